//! What a strike may do at most.

#[cfg(test)]
mod tests;

use super::activity::Activity;
use super::naming::{DRIFTED_S, Unstruck, WANDERED_N, WANDERS_BY_N, named_s};
use leg_firmware::settings::CurrentOutput;
use leg_rig::rig_file::RigFile;
use leg_sim::plant::Defect;
use serde::Serialize;

/// How far the leg may go beyond its maximum tension, as a part of it.
const BEYOND: f64 = 0.1;

/// The same where a tendon of a moving leg is cut: it swings away, and one of the other two catches it as it comes back. Each of these has
/// stored up to 0.10 J, at 150 N on the curve of the paper's tendon; at 0.8 rad/s 2 kg at 0.19 m have 0.02 J. Where one tendon takes up
/// all of that, it is at 297 N. Nothing is driven by then: the brake has ended, and a cell without its bridge's supply shows the same.
const CUT_BEYOND: f64 = 1.0;

/// The same where two load cells change their places while the leg is driven. That is no single fault that happens by itself:
/// both plugs have to be pulled and put back, each in the other's place, within a tick; homing finds cells that have changed their
/// places before. Tensions and counters agree on another load, and the leg gives way by it and swings ever more, with up to 17 mm at the tip, until a
/// true tension is a tenth above the maximum, or a tendon is slack: that swing goes on, whatever the motors do. How far it has grown by then
/// depends on pose, load and moment, and no calculation bounds it closely: this is 3 % more than the highest that an earlier law gave, 327 N. The
/// same strike gives 197 N now (`--seed 7303`, #1377).
const SWAPPED_BEYOND: f64 = 1.25;

/// The same where a motor obeys by parts, or is counted by parts, until that is told: 180.9 N are known (`--seed 281129`, #12704).
const IN_PARTS_BEYOND: f64 = 0.25;

/// The same where the play of a gear is 1 rad of its screw at once while its motor pays out: the tendon stands for 0.16 mm, at 179 N/mm, the
/// stiffness of the paper's tendon at 150 N, while the others move the leg on.
const PLAY_BEYOND: f64 = 0.2;

/// The same where one driver pulls inwards whatever is asked, for the 5 ms and more until its counter contradicts, and is then cut
/// off.
const STUCK_BEYOND: f64 = 0.5;

/// The same where a hand holds the tip of a moving leg: its motors stretch the tendons by what the tip stays behind, until one is
/// above the maximum.
const GRASPED_BEYOND: f64 = 0.8;

/// The same where a driver gives the whole supply: at 37 mm/s of the free motor the tendon is 0.45 mm shorter before its motor
/// is far enough away to tell, and turns on by its inertia.
const RUNAWAY_BEYOND: f64 = 1.6;

/// The same where it is cleared and armed again, twice: each arm lets the motor run from where it came to rest.
const RUNAWAY_AGAIN_BEYOND: f64 = 1.8;

/// The same where a tendon slips by 5 mm and catches the leg, which has fallen by the 46 mm of the tip that belong to it: 531.8 N are known
/// (`--seed 271128`, #17437).
const SLIP_BEYOND: f64 = 3.0;

/// The same where a moving leg brakes that leaves its load out: its tensions do not take the load from its path, and it swings about where
/// it comes to rest. 165.0 N, of 135.5 N without the stop, were found by an earlier law
/// (`--seed 271128`, #10784, 162.6 N now).
const LEFT_OUT_BEYOND: f64 = 0.15;

/// The same where a cell shows the maximum tension, so that its motor gives way by it until another tendon is slack, and the leg swings: 164.2 N
/// are known (`--seed 777`, #8833).
const AT_MAX_BEYOND: f64 = 0.15;

/// The same on the way, which the other motors go on with until the cell is found wrong: 184.6 N are known (`--seed 281129`, #1511).
const AT_MAX_WAY_BEYOND: f64 = 0.25;

/// The highest tension while homing, N; and where a driver gives the whole supply then, for the 10 ms until its motor is told to run away: 40.5 N are known
/// (`--seed 281129`, #6715).
const HOMING_N: f64 = 25.0;
const HOMING_RUNAWAY_N: f64 = 42.0;

/// How far the tip may move from where it rests, and off its way, mm.
const REST_MM: f64 = 0.5;
const WAY_MM: f64 = 3.0;

/// The same of a leg that is cleared and armed again with its fault, twice, mm: each arm takes what the cell shows as right,
/// and follows its error until that changes.
const REARMED_MM: f64 = 2.0;

/// The same where a gain is 20 % off, which cannot be distinguished from a load, mm: 0.12 mm of a tendon, which is 1.1 mm at the tip of a leg
/// that hangs straight down, and more where the tendon's lever is shorter. 1.19 mm are known, at 30° (`--seed 777`, #23168).
const GAIN_MM: f64 = 1.4;

