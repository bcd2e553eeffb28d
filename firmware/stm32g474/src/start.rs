//! What happens once: every part is set up, the outputs off before anything else.

use crate::control::{self, SharedLeg};
use crate::converters::{ConverterParts, Converters};
use crate::cycles::CycleCounter;
use crate::encoders::{EncoderParts, Encoders};
use crate::flash::CheckedFlash;
use crate::link::Session;
use crate::nucleo::Nucleo;
use crate::power::{self, Power, PowerParts};
use crate::slow_sensors::SlowSensors;
use crate::watchdog::Watchdog;
use crate::{can_bus, fatal, housekeeping, serial, settings_task, switches};
use embassy_executor::{SpawnError, SpawnToken, Spawner};
use embassy_stm32::Peripherals;
use embassy_stm32::gpio::{Level, Output, Speed};
use leg_firmware::board::{CrashReport, LinkChoice, ShortText};
use leg_firmware::host_link::BoardKind;
use leg_firmware::host_link::{HostLink, Identity, ResetCause};
use leg_firmware::leg::Checked;
use leg_firmware::linked_leg::SensingLeg;
use leg_firmware::recorder::{Recorder, RecorderSetup};
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware::version::VERSION;
use static_cell::{ConstStaticCell, StaticCell};

/// Sets everything up and lets it run.
pub async fn start(spawner: Spawner, p: Peripherals, origin: (ResetCause, Option<CrashReport>)) {
    let power = Power::new(PowerParts {
        timer: p.TIM1,
        pulse_1: p.PA8,
        pulse_2: p.PA9,
        pulse_3: p.PA10,
        direction_1: p.PC6,
        direction_2: p.PC7,
        direction_3: p.PC8,
        enable: p.PC9,
        fault_1: p.PB2,
        fault_2: p.PB11,
        fault_3: p.PB15,
        any_fault: p.PB10,
        stop: p.PC3,
    });
    let encoders = Encoders::new(EncoderParts {
        timer_1: p.TIM2,
        tracks_1: (p.PA0, p.PA1),
        timer_2: p.TIM3,
        tracks_2: (p.PB4, p.PB5),
        timer_3: p.TIM4,
        tracks_3: (p.PB6, p.PB7),
    });
    let slow_sensors = SlowSensors::new(p.ADC3, p.PB1, p.PB0);
    let converters = Converters::new(ConverterParts {
        cells: p.ADC1,
        cell_1: p.PC0,
        cell_2: p.PC1,
        cell_3: p.PC2,
        currents: p.ADC2,
        current_1: p.PA4,
        current_2: p.PA6,
        current_3: p.PA7,
    });
    let led = Output::new(p.PA5, Level::High, Speed::Low);

    let Ok(mut store) = settings_task::store(CheckedFlash::new(p.FLASH)) else {
        fatal::end(&ShortText::new("the settings' place is not in the flash"));
    };
    static SETTINGS: StaticCell<Settings> = StaticCell::new();
    let settings = SETTINGS.init_with(built_in);
    settings_task::load(&mut store, settings).await;
    refuse_unfit(settings);
    static LEG: StaticCell<SensingLeg<f32>> = StaticCell::new();
    let leg = placed(&LEG, settings);
    // To be built anew when the settings change.
    static SPARE: StaticCell<SensingLeg<f32>> = StaticCell::new();
    let spare = SharedLeg::new(placed(&SPARE, settings));
    static RECORDER: ConstStaticCell<Recorder> = ConstStaticCell::new(Recorder::new());
    let recorder = RECORDER.take();
    recorder.begin(&RecorderSetup::new(settings));
    let session = session(origin, settings, spare);

    let Some(cycles) = CycleCounter::start() else {
        fatal::end(&ShortText::new("the cycle counter is taken"));
    };
    let board = Nucleo::new(power, encoders, converters, slow_sensors);
    control::start(board, leg, recorder);
    power::start();
    spawn(&spawner, settings_task::keep_settings(store));
    // Before the line is opened, which may wait for its hardware.
    let watchdog = Watchdog::start(p.IWDG);
    match switches::read(p.PC10, p.PC11, p.PC12) {
        LinkChoice::Serial => match serial::open(p.LPUART1, p.PA3, p.PA2) {
            Ok(uart) => spawn(&spawner, serial::serve(uart, session)),
            Err(_) => fatal::end(&ShortText::new("the serial line refuses its settings")),
        },
        LinkChoice::Can(address) => {
            let node = can_bus::open(p.FDCAN2, p.PB12, p.PB13, address);
            spawn(&spawner, can_bus::serve(node, session));
        }
    }
    spawn(&spawner, housekeeping::keep_house(watchdog, cycles, led));
}

fn spawn<S>(spawner: &Spawner, task: Result<SpawnToken<S>, SpawnError>) {
    match task {
        Ok(task) => spawner.spawn(task),
        Err(_) => fatal::end(&ShortText::new("a task was started twice")),
    }
}

fn identity((reset, kept): (ResetCause, Option<CrashReport>)) -> Identity {
    Identity {
        board: BoardKind::Stm32g474,
        version: VERSION,
        reset,
        crash_report: kept.map(|kept| kept.text).unwrap_or_default(),
    }
}

fn built_in() -> Settings {
    match Settings::table_1() {
        Some(settings) => settings,
        None => fatal::end(&ShortText::new("the built-in settings have another shape")),
    }
}

/// Puts the built-in settings in the place of those that describe no leg.
// Apart, as those below, so that it takes stack only as long as it runs.
#[inline(never)]
fn refuse_unfit(settings: &mut Settings) {
    settings.forget_zero();
    if let Err(error) = check(settings) {
        settings_task::warn(&error);
        settings_task::refuse();
        replace(settings);
    }
}

/// Whether the settings describe a leg.
#[inline(never)]
fn check(settings: &Settings) -> Result<(), SettingsError> {
    Checked::<f32>::new(settings).map(|_| ())
}

#[inline(never)]
fn replace(settings: &mut Settings) {
    *settings = built_in();
}

/// A leg at its place.
#[inline(never)]
fn placed(
    place: &'static StaticCell<SensingLeg<f32>>,
    settings: &Settings,
) -> &'static mut SensingLeg<f32> {
    match Checked::new(settings) {
        Ok(checked) => place.init_with(|| SensingLeg::assembled(settings, checked)),
        Err(_) => fatal::end(&ShortText::new("the built-in settings are refused")),
    }
}

/// The host's line. The settings' place serves the task that keeps them from now on.
#[inline(never)]
fn session(
    origin: (ResetCause, Option<CrashReport>),
    settings: &'static mut Settings,
    leg: SharedLeg,
) -> &'static mut Session {
    static SESSION: StaticCell<Session> = StaticCell::new();
    let link = HostLink::new(identity(origin), settings.clone());
    SESSION.init_with(|| Session::new(link, leg, settings))
}
