//! Writing the firmware into a board by [probe-rs](https://probe.rs), and its log.

mod failures;

use crate::cancel_flag::CancelFlag;
use failures::{failed, not_started, output_failure, output_text};
use leg_base::failure::Failure;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The chip as probe-rs calls it.
pub const CHIP: &str = "STM32G474RETx";

/// Variable that names the program in the place of `probe-rs`.
pub const PROGRAM_VARIABLE: &str = "LEG_PROBE_RS";

/// The chip's DBGMCU_IDCODE register, and its device number for an STM32G471/473/474/483/484 (RM0440).
const ID_REGISTER: &str = "0xE0042000";
const ID_BITS: u32 = 0xfff;
const ID: u32 = 0x469;

/// The FLASH_OPTR register of the option bytes: its read-out protection, what that is at level 0, and DBANK (RM0440).
const OPTION_REGISTER: &str = "0x40022020";
const PROTECTION_BITS: u32 = 0xff;
const UNPROTECTED: u32 = 0xaa;
const TWO_BANKS: u32 = 1 << 22;

/// A debugger that probe-rs can use.
#[derive(Clone, Debug)]
pub struct Probe {
    program: PathBuf,
    selector: Option<String>,
}

impl Probe {
    /// Finds the program. `selector` is probe-rs's for one of several debuggers: `VID:PID:Serial`.
    ///
    /// # Errors
    /// Refused (exit code 2) if there is no such program.
    pub fn find(selector: Option<String>) -> Result<Self, Failure> {
        let named = std::env::var_os(PROGRAM_VARIABLE);
        let name = named.as_deref().unwrap_or(OsStr::new("probe-rs"));
        match which::which(name) {
            Ok(program) => Ok(Self { program, selector }),
            Err(_) => Err(Failure::refused(
                format!(
                    "there is no program `{}`, which writes the firmware into the board",
                    name.display()
                ),
                format!(
                    "install it: `cargo install probe-rs-tools --locked`, or name it in {PROGRAM_VARIABLE}"
                ),
            )),
        }
    }

    /// Refuses another chip than the board's, and one whose option bytes do not let the firmware be written or keep its
    /// settings.
    ///
    /// # Errors
    /// Refused (exit code 2): another chip, protected or with one bank, and a chip that probe-rs cannot read.
    pub fn check_chip(&self) -> Result<(), Failure> {
        let id = self.register(ID_REGISTER)? & ID_BITS;
        if id != ID {
            return Err(Failure::refused(
                format!("the chip is no STM32G474: its device number is {id:#05x}, not 0x469"),
                "use a NUCLEO-G474RE; the image fits no other chip",
            ));
        }
        let options = self.register(OPTION_REGISTER)?;
        if options & PROTECTION_BITS != UNPROTECTED {
            return Err(Failure::refused(
                "the chip is protected against reading",
                "lift the protection with STM32CubeProgrammer (RDP level 0), which erases the chip",
            ));
        }
        if options & TWO_BANKS == 0 {
            // The settings have to be in the second bank.
            return Err(Failure::refused(
                "the chip's flash is set to a single bank",
                "set its option byte DBANK with STM32CubeProgrammer, as it is from the factory",
            ));
        }
        Ok(())
    }

    fn register(&self, address: &str) -> Result<u32, Failure> {
        let read = self.run("read", &["b32", address, "1"])?;
        let text = String::from_utf8_lossy(&read.stdout);
        let word = text.split_whitespace().last().unwrap_or_default();
        let digits = word.trim_start_matches("0x");
        u32::from_str_radix(digits, 16).map_err(|_| failed(&output_text(&read)))
    }

    /// Writes an image, reads it back and compares.
    ///
    /// # Errors
    /// Fails (exit code 1) if the flash does not hold what was written; all else that probe-rs reports is refused (exit code 2).
    pub fn download(&self, image: &Path) -> Result<(), Failure> {
        let image = image.to_string_lossy();
        self.run("download", &["--disable-progressbars", "--verify", &image])
            .map(drop)
    }

    /// Starts the firmware anew.
    pub fn reset(&self) -> Result<(), Failure> {
        self.run("reset", &[]).map(drop)
    }

    /// Shows the firmware's log until the user ends it by Ctrl-C, which sets `cancel` and reaches probe-rs, too.
    ///
    /// # Errors
    /// Refused (exit code 2) if probe-rs cannot be started or ends with an error before Ctrl-C.
    pub fn attach(&self, image: &Path, cancel: &CancelFlag) -> Result<(), Failure> {
        let status = self.command("attach").arg(image).status();
        match status.map_err(not_started)? {
            status if status.success() || cancel.is_set() => Ok(()),
            status => Err(failed(&format!("it ended with {status}"))),
        }
    }

    fn command(&self, subcommand: &str) -> Command {
        let mut command = Command::new(&self.program);
        command.args([subcommand, "--non-interactive", "--chip", CHIP]);
        if let Some(selector) = &self.selector {
            command.args(["--probe", selector]);
        }
        command
    }

    fn run(&self, subcommand: &str, arguments: &[&str]) -> Result<Output, Failure> {
        let output = self
            .command(subcommand)
            .args(arguments)
            .stdin(Stdio::null())
            .output()
            .map_err(not_started)?;
        if output.status.success() {
            Ok(output)
        } else {
            Err(output_failure(&output))
        }
    }
}
