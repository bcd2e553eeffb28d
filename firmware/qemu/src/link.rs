//! The link to the host: two named pipes in QEMU's working directory, by semihosting.
//!
//! Reading blocks the processor, and with it QEMU's clock: host and firmware run in lock-step without further means.

use crate::boot::QemuBoard;
use embassy_futures::yield_now;
use leg_firmware::frame::{Decoder, MAX_FRAME};
use leg_firmware::recorder::Recorder;
use leg_firmware_bench::exit::Exit;
use leg_firmware_bench::pipes::{TO_FIRMWARE, TO_HOST};
use leg_firmware_bench::server::Server;
use semihosting::fs::File;
use semihosting::io::{Read, Write};

/// The server of this board.
type BoardServer = Server<QemuBoard, &'static mut Recorder>;

/// Answers the host until it closes the link; returns why it ended.
pub async fn serve(server: &mut BoardServer) -> Exit {
    let Ok((mut to_host, mut from_host)) = open() else {
        return Exit::NoLink;
    };
    let mut decoder = Decoder::new();
    let mut received = [0; MAX_FRAME];
    loop {
        let bytes = match from_host.read(&mut received) {
            Ok(0) => return Exit::LinkClosed,
            Ok(length) => received.get(..length).unwrap_or_default(),
            Err(_) => return Exit::LinkBroken,
        };
        if let Err(exit) = answer(server, &mut decoder, bytes, &mut to_host) {
            return exit;
        }
        yield_now().await;
    }
}

/// Opens the pipe to the host first, as the host does: each open waits for the other side.
fn open() -> semihosting::io::Result<(File, File)> {
    let to_host = File::create(TO_HOST)?;
    let from_host = File::open(TO_FIRMWARE)?;
    Ok((to_host, from_host))
}

/// Answers every request that ends within `bytes`.
fn answer(
    server: &mut BoardServer,
    decoder: &mut Decoder,
    bytes: &[u8],
    to_host: &mut File,
) -> Result<(), Exit> {
    let mut out = [0; MAX_FRAME];
    for &byte in bytes {
        let Some(request) = decoder.push(byte) else {
            continue;
        };
        let reply = server
            .answer(request, &mut out)
            .map_err(|_| Exit::ReplyTooLong)?;
        to_host.write_all(reply).map_err(|_| Exit::LinkBroken)?;
    }
    Ok(())
}
