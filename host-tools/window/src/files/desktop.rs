//! On a desktop: files are read and written at their paths.

use super::Files;
use egui::{Context, DroppedFileHandle};
use leg_base::atomic_file;
use std::fs;
use std::path::Path;

pub(super) fn read(files: &Files, dropped: DroppedFileHandle, _: &Context) {
    read_path(files, dropped.path());
}

pub(super) fn read_path(files: &Files, path: &Path) {
    let name = path.display().to_string();
    let size = fs::metadata(path).map_or(0.0, |found| found.len() as f64);
    if !files.put_too_large(&name, size) {
        files.put(&name, fs::read(path).map_err(|error| error.to_string()));
    }
}

/// A path is typed here.
pub(super) fn choose(_: &Files, _: &Context) {}

pub(super) fn save(name: &str, bytes: &[u8]) -> Result<String, String> {
    let path = Path::new(name);
    let written = atomic_file::replace(path, |new| fs::write(new, bytes));
    written.map_err(|error: std::io::Error| format!("{name} is not written: {error}"))?;
    let shown = fs::canonicalize(path).unwrap_or_else(|_| path.into());
    Ok(format!("{} is written.", shown.display()))
}
