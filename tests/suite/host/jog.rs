//! A jog of one motor: it ends by a name, within bounds, with the motor off, whatever is wrong with the leg.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod refusals;

use leg_firmware::jog::{JogDemand, JogDrive, JogEnd, JogReport};
use leg_firmware::supervisor::{Fault, State};
use leg_firmware::telemetry::Telemetry;
use leg_host::cancel_flag::CancelFlag;
use leg_host::jog_report::{findings, slow_voltage_v};
use leg_host::operator::{HostIdentity, Operator};
use leg_host::transport::emulated::EmulatedLine;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::link::InProcess;
use leg_sim::plant::Defect;

/// The paper's leg with a few more lines in its rig file, and its host.
fn leg(initial: InitialState) -> (EmulatedLine, Operator) {
    leg_of(&RigFile::load(None).unwrap(), initial)
}

fn leg_of(rig: &RigFile, initial: InitialState) -> (EmulatedLine, Operator) {
    let leg = EmulatedLeg::new(rig, initial, Box::new(InProcess::new())).unwrap();
    let line = EmulatedLine::new(leg, "the leg");
    let host = Box::new(line.connect());
    let operator = Operator::open(host, HostIdentity::FIXED, CancelFlag::default()).unwrap();
    (line, operator)
}

fn demand(operator: &mut Operator, motor: u8, travel_mm: f32) -> JogDemand {
    JogDemand {
        motor,
        travel_m: travel_mm / 1000.0,
        drive: JogDrive::Voltage(slow_voltage_v(motor, &operator.settings().unwrap())),
    }
}

/// What a jog of a slack leg saw, the first finding, the leg after it, and the farthest and the hardest that the true leg went:
/// mm and N.
struct Seen {
    report: JogReport<f32>,
    finding: String,
    telemetry: Telemetry<f32>,
    moved_mm: f64,
    tension_n: f64,
}

fn jog(defects: &[Defect], travel_mm: f32) -> Seen {
    let (line, mut operator) = leg(InitialState::Slack);
    let before = line.with_plant(|plant| {
        for &defect in defects {
            plant.set_defect(defect, true);
        }
        plant.truth().unstretched_m
    });
    let demand = demand(&mut operator, 1, travel_mm);
    let (report, telemetry) = operator.jog(&demand).unwrap();
    operator
        .pause(std::time::Duration::from_millis(300))
        .unwrap();
    let truth = line.with_plant(|plant| plant.truth());
    let settings = operator.settings().unwrap();
    let finding = findings(&report, &settings);
    let moves = truth.unstretched_m.iter().zip(before);
    Seen {
        report,
        finding: finding
            .iter()
            .map(|found| found.what.as_str())
            .collect::<Vec<_>>()
            .join("; "),
        telemetry,
        moved_mm: moves
            .map(|(now, before)| 1000.0 * (now - before).abs())
            .fold(0.0, f64::max),
        tension_n: truth.tensions_n.into_iter().fold(0.0, f64::max),
    }
}

#[test]
fn a_jog_goes_as_far_as_it_was_asked_both_ways_and_ends_disarmed() {
    for travel_mm in [1.0, -2.0, 0.2, 2.5] {
        let seen = jog(&[], travel_mm);
        assert_eq!(seen.report.end, JogEnd::Arrived, "{travel_mm}");
        assert_eq!(seen.finding, "");
        assert_eq!(seen.telemetry.state, State::Disarmed);
        let pulled_mm = 1000.0 * seen.report.pulled_m[0];
        assert!(
            (pulled_mm - travel_mm).abs() < 0.05,
            "{travel_mm} {pulled_mm}"
        );
        assert!((0.02..0.08).contains(&seen.report.current_a.abs()));
        assert_eq!(seen.report.pulled_m[1..], [0.0; 2]);
    }
}

/// Reeled in from slack, the tendon comes to pull: its own load cell tells, and the jog ends where homing would.
#[test]
fn a_jog_into_a_taut_tendon_ends_by_its_load_cell() {
    let seen = jog(&[], 10.0);
    assert_eq!(seen.report.end, JogEnd::Tension(1), "{:?}", seen.report);
    assert_eq!(seen.telemetry.state, State::Disarmed);
    assert!(seen.tension_n < 20.0, "{}", seen.tension_n);
}

