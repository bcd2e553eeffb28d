//! Answers requests: the same on every board and inside the host's own process.

use crate::counter::InstructionCounter;
use crate::kernels;
use crate::protocol::{
    BENCH_SCHEMA, BoardInfo, BoardStep, EvaluateRequest, KernelRequest, Refusal, Reply, Request,
    TickRequest,
};
use crate::virtual_leg::VirtualLeg;
use core::borrow::BorrowMut;
use leg_firmware::frame::{self, Frame, FrameError, MAX_FRAME};
use leg_firmware::host_link::{BoardKind, Hello, Identity, ResetCause};
use leg_firmware::recorder::{Recorder, RecorderSetup};
use leg_firmware::settings::Settings;
use leg_firmware::version::VERSION;

/// What the server needs from the board that it runs on.
pub trait BenchBoard: InstructionCounter {
    /// What the board is and found at boot.
    fn info(&self) -> BoardInfo;

    /// Keeps settings over a reset; false if that failed.
    fn save(&mut self, settings: &Settings) -> bool;
}

/// One end of a link: it answers each request with one reply. `R` is where its leg's recorder is.
#[derive(Clone, Debug)]
pub struct Server<B, R> {
    board: B,
    recorder: R,
    greeted: bool,
    leg: Option<VirtualLeg>,
}

impl<B: BenchBoard, R: BorrowMut<Recorder>> Server<B, R> {
    /// A server whose host has not said [`Request::Hello`] yet.
    pub const fn new(board: B, recorder: R) -> Self {
        Self {
            board,
            recorder,
            greeted: false,
            leg: None,
        }
    }

    /// Answers what a [`frame::Decoder`] found and returns the reply's frame.
    ///
    /// The reply has the request's sequence; a frame that could not be read is answered by
    /// [`Refusal::BadFrame`] with sequence 0, which no request has.
    ///
    /// # Errors
    /// [`FrameError::TooLong`] if the reply does not fit into a frame.
    pub fn answer<'a>(
        &mut self,
        request: Result<Frame<'_>, FrameError>,
        out: &'a mut [u8; MAX_FRAME],
    ) -> Result<&'a [u8], FrameError> {
        match request {
            Ok(frame) => frame::encode(frame.sequence, &self.reply(&frame), out),
            Err(error) => frame::encode(0, &Reply::Refused(Refusal::BadFrame(error)), out),
        }
    }

    fn reply(&mut self, frame: &Frame<'_>) -> Reply {
        match frame.message() {
            None => Reply::Refused(Refusal::BadRequest),
            Some(request) => self.handle(&request),
        }
    }

    /// Answers a request that comes without a frame.
    pub fn handle(&mut self, request: &Request) -> Reply {
        let reply = match request {
            Request::Hello(hello) => self.greet(*hello),
            _ if !self.greeted => Err(Refusal::NoHello),
            Request::Evaluate(request) => evaluate(request),
            Request::Run(request) => run(request),
            Request::Count(request) => self.count(request),
            Request::Start(settings) => self.start(settings),
            Request::Tick(request) => self.tick(request),
            Request::CountTick(request) => self.count_tick(request),
            Request::Board(step) => self.board_step(step),
        };
        reply.unwrap_or_else(Reply::Refused)
    }

    fn greet(&mut self, hello: Hello) -> Result<Reply, Refusal> {
        self.greeted = hello.schema == BENCH_SCHEMA;
        if self.greeted {
            Ok(Reply::Hello(self.board.info()))
        } else {
            Err(Refusal::SchemaMismatch {
                schema: BENCH_SCHEMA,
            })
        }
    }

    #[inline(never)]
    fn start(&mut self, settings: &Settings) -> Result<Reply, Refusal> {
        let identity = emulated(self.board.info().board);
        self.leg = Some(VirtualLeg::new(identity, settings).map_err(Refusal::Settings)?);
        let setup = RecorderSetup::new(settings);
        self.recorder.borrow_mut().begin(&setup);
        Ok(Reply::Started)
    }

    #[inline(never)]
    fn tick(&mut self, request: &TickRequest) -> Result<Reply, Refusal> {
        let leg = self.leg.as_mut().ok_or(Refusal::NoLeg)?;
        let board = &mut self.board;
        let save = |settings: &Settings| board.save(settings);
        let recorder = self.recorder.borrow_mut();
        Ok(Reply::Ticked(leg.tick(request, recorder, save)))
    }

    #[inline(never)]
    fn count_tick(&mut self, request: &TickRequest) -> Result<Reply, Refusal> {
        let leg = self.leg.as_mut().ok_or(Refusal::NoLeg)?;
        let recorder = self.recorder.borrow_mut();
        leg.count_tick(request, recorder, &mut self.board, B::save)
            .map(Reply::Ticked)
            .ok_or(Refusal::NoCounter)
    }

    #[inline(never)]
    fn board_step(&mut self, step: &BoardStep) -> Result<Reply, Refusal> {
        let leg = self.leg.as_mut().ok_or(Refusal::NoLeg)?;
        Ok(Reply::Board(leg.board_step(step)))
    }

    fn count(&mut self, request: &KernelRequest) -> Result<Reply, Refusal> {
        kernels::count(request.kernel, &request.input, &mut self.board)
            .map_err(Refusal::Model)?
            .map(Reply::Counted)
            .ok_or(Refusal::NoCounter)
    }
}

/// What an emulated board is to the user's host.
#[must_use]
pub fn emulated(board: BoardKind) -> Identity {
    Identity {
        board,
        version: VERSION,
        reset: ResetCause::Emulated,
        crash_report: heapless::String::new(),
    }
}

fn evaluate(request: &EvaluateRequest) -> Result<Reply, Refusal> {
    let evaluated = request
        .query
        .query()
        .and_then(|query| leg_model::evaluate(&request.rig, &query));
    evaluated.map(Reply::Evaluation).map_err(Refusal::Model)
}

fn run(request: &KernelRequest) -> Result<Reply, Refusal> {
    kernels::run(request.kernel, &request.input)
        .map(Reply::Ran)
        .map_err(Refusal::Model)
}
