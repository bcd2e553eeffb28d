//! The feedback loops of the firmware, and how each is swept.

use super::break_point::{BreakPoint, BrokenLoop, CellBreak};
use super::frequency_response::Excitation;
use super::patterns::Patterns;
use super::sweep::Sweep;
use crate::stand::Stand;
use leg_firmware::command::{Command, Compensation};
use leg_firmware::sensors::TICK_HZ;
use leg_rig::rig_file::RigFile;
use serde::Serialize;

/// A feedback loop of the control law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Feedback {
    /// Position and speed of a motor (`Axis`), broken at its voltage.
    Servo,
    /// The brake of the swing (`SwingDamping`), broken at the lengths of the tendons along a tilt, while the compensation is frozen.
    Damping,
    /// All that the load cells feed back along a tilt: the brake, and the estimated load that is compensated (`Estimator`).
    Tension,
    /// The trim of the pretension (`TargetGenerator`), broken at the load cells along the pretension.
    Trim,
}

/// Amplitudes of what is added to a motor's voltage, as parts of what drives the servo's highest current. The
/// smaller one is still more than what friction takes at the highest tension.
const VOLTAGE_PARTS: [f64; 2] = [0.65, 0.325];

/// The same of tensions, as parts of the highest.
pub(super) const TENSION_PARTS: [f64; 2] = [0.02, 0.01];

/// Time in which a frozen load leaves nothing to swing, s.
const FREEZE_S: f64 = 0.5;

impl Feedback {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Servo, Self::Damping, Self::Tension, Self::Trim];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Servo => "servo",
            Self::Damping => "damping",
            Self::Tension => "tension",
            Self::Trim => "trim",
        }
    }

    /// Its places: motors, or the tilts farther and across.
    pub(super) const fn places(self) -> &'static [&'static str] {
        match self {
            Self::Servo => &["motor 1", "motor 2", "motor 3"],
            Self::Damping | Self::Tension => &["farther", "across"],
            Self::Trim => &["pretension"],
        }
    }

    /// The loop at one of its places, broken, of a leg at rest; and its sweeps by amplitude.
    pub(super) fn broken(
        self,
        file: &RigFile,
        stand: &Stand,
        place: usize,
    ) -> Result<(BrokenLoop, Vec<(f64, Sweep)>), String> {
        let mut stand = stand.clone();
        if self == Self::Servo {
            let servo = &file.gains.servos[place];
            let highest_v = f64::from(servo.current_a * servo.resistance_ohm);
            let at = BreakPoint::Motor {
                motor: place,
                supply_v: file.actuators[place].supply_v,
            };
            let sweeps = VOLTAGE_PARTS.map(|part| (part * highest_v, self.sweep(part * highest_v)));
            return Ok((BrokenLoop { stand, at }, sweeps.into()));
        }
        if self == Self::Damping {
            stand.command(&Command::Compensation(Compensation::Frozen))?;
            stand.wait(FREEZE_S)?;
        }
        let patterns = Patterns::new(file, &stand).map_err(|error| error.to_string())?;
        let cells = match self {
            Self::Damping => patterns.lengths(place),
            Self::Tension => patterns.moment(place),
            _ => patterns.pretension(),
        };
        let sweep = |cells: &CellBreak, part: f64| {
            let tension_n = part * file.f_max_n;
            (tension_n, self.sweep(cells.amplitude(tension_n)))
        };
        let sweeps = match self {
            // An integral in f32 answers in proportion.
            Self::Trim => vec![sweep(&cells, TENSION_PARTS[0])],
            _ => TENSION_PARTS.map(|part| sweep(&cells, part)).into(),
        };
        let at = BreakPoint::Cells(cells);
        Ok((BrokenLoop { stand, at }, sweeps))
    }

    fn sweep(self, amplitude: f64) -> Sweep {
        let ([from_hz, to_hz], points, settle_s, window_s) = match self {
            Self::Servo => ([20.0, 700.0], 12, 0.05, 0.05),
            Self::Damping => ([1.0, 400.0], 18, 0.5, 0.25),
            Self::Tension => ([1.0, 400.0], 17, 0.8, 0.3),
            Self::Trim => ([0.2, 5.0], 5, 2.0, 0.3),
        };
        Sweep {
            excitation: Excitation {
                tick_hz: f64::from(TICK_HZ),
                amplitude,
                settle_s,
                settle_periods: 1.0,
                window_s,
                window_periods: 2.0,
            },
            from_hz,
            to_hz,
            points,
        }
    }
}
