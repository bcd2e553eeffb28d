//! `leg monitor`.

mod udp;

use super::line::{Fresh, LineArgs, RigArgs, version};
use super::numbers::{positive, seconds};
use super::print;
use leg_base::failure::Failure;
use leg_host::monitor::{Picture, draw};
use leg_host::operator::{Operator, OperatorError};
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyModifiers};
use std::io::IsTerminal;
use std::time::{Duration, Instant};
use udp::Udp;

/// How often a key is looked for.
const KEY_TIME: Duration = Duration::from_millis(50);

/// Shows what the leg tells, on the terminal or as lines of JSON.
///
/// It commands nothing, and may run beside other commands; not on CAN.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Prints a line of JSON each time instead of a screen.
    #[arg(long)]
    json: bool,
    /// Sends the same lines to a program such as PlotJuggler.
    #[arg(long, value_name = "HOST:PORT")]
    udp: Option<String>,
    /// How often, Hz.
    #[arg(long, value_name = "HZ", value_parser = rate, default_value = "20")]
    rate: f64,
    /// Ends after so many seconds.
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    length: Option<Duration>,
    #[command(flatten)]
    line: LineArgs,
    #[command(flatten)]
    rig: RigArgs,
}

fn rate(text: &str) -> Result<f64, String> {
    match positive(text)? {
        rate if (0.1..=100.0).contains(&rate) => Ok(rate),
        _ => Err("it is not within 0.1 to 100 Hz".into()),
    }
}

/// Runs the command.
///
/// # Errors
/// A [`Failure`]: no line to the leg, one that breaks, an address that cannot be sent to, or a terminal that fails.
pub(super) fn run(args: &Args, verbose: bool) -> Result<(), Failure> {
    let screen = !args.json && std::io::stdout().is_terminal();
    if !(screen || args.json || args.udp.is_some()) {
        return Err(Failure::refused(
            "standard output is no terminal",
            "ask for lines with --json, or for datagrams with --udp",
        ));
    }
    let udp = args.udp.as_deref().map(Udp::open).transpose()?;
    let rig = args.rig.load()?;
    let mut operator = args.line.open(&rig, Fresh::Homed, verbose)?.operator;
    let title = format!(
        "{}, firmware {}",
        operator.name(),
        version(operator.identity().version)
    );
    let settings = operator.settings()?;
    let mut monitor = Monitor {
        picture: Picture::new(&title, &settings),
        udp,
        json: args.json,
        period: Duration::from_secs_f64(1.0 / args.rate),
        length: args.length,
    };
    if screen {
        monitor.on_screen(&mut operator)
    } else {
        monitor.watch(&mut operator, |_, _| Ok(true))
    }
}

/// Ctrl-C is how it ends: nothing then, and no failure.
fn unless_ended<T>(result: Result<T, OperatorError>) -> Result<Option<T>, Failure> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(OperatorError::Interrupted) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

struct Monitor {
    picture: Picture,
    udp: Option<Udp>,
    json: bool,
    period: Duration,
    length: Option<Duration>,
}

impl Monitor {
    /// Looks at the leg until `shown` has enough of it, or the time is over. `shown` is told the time, gets what is new, and
    /// is asked in between.
    fn watch(
        &mut self,
        operator: &mut Operator,
        mut shown: impl FnMut(Duration, Option<&Picture>) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        let end = self.length.map(|length| operator.now() + length);
        while end.is_none_or(|end| operator.now() < end) {
            let due = operator.now() + self.period;
            let Some(told) = unless_ended(operator.telemetry())? else {
                return Ok(());
            };
            self.picture.take(&told.telemetry, operator.damaged());
            self.tell()?;
            if !shown(operator.now(), Some(&self.picture))? {
                return Ok(());
            }
            while operator.now() < due {
                let left = due.saturating_sub(operator.now());
                if unless_ended(operator.pause(left.min(KEY_TIME)))?.is_none()
                    || !shown(operator.now(), None)?
                {
                    return Ok(());
                }
            }
        }
        Ok(())
    }

    /// Prints and sends the line that is asked for.
    fn tell(&self) -> Result<(), Failure> {
        if !self.json && self.udp.is_none() {
            return Ok(());
        }
        let line = self.picture.json();
        let Some(line) = line.map_err(|error| Failure::from_error(&error))? else {
            return Ok(());
        };
        if let Some(udp) = &self.udp {
            udp.send(&line)?;
        }
        if self.json {
            print(&(line + "\n"))?;
        }
        Ok(())
    }

    fn on_screen(&mut self, operator: &mut Operator) -> Result<(), Failure> {
        let mut terminal = ratatui::try_init().map_err(|error| no_screen(&error))?;
        // An emulated leg waits for nobody: without this it would rush through its time.
        let begun = (Instant::now(), operator.now());
        let clock = operator.clock_is_emulated().then_some(begun);
        let watched = self.watch(operator, |now, picture| {
            if let Some((begun, begun_there)) = clock {
                let ahead = now.saturating_sub(begun_there);
                std::thread::sleep(ahead.saturating_sub(begun.elapsed()));
            }
            if let Some(picture) = picture {
                let drawn = terminal.draw(|frame| draw(frame, picture));
                drawn.map_err(|error| no_screen(&error))?;
            }
            Ok(!end_wanted().map_err(|error| no_screen(&error))?)
        });
        ratatui::restore();
        watched
    }
}

/// Whether the user has seen enough.
fn end_wanted() -> std::io::Result<bool> {
    while event::poll(Duration::ZERO)? {
        if let Event::Key(key) = event::read()?
            && ends(key)
        {
            return Ok(true);
        }
    }
    Ok(false)
}

fn ends(key: KeyEvent) -> bool {
    let control = key.modifiers.contains(KeyModifiers::CONTROL);
    match key.code {
        KeyCode::Char('c') => control,
        KeyCode::Char('q') | KeyCode::Esc => true,
        _ => false,
    }
}

fn no_screen(error: &std::io::Error) -> Failure {
    Failure::refused(
        format!("the terminal shows no screen: {error}"),
        "ask for lines with --json",
    )
}
