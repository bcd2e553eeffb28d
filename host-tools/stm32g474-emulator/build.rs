//! Writes ST's description of the STM32G474 as a table: from the source of the crate `stm32g4`, which svd2rust made.

use std::collections::{BTreeMap, BTreeSet};
use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

use cargo_metadata::MetadataCommand;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

const CRATE: &str = "stm32g4";

fn main() -> Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let chip = crate_directory()?.join("src/stm32g474");
    let out = PathBuf::from(env::var("OUT_DIR")?).join("description.rs");
    fs::write(out, table(&chip)?)?;
    Ok(())
}

/// Where cargo keeps the crate's source.
fn crate_directory() -> Result<PathBuf> {
    let host = ["--filter-platform".to_owned(), env::var("HOST")?];
    let metadata = MetadataCommand::new().other_options(host).exec()?;
    let mut packages = metadata.packages.into_iter();
    let package = packages.find(|package| *package.name == CRATE);
    let manifest = package
        .ok_or("cargo does not know the crate stm32g4")?
        .manifest_path;
    let directory = manifest
        .parent()
        .ok_or("the crate stm32g4 has no directory")?;
    Ok(directory.to_owned().into_std_path_buf())
}

/// `BLOCKS`: each with a table of registers that it may share with others of its kind.
fn table(chip: &Path) -> Result<String> {
    let source = fs::read_to_string(chip.join("mod.rs"))?;
    let mut blocks = String::from("pub static BLOCKS: &[DescribedBlock] = &[\n");
    let mut kinds = BTreeSet::new();
    for line in source.lines() {
        // pub type TIM4 = crate::Periph<tim3::RegisterBlock, 0x4000_0800>;
        let Some((name, kind, base)) = split_block(line) else {
            continue;
        };
        let table = kind.to_uppercase();
        writeln!(
            blocks,
            "DescribedBlock {{ name: {name:?}, base: {base}, registers: {table} }},"
        )?;
        kinds.insert(kind.to_owned());
    }
    blocks.push_str("];\n");
    for kind in kinds {
        let table = kind.to_uppercase();
        writeln!(blocks, "static {table}: &[DescribedRegister] = &[")?;
        registers(&mut blocks, chip, &kind)?;
        blocks.push_str("];\n");
    }
    Ok(blocks)
}

fn split_block(line: &str) -> Option<(&str, &str, &str)> {
    let (name, place) = line
        .strip_prefix("pub type ")?
        .split_once(" = crate::Periph<")?;
    let (kind, base) = place.split_once("::RegisterBlock, ")?;
    Some((name, kind, base.strip_suffix(">;")?))
}

fn registers(out: &mut String, chip: &Path, kind: &str) -> Result<()> {
    let source = fs::read_to_string(chip.join(kind).with_extension("rs"))?;
    let files: BTreeMap<_, _> = source
        .lines()
        .filter_map(|line| split_type(kind, line))
        .collect();
    let mut offset = None;
    for line in source.lines().map(str::trim_start) {
        // ///0x34 - capture/compare register
        // pub const fn ccr1(&self) -> &CCR {
        if let Some((place, _)) = line.strip_prefix("///0x").and_then(|l| l.split_once(" - ")) {
            offset = u32::from_str_radix(place, 16).ok();
        } else if let Some((name, kind_of)) = split_getter(line)
            && let (Some(offset), Some(file)) = (offset.take(), files.get(kind_of))
        {
            let source = fs::read_to_string(chip.join(file).with_extension("rs"))?;
            register(out, &name.to_uppercase(), offset, &source)
                .map_err(|error| format!("{file}.rs: {error}"))?;
        }
    }
    Ok(())
}

/// The type of a register, and the file that it is in.
fn split_type<'l>(kind: &str, line: &'l str) -> Option<(&'l str, String)> {
    // pub type CCR = crate::Reg<ccr::CCRrs>;
    if let Some((name, place)) = line
        .strip_prefix("pub type ")
        .and_then(|l| l.split_once(" = crate::Reg<"))
    {
        return Some((name, format!("{kind}/{}", place.split_once("::")?.0)));
    }
    let place = line.strip_prefix("pub use ")?.strip_suffix(';')?;
    // pub use crate::stm32g474::gpioa::AFRH;
    if let Some(place) = place.strip_prefix("crate::stm32g474::") {
        let (kind, name) = place.split_once("::")?;
        return Some((name, format!("{kind}/{}", name.to_lowercase())));
    }
    // pub use CCR as CCR6;
    let (file, name) = place.split_once(" as ")?;
    Some((name, format!("{kind}/{}", file.to_lowercase())))
}

fn split_getter(line: &str) -> Option<(&str, &str)> {
    let line = line.strip_prefix("pub const fn ")?;
    let (name, kind) = line.split_once("(&self) -> &")?;
    Some((name, kind.strip_suffix(" {")?))
}

fn register(out: &mut String, name: &str, offset: u32, source: &str) -> Result<()> {
    let (_, specification) = source
        .split_once("impl crate::RegisterSpec for")
        .ok_or("no register")?;
    // The value after a reset is written only where it is not 0.
    let reset = specification.split_once("const RESET_VALUE: ");
    let reset = reset.and_then(|(_, value)| value.split_once(" = ")?.1.split_once(';'));
    let reset = reset.map_or("0", |(value, _)| value);
    let read = specification.contains("impl crate::Readable for");
    let write = specification.contains("impl crate::Writable for");
    writeln!(
        out,
        "DescribedRegister {{ name: {name:?}, offset: {offset:#x}, reset: {reset}, read: {read}, write: {write}, fields: &["
    )?;
    for (name, mask) in fields(source)? {
        writeln!(out, "({name:?}, {mask:#x}),")?;
    }
    out.push_str("] },\n");
    Ok(())
}

/// The fields with their bits: those that are read and those that are written.
fn fields(source: &str) -> Result<BTreeMap<String, u32>> {
    let mut fields = BTreeMap::new();
    let mut bits = None;
    for line in source.lines().map(str::trim_start) {
        // ///Bits 4:6 - Master mode selection
        // pub fn mms(&self) -> MMS_R {
        if let Some(text) = line.strip_prefix("///Bit") {
            let place = text.trim_start_matches('s').trim_start();
            bits = place.split_once(" - ").map(|(bits, _)| bits);
        } else if let Some(text) = line.strip_prefix("pub fn ")
            && let Some(bits) = bits.take()
        {
            let name = text.split('(').next().unwrap_or_default();
            let (first, last) = bits.split_once(':').unwrap_or((bits, bits));
            let (first, last): (u32, u32) = (first.parse()?, last.parse()?);
            let mask = u32::MAX >> (31 + first - last) << first;
            // A name that is a word of Rust has a line behind it.
            let name = name.trim_end_matches('_').to_uppercase();
            if fields
                .insert(name.clone(), mask)
                .is_some_and(|known| known != mask)
            {
                return Err(format!("{name} is at two places").into());
            }
        }
    }
    Ok(fields)
}
