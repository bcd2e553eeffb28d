//! What the user should know of a board before anything else.

use super::line::version;
use leg_firmware::host_link::{Identity, Reset};
use leg_firmware::version::VERSION;

/// A firmware of another version; a start that nobody wanted, with what the firmware said before.
pub(super) fn notices(identity: &Identity) -> Vec<String> {
    let mut notices = Vec::new();
    if identity.version != VERSION {
        let [theirs, ours] = [identity.version, VERSION].map(version);
        notices.push(format!(
            "the firmware is version {theirs}, this program {ours}: `leg flash` makes them the same"
        ));
    }
    let cause = match identity.reset {
        Reset::BrownOut => "its supply was too low",
        Reset::Software => "its firmware had stopped by itself",
        Reset::Watchdog => "a task had not checked in with its watchdog",
        Reset::Power | Reset::Pin | Reset::Other | Reset::Emulated => return notices,
    };
    let words = &identity.last_words;
    let colon = if words.is_empty() { "" } else { ": " };
    notices.push(format!(
        "the board started anew because {cause}{colon}{words}"
    ));
    notices
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::notices;
    use leg_firmware::host_link::BoardKind;
    use leg_firmware::host_link::{Identity, Reset};
    use leg_firmware::version::VERSION;

    fn of(version: [u8; 3], reset: Reset, words: &str) -> Vec<String> {
        notices(&Identity {
            board: BoardKind::InProcess,
            version,
            reset,
            last_words: words.try_into().unwrap(),
        })
    }

    #[test]
    fn a_start_that_was_wanted_is_not_told() {
        for reset in [Reset::Power, Reset::Pin, Reset::Other, Reset::Emulated] {
            assert!(of(VERSION, reset, "").is_empty());
        }
    }

    #[test]
    fn a_start_that_nobody_wanted_is_told_with_the_last_words() {
        assert_eq!(
            of(VERSION, Reset::BrownOut, ""),
            ["the board started anew because its supply was too low"]
        );
        assert_eq!(
            of(VERSION, Reset::Software, "panicked at leg.rs:7"),
            [
                "the board started anew because its firmware had stopped by itself: panicked at leg.rs:7"
            ]
        );
        assert_eq!(
            of(VERSION, Reset::Watchdog, "link"),
            ["the board started anew because a task had not checked in with its watchdog: link"]
        );
    }

    #[test]
    fn another_version_is_told_first() {
        let told = of([9, 8, 7], Reset::BrownOut, "");
        assert!(
            told[0].starts_with("the firmware is version 9.8.7, this program "),
            "{told:?}"
        );
        assert_eq!(told.len(), 2);
    }
}
