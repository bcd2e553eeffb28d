//! The link to the host: LPUART1, which the board's debugger passes on as a USB serial port.

use embassy_stm32::peripherals::{LPUART1, PA2, PA3};
use embassy_stm32::usart::{BufferedInterruptHandler, BufferedUart, Config, ConfigError};
use embassy_stm32::{Peri, bind_interrupts};
use embedded_io_async::{Read, Write};
use leg_firmware::counter::Counter;
use leg_firmware::frame::{Decoder, MAX_FRAME};
use leg_firmware::protocol::{self, BoardInfo};
use leg_firmware::server::{self, Server};
use leg_firmware::settings::Settings;
use static_cell::StaticCell;

const BAUD: u32 = 921_600;

bind_interrupts!(struct Interrupts {
    LPUART1 => BufferedInterruptHandler<LPUART1>;
});

/// The board as the server sees it.
struct Nucleo;

impl Counter for Nucleo {
    /// The chip counts cycles, not instructions.
    fn count<A, B>(&mut self, _: fn(&A, &mut B), _: &A, _: &mut B) -> Option<u32> {
        None
    }
}

impl server::Board for Nucleo {
    fn info(&self) -> BoardInfo {
        BoardInfo {
            board: protocol::Board::Stm32g474,
            boot: None,
        }
    }

    fn save(&mut self, _settings: &Settings) -> bool {
        false
    }
}

/// Opens the serial line at 921 600 baud, 8 bits, no parity, one stop bit.
pub fn open(
    lpuart: Peri<'static, LPUART1>,
    receive: Peri<'static, PA3>,
    transmit: Peri<'static, PA2>,
) -> Result<BufferedUart<'static>, ConfigError> {
    static TO_HOST: StaticCell<[u8; MAX_FRAME]> = StaticCell::new();
    static FROM_HOST: StaticCell<[u8; MAX_FRAME]> = StaticCell::new();
    let mut config = Config::default();
    config.baudrate = BAUD;
    BufferedUart::new(
        lpuart,
        receive,
        transmit,
        TO_HOST.init([0; MAX_FRAME]),
        FROM_HOST.init([0; MAX_FRAME]),
        Interrupts,
        config,
    )
}

/// Answers the host for ever. A damaged byte costs its frame and no more.
pub async fn serve(mut uart: BufferedUart<'static>) -> ! {
    let mut server = Server::new(Nucleo);
    let mut decoder = Decoder::new();
    let mut received = [0; 64];
    let mut out = [0; MAX_FRAME];
    loop {
        let length = match uart.read(&mut received).await {
            Ok(length) => length,
            Err(error) => {
                defmt::warn!("serial line: {}", error);
                continue;
            }
        };
        for &byte in received.get(..length).unwrap_or_default() {
            let Some(request) = decoder.push(byte) else {
                continue;
            };
            match server.answer(request, &mut out) {
                Ok(reply) => {
                    if let Err(error) = uart.write_all(reply).await {
                        defmt::warn!("serial line: {}", error);
                    }
                }
                Err(_) => defmt::error!("a reply is too long for a frame"),
            }
        }
    }
}
