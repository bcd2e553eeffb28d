//! The spectrum of a signal: which sines it has, each with its amplitude in the signal's unit.

use realfft::RealFftPlanner;
use std::f64::consts::{PI, TAU};

/// Fewer samples have no spectrum that says anything.
const SAMPLES_MIN: usize = 32;

/// No more samples are looked at: the last ones.
const SAMPLES_MAX: usize = 16_384;

/// The window cannot tell the lines below this one from the mean.
const FIRST_LINE: usize = 2;

/// It.
#[derive(Clone, Debug)]
pub(super) struct Spectrum {
    /// Frequency, Hz, and amplitude of each line that is told from the mean.
    pub lines: Vec<[f64; 2]>,
    /// The sine of the highest one.
    pub peak: Option<[f64; 2]>,
}

impl Spectrum {
    /// Of a signal at times, s, which are about evenly spaced; none of too few.
    pub fn new(points: &[[f64; 2]]) -> Option<Self> {
        let (samples, step_s) = even(points)?;
        let count = samples.len();
        let mean = samples.iter().sum::<f64>() / count as f64;
        // Hann's window, which ends at zero.
        let window = |i: usize| 0.5 - 0.5 * (TAU * i as f64 / count as f64).cos();
        let whole: f64 = (0..count).map(window).sum();
        let mut input: Vec<f64> = samples
            .iter()
            .enumerate()
            .map(|(i, sample)| (sample - mean) * window(i))
            .collect();
        let transform = RealFftPlanner::new().plan_fft_forward(count);
        let mut output = transform.make_output_vec();
        transform.process(&mut input, &mut output).ok()?;
        let line_hz = 1.0 / (step_s * count as f64);
        let mut lines: Vec<[f64; 2]> = output
            .iter()
            .enumerate()
            .map(|(line, value)| [line as f64 * line_hz, 2.0 * value.norm() / whole])
            .collect();
        let peak = peak(&lines, line_hz);
        // They would be the highest of the chart, and say nothing.
        lines.drain(..FIRST_LINE.min(lines.len()));
        Some(Self { lines, peak })
    }

    /// The highest peak in words of one length.
    pub fn words(&self, unit: &str) -> String {
        match self.peak {
            Some([hz, amplitude]) => format!("peak {hz:7.2} Hz {amplitude:9.4} {unit}"),
            None => format!("{:>width$}", "no peak", width = 25 + unit.len()),
        }
    }
}

