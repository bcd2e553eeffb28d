//! What the fault table says, for a leg: each setting that it names stands there with its value.

use leg_rig::rig_file::RigFile;
use leg_rig::rig_settings::{self, Setting, written};

/// Where a key is looked for first, if several sections have it: the monitors' own limits.
const LIMITS: &str = "control.limits";

/// The words, with the value and unit of each setting behind its key.
#[must_use]
pub fn with_values(words: &str, rig: &RigFile) -> String {
    if !words.contains('_') {
        return words.into();
    }
    let mut settings = rig_settings::control(rig);
    settings.sort_by_key(|setting| setting.section != LIMITS);
    settings.extend(rig_settings::actuator(rig));
    let mut told = String::new();
    for part in words.split_inclusive(|letter: char| !is_of_key(letter)) {
        let key = part.trim_end_matches(|letter: char| !is_of_key(letter));
        let (_, rest) = part.split_at(key.len());
        told.push_str(key);
        let found = settings.iter().find(|setting| setting.key == key);
        told.extend(found.map(|setting| format!(" ({})", value(setting))));
        told.push_str(rest);
    }
    told
}

const fn is_of_key(letter: char) -> bool {
    letter.is_ascii_alphanumeric() || letter == '_'
}

fn value(setting: &Setting) -> String {
    let value = written(&setting.value);
    match setting.unit {
        "1" => value,
        unit => format!("{value} {unit}"),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{is_of_key, with_values};
    use leg_firmware::supervisor::{FAULT_TABLE, Fault};
    use leg_rig::rig_file::RigFile;

    #[test]
    fn a_cause_has_the_values_of_its_settings() {
        let mut rig = RigFile::load(None).unwrap();
        rig.gains.limits.jump_n = 40.0;
        let told = |fault: Fault, rig: &RigFile| with_values(fault.entry().cause, rig);
        assert_eq!(
            told(Fault::TensionJump, &rig),
            "a tension changes by jump_n (40 N) within a millisecond, or by three tenths of it while lengths and tensions come to disagree"
        );
        // The servo has a key of this name, too.
        assert_eq!(
            told(Fault::OverCurrent, &rig),
            "a motor draws more than current_a (8 A) for 2 ms"
        );
        assert_eq!(
            told(Fault::EmergencyStop, &rig),
            "the emergency stop is pressed"
        );
    }

    #[test]
    fn every_key_in_the_fault_table_is_a_setting() {
        let rig = RigFile::load(None).unwrap();
        for words in FAULT_TABLE.iter().flat_map(|row| [row.cause, row.remedy]) {
            let keys = words.split(|letter| !is_of_key(letter));
            let count = keys.filter(|word| word.contains('_')).count();
            let told = with_values(words, &rig);
            assert_eq!(
                told.matches(" (").count() - words.matches(" (").count(),
                count,
                "{told}"
            );
        }
    }
}
