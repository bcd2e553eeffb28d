//! `leg monitor`.

mod bar;
#[cfg(not(unix))]
#[path = "monitor/events.rs"]
mod keys;
#[cfg(unix)]
mod keys;
mod screen;
mod udp;
mod view;

#[cfg(test)]
mod tests;

use crate::connection::{LegArgs, Purpose};
use crate::notices::version_text;
use crate::numbers::{monitor_rate_hz, seconds};
use crate::options::Options;
use crate::output::{print, wall_time_s};
use keys::Keys;
use leg_base::failure::Failure;
use leg_host::operator::{Operator, OperatorError};
use screen::draw;
use std::io::IsTerminal;
use std::time::{Duration, Instant};
use udp::Udp;
use view::MonitorView;

/// How often keys are polled.
const KEY_TIME: Duration = Duration::from_millis(50);

/// Shows what the leg reports: on a screen, with --json as lines, or as datagrams. Read-only.
///
/// It may run beside other commands, except on CAN. The screen ends with q.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Sends the lines of JSON as datagrams to a program such as PlotJuggler.
    #[arg(long, value_name = "HOST:PORT")]
    udp: Option<String>,
    /// Reports per second, Hz, 0.1 to 100.
    #[arg(long, value_name = "HZ", value_parser = monitor_rate_hz, default_value = "20")]
    rate: f64,
    /// Ends after so many seconds.
    #[arg(long = "for", value_name = "SECONDS", value_parser = seconds)]
    length: Option<Duration>,
    #[command(flatten)]
    leg: LegArgs,
}

pub(crate) fn run(args: &Args, options: Options) -> Result<(), Failure> {
    let screen = !options.json && std::io::stdout().is_terminal();
    if !(screen || options.json || args.udp.is_some()) {
        return Err(Failure::refused(
            "standard output is no terminal",
            "ask for lines with --json, or for datagrams with --udp",
        ));
    }
    let udp = args.udp.as_deref().map(Udp::open).transpose()?;
    let mut operator = args.leg.open(Purpose::Use, options)?.operator;
    let title = format!(
        "{}, firmware {}",
        operator.name(),
        version_text(operator.identity().version)
    );
    let settings = operator.settings()?;
    let mut monitor = Monitor {
        view: MonitorView::new(&title, &settings),
        udp,
        json: options.json,
        period: Duration::from_secs_f64(1.0 / args.rate),
        length: args.length,
    };
    if screen {
        // Nothing else is written on the screen.
        operator.set_late_watcher(|_| ());
        monitor.run_on_screen(&mut operator)
    } else {
        monitor.watch(&mut operator, |_, _| Ok(true))
    }
}

/// Ctrl-C is how it ends: nothing then, and no failure.
fn unless_ended<T>(result: Result<T, OperatorError>) -> Result<Option<T>, Failure> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(OperatorError::Cancelled) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

struct Monitor {
    view: MonitorView,
    udp: Option<Udp>,
    json: bool,
    period: Duration,
    length: Option<Duration>,
}

impl Monitor {
    /// Reads telemetry, once at least, until `shown` returns false or the time is over. `shown` gets the time and, where there is a new one,
    /// the picture; it is called in between, too.
    fn watch(
        &mut self,
        operator: &mut Operator,
        mut shown: impl FnMut(Duration, Option<&MonitorView>) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        let end = self.length.map(|length| operator.now() + length);
        let mut due = operator.now();
        loop {
            // What a wait was too long is made up for, by one report at the most.
            due = operator.now().max(due + self.period);
            let Some(reply) = unless_ended(operator.telemetry())? else {
                return Ok(());
            };
            let received_s = wall_time_s(operator).unwrap_or(f64::NAN);
            self.view
                .take(&reply.telemetry, received_s, operator.damaged_frames());
            self.send()?;
            if !shown(operator.now(), Some(&self.view))? {
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
            if end.is_some_and(|end| operator.now() >= end) {
                return Ok(());
            }
        }
    }

    /// Prints and sends the line that is asked for.
    fn send(&self) -> Result<(), Failure> {
        if !self.json && self.udp.is_none() {
            return Ok(());
        }
        let Some(line) = self.view.json()? else {
            return Ok(());
        };
        if let Some(udp) = &self.udp {
            udp.send(line.trim_end())?;
        }
        if self.json {
            print(&line)?;
        }
        Ok(())
    }

    fn run_on_screen(&mut self, operator: &mut Operator) -> Result<(), Failure> {
        let mut keys = Keys::open().map_err(|error| no_screen(&error))?;
        let mut terminal = ratatui::try_init().map_err(|error| no_screen(&error))?;
        // An emulated leg does not wait for the clock: without this its time would pass at once.
        let start = (Instant::now(), operator.now());
        let clock = operator.clock_is_emulated().then_some(start);
        let watched = self.watch(operator, |now, view| {
            if let Some((start, start_there)) = clock {
                let ahead = now.saturating_sub(start_there);
                std::thread::sleep(ahead.saturating_sub(start.elapsed()));
            }
            if let Some(view) = view {
                let drawn = terminal.draw(|frame| draw(frame, view));
                drawn.map_err(|error| no_screen(&error))?;
            }
            Ok(!keys.end_wanted())
        });
        // A terminal that has gone needs no restoring.
        let _ = ratatui::try_restore();
        if terminal.show_cursor().is_err() {
            // It would be tried again as it is dropped, and told to a standard error that has gone, too: a panic.
            std::mem::forget(terminal);
        }
        watched
    }
}

fn no_screen(error: &std::io::Error) -> Failure {
    Failure::refused(
        format!("the terminal shows no screen: {error}"),
        "ask for lines with --json",
    )
}
