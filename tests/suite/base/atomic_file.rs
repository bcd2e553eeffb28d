//! Files that are there as a whole or not at all.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::atomic_file::{PartFile, StagingDirectory, replace};
use std::io::{self, Write as _};

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("chart.svg");
    std::fs::write(&path, "old").unwrap();
    let failed = replace(&path, |new| -> io::Result<()> {
        std::fs::write(new, "half")?;
        Err(io::Error::other("disk full"))
    });
    assert!(failed.is_err());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
}

#[test]
fn a_directory_is_refused_before_anything_is_written() {
    let directory = tempfile::tempdir().unwrap();
    let refused = replace(directory.path(), |_| -> io::Result<()> { unreachable!() });
    let kind = refused.unwrap_err().kind();
    assert_eq!(kind, io::ErrorKind::IsADirectory);
}

#[cfg(unix)]
#[test]
fn a_device_is_no_place_for_a_file_and_a_link_stays_one() {
    let directory = tempfile::tempdir().unwrap();
    let device = std::path::Path::new("/dev/null");
    let refused = replace(device, |_| -> io::Result<()> { unreachable!() });
    let part = PartFile::create(device).map(drop);
    for refused in [refused, part] {
        assert_eq!(refused.unwrap_err().kind(), io::ErrorKind::InvalidInput);
    }
    let [file, link] = ["file", "link"].map(|name| directory.path().join(name));
    std::fs::write(&file, "old").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    replace(&link, |new| std::fs::write(new, "new")).unwrap();
    assert!(link.is_symlink());
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "new");
    let (part, mut written) = PartFile::create(&link).unwrap();
    let unfinished = PartFile::unfinished(&link).unwrap();
    assert_eq!(unfinished.file_name().unwrap(), "file.part");
    written.write_all(b"newer").unwrap();
    part.commit().unwrap();
    assert!(link.is_symlink());
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "newer");
}

#[test]
fn a_whole_write_replaces_it_and_makes_the_directory() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a/b/chart.svg");
    replace(&path, |new| std::fs::write(new, "new")).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
    let directory = directory.path().join("a/b");
    assert_eq!(std::fs::read_dir(&directory).unwrap().count(), 1);
    let usual = directory.join("usual");
    std::fs::write(&usual, "").unwrap();
    let [found, usual] = [path, usual].map(|path| std::fs::metadata(path).unwrap().permissions());
    assert_eq!(found, usual);
}

#[test]
fn several_files_are_delivered_together_or_not_at_all() {
    let directory = tempfile::tempdir().unwrap();
    let made = || {
        let staging = StagingDirectory::new(directory.path()).unwrap();
        for name in ["a.svg", "b.svg", "c.svg"] {
            std::fs::write(staging.path().join(name), "new").unwrap();
        }
        staging
    };
    std::fs::create_dir(directory.path().join("b.svg")).unwrap();
    assert!(made().check().is_err());
    assert!(made().commit().is_err());
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    std::fs::remove_dir(directory.path().join("b.svg")).unwrap();
    made().commit().unwrap();
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 3);
}

#[cfg(unix)]
#[test]
fn a_file_at_which_another_program_is_at_work_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("leg.mcap");
    let (part, file) = PartFile::create(&path).unwrap();
    let second = PartFile::create(&path).map(drop).unwrap_err();
    assert_eq!(second.kind(), io::ErrorKind::ResourceBusy);
    let sentence = second.to_string();
    assert!(sentence.contains("leg.part.mcap"), "{sentence}");
    // Once it is killed, what it leaves is left alone.
    drop(file);
    let left = part.keep().unwrap();
    assert_eq!(PartFile::unfinished(&path), Some(left.clone()));
    let (other, _file) = PartFile::create(&path).unwrap();
    other.commit().unwrap();
    assert!(path.exists() && left.exists());
}
