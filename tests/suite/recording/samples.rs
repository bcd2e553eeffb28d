//! What a recording holds: the samples of a simulation, and what it is of.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use super::recorded::{recorded, simulation};
use leg_recording::{Samples, read_samples};
use leg_sim::link::InProcess;
use leg_sim::simulation::{SAMPLE_TICKS, Tick};

/// Every number of a simulation comes back from its recording as it was, so that its charts are the same.
#[test]
fn the_samples_of_a_simulation_are_read_as_they_were() {
    let (bytes, _) = recorded(|_, _| ());
    let mut written = Vec::new();
    let watch = &mut |tick: &Tick<'_>| written.push((*tick.comparison, *tick.telemetry));
    simulation().run(&mut InProcess::new(), watch).unwrap();
    let Samples::Simulation(read) = read_samples("leg.mcap", &bytes).unwrap().samples else {
        panic!("a simulation is no log");
    };
    let every = SAMPLE_TICKS as usize;
    assert_eq!(read.len(), written.len().div_ceil(every));
    for (read, written) in read.iter().zip(written.iter().step_by(every)) {
        assert_eq!((read.comparison, read.telemetry), *written);
    }
}

#[test]
fn what_a_recording_is_of_is_in_its_metadata() {
    let (bytes, _) = recorded(|_, _| ());
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let [index] = &summary.metadata_indexes[..] else {
        panic!("{:?}", summary.metadata_indexes);
    };
    let metadata = mcap::read::metadata(&bytes, index).unwrap();
    assert_eq!(
        (&*metadata.name, &*metadata.metadata["title"]),
        ("leg", "test")
    );
    assert!(metadata.metadata["settings"].contains("f_max_n = 150"));
}
