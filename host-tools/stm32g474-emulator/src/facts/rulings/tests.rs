use super::super::settle::settle;
use super::super::{Block, Facts, description, metadata};
use super::*;

const BLOCKS: &[&str] = &[
    "RCC",
    "PWR",
    "FLASH",
    "GPIOA",
    "GPIOB",
    "GPIOC",
    "GPIOD",
    "GPIOE",
    "GPIOF",
    "GPIOG",
    "SYSCFG",
    "DBGMCU",
    "TIM1",
    "TIM2",
    "TIM3",
    "TIM4",
    "TIM15",
    "ADC1",
    "ADC2",
    "ADC3",
    "ADC12_COMMON",
    "ADC345_COMMON",
    "LPUART1",
    "IWDG",
    "WWDG",
    "FDCAN2",
    "EXTI",
];

#[test]
fn every_contradiction_is_settled() {
    let mut blocks = metadata::blocks();
    blocks.retain(|block| BLOCKS.contains(&block.name));
    assert_eq!(blocks.len(), BLOCKS.len());
    for block in &mut blocks {
        assert!(
            !description::registers(block.base).is_empty(),
            "{} is not described",
            block.name
        );
        assert_eq!(settle(block), [], "{}", block.name);
    }
}

/// The names and masks of a register's fields, as both sources have them; none where a source has no such register.
fn fields(blocks: &[Block], block: &str, register: &str) -> [Option<Vec<(String, u32)>>; 2] {
    let block = blocks.iter().find(|known| known.name == block).unwrap();
    let views = description::registers(block.base).iter();
    let views: Vec<_> = views
        .filter(|view| metadata::view_name(view.name) == register)
        .collect();
    let metapac = match views.first() {
        Some(view) => block.register_at(view.offset),
        None => block.register(register),
    };
    let ours = metapac.map(|register| {
        let fields = register.fields.iter();
        fields.map(|f| (f.name_by_st.clone(), f.mask)).collect()
    });
    let theirs = views.iter().flat_map(|view| view.fields);
    let theirs = theirs.map(|(name, mask)| ((*name).to_owned(), *mask));
    [ours, (!views.is_empty()).then(|| theirs.collect())]
}

#[test]
fn every_ruling_settles_a_contradiction() {
    let blocks = metadata::blocks();
    for ruling in RULINGS {
        for block in ruling.blocks {
            let place = format!("{block}_{}: {}", ruling.register, ruling.reason);
            let [ours, theirs] = fields(&blocks, block, ruling.register).map(Option::unwrap);
            for (listed, has, lacks) in [
                (ruling.metapac, &ours, &theirs),
                (ruling.described, &theirs, &ours),
            ] {
                for (name, mask) in listed {
                    let field = ((*name).to_owned(), *mask);
                    assert!(
                        has.contains(&field) && !lacks.contains(&field),
                        "{place}: {field:x?}"
                    );
                }
            }
            assert!(!ruling.described.is_empty(), "{place}");
        }
    }
}

/// Each drops something: the register itself, or bits that the complete source leaves reserved.
#[test]
fn every_complete_register_lacks_something() {
    let blocks = metadata::blocks();
    for ruling in COMPLETE {
        for (block, register) in ruling.blocks.iter().flat_map(|block| {
            ruling
                .registers
                .iter()
                .map(move |register| (block, register))
        }) {
            let place = format!("{block}_{register}: {}", ruling.reason);
            let [ours, theirs] = fields(&blocks, block, register);
            let (complete, other) = match ruling.source {
                Source::Metapac => (ours, theirs),
                Source::Description => (theirs, ours),
            };
            let other = other.unwrap_or_else(|| panic!("{place}: neither has it"));
            let Some(complete) = complete else { continue };
            let known = complete.iter().fold(0, |bits, (_, mask)| bits | mask);
            let mut beyond = other.iter().filter(|(_, mask)| mask & known == 0);
            assert!(beyond.next().is_some(), "{place}");
        }
    }
}

#[test]
fn every_reset_value_is_ruled_on_once_and_differs() {
    for (blocks, register, value, reason) in RESETS {
        for name in *blocks {
            let block = Facts::chip().block(name).unwrap();
            let offset = block.register(register).unwrap().offset;
            let mut described = description::registers(block.base).iter();
            let said = described.find(|view| view.offset == offset).unwrap().reset;
            assert_ne!(said, *value, "{name}_{register}: {reason}");
        }
    }
}

#[test]
fn views_agree_on_the_reset_value() {
    for block in description::BLOCKS
        .iter()
        .filter(|block| BLOCKS.contains(&block.name))
    {
        for views in block
            .registers
            .chunk_by(|one, next| one.offset == next.offset)
        {
            let resets: Vec<_> = views.iter().map(|view| view.reset).collect();
            assert!(
                resets.iter().all(|reset| *reset == resets[0]),
                "{}: {}",
                block.name,
                views[0].name
            );
        }
    }
}
