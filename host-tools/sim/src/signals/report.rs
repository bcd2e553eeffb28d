//! What any leg reports.

use super::{Origin, Signal, Values, fault_names, signals};
use crate::hosted_leg::Comparison;
use crate::sag_model::SagModel;
use leg_base::angles::angles_deg;
use leg_base::description;
use leg_base::tick_time::seconds;
use leg_firmware::settings::Settings;
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_rig::number::decimal;

/// What of a leg's settings a report needs.
#[derive(Clone, Debug)]
pub struct LegConstants {
    tip_length_m: f64,
    tension_bounds_n: [f64; 2],
    sag_model: Option<SagModel>,
}

impl LegConstants {
    /// Of a leg with these settings.
    #[must_use]
    pub fn new(settings: &Settings) -> Self {
        let rig = settings.rig.map(f64::from);
        Self {
            tip_length_m: rig.joint_length_m + rig.leg_length_m,
            tension_bounds_n: [settings.f_min_n, settings.f_max_n].map(f64::from),
            sag_model: SagModel::new(settings),
        }
    }

    /// The tip of a leg with a direction, mm.
    fn tip_mm(&self, direction: [f32; 2]) -> [f64; 3] {
        let [x, y] = direction.map(f64::from);
        let z = -(1.0 - x * x - y * y).max(0.0).sqrt();
        [x, y, z].map(|part| 1000.0 * self.tip_length_m * part)
    }
}

/// A leg at a time, as it reports itself.
#[derive(Clone, Copy, Debug)]
pub struct Report {
    telemetry: Telemetry<f32>,
    tip_commanded_mm: [f64; 3],
    tip_reference_mm: [f64; 3],
    tip_estimated_mm: [f64; 3],
    tension_bounds_n: [f64; 2],
    sag_m: f64,
    wall_time_s: f64,
    damaged_frames: Option<u64>,
}

impl Report {
    /// What a leg reports.
    #[must_use]
    pub fn new(telemetry: &Telemetry<f32>, leg: &LegConstants) -> Self {
        let sag_m = leg
            .sag_model
            .as_ref()
            .and_then(|model| model.sag_m(telemetry));
        Self {
            telemetry: *telemetry,
            tip_commanded_mm: leg.tip_mm(telemetry.commanded),
            tip_reference_mm: leg.tip_mm(telemetry.target),
            tip_estimated_mm: leg.tip_mm(telemetry.pose),
            tension_bounds_n: leg.tension_bounds_n,
            sag_m: sag_m.unwrap_or(f64::NAN),
            wall_time_s: f64::NAN,
            damaged_frames: None,
        }
    }

    /// The tick of which it is.
    #[must_use]
    pub const fn tick(&self) -> u32 {
        self.telemetry.tick
    }

    /// The same, received at a time of the day, s since 1970, over a line that has damaged so many frames.
    #[must_use]
    pub fn received(self, wall_time_s: f64, damaged_frames: u64) -> Self {
        Self {
            wall_time_s,
            damaged_frames: Some(damaged_frames),
            ..self
        }
    }

    /// The same, its tips as the tick before left them, beside the true one of a simulated leg, whose host knows where it sent the tip.
    #[must_use]
    pub fn compared(self, comparison: &Comparison) -> Self {
        Self {
            tip_commanded_mm: comparison.tip_commanded_mm,
            tip_reference_mm: comparison.tip_reference_mm,
            tip_estimated_mm: comparison.tip_estimated_mm,
            ..self
        }
    }

    /// How far the tip would sag without compensation, m.
    #[must_use]
    pub fn sag_m(&self) -> Option<f64> {
        self.sag_m.is_finite().then_some(self.sag_m)
    }
}

