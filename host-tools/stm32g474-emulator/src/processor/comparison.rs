//! The flags of a floating-point comparison, which a program fetches a few instructions later.

/// Instructions in which the flags of a comparison are fetched: the compiler moves few others between.
const SPAN: u32 = 8;

/// `vmrs apsr_nzcv, fpscr`.
const FETCH_FLAGS: (u16, u16) = (0xeef1, 0xfa10);

/// Whether the flags of a comparison are still to be fetched at an instruction: those to come fetch them before they compare anew
/// or branch.
pub(super) fn is_awaited(pc: u32, half_word: impl Fn(u32) -> Option<u16>) -> bool {
    let mut address = pc;
    for _ in 0..SPAN {
        let (Some(first), Some(second)) = (half_word(address), half_word(address + 2)) else {
            return false;
        };
        match (first, second) {
            FETCH_FLAGS => return true,
            _ if is_end_of_block(first, second) => return false,
            _ => address += if is_wide(first) { 4 } else { 2 },
        }
    }
    false
}

/// Whether an instruction has two half words.
fn is_wide(first: u16) -> bool {
    first >= 0xe800
}

/// Whether an instruction compares floating-point numbers, or branches.
fn is_end_of_block(first: u16, second: u16) -> bool {
    let compares = first & 0xffbe == 0xeeb4 && second & 0x0e50 == 0x0a40;
    let branches = matches!(first >> 12, 0xd) || first >> 11 == 0b11100 || first >> 8 == 0x47;
    let branches_far = first >> 11 == 0b11110 && second & 0x8000 != 0;
    compares || branches || branches_far
}
