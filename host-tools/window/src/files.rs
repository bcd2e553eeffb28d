//! Files that the user gives to the window, by dropping them or by a dialog, and files that the window gives back.

#[cfg(target_arch = "wasm32")]
#[path = "files/browser.rs"]
mod platform;
#[cfg(not(target_arch = "wasm32"))]
#[path = "files/desktop.rs"]
mod platform;

use crate::rig_intake::too_large;
use eframe::egui::Context;
use eframe::egui::DroppedFileHandle;
use leg_base::failure::Failure;
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

type Heap = Rc<RefCell<VecDeque<GivenFile>>>;

/// Files on their way into the window.
#[derive(Default)]
pub struct Files {
    /// Those that have come: a browser reads them later.
    heap: Heap,
}

impl Files {
    /// Takes what was dropped on the window but for recordings.
    pub fn take_dropped(&self, ctx: &Context) {
        let dropped = ctx.input_mut(|input| {
            let (rigs, others): (Vec<DroppedFileHandle>, Vec<_>) = input
                .raw
                .dropped_files
                .drain(..)
                .partition(|file| !is_recording(file.path()));
            input.raw.dropped_files = others;
            rigs
        });
        for file in dropped {
            platform::read(&self.heap, file, ctx);
        }
    }

    /// Lets the user choose one.
    pub fn choose(&self, ctx: &Context) {
        platform::choose(&self.heap, ctx);
    }

    /// Reads the one at a path.
    pub fn read_path(&self, path: &str) {
        platform::read_path(&self.heap, Path::new(path));
    }

    /// The next one.
    pub fn next(&self) -> Option<GivenFile> {
        self.heap.borrow_mut().pop_front()
    }

    /// Gives the user a text as a file; what became of it.
    ///
    /// # Errors
    /// What the system says.
    pub fn save(name: &str, text: &str) -> Result<String, String> {
        platform::save(name, text)
    }
}

fn is_recording(path: &Path) -> bool {
    path.extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("mcap"))
}

fn put(heap: &Heap, name: &str, bytes: Result<Vec<u8>, String>) {
    let help = "see that it exists and may be read, and give it again";
    let refused = |why| Failure::refused(format!("cannot read {name}: {why}"), help);
    heap.borrow_mut().push_back(GivenFile {
        name: name.into(),
        bytes: bytes.map_err(refused),
    });
}

/// Refuses a file by its size, before anything of it is read. Whether it is refused.
fn put_too_large(heap: &Heap, name: &str, bytes: f64) -> bool {
    let Some(failure) = too_large(name, bytes) else {
        return false;
    };
    heap.borrow_mut().push_back(GivenFile {
        name: name.into(),
        bytes: Err(failure),
    });
    true
}