signals! {
    /// What any leg reports.
    REPORT_SIGNALS of Report;
    Context Number time_s "Time of the leg since its board started, s."
        = |at| seconds(at.telemetry.tick.into());
    Context Count tick "The same in ticks."
        = |at| Some(at.telemetry.tick.into());
    Context Number wall_time_s "Time of the day when it was received, s since 1970; none of a simulation."
        = |at| at.wall_time_s;
    Context Count damaged_frames "Frames of the leg that could not be read until then; none of a simulation."
        = |at| at.damaged_frames;
    State Word state "What the leg may do."
        = |at| description::state(at.telemetry.state);
    State Count state_index "The same as a number: the place among the names of the states."
        = |at| State::ALL.iter().position(|state| *state == at.telemetry.state).map(|index| index as u64);
    State Names faults "Names of the faults that are latched, or limit now."
        = |at| fault_names(at.telemetry.faults);
    State Flag homed "Whether the zero is known."
        = |at| at.telemetry.homed;
    State Count failed_tendon "The tendon at which homing failed the last time, from 1; 0 if it did not."
        = |at| Some(at.telemetry.failed_tendon.into());
    State Flag moving "Whether the trajectory moves, or waits for the pretension to come up."
        = |at| at.telemetry.moving;
    Commanded Number azimuth_commanded_deg "Where it was sent to lean, 0 to 360°: by the last move; the reference along a path, after a hold and before the first move."
        = |at| angles_deg(at.telemetry.commanded.map(f64::from))[0];
    Commanded Number tilt_commanded_deg "How far, degrees."
        = |at| angles_deg(at.telemetry.commanded.map(f64::from))[1];
    Commanded SingleTwo direction_commanded "The same: x and y of the unit vector along the leg."
        = |at| at.telemetry.commanded;
    Commanded Three tip_commanded_mm "Where that has the tip, mm; of a simulation as the host has it, along a path its point at that time."
        = |at| at.tip_commanded_mm;
    Estimated Number azimuth_deg "Where the leg leans, 0 to 360°."
        = |at| angles_deg(at.telemetry.pose.map(f64::from))[0];
    Estimated Number tilt_deg "How far it leans, degrees."
        = |at| angles_deg(at.telemetry.pose.map(f64::from))[1];
    Estimated SingleTwo direction "Where it points: x and y of the unit vector along the leg."
        = |at| at.telemetry.pose;
    Estimated Three tip_estimated_mm "Where its tip is, mm; without meaning before homing."
        = |at| at.tip_estimated_mm;
    Reference Number azimuth_reference_deg "Where the trajectory has the leg lean now, 0 to 360°."
        = |at| angles_deg(at.telemetry.target.map(f64::from))[0];
    Reference Number tilt_reference_deg "How far, degrees."
        = |at| angles_deg(at.telemetry.target.map(f64::from))[1];
    Reference SingleTwo direction_reference "The same: x and y of the unit vector along the leg."
        = |at| at.telemetry.target;
    Reference Three tip_reference_mm "Where that has the tip, mm."
        = |at| at.tip_reference_mm;
    Measured SingleThree tensions_n "Tension of each tendon, N."
        = |at| at.telemetry.tensions_n;
    Reference SingleThree target_tensions_n "Tension that the target asks of each, N."
        = |at| at.telemetry.target_tensions_n;
    Context Two tension_bounds_n "Lowest and highest tension of the settings, N."
        = |at| at.tension_bounds_n;
    Commanded Number pretension_commanded_n "Pretension that was commanded, N; none where a stiffness was."
        = |at| at.telemetry.pretension_commanded_n.map_or(f64::NAN, decimal);
    Commanded Number stiffness_commanded_nm_per_rad "Bending stiffness that was commanded, N·m/rad; none where a pretension was."
        = |at| at.telemetry.stiffness_commanded_nm_per_rad.map_or(f64::NAN, decimal);
    Reference Single pretension_n "Pretension of the target, N; 0 before the first."
        = |at| at.telemetry.pretension_n;
    Reference Single stiffness_nm_per_rad "Bending stiffness at that pretension, N·m/rad."
        = |at| at.telemetry.stiffness_nm_per_rad;
    Estimated Number sag_m "How far the tip would sag under leg and payload without compensation, m; none without a pretension."
        = |at| at.sag_m;
    Estimated SingleTwo load_nm "Load beyond the leg's own weight, as a horizontal moment, N·m."
        = |at| at.telemetry.load_nm;
    Estimated Single payload_kg "The payload that this load would be, kg."
        = |at| at.telemetry.payload_kg;
    Measured SingleThree pulled_m "How far each tendon is pulled in since the start, by its encoder, m."
        = |at| at.telemetry.pulled_m;
    Reference SingleThree reference_m "How far each shall be, m."
        = |at| at.telemetry.reference_m;
    Estimated SingleThree unstretched_at_zero_m "Length of each without tension where its encoder counts zero, m; 0 while that is not known."
        = |at| at.telemetry.unstretched_at_zero_m;
    Estimated Single elongation_factor "Elongation of the tendons over that by the rig file, found after homing; 1 before, and where the file is right to 3 %."
        = |at| at.telemetry.elongation_factor;
    Measured SingleThree motor_currents_a "Current of each motor, A, a mean over 0.5 ms; without meaning while the drivers are off. A driver's own output that is silent reads none."
        = |at| at.telemetry.motor_currents_a;
    Measured Single supply_v "Voltage at the drivers, V."
        = |at| at.telemetry.supply_v;
    Measured Single temperature_c "Temperature of the drivers, degrees Celsius."
        = |at| at.telemetry.temperature_c;
    Estimated Single residual_m "What forward kinematics leaves over, m."
        = |at| at.telemetry.residual_m;
}
