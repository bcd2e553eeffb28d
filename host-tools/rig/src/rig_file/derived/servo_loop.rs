//! How near the servo is to ringing: its phase margins with the delays of sampling, winding and speed tracking.

use crate::actuator::Actuator;
use leg_firmware::sensors::TICK_HZ;
use leg_firmware::settings::{SPEED_BY_POSITION, Servo};
use nalgebra::ComplexField;

type Complex = nalgebra::Complex<f64>;

/// From a reading of the sensors to the middle of what it makes the drivers do, ticks.
const DELAY_TICKS: f64 = 1.5;

/// The same without the time to compute it, as in the simulation: a voltage is held for a tick. The gains that are derived have the rest as a
/// reserve.
const HOLD_TICKS: f64 = 0.5;

/// The time of the integral by that of the position loop.
const INTEGRAL_BY_POSITION: f64 = 2.4;

/// A servo with its motor, from the error of the position to the position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ServoLoop {
    mechanical_s: f64,
    electrical_s: f64,
    back_emf: f64,
    /// The double pole of the filter that tracks the speed, 1/s.
    tracking_per_s: f64,
    actuator: Actuator,
}

/// The gains of the loops.
#[derive(Clone, Copy, Debug)]
struct LoopGains {
    position_per_s: f64,
    speed: f64,
    integral_s: f64,
}

impl ServoLoop {
    pub fn new(actuator: &Actuator, servo: &Servo) -> Self {
        Self {
            mechanical_s: actuator.mechanical_time_s(),
            electrical_s: actuator.inductance_h / actuator.resistance_ohm,
            back_emf: actuator.back_emf_v_s_per_m(),
            tracking_per_s: 0.5 * f64::from(servo.tracking) * f64::from(TICK_HZ),
            actuator: *actuator,
        }
    }

    /// The gain that makes the speed loop as much faster than the position loop as it has to be, V·s/m.
    pub fn speed_gain_v_s_per_m(actuator: &Actuator, position_gain_per_s: f64) -> f64 {
        let volts = actuator.back_emf_v_s_per_m() * actuator.mechanical_time_s();
        f64::from(SPEED_BY_POSITION) * position_gain_per_s * volts
    }

    /// The time of the integral to a position loop, s.
    pub fn integral_time_s(position_gain_per_s: f64) -> f64 {
        INTEGRAL_BY_POSITION / position_gain_per_s
    }

    /// The least phase margin of both loops with a servo's gains, degrees.
    pub fn phase_margin_deg(&self, servo: &Servo) -> f64 {
        self.margin_deg(&LoopGains {
            position_per_s: servo.position_gain_per_s.into(),
            speed: servo.speed_gain_v_s_per_m.into(),
            integral_s: servo.integral_time_s.into(),
        })
    }

