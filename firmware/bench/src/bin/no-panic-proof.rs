//! Proof by linking that no request can make the firmware panic.
//!
//! Its panic handler calls a function that does not exist (the crate `panic-never`), so this image links only if the
//! optimiser has shown that no panic can be reached: not in the frame decoder, the server, the whole model behind it
//! and each of its kernels, nor on the CAN bus's way in and out, whatever bytes come in. It is linked, never run. With the feature `with-a-panic` it must
//! not link, which shows that the proof can fail.
#![no_std]
#![no_main]

use core::ptr;
use leg_firmware::can::{
    Assembler, BusGuard, BusState, CanFrame, Identifier, LegAddress, Segmenter,
};
use leg_firmware::frame::{Decoder, MAX_FRAME};
use leg_firmware::host_link::BoardKind;
use leg_firmware::recorder::Recorder;
use leg_firmware::settings::Settings;
use leg_firmware_bench::counter::InstructionCounter;
use leg_firmware_bench::protocol::BoardInfo;
use leg_firmware_bench::server::{self, Server};
use panic_never as _;

struct NoBoard;

impl InstructionCounter for NoBoard {
    fn count<A, B>(&mut self, kernel: fn(&A, &mut B), input: &A, output: &mut B) -> Option<u32> {
        kernel(input, output);
        Some(0)
    }
}

impl server::BenchBoard for NoBoard {
    fn info(&self) -> BoardInfo {
        BoardInfo {
            board: BoardKind::Qemu,
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

/// A CAN frame of which nothing is known.
fn unknown_frame() -> Option<CanFrame> {
    let bits = u16::from_le_bytes([unknown(), unknown()]);
    let mut payload = [0; 65];
    payload.fill_with(unknown);
    let size = usize::from(unknown());
    CanFrame::new(Identifier::from_bits(bits)?, payload.get(..size)?).ok()
}

fn watch(guard: &mut BusGuard) {
    let state = match unknown() {
        0 => BusState::ErrorActive,
        1 => BusState::ErrorPassive,
        _ => BusState::BusOff,
    };
    let since_us = u32::from_le_bytes([unknown(), unknown(), unknown(), unknown()]);
    keep(guard.watch(state, since_us) as u8);
}

#[allow(unsafe_code, reason = "the linker's entry has a fixed name")]
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    let mut recorder = Recorder::new();
    let mut server = Server::new(NoBoard, &mut recorder);
    let mut decoder = Decoder::new();
    let mut out = [0; MAX_FRAME];
    let leg = LegAddress::ALL[0];
    let mut assembler = Assembler::<MAX_FRAME>::leg_receiver(leg);
    let mut segmenter = Segmenter::new(Identifier::ToHost(leg));
    let mut guard = BusGuard::new(1_000_000);
    loop {
        watch(&mut guard);
        let serial = [unknown()];
        let frame = unknown_frame();
        let received = match &frame {
            Some(frame) => assembler.push(frame).link_frame.unwrap_or_default(),
            None => &serial,
        };
        for &byte in received {
            let Some(request) = decoder.push(byte) else {
                continue;
            };
            let reply = server.answer(request, &mut out).unwrap_or_default();
            reply.iter().copied().for_each(keep);
            for frame in segmenter.segments(reply).into_iter().flatten() {
                frame.payload().iter().copied().for_each(keep);
            }
        }
        #[cfg(feature = "with-a-panic")]
        keep([1, 2, 3][usize::from(unknown())]);
    }
}
