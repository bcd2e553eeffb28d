//! A link to a firmware: requests go one way, replies come back.

mod error;
mod in_process;

pub use error::LinkError;
pub use in_process::InProcess;

use leg_firmware::frame;
use leg_firmware::host_link::Hello;
use leg_firmware_bench::protocol::{BENCH_SCHEMA, BoardInfo, Refusal, Reply, Request};

/// Something that answers requests.
pub trait Link {
    /// Sends a request and waits for its reply.
    ///
    /// The model's own refusals are replies, too: see [`Reply::Refused`].
    ///
    /// # Errors
    /// [`LinkError`] if no reply came that can be trusted.
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError>;
}

/// Introduces the host on a new link and returns what answers.
///
/// # Errors
/// [`LinkError::SchemaMismatch`] if the other side was built from other sources.
pub fn greet(link: &mut impl Link) -> Result<BoardInfo, LinkError> {
    match link.ask(&Request::Hello(Hello {
        schema: BENCH_SCHEMA,
    }))? {
        Reply::Hello(info) => Ok(info),
        Reply::Refused(Refusal::SchemaMismatch { schema }) => Err(LinkError::SchemaMismatch {
            host: BENCH_SCHEMA,
            firmware: schema,
        }),
        _ => Err(LinkError::UnreadableReply),
    }
}

/// Numbers the requests and checks the replies: what every link has in common.
#[derive(Debug)]
pub struct Sequence(u16);

impl Sequence {
    /// No request yet.
    pub const fn new() -> Self {
        Self(0)
    }

    /// The next request's number. It is never 0: that is the reply to a request that could not be read.
    pub fn next(&mut self) -> u16 {
        self.0 = self.0.checked_add(1).unwrap_or(1);
        self.0
    }

    /// The message of a reply to the latest request.
    pub fn accept(&self, frame: &frame::Frame<'_>) -> Result<Reply, LinkError> {
        let reply = frame.message().ok_or(LinkError::UnreadableReply)?;
        match reply {
            Reply::Refused(Refusal::BadFrame(error)) => Err(LinkError::RequestDamaged(error)),
            _ if frame.sequence == self.0 => Ok(reply),
            _ => Err(LinkError::OutOfStep {
                sent: self.0,
                received: frame.sequence,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Link, LinkError, Sequence, greet};
    use leg_firmware_bench::protocol::{Refusal, Reply, Request};

    /// A firmware that gives one reply to everything.
    struct Always(Reply);

    impl Link for Always {
        fn ask(&mut self, _request: &Request) -> Result<Reply, LinkError> {
            Ok(self.0.clone())
        }
    }

    fn greeting_error(reply: Reply) -> Option<String> {
        greet(&mut Always(reply))
            .err()
            .map(|error| error.to_string())
    }

    #[test]
    fn another_schema_is_told_in_words() {
        let text = greeting_error(Reply::Refused(Refusal::SchemaMismatch {
            schema: [0xab; 8],
        }))
        .unwrap_or_default();
        assert!(
            text.starts_with(
                "the firmware speaks another protocol (schema abababababababab, this program "
            ),
            "{text}"
        );
        assert!(
            text.ends_with("; build and start both from the same sources"),
            "{text}"
        );
    }

    #[test]
    fn an_answer_that_is_no_greeting_is_refused() {
        assert_eq!(
            greeting_error(Reply::Counted(1)).as_deref(),
            Some(
                "the firmware's reply cannot be read; build and start both sides from the same sources"
            )
        );
    }

    #[test]
    fn no_request_has_sequence_zero() {
        let mut sequence = Sequence(u16::MAX);
        assert_eq!(sequence.next(), 1);
    }
}
