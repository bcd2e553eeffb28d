//! The commands that make a leg do something: home, move, stiffness, hold, stop, disarm, clear.

mod path_file;

use crate::connection::{LegArgs, Purpose};
use crate::numbers::{azimuth_deg, direction, lead_s, positive, tilt_deg, unit_vector};
use crate::options::Options;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_host::leg_report;
use leg_host::operator::{Goal, Operator, OperatorError, Tensioning};
use leg_host::path_reader::{PathReader, PathSource};
use path_file::PathFile;
use std::io::{self, BufReader};
use std::path::PathBuf;
use std::time::Duration;

#[derive(Debug, clap::Subcommand)]
pub(crate) enum LegCommand {
    /// Clears the faults whose cause is gone.
    ///
    /// A leg in hold that knows its zero stays in hold. One that does not, as after a stop of its homing, pays its tendons out and is
    /// disarmed: keep your hands away. One that keeps station goes on; one whose drivers a fault switched off is disarmed then.
    Clear(LegArgs),
    /// Leads the leg straight down, pays its tendons out and switches the drivers off; the screws hold.
    ///
    /// A leg whose sensors disagree, or that has a fault, is paid out where it is: after "no command" clear it first.
    Disarm(LegArgs),
    /// Follows a path in time, streamed as set-points; the leg keeps station then.
    ///
    /// The leg goes to where it rests before the path, follows it from there within the limits of speed, acceleration and jerk,
    /// and comes to rest after it. A column `pretension_n` or `stiffness_nm_per_rad` changes the pretension on the way. A file is checked
    /// before the leg moves. A leg that is homed and disarmed is armed first.
    Follow(FollowArgs),
    /// Holds the leg where it is, on its screws.
    ///
    /// A leg that is homed and disarmed is armed first.
    Hold(LegArgs),
    /// Finds the zero of the tendons and leaves the leg in hold, straight down.
    ///
    /// The leg must hang free, without a payload. A leg in hold, or one that keeps station, is disarmed first.
    Home(LegArgs),
    /// Moves the leg to a pose, where it keeps station.
    ///
    /// A leg that is homed and disarmed is armed first; a hold without a fault ends.
    Move(MoveArgs),
    /// Changes the bending stiffness of the leg where it is, and lets it keep station.
    Stiffness(StiffnessArgs),
    /// Stops the leg, for any host, and leaves it in hold.
    ///
    /// A leg that is disarmed or off stays so, one that jogs is disarmed; a leg that ramps down goes on paying its tendons out until it is
    /// disarmed: only the emergency stop ends this.
    ///
    /// The stop is repeated until the leg acknowledges it, and works beside another command that drives the leg, on CAN too.
    Stop(LegArgs),
}

#[derive(Debug, clap::Args)]
pub(crate) struct FollowArgs {
    /// The path: a CSV file with the columns time_s, azimuth_deg and tilt_deg, and pretension_n or stiffness_nm_per_rad where that
    /// shall change; or - for standard input.
    #[arg(value_name = "FILE")]
    path: PathBuf,
    /// The time from the rest before the path to its first point, beside the run-up, s, up to 3600: how long a point may be on its
    /// way to the leg. A point is sent when the third row after it is known.
    #[arg(long = "lead", value_name = "SECONDS", value_parser = lead_s, default_value = "0.2")]
    lead: Duration,
    #[command(flatten)]
    leg: LegArgs,
}

#[derive(Debug, clap::Args)]
pub(crate) struct MoveArgs {
    /// The azimuth towards which the leg leans, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg)]
    azimuth: f64,
    /// The tilt from the vertical, degrees; a negative tilt is the opposite azimuth.
    #[arg(long, value_name = "DEG", value_parser = tilt_deg)]
    tilt: f64,
    /// The pretension, N; as before if left out.
    #[arg(long, alias = "level", value_name = "N", value_parser = positive, conflicts_with = "stiffness")]
    pretension: Option<f64>,
    /// The bending stiffness, N·m/rad, in the place of a pretension: of the softest tilt, unless --towards is given.
    #[arg(long, value_name = "NM_PER_RAD", value_parser = positive)]
    stiffness: Option<f64>,
    /// The azimuth of a push at the tip that meets the stiffness, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg, requires = "stiffness")]
    towards: Option<f64>,
    #[command(flatten)]
    leg: LegArgs,
}

#[derive(Debug, clap::Args)]
pub(crate) struct StiffnessArgs {
    /// The bending stiffness, N·m/rad: of the softest tilt, unless --towards is given.
    #[arg(value_name = "NM_PER_RAD", value_parser = positive)]
    stiffness: f64,
    /// The azimuth of a push at the tip that meets the stiffness, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg)]
    towards: Option<f64>,
    #[command(flatten)]
    leg: LegArgs,
}

