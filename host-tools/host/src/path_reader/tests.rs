#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::{PathReader, PathSource, PathStep};
use leg_base::failure::Failure;
use leg_firmware::set_point::StreamTension;
use std::fs::File;
use std::io::BufReader;

fn rows(text: &'static str) -> Result<Vec<f64>, Failure> {
    let mut reader = PathReader::new(text.as_bytes(), "path.csv");
    let mut times_s = Vec::new();
    while let Some(row) = reader.next_row()? {
        times_s.push(row.time_s);
    }
    Ok(times_s)
}

#[test]
fn rows_are_read_in_any_order_of_the_columns() {
    let text = "tilt_deg, azimuth_deg ,time_s\n\n20,45,0\n21 , 46,0.5\n";
    assert_eq!(rows(text), Ok(vec![0.0, 0.5]));
}

/// A cell that is empty asks for nothing.
#[test]
fn a_row_may_ask_for_a_pretension_or_a_stiffness() {
    let text = "time_s,azimuth_deg,tilt_deg,pretension_n,stiffness_nm_per_rad\n\
                0,0,1,60,\n1,0,1,,\n2,0,1,,50\n";
    let mut reader = PathReader::new(text.as_bytes(), "path.csv");
    for tension in [
        Some(StreamTension::Pretension(60.0)),
        None,
        Some(StreamTension::Stiffness(50.0)),
    ] {
        let row = reader.next_row().map(|row| row.map(|row| row.tension));
        assert_eq!(row, Ok(Some(tension)));
    }
}

/// Of a cell that is no text, too, line and column are those of the file; what cannot be read at all has none.
#[test]
fn what_is_no_text_is_refused_at_its_place() {
    let text: &[u8] = b"time_s,azimuth_deg,tilt_deg\n0,0,1\n1,\xff,1\n";
    let mut reader = PathReader::new(text, "path.csv");
    reader.next_row().unwrap();
    let told = reader.next_row().unwrap_err().to_string();
    assert!(
        told.contains("path.csv, line 3: column 2 is no UTF-8"),
        "{told}"
    );
    let directory = BufReader::new(File::open(env!("CARGO_MANIFEST_DIR")).unwrap());
    let told = PathReader::new(directory, "here").next_row().unwrap_err();
    let told = told.to_string();
    assert!(told.contains("cannot read here: "), "{told}");
}

#[test]
fn what_is_wrong_with_a_row_is_said_with_its_line() {
    for (text, expected) in [
        ("0,0,0\n", "line 1: the header has no column time_s"),
        (
            "time_s,azimuth_deg\n",
            "line 1: the header has no column tilt_deg",
        ),
        (
            "time_s,azimuth_deg,tilt_deg\n0,0\n",
            "line 2: 2 columns, and the header has 3",
        ),
        (
            "time_s,azimuth_deg,tilt_deg\n0,0,x\n",
            "line 2: column 3, tilt_deg: `x` is no number",
        ),
        (
            "time_s,azimuth_deg,tilt_deg\n0,0,NaN\n",
            "line 2: tilt_deg = NaN is not from -90 to 90",
        ),
        (
            "time_s,azimuth_deg,tilt_deg\n0,0,1\n0,0,2\n",
            "line 3: time_s = 0 is not after 0",
        ),
        (
            "time_s,azimuth_deg,tilt_deg,pretension_n\n0,0,1,-1\n",
            "line 2: pretension_n = -1 is not from 0 to 100000",
        ),
        (
            "time_s,azimuth_deg,tilt_deg,stiffness_nm_per_rad\n0,0,1,0\n",
            "line 2: stiffness_nm_per_rad = 0 is not from 0.001 to 1000000",
        ),
        (
            "time_s,azimuth_deg,tilt_deg,pretension_n,stiffness_nm_per_rad\n0,0,1,70,50\n",
            "line 2: it gives both pretension_n and stiffness_nm_per_rad",
        ),
        (
            "time_s,azimuth_deg,tilt_deg\n,0,1\n",
            "line 2: column 1, time_s: `` is no number",
        ),
        (
            "\ntime_s,azimuth_deg,tilt_deg,force_n\n0,0,1,2\n",
            "path.csv, line 2: column 4, `force_n`, is not known",
        ),
        (
            "time_s,azimuth_deg,tilt_deg,time_s\n0,0,1,2\n",
            "line 1: column 4, time_s, is there twice",
        ),
    ] {
        let refusal = rows(text).err().map(|failure| failure.to_string());
        let refusal = refusal.unwrap_or_default();
        assert!(refusal.contains(expected), "{text}: {refusal}");
    }
}

#[test]
fn a_program_s_rows_become_points_as_they_come() {
    let text = "time_s,azimuth_deg,tilt_deg\n0,0,1\n1,0,2\n2,0,3\n3,0,4\n";
    let mut source = PathSource::live(PathReader::new(text.as_bytes(), "standard input"));
    let mut times_s = Vec::new();
    loop {
        match source.next_step() {
            Ok(PathStep::Point(point)) => times_s.push(point.time_s),
            Ok(PathStep::Wait) => std::thread::yield_now(),
            Ok(PathStep::End) => break,
            Err(failure) => panic!("{failure}"),
        }
    }
    assert_eq!(times_s, [0.0, 1.0, 2.0, 3.0]);
}
