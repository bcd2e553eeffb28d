//! The keys of the terminal, where it is no file: by crossterm's events.

use ratatui::crossterm::event::{Event, KeyCode, KeyModifiers, poll, read};
use std::io;
use std::time::Duration;

/// Where the keys come from.
pub(super) struct Keys;

impl Keys {
    /// The terminal of this process.
    pub(super) fn open() -> io::Result<Self> {
        Ok(Self)
    }

    /// Whether the user has pressed a key that ends the screen, or the terminal has gone.
    pub(super) fn end_wanted(&mut self) -> bool {
        loop {
            match poll(Duration::ZERO) {
                Ok(true) => {}
                Ok(false) => return false,
                Err(_) => return true,
            }
            match read() {
                Ok(Event::Key(key)) => match key.code {
                    KeyCode::Char('q') | KeyCode::Esc => return true,
                    KeyCode::Char('c') if key.modifiers.contains(KeyModifiers::CONTROL) => {
                        return true;
                    }
                    _ => {}
                },
                Ok(_) => {}
                Err(_) => return true,
            }
        }
    }
}