/// Samples in even steps, s, between points that are nearly so.
fn even(points: &[[f64; 2]]) -> Option<(Vec<f64>, f64)> {
    let points = &points[points.len().saturating_sub(SAMPLES_MAX)..];
    let (first, last) = (points.first()?, points.last()?);
    let mut steps_s: Vec<f64> = points
        .windows(2)
        .map(|pair| pair[1][0] - pair[0][0])
        .collect();
    steps_s.sort_by(f64::total_cmp);
    let step_s = *steps_s.get(steps_s.len() / 2)?;
    if step_s <= 0.0 {
        return None;
    }
    let count = ((last[0] - first[0]) / step_s).round() as usize + 1;
    if !(SAMPLES_MIN..=2 * SAMPLES_MAX).contains(&count) {
        return None;
    }
    let mut next = 1;
    let sample = |i: usize| {
        let time_s = first[0] + i as f64 * step_s;
        while next + 1 < points.len() && points[next][0] < time_s {
            next += 1;
        }
        let [[a_s, a], [b_s, b]] = [points[next - 1], points[next]];
        let part = if b_s > a_s {
            ((time_s - a_s) / (b_s - a_s)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        a + part * (b - a)
    };
    Some(((0..count).map(sample).collect(), step_s))
}

/// The sine that has the highest line, which lies between two of them.
fn peak(lines: &[[f64; 2]], line_hz: f64) -> Option<[f64; 2]> {
    let inside = FIRST_LINE..lines.len().saturating_sub(1);
    let highest = inside.max_by(|a, b| lines[*a][1].total_cmp(&lines[*b][1]))?;
    let [[_, before], [hz, here], [_, after]] =
        [lines[highest - 1], lines[highest], lines[highest + 1]];
    if here <= 0.0 {
        return None;
    }
    // What Hann's window makes of a sine between two lines.
    let (side, sign) = if after > before {
        (after, 1.0)
    } else {
        (before, -1.0)
    };
    let ratio = side / here;
    let off = ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(0.0, 0.5);
    let loss = if off > 1e-6 {
        (PI * off).sin() / (PI * off) / (1.0 - off * off)
    } else {
        1.0
    };
    Some([hz + sign * off * line_hz, here / loss])
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Spectrum;
    use std::f64::consts::TAU;

    /// Sines of these frequencies and amplitudes beside a mean, at 200 Hz for some time, s.
    fn signal(sines: &[[f64; 2]], time_s: f64) -> Vec<[f64; 2]> {
        let count = (200.0 * time_s) as u32;
        let point = |i: u32| {
            let at_s = 7.0 + f64::from(i) / 200.0;
            let parts = sines
                .iter()
                .map(|[hz, amplitude]| amplitude * (TAU * hz * at_s + 0.3).sin());
            [at_s, 70.0 + parts.sum::<f64>()]
        };
        (0..count).map(point).collect()
    }

    #[test]
    fn the_highest_peak_has_the_frequency_and_amplitude_of_its_sine() {
        // On a line, and at several places between two.
        for hz in [20.0, 12.34, 31.05, 7.77] {
            let spectrum = Spectrum::new(&signal(&[[hz, 3.0], [55.0, 0.7]], 10.0)).unwrap();
            let [found_hz, amplitude] = spectrum.peak.unwrap();
            assert!((found_hz - hz).abs() < 0.01, "{found_hz} {hz}");
            assert!((amplitude - 3.0).abs() < 0.03, "{amplitude}");
            let [last_hz, _] = *spectrum.lines.last().unwrap();
            assert!((last_hz - 100.0).abs() < 0.1, "{last_hz}");
        }
    }

    #[test]
    fn a_lesser_sine_stands_at_its_place() {
        let spectrum = Spectrum::new(&signal(&[[20.0, 3.0], [55.0, 0.7]], 10.0)).unwrap();
        let near = spectrum
            .lines
            .iter()
            .filter(|[hz, _]| (hz - 55.0).abs() < 0.3);
        let highest = near.map(|[_, amplitude]| *amplitude).fold(0.0, f64::max);
        assert!((highest - 0.7).abs() < 0.05, "{highest}");
        let between = spectrum
            .lines
            .iter()
            .filter(|[hz, _]| (30.0..45.0).contains(hz));
        assert!(between.map(|[_, amplitude]| *amplitude).fold(0.0, f64::max) < 0.01);
    }

    /// A mean that drifts is no sine, and must not be the highest of the chart.
    #[test]
    fn no_line_is_higher_than_the_peak() {
        let drifting = signal(&[[12.34, 0.01]], 10.0).into_iter();
        let drifting: Vec<_> = drifting
            .map(|[at_s, value]| [at_s, value + 0.003 * (at_s - 7.0).powi(2)])
            .collect();
        let spectrum = Spectrum::new(&drifting).unwrap();
        let [_, peak] = spectrum.peak.unwrap();
        let highest = spectrum.lines.iter().map(|[_, amplitude]| *amplitude);
        assert!(highest.fold(0.0, f64::max) <= peak, "{peak}");
        let [first_hz, _] = spectrum.lines[0];
        assert!((first_hz - 0.2).abs() < 1e-9, "{first_hz}");
    }

    #[test]
    fn missing_samples_are_bridged() {
        let mut points = signal(&[[5.0, 2.0]], 10.0);
        let mut number = 0;
        points.retain(|_| {
            number += 1;
            number % 17 != 0
        });
        let [hz, amplitude] = Spectrum::new(&points).unwrap().peak.unwrap();
        assert!(
            (hz - 5.0).abs() < 0.01 && (amplitude - 2.0).abs() < 0.05,
            "{hz} {amplitude}"
        );
    }

    #[test]
    fn what_does_not_change_has_no_peak_and_too_few_samples_no_spectrum() {
        let still = Spectrum::new(&signal(&[], 5.0)).unwrap();
        assert!(still.peak.is_none_or(|[_, amplitude]| amplitude < 1e-9));
        assert!(Spectrum::new(&signal(&[[5.0, 1.0]], 0.1)).is_none());
        assert!(Spectrum::new(&[]).is_none());
        assert!(Spectrum::new(&[[1.0, 2.0]; 100]).is_none());
    }
}
