//! On a desktop: files are read and written at their paths.

use super::{Heap, put, put_too_large};
use eframe::egui::{Context, DroppedFileHandle};
use leg_base::atomic_file;
use std::fs;
use std::path::Path;

pub(super) fn read(heap: &Heap, dropped: DroppedFileHandle, _: &Context) {
    read_path(heap, dropped.path());
}

pub(super) fn read_path(heap: &Heap, path: &Path) {
    let name = path.display().to_string();
    let size = fs::metadata(path).map_or(0.0, |found| found.len() as f64);
    if !put_too_large(heap, &name, size) {
        put(
            heap,
            &name,
            fs::read(path).map_err(|error| error.to_string()),
        );
    }
}

/// A path is typed here.
pub(super) fn choose(_: &Heap, _: &Context) {}

pub(super) fn save(name: &str, text: &str) -> Result<String, String> {
    let path = Path::new(name);
    let written = atomic_file::replace(path, |new| fs::write(new, text));
    written.map_err(|error: std::io::Error| format!("{name} is not written: {error}"))?;
    let shown = fs::canonicalize(path).unwrap_or_else(|_| path.into());
    Ok(format!("{} is written.", shown.display()))
}
