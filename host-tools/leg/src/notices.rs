//! What the user should know of a board before anything else.

use leg_firmware::host_link::{Identity, ResetCause};
use leg_firmware::version::VERSION;

/// A version as text.
pub(crate) fn version_text([major, minor, patch]: [u8; 3]) -> String {
    format!("{major}.{minor}.{patch}")
}

/// A firmware of another version; an unwanted restart, with what the firmware reported before it.
pub(crate) fn notices(identity: &Identity) -> Vec<String> {
    let mut notices = Vec::new();
    if identity.version != VERSION {
        let [theirs, ours] = [identity.version, VERSION].map(version_text);
        notices.push(format!(
            "the firmware is version {theirs}, this program {ours}: `leg flash` makes them the same"
        ));
    }
    let cause = match identity.reset {
        ResetCause::BrownOut => "its supply was too low",
        ResetCause::Software => "its firmware had stopped by itself",
        ResetCause::Watchdog => "a task had not checked in with its watchdog",
        ResetCause::HungTick => "its control tick hung",
        ResetCause::Power | ResetCause::Pin | ResetCause::Other | ResetCause::Emulated => {
            return notices;
        }
    };
    let report = &identity.crash_report;
    let colon = if report.is_empty() { "" } else { ": " };
    notices.push(format!(
        "the board started anew because {cause}{colon}{report}"
    ));
    notices
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::notices;
    use leg_firmware::host_link::{BoardKind, Identity, ResetCause};
    use leg_firmware::version::VERSION;

    #[test]
    fn another_version_and_an_unwanted_restart_are_reported() {
        let version = VERSION.map(|part| part + 1);
        let [major, minor, patch] = version;
        let other = format!("the firmware is version {major}.{minor}.{patch}, this program ");
        for (version, reset, report, expected) in [
            (VERSION, ResetCause::Power, "", vec![]),
            (VERSION, ResetCause::Pin, "", vec![]),
            (VERSION, ResetCause::Other, "", vec![]),
            (VERSION, ResetCause::Emulated, "", vec![]),
            (
                VERSION,
                ResetCause::BrownOut,
                "",
                vec!["the board started anew because its supply was too low"],
            ),
            (
                VERSION,
                ResetCause::HungTick,
                "",
                vec!["the board started anew because its control tick hung"],
            ),
            (
                VERSION,
                ResetCause::Software,
                "panicked at leg.rs:7",
                vec![
                    "the board started anew because its firmware had stopped by itself: panicked at leg.rs:7",
                ],
            ),
            (
                version,
                ResetCause::Watchdog,
                "link",
                vec![
                    other.as_str(),
                    "the board started anew because a task had not checked in with its watchdog: link",
                ],
            ),
        ] {
            let found = notices(&Identity {
                board: BoardKind::InProcess,
                version,
                reset,
                crash_report: report.try_into().unwrap(),
            });
            assert_eq!(found.len(), expected.len(), "{found:?}");
            for (found, expected) in found.iter().zip(expected) {
                assert!(found.starts_with(expected), "{found}");
            }
        }
    }
}