    /// The highest gain of the position loop that leaves a margin, 1/s, with the other gains that follow from it.
    pub fn highest_gain_per_s(&self, margin_deg: f64) -> f64 {
        let margin = |position_per_s: f64| {
            self.margin_deg(&LoopGains {
                position_per_s,
                speed: Self::speed_gain_v_s_per_m(&self.actuator, position_per_s),
                integral_s: Self::integral_time_s(position_per_s),
            })
        };
        let (mut low, mut high) = (1.0_f64, 1000.0_f64);
        for _ in 0..24 {
            let middle = (low * high).sqrt();
            if margin(middle) >= margin_deg {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// The transfer of the whole servo at a frequency, Hz, broken at the voltage of the motor: that of a loop whose limit of stability
    /// is −1.
    pub fn voltage_transfer(&self, servo: &Servo, hz: f64) -> Complex {
        let rate = std::f64::consts::TAU * hz;
        let position_per_s = f64::from(servo.position_gain_per_s);
        let integral_s = f64::from(servo.integral_time_s);
        let integral = Complex::ONE + Complex::new(0.0, rate * integral_s).recip();
        let s = Complex::new(0.0, rate);
        let motor = s * self.mechanical_s * (s * self.electrical_s + 1.0) + 1.0;
        let travel = late(rate, HOLD_TICKS) / (motor * s * self.back_emf);
        let speed_error = Complex::from(position_per_s) + self.tracked_speed(rate);
        let by_speed = integral * speed_error * f64::from(servo.speed_gain_v_s_per_m);
        travel * (by_speed + self.back_emf * position_per_s)
    }

    fn margin_deg(&self, gains: &LoopGains) -> f64 {
        let speed_loop = |rate| self.speed_forward(gains, rate) * self.tracked(rate);
        let position_loop = |rate: f64| {
            let forward = self.speed_forward(gains, rate);
            // The speed that is asked for drives the back EMF by itself.
            let fed = forward + self.motor(rate) * self.back_emf;
            let closed = fed / (Complex::ONE + forward * self.tracked(rate));
            closed * gains.position_per_s / Complex::new(0.0, rate)
        };
        phase_margin_deg(speed_loop).min(phase_margin_deg(position_loop))
    }

    /// From the voltage to the speed, with the delay; the winding as a lag of its own.
    fn motor(&self, rate: f64) -> Complex {
        let lag = |time_s: f64| Complex::new(1.0, rate * time_s);
        late(rate, DELAY_TICKS) / (lag(self.mechanical_s) * lag(self.electrical_s) * self.back_emf)
    }

    /// From an error of the speed to the speed.
    fn speed_forward(&self, gains: &LoopGains, rate: f64) -> Complex {
        let integral = Complex::ONE + Complex::new(0.0, rate * gains.integral_s).recip();
        self.motor(rate) * integral * gains.speed
    }

    /// From the position to the tracked speed, as the filter computes it tick by tick.
    fn tracked_speed(&self, rate: f64) -> Complex {
        let ticks_per_s = f64::from(TICK_HZ);
        let tick = Complex::new(0.0, rate / ticks_per_s).exp();
        let position = 2.0 * self.tracking_per_s / ticks_per_s;
        let speed = 0.25 * position * position;
        let poles = tick * (tick + (position + speed - 2.0)) + (1.0 - position);
        tick * (tick - 1.0) * speed * ticks_per_s / poles
    }

    /// From the speed to the tracked speed, by a filter that works all the time.
    fn tracked(&self, rate: f64) -> Complex {
        let lag = Complex::new(1.0, rate / self.tracking_per_s);
        (lag * lag).recip()
    }
}

/// A delay of so many ticks.
fn late(rate: f64, ticks: f64) -> Complex {
    Complex::new(0.0, -rate * ticks / f64::from(TICK_HZ)).exp()
}

/// The least phase margin of an open loop over all its crossovers, degrees; −180 at worst.
fn phase_margin_deg(open: impl Fn(f64) -> Complex) -> f64 {
    let mut rate = 1.0;
    let mut last = open(rate);
    let mut phase = last.argument();
    let mut least = f64::INFINITY;
    while rate < 0.5 * std::f64::consts::TAU * f64::from(TICK_HZ) {
        rate *= 1.02;
        let next = open(rate);
        // The phase goes on where it would turn about.
        phase += (next / last).argument();
        if (last.modulus() >= 1.0) != (next.modulus() >= 1.0) {
            least = least.min(180.0 + phase.to_degrees());
        }
        last = next;
    }
    least.max(-180.0)
}

#[cfg(test)]
mod tests {
    use super::{Complex, ServoLoop, phase_margin_deg};
    use crate::actuator::Actuator;
    use leg_firmware::settings::Servo;
    use nalgebra::ComplexField;

    /// An integrator with a delay crosses at its gain: the margin is 90° less what the delay takes.
    #[test]
    fn a_delayed_integrator_has_the_margin_of_the_text_book() {
        for (gain, delay_s) in [(100.0, 1e-3), (500.0, 1e-3), (1000.0, 2e-3)] {
            let open = |rate: f64| {
                Complex::new(0.0, -rate * delay_s).exp() * gain / Complex::new(0.0, rate)
            };
            let expected = 90.0 - f64::to_degrees(gain * delay_s);
            let found = phase_margin_deg(open);
            assert!((found - expected).abs() < 2.5, "{found} {expected}");
        }
    }

    #[test]
    fn a_slower_winding_a_slower_filter_and_a_higher_gain_take_margin() {
        let margin = |change: fn(&mut Actuator, &mut Servo)| {
            let (mut actuator, mut servo) = (Actuator::DEFAULT, Servo::DEFAULT);
            change(&mut actuator, &mut servo);
            ServoLoop::new(&actuator, &servo).phase_margin_deg(&servo)
        };
        let default = margin(|_, _| ());
        assert!((45.0..70.0).contains(&default), "{default}");
        assert!(margin(|actuator, _| actuator.inductance_h *= 10.0) < default - 15.0);
        assert!(margin(|_, servo| servo.tracking *= 0.5) < default - 15.0);
        assert!(margin(|_, servo| servo.speed_gain_v_s_per_m *= 3.0) < default - 15.0);
        assert!(margin(|_, servo| servo.position_gain_per_s *= 5.0) < default - 15.0);
    }
}
