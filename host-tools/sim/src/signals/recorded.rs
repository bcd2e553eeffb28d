//! What a board's recorder kept of a tick.

use super::{Origin, Signal, Values, fault_names, signals};
use leg_base::description;
use leg_base::recorder_rows::RecorderRow;
use leg_base::tick_time::{seconds, tick_s};
use leg_firmware::settings::RecordedSignal;
use leg_firmware::supervisor::{FaultSet, State};

/// What is not there is not a number.
fn three(row: &RecorderRow, signal: RecordedSignal) -> [f64; 3] {
    row.get(signal).unwrap_or([f64::NAN; 3])
}

/// Time since the fault, s; not a number where a host has ended the recording.
fn fault_age_s(row: &RecorderRow) -> f64 {
    row.ticks_since_fault()
        .map_or(f64::NAN, |ticks| f64::from(ticks) * tick_s())
}

signals! {
    /// What the recorder keeps of a tick. What the settings do not choose is not known.
    RECORDER_SIGNALS of RecorderRow;
    Context Number time_s "Time of the leg since its board started, s."
        = |at| seconds(at.tick.into());
    Context Count tick "The same in ticks."
        = |at| Some(at.tick.into());
    Context Number since_fault_s "Time since the fault that ended the recording, s; none where a host did."
        = fault_age_s;
    Context Names fault_names "Names of the faults that stopped the leg in the tick of that fault."
        = |at| fault_names(at.fault.map_or(FaultSet::NONE, |fault| fault.faults));
    State Word state "What the leg may do; empty if it was not recorded."
        = |at| at.state().map_or("", description::state);
    State Count state_index "The same as a number: the place among the names of the states."
        = |at| at.state().and_then(|state| State::ALL.iter().position(|each| *each == state)).map(|index| index as u64);
    Measured Three tensions_n "Tension of each tendon, N."
        = |at| three(at, RecordedSignal::Tensions);
    Reference Three target_tensions_n "Tension that the target asks of each, N."
        = |at| three(at, RecordedSignal::TargetTensions);
    Measured Three pulled_m "How far each tendon is pulled in since the start, by its encoder, m."
        = |at| three(at, RecordedSignal::Pulled);
    Reference Three reference_m "How far each shall be, m."
        = |at| three(at, RecordedSignal::References);
    Measured Three motor_currents_a "Current of each motor, A."
        = |at| three(at, RecordedSignal::Currents);
    Commanded Three duties "What is asked for each motor, as a part of the supply's voltage, -1 to 1."
        = |at| three(at, RecordedSignal::Duties);
    Estimated Two direction "Where the leg points: x and y of the unit vector along it."
        = |at| { let [x, y, _] = three(at, RecordedSignal::Pose); [x, y] };
    Estimated Number residual_m "What forward kinematics leaves over, m."
        = |at| three(at, RecordedSignal::Pose)[2];
    Measured Number supply_v "Voltage at the drivers, V."
        = |at| three(at, RecordedSignal::Board)[0];
    Measured Number temperature_c "Temperature of the drivers, degrees Celsius."
        = |at| three(at, RecordedSignal::Board)[1];
}
