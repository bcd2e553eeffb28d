//! Python with the packages of the tests, in a virtual environment of its own.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use leg_boards::setup::{self, SetupError};
use serde_json::Value;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The packages and their versions.
const REQUIREMENTS: &str = include_str!("../../python/requirements.txt");

/// Why there is no such Python.
#[derive(Debug, thiserror::Error)]
pub enum PythonError {
    /// The environment's directory cannot be written to, or a program there does not start.
    #[error("cannot make a Python environment in {}: {error}; see that the target directory is writable", directory.display())]
    Directory {
        /// The environment's directory.
        directory: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// Python is missing.
    #[error(transparent)]
    NoPython(#[from] SetupError),
    /// The environment or its packages cannot be had.
    #[error("python3 does not install tests/python/requirements.txt: a way to PyPI is needed\n{0}")]
    NoPackages(String),
}

/// The Python of that environment, which is made on first use and when the requirements change.
///
/// # Errors
/// A [`PythonError`] that says what to install.
pub fn python() -> Result<PathBuf, PythonError> {
    let directory = &Path::new(env!("CARGO_TARGET_TMPDIR")).join("python");
    let failed = |error| PythonError::Directory {
        directory: directory.into(),
        error,
    };
    fs::create_dir_all(directory).map_err(failed)?;
    // One test at a time: the lock ends with the file.
    let lock = File::create(directory.join("lock")).map_err(failed)?;
    lock.lock().map_err(failed)?;
    let environment = directory.join("environment");
    let installed = directory.join("installed.txt");
    let python = environment.join("bin/python");
    let ready = fs::read_to_string(&installed).is_ok_and(|text| text == REQUIREMENTS);
    if !(ready && python.is_file()) {
        // An environment that is made only in part is not taken for a whole one.
        fs::write(&installed, "").map_err(failed)?;
        let system_python = setup::ensure_python(&mut |doing| eprintln!("{doing}"))?;
        let venv = ["-m", "venv", "--clear"];
        let made = run(Command::new(system_python).args(venv).arg(&environment));
        made.map_err(failed)?.map_err(PythonError::NoPackages)?;
        let requirements = concat!(env!("CARGO_MANIFEST_DIR"), "/python/requirements.txt");
        let install = [
            "-m",
            "pip",
            "install",
            "--quiet",
            "--requirement",
            requirements,
        ];
        let made = run(Command::new(&python).args(install));
        made.map_err(failed)?.map_err(PythonError::NoPackages)?;
        fs::write(&installed, REQUIREMENTS).map_err(failed)?;
    }
    Ok(python)
}

/// What a script of `tests/python` answers to jobs, both as JSON.
pub fn answers(script: &str, jobs: &[Value]) -> Vec<Value> {
    let python = python().unwrap_or_else(|error| panic!("{error}"));
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("python");
    let mut child = Command::new(python)
        .arg(directory.join(script))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let jobs = serde_json::to_vec(jobs).unwrap();
    child.stdin.take().unwrap().write_all(&jobs).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{script} failed, see above");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Runs a command to its end; one that fails gives what it said.
fn run(command: &mut Command) -> io::Result<Result<(), String>> {
    let output = command.output()?;
    if output.status.success() {
        return Ok(Ok(()));
    }
    let said = [output.stdout, output.stderr].concat();
    Ok(Err(String::from_utf8_lossy(&said).into_owned()))
}