/// Defects, travel, end, fault, words, and the bounds in mm and N.
type Case<'a> = (&'a [Defect], f32, JogEnd, Option<Fault>, &'a str, [f64; 2]);

/// A leg whose wires are wrong: how the jog ends, the fault where one ends it, words of the finding; never farther, mm, and never
/// harder, N, than given.
#[test]
fn a_jog_of_a_leg_with_a_mistake_ends_by_its_name_and_within_bounds() {
    use Defect as D;
    let disagrees = Some(Fault::CurrentDisagrees);
    let follows = [D::CellFollows(0), D::CellFollows(1), D::CellFollows(2)];
    // From slack: 3 mm, then 7 mm that only lean the leg.
    let (near, far) = (2.0, 10.0);
    let cases: [Case<'_>; 10] = [
        (
            &[D::MotorJammed(0)],
            near,
            JogEnd::NoCounts,
            None,
            "does not turn",
            [0.01, 3.0],
        ),
        (
            &[D::ScrewDry(0)],
            near,
            JogEnd::NoCounts,
            None,
            "does not turn",
            [0.01, 3.0],
        ),
        (
            &[D::EncoderLost(0)],
            near,
            JogEnd::CutOff,
            disagrees,
            "counts nothing",
            [0.3, 3.0],
        ),
        (
            &[D::HalfBridgeOpen(0)],
            near,
            JogEnd::CutOff,
            disagrees,
            "draws no current",
            [0.01, 3.0],
        ),
        (
            &[D::EncodersSwapped],
            near,
            JogEnd::OtherEncoder(2),
            None,
            "encoder 2 counted",
            [0.3, 3.0],
        ),
        (
            &[D::EncoderReversed(0)],
            near,
            JogEnd::WrongWay,
            None,
            "wrong way",
            [0.3, 3.0],
        ),
        (
            &[D::CellReversed(0)],
            far,
            JogEnd::Arrived,
            None,
            "shows less",
            [10.1, 25.0],
        ),
        (
            &[D::CellExcitationLost(0)],
            far,
            JogEnd::Arrived,
            None,
            "",
            [10.1, 25.0],
        ),
        (
            &follows,
            far,
            JogEnd::Tension(3),
            None,
            "cell 3 shows what tendon 1",
            [10.1, 25.0],
        ),
        (
            &[D::TendonCut(0)],
            far,
            JogEnd::Arrived,
            None,
            "",
            [10.1, 3.0],
        ),
    ];
    for (defects, travel_mm, end, fault, words, [farthest_mm, hardest_n]) in cases {
        let seen = jog(defects, travel_mm);
        println!(
            "{defects:?}: {:?}, {:?}, {}, {:.3} mm, {:.1} N",
            seen.report, seen.telemetry.faults, seen.finding, seen.moved_mm, seen.tension_n
        );
        assert_eq!(seen.report.end, end, "{defects:?}");
        let faults = seen.telemetry.faults;
        assert_eq!(fault.is_some(), faults.any(), "{defects:?} {faults:?}");
        assert!(
            fault.is_none_or(|fault| faults.has(fault)),
            "{defects:?} {faults:?}"
        );
        assert_eq!(
            seen.finding.is_empty(),
            words.is_empty(),
            "{defects:?} {}",
            seen.finding
        );
        assert!(seen.finding.contains(words), "{defects:?} {}", seen.finding);
        let off = if fault.is_some() {
            State::Off
        } else {
            State::Disarmed
        };
        assert_eq!(seen.telemetry.state, off, "{defects:?}");
        assert!(
            seen.moved_mm <= farthest_mm,
            "{defects:?} {} mm",
            seen.moved_mm
        );
        assert!(
            seen.tension_n <= hardest_n,
            "{defects:?} {} N",
            seen.tension_n
        );
    }
}

/// A motor with swapped wires pays a taut tendon out: its load cell is not to blame.
#[test]
fn a_motor_that_turns_the_other_way_says_nothing_of_the_load_cells() {
    let settings = leg(InitialState::Homed).1.settings().unwrap();
    for (end, count) in [
        (JogEnd::WrongWay, 1),
        (JogEnd::OtherEncoder(2), 1),
        (JogEnd::Arrived, 1),
        (JogEnd::Tension(1), 2),
    ] {
        let report = JogReport {
            demand: JogDemand {
                motor: 1,
                travel_m: 1e-3,
                drive: JogDrive::Voltage(1.8),
            },
            end,
            time_s: 0.3,
            pulled_m: [-3e-5, 0.0, 0.0],
            tensions_n: [[12.0, 12.0, 12.0], [8.0, 11.5, 11.5]],
            steady_s: 0.1,
            current_a: 0.1,
            speed_m_per_s: 2e-3,
            tension_n: 10.0,
            servo: None,
        };
        let found = findings(&report, &settings);
        assert_eq!(found.len(), count, "{end:?}: {found:?}");
    }
}

