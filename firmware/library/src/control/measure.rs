//! From counts and codes to SI.

use super::magnitude::{Applied, Magnitude};
use super::{CYCLE_TICKS, TICK_S, bounds, filter::LowPass};
use crate::sensors::{CODE_MAX, CurrentZero, Sensors};
use crate::settings::{CurrentOutput, CurrentOutputs, Settings};
use leg_model::Scalar;

/// Readings of a current whose mean is its zero: 2 ms, as long as nothing is driven after a start.
pub const ZERO_READINGS: u16 = 16;

/// What the sensors say, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<T> {
    /// How far each tendon is pulled in since the board started, m.
    pub pulled_m: [T; 3],
    /// Tension of each tendon, N.
    pub tensions_n: [T; 3],
    /// The same without noise.
    pub steady_tensions_n: [T; 3],
    /// Mean current of each motor over the last whole cycle, A; what an output reads that was silent in all of it.
    pub currents_a: [T; 3],
    /// Supply, V.
    pub supply_v: T,
    /// Temperature of the drivers, °C.
    pub temperature_c: T,
}

#[cfg(test)]
impl Measured<f64> {
    /// What is measured of a leg at rest whose motors are off: how far each tendon is pulled in, m, and its tension, N.
    pub const fn resting(pulled_m: [f64; 3], tensions_n: [f64; 3]) -> Self {
        Self {
            pulled_m,
            tensions_n,
            steady_tensions_n: tensions_n,
            currents_a: [0.0; 3],
            supply_v: 24.0,
            temperature_c: 30.0,
        }
    }

    /// The same in f32.
    pub fn single(&self) -> Measured<f32> {
        let single = |three: [f64; 3]| three.map(|number| number as f32);
        Measured {
            pulled_m: single(self.pulled_m),
            tensions_n: single(self.tensions_n),
            steady_tensions_n: single(self.steady_tensions_n),
            currents_a: single(self.currents_a),
            supply_v: self.supply_v as f32,
            temperature_c: self.temperature_c as f32,
        }
    }
}

/// The conversion of one axis.
#[derive(Clone, Copy, Debug)]
struct Channel<T> {
    last_count: u16,
    /// Counts since the start: integers, so that none is ever lost to rounding.
    counts: i32,
    m_per_count: T,
    n_per_code: T,
    zero_code: T,
    a_per_code: T,
    current_zero_code: T,
    /// Codes of the current since its last mean.
    current_codes: u32,
    current_a: T,
    steady: LowPass<T>,
}

/// Converts what the sensors read.
#[derive(Clone, Copy, Debug)]
pub struct Measurement<T> {
    channels: [Channel<T>; 3],
    supply_v_per_code: T,
    temperature_c_per_code: T,
    temperature_at_zero_c: T,
    started: bool,
    current_zeros: [CurrentZero; 3],
    /// Codes of each current while its zero is searched for, and how many readings that were.
    zero_codes: [u32; 3],
    zero_readings: u16,
    outputs: CurrentOutputs,
}

impl<T: Scalar> Measurement<T> {
    /// With the calibration of the settings.
    pub fn new(settings: &Settings) -> Self {
        let outputs = settings.current_outputs;
        let zero_codes = outputs.each().map(CurrentOutput::zero_code);
        let channel = |i: usize| {
            let axis = &settings.axes[i];
            Channel {
                last_count: 0,
                counts: 0,
                m_per_count: axis.m_per_count.into(),
                n_per_code: axis.cell_n_per_code.into(),
                zero_code: axis.cell_zero_code.into(),
                a_per_code: axis.current_a_per_code.into(),
                current_zero_code: zero_codes[i].into(),
                current_codes: 0,
                current_a: T::zero(),
                steady: LowPass::new(settings.estimation.tension_time_s, TICK_S),
            }
        };
        Self {
            channels: [channel(0), channel(1), channel(2)],
            supply_v_per_code: settings.board.supply_v_per_code.into(),
            temperature_c_per_code: settings.board.temperature_c_per_code.into(),
            temperature_at_zero_c: settings.board.temperature_at_zero_c.into(),
            started: false,
            current_zeros: [CurrentZero::NotFound; 3],
            zero_codes: [0; 3],
            zero_readings: 0,
            outputs,
        }
    }

    /// Converts one reading.
    #[inline(always)]
    pub fn convert(&mut self, sensors: &Sensors) -> Measured<T> {
        if !self.started {
            self.start(sensors);
        }
        let mut measured = Measured {
            pulled_m: [T::zero(); 3],
            tensions_n: [T::zero(); 3],
            steady_tensions_n: [T::zero(); 3],
            currents_a: [T::zero(); 3],
            supply_v: code::<T>(sensors.supply_code) * self.supply_v_per_code,
            temperature_c: code::<T>(sensors.temperature_code) * self.temperature_c_per_code
                + self.temperature_at_zero_c,
        };
        for (i, channel) in self.channels.iter_mut().enumerate() {
            measured.pulled_m[i] = channel.pulled(sensors.encoder_counts[i]);
            let tension = channel.tension(sensors.cell_codes[i]);
            measured.tensions_n[i] = tension;
            measured.steady_tensions_n[i] = channel.steady.step(tension);
            channel.current_codes += u32::from(sensors.current_codes[i]);
            measured.currents_a[i] = channel.current_a;
        }
        measured
    }

    /// Ends the mean of the current of an axis, from 0 to 2, after the readings of a cycle.
    #[inline(always)]
    pub fn end_current(&mut self, axis: usize) {
        if let Some(channel) = self.channels.get_mut(axis) {
            let codes = core::mem::take(&mut channel.current_codes);
            let mean_code = T::from(codes as f32 * (1.0 / CYCLE_TICKS as f32));
            channel.current_a = channel.current(mean_code);
        }
    }

