//! The CAN FD bus to the host: FDCAN2, under the address that the board's switches choose.

use crate::link::{REPORT_MS, Session};
use core::num::{NonZeroU8, NonZeroU16};
use embassy_futures::select::{Either3, select3};
use embassy_stm32::can::config::{
    DataBitTiming, FdCanConfig, FrameTransmissionConfig, GlobalFilter, NominalBitTiming,
    TxBufferMode,
};
use embassy_stm32::can::filter::{Action, Filter, FilterType, StandardFilterSlot};
use embassy_stm32::can::frame::{FdFrame, Header};
use embassy_stm32::can::{
    Can, CanConfigurator, CanRx, CanTx, IT0InterruptHandler, IT1InterruptHandler,
};
use embassy_stm32::pac;
use embassy_stm32::peripherals::{FDCAN2, PB12, PB13};
use embassy_stm32::{Peri, bind_interrupts};
use embassy_time::{Duration, Instant, Timer};
use embedded_can::{Id, StandardId};
use heapless::Vec;
use leg_firmware::can::{
    Assembler, BusAction, BusGuard, BusState, CanFrame, Identifier, LegAddress, NOMINAL_BIT_RATE,
    Segmenter,
};
use leg_firmware::frame::MAX_FRAME;

bind_interrupts!(struct Interrupts {
    FDCAN2_IT0 => IT0InterruptHandler<FDCAN2>;
    FDCAN2_IT1 => IT1InterruptHandler<FDCAN2>;
});

/// A CAN frame that the bus does not take in this time is given up, with the link frame that it belongs to.
const SEND_TIME: Duration = Duration::from_millis(20);

/// 170 MHz / 170 = 1 Mbit/s, sampled at 75.3 %: `leg_firmware::can::SAMPLE_POINT_PERMILLE`. A host that samples at 75 % ends the bit in which it
/// changes the rate after 800 ns: at 80 % the board would read it there.
const NOMINAL: [u8; 3] = [127, 42, 42];

/// 170 MHz / 34 = 5 Mbit/s, sampled at 76 %.
const DATA: [u8; 3] = [25, 8, 8];

/// Where in a bit the transmitter samples what it sent itself, which its transceiver delays by more than the bit: as
/// far in as receivers do, in cycles of 170 MHz.
const DELAYED_SAMPLE: u8 = 26;

const SLOTS: [StandardFilterSlot; 3] = [
    StandardFilterSlot::_0,
    StandardFilterSlot::_1,
    StandardFilterSlot::_2,
];

/// The leg's node on the bus.
pub struct Node {
    segmenter: Segmenter,
    bus: Bus,
}

/// The controller, and what arrives.
struct Bus {
    tx: CanTx<'static>,
    rx: CanRx<'static>,
    assembler: Assembler,
    guard: BusGuard,
    watched: Instant,
}

/// Joins the bus.
pub fn open(
    fdcan: Peri<'static, FDCAN2>,
    receive: Peri<'static, PB12>,
    transmit: Peri<'static, PB13>,
    leg: LegAddress,
) -> Node {
    let mut configurator = CanConfigurator::new(fdcan, receive, transmit, Interrupts);
    let properties = configurator.properties();
    for (slot, identifier) in SLOTS.into_iter().zip(Identifier::received_by(leg)) {
        if let Some(id) = StandardId::new(identifier.bits()) {
            properties.set_standard_filter(
                slot,
                Filter {
                    filter: FilterType::DedicatedSingle(id),
                    action: Action::StoreInFifo0,
                },
            );
        }
    }
    configurator.set_config(config(configurator.config()));
    let (tx, rx, _) = started(configurator).split();
    Node {
        segmenter: Segmenter::new(Identifier::ToHost(leg)),
        bus: Bus {
            tx,
            rx,
            assembler: Assembler::leg_receiver(leg),
            guard: BusGuard::new(NOMINAL_BIT_RATE),
            watched: Instant::now(),
        },
    }
}

fn config(before: FdCanConfig) -> FdCanConfig {
    let [nominal_1, nominal_2, nominal_jump] = NOMINAL.map(non_zero);
    let [data_1, data_2, data_jump] = DATA.map(non_zero);
    FdCanConfig {
        nbtr: NominalBitTiming {
            prescaler: NonZeroU16::MIN,
            seg1: nominal_1,
            seg2: nominal_2,
            sync_jump_width: nominal_jump,
        },
        dbtr: DataBitTiming {
            transceiver_delay_compensation: true,
            prescaler: NonZeroU16::MIN,
            seg1: data_1,
            seg2: data_2,
            sync_jump_width: data_jump,
        },
        frame_transmit: FrameTransmissionConfig::AllowFdCanAndBRS,
        global_filter: GlobalFilter::reject_all(),
        tx_buffer_mode: TxBufferMode::Fifo,
        automatic_bus_off_recovery: false,
        ..before
    }
}

