//! Text that is put together without the formatting machinery.
//!
//! That machinery may need more stack than is left where something has failed, and may fail itself.

use crate::host_link::CRASH_REPORT_MAX;
use heapless::String;

/// What the digits of a number stand for.
const POWERS: [u32; 10] = [
    1_000_000_000,
    100_000_000,
    10_000_000,
    1_000_000,
    100_000,
    10_000,
    1_000,
    100,
    10,
    1,
];

/// A short text; what does not fit is left out.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ShortText(String<CRASH_REPORT_MAX>);

impl ShortText {
    /// A text.
    #[must_use]
    pub fn new(text: &str) -> Self {
        Self::default().text(text)
    }

    /// The same and another text.
    #[must_use]
    pub fn text(mut self, text: &str) -> Self {
        for character in text.chars() {
            if self.0.push(character).is_err() {
                break;
            }
        }
        self
    }

    /// The same and a number.
    #[must_use]
    pub fn number(self, number: u32) -> Self {
        let (mut text, mut begun) = (self, false);
        for power in POWERS {
            let digit = number / power % 10;
            begun |= digit > 0 || power == 1;
            if begun {
                text = text.digit(digit);
            }
        }
        text
    }

    /// The same and a number of eight hexadecimal digits.
    #[must_use]
    pub fn hex(self, number: u32) -> Self {
        let nibbles = (0..8).rev().map(|place| number >> (4 * place) & 0xf);
        nibbles.fold(self.text("0x"), Self::digit)
    }

    /// The text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    fn digit(mut self, digit: u32) -> Self {
        if let Some(digit) = char::from_digit(digit, 16) {
            // What does not fit is left out.
            let _ = self.0.push(digit);
        }
        self
    }
}

/// A source file's name without its directories, which would leave no room for what happened there.
#[must_use]
pub fn file_name(path: &str) -> &str {
    let directory = |byte: u8| byte == b'/' || byte == b'\\';
    match path.bytes().rposition(directory) {
        Some(end) => path.get(end + 1..).unwrap_or(path),
        None => path,
    }
}

#[cfg(test)]
mod tests {
    use super::{CRASH_REPORT_MAX, ShortText, file_name};

    #[test]
    fn texts_and_numbers_follow_each_other() {
        let text = ShortText::new("a ").number(120).text(", b ").hex(0xbeef);
        assert_eq!(text.as_str(), "a 120, b 0x0000beef");
        for number in [0, 9, 10, 4_000_000_000, u32::MAX] {
            let text = ShortText::default().number(number);
            assert_eq!(text.as_str(), number.to_string());
            let text = ShortText::default().hex(number);
            assert_eq!(text.as_str(), format!("{number:#010x}"));
        }
    }

    #[test]
    fn what_does_not_fit_is_left_out() {
        let full = ShortText::new(&"x".repeat(1000));
        assert_eq!(full.as_str(), "x".repeat(CRASH_REPORT_MAX));
        assert_eq!(full.clone().number(7), full);
        let whole = ShortText::new(&"µ".repeat(1000));
        assert_eq!(whole.as_str(), "µ".repeat(CRASH_REPORT_MAX / 2));
    }

    #[test]
    fn folders_are_left_out() {
        assert_eq!(file_name("firmware/src/leg.rs"), "leg.rs");
        assert_eq!(file_name("src\\leg.rs"), "leg.rs");
        assert_eq!(file_name("leg.rs"), "leg.rs");
        assert_eq!(file_name("leg/"), "");
    }
}
