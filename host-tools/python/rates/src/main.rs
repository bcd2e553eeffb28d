//! What Rust alone takes for ticks of a simulated leg with its host, and for a map on all cores: one line of JSON.
//!
//! `cargo run --release --package leg-rates -- TICKS AZIMUTHS TILTS`; `tests/test_speed.py` sets the Python package beside it.

use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_model_tools::workspace_map::{Grid, WorkspaceMap};
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::EmulatedLeg;
use leg_sim::hosted_leg::HostedLeg;
use leg_sim::plant::Start;
use serde_json::json;
use std::env;
use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

/// Payload of the map, kg.
const PAYLOAD_KG: f64 = 1.0;

fn main() -> Result<(), Box<dyn Error>> {
    let mut given = env::args().skip(1);
    let mut next = || given.next().ok_or("usage: leg-rates TICKS AZIMUTHS TILTS");
    let ticks = next()?.parse()?;
    let grid = Grid {
        azimuths: next()?.parse()?,
        tilts: next()?.parse()?,
    };
    let rig = RigFile::load(None).map_err(|failure| failure.to_string())?;
    println!(
        "{}",
        json!({ "ticks_s": ticks_s(&rig, ticks)?, "map_s": map_s(&rig, grid) })
    );
    Ok(())
}

/// What the ticks of an armed leg take, s.
fn ticks_s(rig: &RigFile, ticks: u32) -> Result<f64, Box<dyn Error>> {
    let start = Start::Held {
        azimuth_deg: 0.0,
        tilt_deg: 0.0,
        pretension_n: rig.pretension_n,
        payload_kg: 0.0,
    };
    let leg = EmulatedLeg::start_in_process(rig, &rig.plant, start, 0)?;
    let mut leg = HostedLeg::new(leg, rig, start.direction(), 0);
    while leg.state() == State::Boot {
        leg.tick()?;
    }
    leg.send(&Command::Arm).map_err(|error| error.to_string())?;
    while leg.state() != State::Active {
        leg.tick()?;
    }
    let begin = Instant::now();
    for _ in 0..ticks {
        black_box(leg.tick()?);
    }
    Ok(begin.elapsed().as_secs_f64())
}

/// What a map takes, s.
fn map_s(rig: &RigFile, grid: Grid) -> f64 {
    let begin = Instant::now();
    black_box(WorkspaceMap::compute(rig, PAYLOAD_KG, grid, false, || ()));
    begin.elapsed().as_secs_f64()
}
