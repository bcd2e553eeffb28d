//! Printing, files and errors, the same for every command.

use leg_base::atomic_file::{self, StagingDirectory};
use leg_base::disk::help_for;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_base::json_object;
use leg_base::paths::relative_path;
use leg_host::operator::Operator;
use leg_host::recording::{self, About};
use leg_rig::ready_rigs::READY_RIGS;
use leg_rig::rig_file::{RigFile, RigText};
use std::error::Error;
use std::ffi::OsStr;
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::SystemTime;

/// Writes to standard output.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let written = io::stdout().lock().write_all(text.as_bytes());
    written.map_err(|error| {
        let reader = "see that the program that reads the output is still there";
        let help = help_for(&error, reader);
        Failure::refused(format!("cannot write to standard output: {error}"), help)
    })
}

/// The rig of a file or of that name, the paper's where none is given; its notes go to standard error.
pub(crate) fn load_rig(path: Option<&Path>) -> Result<RigFile, Failure> {
    let (rig, notes) = RigText::load(path)?.read()?;
    print_notes(&notes);
    Ok(rig)
}

/// The rig of a file or of that name, or, for `all`, every ready rig, with their names.
pub(crate) fn load_rigs(path: &Path) -> Result<Vec<(String, RigFile)>, Failure> {
    let load = |path: &Path| Ok((path.display().to_string(), load_rig(Some(path))?));
    if path == Path::new("all") {
        return READY_RIGS
            .iter()
            .map(|rig| load(rig.name.as_ref()))
            .collect();
    }
    Ok(vec![load(path)?])
}

/// Prints notes on a file on standard error.
pub(crate) fn print_notes(notes: &[String]) {
    for text in notes {
        note(text);
    }
}

/// Prints a note on a recording of that name that did not come to its end.
pub(crate) fn note_unfinished(file: &Path) {
    if let Some(part) = recording::unfinished(file) {
        note(&format!(
            "leg: {} is a recording that has not come to its end; it is left as it is",
            part.display()
        ));
    }
}

/// Prints a line on standard error; nothing is left to say where that cannot be written, as on a terminal that has gone.
pub(crate) fn note(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Writes a file whole or not at all; to standard output where none is named.
pub(crate) fn write(file: Option<&Path>, text: &str) -> Result<(), Failure> {
    let Some(file) = file else {
        return print(text);
    };
    let written = atomic_file::replace(file, |new| std::fs::write(new, text));
    written.map_err(|error: io::Error| {
        let sentence = format!("cannot write {}: {error}", file.display());
        let elsewhere = "name a file in a directory that may be written";
        Failure::refused(sentence, help_for(&error, elsewhere))
    })
}

/// The line that names a chart.
pub(crate) fn chart_line(svg: &Path) -> String {
    format!("Chart: {} (and .png, .pdf)\n", relative_path(svg).display())
}

/// A directory into which something cannot be written; `option` is the one that names it.
pub(crate) fn not_saved(
    what: &str,
    directory: &Path,
    option: &str,
    error: &dyn Display,
) -> Failure {
    let sentence = format!("no {what} in {}: {error}", directory.display());
    Failure::refused(sentence, format!("name another directory with {option}"))
}

/// Lets `work` make files in a directory of its own, then moves all of them or none into `directory`. `before` is done when
/// nothing but the moves is left.
pub(crate) fn save_all<T>(
    what: &str,
    directory: &Path,
    option: &str,
    work: impl FnOnce(&Path) -> Result<T, Box<dyn Error>>,
    before: impl FnOnce() -> Result<(), Failure>,
) -> Result<T, Failure> {
    let refused = |error: &dyn Display| not_saved(what, directory, option, error);
    let staging = StagingDirectory::new(directory).map_err(|error| refused(&error))?;
    let made = work(staging.path()).map_err(|error| refused(&error))?;
    staging.check().map_err(|error| refused(&error))?;
    before()?;
    staging.commit().map_err(|error| refused(&error))?;
    Ok(made)
}

/// Fails, exit code 1, if anything is named as failed.
pub(crate) fn require_none(what: &str, failed: &[String], help: &str) -> Result<(), Failure> {
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::failed(
        format!("{what}: {}", failed.join("; ")),
        help,
    ))
}

