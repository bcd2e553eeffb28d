//! RCC: oscillators, PLL, prescalers, and the switches of every other block's clock and reset.

mod fields;
mod oscillator;

use crate::clocks::Clocks;
use crate::device::{Context, Device, FieldPlace, RegisterFile};
use crate::facts::{Block, Switch};
use fields::Fields;
use oscillator::Oscillator;

/// Frequency of the internal oscillator, Hz.
const HSI_HZ: u32 = 16_000_000;

/// Time until an oscillator or the PLL is ready, µs: longest of the datasheet, crystal apart, whose own is typical.
const HSI_START_US: u64 = 4;
const HSE_START_US: u64 = 2_000;
const PLL_LOCK_US: u64 = 40;
const HSI48_START_US: u64 = 6;
const LSI_START_US: u64 = 130;

/// Limits of the PLL, Hz: datasheet of the STM32G474, PLL characteristics.
const PLL_INPUT_HZ: [u32; 2] = [2_660_000, 16_000_000];
const PLL_VCO_HZ: [u32; 2] = [96_000_000, 344_000_000];

/// Why a chip started. The flags add up until software clears them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetCause {
    /// Supply below its lowest level; also every power-up.
    BrownOut,
    /// The reset pin.
    Pin,
    /// The processor asked for it.
    Software,
    /// The independent watchdog.
    IndependentWatchdog,
    /// The window watchdog.
    WindowWatchdog,
}

/// The block.
#[derive(Clone, Debug)]
pub struct Rcc {
    registers: RegisterFile,
    fields: Fields,
    /// The crystal on the board, Hz; 0 while it stands still.
    crystal_hz: u32,
    hsi: Oscillator,
    hse: Oscillator,
    pll: Oscillator,
    hsi48: Oscillator,
    lsi: Oscillator,
    /// Whether something has changed of which frequencies depend.
    changed: bool,
}

impl Rcc {
    /// After a power-up, on a board with a crystal.
    #[must_use]
    pub fn new(block: &'static Block, crystal_hz: u32) -> Self {
        let registers = RegisterFile::new(block);
        let mut rcc = Self {
            fields: Fields::new(&registers),
            registers,
            crystal_hz,
            hsi: Oscillator::default(),
            hse: Oscillator::default(),
            pll: Oscillator::default(),
            hsi48: Oscillator::default(),
            lsi: Oscillator::default(),
            changed: true,
        };
        rcc.reset();
        rcc
    }

    /// Adds a flag to those that tell why the chip started.
    pub fn note_cause(&mut self, cause: ResetCause) {
        let flags: &[&str] = match cause {
            ResetCause::BrownOut => &["BORRSTF", "PINRSTF"],
            ResetCause::Pin => &["PINRSTF"],
            // The chip pulls its own reset pin.
            ResetCause::Software => &["SFTRSTF", "PINRSTF"],
            ResetCause::IndependentWatchdog => &["IWDGRSTF", "PINRSTF"],
            ResetCause::WindowWatchdog => &["WWDGRSTF", "PINRSTF"],
        };
        for flag in flags {
            let place = self.registers.field("CSR", flag);
            self.registers.set_value(place, 1);
        }
    }

    /// The supply was gone: only what follows is told.
    pub fn forget_causes(&mut self) {
        self.registers.set(self.fields.remove_flags.offset, 0);
    }

    /// Whether a block's clock is on.
    #[must_use]
    pub fn enabled(&self, switch: Switch) -> bool {
        self.registers.get(switch.offset) >> switch.bit & 1 == 1
    }

    /// Whether the frequencies may have changed since the last call.
    pub fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// The crystal stops: if the chip watches it, that is a failure of the clock.
    pub fn stop_crystal(&mut self) {
        self.crystal_hz = 0;
        self.changed = true;
        let watched =
            self.registers.is_set(self.fields.css_on) && self.registers.is_set(self.fields.hse_on);
        if watched {
            self.registers.set_value(self.fields.css_flag, 1);
            self.registers.set_value(self.fields.hse_on, 0);
            self.registers.set_value(self.fields.pll_on, 0);
            self.registers.set_value(self.fields.source, SOURCE_HSI);
            self.hse = Oscillator::default();
            self.pll = Oscillator::default();
            self.hsi.ready_at.get_or_insert(0);
        }
    }

