//! Paths as a user reads them.

use std::env;
use std::path::{Path, PathBuf};

/// The path from the working directory, if it lies below it.
#[must_use]
pub fn relative_path(path: &Path) -> PathBuf {
    let here = env::current_dir().unwrap_or_default();
    path.strip_prefix(here).unwrap_or(path).to_path_buf()
}
