//! A rig file that is given to the window: read and checked, or refused as the command line refuses it.

use crate::files::FileKind;
use leg_base::failure::Failure;
use leg_rig::rig_file::{RigFile, RigText};

/// A rig with its text.
#[derive(Clone, Debug)]
pub struct OpenedRig {
    /// As it was given.
    pub source: RigText,
    /// What it says.
    pub rig: RigFile,
    /// What it should say otherwise.
    pub notes: Vec<String>,
}

const HELP: &str =
    "give a rig file, which is text in TOML: save one of the ready rigs here, and change it";

/// The rig of a file.
///
/// # Errors
/// What is wrong with it, with the place where that is known.
pub fn open(name: &str, bytes: Vec<u8>) -> Result<OpenedRig, Failure> {
    if let Some(failure) = FileKind::Rig.too_large(name, bytes.len() as f64) {
        return Err(failure);
    }
    let text = String::from_utf8(bytes).ok();
    // Text has no zeros: a recording or a picture has, soon.
    let text = text.filter(|text| !text.contains('\0'));
    let no_text = || Failure::refused(format!("{name} is no text: no rig file is so"), HELP);
    read(RigText {
        name: name.into(),
        text: text.ok_or_else(no_text)?,
    })
}

/// The same of a text.
///
/// # Errors
/// As [`open`].
pub fn read(source: RigText) -> Result<OpenedRig, Failure> {
    let (rig, notes) = source.read()?;
    Ok(OpenedRig { source, rig, notes })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::open;
    use leg_rig::ready_rigs::READY_RIGS;

    #[test]
    fn a_good_rig_is_read() {
        let text = READY_RIGS[0].text.replace("leg_mm = 190", "leg_mm = 250");
        let opened = open("mine.toml", text.into_bytes()).unwrap();
        assert_eq!(opened.rig.parameters.leg_length_m, 0.25);
        assert_eq!(opened.source.name, "mine.toml");
    }

    #[test]
    fn a_mistake_has_its_line_its_column_its_text_and_a_remedy() {
        let text = READY_RIGS[0].text.replace("leg_mm = 190", "leg_m = 190");
        let line = 1 + text.lines().position(|line| line == "leg_m = 190").unwrap();
        let words = open("mine.toml", text.into_bytes())
            .unwrap_err()
            .render(false);
        for part in ["unknown key `leg_m`", "leg_m = 190", "help: ", "leg_mm"] {
            assert!(words.contains(part), "{words}");
        }
        assert!(words.contains(&format!("mine.toml:{line}:1")), "{words}");
    }

    #[test]
    fn what_is_no_rig_file_is_refused_by_name() {
        for (bytes, expected) in [
            (vec![0x89, b'P', b'N', b'G', 0xff], "is no text"),
            (b"[geometry]\0".to_vec(), "is no text"),
            (vec![b'a'; (1 << 20) + 1], "is larger than 1 MiB"),
            (Vec::new(), "missing section `[geometry]`"),
        ] {
            let words = open("given.bin", bytes).unwrap_err().render(false);
            assert!(words.contains("given.bin"), "{words}");
            assert!(
                words.contains(expected) && words.contains("help: "),
                "{words}"
            );
        }
    }
}