/// The same where it drifts down by that: what the cell lacks is 0.16 mm of a tendon's stretch at 70 to 150 N, on the curve of the paper's
/// tendon, by which it is pulled in; a millimetre of it is 9.2 mm at the tip. One that shows
/// 20 % more lets out 0.12 mm, 1.1 mm at the tip.
const GAIN_DOWN_MM: f64 = 1.5;

/// The same where a cell that grows, steps by 10 N or wanders comes to show the maximum tension, mm: its tendon is paid out until another is slack.
/// Known are 6.19 mm (`--seed 777`, #8833).
const GAIN_AT_MAX_MM: f64 = 7.0;

/// The same where two sensors change their places or an encoder counts the other way, mm: a controller with its sign reversed runs
/// for the time until a counter contradicts.
const SWAPPED_MM: f64 = 20.0;

/// How far a tendon that homing pulls, and whose cell or motor fails, may lift a leg that hangs free, mm: by what its motor can pull
/// below the current at which homing ends, about 20 N, which holds the leg's own weight far aside.
const LIFTED_MM: f64 = 90.0;

/// The same where its motor stops as it reels in, mm: 10 mm/s of a tendon, 92 mm/s at the tip, are 10.2 mm of a leg that swings at 9 rad/s.
const HOMING_STOPS_MM: f64 = 10.2;

/// How far a leg that is paid out may hang aside by a motor that stays behind, mm.
const ASIDE_MM: f64 = 10.0;

/// How far the tip may come down where it has to: a tendon that is cut, and one that slips by 5 mm, which is 46 mm at the tip, and
/// swings, mm.
const CUT_MM: f64 = 250.0;
const SLIP_MM: f64 = 80.0;

/// The same where the leg is armed again with it, mm: its zero is wrong by these 5 mm, so that it is led down by the 46 mm once more; near 30°
/// the tendons' levers are up to a fifth shorter. 92.7 mm were found by an earlier law (`--seed 281128`, #1911, 54.7 mm now).
const SLIP_AGAIN_MM: f64 = 110.0;

/// The same where a tendon grows longer unseen, by 0.1 mm or 0.9 mm of the tip in a second, mm.
const CREEP_MM: f64 = 4.0;

/// The same where a driver runs away until it is cut off, once and where it is armed again, and where a motor turns without being
/// counted, mm.
const RUNAWAY_MM: f64 = 35.0;
const RUNAWAY_AGAIN_MM: f64 = 45.0;
const UNCOUNTED_MM: f64 = 1.2;

/// How far a leg goes off its way one of whose motors obeys by parts, or is counted by parts, until that is told, mm: 4.27 mm are known
/// (`--seed 271129`, #16298).
const IN_PARTS_MM: f64 = 5.0;

/// The same where a hand holds the tip that should move, with 5 N for each millimetre, mm: the leg gives way by its stiffness.
const GRASPED_MM: f64 = 10.0;

/// The bars of one strike.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StrikeBars {
    /// Highest tension, N.
    pub tension_n: f64,
    /// The same while homing, and after a fault that ended that, N.
    pub homing_n: f64,
    /// How far the tip may go, mm.
    pub tip_mm: f64,
    /// When a fault has to be named, s; none where nothing shows it.
    pub named_s: Option<f64>,
    /// Whether the tip may sag once a tension that truly is beyond its bar has the leg ramp down: with two cells that changed their
    /// places it swings ever more, and its tendons have to be paid out.
    pub sags: bool,
    /// Whether it may also do what a leg whose motors stop at once does, and a little more: see `cut_off.rs`.
    pub cut_off: bool,
}

impl StrikeBars {
    /// The widest of a defect, for a page: those of a leg that pulls and goes as far as it may, and of one that is near its
    /// maximum tension or not.
    #[must_use]
    pub fn widest(defect: Defect, activity: Activity, f_max_n: f64, near_maximum: bool) -> Self {
        let part = if near_maximum { 1.0 } else { 0.5 };
        let before = Unstruck {
            tensions_n: [0.2, 0.6, 1.0].map(|share| share * part * f_max_n),
            highest_n: [part * f_max_n; 3],
            travels_m: [1.0; 3],
        };
        Self::new(Some(defect), activity, f_max_n, &before)
    }

