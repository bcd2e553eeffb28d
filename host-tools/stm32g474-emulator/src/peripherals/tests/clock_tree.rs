//! Mistakes in the clock tree, and the sentences that they are reported by.

use super::{Row, block};

/// Sources, the PLL, and what runs from them.
pub const CLOCK_TREE: &[Row] = &[
    (
        &[],
        |b| b.rcc("CR", "HSION", 0),
        "RCC_CR: HSI is switched off while the chip runs from it",
    ),
    (
        &[],
        |b| {
            b.rcc("CR", "HSEON", 1);
            b.wait();
            b.rcc("CFGR", "HPRE", 8);
            b.rcc("CFGR", "SW", 2);
            b.rcc("CR", "HSEON", 0);
        },
        "RCC_CR: HSE is switched off while the chip runs from it",
    ),
    (
        &[],
        |b| {
            b.rcc("CR", "HSEON", 1);
            b.rcc("CR", "HSEBYP", 1);
        },
        "RCC_CR: HSEBYP is changed while HSE is on",
    ),
    (
        &[],
        |b| {
            b.run_from_pll();
            b.rcc("CR", "PLLON", 0);
        },
        "RCC_CR: PLL is switched off while the chip runs from it",
    ),
    (
        &[],
        |b| {
            b.lock_pll();
            b.rcc("CR", "HSEON", 0);
        },
        "RCC_CR: HSE is switched off while the PLL runs from it",
    ),
    (
        &[],
        |b| {
            b.rcc("PLLCFGR", "PLLSRC", 2);
            b.rcc("PLLCFGR", "PLLM", 3);
            b.rcc("PLLCFGR", "PLLN", 85);
            b.rcc("PLLCFGR", "PLLREN", 1);
            b.rcc("CR", "PLLON", 1);
            b.wait();
            b.rcc("CFGR", "HPRE", 12);
            b.rcc("CFGR", "SW", 3);
            b.rcc("CR", "HSION", 0);
        },
        "RCC_CR: HSI is switched off while the PLL runs from it",
    ),
    (
        &[],
        |b| {
            b.divide_crystal();
            b.rcc("CR", "HSEON", 1);
            b.rcc("CR", "PLLON", 1);
        },
        "RCC_CR: PLLON is set while the PLL's source is not ready",
    ),
    (
        &[],
        |b| {
            b.rcc("PLLCFGR", "PLLSRC", 2);
            b.rcc("PLLCFGR", "PLLM", 7);
            b.rcc("PLLCFGR", "PLLN", 85);
            b.rcc("CR", "PLLON", 1);
        },
        "RCC_PLLCFGR: the PLL's input is 2000000 Hz, outside of [2660000, 16000000]",
    ),
    (
        &[],
        |b| {
            b.rcc("PLLCFGR", "PLLSRC", 2);
            b.rcc("PLLCFGR", "PLLM", 3);
            b.rcc("PLLCFGR", "PLLN", 87);
            b.rcc("CR", "PLLON", 1);
        },
        "RCC_PLLCFGR: the PLL's oscillator is at 348000000 Hz, outside of [96000000, 344000000]",
    ),
    (
        &[],
        |b| {
            b.lock_pll();
            b.rcc("PLLCFGR", "PLLN", 80);
        },
        "RCC_PLLCFGR: source, M, N or R is changed while the PLL is on",
    ),
    (
        &[],
        |b| {
            b.lock_pll();
            b.rcc("PLLCFGR", "PLLR", 1);
        },
        "RCC_PLLCFGR: source, M, N or R is changed while the PLL is on",
    ),
    (
        &[],
        |b| {
            b.run_from_pll();
            b.rcc("PLLCFGR", "PLLREN", 0);
        },
        "RCC_PLLCFGR: PLLREN is cleared while the chip runs from the PLL",
    ),
    (
        &[],
        |b| b.rcc("CFGR", "SW", 2),
        "RCC_CFGR: SW chooses a source that is not ready",
    ),
    (
        &[],
        |b| {
            b.lock_pll();
            b.rcc("PLLCFGR", "PLLREN", 0);
            b.rcc("CFGR", "SW", 3);
        },
        "RCC_CFGR: SW chooses a source that is not ready",
    ),
    (
        &[],
        |b| b.switch(block("FDCAN2").enable),
        "RCC_CCIPR: FDCANSEL gives FDCAN HSE, which is off",
    ),
    (
        &[],
        |b| {
            b.rcc("CR", "HSEON", 1);
            b.switch(block("FDCAN2").enable);
            b.rcc("CR", "HSEON", 0);
        },
        "RCC_CCIPR: FDCANSEL gives FDCAN HSE, which is off",
    ),
    (
        &[],
        |b| {
            b.rcc("CCIPR", "FDCANSEL", 1);
            b.switch(block("FDCAN2").enable);
        },
        "RCC_CCIPR: FDCANSEL gives FDCAN PLL Q, which is not modelled",
    ),
];

/// A processor that is too fast for its voltage or its flash.
pub const SPEEDS: &[Row] = &[
    (
        &[],
        |b| {
            b.run_at_half();
            b.wait();
            b.rcc("CFGR", "HPRE", 0);
            b.wait();
        },
        "the processor runs at 170000000 Hz in range 1 normal, whose limit is 150000000 Hz",
    ),
    (
        &["PWR"],
        |b| {
            b.set("FLASH", "ACR", "LATENCY", 1);
            b.set("PWR", "CR1", "VOS", 2);
            b.lock_pll();
            b.rcc("CFGR", "HPRE", 9);
            b.rcc("CFGR", "SW", 3);
            b.wait();
        },
        "the processor runs at 42500000 Hz in range 2, whose limit is 26000000 Hz",
    ),
    (
        &[],
        |b| {
            b.lock_pll();
            b.set("FLASH", "ACR", "LATENCY", 1);
            b.rcc("CFGR", "HPRE", 8);
            b.rcc("CFGR", "SW", 3);
            b.wait();
        },
        "the flash has 1 wait states at 85000000 Hz in range 1 normal, and needs 2",
    ),
    (
        &["PWR"],
        |b| {
            b.set("PWR", "CR5", "R1MODE", 0);
            b.set("FLASH", "ACR", "LATENCY", 4);
            b.lock_pll();
            b.rcc("CFGR", "SW", 3);
            b.wait();
        },
        "the processor's clock goes from 16000000 Hz to 170000000 Hz without 1 µs at half of that",
    ),
    (
        &["PWR"],
        |b| {
            b.set("PWR", "CR5", "R1MODE", 0);
            b.run_at_half();
            b.0.set_cycle(b.0.cycle + 84);
            b.rcc("CFGR", "HPRE", 0);
            b.0.advance();
        },
        "the processor's clock goes from 85000000 Hz to 170000000 Hz without 1 µs at half of that",
    ),
    (
        &["PWR"],
        |b| {
            b.run_at_half();
            b.wait();
            b.set("PWR", "CR5", "R1MODE", 0);
            b.rcc("CFGR", "HPRE", 0);
            b.0.advance();
        },
        "the processor's clock goes from 85000000 Hz to 170000000 Hz without 1 µs at half of that",
    ),
];
