//! `leg follow` with tensions that a leg cannot reach.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::timed_path::{PathRow, TimedPath};
use leg_firmware::set_point::StreamTension;
use leg_host::cancel_flag::CancelFlag;
use leg_host::operator::{HostIdentity, Operator, OperatorError};
use leg_host::path_reader::{PathReader, PathSource};
use leg_host::transport::emulated::EmulatedLine;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{EmulatedLeg, InitialState};
use leg_sim::link::InProcess;
use std::time::Duration;

fn operator() -> Operator {
    let rig = RigFile::load(None).unwrap();
    let link = Box::new(InProcess::new());
    let leg = EmulatedLeg::new(&rig, InitialState::Homed, link).unwrap();
    let line = EmulatedLine::new(leg, "the leg");
    let host = Box::new(line.connect());
    Operator::open(host, HostIdentity::FIXED, CancelFlag::default()).unwrap()
}

/// Leans to 10° and back in 4 s, with these pretensions in the middle and at the end, N.
fn rows(middle_n: f32, end_n: f32) -> Vec<PathRow> {
    let row = |i: u32| {
        let part = f64::from(i) / 40.0;
        let tension = match i {
            10 => Some(StreamTension::Pretension(middle_n)),
            28 => Some(StreamTension::Pretension(end_n)),
            _ => None,
        };
        PathRow {
            tension,
            ..PathRow::from_angles(
                4.0 * part,
                30.0,
                10.0 * (std::f64::consts::PI * part).sin().powi(2),
            )
        }
    };
    (0..=40).map(row).collect()
}

/// It is held at the bound, and the path goes on; what is still out of reach at the end is an error by name.
#[test]
fn a_tension_out_of_reach_ends_no_path() {
    let lead = Duration::from_millis(200);
    for (end_n, reached) in [(70.0, true), (300.0, false)] {
        let path = TimedPath::new(&rows(300.0, end_n));
        let followed = operator().follow_whole(&path, lead);
        match followed {
            Ok(telemetry) => {
                assert!(reached);
                assert!((f64::from(telemetry.pretension_n) - 70.0).abs() < 0.5);
            }
            Err(OperatorError::Limited(..)) => assert!(!reached),
            Err(error) => panic!("{error}"),
        }
    }
}

/// The same of rows that come from a program.
#[test]
fn a_tension_out_of_reach_ends_no_stream() {
    let mut text = "time_s,azimuth_deg,tilt_deg,pretension_n\n".to_owned();
    for row in rows(300.0, 70.0) {
        let tilt_deg = row.direction[0].hypot(row.direction[1]).asin().to_degrees();
        let pretension = match row.tension {
            Some(StreamTension::Pretension(n)) => n.to_string(),
            _ => String::new(),
        };
        text += &format!("{},30,{tilt_deg:.6},{pretension}\n", row.time_s);
    }
    let reader = PathReader::new(std::io::Cursor::new(text), "the path");
    let mut source = PathSource::live(reader);
    let followed = operator().follow(&mut source, Duration::from_millis(200));
    assert!(followed.is_ok(), "{}", followed.unwrap_err());
}
