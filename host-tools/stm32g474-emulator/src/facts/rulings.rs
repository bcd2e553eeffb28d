//! What holds where the two sources contradict each other.
//!
//! "ST's C header" is `stm32g474xx.h` of cmsis-device-g4, a third description, by hand.

use super::Field;

/// Names by ST and masks of fields.
pub type Fields = &'static [(&'static str, u32)];

/// Which source holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Holds {
    /// `stm32-metapac`.
    Metapac,
    /// ST's description, in `stm32g4`.
    Description,
    /// Neither.
    Fields(Fields),
}

/// What holds for some fields of a register. Without fields, it is whether the register exists: one source has it, and the
/// one that holds has not.
pub struct Ruling {
    pub blocks: &'static [&'static str],
    /// As ST calls it.
    pub register: &'static str,
    pub metapac: Fields,
    pub described: Fields,
    pub holds: Holds,
    #[cfg_attr(not(test), expect(dead_code, reason = "for readers"))]
    pub reason: &'static str,
}

impl Ruling {
    pub fn is_of_register(&self) -> bool {
        self.metapac.is_empty() && self.described.is_empty()
    }

    pub fn is_about(&self, fields: Fields, field: &Field) -> bool {
        fields.contains(&(field.name_by_st.as_str(), field.mask))
    }
}

const ADCS: &[&str] = &["ADC12_COMMON", "ADC345_COMMON"];
const COUNTERS: &[&str] = &["TIM2", "TIM3", "TIM4"];
const ENCODERS: &[&str] = &["TIM1", "TIM2", "TIM3", "TIM4"];

const ADVANCED: &str = "ST's description repeats the registers of the advanced timers; this one has no break, no complementary output and four channels";
const USART: &str = "stm32-metapac repeats the USART's; the low-power one has no such mode";
const COMPARATORS: &str = "the chip has seven comparators, as in ST's C header";

