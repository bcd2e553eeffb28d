//! The peripherals of the chip, and what passes between them.

mod inputs;
mod lines;
mod pins;
mod system_breaks;

pub use system_breaks::SystemBreak;

use crate::adc::AdcConverters;
use crate::board::Board;
use crate::device::{Context, Device, FieldPlace};
use crate::encoder_timer::EncoderTimer;
use crate::facts::{Block, Facts, Pin};
use crate::fdcan::Fdcan;
use crate::flash::Flash;
use crate::gpio::Gpio;
use crate::iwdg::Iwdg;
use crate::lpuart::Lpuart;
use crate::plain::Plain;
use crate::pwr::Pwr;
use crate::rcc::Rcc;
use crate::tim1::Tim1;
use crate::tim15::Tim15;
use crate::wwdg::Wwdg;
use inputs::Inputs;
use lines::Lines;
use std::cell::RefCell;
use std::collections::BTreeMap;

/// The timers of the encoders, in the order of the motors.
const ENCODER_TIMERS: [&str; 3] = ["TIM2", "TIM3", "TIM4"];

/// The message RAM of FDCAN2.
const MESSAGE_RAM: &str = "FDCANRAM2";

/// The chip's own voltage of 1.212 V with a supply of 3.3 V: a sum of 16 conversions.
const REFERENCE_SUM: u16 = (1_212 * 16 * 4_095 / 3_300) as u16;

/// Registers of SYSCFG whose bits only a reset clears: RM0440, SYSCFG_CFGR2 and SYSCFG_SWPR.
const LASTING: [&str; 2] = ["CFGR2", "SWPR"];

/// The peripherals.
#[derive(Clone)]
pub struct Devices {
    /// RCC.
    pub rcc: Rcc,
    /// PWR.
    pub pwr: Pwr,
    /// The ports.
    pub ports: Vec<Gpio>,
    /// DBGMCU.
    pub dbgmcu: Plain,
    /// FLASH and its memory.
    pub flash: Flash,
    /// LPUART1.
    pub lpuart: Lpuart,
    /// FDCAN2 and its message RAM.
    pub fdcan: Fdcan,
    /// IWDG.
    pub iwdg: Iwdg,
    /// WWDG.
    pub wwdg: Wwdg,
    /// TIM1.
    pub tim1: Tim1,
    /// TIM15.
    pub tim15: Tim15,
    /// TIM2 to TIM4.
    pub encoders: [EncoderTimer; 3],
    /// ADC1 to ADC3.
    pub converters: AdcConverters,
    /// What the board gives the converters, by pin: sums of 16 conversions.
    pub analogue: BTreeMap<Pin, u16>,
    /// The chip's own voltage at a converter, which the supply of the chip is the reference of: a sum of 16 conversions.
    pub reference: u16,
    /// What was converted last, by pin.
    sampled: RefCell<BTreeMap<Pin, u16>>,
    /// SYSCFG.
    pub syscfg: Plain,
    /// The processor has locked up.
    pub locked_up: bool,
    debug_in_sleep: FieldPlace,
    /// The offset of SYSCFG_SWPR.
    ccm_protection: u32,
    watchdog_halts: [FieldPlace; 2],
    updated: bool,
    /// The pins that are routed to the breaks, and their levels.
    break_pins: [Option<Pin>; 2],
    break_levels: [bool; 2],
    lines: Lines,
}

/// A block that the chip has.
fn block(name: &str) -> &'static Block {
    match Facts::chip().block(name) {
        Some(block) => block,
        None => panic!("the chip has no {name}"),
    }
}

