//! The same library as in the image, in this process: what the chip's pins have to carry.

use leg_firmware::board;
use leg_firmware::command::Command;
use leg_firmware::drive::Drive;
use leg_firmware::host_link::{
    BoardKind, CommandedLeg, HostLink, HostRefusal, Identity, ResetCause,
};
use leg_firmware::jog::JogReport;
use leg_firmware::leg::CommandOutcome;
use leg_firmware::linked_leg::{RecordedLeg, SensingLeg};
use leg_firmware::recorder::{Recorder, RecorderReply, RecorderRequest, RecorderSetup};
use leg_firmware::sensors::{SensorReading, Sensors};
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware::supervisor::State;
use leg_firmware::telemetry::Telemetry;
use leg_firmware_bench::virtual_board::VirtualBoard;
use std::collections::VecDeque;

/// A leg that counts what passes to it from the line.
#[derive(Clone)]
struct CountingLeg {
    leg: SensingLeg<f32>,
    recorder: Box<Recorder>,
    taken: u64,
}

/// The library, ticked as often as the chip, and given each command between the same two ticks.
#[derive(Clone)]
pub struct Twin {
    leg: CountingLeg,
    link: HostLink,
    board: VirtualBoard,
    /// Bytes that went to the chip, and whose commands it has not taken yet.
    pub pending: VecDeque<u8>,
    /// Bytes whose commands it has taken since the last tick.
    pub received: VecDeque<u8>,
    /// Commands that the chip has taken.
    taken: u64,
}

impl Twin {
    /// With the settings that the chip finds in its flash.
    pub fn new(settings: &Settings) -> Result<Self, SettingsError> {
        let identity = Identity {
            board: BoardKind::InProcess,
            version: leg_firmware::version::VERSION,
            reset: ResetCause::Emulated,
            crash_report: Default::default(),
        };
        let mut recorder = Box::new(Recorder::new());
        recorder.begin(&RecorderSetup::new(settings));
        Ok(Self {
            leg: CountingLeg {
                leg: SensingLeg::new(settings)?,
                recorder,
                taken: 0,
            },
            link: HostLink::new(identity, settings.clone()),
            board: VirtualBoard::default(),
            pending: VecDeque::new(),
            received: VecDeque::new(),
            taken: 0,
        })
    }

    /// The chip takes a command: so does the twin.
    pub fn take_command(&mut self) {
        self.taken += 1;
        while self.leg.taken < self.taken
            && let Some(byte) = self.pending.pop_front()
        {
            self.received.push_back(byte);
            self.link.receive(&[byte], &mut self.leg);
            // The chip has kept them before it takes another command.
            if self.link.unsaved_settings().is_some() {
                self.link.saved(true);
            }
        }
    }

    /// Takes up to `most` of the bytes up to the next zero, which alone ends a frame: nothing comes of them before it. They
    /// are then recorded as the line brings them, and a long frame that is damaged ends in the record when it ends on the chip.
    pub fn take_incomplete(&mut self, most: usize) {
        let incomplete = self.pending.iter().take_while(|byte| **byte != 0);
        let count = incomplete.take(most).count();
        for byte in self.pending.drain(..count) {
            self.received.push_back(byte);
            self.link.receive(&[byte], &mut self.leg);
        }
    }

    /// One tick: what is asked of the motors, what they get, and the leg after it.
    pub fn tick(&mut self, sensors: &Sensors) -> (Drive<f32>, Drive<f32>, Telemetry<f32>) {
        self.board.read(sensors);
        let drive = board::tick(&mut self.board, &mut self.leg.leg, &mut self.leg.recorder);
        self.link.report(&mut self.leg);
        while self.link.transmit().is_some() {}
        (drive, self.board.motors(), self.leg.leg.telemetry())
    }
}

impl CountingLeg {
    fn recorded(&mut self) -> RecordedLeg<'_, f32> {
        RecordedLeg {
            leg: &mut self.leg,
            recorder: &mut self.recorder,
        }
    }
}

impl CommandedLeg for CountingLeg {
    fn command(&mut self, number: u16, command: Command) -> bool {
        self.taken += 1;
        self.recorded().command(number, command)
    }

    fn note_decode_error(&mut self) {
        self.taken += 1;
        self.recorded().note_decode_error();
    }

    fn outcome(&mut self) -> Option<CommandOutcome> {
        self.recorded().outcome()
    }

    fn state(&mut self) -> State {
        self.recorded().state()
    }

    fn telemetry(&mut self) -> Telemetry<f32> {
        self.recorded().telemetry()
    }

    fn jog_report(&mut self) -> Option<JogReport<f32>> {
        self.recorded().jog_report()
    }

    fn sensors(&mut self) -> SensorReading {
        self.recorded().sensors()
    }

    fn restart(&mut self, settings: &Settings) -> Result<(), HostRefusal> {
        self.taken += 1;
        self.recorded().restart(settings)
    }

    fn recorder(&mut self, request: RecorderRequest) -> Option<RecorderReply> {
        self.recorder.answer(request)
    }
}
