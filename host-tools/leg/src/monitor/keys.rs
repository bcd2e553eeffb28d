//! The keys of the terminal. Not crossterm's events: it does not come back from a terminal that has gone, nor from half a
//! key.

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::fs::File;
use std::io::{self, ErrorKind, IsTerminal, Read};
use std::os::fd::AsFd;

/// What the terminal sends for Ctrl-C and for Esc, which also begins what it sends for arrows and the like.
const CTRL_C: u8 = 0x03;
const ESCAPE: u8 = 0x1b;

const NO_TIME: Timespec = Timespec {
    tv_sec: 0,
    tv_nsec: 0,
};

/// Where the keys come from.
pub(super) struct Keys(File);

impl Keys {
    /// The terminal of this process: its standard input, or else the one that controls it.
    pub(super) fn open() -> io::Result<Self> {
        let input = io::stdin();
        if input.is_terminal() {
            return Ok(Self(input.as_fd().try_clone_to_owned()?.into()));
        }
        File::open("/dev/tty").map(Self)
    }

    /// Whether the user has pressed a key that ends the screen, or the terminal has gone.
    pub(super) fn end_wanted(&mut self) -> bool {
        let mut bytes = [0; 256];
        loop {
            let waiting = poll(&mut [PollFd::new(&self.0, PollFlags::IN)], Some(&NO_TIME));
            if matches!(waiting, Ok(0) | Err(rustix::io::Errno::INTR)) {
                return false;
            }
            match self.0.read(&mut bytes) {
                Ok(0) => return true,
                Ok(count) if ends(bytes.get(..count).unwrap_or_default()) => return true,
                Ok(_) => {}
                Err(error) => {
                    return !matches!(error.kind(), ErrorKind::Interrupted | ErrorKind::WouldBlock);
                }
            }
        }
    }
}

/// Whether what was typed at a time has a key that ends the screen.
fn ends(typed: &[u8]) -> bool {
    match typed {
        [] => false,
        [ESCAPE] | [ESCAPE, ESCAPE | CTRL_C, ..] | [CTRL_C | b'q' | b'Q', ..] => true,
        [ESCAPE, rest @ ..] => ends(skip_sequence(rest)),
        [_, rest @ ..] => ends(rest),
    }
}

/// What comes behind an arrow, say, whose escape was read: a letter, or ECMA-48's `[` or `O`, parameters and a final byte.
fn skip_sequence(typed: &[u8]) -> &[u8] {
    let introduced = typed.strip_prefix(b"[").or(typed.strip_prefix(b"O"));
    let rest = introduced.unwrap_or(typed);
    let last = rest.iter().position(|byte| (0x40..=0x7e).contains(byte));
    last.and_then(|last| rest.get(last + 1..))
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::ends;

    #[test]
    fn q_escape_and_ctrl_c_end_the_screen_and_arrows_do_not() {
        for (typed, expected) in [
            ("q", true),
            ("\x1b", true),
            ("\x03", true),
            ("xq", true),
            ("x", false),
            ("Q", true),
            ("\x1b[Aq", true),
            ("\x1b\x03", true),
            ("\x1b\x1b", true),
            ("\x1b[1;5A\x1b[Bx", false),
            ("\x1b[1;5Aq", true),
            ("\x1b[A", false),
            ("\x1bOq", false),
            ("\x1b[", false),
        ] {
            assert_eq!(ends(typed.as_bytes()), expected, "{typed:?}");
        }
    }
}
