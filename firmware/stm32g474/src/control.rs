//! The control interrupt, and the leg that it shares with the tasks below it.
//!
//! The leg is touched by the interrupt, and by tasks inside short critical sections only, so that neither ever finds it
//! taken; if it did, the tick would be left out and be reported as late, not panic. These sections mask every interrupt;
//! those of the drivers do not delay a tick: see `task_sections`.

use crate::check_ins::CHECK_INS;
use crate::nucleo::Nucleo;
use crate::tick_watchdog;
use core::cell::RefCell;
use core::hint::black_box;
use cortex_m::interrupt::Mutex;
use cortex_m::peripheral::DWT;
use embassy_stm32::interrupt;
use embassy_stm32::interrupt::InterruptExt;
use heapless::Vec;
use leg_firmware::board::{self, LowerHalf, TickTimer, WatchedTask};
use leg_firmware::command::Command;
use leg_firmware::host_link::{CommandedLeg, HostRefusal};
use leg_firmware::jog::JogReport;
use leg_firmware::leg::{Checked, CommandOutcome};
use leg_firmware::linked_leg::SensingLeg;
use leg_firmware::recorder::{Recorder, RecorderReply, RecorderRequest, RecorderSetup};
use leg_firmware::sensors::SensorReading;
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware::supervisor::{FaultSet, State};
use leg_firmware::telemetry::Telemetry;

static CONTROL: Mutex<RefCell<Option<Control>>> = Mutex::new(RefCell::new(None));

/// What a tick works on.
struct Control {
    board: Nucleo,
    leg: &'static mut SensingLeg<f32>,
    recorder: &'static mut Recorder,
    timer: TickTimer,
}

impl Control {
    #[inline(always)]
    fn tick(&mut self, started: u32) {
        self.board.late = self.timer.start(started);
        board::tick(&mut self.board, self.leg, self.recorder);
        tick_watchdog::refresh();
        self.timer.end(DWT::cycle_count());
    }
}

/// Reads the sensors, runs the control law and sets the duties, 8 000 times a second.
#[interrupt]
fn ADC1_2() {
    let started = DWT::cycle_count();
    if with_control(|control| control.tick(started)).is_some() {
        CHECK_INS.check_in(WatchedTask::Control);
    }
}

/// What `body` makes of the control; `None` before [`start`].
#[inline(always)]
fn with_control<R>(body: impl FnOnce(&mut Control) -> R) -> Option<R> {
    cortex_m::interrupt::free(|section| {
        let mut control = CONTROL.borrow(section).try_borrow_mut().ok()?;
        control.as_mut().map(body)
    })
}

/// Hands the board and the leg to the interrupt. The first tick comes once the timer runs.
#[allow(
    unsafe_code,
    reason = "unmasking an interrupt can break critical sections that rely on masks"
)]
pub fn start(board: Nucleo, leg: &'static mut SensingLeg<f32>, recorder: &'static mut Recorder) {
    let control = Control {
        board,
        leg,
        recorder,
        timer: TickTimer::new(),
    };
    cortex_m::interrupt::free(|section| CONTROL.borrow(section).replace(Some(control)));
    interrupt::ADC1_2.unpend();
    // SAFETY: the sections of this module stop every interrupt, those of the tasks share nothing with this one, and none
    // relies on its mask.
    unsafe { interrupt::ADC1_2.enable() };
}

/// Switches the outputs off, and leaves them off until the leg has let go of them.
pub fn cut() {
    with_control(|control| control.board.cut());
}

/// The longest tick so far, cycles.
pub fn longest_tick() -> u32 {
    with_control(|control| control.timer.longest()).unwrap_or(0)
}

/// The leg as a host commands it.
pub struct SharedLeg {
    /// The leg that is not in use: it is built anew here, at leisure, and then changes places with the other.
    spare: &'static mut SensingLeg<f32>,
    /// The last that was read.
    telemetry: Telemetry<f32>,
}

