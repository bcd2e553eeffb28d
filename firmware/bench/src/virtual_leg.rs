//! A leg with its line on a virtual board: all of the firmware that an emulator runs.

use crate::counter::InstructionCounter;
use crate::protocol::{BoardReply, BoardStep, TickReply, TickRequest};
use crate::virtual_board::VirtualBoard;
use leg_firmware::board::{self, LowerHalf};
use leg_firmware::drive::Drive;
use leg_firmware::host_link::Identity;
use leg_firmware::leg::Leg;
use leg_firmware::linked_leg::LinkedLeg;
use leg_firmware::recorder::Recorder;
use leg_firmware::sensors::Sensors;
use leg_firmware::settings::{Settings, SettingsError};

/// A leg, its line and its board.
#[derive(Clone, Debug)]
pub struct VirtualLeg {
    leg: LinkedLeg<f32>,
    board: VirtualBoard,
}

impl VirtualLeg {
    /// A leg that has not seen its sensors yet, on a board that drives nothing.
    ///
    /// # Errors
    /// Settings that are refused.
    pub fn new(identity: Identity, settings: &Settings) -> Result<Self, SettingsError> {
        Ok(Self {
            leg: LinkedLeg::new(identity, settings)?,
            board: VirtualBoard::default(),
        })
    }

    /// One tick and what belongs to it. `save` keeps settings over a reset; false if that failed.
    pub fn tick(
        &mut self,
        request: &TickRequest,
        recorder: &mut Recorder,
        save: impl FnMut(&Settings) -> bool,
    ) -> TickReply {
        self.leg.receive(&request.link, recorder);
        self.board.read(&request.sensors);
        let drive = board::tick(&mut self.board, self.leg.leg(), recorder);
        self.reply(drive, recorder, save)
    }

    /// The same, and how many instructions the control law and the recorder took; `None` where there is nothing to count with.
    pub fn count_tick<B: InstructionCounter>(
        &mut self,
        request: &TickRequest,
        recorder: &mut Recorder,
        counter: &mut B,
        save: impl FnOnce(&mut B, &Settings) -> bool,
    ) -> Option<TickReply> {
        self.leg.receive(&request.link, recorder);
        self.board.read(&request.sensors);
        let sensors = self.board.sense();
        let mut ticking = Ticking {
            leg: self.leg.leg().store_sensors(&sensors),
            drive: None,
        };
        let instructions = counter.count(tick, &sensors, &mut ticking)?;
        let drive = ticking.drive?;
        self.board.drive(&drive);
        let mut recording = Recording {
            leg: ticking.leg,
            recorder,
        };
        let recorder_instructions = counter.count(record, &drive, &mut recording)?;
        let mut save = Some(save);
        let reply = self.reply(drive, recorder, |settings| {
            save.take().is_some_and(|save| save(counter, settings))
        });
        Some(TickReply {
            instructions: Some(instructions),
            recorder_instructions: Some(recorder_instructions),
            ..reply
        })
    }

    /// One step of the board without the leg.
    pub fn board_step(&mut self, step: &BoardStep) -> BoardReply {
        match step {
            BoardStep::Read(sensors) => self.board.read(sensors),
            BoardStep::Drive(drive) => self.board.drive(drive),
            BoardStep::Cut => self.board.cut(),
        }
        BoardReply {
            sensors: self.board.sense(),
            motors: self.board.motors(),
        }
    }

    fn reply(
        &mut self,
        drive: Drive<f32>,
        recorder: &mut Recorder,
        save: impl FnMut(&Settings) -> bool,
    ) -> TickReply {
        TickReply {
            drive,
            motors: self.board.motors(),
            telemetry: self.leg.leg().telemetry(),
            instructions: None,
            recorder_instructions: None,
            link: self.leg.sent(recorder, save),
        }
    }
}

/// What a counted tick works on.
struct Ticking<'a> {
    leg: &'a mut Leg<f32>,
    drive: Option<Drive<f32>>,
}

/// What a counted recording works on.
struct Recording<'a> {
    leg: &'a Leg<f32>,
    recorder: &'a mut Recorder,
}

fn record(drive: &Drive<f32>, recording: &mut Recording<'_>) {
    recording.recorder.record(recording.leg, drive);
}

fn tick(sensors: &Sensors, ticking: &mut Ticking<'_>) {
    ticking.drive = Some(ticking.leg.tick(sensors));
}
