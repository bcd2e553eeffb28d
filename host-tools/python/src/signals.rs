//! What can be read of a simulated leg and recorded: each signal with its name, which ends with its unit, and its meaning.

use leg_firmware::drive::Drive;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_sim::hosted_leg::{Comparison, HostedLeg};
use leg_sim::plant::Truth;

/// The leg after a tick.
pub struct Snapshot<'a> {
    /// How it is.
    pub truth: &'a Truth,
    /// What it reports.
    pub telemetry: &'a Telemetry<f32>,
    /// What the motors got in the last tick.
    pub motors: &'a Drive<f32>,
    /// Both beside what was commanded.
    pub comparison: Comparison,
    /// Whether a path is followed, and the leg is on it.
    pub on_path: bool,
}

impl<'a> Snapshot<'a> {
    /// Of a leg; none before its first tick.
    pub fn new(leg: &'a HostedLeg, motors: &'a Drive<f32>, on_path: bool) -> Option<Self> {
        Some(Self {
            truth: leg.truth(),
            telemetry: leg.telemetry()?,
            motors,
            comparison: leg.comparison(),
            on_path,
        })
    }
}

/// Where a signal comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The simulated leg as it is, which no sensor says.
    Truth,
    /// What the firmware reports.
    Telemetry,
    /// What was commanded and what is compared with it.
    Comparison,
}

/// A signal: one number, or one for each tendon or coordinate.
pub struct Signal {
    /// Its name, which ends with its unit.
    pub name: &'static str,
    /// Where it comes from.
    pub origin: Origin,
    /// What it is.
    pub meaning: &'static str,
    /// How many numbers.
    pub width: usize,
    /// Writes them.
    read: Read,
}

