//! Tests that pages quote by name.

use super::sources::sources;
use leg_boards::image::workspace_root;

/// The sources of all tests that a page may quote.
pub fn test_sources() -> String {
    let mut text = String::new();
    for directory in ["tests/suite", "firmware/library/src", "host-tools"] {
        sources(&workspace_root().join(directory), &mut text);
    }
    text
}

/// Requires that a name is that of a test which `cargo test` runs.
///
/// # Panics
/// Where it is not.
pub fn require_test(sources: &str, name: &str) {
    let place = sources.split_once(&format!("fn {name}()"));
    let Some((before, _)) = place else {
        panic!("no test is called {name}");
    };
    let attributes = before.trim_end().rsplit("\n\n").next().unwrap_or_default();
    assert!(attributes.contains("#[test]"), "{name} is no test");
    assert!(!attributes.contains("#[ignore"), "{name} is ignored");
}
