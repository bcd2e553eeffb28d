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
use leg_firmware::linked_leg::SensingLeg;
use leg_firmware::settings::{Settings, SettingsError};
use leg_firmware::version::VERSION;
use static_cell::StaticCell;

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
    let built_in = built_in();
    let loaded = settings_task::load(&mut store, built_in.clone()).await;
    let (leg, settings) = leg(loaded, built_in);
    let shared = SharedLeg::new(spare(&settings));
    static TO_KEEP: StaticCell<Settings> = StaticCell::new();
    let to_keep = TO_KEEP.init(settings.clone());
    let link = HostLink::new(identity(origin), settings);
    static SESSION: StaticCell<Session> = StaticCell::new();
    let session = SESSION.init(Session::new(link, shared, to_keep));

    let Some(cycles) = CycleCounter::start() else {
        fatal::end(&ShortText::new("the cycle counter is taken"));
    };
    let board = Nucleo::new(power, encoders, converters, slow_sensors);
    control::start(board, leg);
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
    match Settings::for_table_1() {
        Some(settings) => settings,
        None => fatal::end(&ShortText::new("the built-in settings have another shape")),
    }
}

/// A leg with the settings that were kept, or with others where those describe no leg.
fn leg(kept: Settings, others: Settings) -> (&'static mut SensingLeg<f32>, Settings) {
    static LEG: StaticCell<SensingLeg<f32>> = StaticCell::new();
    let kept = kept.without_zero();
    match SensingLeg::new(&kept) {
        Ok(leg) => (LEG.init(leg), kept),
        Err(error) => {
            defmt::warn!("settings: {}", defmt::Display2Format(&error));
            settings_task::unfit();
            (LEG.init(accepted(SensingLeg::new(&others))), others)
        }
    }
}

/// A second leg with the same settings, to be built anew when they change.
fn spare(settings: &Settings) -> &'static mut SensingLeg<f32> {
    static SPARE: StaticCell<SensingLeg<f32>> = StaticCell::new();
    SPARE.init(accepted(SensingLeg::new(settings)))
}

fn accepted(leg: Result<SensingLeg<f32>, SettingsError>) -> SensingLeg<f32> {
    match leg {
        Ok(leg) => leg,
        Err(_) => fatal::end(&ShortText::new("the built-in settings are refused")),
    }
}
