//! Copies of the workspace, in which the mistakes are made.

use super::Mistake;
use leg_boards::image::{FirmwareImage, workspace_root};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

/// What is copied: all members, as cargo reads the manifests of all.
const PARTS: [&str; 7] = [
    "Cargo.toml",
    "Cargo.lock",
    "memory.x",
    "model",
    "firmware",
    "host-tools",
    "tests",
];

/// What is set beside the settings of the workspace. Without lines and types for a debugger, and without the optimisation of all crates
/// together at the end, an image takes half of the time. Without that the hot code fits its memory at level 2 only. The test of an image without a
/// mistake shows that it still does what it shall.
const SETTINGS: &str = "[profile.firmware]\ndebug = false\nlto = false\nopt-level = 2\n";

/// In each copy one image is built at a time. Most of that runs on one core: so there are as many as CI's machine has.
static TREES: [Mutex<()>; 2] = [Mutex::new(()), Mutex::new(())];

/// A copy in which nothing is built, and its number; without one the first, once it is free.
fn free_tree() -> (usize, MutexGuard<'static, ()>) {
    for (number, tree) in TREES.iter().enumerate() {
        match tree.try_lock() {
            Ok(alone) => return (number, alone),
            Err(TryLockError::Poisoned(alone)) => return (number, alone.into_inner()),
            Err(TryLockError::WouldBlock) => {}
        }
    }
    let [first, _] = &TREES;
    (0, first.lock().unwrap_or_else(PoisonError::into_inner))
}

/// Builds the image with a mistake. The copies are always in the same places, so that dependencies are compiled once in each.
pub fn image_with(mistake: &Mistake, name: &str) -> PathBuf {
    let (number, alone) = free_tree();
    let root = workspace_root();
    let directory = root.join(format!("target/mistakes/{number}"));
    fs::create_dir_all(directory.join(".cargo")).unwrap();
    fs::write(directory.join(".cargo/config.toml"), SETTINGS).unwrap();
    for part in PARTS {
        copy(&root.join(part), &directory.join(part));
    }
    let path = directory.join(mistake.file);
    let text = fs::read_to_string(&path).unwrap();
    let count = mistake.count_in(&text);
    assert_eq!(
        count, 1,
        "{name}: {} has `{}` {count} times: mend the mistake",
        mistake.file, mistake.right
    );
    fs::write(&path, text.replace(mistake.right, mistake.wrong)).unwrap();
    let built = FirmwareImage::Stm32g474.build_in(&directory, &|| false);
    let built = built.unwrap_or_else(|error| panic!("{name}: {error}"));
    // The next build overwrites it while this one runs.
    let image = directory.join(format!("target/{name}.elf"));
    fs::copy(built, &image).unwrap();
    drop(alone);
    image
}

/// Copies what differs: what is as it was is not compiled again.
fn copy(from: &Path, to: &Path) {
    if from.is_dir() {
        fs::create_dir_all(to).unwrap();
        for entry in fs::read_dir(from).unwrap() {
            let name = entry.unwrap().file_name();
            // What is built, what the fuzzers keep beside their sources, and workspaces of their own, whose tests write beside this one.
            if !["target", "corpus", "artifacts", "python", "window"]
                .map(OsString::from)
                .contains(&name)
            {
                copy(&from.join(&name), &to.join(&name));
            }
        }
        return;
    }
    let bytes = fs::read(from).unwrap();
    if fs::read(to).ok().as_ref() != Some(&bytes) {
        fs::write(to, bytes).unwrap();
    }
}
