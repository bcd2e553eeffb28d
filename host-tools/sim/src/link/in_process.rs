//! The firmware's library in the host's own process.

use super::{Link, LinkError};
use leg_firmware::host_link::{BoardKind, Hello};
use leg_firmware::recorder::Recorder;
use leg_firmware::settings::Settings;
use leg_firmware_bench::counter::InstructionCounter;
use leg_firmware_bench::protocol::{BENCH_SCHEMA, BoardInfo, Reply, Request};
use leg_firmware_bench::server::{BenchBoard, Server};

/// The firmware's library in the host's own process. Requests go to it as they are, without frames.
#[derive(Clone, Debug)]
pub struct InProcess(Server<ThisProcess, Box<Recorder>>);

impl InProcess {
    /// A link that has been greeted.
    #[must_use]
    pub fn new() -> Self {
        let mut server = Server::new(ThisProcess, Box::default());
        let schema = BENCH_SCHEMA;
        server.handle(&Request::Hello(Hello { schema }));
        Self(server)
    }
}

impl Default for InProcess {
    fn default() -> Self {
        Self::new()
    }
}

impl Link for InProcess {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        Ok(self.0.handle(request))
    }
}

/// The host's process as a board: it has no clock to check, counts nothing, and keeps no settings over a reset because
/// it has none.
#[derive(Clone, Debug)]
struct ThisProcess;

impl InstructionCounter for ThisProcess {
    fn count<A, B>(&mut self, _kernel: fn(&A, &mut B), _input: &A, _output: &mut B) -> Option<u32> {
        None
    }
}

impl BenchBoard for ThisProcess {
    fn info(&self) -> BoardInfo {
        BoardInfo {
            board: BoardKind::InProcess,
            boot: None,
        }
    }

    fn save(&mut self, _settings: &Settings) -> bool {
        true
    }
}
