//! A leg without a mechanism: it keeps what it is told, and obeys one command a tick.

use crate::command::{Command, CommandRefusal};
use crate::host_link::{CommandedLeg, HostRefusal};
use crate::jog::JogReport;
use crate::leg::{CommandOutcome, Leg};
use crate::recorder::{Recorder, RecorderReply, RecorderRequest};
use crate::sensors::SensorReading;
use crate::settings::Settings;
use crate::supervisor::State;
use crate::telemetry::Telemetry;
use std::collections::VecDeque;

pub struct NotedLeg {
    pub state: State,
    pub tick: u32,
    /// Commands that find room.
    pub room: usize,
    /// Commands that wait for their tick.
    pub waiting: VecDeque<(u16, Command)>,
    /// Commands that were obeyed or refused.
    pub obeyed: Vec<Command>,
    /// What the next ticks answer.
    pub result: Result<(), CommandRefusal>,
    pub note_decode_error: usize,
    pub sensors: SensorReading,
    /// What it was started again with.
    pub restarts: Vec<Settings>,
    pub recorder: Recorder,
    outcomes: VecDeque<CommandOutcome>,
    telemetry: Telemetry<f32>,
}

impl Default for NotedLeg {
    fn default() -> Self {
        let settings = Settings::table_1().unwrap();
        Self {
            state: State::Disarmed,
            tick: 0,
            room: 2,
            waiting: VecDeque::new(),
            obeyed: Vec::new(),
            result: Ok(()),
            note_decode_error: 0,
            sensors: SensorReading::default(),
            restarts: Vec::new(),
            recorder: Recorder::new(),
            outcomes: VecDeque::new(),
            telemetry: Leg::<f32>::new(&settings).unwrap().telemetry(),
        }
    }
}

impl NotedLeg {
    pub fn tick(&mut self) {
        self.tick = self.tick.wrapping_add(1);
        if let Some((number, command)) = self.waiting.pop_front() {
            self.obeyed.push(command);
            let result = self.result;
            self.outcomes.push_back(CommandOutcome { number, result });
        }
    }
}

impl CommandedLeg for NotedLeg {
    fn command(&mut self, number: u16, command: Command) -> bool {
        let free = self.waiting.len() < self.room;
        if free {
            self.waiting.push_back((number, command));
        }
        free
    }

    fn note_decode_error(&mut self) {
        self.note_decode_error += 1;
    }

    fn outcome(&mut self) -> Option<CommandOutcome> {
        self.outcomes.pop_front()
    }

    fn state(&mut self) -> State {
        self.state
    }

    fn telemetry(&mut self) -> Telemetry<f32> {
        Telemetry {
            tick: self.tick,
            state: self.state,
            ..self.telemetry
        }
    }

    fn jog_report(&mut self) -> Option<JogReport<f32>> {
        None
    }

    fn sensors(&mut self) -> SensorReading {
        self.sensors
    }

    fn restart(&mut self, settings: &Settings) -> Result<(), HostRefusal> {
        if self.state.driven() {
            return Err(HostRefusal::Driven);
        }
        settings.check().map_err(HostRefusal::Settings)?;
        self.restarts.push(settings.clone());
        Ok(())
    }

    fn recorder(&mut self, request: RecorderRequest) -> Option<RecorderReply> {
        self.recorder.answer(request)
    }
}