    /// Whether the crystal has failed, and the program has not cleared the flag: the processor gets an NMI, and TIM1 a break.
    #[must_use]
    pub fn clock_failed(&self) -> bool {
        self.registers.is_set(self.fields.css_flag)
    }

    /// What the processor and the buses run from, Hz.
    fn system_hz(&self, cycle: u64) -> u32 {
        match self.source(cycle) {
            SOURCE_HSE => self.crystal_hz,
            SOURCE_PLL => self.pll_hz(),
            _ => HSI_HZ,
        }
    }

    /// The source in use: the one that is chosen as soon as it is ready.
    fn source(&self, cycle: u64) -> u32 {
        let chosen = self.registers.value(self.fields.source);
        let ready = match chosen {
            SOURCE_HSE => self.hse.ready(cycle),
            SOURCE_PLL => self.pll_gives(cycle),
            _ => true,
        };
        if ready { chosen } else { SOURCE_HSI }
    }

    /// Whether the PLL has locked, and its output R is on.
    fn pll_gives(&self, cycle: u64) -> bool {
        self.pll.ready(cycle) && self.registers.is_set(self.fields.pll_r_on)
    }

    fn pll_hz(&self) -> u32 {
        self.vco_hz() / (2 * (self.registers.value(self.fields.pll_r) + 1))
    }

    fn pll_input_hz(&self) -> u32 {
        let input = match self.registers.value(self.fields.pll_source) {
            PLL_FROM_HSI => HSI_HZ,
            PLL_FROM_HSE => self.crystal_hz,
            _ => 0,
        };
        input / (self.registers.value(self.fields.pll_divider) + 1)
    }

    fn vco_hz(&self) -> u32 {
        self.pll_input_hz() * self.registers.value(self.fields.pll_factor)
    }

    /// The frequencies of the moment.
    #[must_use]
    pub fn clocks(&self, cycle: u64) -> Clocks {
        let system = self.system_hz(cycle);
        let hclk = system / ahb_divider(self.registers.value(self.fields.ahb));
        let [pclk1, timers1] = apb(hclk, self.registers.value(self.fields.apb1));
        let [pclk2, timers2] = apb(hclk, self.registers.value(self.fields.apb2));
        let chosen = |field| self.registers.value(field);
        Clocks {
            hclk,
            pclk1,
            pclk2,
            timers1,
            timers2,
            adc12: adc_hz(chosen(self.fields.adc12), system),
            adc345: adc_hz(chosen(self.fields.adc345), system),
            lpuart1: match chosen(self.fields.lpuart1) {
                0 => pclk1,
                1 => system,
                2 => HSI_HZ,
                _ => 0,
            },
            fdcan: match chosen(self.fields.fdcan) {
                FDCAN_FROM_HSE if self.hse.is_on() => self.crystal_hz,
                FDCAN_FROM_PCLK => pclk1,
                _ => 0,
            },
        }
    }

    /// The PLL is switched on: its source and its rates.
    fn check_pll(&self, context: &mut Context<'_>) {
        let within = |value, [low, high]: [u32; 2]| (low..=high).contains(&value);
        let (input, vco) = (self.pll_input_hz(), self.vco_hz());
        if !within(input, PLL_INPUT_HZ) {
            context.findings.add(format!(
                "RCC_PLLCFGR: the PLL's input is {input} Hz, outside of {PLL_INPUT_HZ:?}"
            ));
        }
        if !within(vco, PLL_VCO_HZ) {
            context.findings.add(format!(
                "RCC_PLLCFGR: the PLL's oscillator is at {vco} Hz, outside of {PLL_VCO_HZ:?}"
            ));
        }
        let ready = match self.registers.value(self.fields.pll_source) {
            PLL_FROM_HSI => self.hsi.ready(context.cycle),
            PLL_FROM_HSE => self.hse.ready(context.cycle),
            _ => true,
        };
        if !ready {
            let text = "RCC_CR: PLLON is set while the PLL's source is not ready";
            context.findings.add(text);
        }
    }