fn non_zero(number: u8) -> NonZeroU8 {
    NonZeroU8::new(number).unwrap_or(NonZeroU8::MIN)
}

/// Starts the controller, and lets it make up for its transceiver's delay: the driver leaves that out.
fn started(configurator: CanConfigurator<'static>) -> Can<'static> {
    let can = configurator.into_normal_mode();
    let registers = pac::FDCAN2;
    registers.cccr().modify(|w| w.set_init(true));
    while !registers.cccr().read().init() {}
    registers.cccr().modify(|w| w.set_cce(true));
    registers.dbtp().modify(|w| w.set_tdc(true));
    registers.tdcr().write(|w| w.set_tdco(DELAYED_SAMPLE));
    registers.cccr().modify(|w| w.set_cce(false));
    registers.cccr().modify(|w| w.set_init(false));
    can
}

/// Serves the host for ever.
#[embassy_executor::task]
pub async fn serve(mut node: Node, session: &'static mut Session) {
    loop {
        node.bus.wait(session, None).await;
        node.bus.watch();
        session.turn();
        node.send_waiting(session).await;
    }
}

impl Node {
    /// Sends one link frame, if one waits; gives it up where the bus does not take it.
    async fn send_waiting(&mut self, session: &mut Session) {
        let mut link_frame: Vec<u8, MAX_FRAME> = Vec::new();
        while let Some(byte) = session.transmit() {
            // There is room: it is one whole link frame.
            let _ = link_frame.push(byte);
            if byte == 0 {
                break;
            }
        }
        // None waits if this is refused.
        let Ok(segments) = self.segmenter.segments(&link_frame) else {
            return;
        };
        for segment in segments {
            if !self.bus.send(session, &segment).await {
                return;
            }
        }
    }
}

impl Bus {
    /// Hands a CAN frame to the controller; false if it does not take it.
    async fn send(&mut self, session: &mut Session, segment: &CanFrame) -> bool {
        let Some(frame) = to_bus(segment) else {
            return false;
        };
        let start = Instant::now();
        while self.guard.state() != BusState::BusOff && start.elapsed() < SEND_TIME {
            if self.wait(session, Some(&frame)).await {
                return true;
            }
            self.watch();
        }
        drop_waiting();
        false
    }

    /// Waits until `frame` is handed over, for a CAN frame and passes on what that brings, or for the next report. True
    /// in the first case.
    async fn wait(&mut self, session: &mut Session, frame: Option<&FdFrame>) -> bool {
        session.alive();
        let handed_over = async {
            match frame {
                Some(frame) => self.tx.write_fd(frame).await,
                None => core::future::pending().await,
            }
        };
        let pause = Timer::after_millis(REPORT_MS);
        match select3(handed_over, self.rx.read_fd(), pause).await {
            Either3::First(_) => return true,
            Either3::Second(Ok(envelope)) => {
                if let Some(frame) = from_bus(&envelope.frame) {
                    let taken = self.assembler.push(&frame);
                    session.receive(taken.link_frame.unwrap_or_default());
                }
            }
            // The controller counts errors itself; `watch` looks at what comes of them.
            Either3::Second(Err(_)) | Either3::Third(()) => {}
        }
        false
    }

    /// Looks whether the bus is lost, and brings it back in its time.
    fn watch(&mut self) {
        let now = Instant::now();
        let since = now.duration_since(self.watched).as_micros();
        self.watched = now;
        let since_us = u32::try_from(since).unwrap_or(u32::MAX);
        match self.guard.watch(bus_state(), since_us) {
            BusAction::None => {}
            BusAction::GiveUp => {
                defmt::warn!("the CAN bus is off");
                drop_waiting();
            }
            BusAction::Restart => pac::FDCAN2.cccr().modify(|w| w.set_init(false)),
        }
    }
}

fn bus_state() -> BusState {
    let status = pac::FDCAN2.psr().read();
    match (status.bo(), status.ep()) {
        (true, _) => BusState::BusOff,
        (false, true) => BusState::ErrorPassive,
        (false, false) => BusState::ErrorActive,
    }
}

/// Takes back what the controller has not sent yet.
fn drop_waiting() {
    pac::FDCAN2.txbcr().write(|w| {
        for buffer in 0..3 {
            w.set_cr(buffer, true);
        }
    });
}

fn to_bus(frame: &CanFrame) -> Option<FdFrame> {
    let id = Id::Standard(StandardId::new(frame.identifier().bits())?);
    let payload = frame.payload();
    let header = Header::new_fd(id, u8::try_from(payload.len()).ok()?, false, true);
    FdFrame::new(header, payload).ok()
}

fn from_bus(frame: &FdFrame) -> Option<CanFrame> {
    match frame.header().id() {
        Id::Standard(id) => CanFrame::new(Identifier::from_bits(id.as_raw())?, frame.data()).ok(),
        Id::Extended(_) => None,
    }
}