/// Reads the numbers of a signal.
enum Read {
    /// Of the simulated leg.
    Leg(fn(&Snapshot<'_>, &mut Vec<f64>)),
    /// Of what any leg reports.
    Telemetry(fn(&Telemetry<f32>, &mut Vec<f64>)),
}

impl Signal {
    /// Its numbers at a snapshot of the simulated leg.
    pub fn read(&self, snapshot: &Snapshot<'_>, out: &mut Vec<f64>) {
        match self.read {
            Read::Leg(read) => read(snapshot, out),
            Read::Telemetry(read) => read(snapshot.telemetry, out),
        }
    }

    /// Its numbers in what a leg reports; none of a signal that no leg reports.
    pub fn reported(&self, telemetry: &Telemetry<f32>) -> Option<Vec<f64>> {
        let Read::Telemetry(read) = self.read else {
            return None;
        };
        let mut numbers = Vec::with_capacity(self.width);
        read(telemetry, &mut numbers);
        Some(numbers)
    }
}

macro_rules! signals {
    ($($origin:ident $name:literal [$width:literal] $meaning:literal = |$at:ident| $value:expr;)*) => {
        /// Every signal.
        pub const SIGNALS: &[Signal] = &[$(Signal {
            name: $name,
            origin: Origin::$origin,
            meaning: $meaning,
            width: $width,
            read: signals!(@read $origin, $width, $at, $value),
        },)*];
    };
    (@read Telemetry, $width:literal, $at:ident, $value:expr) => {
        Read::Telemetry(|$at, out| out.extend::<[f64; $width]>($value))
    };
    (@read $origin:ident, $width:literal, $at:ident, $value:expr) => {
        Read::Leg(|$at, out| out.extend::<[f64; $width]>($value))
    };
}

signals! {
    Comparison "tip_commanded_mm" [3] "Where the tip was sent: the end of a move, or the point of a path at that time, mm."
        = |at| at.comparison.tip_commanded_mm;
    Comparison "tip_reference_mm" [3] "Where the firmware's trajectory has the tip, mm."
        = |at| at.comparison.tip_reference_mm;
    Comparison "tip_estimated_mm" [3] "Where the firmware estimates the tip, mm; without meaning before homing."
        = |at| at.comparison.tip_estimated_mm;
    Truth "tip_true_mm" [3] "Where the tip is: x, y and z from the joint's centre, z upwards, mm."
        = |at| at.comparison.tip_true_mm;
    Comparison "tip_error_mm" [1] "Distance of the true tip from where it was sent, mm."
        = |at| [distance(&at.comparison.tip_true_mm, &at.comparison.tip_commanded_mm)];
    Comparison "path_error_mm" [1] "The same while a path is followed, mm; not a number elsewhere."
        = |at| [if at.on_path {
            distance(&at.comparison.tip_true_mm, &at.comparison.tip_commanded_mm)
        } else {
            f64::NAN
        }];
    Truth "azimuth_true_deg" [1] "Where the leg leans, 0 to 360°."
        = |at| [azimuth_deg(direction(at.truth))];
    Truth "tilt_true_deg" [1] "How far it leans, degrees."
        = |at| [tilt_deg(direction(at.truth))];
    Truth "torsion_true_deg" [1] "How far it is twisted beyond what its joint does, degrees."
        = |at| [at.truth.torsion_rad.to_degrees()];
    Truth "rate_true_rad_per_s" [3] "How fast it turns about x, y and z, rad/s."
        = |at| at.truth.rate_rad_per_s.into();
    Truth "tensions_true_n" [3] "Tension of each tendon, N."
        = |at| at.truth.tensions_n;
    Truth "unstretched_true_mm" [3] "Length of each tendon without tension, mm."
        = |at| at.truth.unstretched_m.map(|m| m * 1000.0);
    Truth "payload_true_kg" [1] "Mass at the tip, kg."
        = |at| [at.truth.payload_kg];
    Truth "motor_currents_true_a" [3] "Current of each motor, A."
        = |at| at.truth.currents_a;
    Truth "motor_speeds_true_rad_per_s" [3] "Speed of each rotor, rad/s."
        = |at| at.truth.speeds_rad_per_s;
    Truth "supply_true_v" [1] "Voltage at the drivers, V."
        = |at| [at.truth.supply_v];
    Telemetry "azimuth_deg" [1] "Where the leg is estimated to lean, 0 to 360°."
        = |at| [azimuth_deg(at.pose.map(f64::from))];
    Telemetry "tilt_deg" [1] "How far it is estimated to lean, degrees."
        = |at| [tilt_deg(at.pose.map(f64::from))];
    Telemetry "tensions_n" [3] "Tensions as measured, N."
        = |at| at.tensions_n.map(f64::from);
    Telemetry "target_tensions_n" [3] "Tensions that the target asks for, N."
        = |at| at.target_tensions_n.map(f64::from);
    Telemetry "pretension_n" [1] "Pretension of the target, N; 0 before the first."
        = |at| [at.pretension_n.into()];
    Telemetry "stiffness_nm_per_rad" [1] "Bending stiffness at that pretension, N·m/rad."
        = |at| [at.stiffness_nm_per_rad.into()];
    Telemetry "load_nm" [2] "Load beyond the leg's own weight, as a horizontal moment, N·m."
        = |at| at.load_nm.map(f64::from);
    Telemetry "payload_kg" [1] "The payload that this load would be, kg."
        = |at| [at.payload_kg.into()];
    Telemetry "residual_m" [1] "What forward kinematics leaves over, m."
        = |at| [at.residual_m.into()];
    Telemetry "pulled_m" [3] "How far each tendon is pulled in since the start, m."
        = |at| at.pulled_m.map(f64::from);
    Telemetry "reference_m" [3] "How far each shall be, m."
        = |at| at.reference_m.map(f64::from);
    Truth "duties" [3] "What each motor gets, as a part of the supply's voltage, -1 to 1; 0 while the drivers are off."
        = |at| if at.motors.enabled { at.motors.duty.map(f64::from) } else { [0.0; 3] };
    Telemetry "moving" [1] "1 while the trajectory moves, 0 else."
        = |at| [f64::from(u8::from(at.moving))];
    Telemetry "state_index" [1] "What the leg may do, as the index of the state's name in STATES."
        = |at| [state_index(at.state) as f64];
}

/// The signal of a name.
pub fn named(name: &str) -> Option<&'static Signal> {
    SIGNALS.iter().find(|signal| signal.name == name)
}

fn state_index(state: State) -> usize {
    let mut states = State::ALL.into_iter();
    states.position(|other| other == state).unwrap_or(0)
}

fn direction(truth: &Truth) -> [f64; 2] {
    let along = truth.direction.vector();
    [along.x, along.y]
}

fn azimuth_deg([x, y]: [f64; 2]) -> f64 {
    y.atan2(x).to_degrees().rem_euclid(360.0)
}

fn tilt_deg([x, y]: [f64; 2]) -> f64 {
    x.hypot(y).min(1.0).asin().to_degrees()
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    squares.sum::<f64>().sqrt()
}