    /// Of a defect of a leg with a maximum tension, N.
    pub(super) fn new(
        defect: Option<Defect>,
        activity: Activity,
        f_max_n: f64,
        before: &Unstruck,
    ) -> Self {
        let on_the_way = activity.is_on_the_way();
        let at_max = defect.is_some_and(|defect| {
            let found = matches!(defect, Defect::CellGainStep(_)) && !on_the_way;
            !found && shows_maximum(defect, f_max_n, before.highest_n)
        });
        let (stopped_part, paid_out_mm) = match (at_max, on_the_way) {
            (true, true) => (AT_MAX_WAY_BEYOND, GAIN_AT_MAX_MM),
            (true, false) => (AT_MAX_BEYOND, GAIN_AT_MAX_MM),
            (false, _) => (0.0, 0.0),
        };
        let steps = matches!(
            defect,
            Some(Defect::CellGainStep(_) | Defect::CellOffsetStep(_))
        );
        let cuts_off = defect.is_some_and(|defect| cuts_off(defect) && !is_slow(defect, activity));
        Self {
            tension_n: f_max_n * (1.0 + excess_part(defect, activity).max(stopped_part)),
            homing_n: if matches!(defect, Some(Defect::DriverFullOn(_))) {
                HOMING_RUNAWAY_N
            } else {
                HOMING_N
            },
            tip_mm: tip_mm(defect, activity).max(paid_out_mm),
            named_s: defect.and_then(|defect| named_s(defect, activity, before)),
            sags: defect == Some(Defect::CellsSwapped),
            // Others come to that later.
            cut_off: on_the_way && (at_max && steps || cuts_off),
        }
    }

    /// Those of a moving leg that leaves its load out.
    pub(super) fn leave_load_out(self, f_max_n: f64) -> Self {
        Self {
            tension_n: self.tension_n.max(f_max_n * (1.0 + LEFT_OUT_BEYOND)),
            ..self
        }
    }
}

/// How far the leg may go beyond its maximum tension, as a part of it.
fn excess_part(defect: Option<Defect>, activity: Activity) -> f64 {
    match defect {
        Some(Defect::DriverFullOn(_)) if activity == Activity::Rearmed => RUNAWAY_AGAIN_BEYOND,
        Some(Defect::DriverFullOn(_)) => RUNAWAY_BEYOND,
        Some(Defect::TendonSlips(_)) => SLIP_BEYOND,
        Some(Defect::DirectionStuck(_)) => STUCK_BEYOND,
        Some(Defect::LegGrasped) => GRASPED_BEYOND,
        Some(Defect::CellsSwapped)
            if matches!(
                activity,
                Activity::Homing | Activity::Held | Activity::Disarmed
            ) =>
        {
            BEYOND
        }
        Some(Defect::CellsSwapped) => SWAPPED_BEYOND,
        Some(Defect::TendonCut(_))
            if matches!(activity, Activity::Moving | Activity::RampingDown) =>
        {
            CUT_BEYOND
        }
        Some(Defect::GearPlay(_)) if activity.is_on_the_way() => PLAY_BEYOND,
        Some(defect) if obeys_in_parts(defect, activity) => IN_PARTS_BEYOND,
        _ => BEYOND,
    }
}

/// Whether a moving leg cannot be braked: a motor, its driver or its encoder is not to be relied on.
const fn cuts_off(defect: Defect) -> bool {
    matches!(
        defect,
        Defect::DriverFault(_)
            | Defect::DirectionStuck(_)
            | Defect::HalfBridgeOpen(_)
            | Defect::HalfBridgeOpenOutwards(_)
            | Defect::MotorIntermittent(_)
            | Defect::MotorJammed(_)
            | Defect::ScrewDry(_)
            | Defect::CurrentOffset(_)
            | Defect::CurrentFullScale(_)
            | Defect::CurrentDead(_)
            | Defect::EncoderLost(_)
            | Defect::EncoderReversed(_)
            | Defect::EncoderSlipping(_)
            | Defect::EncoderJumps(_)
            | Defect::EncoderSlipsQuarter(_)
            | Defect::EncodersSwapped
            // A board finds that at its start alone; a simulated leg is cut off by it on its way, too.
            | Defect::SettingsCorrupt
    )
}

/// Whether what fails is cut off on a way that is too slow to swing on from. A leg that is led down before its tendons are paid out
/// is as fast as one that moves.
const fn is_slow(defect: Defect, activity: Activity) -> bool {
    let slow = matches!(activity, Activity::Homing | Activity::Arming);
    slow && matches!(
        defect,
        Defect::CurrentFullScale(_)
            | Defect::CurrentZero(_)
            | Defect::EncoderJumps(_)
            | Defect::HalfBridgeOpen(_)
    )
}