/// Nothing is wrong with the motor.
#[test]
fn a_voltage_that_friction_takes_is_named_with_one_that_would_do() {
    let (_line, mut operator) = leg(InitialState::Slack);
    let settings = operator.settings().unwrap();
    let demand = JogDemand {
        drive: JogDrive::Voltage(0.1),
        ..demand(&mut operator, 1, 2.0)
    };
    let (report, _) = operator.jog(&demand).unwrap();
    let found = findings(&report, &settings);
    assert_eq!(
        found[0].what,
        "0.10 V do not turn motor 1: less than its friction takes"
    );
    assert_eq!(
        found[0].remedy,
        format!("give {:.1} V", slow_voltage_v(1, &settings))
    );
}

/// Load cells that show next to nothing: the current ends the jog, before the tension is too high.
#[test]
fn without_its_load_cell_the_current_ends_a_jog() {
    let (line, mut operator) = leg(InitialState::Homed);
    let mut settings = operator.settings().unwrap();
    for axis in &mut settings.axes {
        axis.cell_n_per_code *= 0.01;
    }
    operator.set_settings(&settings).unwrap();
    let demand = JogDemand {
        drive: JogDrive::Voltage(4.6),
        ..demand(&mut operator, 1, 10.0)
    };
    let (report, telemetry) = operator.jog(&demand).unwrap();
    assert_eq!(report.end, JogEnd::Current, "{report:?}");
    assert_eq!(telemetry.state, State::Disarmed);
    let tension_n = line.with_plant(|plant| plant.truth().tensions_n[0]);
    assert!(tension_n < 80.0, "{tension_n}");
}

/// An output that is silent at the voltage of the jog: a ceiling of the current that the voltage drives ends it, here before the motor has turned
/// at all. Without the ceiling it pulled for 5.7 s, up to 167 N.
#[test]
fn without_its_load_cell_a_jog_at_an_output_that_is_silent_ends_in_time() {
    let more = "[actuator]\ncurrent_output = \"magnitude_when_driven\"\n";
    let rig = RigFile::parse("silent", &[READY_RIGS[0].text, more].concat()).unwrap();
    let (line, mut operator) = leg_of(&rig, InitialState::Homed);
    let mut settings = operator.settings().unwrap();
    for axis in &mut settings.axes {
        axis.cell_n_per_code *= 0.01;
    }
    operator.set_settings(&settings).unwrap();
    // A tenth of the supply is 2.4 V.
    let demand = JogDemand {
        drive: JogDrive::Voltage(2.3),
        ..demand(&mut operator, 1, 10.0)
    };
    let (report, telemetry) = operator.jog(&demand).unwrap();
    let tension_n = line.with_plant(|plant| plant.truth().tensions_n[0]);
    assert_eq!(report.end, JogEnd::NoCounts, "{report:?}");
    assert!(report.time_s < 0.1, "{report:?}");
    assert_eq!(telemetry.state, State::Disarmed);
    assert!(tension_n < 80.0, "{tension_n}");
}

/// A tendon that pulls is not pulled harder, but may be paid out.
#[test]
fn a_taut_tendon_is_paid_out_alone() {
    for (travel_mm, end) in [(1.0, JogEnd::Tension(1)), (-0.5, JogEnd::Arrived)] {
        let (line, mut operator) = leg(InitialState::Homed);
        let demand = demand(&mut operator, 1, travel_mm);
        let (report, telemetry) = operator.jog(&demand).unwrap();
        assert_eq!(
            (report.end, telemetry.state),
            (end, State::Disarmed),
            "{report:?}"
        );
        let highest_n =
            line.with_plant(|plant| plant.truth().tensions_n.into_iter().fold(0.0, f64::max));
        assert!(highest_n < 75.0, "{highest_n}");
    }
}
