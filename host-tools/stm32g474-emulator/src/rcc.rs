//! RCC: oscillators, PLL, prescalers, and the switches of every other block's clock and reset.

mod checks;
mod fields;
mod oscillator;
mod rates;

use crate::device::{Context, Device, FieldPlace, RegisterFile};
use crate::facts::{Block, Switch};
use fields::RccFields;
use oscillator::Oscillator;
use rates::{SOURCE_HSE, SOURCE_HSI, SOURCE_PLL};

/// Time until an oscillator or the PLL is ready, µs: longest of the datasheet, crystal apart, whose own is typical.
const HSI_START_US: u64 = 4;
const HSE_START_US: u64 = 2_000;
const PLL_LOCK_US: u64 = 40;
const HSI48_START_US: u64 = 6;
const LSI_START_US: u64 = 130;

/// Why a chip started. The flags add up until software clears them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ResetFlag {
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
    fields: RccFields,
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
            fields: RccFields::new(&registers),
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
    pub fn note_cause(&mut self, cause: ResetFlag) {
        let flags: &[&str] = match cause {
            ResetFlag::BrownOut => &["BORRSTF", "PINRSTF"],
            ResetFlag::Pin => &["PINRSTF"],
            // The chip pulls its own reset pin.
            ResetFlag::Software => &["SFTRSTF", "PINRSTF"],
            ResetFlag::IndependentWatchdog => &["IWDGRSTF", "PINRSTF"],
            ResetFlag::WindowWatchdog => &["WWDGRSTF", "PINRSTF"],
        };
        for flag in flags {
            let place = self.registers.field("CSR", flag);
            self.registers.set_value(place, 1);
        }
    }

    /// The supply was gone: only what follows is reported.
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

    /// A crystal that stood still swings again, at so many Hz: who has switched it on, or does then, finds it ready in its time.
    pub fn start_crystal(&mut self, crystal_hz: u32, context: &Context<'_>) {
        self.crystal_hz = crystal_hz;
        let enabled = self.registers.is_set(self.fields.hse_on);
        self.hse.switch(enabled, HSE_START_US, context);
        self.changed = true;
    }

    /// The crystal stops: if the chip watches it, that is a failure of the clock.
    pub fn stop_crystal(&mut self) {
        self.crystal_hz = 0;
        self.changed = true;
        self.hse = Oscillator::default();
        let watched =
            self.registers.is_set(self.fields.css_on) && self.registers.is_set(self.fields.hse_on);
        if watched {
            self.registers.set_value(self.fields.css_flag, 1);
            self.registers.set_value(self.fields.hse_on, 0);
            self.registers.set_value(self.fields.pll_on, 0);
            self.registers.set_value(self.fields.source, SOURCE_HSI);
            self.pll = Oscillator::default();
            self.hsi.ready_at.get_or_insert(0);
        }
    }

    /// Whether the crystal has failed, and the program has not cleared the flag: the processor gets an NMI, and TIM1 a break.
    #[must_use]
    pub fn clock_failed(&self) -> bool {
        self.registers.is_set(self.fields.css_flag)
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

impl Device for Rcc {
    fn reset(&mut self) {
        // Why the chip started is shown until software clears it.
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
