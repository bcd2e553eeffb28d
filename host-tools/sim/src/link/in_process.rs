//! The firmware's library in the host's own process.

use super::{Link, LinkError, Sequence, greet};
use leg_firmware::frame::{self, Decoder, MAX_FRAME};
use leg_firmware::host_link::BoardKind;
use leg_firmware::settings::Settings;
use leg_firmware_bench::counter::Counter;
use leg_firmware_bench::protocol::{BoardInfo, Reply, Request};
use leg_firmware_bench::server::{self, Server};

/// The firmware's library inside the host's own process, behind the same frames.
#[derive(Debug)]
pub struct InProcess {
    server: Server<ThisProcess>,
    requests: Decoder,
    replies: Decoder,
    sequence: Sequence,
}

impl InProcess {
    /// A link that has been greeted.
    ///
    /// # Errors
    /// [`LinkError`] if the library does not answer itself.
    pub fn open() -> Result<Self, LinkError> {
        let mut link = Self {
            server: Server::new(ThisProcess),
            requests: Decoder::new(),
            replies: Decoder::new(),
            sequence: Sequence::new(),
        };
        greet(&mut link)?;
        Ok(link)
    }
}

impl Link for InProcess {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        let mut sent = [0; MAX_FRAME];
        let mut received = [0; MAX_FRAME];
        for &byte in frame::encode(self.sequence.next(), request, &mut sent)? {
            let Some(request) = self.requests.push(byte) else {
                continue;
            };
            for &byte in self.server.answer(request, &mut received)? {
                if let Some(reply) = self.replies.push(byte) {
                    return self.sequence.accept(&reply?);
                }
            }
        }
        Err(LinkError::UnreadableReply)
    }
}

/// The host's process as a board: it has no clock to check and counts nothing.
#[derive(Debug)]
struct ThisProcess;

impl Counter for ThisProcess {
    fn count<A, B>(&mut self, _kernel: fn(&A, &mut B), _input: &A, _output: &mut B) -> Option<u32> {
        None
    }
}

impl server::Board for ThisProcess {
    fn info(&self) -> BoardInfo {
        BoardInfo {
            board: BoardKind::InProcess,
            boot: None,
        }
    }

    fn save(&mut self, _settings: &Settings) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::{InProcess, Link, LinkError};
    use leg_firmware::host_link::Hello;
    use leg_firmware_bench::protocol::{Refusal, Reply, Request};

    #[test]
    fn each_request_has_its_reply() -> Result<(), LinkError> {
        let mut link = InProcess::open()?;
        for schema in [[1; 8], [2; 8]] {
            let reply = link.ask(&Request::Hello(Hello { schema }))?;
            assert!(matches!(
                reply,
                Reply::Refused(Refusal::SchemaMismatch { .. })
            ));
        }
        Ok(())
    }
}
