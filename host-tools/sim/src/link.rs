//! A link to a firmware: requests go one way, replies come back.

mod error;
mod in_process;

pub use error::LinkError;
pub use in_process::InProcess;

use leg_firmware::host_link::Hello;
use leg_firmware_bench::protocol::{BENCH_SCHEMA, BoardInfo, Refusal, Reply, Request, TickRequest};

/// Something that answers requests.
pub trait Link {
    /// Sends a request and waits for its reply.
    ///
    /// The model's own refusals are replies, too: see [`Reply::Refused`].
    ///
    /// # Errors
    /// [`LinkError`] if no reply came that can be trusted.
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError>;

    /// What the leg took in the last tick, where that is not what the request had: a board hears bytes at the rate of its
    /// line, and converts slow sensors seldom.
    fn taken(&mut self) -> Option<TickRequest> {
        None
    }
}

impl<L: Link + ?Sized> Link for &mut L {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        (**self).ask(request)
    }

    fn taken(&mut self) -> Option<TickRequest> {
        (**self).taken()
    }
}

impl<L: Link + ?Sized> Link for Box<L> {
    fn ask(&mut self, request: &Request) -> Result<Reply, LinkError> {
        (**self).ask(request)
    }

    fn taken(&mut self) -> Option<TickRequest> {
        (**self).taken()
    }
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

/// The number of the next request. It is never 0: that is the reply to a request that could not be read.
#[must_use]
pub fn next_sequence(latest: u16) -> u16 {
    latest.checked_add(1).unwrap_or(1)
}

#[cfg(test)]
mod tests {
    use super::{Link, LinkError, greet, next_sequence};
    use leg_firmware_bench::protocol::{Refusal, Reply, Request};

    /// A firmware that gives one reply to everything.
    struct Always(Reply);

    impl Link for Always {
        fn ask(&mut self, _request: &Request) -> Result<Reply, LinkError> {
            Ok(self.0.clone())
        }
    }

    #[test]
    fn a_greeting_that_fails_says_why() {
        let schema = [0xab; 8];
        let other = Reply::Refused(Refusal::SchemaMismatch { schema });
        for (reply, part) in [
            (
                other,
                "another protocol (schema abababababababab, this program ",
            ),
            (Reply::Counted(1), "the firmware's reply cannot be read"),
        ] {
            let error = greet(&mut Always(reply)).err().map(|e| e.to_string());
            let text = error.unwrap_or_default();
            assert!(text.contains(part), "{text}");
            assert!(text.ends_with("from the same sources"), "{text}");
        }
    }

    #[test]
    fn no_request_has_sequence_zero() {
        assert_eq!([0, u16::MAX].map(next_sequence), [1, 1]);
    }
}
