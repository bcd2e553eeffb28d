#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod can;
mod endings;
mod faults;
mod goals;
mod greeting;
mod hosts;
mod lost_frames;
mod patience;
mod scripted;
mod settings;
mod strange;
mod stream;
mod urgent;

use crate::operator::{Goal, Host, Interrupt, Operator};
use crate::transport::emulated::Emulated;
use leg_firmware::command::Command;
use leg_firmware::supervisor::State;
use leg_rig::rig_file::RigFile;
use leg_sim::emulated_leg::{Beginning, EmulatedLeg};
use leg_sim::simulation::InThisProcess;
use std::time::Duration;

fn emulated(beginning: Beginning) -> Emulated {
    emulated_rig(&RigFile::load(None).unwrap(), beginning)
}

fn emulated_rig(rig: &RigFile, beginning: Beginning) -> Emulated {
    let controller = Box::new(InThisProcess::default());
    Emulated::new(
        EmulatedLeg::new(rig, beginning, controller).unwrap(),
        "the leg in this test",
    )
}

fn host(leg: &Emulated, id: u32) -> Operator {
    let sequence = 1000 * id as u16;
    let host = Host { id, sequence };
    Operator::open(Box::new(leg.beside()), host, Interrupt::default()).unwrap()
}

fn lean(tilt_deg: f64) -> Goal {
    let sine = tilt_deg.to_radians().sin() as f32;
    Goal {
        direction: Some([0.0, sine]),
        demand: None,
    }
}

fn state(operator: &mut Operator) -> State {
    operator.telemetry().unwrap().telemetry.state
}

/// Commands a move and comes back while the leg is on its way.
fn begin_move(operator: &mut Operator) {
    operator.command(Command::Arm).unwrap();
    operator.command(Command::Move { x: 0.4, y: 0.0 }).unwrap();
    operator.pause(Duration::from_millis(100)).unwrap();
    assert!(operator.telemetry().unwrap().telemetry.moving);
}
