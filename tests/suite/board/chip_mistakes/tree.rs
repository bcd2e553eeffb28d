//! A copy of the workspace, in which the mistakes are made.

use super::Mistake;
use leg_boards::image::{FirmwareImage, workspace_root};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

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

/// One image is built at a time.
static TREE: Mutex<()> = Mutex::new(());

/// Builds the image with a mistake. The copy is always in the same place, so that dependencies are compiled once.
pub fn image_with(mistake: &Mistake, name: &str) -> PathBuf {
    let alone = TREE.lock().unwrap_or_else(PoisonError::into_inner);
    let (root, directory) = (workspace_root(), workspace_root().join("target/mistakes"));
    fs::create_dir_all(&directory).unwrap();
    for part in PARTS {
        copy(&root.join(part), &directory.join(part));
    }
    let path = directory.join(mistake.file);
    let text = fs::read_to_string(&path).unwrap();
    let count = text.matches(mistake.right).count();
    assert_eq!(
        count, 1,
        "{name}: {} has `{}` {count} times: mend the mistake",
        mistake.file, mistake.right
    );
    fs::write(&path, text.replace(mistake.right, mistake.wrong)).unwrap();
    let built = FirmwareImage::Stm32g474.build_in(&directory);
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
            if name != "target" {
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
