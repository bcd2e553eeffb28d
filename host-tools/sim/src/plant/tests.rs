#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod actuators;
mod cells;
mod defects;
mod energy;
mod momentum;
mod order;
mod pendulum;
mod rest;
mod tendons;

use super::{Plant, Start};
use leg_firmware::drive::Drive;
use leg_rig::plant_settings::PlantSettings;
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::RigFile;

const OFF: Drive<f32> = Drive {
    duty: [0.0; 3],
    enabled: false,
};

const HELD: Start = Start::Held {
    azimuth_deg: 40.0,
    tilt_deg: 15.0,
    pretension_n: 70.0,
    payload_kg: 0.5,
};

fn driven(duty: [f32; 3]) -> Drive<f32> {
    Drive {
        duty,
        enabled: true,
    }
}

fn ready(name: &str) -> RigFile {
    RigFile::load(Some(name.as_ref())).unwrap()
}

fn ready_rigs() -> impl Iterator<Item = (&'static str, RigFile)> {
    READY_RIGS.iter().map(|rig| (rig.name, ready(rig.name)))
}

fn plant(rig: &RigFile, settings: &PlantSettings, start: Start) -> Plant {
    Plant::new(rig, settings, start, 1).unwrap()
}

fn run(plant: &mut Plant, ticks: u32, drive: &Drive<f32>) {
    for _ in 0..ticks {
        plant.step(drive);
    }
}
