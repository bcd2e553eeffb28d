//! Proof by linking that no request can make the firmware panic.
//!
//! Its panic handler calls a function that does not exist (the crate `panic-never`), so this image links only if the
//! optimiser has shown that no panic can be reached: not in the frame decoder, the server, the whole model behind it
//! and each of its kernels, whatever bytes come in. It is linked, never run. With the feature `with-a-panic` it must
//! not link, which shows that the proof can fail.
#![no_std]
#![no_main]

use core::ptr;
use leg_firmware::counter::Counter;
use leg_firmware::frame::{Decoder, MAX_FRAME};
use leg_firmware::protocol::{self, BoardInfo};
use leg_firmware::server::{self, Server};
use leg_firmware::settings::Settings;
use panic_never as _;

struct NoBoard;

impl Counter for NoBoard {
    fn count<A, B>(&mut self, kernel: fn(&A, &mut B), input: &A, output: &mut B) -> Option<u32> {
        kernel(input, output);
        Some(0)
    }
}

impl server::Board for NoBoard {
    fn info(&self) -> BoardInfo {
        BoardInfo {
            board: protocol::Board::Qemu,
            boot: None,
        }
    }

    fn save(&mut self, _settings: &Settings) -> bool {
        true
    }
}

/// Bytes that the optimiser cannot know.
#[allow(
    unsafe_code,
    reason = "only a volatile read hides a value from the optimiser"
)]
fn unknown() -> u8 {
    static SOURCE: u8 = 0;
    // SAFETY: it points to a static.
    unsafe { ptr::read_volatile(&raw const SOURCE) }
}

/// Keeps a reply from being optimised away.
#[allow(unsafe_code, reason = "only a volatile write keeps a value")]
fn keep(byte: u8) {
    let mut sink = 0;
    // SAFETY: it points to a local variable.
    unsafe { ptr::write_volatile(&raw mut sink, byte) }
}

#[allow(unsafe_code, reason = "the linker's entry has a fixed name")]
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    let mut server = Server::new(NoBoard);
    let mut decoder = Decoder::new();
    let mut out = [0; MAX_FRAME];
    loop {
        let Some(request) = decoder.push(unknown()) else {
            continue;
        };
        for &byte in server.answer(request, &mut out).unwrap_or_default() {
            keep(byte);
        }
        #[cfg(feature = "with-a-panic")]
        keep([1, 2, 3][usize::from(unknown())]);
    }
}
