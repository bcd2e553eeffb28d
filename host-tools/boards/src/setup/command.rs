//! Runs a program to its end and tells a failure with what it wrote.

use super::SetupError;
use std::ffi::OsStr;
use std::path::Path;
use std::process::Command;

/// Runs a program and returns its standard output.
pub fn run(command: &mut Command) -> Result<String, SetupError> {
    let output = command.output().map_err(|source| SetupError::System {
        action: format!("start {}", command.get_program().to_string_lossy()),
        source,
    })?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    Err(SetupError::Failed {
        command: words(command),
        output: String::from_utf8_lossy(&output.stderr).into_owned(),
    })
}

fn words(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let name = program.file_name().unwrap_or(program.as_os_str());
    let words: Vec<_> = std::iter::once(name)
        .chain(command.get_args())
        .map(OsStr::to_string_lossy)
        .collect();
    words.join(" ")
}
