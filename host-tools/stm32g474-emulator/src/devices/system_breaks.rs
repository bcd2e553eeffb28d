//! What of the chip itself breaks TIM1, and asks for the interrupt that cannot be masked.

use super::Devices;

/// What of the chip itself breaks TIM1, where SYSCFG_CFGR2 says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SystemBreak {
    /// The processor has locked up.
    Lockup,
    /// The voltage detector finds the supply too low.
    Supply,
    /// The flash has read a double word with two wrong bits.
    Ecc,
    /// SRAM1 has a word of wrong parity, which it looks for where the option byte SRAM_PE says so.
    Parity,
}

impl SystemBreak {
    /// The field of SYSCFG_CFGR2 that lets it break TIM1.
    fn field(self) -> &'static str {
        match self {
            Self::Lockup => "CLL",
            Self::Supply => "PVDL",
            Self::Ecc => "ECCL",
            Self::Parity => "SPL",
        }
    }
}

impl Devices {
    /// The level of the interrupt that cannot be masked: wrong bits in the flash, or a failed clock, hold it up until the
    /// program clears their flags.
    #[must_use]
    pub fn nmi(&self) -> bool {
        self.flash.nmi() || self.rcc.clock_failed()
    }

    /// What lasts of what breaks TIM1: a failed clock, a lockup, wrong bits in the flash.
    pub(super) fn system_break(&self) -> bool {
        let lasting = [
            (self.locked_up, SystemBreak::Lockup),
            (self.flash.nmi(), SystemBreak::Ecc),
        ];
        let mut lasting = lasting.into_iter();
        self.rcc.clock_failed() || lasting.any(|(lasts, cause)| lasts && self.breaks_by(cause))
    }

    /// Whether something of the chip breaks TIM1, by SYSCFG.
    #[must_use]
    pub fn breaks_by(&self, cause: SystemBreak) -> bool {
        let registers = self.syscfg.registers();
        registers.is_set(registers.field("CFGR2", cause.field()))
    }
}
