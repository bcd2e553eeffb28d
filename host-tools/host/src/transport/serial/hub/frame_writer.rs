//! Frames on their way to a board that may not take them.

use std::io::{self, Write};

/// Writes frames to a port. What the port does not take in time is lost.
#[derive(Debug)]
pub(super) struct FrameWriter<W> {
    port: W,
    /// Whether the board has got a part of a frame, and would take the next for the rest of it.
    unfinished: bool,
}

impl<W: Write> FrameWriter<W> {
    pub(super) const fn new(port: W) -> Self {
        Self {
            port,
            unfinished: false,
        }
    }

    /// Sends a whole frame, or none.
    pub(super) fn send(&mut self, frame: &[u8]) -> io::Result<()> {
        if self.unfinished && self.put(&[0])? == 0 {
            return Ok(());
        }
        let count = self.put(frame)?;
        self.unfinished = count > 0 && count < frame.len();
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
    use super::FrameWriter;
    use std::collections::VecDeque;
    use std::io::{self, ErrorKind, Write};

    /// A port that takes so many bytes each time; it is gone when no more times are given.
    #[derive(Default)]
    struct NarrowPort {
        room: VecDeque<usize>,
        taken: Vec<u8>,
    }

    impl Write for NarrowPort {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            match self.room.pop_front() {
                None => Err(ErrorKind::BrokenPipe.into()),
                Some(0) => Err(ErrorKind::TimedOut.into()),
                Some(room) => self.taken.write(&bytes[..room.min(bytes.len())]),
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_frame_is_sent_whole_or_ended_before_the_next() {
        for (room, expected) in [
            // Not taken in time: lost, and the next is not.
            (&[2, 1, 0, 9][..], &[1, 1, 0, 3, 3, 0][..]),
            (&[2, 0, 0, 9, 9], &[1, 1, 0, 3, 3, 0]),
            // Taken in part: ended by a zero.
            (&[1, 0, 9, 9, 9], &[1, 0, 2, 2, 0, 3, 3, 0]),
        ] {
            let mut writer = FrameWriter::new(NarrowPort::default());
            writer.port.room = room.iter().copied().collect();
            for byte in 1..=3 {
                writer.send(&[byte, byte, 0]).unwrap();
            }
            assert_eq!(writer.port.taken, expected, "{room:?}");
        }
        let gone = FrameWriter::new(NarrowPort::default()).send(&[1, 0]);
        assert_eq!(gone.unwrap_err().kind(), ErrorKind::BrokenPipe);
    }
}