    /// Whether an output shows no more than a magnitude: then [`Self::end_magnitude`] and [`Self::add_magnitudes`] are needed.
    #[inline(always)]
    pub fn has_magnitudes(&self) -> bool {
        self.outputs.has_magnitudes()
    }

    /// Ends the mean of an axis, from 0 to 2, at an output that shows a magnitude. After [`Self::end_current`].
    pub fn end_magnitude(&mut self, axis: usize, magnitudes: &mut [Magnitude<T>; 3]) {
        let outputs = self.outputs.each();
        if let (Some(channel), Some(magnitude), Some(&output)) = (
            self.channels.get_mut(axis),
            magnitudes.get_mut(axis),
            outputs.get(axis),
        ) {
            let most_a = channel.current(T::from(f32::from(CODE_MAX)));
            channel.current_a = magnitude.end(output, channel.current_a, most_a);
        }
    }

    /// Adds what the outputs show while the motors have what was applied in the last tick. Before [`Self::convert`].
    pub fn add_magnitudes(
        &self,
        sensors: &Sensors,
        applied: &[Applied<T>; 3],
        magnitudes: &mut [Magnitude<T>; 3],
    ) {
        let supply_v = code::<T>(sensors.supply_code) * self.supply_v_per_code;
        let shown = self.channels.iter().zip(&sensors.current_codes);
        let magnitudes = magnitudes.iter_mut().zip(self.outputs.each());
        for (((magnitude, output), applied), (channel, &shown)) in
            magnitudes.zip(applied).zip(shown)
        {
            let duty = if supply_v > T::one() {
                applied.voltage_v.abs() / supply_v
            } else {
                T::zero()
            };
            magnitude.add(output, channel.current(code(shown)), applied, duty);
        }
    }

    /// Whether the zeros of the currents are searched for.
    #[inline(always)]
    pub fn seeks_current_zeros(&self) -> bool {
        self.zero_readings < ZERO_READINGS
    }

    /// Takes a reading: after [`ZERO_READINGS`] of them the mean of each current is its zero, where it may be one. A leg that is driven
    /// before that has none.
    #[cold]
    #[inline(never)]
    pub fn seek_current_zeros(&mut self, sensors: &Sensors, driven: bool) {
        if driven {
            self.zero_readings = ZERO_READINGS;
            return;
        }
        self.zero_readings += 1;
        for (sum, &code) in self.zero_codes.iter_mut().zip(&sensors.current_codes) {
            *sum += u32::from(code);
        }
        if self.zero_readings == ZERO_READINGS {
            // Exact: a sum has 20 bits, and the divisor is a power of two.
            let mean = |sum: u32| sum as f32 * (1.0 / f32::from(ZERO_READINGS));
            let mut zeros = self.current_zeros;
            let outputs = self.outputs.each().into_iter().zip(&self.zero_codes);
            for (zero, (output, &sum)) in zeros.iter_mut().zip(outputs) {
                *zero = CurrentZero::from_mean(mean(sum), output.zero_code());
            }
            self.set_current_zeros(&zeros);
        }
    }

    /// The zero of each current, and what was made of what it read.
    #[must_use]
    pub fn current_zeros(&self) -> [CurrentZero; 3] {
        self.current_zeros
    }

    /// Counts currents from these zeros, from the next mean on.
    pub fn set_current_zeros(&mut self, zeros: &[CurrentZero; 3]) {
        self.current_zeros = *zeros;
        let zeros = zeros.iter().zip(self.outputs.each());
        for (channel, (zero, output)) in self.channels.iter_mut().zip(zeros) {
            channel.current_zero_code = zero.code(output.zero_code()).into();
        }
    }

    /// Takes the present codes of the load cells, each an average, as those without tension.
    pub fn tare(&mut self, offsets_n: &[T; 3]) {
        for (channel, &offset_n) in self.channels.iter_mut().zip(offsets_n) {
            channel.zero_code += offset_n / channel.n_per_code;
            channel.steady.set(T::zero());
        }
    }

    #[cold]
    fn start(&mut self, sensors: &Sensors) {
        self.started = true;
        for (i, channel) in self.channels.iter_mut().enumerate() {
            channel.last_count = sensors.encoder_counts[i];
            channel.current_a = channel.current(code(sensors.current_codes[i]));
            let tension = channel.tension(sensors.cell_codes[i]);
            channel.steady.set(tension);
        }
    }
}

impl<T: Scalar> Channel<T> {
    #[inline(always)]
    fn pulled(&mut self, count: u16) -> T {
        // Between two ticks a motor turns far less than half of the counter's range.
        let step = count.wrapping_sub(self.last_count).cast_signed();
        self.last_count = count;
        self.counts = self.counts.wrapping_add(i32::from(step));
        // Exact up to 2²⁴ counts, far beyond any travel.
        T::from(self.counts as f32) * self.m_per_count
    }

    #[inline(always)]
    fn tension(&self, cell_code: u16) -> T {
        (code::<T>(cell_code) - self.zero_code) * self.n_per_code
    }

    #[inline(always)]
    fn current(&self, code: T) -> T {
        let highest = T::from(f32::from(CODE_MAX));
        (bounds::min(code, highest) - self.current_zero_code) * self.a_per_code
    }
}

#[inline(always)]
fn code<T: Scalar>(code: u16) -> T {
    T::from(f32::from(code))
}

#[cfg(test)]
mod tests;
