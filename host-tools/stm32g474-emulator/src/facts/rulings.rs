//! What holds where the two sources contradict each other.
//!
//! "ST's C header" is `stm32g474xx.h` of cmsis-device-g4, a third description, by hand.

use super::RegisterField;

/// Names by ST and masks of fields.
pub type RulingFields = &'static [(&'static str, u32)];

/// One of the sources.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// `stm32-metapac`.
    Metapac,
    /// ST's description, in `stm32g4`.
    Description,
}

/// What holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// What one source has.
    Of(Source),
    /// Neither.
    Fields(RulingFields),
}

/// What holds for some fields of a register.
pub struct Ruling {
    pub blocks: &'static [&'static str],
    /// As ST calls it.
    pub register: &'static str,
    pub metapac: RulingFields,
    pub described: RulingFields,
    pub holds: Holds,
    #[cfg_attr(not(test), expect(dead_code, reason = "for readers"))]
    pub reason: &'static str,
}

/// Registers of which one source has all fields: what the other alone has there, a field or the whole register, does not
/// exist.
pub struct Complete {
    pub blocks: &'static [&'static str],
    /// As ST calls them.
    pub registers: &'static [&'static str],
    pub source: Source,
    #[cfg_attr(not(test), expect(dead_code, reason = "for readers"))]
    pub reason: &'static str,
}

impl Ruling {
    pub fn is_about(&self, fields: RulingFields, field: &RegisterField) -> bool {
        fields.contains(&(field.name_by_st.as_str(), field.mask))
    }
}

const METAPAC: Holds = Holds::Of(Source::Metapac);
const DESCRIPTION: Holds = Holds::Of(Source::Description);

/// Blocks and register; what stm32-metapac has, what ST's description has; what holds, and why.
macro_rules! rulings {
    ($($($block:ident)+ / $register:ident: $([$($name:ident $mask:literal)*])+ => $holds:expr, $reason:expr;)+) => {
        &[$(ruling(
            &[$(stringify!($block)),+],
            stringify!($register),
            [$(&[$((stringify!($name), $mask)),*]),+],
            $holds,
            $reason,
        )),+]
    };
}

const fn ruling(
    blocks: &'static [&'static str],
    register: &'static str,
    [metapac, described]: [RulingFields; 2],
    holds: Holds,
    reason: &'static str,
) -> Ruling {
    Ruling {
        blocks,
        register,
        metapac,
        described,
        holds,
        reason,
    }
}

/// The contradictions about fields, each settled.
pub const RULINGS: &[Ruling] = rulings! {
    PWR / CR5: [R1MODE 0x1] [R1MODE 0x100]
        => DESCRIPTION, "bit 8 in ST's C header too, and the only bit that the reset value has";
    PWR / CR2: [PLS 0xE PVMEN1 0x10 PVMEN2 0x20 PVMEN3 0x40 PVMEN4 0x80] [PVDLS 0xE PVMEN1 0x40 PVMEN2 0x80]
        => METAPAC, "as stm32-metapac in ST's C header";
    PWR / SR2: [PVMO1 0x1000 PVMO2 0x2000 PVMO3 0x4000 PVMO4 0x8000] [PVMO1 0x4000 PVMO2 0x8000]
        => METAPAC, "as stm32-metapac in ST's C header";
    RCC / PLLCFGR: [PLLP 0xF800_0000 PLLPBIT 0x2_0000] [PLLP 0x2_0000 PLLPDIV 0xF800_0000]
        => DESCRIPTION, "as ST's in ST's C header; the bits are the same";
    FLASH / OPTR: [SRAM_PE 0x100_0000 CCMSRAM_RST 0x200_0000] [SRAM2_PE 0x100_0000 SRAM2_RST 0x200_0000]
        => METAPAC, "as stm32-metapac in ST's C header; the bits are the same";
    ADC12_COMMON ADC345_COMMON / CSR: [ADRDY_MST 0x1] [ADDRDY_MST 0x1]
        => METAPAC, "a misprint of ST's description";
    TIM1 TIM2 TIM3 TIM4 / ECR: [PWPRSC 0x300_0000] [PWPRSC 0x700_0000]
        => DESCRIPTION, "three bits in ST's C header too";
    TIM1 / CCR3: [CCR 0xFFFF] [CCR 0xF_FFFF]
        => DESCRIPTION, "20 bits with dither, as both sources have channels 1 and 2";
    TIM1 / CCR4: [CCR 0xFFFF] [CCR 0xF_FFFF]
        => DESCRIPTION, "20 bits with dither, as both sources have channels 1 and 2";
    TIM1 / BDTR: [BKBID1 0x2000_0000] [BK2ID 0x2000_0000]
        => Holds::Fields(&[("BK2BID", 0x2000_0000)]), "the name of ST's C header; the bit is the same";
    TIM1 / AF2: [BK2INE 0x1] [BKINE 0x1]
        => METAPAC, "the name of ST's C header; the bit is the same";
    TIM2 / CNT: [CNT 0x7FFF_FFFF] [CNT 0xFFFF_FFFF]
        => DESCRIPTION, "bit 31 is the counter's unless UIFREMAP makes it UIFCPY";
    TIM15 / CR2: [MMS 0x200_0070] [MMS 0x70]
        => DESCRIPTION, "by memory of the manual, bit 25 is of the timers that count encoders";
    TIM15 / CCMR1: [] [OC1CE 0x80 OC2M 0x7000 OC2M_3 0x100_0000]
        => Holds::Fields(&[("OC1CE", 0x80), ("OC2M", 0x100_7000)]),
        "stm32-metapac lacks channel 2 and OC1CE; OC2M is one field, as both sources have OC1M";
    LPUART1 / BRR: [BRR 0xFFFF] [BRR 0xF_FFFF]
        => DESCRIPTION, "20 bits in ST's C header too";
    LPUART1 / ISR: [NE 0x4] [NF 0x4]
        => METAPAC, "the name of ST's C header; the bit is the same";
};

