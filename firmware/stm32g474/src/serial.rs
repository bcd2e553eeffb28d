//! The serial line to the host: LPUART1, which the board's debugger passes on over USB.

use crate::link::{REPORT_MS, Session};
use embassy_futures::select::{Either, select};
use embassy_stm32::interrupt::{self, InterruptExt};
use embassy_stm32::peripherals::{LPUART1, PA2, PA3};
use embassy_stm32::usart::{
    BufferedInterruptHandler, BufferedUart, BufferedUartTx, Config, ConfigError,
};
use embassy_stm32::{Peri, bind_interrupts};
use embassy_time::Timer;
use embedded_io_async::{Read, Write};
use heapless::Vec;
use leg_firmware::frame::MAX_FRAME;
use static_cell::StaticCell;

const BAUD: u32 = 921_600;

/// Bytes that are passed on at a time, so that what comes in never waits long: the line takes 1.4 ms for them.
const CHUNK: usize = 128;

bind_interrupts!(struct Interrupts {
    LPUART1 => BufferedInterruptHandler<LPUART1>;
});

/// Room for what goes out while the next bytes are passed on: four times that. What comes in has room for a frame.
const TO_HOST_BYTES: usize = 4 * CHUNK;

/// Opens the serial line at 921 600 baud, 8 bits, no parity, one stop bit.
///
/// # Errors
/// [`ConfigError`] if the clock does not give that rate.
pub fn open(
    lpuart: Peri<'static, LPUART1>,
    receive: Peri<'static, PA3>,
    transmit: Peri<'static, PA2>,
) -> Result<BufferedUart<'static>, ConfigError> {
    static TO_HOST: StaticCell<[u8; TO_HOST_BYTES]> = StaticCell::new();
    static FROM_HOST: StaticCell<[u8; MAX_FRAME]> = StaticCell::new();
    let mut config = Config::default();
    config.baudrate = BAUD;
    BufferedUart::new(
        lpuart,
        receive,
        transmit,
        TO_HOST.init([0; TO_HOST_BYTES]),
        FROM_HOST.init([0; MAX_FRAME]),
        Interrupts,
        config,
    )
}

/// Serves the host for ever.
#[embassy_executor::task]
pub async fn serve(uart: BufferedUart<'static>, session: &'static mut Session) {
    let (mut to_host, mut from_host) = uart.split();
    let mut received = [0; CHUNK];
    loop {
        let pause = Timer::after_millis(REPORT_MS);
        match select(from_host.read(&mut received), pause).await {
            Either::First(Ok(length)) => {
                session.receive(received.get(..length).unwrap_or_default());
            }
            // A byte is lost or damaged: the CRC of its frame shows that.
            Either::First(Err(_)) | Either::Second(()) => {}
        }
        session.turn();
        let mut chunk: Vec<u8, CHUNK> = Vec::new();
        while !chunk.is_full()
            && let Some(byte) = session.transmit()
        {
            // There is room: it was just checked.
            let _ = chunk.push(byte);
        }
        send(&mut to_host, &chunk).await;
    }
}

/// Hands bytes over to the line, which has no flow control and takes every byte in its time.
///
/// Where there is no room for all of them, the driver of embassy-stm32 0.6.0 takes none, and does not wake who waits for
/// room: so it is asked again. It starts the line only if nothing was left to send when it began to copy, though the last
/// byte may leave meanwhile: so its interrupt is asked for whatever was left.
async fn send(to_host: &mut BufferedUartTx<'static>, bytes: &[u8]) {
    if bytes.is_empty() {
        return;
    }
    while let Either::Second(()) =
        select(to_host.write(bytes), Timer::after_millis(REPORT_MS)).await
    {}
    interrupt::LPUART1.pend();
}
