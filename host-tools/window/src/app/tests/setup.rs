//! Rig files and settings, as their user has them.

use super::Window;
use egui::{DroppedFile, Event, Key};
use leg_firmware::supervisor::State;
use leg_rig::ready_rigs::READY_RIGS;
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// A file of this process alone, with a name that the window shows.
pub(super) fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let directory = std::env::temp_dir().join(format!("leg-window-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let path = directory.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

impl Window {
    /// Drops a file, and waits until it is read.
    pub(super) fn drop_file(&mut self, path: &Path) {
        self.begin_to_read(path);
        while self.app.reader.is_some() {
            self.frames(1);
        }
        self.frames(3);
    }

    /// Drops a file.
    pub(super) fn begin_to_read(&mut self, path: &Path) {
        let dropped = Arc::new(Dropped(path.into()));
        self.frame_with(Vec::new(), vec![dropped]);
        std::fs::remove_file(path).unwrap();
    }

    pub(super) fn type_value(&mut self, name: &str, text: &str) {
        self.press(name);
        assert_eq!(self.app.places.focused.as_deref(), Some(name));
        self.frame(vec![
            Event::Key {
                key: Key::A,
                physical_key: None,
                pressed: true,
                repeat: false,
                modifiers: egui::Modifiers::COMMAND,
            },
            Event::Text(text.into()),
        ]);
        self.key(Key::Enter);
        self.frames(3);
    }

    fn leg_length_m(&self) -> f64 {
        self.leg().rig().parameters.leg_length_m
    }
}

#[test]
fn a_rig_file_that_is_dropped_becomes_the_leg() {
    let mut window = Window::new();
    let text = READY_RIGS[0].text.replace("leg_mm = 190", "leg_mm = 250");
    window.drop_file(&file("longer.toml", text.as_bytes()));
    assert_eq!(window.leg_length_m(), 0.25);
    assert_eq!(window.state(), State::Active);
    assert!(window.shows("notice"));
    window.press("notice_close");
    assert!(!window.shows("notice"));
    // It is that rig that starts again.
    window.press("start_again");
    assert_eq!(window.leg_length_m(), 0.25);
}

#[test]
fn a_bad_file_leaves_the_leg_as_it_is() {
    let bad = READY_RIGS[0].text.replace("leg_mm = 190", "leg_mm = -1");
    for (name, bytes) in [
        ("bad.toml", bad.as_bytes()),
        ("picture.png", b"\x89PNG\0\xff"),
        ("huge.toml", &vec![b'#'; (1 << 20) + 1]),
    ] {
        let mut window = Window::new();
        let before = window.leg().leg().ticks();
        window.drop_file(&file(name, bytes));
        assert!(window.shows("notice"), "{name}");
        assert_eq!(window.leg_length_m(), 0.19);
        assert!(window.leg().leg().ticks() > before);
        assert_eq!(window.state(), State::Active);
    }
}

#[test]
fn a_ready_rig_is_chosen_and_its_settings_are_edited_checked_and_applied() {
    let mut window = Window::new();
    window.press("setup");
    window.press("rig_spherical");
    assert_eq!(window.leg().source().name, "spherical.toml");
    window.press("setup_settings");
    let key = "value_geometry.leg_mm";
    window.type_value(key, "-4");
    assert!(window.shows("settings_refused"));
    window.type_value(key, "210");
    assert!(!window.shows("settings_refused"));
    assert_eq!(window.leg_length_m(), 0.19);
    window.press("settings_apply");
    assert_eq!(window.leg_length_m(), 0.21);
    assert_eq!(window.state(), State::Active);
    // What was changed stays marked against the file, and goes back to it.
    window.press("file_geometry.leg_mm");
    window.press("settings_apply");
    assert_eq!(window.leg_length_m(), 0.19);
    window.press("settings_undo");
    window.press("settings_apply");
    assert_eq!(window.leg_length_m(), 0.21);
}

#[test]
fn a_stop_works_from_the_settings() {
    let mut window = Window::new();
    window.press("setup");
    window.press("setup_settings");
    window.press("settings_search");
    window.key(Key::Space);
    window.frames(5);
    assert_eq!(window.state(), State::Held);
    window.press("setup");
    assert!(window.shows("leg"));
}
