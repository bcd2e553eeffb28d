//! What the leg tells of itself, once and again and again, and a line that is full.

use super::{Heard, Line, ONE};
use crate::command::Command;
use crate::frame::MAX_FRAME;
use crate::host_link::outbox::ROOM;
use crate::host_link::{HostReply, HostRequest};
use crate::sensors::{CurrentZero, SensorReading, Sensors};

/// Number and tick of each telemetry, all of which come unasked.
fn told(heard: &Heard) -> Vec<(u32, u32)> {
    let told = heard.iter().map(|(number, reply)| match reply {
        HostReply::Telemetry(told) if *number == 0 => (told.number, told.telemetry.tick),
        other => panic!("{number}: {other:?}"),
    });
    told.collect()
}

fn streaming(every_ticks: u16) -> Line {
    let mut line = Line::identified();
    assert_eq!(line.ask(&HostRequest::Stream(every_ticks)), HostReply::Done);
    line
}

/// More telemetry than a line holds.
const MANY: u32 = 100;

/// A line on which telemetry finds no more room.
fn full() -> Line {
    let mut line = streaming(1);
    (0..MANY).for_each(|_| line.tick());
    line
}

#[test]
fn what_the_sensors_read_is_told() {
    let mut line = Line::identified();
    line.leg.sensors = SensorReading {
        codes: Sensors {
            encoder_counts: [1, 2, 3],
            emergency_stop: true,
            ..Sensors::default()
        },
        current_zeros: [
            CurrentZero::NotFound,
            CurrentZero::Found(32_800.0),
            CurrentZero::Refused(65_520.0),
        ],
    };
    let sensors = line.leg.sensors;
    assert_eq!(line.ask(&HostRequest::Sensors), HostReply::Sensors(sensors));
}

#[test]
fn telemetry_is_told_once_when_it_is_asked_for_once() {
    let mut line = Line::identified();
    line.tick();
    assert_eq!(line.heard(), []);
    let HostReply::Telemetry(told) = line.ask(&HostRequest::Telemetry) else {
        panic!("no telemetry")
    };
    assert_eq!((told.number, told.telemetry.tick), (0, 1));
    line.tick();
    assert_eq!(line.heard(), []);
}

#[test]
fn a_stream_tells_every_so_many_ticks_and_counts() {
    let mut line = streaming(5);
    (0..20).for_each(|_| line.tick());
    assert_eq!(told(&line.heard()), [(1, 5), (2, 10), (3, 15), (4, 20)]);
}

#[test]
fn a_stream_goes_on_where_the_count_of_the_ticks_wraps() {
    let mut line = streaming(2);
    line.leg.tick = u32::MAX - 2;
    (0..4).for_each(|_| line.tick());
    let ticks: Vec<u32> = told(&line.heard()).iter().map(|(_, tick)| *tick).collect();
    assert_eq!(ticks, [u32::MAX - 1, 0]);
}

/// New settings start the count of the ticks again.
#[test]
fn a_stream_goes_on_when_the_leg_starts_again() {
    let mut line = streaming(5);
    (0..13).for_each(|_| line.tick());
    line.leg.tick = 0;
    (0..6).for_each(|_| line.tick());
    assert_eq!(told(&line.heard()), [(1, 5), (2, 10), (3, 1), (4, 6)]);
}

/// A report may come more seldom than a tick, and tells the last of them only.
#[test]
fn a_tick_is_told_once_however_often_there_is_a_report() {
    let mut line = streaming(5);
    (0..12).for_each(|_| line.leg.tick());
    (0..3).for_each(|_| line.link.report(&mut line.leg));
    assert_eq!(told(&line.heard()), [(1, 12)]);
}

#[test]
fn a_stream_of_zero_ends_it() {
    let mut line = streaming(1);
    line.tick();
    assert_eq!(told(&line.heard()), [(1, 1)]);
    line.ask(&HostRequest::Stream(0));
    (0..3).for_each(|_| line.tick());
    assert_eq!(line.heard(), []);
}

#[test]
fn telemetry_asked_for_once_leaves_no_gap_in_a_stream() {
    let mut line = streaming(1);
    line.tick();
    line.heard();
    let HostReply::Telemetry(once) = line.ask(&HostRequest::Telemetry) else {
        panic!("no telemetry")
    };
    assert_eq!(once.number, 1);
    line.tick();
    assert_eq!(told(&line.heard()), [(2, 2)]);
}

#[test]
fn a_gap_in_the_numbers_is_what_found_no_room() {
    let mut line = full();
    let numbers = told(&line.heard());
    let count = numbers.len() as u32;
    assert!(0 < count && count < MANY, "{count}");
    let first: Vec<(u32, u32)> = (1..=count).map(|number| (number, number)).collect();
    assert_eq!(numbers, first);
    line.tick();
    assert_eq!(told(&line.heard()), [(MANY + 1, MANY + 1)]);
}

/// No more room is kept free than a reply may need.
#[test]
fn a_line_that_is_full_of_telemetry_has_room_for_one_reply_alone() {
    let mut line = full();
    let waiting = core::iter::from_fn(|| line.link.transmit()).count();
    // The longest frame is left, and telemetry takes but a quarter of one.
    let most = ROOM - MAX_FRAME;
    assert!(
        (most - MAX_FRAME / 4..=most).contains(&waiting),
        "{waiting} bytes"
    );
}

/// A log loses nothing when two other hosts ask for the settings at once.
#[test]
fn reports_find_room_beside_two_replies_with_settings() {
    let mut line = streaming(1);
    for _ in 0..2 {
        line.send(&HostRequest::GetSettings);
    }
    line.tick();
    let heard = line.heard();
    let [
        (_, HostReply::Settings(_)),
        (_, HostReply::Settings(_)),
        report,
    ] = &heard[..]
    else {
        panic!("{heard:?}")
    };
    assert_eq!(told(&vec![report.clone()]), [(1, 1)]);
}

#[test]
fn a_reply_finds_room_on_a_line_that_is_full_of_telemetry() {
    let mut line = full();
    let number = line.send(&HostRequest::GetSettings);
    let heard = line.heard();
    assert!(
        matches!(heard.last(), Some((told, HostReply::Settings(_))) if *told == number),
        "{heard:?}"
    );
}

#[test]
fn replies_leave_before_the_telemetry_of_their_tick() {
    let mut line = streaming(1);
    let number = line.command(ONE, Command::KeepAlive);
    line.tick();
    let heard = line.heard();
    assert_eq!(heard[0], (number, HostReply::Done));
    assert_eq!(told(&heard[1..].to_vec()), [(1, 1)]);
}

/// No half frames: what finds no room is lost whole, and the host asks again.
#[test]
fn a_reply_that_finds_no_room_is_lost_whole() {
    let mut line = Line::identified();
    let numbers: Vec<u16> = (0..20)
        .map(|_| line.send(&HostRequest::GetSettings))
        .collect();
    let heard = line.heard();
    let told: Vec<u16> = heard.iter().map(|(number, _)| *number).collect();
    assert!(told.len() < numbers.len(), "{told:?}");
    assert!(numbers.starts_with(&told), "{told:?}");
    assert!(matches!(
        line.ask(&HostRequest::GetSettings),
        HostReply::Settings(_)
    ));
}
