//! Text from files and lines that may be of any length, read up to a bound.

use std::fs::File;
use std::io::{self, BufRead, ErrorKind, Read};
use std::path::Path;

/// The longest rig file or scenario, bytes: a hundred times the longest one that comes ready.
pub const FILE_BYTES_MAX: u64 = 1 << 20;

/// The longest line of a program or a person, bytes.
pub const LINE_BYTES_MAX: usize = 64 * 1024;

/// The longest line that is skipped as too long, bytes: an input without lines has to come to an end.
const SKIPPED_BYTES_MAX: u64 = 64 << 20;

/// Reads a text file of at most `bytes_max`.
///
/// # Errors
/// The system's; [`ErrorKind::FileTooLarge`] with a sentence; what is no UTF-8.
pub fn read_file(path: &Path, bytes_max: u64) -> io::Result<String> {
    let mut text = String::new();
    let mut file = File::open(path)?.take(bytes_max + 1);
    let read = file.read_to_string(&mut text);
    // A file that is cut in the middle of a letter is too large in the first place.
    if file.limit() == 0 {
        let mib = bytes_max >> 20;
        let sentence = format!("it is larger than {mib} MiB");
        return Err(io::Error::new(ErrorKind::FileTooLarge, sentence));
    }
    read?;
    Ok(text)
}

/// A line of an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Line {
    /// Its bytes, without the newline.
    Whole(Vec<u8>),
    /// It is longer than [`LINE_BYTES_MAX`], and was skipped.
    TooLong,
}

/// What is said of a line that is too long.
#[must_use]
pub fn too_long() -> String {
    format!("the line is longer than {} KiB", LINE_BYTES_MAX / 1024)
}

/// The next line; none at the end of the input. No more than [`LINE_BYTES_MAX`] of it is kept.
///
/// # Errors
/// The system's; [`ErrorKind::InvalidData`] with a sentence where a line is longer than 64 MiB.
pub fn next_line(input: &mut (impl BufRead + ?Sized)) -> io::Result<Option<Line>> {
    let mut line = Vec::new();
    // Two more: the newline, and the one byte too many.
    let mut start = input.take(LINE_BYTES_MAX as u64 + 2);
    if start.read_until(b'\n', &mut line)? == 0 {
        return Ok(None);
    }
    if line.last() == Some(&b'\n') {
        line.pop();
    } else if line.len() > LINE_BYTES_MAX {
        let skipped = input.take(SKIPPED_BYTES_MAX).skip_until(b'\n')?;
        if skipped as u64 == SKIPPED_BYTES_MAX {
            let sentence = format!("it is longer than {} MiB", SKIPPED_BYTES_MAX >> 20);
            return Err(io::Error::new(ErrorKind::InvalidData, sentence));
        }
    }
    if line.len() > LINE_BYTES_MAX {
        return Ok(Some(Line::TooLong));
    }
    Ok(Some(Line::Whole(line)))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{FILE_BYTES_MAX, LINE_BYTES_MAX, Line, next_line, read_file};
    use std::io::{BufReader, ErrorKind};
    use std::path::Path;

    #[test]
    fn a_file_without_an_end_is_too_large() {
        let endless = read_file(Path::new("/dev/zero"), FILE_BYTES_MAX).unwrap_err();
        assert_eq!(endless.kind(), ErrorKind::FileTooLarge);
        assert_eq!(endless.to_string(), "it is larger than 1 MiB");
        assert_eq!(read_file(Path::new("/dev/null"), 1).unwrap(), "");
    }

    #[test]
    fn a_line_without_an_end_is_an_error() {
        let error = next_line(&mut BufReader::new(std::io::repeat(0))).unwrap_err();
        assert_eq!(error.to_string(), "it is longer than 64 MiB");
    }

    #[test]
    fn a_line_is_kept_up_to_the_bound() {
        let whole = |count| Some(Line::Whole(vec![b'a'; count]));
        for (count, expected) in [
            (0, whole(0)),
            (LINE_BYTES_MAX, whole(LINE_BYTES_MAX)),
            (LINE_BYTES_MAX + 1, Some(Line::TooLong)),
            (LINE_BYTES_MAX + 2, Some(Line::TooLong)),
            (3 * LINE_BYTES_MAX, Some(Line::TooLong)),
        ] {
            for end in ["\n", "\nlast", "\nlast\n"] {
                let text = ["a".repeat(count).as_str(), end].concat();
                let mut input = text.as_bytes();
                assert_eq!(next_line(&mut input).unwrap(), expected, "{count}");
                let last = next_line(&mut input).unwrap();
                let is_last = last == Some(Line::Whole(b"last".into()));
                assert_eq!(is_last, end.len() > 1, "{count}");
                assert_eq!(next_line(&mut input).unwrap(), None);
            }
        }
    }
}