impl Devices {
    /// After a power-up.
    #[must_use]
    pub fn new(board: &Board) -> Self {
        let facts = Facts::chip();
        let dbgmcu = Plain::new(block("DBGMCU"));
        let syscfg = Plain::new(block("SYSCFG")).with_lasting(&LASTING);
        let ports = facts.blocks.iter().filter(|b| b.name.starts_with("GPIO"));
        Self {
            rcc: Rcc::new(block("RCC"), board.crystal_hz),
            pwr: Pwr::new(block("PWR")),
            ports: ports.map(|block| Gpio::new(block, facts)).collect(),
            flash: Flash::new(board.dual_bank, board.brown_out_level, board.seed),
            lpuart: Lpuart::new(),
            fdcan: Fdcan::new(board.can),
            iwdg: Iwdg::new(board.lsi_hz),
            wwdg: Wwdg::new(block("WWDG")),
            tim1: Tim1::new(block("TIM1")),
            tim15: Tim15::new(block("TIM15")),
            encoders: ENCODER_TIMERS.map(|name| EncoderTimer::new(block(name))),
            converters: AdcConverters::new(facts),
            analogue: BTreeMap::new(),
            reference: REFERENCE_SUM,
            sampled: RefCell::default(),
            debug_in_sleep: dbgmcu.registers().field("CR", "DBG_SLEEP"),
            watchdog_halts: ["IWDG", "WWDG"].map(|dog| dbgmcu.registers().field("APB1LFZR", dog)),
            dbgmcu,
            ccm_protection: syscfg.registers().offset("SWPR"),
            syscfg,
            locked_up: false,
            updated: false,
            break_pins: [None; 2],
            break_levels: [false; 2],
            lines: Lines::new(),
        }
    }

    /// The processor reads a register; none where the block is not modelled.
    pub fn read(&mut self, block: &str, offset: u32, context: &mut Context<'_>) -> Option<u32> {
        if block.starts_with("ADC") {
            let inputs = Inputs {
                ports: &self.ports,
                analogue: &self.analogue,
                reference: self.reference,
                sampled: &self.sampled,
            };
            return self.converters.read(block, offset, &inputs, context);
        }
        if block == MESSAGE_RAM {
            return Some(self.fdcan.read_memory(offset));
        }
        Some(self.device(block)?.read(offset, context))
    }

    /// The processor writes a register; none where the block is not modelled.
    pub fn write(
        &mut self,
        block: &str,
        (offset, value): (u32, u32),
        context: &mut Context<'_>,
    ) -> Option<()> {
        if block.starts_with("ADC") {
            let inputs = Inputs {
                ports: &self.ports,
                analogue: &self.analogue,
                reference: self.reference,
                sampled: &self.sampled,
            };
            let place = (offset, value);
            return self.converters.write(block, place, &inputs, context);
        }
        if block == MESSAGE_RAM {
            self.fdcan.write_memory(offset, value, context);
            return Some(());
        }
        self.device(block)?.write(offset, value, context);
        Some(())
    }

    /// The pages of the CCM that SYSCFG protects, bit by number.
    #[must_use]
    pub fn protected_ccm_pages(&self) -> u32 {
        self.syscfg.registers().get(self.ccm_protection)
    }

    /// What an input was when it was converted last; none before.
    #[must_use]
    pub fn sampled(&self, pin: Pin) -> Option<u16> {
        self.sampled.borrow().get(&pin).copied()
    }

    /// The peripheral of a block; none where it is not modelled.
    fn device(&mut self, name: &str) -> Option<&mut dyn Device> {
        let named = |block: &Block| block.name == name;
        Some(match name {
            "RCC" => &mut self.rcc,
            "PWR" => &mut self.pwr,
            "DBGMCU" => &mut self.dbgmcu,
            "FLASH" => &mut self.flash,
            "LPUART1" => &mut self.lpuart,
            "FDCAN2" => &mut self.fdcan,
            "IWDG" => &mut self.iwdg,
            "WWDG" => &mut self.wwdg,
            "TIM1" => &mut self.tim1,
            "TIM15" => &mut self.tim15,
            _ if name.starts_with("GPIO") => self.ports.iter_mut().find(|p| named(p.block()))?,
            "SYSCFG" => &mut self.syscfg,
            _ => {
                let timer = ENCODER_TIMERS.iter().position(|timer| *timer == name)?;
                self.encoders.get_mut(timer)?
            }
        })
    }

    fn all(&mut self) -> impl Iterator<Item = &mut dyn Device> {
        let single: [&mut dyn Device; 10] = [
            &mut self.rcc,
            &mut self.pwr,
            &mut self.syscfg,
            &mut self.flash,
            &mut self.lpuart,
            &mut self.fdcan,
            &mut self.iwdg,
            &mut self.wwdg,
            &mut self.tim1,
            &mut self.tim15,
        ];
        let encoders = self.encoders.iter_mut().map(|d| d as &mut dyn Device);
        let ports = self.ports.iter_mut().map(|d| d as &mut dyn Device);
        single.into_iter().chain(encoders).chain(ports)
    }

