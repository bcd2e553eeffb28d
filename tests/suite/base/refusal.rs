//! Which refusal it is, as `firmware/PROTOCOL.md` lists them.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_base::refusal::variants;
use leg_boards::image::workspace_root;
use leg_firmware::command::CommandRefusal;
use leg_firmware::frame::FrameError;
use leg_firmware::host_link::HostRefusal;
use leg_firmware::set_point::{MotionLimit, PointRefusal};
use leg_firmware::supervisor::State;

#[test]
fn a_refusal_has_the_numbers_and_names_of_the_protocols_page() {
    let page = std::fs::read_to_string(workspace_root().join("firmware/PROTOCOL.md")).unwrap();
    let too_fast = PointRefusal::Limit(MotionLimit::Speed);
    let schema = [1; 8];
    for (refusal, name) in [
        (HostRefusal::SchemaMismatch { schema }, "SchemaMismatch"),
        (HostRefusal::BadFrame(FrameError::BadCrc), "BadFrame.BadCrc"),
        (HostRefusal::OtherHost, "OtherHost"),
        // Not in which state: its name is no variant of a refusal.
        (
            HostRefusal::Command(CommandRefusal::State(State::Held)),
            "Command.State",
        ),
        (
            HostRefusal::Command(CommandRefusal::Point(too_fast)),
            "Command.Point.Limit.Speed",
        ),
    ] {
        let found = variants(&refusal);
        let names: Vec<_> = found.iter().map(|(_, name)| name.as_str()).collect();
        assert_eq!(names.join("."), name);
        for (number, name) in &found {
            let listed = format!("    {number} {name}");
            let is_it = |line: &str| {
                let after = line.strip_prefix(&listed);
                after.is_some_and(|rest| rest.is_empty() || rest.starts_with(':'))
            };
            assert!(page.lines().any(is_it), "{listed}");
        }
    }
}
