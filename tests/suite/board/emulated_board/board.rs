//! An emulated board in the background, and the commands for it.

use crate::common::stalls::{PATIENCE, wait_for};
use leg_host::recording;
use leg_rig::ready_rigs::READY_RIGS;
use serde_json::Value;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Output, Stdio};
use std::time::Duration;
use std::time::Instant;

const LEG: &str = env!("CARGO_BIN_EXE_leg-under-test");

/// For longer a log must not be stalled: what the leg sends meanwhile is late, or lost.
pub const LOG_STALL: Duration = Duration::from_millis(80);

/// A board that waits longer for its host: the machine may have much else to do, and stall single processes for seconds.
pub const PATIENT: &str = "\n[control.limits]\ncommand_time_s = 30\n";

/// A board that holds in the time of a test when its host has died, and not yet when it is stalled.
pub const IMPATIENT: &str = "\n[control.limits]\ncommand_time_s = 6\n";

/// A leg that takes 50 s for a move: some commands, and what they are stalled, have room beside it.
pub const SLOW: &str = "\n[control.motion]\nspeed_rad_per_s = 0.01\n";

/// `leg emulate` in the background.
pub struct BoardUnderTest {
    pub process: Child,
    actions: ChildStdin,
    pub port: String,
}

impl BoardUnderTest {
    pub fn new(arguments: &[&str]) -> Self {
        Self::with_sections(PATIENT, arguments)
    }

    /// A leg that moves slowly.
    pub fn slow() -> Self {
        Self::with_sections(&[PATIENT, SLOW].concat(), &[])
    }

    /// A leg of the default rig with more sections.
    pub fn with_sections(sections: &str, arguments: &[&str]) -> Self {
        let directory = tempfile::tempdir().unwrap();
        let rig = directory.path().join("rig.toml");
        std::fs::write(&rig, [READY_RIGS[0].text, sections].concat()).unwrap();
        let mut process = Command::new(LEG)
            .args(["emulate", "--touch", "--for", "3600", "--rig"])
            .arg(&rig)
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut port = String::new();
        let stdout = process.stdout.take().unwrap();
        BufReader::new(stdout).read_line(&mut port).unwrap();
        Self {
            actions: process.stdin.take().unwrap(),
            process,
            port: port.trim_end().into(),
        }
    }

    /// Begins a move and waits until the leg is on its way.
    pub fn begin_move(&self) -> Child {
        self.wait_until_moving(self.begin(&move_to("29")))
    }

    /// Waits until a move has the leg on its way.
    pub fn wait_until_moving(&self, mut moving: Child) -> Child {
        let begun = Instant::now();
        while self.state()["moving"] != true {
            if begun.elapsed() > PATIENCE || moving.try_wait().unwrap().is_some() {
                let told = errors(&moving.wait_with_output().unwrap());
                panic!("it does not move: {told} {}", self.state());
            }
        }
        moving
    }

    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(LEG);
        command.args(arguments).args(["--port", &self.port]);
        command
    }

    /// Runs a command to its end.
    pub fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// The same, again where a leg that a busy machine keeps from running did not acknowledge it.
    pub fn run_until_acknowledged(&self, arguments: &[&str]) -> Output {
        wait_for("an acknowledgement", || {
            let output = self.run(arguments);
            (!errors(&output).contains("did not acknowledge")).then_some(output)
        })
    }

    /// Runs a command that succeeds; the JSON that it prints.
    pub fn json(&self, arguments: &[&str]) -> Value {
        let output = self.run(&[arguments, &["--json"]].concat());
        assert!(
            output.status.success(),
            "{arguments:?}: {}",
            errors(&output)
        );
        serde_json::from_slice(&output.stdout).unwrap()
    }

    /// Runs a command that fails: its exit code and what it says.
    pub fn refused(&self, arguments: &[&str]) -> (Option<i32>, String) {
        let output = self.run(arguments);
        (output.status.code(), errors(&output))
    }

    pub fn begin(&self, arguments: &[&str]) -> Child {
        let mut command = self.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().unwrap()
    }

    /// The same with its standard output in a file: what it prints may be more than a pipe holds.
    pub fn begin_into(&self, file: &Path, arguments: &[&str]) -> Child {
        let mut command = self.command(arguments);
        command.stdout(File::create(file).unwrap());
        command.stderr(Stdio::piped()).spawn().unwrap()
    }

    /// Waits until a command has opened the port: it passes on what others send then, not they what it sends.
    pub fn wait_for_port(&self, command: &Child) {
        let files = format!("/proc/{}/fd", command.id());
        let has_port = || {
            let mut files = std::fs::read_dir(&files).unwrap().flatten();
            files.any(|file| std::fs::read_link(file.path()).is_ok_and(|to| to == *self.port))
        };
        wait_for("an open port", || has_port().then_some(()));
    }

    /// Begins a log; comes back when the leg sends it telemetry.
    pub fn begin_log(&self, file: &Path, arguments: &[&str]) -> Child {
        let name = file.display().to_string();
        let log = [&["log", "--out", &name, "--for", "3600"], arguments].concat();
        let log = self.begin(&log);
        wait_for("a recording", || recording::unfinished(file));
        // Its line is asked for its first row.
        self.wait(0.2);
        log
    }

    pub fn act(&mut self, line: &str) {
        writeln!(self.actions, "{line}").unwrap();
        // The board looks at least every 10 ms of its own time.
        self.wait(0.1);
    }

    /// Runs a command with what is done by hand at each of its questions, after which the leg's time goes on. The standard
    /// error is what follows the questions.
    pub fn run_by_hand(
        &mut self,
        mut command: Command,
        actions: &[&str],
        leg_time_s: f64,
    ) -> Output {
        command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let mut running = command.spawn().unwrap();
        let mut enter = running.stdin.take().unwrap();
        // A leg that is late is waited for, and is no question.
        let lines = BufReader::new(running.stderr.take().unwrap()).lines();
        let mut questions =
            lines.filter(|line| !line.as_ref().is_ok_and(|line| line.contains("tried again")));
        for action in actions {
            let question = questions.next().unwrap().unwrap();
            assert!(question.ends_with("then press Enter"), "{question}");
            self.act(action);
            self.wait(leg_time_s);
            writeln!(enter).unwrap();
        }
        let stderr: Vec<String> = questions.map_while(Result::ok).collect();
        let output = running.wait_with_output().unwrap();
        Output {
            stderr: stderr.join("\n").into(),
            ..output
        }
    }

    /// Lets the leg's own time go on, which may be slower than the clock.
    pub fn wait(&self, seconds: f64) {
        let time = || self.state()["time_s"].as_f64().unwrap();
        let until = time() + seconds;
        wait_for("the leg's time", || (time() >= until).then_some(()));
    }

    /// Homes nothing, arms nothing: what the leg does now.
    pub fn state(&self) -> Value {
        let output = self.run(&["monitor", "--json", "--for", "0.01"]);
        assert!(output.status.success(), "{}", errors(&output));
        let text = String::from_utf8(output.stdout).unwrap();
        serde_json::from_str(text.lines().next().unwrap()).unwrap()
    }
}

impl Drop for BoardUnderTest {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

pub fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub fn move_to(tilt: &str) -> [&str; 5] {
    ["move", "--azimuth", "40", "--tilt", tilt]
}

pub fn signal(process: &Child, name: &str) {
    let id = process.id().to_string();
    let sent = Command::new("kill").args([name, &id]).status().unwrap();
    assert!(sent.success());
}