impl SharedLeg {
    /// The leg that the control interrupt has, beside one that it has not.
    pub fn new(spare: &'static mut SensingLeg<f32>) -> Self {
        let telemetry = spare.telemetry();
        Self { spare, telemetry }
    }
}

/// Where commands pass from the tasks to the leg. The functions keep their names in the image, so that an emulator can
/// tell between which two ticks a command came.
impl CommandedLeg for SharedLeg {
    #[inline(never)]
    fn command(&mut self, number: u16, command: Command) -> bool {
        with_control(|control| control.leg.command(number, command)).unwrap_or(false)
    }

    #[inline(never)]
    fn note_decode_error(&mut self) {
        with_control(|control| control.leg.note_decode_error());
    }

    fn outcome(&mut self) -> Option<CommandOutcome> {
        with_control(|control| control.leg.outcome())?
    }

    fn state(&mut self) -> State {
        with_control(|control| control.leg.state()).unwrap_or(self.telemetry.state)
    }

    fn telemetry(&mut self) -> Telemetry<f32> {
        let telemetry = &mut self.telemetry;
        loop {
            // Apart: the interrupt waits for one of the two. If it comes between them they are of two ticks, and are
            // read again: the next one is far.
            if let Some(course) = with_control(|control| control.leg.course()) {
                *telemetry = course;
            }
            let tick = with_control(|control| {
                control.leg.report_measured(telemetry);
                control.leg.ticks()
            });
            if tick.is_none_or(|tick| tick == telemetry.tick) {
                return *telemetry;
            }
        }
    }

    fn jog_report(&mut self) -> Option<JogReport<f32>> {
        // Copied once: every copy keeps the control interrupt waiting.
        let mut report = None;
        with_control(|control| report = control.leg.jog_report().copied());
        report
    }

    fn sensors(&mut self) -> SensorReading {
        with_control(|control| control.leg.sensors()).unwrap_or_default()
    }

    #[inline(never)]
    fn restart(&mut self, settings: &Settings) -> Result<(), HostRefusal> {
        rebuild(self.spare, settings).map_err(HostRefusal::Settings)?;
        // Apart: the interrupt may come before the legs change their places.
        with_control(|control| control.leg.refuse_commands());
        let spare = &mut self.spare;
        let changed = with_control(|control| {
            control.leg.hand_over(spare)?;
            core::mem::swap(&mut control.leg, spare);
            Ok(())
        });
        changed.unwrap_or(Err(HostRefusal::Busy))?;
        // Apart: the interrupt may come between the two.
        // The compiler leaves its divisions before the section.
        let setup = black_box(RecorderSetup::new(settings));
        with_control(|control| control.recorder.begin(&setup));
        Ok(())
    }

    fn recorder(&mut self, request: RecorderRequest) -> Option<RecorderReply> {
        let RecorderRequest::Read(first) = request else {
            with_control(|control| control.recorder.obey(request))?;
            // A waiting interrupt comes between the two.
            cortex_m::asm::isb();
            let report = with_control(|control| control.recorder.report())?;
            return Some(RecorderReply::Report(report));
        };
        // Into its place: the interrupt waits no longer than for one copy.
        let mut read = Vec::new();
        let ended = with_control(|control| control.recorder.read(first, &mut read))?;
        ended.then_some(RecorderReply::Triples(read))
    }
}

/// Builds a leg anew at its place, without its zero. Refused settings leave it as it was.
// Apart, so that it takes stack only as long as it runs.
#[inline(never)]
fn rebuild(leg: &mut SensingLeg<f32>, settings: &Settings) -> Result<(), SettingsError> {
    let checked = Checked::new(settings)?;
    *leg = SensingLeg::assembled(settings, checked);
    leg.forget_zero();
    Ok(())
}

/// What the leg may do, and its faults that do more than limit; `None` before the first start.
pub fn condition() -> Option<(State, FaultSet)> {
    with_control(|control| (control.leg.state(), control.leg.stopping_faults()))
}
