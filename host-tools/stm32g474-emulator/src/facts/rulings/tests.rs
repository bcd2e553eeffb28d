use super::super::settle::settle;
use super::super::{Facts, description, metadata};
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

#[test]
fn every_ruling_settles_a_contradiction() {
    let blocks = metadata::blocks();
    for ruling in RULINGS {
        for name in ruling.blocks {
            let place = format!("{name}_{}: {}", ruling.register, ruling.reason);
            let block = blocks.iter().find(|block| block.name == *name).unwrap();
            let known = description::registers(block.base).iter();
            let described: Vec<_> = known
                .filter(|view| metadata::view_name(view.name) == ruling.register)
                .collect();
            let offset = described.first().map(|view| view.offset);
            let metapac = match offset {
                Some(offset) => block.register_at(offset),
                None => block.register(ruling.register),
            };
            if ruling.is_of_register() {
                let lacks = match ruling.holds {
                    Holds::Metapac => metapac.is_none() && !described.is_empty(),
                    Holds::Description => metapac.is_some() && described.is_empty(),
                    Holds::Fields(_) => false,
                };
                assert!(lacks, "{place}");
                continue;
            }
            let ours: Vec<_> = metapac
                .unwrap()
                .fields
                .iter()
                .map(|field| (field.name_by_st.as_str(), field.mask))
                .collect();
            let theirs: Vec<_> = described
                .iter()
                .flat_map(|view| view.fields.iter().copied())
                .collect();
            for field in ruling.metapac {
                assert!(
                    ours.contains(field) && !theirs.contains(field),
                    "{place}: {field:x?}"
                );
            }
            for field in ruling.described {
                assert!(
                    theirs.contains(field) && !ours.contains(field),
                    "{place}: {field:x?}"
                );
            }
            // Reserved bits of one source are ruled on only where the other holds.
            let reserved = ruling.metapac.is_empty() && ruling.holds == Holds::Description
                || ruling.described.is_empty() && ruling.holds == Holds::Metapac;
            assert!(!reserved, "{place}");
        }
    }
}

#[test]
fn every_reset_value_is_ruled_on_once_and_differs() {
    for (blocks, register, value, reason) in RESETS {
        for name in *blocks {
            let block = Facts::of_chip().block(name).unwrap();
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
