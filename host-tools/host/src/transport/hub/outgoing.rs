//! Frames on their way to a board that may not take them.

use std::io::{self, Write};

/// The way to a board. What the board does not take in time is lost.
#[derive(Debug)]
pub(super) struct Outgoing<W> {
    port: W,
    /// Whether the board has got a part of a frame, and would take the next for the rest of it.
    torn: bool,
}

impl<W: Write> Outgoing<W> {
    pub(super) const fn new(port: W) -> Self {
        Self { port, torn: false }
    }

    /// Sends a whole frame, or none.
    pub(super) fn send(&mut self, frame: &[u8]) -> io::Result<()> {
        if self.torn && self.put(&[0])? == 0 {
            return Ok(());
        }
        let count = self.put(frame)?;
        self.torn = count > 0 && count < frame.len();
        Ok(())
    }

    /// How many of the bytes the port took in time.
    fn put(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut count = 0;
        while let Some(rest @ [_, ..]) = bytes.get(count..) {
            match self.port.write(rest) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(taken) => count += taken,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::TimedOut => break,
                Err(error) => return Err(error),
            }
        }
        Ok(count)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::Outgoing;
    use std::collections::VecDeque;
    use std::io::{self, ErrorKind, Write};

    /// A port that takes so many bytes each time; a time without any is over.
    #[derive(Default)]
    struct Port {
        room: VecDeque<usize>,
        taken: Vec<u8>,
    }

    impl Write for Port {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            match self.room.pop_front() {
                None => Err(ErrorKind::BrokenPipe.into()),
                Some(0) => Err(ErrorKind::TimedOut.into()),
                Some(room) => {
                    let count = room.min(bytes.len());
                    self.taken.extend(&bytes[..count]);
                    Ok(count)
                }
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn sent(room: &[usize], frames: &[&[u8]]) -> Vec<u8> {
        let mut outgoing = Outgoing::new(Port::default());
        outgoing.port.room = room.iter().copied().collect();
        for frame in frames {
            outgoing.send(frame).unwrap();
        }
        outgoing.port.taken
    }

    #[test]
    fn a_frame_that_is_not_taken_is_lost_and_the_next_is_not() {
        let frames: [&[u8]; 3] = [&[1, 1, 0], &[2, 2, 0], &[3, 3, 0]];
        assert_eq!(sent(&[2, 1, 0, 9], &frames), [1, 1, 0, 3, 3, 0]);
    }

    #[test]
    fn a_part_of_a_frame_is_ended_before_the_next() {
        let frames: [&[u8]; 3] = [&[1, 1, 0], &[2, 2, 0], &[3, 3, 0]];
        assert_eq!(sent(&[2, 0, 0, 9, 9], &frames), [1, 1, 0, 3, 3, 0]);
        assert_eq!(sent(&[1, 0, 9, 9, 9], &frames), [1, 0, 2, 2, 0, 3, 3, 0]);
    }

    #[test]
    fn a_port_that_has_gone_is_told() {
        let error = Outgoing::new(Port::default()).send(&[1, 0]).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::BrokenPipe);
    }
}