/// The contradictions, each settled.
pub const RULINGS: &[Ruling] = &[
    Ruling {
        blocks: &["PWR"],
        register: "CR5",
        metapac: &[("R1MODE", 0x1)],
        described: &[("R1MODE", 0x100)],
        holds: Holds::Description,
        reason: "bit 8 in ST's C header too, and the only bit that the reset value has",
    },
    Ruling {
        blocks: &["PWR"],
        register: "CR2",
        metapac: &[
            ("PLS", 0xE),
            ("PVMEN1", 0x10),
            ("PVMEN2", 0x20),
            ("PVMEN3", 0x40),
            ("PVMEN4", 0x80),
        ],
        described: &[("PVDLS", 0xE), ("PVMEN1", 0x40), ("PVMEN2", 0x80)],
        holds: Holds::Metapac,
        reason: "as stm32-metapac in ST's C header",
    },
    Ruling {
        blocks: &["PWR"],
        register: "SR2",
        metapac: &[
            ("PVMO1", 0x1000),
            ("PVMO2", 0x2000),
            ("PVMO3", 0x4000),
            ("PVMO4", 0x8000),
        ],
        described: &[("PVMO1", 0x4000), ("PVMO2", 0x8000)],
        holds: Holds::Metapac,
        reason: "as stm32-metapac in ST's C header",
    },
    Ruling {
        blocks: &["RCC"],
        register: "PLLCFGR",
        metapac: &[("PLLP", 0xF800_0000), ("PLLPBIT", 0x2_0000)],
        described: &[("PLLP", 0x2_0000), ("PLLPDIV", 0xF800_0000)],
        holds: Holds::Description,
        reason: "as ST's in ST's C header; the bits are the same",
    },
    Ruling {
        blocks: &["FLASH"],
        register: "OPTR",
        metapac: &[("SRAM_PE", 0x100_0000), ("CCMSRAM_RST", 0x200_0000)],
        described: &[("SRAM2_PE", 0x100_0000), ("SRAM2_RST", 0x200_0000)],
        holds: Holds::Metapac,
        reason: "as stm32-metapac in ST's C header; the bits are the same",
    },
    Ruling {
        blocks: ADCS,
        register: "CSR",
        metapac: &[("ADRDY_MST", 0x1)],
        described: &[("ADDRDY_MST", 0x1)],
        holds: Holds::Metapac,
        reason: "a misprint of ST's description",
    },
    Ruling {
        blocks: ADCS,
        register: "CDR2",
        metapac: &[],
        described: &[],
        holds: Holds::Description,
        reason: "ST's C header has no such register either",
    },
    Ruling {
        blocks: ENCODERS,
        register: "ECR",
        metapac: &[("PWPRSC", 0x300_0000)],
        described: &[("PWPRSC", 0x700_0000)],
        holds: Holds::Description,
        reason: "three bits in ST's C header too",
    },
    Ruling {
        blocks: &["TIM1"],
        register: "CCR3",
        metapac: &[("CCR", 0xFFFF)],
        described: &[("CCR", 0xF_FFFF)],
        holds: Holds::Description,
        reason: "20 bits with dither, as both sources have channels 1 and 2",
    },
    Ruling {
        blocks: &["TIM1"],
        register: "CCR4",
        metapac: &[("CCR", 0xFFFF)],
        described: &[("CCR", 0xF_FFFF)],
        holds: Holds::Description,
        reason: "20 bits with dither, as both sources have channels 1 and 2",
    },
    Ruling {
        blocks: &["TIM1"],
        register: "BDTR",
        metapac: &[("BKBID1", 0x2000_0000)],
        described: &[("BK2ID", 0x2000_0000)],
        holds: Holds::Fields(&[("BK2BID", 0x2000_0000)]),
        reason: "the name of ST's C header; the bit is the same",
    },
    Ruling {
        blocks: &["TIM1", "TIM15"],
        register: "AF1",
        metapac: &[("BKCMPE7", 0x100)],
        described: &[],
        holds: Holds::Description,
        reason: COMPARATORS,
    },
    Ruling {
        blocks: &["TIM1"],
        register: "AF2",
        metapac: &[("BK2CMPE7", 0x100)],
        described: &[],
        holds: Holds::Description,
        reason: COMPARATORS,
    },
    Ruling {
        blocks: &["TIM1"],
        register: "AF2",
        metapac: &[("BK2INE", 0x1)],
        described: &[("BKINE", 0x1)],
        holds: Holds::Metapac,
        reason: "the name of ST's C header; the bit is the same",
    },
    Ruling {
        blocks: &["TIM2"],
        register: "CNT",
        metapac: &[("CNT", 0x7FFF_FFFF)],
        described: &[("CNT", 0xFFFF_FFFF)],
        holds: Holds::Description,
        reason: "bit 31 is the counter's unless UIFREMAP makes it UIFCPY",
    },
    Ruling {
        blocks: COUNTERS,
        register: "CR2",
        metapac: &[],
        described: &[
            ("CCPC", 0x1),
            ("CCUS", 0x4),
            ("OIS1", 0x100),
            ("OIS1N", 0x200),
            ("OIS2", 0x400),
            ("OIS2N", 0x800),
            ("OIS3", 0x1000),
            ("OIS3N", 0x2000),
            ("OIS4", 0x4000),
            ("OIS4N", 0x8000),
            ("OIS5", 0x1_0000),
            ("OIS6", 0x4_0000),
            ("MMS2", 0xF0_0000),
        ],
        holds: Holds::Metapac,
        reason: ADVANCED,
    },
    Ruling {
        blocks: COUNTERS,
        register: "DIER",
        metapac: &[],
        described: &[("COMIE", 0x20), ("BIE", 0x80), ("COMDE", 0x2000)],
        holds: Holds::Metapac,
        reason: ADVANCED,
    },
    Ruling {
        blocks: COUNTERS,
        register: "SR",
        metapac: &[],
        described: &[
            ("COMIF", 0x20),
            ("BIF", 0x80),
            ("B2IF", 0x100),
            ("SBIF", 0x2000),
            ("CC5IF", 0x1_0000),
            ("CC6IF", 0x2_0000),
        ],
        holds: Holds::Metapac,
        reason: ADVANCED,
    },
    Ruling {
        blocks: COUNTERS,
        register: "EGR",
        metapac: &[],
        described: &[("COMG", 0x20), ("BG", 0x80), ("B2G", 0x100)],
        holds: Holds::Metapac,
        reason: ADVANCED,
    },
    Ruling {
        blocks: COUNTERS,
        register: "CCER",
        metapac: &[],
        described: &[
            ("CC1NE", 0x4),
            ("CC2NE", 0x40),
            ("CC3NE", 0x400),
            ("CC4NE", 0x4000),
            ("CC5E", 0x1_0000),
            ("CC5P", 0x2_0000),
            ("CC6E", 0x10_0000),
            ("CC6P", 0x20_0000),
        ],
        holds: Holds::Metapac,
        reason: ADVANCED,
    },
    Ruling {
        blocks: COUNTERS,
        register: "AF1",
        metapac: &[],
        described: &[
            ("BKINE", 0x1),
            ("BKCMP1E", 0x2),
            ("BKCMP2E", 0x4),
            ("BKCMP3E", 0x8),
            ("BKCMP4E", 0x10),
            ("BKCMP5E", 0x20),
            ("BKCMP6E", 0x40),
            ("BKCMP7E", 0x80),
            ("BKINP", 0x200),
            ("BKCMP1P", 0x400),
            ("BKCMP2P", 0x800),
            ("BKCMP3P", 0x1000),
            ("BKCMP4P", 0x2000),
        ],
        holds: Holds::Metapac,
        reason: ADVANCED,
    },
    Ruling {
        blocks: COUNTERS,
        register: "AF2",
        metapac: &[],
        described: &[
            ("BKINE", 0x1),
            ("BK2CMP1E", 0x2),
            ("BK2CMP2E", 0x4),
            ("BK2CMP3E", 0x8),
            ("BK2CMP4E", 0x10),
            ("BK2CMP5E", 0x20),
            ("BK2CMP6E", 0x40),
            ("BK2CMP7E", 0x80),
            ("BK2INP", 0x200),
            ("BK2CMP1P", 0x400),
            ("BK2CMP2P", 0x800),
            ("BK2CMP3P", 0x1000),
            ("BK2CMP4P", 0x2000),
        ],
        holds: Holds::Metapac,
        reason: ADVANCED,
    },
    no_register(COUNTERS, "RCR", Holds::Metapac, ADVANCED),
    no_register(COUNTERS, "BDTR", Holds::Metapac, ADVANCED),
    no_register(COUNTERS, "CCR5", Holds::Metapac, ADVANCED),
    no_register(COUNTERS, "CCR6", Holds::Metapac, ADVANCED),
    no_register(COUNTERS, "CCMR3", Holds::Metapac, ADVANCED),
    no_register(COUNTERS, "DTR2", Holds::Metapac, ADVANCED),
    no_register(
        &["TIM15"],
        "CCMR2",
        Holds::Description,
        "the timer has two channels",
    ),
    Ruling {
        blocks: &["TIM15"],
        register: "CR2",
        metapac: &[("MMS", 0x200_0070)],
        described: &[("MMS", 0x70)],
        holds: Holds::Description,
        reason: "by memory of the manual, bit 25 is of the timers that count encoders",
    },
    Ruling {
        blocks: &["TIM15"],
        register: "CCMR1",
        metapac: &[],
        described: &[("OC1CE", 0x80), ("OC2M", 0x7000), ("OC2M_3", 0x100_0000)],
        holds: Holds::Fields(&[("OC1CE", 0x80), ("OC2M", 0x100_7000)]),
        reason: "stm32-metapac lacks channel 2 and OC1CE; OC2M is one field, as both sources have OC1M",
    },
    Ruling {
        blocks: &["LPUART1"],
        register: "CR1",
        metapac: &[
            ("OVER8", 0x8000),
            ("RTOIE", 0x400_0000),
            ("EOBIE", 0x800_0000),
        ],
        described: &[],
        holds: Holds::Description,
        reason: USART,
    },
    Ruling {
        blocks: &["LPUART1"],
        register: "CR2",
        metapac: &[
            ("LBDL", 0x20),
            ("LBDIE", 0x40),
            ("LBCL", 0x100),
            ("CPHA", 0x200),
            ("CPOL", 0x400),
            ("CLKEN", 0x800),
            ("LINEN", 0x4000),
            ("ABREN", 0x10_0000),
            ("ABRMOD", 0x60_0000),
            ("RTOEN", 0x80_0000),
        ],
        described: &[],
        holds: Holds::Description,
        reason: USART,
    },
    Ruling {
        blocks: &["LPUART1"],
        register: "CR3",
        metapac: &[
            ("IREN", 0x2),
            ("IRLP", 0x4),
            ("NACK", 0x10),
            ("SCEN", 0x20),
            ("ONEBIT", 0x800),
            ("SCARCNT", 0xE_0000),
        ],
        described: &[],
        holds: Holds::Description,
        reason: USART,
    },
    Ruling {
        blocks: &["LPUART1"],
        register: "BRR",
        metapac: &[("BRR", 0xFFFF)],
        described: &[("BRR", 0xF_FFFF)],
        holds: Holds::Description,
        reason: "20 bits in ST's C header too",
    },
    Ruling {
        blocks: &["LPUART1"],
        register: "RQR",
        metapac: &[("ABRRQ", 0x1)],
        described: &[],
        holds: Holds::Description,
        reason: USART,
    },
    Ruling {
        blocks: &["LPUART1"],
        register: "ISR",
        metapac: &[
            ("LBD", 0x100),
            ("RTOF", 0x800),
            ("EOBF", 0x1000),
            ("ABRE", 0x4000),
            ("ABRF", 0x8000),
        ],
        described: &[],
        holds: Holds::Description,
        reason: USART,
    },
    Ruling {
        blocks: &["LPUART1"],
        register: "ISR",
        metapac: &[("NE", 0x4)],
        described: &[("NF", 0x4)],
        holds: Holds::Metapac,
        reason: "the name of ST's C header; the bit is the same",
    },
    Ruling {
        blocks: &["LPUART1"],
        register: "ICR",
        metapac: &[("LBD", 0x100), ("RTOF", 0x800), ("EOBF", 0x1000)],
        described: &[],
        holds: Holds::Description,
        reason: USART,
    },
];

const fn no_register(
    blocks: &'static [&'static str],
    register: &'static str,
    holds: Holds,
    reason: &'static str,
) -> Ruling {
    Ruling {
        blocks,
        register,
        metapac: &[],
        described: &[],
        holds,
        reason,
    }
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
