//! What a host asks of the recorder.

use super::{Line, refused};
use crate::host_link::{HostRefusal, HostReply, HostRequest};
use crate::recorder::{RecorderReply, RecorderRequest, RecorderSetup, RecorderState};
use crate::settings::Settings;

fn ask(line: &mut Line, request: RecorderRequest) -> HostReply {
    line.ask(&HostRequest::Recorder(request))
}

fn state(reply: &HostReply) -> RecorderState {
    match reply {
        HostReply::Recorder(RecorderReply::Report(report)) => report.state,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_recording_is_read_once_it_has_ended() {
    let mut line = Line::identified();
    assert_eq!(
        state(&ask(&mut line, RecorderRequest::Report)),
        RecorderState::Off
    );
    let settings = Settings::table_1().unwrap();
    line.leg.recorder.begin(&RecorderSetup::new(&settings));
    let read = ask(&mut line, RecorderRequest::Read(0));
    assert_eq!(read, refused(HostRefusal::Recording));
    assert_eq!(
        state(&ask(&mut line, RecorderRequest::Stop)),
        RecorderState::Stopped
    );
    let none = HostReply::Recorder(RecorderReply::Triples(heapless::Vec::new()));
    assert_eq!(ask(&mut line, RecorderRequest::Read(0)), none);
    assert_eq!(
        state(&ask(&mut line, RecorderRequest::Restart)),
        RecorderState::Recording
    );
}
