//! What the firmware checks of itself at boot.

use crate::counter;
use embassy_time::{Duration, Instant, Timer};
use leg_firmware::host_link::BoardKind;
use leg_firmware::settings::Settings;
use leg_firmware_bench::counter::InstructionCounter;
use leg_firmware_bench::exit::Exit;
use leg_firmware_bench::protocol::{BoardInfo, BootCheck};
use leg_firmware_bench::server;

const ALARM: Duration = Duration::from_micros(1_000);

/// Latest alarm that passes, µs. Counting instructions, QEMU's processor does one in a µs, so waking a task is slow.
const LATEST_ALARM_US: u64 = 2_500;

/// QEMU's mps2-an386, checked.
pub struct QemuBoard {
    check: BootCheck,
}

impl QemuBoard {
    /// Rings an alarm by TIMER1, measures it by TIMER0, and tries the instruction counter.
    pub async fn check() -> Result<Self, Exit> {
        let start = Instant::now();
        Timer::after(ALARM).await;
        let took_us = start.elapsed().as_micros();
        let nops_counted = counter::count_nops();
        defmt::info!(
            "alarm of 1000 us took {=u64} us, 100 nops counted as {=u32}",
            took_us,
            nops_counted
        );
        match u32::try_from(took_us) {
            Ok(alarm_us) if (ALARM.as_micros()..=LATEST_ALARM_US).contains(&took_us) => Ok(Self {
                check: BootCheck {
                    alarm_us,
                    nops_counted,
                },
            }),
            Ok(_) | Err(_) => Err(Exit::AlarmOff),
        }
    }
}

impl InstructionCounter for QemuBoard {
    fn count<A, B>(&mut self, kernel: fn(&A, &mut B), input: &A, output: &mut B) -> Option<u32> {
        let exact = self.check.nops_counted == counter::NOPS;
        exact.then(|| counter::count(kernel, input, output))
    }
}

impl server::BenchBoard for QemuBoard {
    fn info(&self) -> BoardInfo {
        BoardInfo {
            board: BoardKind::Qemu,
            boot: Some(self.check),
        }
    }

    fn save(&mut self, _settings: &Settings) -> bool {
        true
    }
}
