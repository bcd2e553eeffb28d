//! What QEMU and the firmware write: defmt frames on standard output, plain lines on standard error.

use defmt_decoder::{DecodeError, StreamDecoder, Table};
use leg_sim::link::LinkError;
use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

/// Lines that are kept for an error's message.
const KEPT_LINES: usize = 20;

/// The last lines, and the threads that collect them.
#[derive(Debug)]
pub struct Log {
    lines: KeptLines,
    readers: Vec<JoinHandle<()>>,
}

impl Log {
    /// Collects what comes from the two streams until they end.
    pub fn collect(
        table: Table,
        stdout: impl Read + Send + 'static,
        stderr: impl Read + Send + 'static,
        verbose: bool,
    ) -> Self {
        let lines = KeptLines {
            kept: Arc::default(),
            verbose,
        };
        let (decoded, plain) = (lines.clone(), lines.clone());
        let readers = vec![
            thread::spawn(move || decode(&table, stdout, &decoded)),
            thread::spawn(move || copy(stderr, &plain)),
        ];
        Self { lines, readers }
    }

    /// The last lines up to now.
    pub fn last_lines(&self) -> Vec<String> {
        self.lines.snapshot()
    }

    /// The last lines of all; waits for the streams' end, so the process must have ended.
    pub fn finish(&mut self) -> Vec<String> {
        for reader in self.readers.drain(..) {
            if reader.join().is_err() {
                self.lines
                    .push("(the log could not be decoded further)".to_owned());
            }
        }
        self.lines.snapshot()
    }
}

/// Reads the table of log messages from the image.
pub fn table(image: &Path) -> Result<Table, LinkError> {
    let path = image.display().to_string();
    let unreadable = |reason: String| LinkError::ImageUnreadable {
        path: path.clone(),
        reason,
    };
    if !image.is_file() {
        return Err(LinkError::ImageMissing(path));
    }
    let elf = std::fs::read(image).map_err(|error| unreadable(error.to_string()))?;
    Table::parse(&elf)
        .map_err(|error| unreadable(error.to_string()))?
        .ok_or_else(|| unreadable("it has no log table".to_owned()))
}

#[derive(Clone, Debug)]
struct KeptLines {
    kept: Arc<Mutex<VecDeque<String>>>,
    verbose: bool,
}

impl KeptLines {
    fn push(&self, line: String) {
        if self.verbose {
            eprintln!("firmware: {line}");
        }
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() == KEPT_LINES {
            kept.pop_front();
        }
        kept.push_back(line);
    }

    fn snapshot(&self) -> Vec<String> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().cloned().collect()
    }
}

fn decode(table: &Table, mut stream: impl Read, lines: &KeptLines) {
    let mut decoder = table.new_stream_decoder();
    let mut bytes = [0; 1024];
    while let Ok(length @ 1..) = stream.read(&mut bytes) {
        decoder.received(bytes.get(..length).unwrap_or_default());
        decode_received(decoder.as_mut(), lines);
    }
}

fn decode_received(decoder: &mut dyn StreamDecoder, lines: &KeptLines) {
    loop {
        match decoder.decode() {
            Ok(frame) => lines.push(frame.display(false).to_string()),
            Err(DecodeError::UnexpectedEof) => return,
            Err(DecodeError::Malformed) => lines.push("(a log frame was damaged)".to_owned()),
        }
    }
}

fn copy(stream: impl Read, lines: &KeptLines) {
    for line in BufReader::new(stream).split(b'\n').map_while(Result::ok) {
        lines.push(String::from_utf8_lossy(&line).into_owned());
    }
}