impl LegCommand {
    pub(crate) fn run(&self, options: Options) -> Result<(), Failure> {
        let reach = |leg: &LegArgs, goal: Goal| {
            run(leg, Purpose::Use, options, |operator| operator.reach(&goal))
        };
        match self {
            Self::Clear(leg) => run(leg, Purpose::Use, options, Operator::clear),
            Self::Disarm(leg) => run(leg, Purpose::Use, options, Operator::disarm),
            Self::Follow(args) => args.run(options),
            Self::Hold(leg) => reach(leg, Goal::default()),
            Self::Home(leg) => home(leg, options),
            Self::Move(args) => reach(&args.leg, args.goal()),
            Self::Stiffness(args) => reach(&args.leg, args.goal()),
            Self::Stop(leg) => run(leg, Purpose::Stop, options, Operator::stop_to_rest),
        }
    }
}

impl FollowArgs {
    fn run(&self, options: Options) -> Result<(), Failure> {
        if self.path.as_os_str() == "-" {
            let reader = PathReader::new(BufReader::new(io::stdin()), "standard input");
            let mut source = PathSource::live(reader);
            return run(&self.leg, Purpose::Use, options, |operator| {
                operator.follow(&mut source, self.lead)
            });
        }
        let file = PathFile::read(&self.path)?;
        run(&self.leg, Purpose::Use, options, |operator| {
            let followed = operator.follow_whole(file.path(), self.lead);
            followed.map_err(|error| file.placed(error))
        })
    }
}

impl MoveArgs {
    fn goal(&self) -> Goal {
        let pretension = self.pretension.map(|n| Tensioning::Pretension(n as f32));
        let stiffness = self.stiffness.map(|demand| stiffness(demand, self.towards));
        Goal {
            tensioning: pretension.or(stiffness),
            direction: Some(direction(self.azimuth, self.tilt)),
        }
    }
}

impl StiffnessArgs {
    fn goal(&self) -> Goal {
        Goal {
            tensioning: Some(stiffness(self.stiffness, self.towards)),
            direction: None,
        }
    }
}

fn stiffness(nm_per_rad: f64, towards_deg: Option<f64>) -> Tensioning {
    Tensioning::Stiffness {
        demand_nm_per_rad: nm_per_rad as f32,
        towards: towards_deg.map(unit_vector),
    }
}

/// Does `work` and reports what the leg does in the end.
fn run<T>(
    leg: &LegArgs,
    purpose: Purpose,
    options: Options,
    work: impl FnOnce(&mut Operator) -> Result<T, OperatorError>,
) -> Result<(), Failure> {
    let telemetry = leg.open(purpose, options)?.watched(work)?;
    options.report(&leg_report::json(&telemetry), || {
        leg_report::text(&telemetry)
    })
}

/// What tendons of another make are to be told of, as a line.
fn stretch_line(factor: f32) -> String {
    if factor == 1.0 {
        return String::new();
    }
    format!(
        "tendons    stretch {factor:.2} times as much as the settings say; see that no payload hung on the leg while it homed, that the load cells are calibrated, and measure it with `leg tune`\n"
    )
}

/// `leg home`, and `leg calibrate zero`.
pub(crate) fn home(leg: &LegArgs, options: Options) -> Result<(), Failure> {
    let connection = leg.open(Purpose::Calibrate, options)?;
    let telemetry = connection.watched(Operator::home)?;
    let json = json_object! {
        #[serde(flatten)]
        leg: leg_report::json(&telemetry),
        unstretched_at_zero_m: telemetry.unstretched_at_zero_m,
        elongation_factor: telemetry.elongation_factor,
    };
    options.report(&json, || {
        let [a, b, c] = telemetry.unstretched_at_zero_m.map(|m| m * 1000.0);
        format!(
            "{}zero       {a:.3}  {b:.3}  {c:.3} mm of tendon when the board started\n{}",
            leg_report::text(&telemetry),
            stretch_line(telemetry.elongation_factor)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::stretch_line;

    /// The line stands there where the tendons were found to stretch otherwise, and not where not.
    #[test]
    fn tendons_of_another_make_are_told_of() {
        assert_eq!(stretch_line(1.0), "");
        for (factor, words) in [
            (1.06, "tendons    stretch 1.06 times"),
            (0.8, "tendons    stretch 0.80 times"),
        ] {
            assert!(stretch_line(factor).starts_with(words), "{factor}");
        }
    }
}