/// Prints an error on standard error.
pub(crate) fn print_failure(failure: &Failure, json: bool) {
    if json {
        note(failure_line(failure).trim_end());
    } else {
        note(&failure.render(shows_colours()));
    }
}

/// Whether standard error is a terminal that shows colours, and whose user has not declined them (`NO_COLOR`).
fn shows_colours() -> bool {
    let variable = |name| std::env::var_os(name).unwrap_or_default();
    io::stderr().is_terminal() && wishes_colours(&variable("NO_COLOR"), &variable("TERM"))
}

fn wishes_colours(no_color: &OsStr, term: &OsStr) -> bool {
    no_color.is_empty() && term != "dumb"
}

/// Prints what clap says of the arguments: help on standard output, an error on standard error.
pub(crate) fn usage(error: &clap::Error) -> ExitCode {
    let json = std::env::args_os().any(|argument| argument == "--json");
    if json && error.use_stderr() {
        let text = error.to_string();
        let sentence = text.split("\n\n").next().unwrap_or_default();
        let sentence = sentence.strip_prefix("error: ").unwrap_or(sentence);
        let help = "`leg help` and `leg help COMMAND` print what is accepted";
        print_failure(&Failure::refused(sentence, help), true);
    } else {
        // Nothing is left to say where the message itself cannot be written.
        let _ = error.print();
    }
    ExitCode::from(if error.use_stderr() { 2 } else { 0 })
}

/// An error for machines.
fn failure_line(failure: &Failure) -> String {
    let (message, exit_code) = match failure {
        Failure::Failed(message) => (message, 1),
        Failure::Refused(message) => (message, 2),
    };
    let json = json_object! {
        error: &message.sentence,
        help: &message.help,
        #[serde(flatten)]
        file: message.place.as_ref().map(|place| json_object! { file: &place.file }),
        #[serde(flatten)]
        place: message.position().map(|[line, column]| json_object! { line: line, column: column }),
        exit_code: exit_code,
    };
    // Strings and integers always have a form in JSON.
    to_line(&json).unwrap_or_default()
}

/// The time of the day, s since 1970; none beside a leg whose time is emulated.
pub(crate) fn wall_time_s(operator: &Operator) -> Option<f64> {
    (!operator.clock_is_emulated()).then(now_s)
}

/// The time of the day, s since 1970.
fn now_s() -> f64 {
    let since = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
    since.map_or(0.0, |since| since.as_secs_f64())
}

/// What a recording that begins now is of; its begin is in whole milliseconds, so that it is short in words.
pub(crate) fn about_now(title: &str) -> About {
    About {
        begin_wall_time_s: Some((now_s() * 1e3).floor() / 1e3),
        ..About::log(title)
    }
}

#[cfg(test)]
mod tests {
    use super::{failure_line, wishes_colours};
    use leg_base::failure::{Failure, TextPlace};
    use std::ffi::OsStr;

    #[test]
    fn colours_are_declined_by_name() {
        for (no_color, term, wishes) in [
            ("", "xterm", true),
            ("", "", true),
            ("1", "xterm", false),
            ("", "dumb", false),
        ] {
            let [no_color, term] = [no_color, term].map(OsStr::new);
            assert_eq!(
                wishes_colours(no_color, term),
                wishes,
                "{no_color:?} {term:?}"
            );
        }
    }

    #[test]
    fn an_error_for_machines_has_its_place_and_exit_code() {
        let place = TextPlace {
            file: "a.toml".into(),
            text: "x = 1\nµ = two\n".into(),
            span: 11..14,
        };
        let failure = Failure::refused_at("no number", "write one", place);
        assert_eq!(
            failure_line(&failure),
            "{\"error\":\"no number\",\"help\":\"write one\",\"file\":\"a.toml\",\"line\":2,\"column\":5,\"exit_code\":2}\n"
        );
        assert_eq!(
            failure_line(&Failure::failed("off", "look")),
            "{\"error\":\"off\",\"help\":\"look\",\"exit_code\":1}\n"
        );
    }
}
