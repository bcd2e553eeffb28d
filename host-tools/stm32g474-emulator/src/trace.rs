//! What an image writes to registers, in words.

use crate::access::Write;
use crate::facts::{Access, RegisterField};

/// One line for each write: what it changes, by the makers' names; writes that change nothing are left out.
#[must_use]
pub fn lines(writes: &[Write]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for write in writes {
        let line = line(write);
        // A loop writes the same again and again.
        if let Some(line) = line
            && lines.last() != Some(&line)
        {
            lines.push(line);
        }
    }
    lines
}

fn line(write: &Write) -> Option<String> {
    let register = format!("{}_{}", write.block.name, write.register.name);
    // A register that cannot be read keeps nothing: each write does something.
    let before = match write.register.access {
        Access::Write => 0,
        Access::Read | Access::ReadWrite => write.before,
    };
    let changed = before ^ write.value;
    if write.register.fields.is_empty() {
        return (changed != 0).then(|| format!("{register} = {:#x}", write.value));
    }
    let fields = write.register.fields.iter();
    let words: Vec<String> = fields
        .filter(|field| changed & field.mask != 0)
        .map(|field| word(field, write.value))
        .collect();
    (!words.is_empty()).then(|| format!("{register}: {}", words.join(", ")))
}

fn word(field: &RegisterField, value: u32) -> String {
    format!("{} = {}", field.name, field.name_of(value))
}
