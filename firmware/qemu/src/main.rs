//! The firmware on QEMU's mps2-an386: answers a host over two named pipes.
//!
//! Every task runs in an interrupt executor, and the main loop sleeps by `wfi`: QEMU takes the thread executor's
//! `wfe` for a yield and is then ten times slower.
#![no_std]
#![no_main]

mod boot;
mod clock;
mod counter;
mod fatal;
mod link;
mod timer;
mod vectors;

use boot::QemuBoard;
use defmt_semihosting as _;
use embassy_executor::InterruptExecutor;
use leg_firmware::recorder::Recorder;
use leg_firmware_bench::exit::Exit;
use leg_firmware_bench::server::Server;
use static_cell::ConstStaticCell;
use vectors::Interrupt;

/// Runs the task that answers the host. The clock's interrupts stand above it.
static LINK_EXECUTOR: InterruptExecutor = InterruptExecutor::new();

#[cortex_m_rt::entry]
fn main() -> ! {
    vectors::set_priorities();
    clock::start();
    let spawner = LINK_EXECUTOR.start(Interrupt::Link);
    match answer_host() {
        Ok(task) => spawner.spawn(task),
        Err(_) => fatal::end(Exit::NoTask),
    }
    loop {
        cortex_m::asm::wfi();
    }
}

/// Checks the board, then answers the host until it closes the link.
#[embassy_executor::task]
async fn answer_host() {
    let board = match QemuBoard::check().await {
        Ok(board) => board,
        Err(exit) => fatal::end(exit),
    };
    static RECORDER: ConstStaticCell<Recorder> = ConstStaticCell::new(Recorder::new());
    let mut server = Server::new(board, RECORDER.take());
    fatal::end(link::serve(&mut server).await);
}

#[allow(
    unsafe_code,
    reason = "the vector table names its handlers without mangling"
)]
#[unsafe(no_mangle)]
extern "C" fn LINK() {
    // SAFETY: this is the handler of the interrupt that the executor was started with, and the interrupt is masked
    // until then.
    unsafe { LINK_EXECUTOR.on_interrupt() }
}