    /// All back to what a reset of the chip gives. DBGMCU is reset by a power-up alone: RM0440, DBGMCU_CR.
    pub fn reset(&mut self) {
        self.all().for_each(Device::reset);
        self.converters.reset_all();
        self.locked_up = false;
        self.break_levels = [false; 2];
        self.updated = false;
    }

    /// A block that the image holds in reset is as after a reset of the chip.
    pub fn reset_block(&mut self, block: &str) {
        if block.starts_with("ADC") {
            self.converters.reset(block);
        } else if let Some(device) = self.device(block) {
            device.reset();
        }
        self.break_levels = [false; 2];
    }

    /// Lets everything happen that is due, and hands on what passes between peripherals.
    pub fn advance(&mut self, context: &mut Context<'_>) {
        self.route_breaks(context);
        self.tim1.set_system_break(self.system_break(), context);
        for device in self.acting() {
            if device.next_event().is_some_and(|at| at <= context.cycle) {
                device.advance(context);
            }
        }
        let inputs = Inputs {
            ports: &self.ports,
            analogue: &self.analogue,
            reference: self.reference,
            sampled: &self.sampled,
        };
        self.converters.advance(&inputs, context);
        if let Some(cycle) = self.tim1.take_trigger() {
            self.updated = true;
            self.converters.trigger(cycle, &inputs, context);
        }
    }

    /// Whether the processor's clock goes on while it sleeps, for a debugger.
    #[must_use]
    pub fn debug_in_sleep(&self) -> bool {
        let registers = self.dbgmcu.registers();
        registers.is_set(self.debug_in_sleep)
    }

    /// A debugger has both watchdogs stand still in a halt.
    pub fn rest_watchdogs_in_halt(&mut self) {
        for place in self.watchdog_halts {
            self.dbgmcu.set_value(place, 1);
        }
    }

    /// A debugger has halted the processor for some cycles: the watchdogs that DBGMCU stops meanwhile count later.
    pub fn halt_watchdogs(&mut self, cycles: u64) {
        let halts = |place| self.dbgmcu.registers().is_set(place);
        let [iwdg, wwdg] = self.watchdog_halts.map(halts);
        if iwdg {
            self.iwdg.halt(cycles);
        }
        if wwdg {
            self.wwdg.halt(cycles);
        }
    }

    /// Whether the pulse timer has come to its update since the last question.
    pub fn take_update(&mut self) -> bool {
        std::mem::take(&mut self.updated)
    }

    /// The next cycle in which something happens by itself.
    pub fn next_event(&mut self) -> Option<u64> {
        let acting = self.acting().into_iter();
        let next = acting.filter_map(|device| device.next_event()).min();
        next.into_iter().chain(self.converters.next_event()).min()
    }

    /// Those in which something happens by itself.
    fn acting(&mut self) -> [&mut dyn Device; 7] {
        [
            &mut self.tim1,
            &mut self.tim15,
            &mut self.flash,
            &mut self.lpuart,
            &mut self.fdcan,
            &mut self.iwdg,
            &mut self.wwdg,
        ]
    }

    /// The lines of interrupts that are high, bit by number.
    pub fn interrupts(&mut self) -> u128 {
        let lines = &mut self.lines;
        lines.clear();
        for (name, level) in self.tim1.interrupts() {
            lines.raise(name, level);
        }
        for (name, level) in self.tim15.interrupts() {
            lines.raise(name, level);
        }
        for (name, level) in self.converters.interrupts() {
            lines.raise(name, level);
        }
        lines.raise("FLASH", self.flash.interrupt());
        lines.raise("WWDG", self.wwdg.interrupt());
        lines.raise("LPUART1", self.lpuart.interrupt());
        let [first, second] = self.fdcan.interrupt_lines();
        lines.raise("FDCAN2_IT0", first);
        lines.raise("FDCAN2_IT1", second);
        for (name, timer) in ENCODER_TIMERS.iter().zip(&self.encoders) {
            lines.raise(name, timer.interrupt());
        }
        lines.levels
    }
}