/// Whether a motor of a leg on its way does a part of what it is asked, or is counted for a part of it.
const fn obeys_in_parts(defect: Defect, activity: Activity) -> bool {
    let in_parts = matches!(
        defect,
        Defect::EncoderJumps(_)
            | Defect::EncoderLost(_)
            | Defect::EncoderSlipping(_)
            | Defect::HalfBridgeOpen(_)
            | Defect::MotorIntermittent(_)
    );
    in_parts && activity.is_on_the_way() && !is_slow(defect, activity)
}

/// Whether what fails moves a leg that homes or is paid out no farther than one on its way.
const fn is_harmless(defect: Defect) -> bool {
    matches!(
        defect,
        Defect::CellHum(_)
            | Defect::CellGainStep(_)
            | Defect::CurrentFullScaleDisabled(_)
            | Defect::CurrentZero(_)
            | Defect::HalfBridgeOpen(_)
            | Defect::SupplyDip
    )
}

/// Whether a cell shows so little that it is found at once, whatever the leg does but homing.
const fn is_found_at_once(defect: Defect) -> bool {
    matches!(
        defect,
        Defect::CellExcitationLost(_)
            | Defect::CellFades(_)
            | Defect::CellFollows(_)
            | Defect::EncoderJumps(_)
    )
}

/// Whether a cell that is wrong comes to show the maximum tension.
fn shows_maximum(defect: Defect, f_max_n: f64, highest_n: [f64; 3]) -> bool {
    let shows_n = match defect {
        Defect::CellGainStep(i) | Defect::CellGainDrift(i) => 1.2 * highest_n[i],
        // 5 N in a second.
        Defect::CellDrifting(i) => highest_n[i] + 5.0 * DRIFTED_S,
        Defect::CellOffsetStep(i) => highest_n[i] + 10.0,
        Defect::CellWanders(i) => highest_n[i] + WANDERS_BY_N + WANDERED_N,
        _ => return false,
    };
    shows_n > f_max_n
}

/// How far the tip may go, mm.
fn tip_mm(defect: Option<Defect>, activity: Activity) -> f64 {
    let usual_mm = match activity {
        Activity::Homing if defect.is_some_and(|defect| !is_harmless(defect)) => LIFTED_MM,
        Activity::RampingDown
            if defect.is_some_and(|defect| is_harmless(defect) || is_found_at_once(defect)) =>
        {
            WAY_MM
        }
        Activity::Rearmed if defect.is_some_and(is_found_at_once) => REST_MM,
        Activity::RampingDown if defect.is_some() => ASIDE_MM,
        Activity::Rearmed if defect.is_some() => REARMED_MM,
        Activity::Homing
            if matches!(defect, Some(Defect::SupplyDip | Defect::HalfBridgeOpen(_))) =>
        {
            HOMING_STOPS_MM
        }
        _ if activity.is_on_the_way() => WAY_MM,
        _ => REST_MM,
    };
    let least_mm = match defect {
        Some(Defect::TendonCut(_)) => CUT_MM,
        Some(Defect::TendonSlips(_)) if activity == Activity::Rearmed => SLIP_AGAIN_MM,
        Some(Defect::TendonSlips(_)) => SLIP_MM,
        Some(Defect::TendonCreeps(_)) => CREEP_MM,
        Some(Defect::DriverFullOn(_)) if activity == Activity::Rearmed => RUNAWAY_AGAIN_MM,
        Some(Defect::DriverFullOn(_) | Defect::DirectionStuck(_)) => RUNAWAY_MM,
        Some(defect) if obeys_in_parts(defect, activity) => IN_PARTS_MM,
        Some(Defect::EncoderLost(_)) => UNCOUNTED_MM,
        Some(Defect::LegGrasped) => GRASPED_MM,
        Some(Defect::CellsSwapped | Defect::EncodersSwapped | Defect::EncoderReversed(_)) => {
            SWAPPED_MM
        }
        Some(Defect::CellWanders(_))
            if matches!(activity, Activity::Following | Activity::Held) =>
        {
            usual_mm
        }
        Some(
            Defect::CellGainStep(_)
            | Defect::CellGainStepDown(_)
            | Defect::CellGainDrift(_)
            | Defect::CellCrosstalk(_)
            | Defect::CellWanders(_)
            | Defect::CellDrifting(_)
            | Defect::ExcitationSags,
        ) => GAIN_MM,
        Some(Defect::CellGainDriftDown(_)) => GAIN_DOWN_MM,
        _ => usual_mm,
    };
    usual_mm.max(least_mm)
}

/// The defect that a current output shows in the same way: where code 0 is no current, or nearly none, an output that is dead reads none.
pub(super) fn shown_as(defect: Defect, file: &RigFile) -> Defect {
    match defect {
        Defect::CurrentDead(i)
            if file.actuators[i].current_output != CurrentOutput::Bidirectional =>
        {
            Defect::CurrentZero(i)
        }
        other => other,
    }
}