    /// What the processor's clock depends on, directly or through the PLL, has to stay on; and the crystal's bypass must not
    /// change under it. As ST's description says at the fields.
    fn check_oscillators(&self, value: u32, context: &mut Context<'_>) {
        let fields = self.fields;
        let on = |field: FieldPlace| field.extract(value) != 0;
        let source = self.source(context.cycle);
        let of_pll = self.registers.value(fields.pll_source);
        let pll_stays = self.pll.is_on() && on(fields.pll_on);
        let chip = |used: bool| used.then_some("the chip runs from it");
        let pll = |used: bool| (used && pll_stays).then_some("the PLL runs from it");
        let switches = [
            (chip(source == SOURCE_HSI), fields.hsi_on, "HSI"),
            (pll(of_pll == PLL_FROM_HSI), fields.hsi_on, "HSI"),
            (chip(source == SOURCE_HSE), fields.hse_on, "HSE"),
            (pll(of_pll == PLL_FROM_HSE), fields.hse_on, "HSE"),
            (chip(source == SOURCE_PLL), fields.pll_on, "PLL"),
        ];
        for (used, field, name) in switches {
            if let Some(how) = used.filter(|_| !on(field)) {
                let text = format!("RCC_CR: {name} is switched off while {how}");
                context.findings.add(text);
            }
        }
        if self.hse.is_on() && on(fields.hse_bypass) != self.registers.is_set(fields.hse_bypass) {
            let text = "RCC_CR: HSEBYP is changed while HSE is on";
            context.findings.add(text);
        }
    }

    fn write_control(&mut self, value: u32, context: &mut Context<'_>) {
        self.check_oscillators(value, context);
        let fields = self.fields;
        let on = |field: FieldPlace| field.extract(value) != 0;
        let crystal = on(fields.hse_on) && self.crystal_hz > 0;
        self.hsi.switch(on(fields.hsi_on), HSI_START_US, context);
        self.hse.switch(crystal, HSE_START_US, context);
        if on(fields.pll_on) && !self.pll.is_on() {
            self.check_pll(context);
        }
        self.pll.switch(on(fields.pll_on), PLL_LOCK_US, context);
        self.registers.set(fields.hsi_on.offset, value);
    }

    /// FDCAN needs the clock that it is given: HSE may be off, and PLL Q is not modelled.
    fn check_fdcan(&self, context: &mut Context<'_>) {
        let fields = &self.fields;
        let text = match self.registers.value(fields.fdcan) {
            FDCAN_FROM_HSE if !self.hse.is_on() => {
                "RCC_CCIPR: FDCANSEL gives FDCAN HSE, which is off"
            }
            FDCAN_FROM_PLL => "RCC_CCIPR: FDCANSEL gives FDCAN PLL Q, which is not modelled",
            _ => return,
        };
        if self.registers.is_set(fields.fdcan_on) {
            context.findings.add(text);
        }
    }

    fn write_pll(&mut self, value: u32, context: &mut Context<'_>) {
        let fields = self.fields;
        let before = self.registers.get(fields.pll_source.offset);
        let fixed = [
            fields.pll_source,
            fields.pll_divider,
            fields.pll_factor,
            fields.pll_r,
        ];
        if self.pll.is_on() && fixed.iter().any(|f| f.extract(before) != f.extract(value)) {
            context
                .findings
                .add("RCC_PLLCFGR: source, M, N or R is changed while the PLL is on");
        }
        if self.source(context.cycle) == SOURCE_PLL && fields.pll_r_on.extract(value) == 0 {
            let text = "RCC_PLLCFGR: PLLREN is cleared while the chip runs from the PLL";
            context.findings.add(text);
        }
        self.registers.set(fields.pll_source.offset, value);
    }

    fn write_configuration(&mut self, value: u32, context: &mut Context<'_>) {
        let ready = match self.fields.source.extract(value) {
            SOURCE_HSI => self.hsi.ready(context.cycle),
            SOURCE_HSE => self.hse.ready(context.cycle),
            SOURCE_PLL => self.pll_gives(context.cycle),
            _ => false,
        };
        if !ready {
            context
                .findings
                .add("RCC_CFGR: SW chooses a source that is not ready");
        }
        self.registers.set(self.fields.source.offset, value);
    }
}

