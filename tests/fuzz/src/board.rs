//! A board without hardware.

use leg_firmware::host_link::BoardKind;
use leg_firmware::settings::Settings;
use leg_firmware_bench::counter::InstructionCounter;
use leg_firmware_bench::protocol::BoardInfo;
use leg_firmware_bench::server::BenchBoard;

/// A board that counts every kernel as one instruction, so that counted ticks run, too.
pub struct NoBoard;

impl InstructionCounter for NoBoard {
    fn count<A, B>(&mut self, kernel: fn(&A, &mut B), input: &A, output: &mut B) -> Option<u32> {
        kernel(input, output);
        Some(1)
    }
}

impl BenchBoard for NoBoard {
    fn info(&self) -> BoardInfo {
        BoardInfo {
            board: BoardKind::InProcess,
            boot: None,
        }
    }

    fn save(&mut self, _settings: &Settings) -> bool {
        true
    }
}
