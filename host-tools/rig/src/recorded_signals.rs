//! The signals of the board's recorder by name, as rig files, recordings and options give them.

use crate::toml_error::TomlError;
use crate::toml_section::Section;
use leg_firmware::settings::{RECORDED_SIGNALS, RecordedSignal, SignalSet};

/// The key in `[control]`.
pub const RECORDED: &str = "recorded";

/// The name of a signal.
#[must_use]
pub const fn word(signal: RecordedSignal) -> &'static str {
    match signal {
        RecordedSignal::Tensions => "tensions",
        RecordedSignal::TargetTensions => "target_tensions",
        RecordedSignal::Pulled => "pulled",
        RecordedSignal::References => "references",
        RecordedSignal::Currents => "currents",
        RecordedSignal::Duties => "duties",
        RecordedSignal::Pose => "pose",
        RecordedSignal::Board => "board",
    }
}

/// The names of those in a set.
pub fn words(set: SignalSet) -> impl Iterator<Item = &'static str> {
    let signals = RECORDED_SIGNALS.into_iter();
    signals.filter(move |signal| set.has(*signal)).map(word)
}

/// What `[control]` of a rig file chooses.
pub(crate) fn read(control: &Section<'_>) -> Result<SignalSet, TomlError> {
    if !control.has(RECORDED) {
        return Ok(SignalSet::default());
    }
    let mut signals = Vec::new();
    for name in control.words(RECORDED)? {
        let named = |signal: &RecordedSignal| word(*signal) == *name.get_ref();
        let Some(signal) = RECORDED_SIGNALS.into_iter().find(named) else {
            let sentence = format!("the recorder has no signal `{}`", name.get_ref());
            let names = RECORDED_SIGNALS.map(|signal| format!("`{}`", word(signal)));
            let help = format!("choose of {}", names.join(", "));
            return Err(TomlError::new(name.span(), sentence, help));
        };
        signals.push(signal);
    }
    Ok(SignalSet::new(&signals))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use crate::ready_rigs::READY_RIGS;
    use crate::rig_file::RigFile;
    use leg_firmware::settings::{RecordedSignal, SignalSet};

    fn read(line: &str) -> Result<SignalSet, String> {
        let text = format!("{}\n[control]\n{line}\n", READY_RIGS[0].text);
        let file = RigFile::parse("rig.toml", &text).map_err(|failure| failure.render(false))?;
        Ok(file.recorded)
    }

    #[test]
    fn signals_are_chosen_by_name() {
        assert_eq!(read(""), Ok(SignalSet::default()));
        assert_eq!(read("recorded = []"), Ok(SignalSet::NONE));
        let chosen = SignalSet::new(&[RecordedSignal::Currents, RecordedSignal::Board]);
        assert_eq!(
            read("recorded = [\"board\", \"currents\", \"board\"]"),
            Ok(chosen)
        );
    }

    #[test]
    fn what_cannot_be_recorded_is_named() {
        let refusal = read("recorded = [\"duties\", \"noise\"]").unwrap_err();
        assert!(
            refusal.contains("the recorder has no signal `noise`"),
            "{refusal}"
        );
        assert!(
            refusal.contains("`tensions`, `target_tensions`"),
            "{refusal}"
        );
        for other in ["recorded = 3", "recorded = [3]", "recorded = \"duties\""] {
            let refusal = read(other).unwrap_err();
            assert!(refusal.contains("recorded"), "{refusal}");
        }
    }
}