/// Values of SW and SWS.
const SOURCE_HSI: u32 = 1;
const SOURCE_HSE: u32 = 2;
const SOURCE_PLL: u32 = 3;

/// Values of PLLSRC.
const PLL_FROM_HSI: u32 = 2;
const PLL_FROM_HSE: u32 = 3;

/// Values of FDCANSEL.
const FDCAN_FROM_HSE: u32 = 0;
const FDCAN_FROM_PLL: u32 = 1;
const FDCAN_FROM_PCLK: u32 = 2;

/// HPRE: 8 is a half, 15 a 512th, without a 32nd.
fn ahb_divider(value: u32) -> u32 {
    match value {
        0..8 => 1,
        8..12 => 2 << (value - 8),
        _ => 64 << (value - 12),
    }
}

/// PPRE: frequency of a bus and of its timers, which run twice as fast where the bus is divided.
fn apb(hclk: u32, value: u32) -> [u32; 2] {
    match value {
        0..4 => [hclk, hclk],
        _ => {
            let bus = hclk / (2 << (value - 4));
            [bus, 2 * bus]
        }
    }
}

/// ADC12SEL and ADC345SEL: none, PLL P (not modelled), or the system's clock.
fn adc_hz(value: u32, system: u32) -> u32 {
    if value == 2 { system } else { 0 }
}

impl Device for Rcc {
    fn reset(&mut self) {
        // Why the chip started is told until software clears it.
        let causes = self.registers.get(self.fields.remove_flags.offset);
        let kept = causes & !(self.fields.lsi_on.mask | self.fields.lsi_ready.mask);
        self.registers.reset();
        self.registers.set(self.fields.remove_flags.offset, kept);
        self.hsi = Oscillator { ready_at: Some(0) };
        self.hse = Oscillator::default();
        self.pll = Oscillator::default();
        self.hsi48 = Oscillator::default();
        self.lsi = Oscillator::default();
        self.changed = true;
    }

    fn read(&mut self, offset: u32, context: &mut Context<'_>) -> u32 {
        let (fields, cycle) = (self.fields, context.cycle);
        let mut value = self.registers.get(offset);
        let shown = [
            (fields.hsi_ready, u32::from(self.hsi.ready(cycle))),
            (fields.hse_ready, u32::from(self.hse.ready(cycle))),
            (fields.pll_ready, u32::from(self.pll.ready(cycle))),
            (fields.hsi48_ready, u32::from(self.hsi48.ready(cycle))),
            (fields.lsi_ready, u32::from(self.lsi.ready(cycle))),
            (fields.source_status, self.source(cycle)),
        ];
        for (field, now) in shown {
            if field.offset == offset {
                value = field.insert(value, now);
            }
        }
        value
    }

    fn write(&mut self, offset: u32, value: u32, context: &mut Context<'_>) {
        let fields = self.fields;
        self.changed = true;
        if offset == fields.hsi_on.offset {
            self.write_control(value, context);
        } else if offset == fields.pll_source.offset {
            self.write_pll(value, context);
        } else if offset == fields.source.offset {
            self.write_configuration(value, context);
        } else if offset == fields.css_clear.offset {
            if fields.css_clear.extract(value) != 0 {
                self.registers.set_value(fields.css_flag, 0);
            }
        } else if offset == fields.hsi48_on.offset {
            let on = fields.hsi48_on.extract(value) != 0;
            self.hsi48.switch(on, HSI48_START_US, context);
            self.registers.set(offset, value);
        } else if offset == fields.lsi_on.offset {
            let on = fields.lsi_on.extract(value) != 0;
            self.lsi.switch(on, LSI_START_US, context);
            let flags = if fields.remove_flags.extract(value) != 0 {
                0
            } else {
                self.registers.get(offset) & !fields.lsi_on.mask
            };
            self.registers.set(offset, flags);
            self.registers.set_value(fields.lsi_on, u32::from(on));
        } else {
            self.registers.set(offset, value);
        }
        self.check_fdcan(context);
    }
}