const COUNTERS: &[&str] = &["TIM2", "TIM3", "TIM4"];

/// Where one source has what the chip has not.
pub const COMPLETE: &[Complete] = &[
    complete(
        &["ADC12_COMMON", "ADC345_COMMON"],
        &["CDR2"],
        Source::Description,
        "ST's C header has no such register either",
    ),
    complete(
        &["TIM1"],
        &["AF1", "AF2"],
        Source::Description,
        "the chip has seven comparators, as in ST's C header",
    ),
    complete(
        &["TIM15"],
        &["AF1"],
        Source::Description,
        "the chip has seven comparators, as in ST's C header",
    ),
    complete(
        &["TIM15"],
        &["CCMR2"],
        Source::Description,
        "the timer has two channels",
    ),
    complete(
        COUNTERS,
        &[
            "CR2", "DIER", "SR", "EGR", "CCER", "AF1", "AF2", "RCR", "BDTR", "CCR5", "CCR6",
            "CCMR3", "DTR2",
        ],
        Source::Metapac,
        "ST's description repeats the registers of the advanced timers; this one has no break, no complementary output and four channels",
    ),
    complete(
        &["LPUART1"],
        &["CR1", "CR2", "CR3", "RQR", "ISR", "ICR"],
        Source::Description,
        "stm32-metapac repeats the USART's; the low-power one has no such mode",
    ),
];

const fn complete(
    blocks: &'static [&'static str],
    registers: &'static [&'static str],
    source: Source,
    reason: &'static str,
) -> Complete {
    Complete {
        blocks,
        registers,
        source,
        reason,
    }
}

/// The source that has all of a register, if a ruling says so.
pub fn complete_source(block: &str, register: &str) -> Option<Source> {
    let of = |one: &&Complete| one.blocks.contains(&block) && one.registers.contains(&register);
    COMPLETE.iter().find(of).map(|one| one.source)
}

/// Values after a reset that ST's description has wrong: the blocks, the register, the value, the reason.
pub const RESETS: &[(&[&str], &str, u32, &str)] = &[
    (
        &["RCC"],
        "CR",
        0x500,
        "HSION and HSIRDY: the chip starts from HSI, whose bit is then set by hardware, as ST says at the field; what ST says here is of the STM32L4, in bits that this chip has not",
    ),
    (
        &["FLASH"],
        "ACR",
        0x0004_0600,
        "the debugger's access (DBG_SWEN) is on, by memory of the manual",
    ),
    (&["TIM3", "TIM4"], "ARR", 0xFFFF, "the counter has 16 bits"),
    (
        &["TIM1", "TIM15"],
        "AF1",
        0x1,
        "BKIN is on (BKINE), by memory of the manual",
    ),
    (
        &["TIM1"],
        "AF2",
        0x1,
        "BKIN2 is on (BK2INE), by memory of the manual",
    ),
];

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests;
