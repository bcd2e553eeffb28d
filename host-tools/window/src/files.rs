//! Files that the user gives to the window, by dropping them or by a dialog, and files that the window gives back.

#[cfg(target_arch = "wasm32")]
#[path = "files/browser.rs"]
mod platform;
#[cfg(not(target_arch = "wasm32"))]
#[path = "files/desktop.rs"]
mod platform;

use egui::Context;
use egui::DroppedFileHandle;
use leg_base::failure::Failure;
use leg_base::text_input;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::path::Path;
use std::rc::Rc;

/// Whether a dialog of the system asks for a file; else its path is typed.
pub const DIALOG: bool = cfg!(target_arch = "wasm32");

/// A file that was given: its name, and its bytes or why they are not read.
#[derive(Debug)]
pub struct GivenFile {
    /// As the user knows it.
    pub name: String,
    /// What is in it.
    pub bytes: Result<Vec<u8>, Failure>,
}

/// What files are of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FileKind {
    /// A rig: whatever is no recording.
    #[default]
    Rig,
    /// A recording: what is called so.
    Recording,
}

/// The largest recording that is opened or made, bytes.
pub const RECORDING_BYTES_MAX: u64 = 256 << 20;

impl FileKind {
    /// What a dialog asks for.
    #[cfg_attr(
        not(target_arch = "wasm32"),
        allow(dead_code, reason = "there is no dialog")
    )]
    const fn accepted(self) -> &'static str {
        match self {
            Self::Rig => ".toml,text/plain",
            Self::Recording => ".mcap",
        }
    }

    /// What a file of that many bytes is refused for; none if it may be read.
    #[must_use]
    pub fn too_large(self, name: &str, bytes: f64) -> Option<Failure> {
        let (most, no, help) = match self {
            Self::Rig => (
                text_input::FILE_BYTES_MAX,
                "no rig file is",
                "give a rig file, which is text in TOML: save one of the ready rigs here, and change it",
            ),
            Self::Recording => (
                RECORDING_BYTES_MAX,
                "no more is held in memory",
                "record for a shorter time, or look at it in Foxglove or by `leg plot`",
            ),
        };
        let words = format!("{name} is larger than {} MiB: {no}", most >> 20);
        (bytes > most as f64).then(|| Failure::refused(words, help))
    }

    /// Whether a dropped file is one.
    fn is_of(self, path: &Path) -> bool {
        let end = path.extension();
        let named = end.is_some_and(|end| end.eq_ignore_ascii_case("mcap"));
        named == (self == Self::Recording)
    }
}

type Heap = Rc<RefCell<VecDeque<GivenFile>>>;

/// Files on their way into the window.
#[derive(Clone, Default)]
pub struct Files {
    kind: FileKind,
    /// Those that have come: a browser reads them later.
    heap: Heap,
}

impl Files {
    /// Of one kind.
    #[must_use]
    pub fn new(kind: FileKind) -> Self {
        Self {
            kind,
            heap: Heap::default(),
        }
    }

    /// Takes what of its kind was dropped on the window.
    pub fn take_dropped(&self, ctx: &Context) {
        let dropped = ctx.input_mut(|input| {
            let (taken, others): (Vec<DroppedFileHandle>, Vec<_>) = input
                .raw
                .dropped_files
                .drain(..)
                .partition(|file| self.kind.is_of(file.path()));
            input.raw.dropped_files = others;
            taken
        });
        for file in dropped {
            platform::read(self, file, ctx);
        }
    }

    /// Lets the user choose one.
    pub fn choose(&self, ctx: &Context) {
        platform::choose(self, ctx);
    }

    /// Reads the one at a path.
    pub fn read_path(&self, path: &str) {
        platform::read_path(self, Path::new(path));
    }

    /// The next one.
    pub fn next(&self) -> Option<GivenFile> {
        self.heap.borrow_mut().pop_front()
    }

    fn put(&self, name: &str, bytes: Result<Vec<u8>, String>) {
        let help = "see that it exists and may be read, and give it again";
        let refused = |why| Failure::refused(format!("cannot read {name}: {why}"), help);
        self.heap.borrow_mut().push_back(GivenFile {
            name: name.into(),
            bytes: bytes.map_err(refused),
        });
    }

    /// Refuses a file by its size, before anything of it is read. Whether it is refused.
    fn put_too_large(&self, name: &str, bytes: f64) -> bool {
        let Some(failure) = self.kind.too_large(name, bytes) else {
            return false;
        };
        self.heap.borrow_mut().push_back(GivenFile {
            name: name.into(),
            bytes: Err(failure),
        });
        true
    }

    /// Gives the user a file; what became of it.
    ///
    /// # Errors
    /// What the system says.
    pub fn save(name: &str, bytes: &[u8]) -> Result<String, String> {
        platform::save(name, bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::FileKind;
    use std::path::Path;

    #[test]
    fn a_dropped_file_is_of_one_kind() {
        for (name, recording) in [
            ("a.mcap", true),
            ("a.MCAP", true),
            ("a.toml", false),
            ("mcap", false),
        ] {
            assert_eq!(
                FileKind::Recording.is_of(Path::new(name)),
                recording,
                "{name}"
            );
            assert_eq!(FileKind::Rig.is_of(Path::new(name)), !recording, "{name}");
        }
    }

    #[test]
    fn a_recording_may_be_larger_than_a_rig_file() {
        let large = 2.0 * 1024.0 * 1024.0;
        assert!(FileKind::Rig.too_large("a", large).is_some());
        assert!(FileKind::Recording.too_large("a", large).is_none());
        let words = FileKind::Recording.too_large("a.mcap", 1e9);
        let words = words
            .map(|failure| failure.render(false))
            .unwrap_or_default();
        assert!(
            words.contains("a.mcap is larger than 256 MiB") && words.contains("help: "),
            "{words}"
        );
    }
}
