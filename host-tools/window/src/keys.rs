//! The keys that stop the leg: space and Escape. They are taken from the input before a control or a menu sees them, so
//! they stop it whatever has the focus.

use egui::{Event, Key};

/// Takes them out of the input. Whether one was pressed.
pub fn take_stop(events: &mut Vec<Event>) -> bool {
    let mut stop = false;
    events.retain(|event| {
        let (stops, pressed) = match event {
            Event::Key { key, pressed, .. } => (matches!(key, Key::Space | Key::Escape), *pressed),
            // A keyboard on a screen sends the letter alone.
            Event::Text(text) => (text == " ", true),
            _ => (false, false),
        };
        stop |= stops && pressed;
        !stops
    });
    stop
}

#[cfg(test)]
mod tests {
    use super::take_stop;
    use egui::{Event, Key, Modifiers};

    fn key(key: Key, pressed: bool, modifiers: Modifiers) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers,
        }
    }

    #[test]
    fn a_stop_is_taken_and_the_rest_is_left() {
        for stop in [Key::Space, Key::Escape] {
            for modifiers in [Modifiers::NONE, Modifiers::SHIFT, Modifiers::CTRL] {
                let other = key(Key::ArrowUp, true, modifiers);
                let mut events = vec![key(stop, true, modifiers), other.clone()];
                assert!(take_stop(&mut events));
                assert_eq!(events, [other]);
            }
            let mut released = vec![key(stop, false, Modifiers::NONE)];
            assert!(!take_stop(&mut released) && released.is_empty());
        }
    }

    #[test]
    fn a_space_that_is_typed_is_a_stop() {
        let text = |text: &str| Event::Text(text.into());
        let mut events = vec![text(" "), text("a")];
        assert!(take_stop(&mut events));
        assert_eq!(events, [text("a")]);
        assert!(!take_stop(&mut events));
    }
}
