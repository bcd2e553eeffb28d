//! The commands that make a leg do something: home, move, stiffness, hold, stop, disarm, clear.

use crate::connection::{LegArgs, Purpose};
use crate::numbers::{azimuth_deg, direction, positive, tilt_deg, unit_vector};
use crate::options::Options;
use leg_base::failure::Failure;
use leg_base::json_object;
use leg_host::leg_report;
use leg_host::operator::{Goal, Operator, OperatorError, Tensioning};

#[derive(Debug, clap::Subcommand)]
pub(crate) enum LegCommand {
    /// Clears the faults whose cause is gone.
    ///
    /// A leg in hold stays in hold; one whose drivers a fault switched off is then disarmed.
    Clear(LegArgs),
    /// Leads the leg straight down, pays its tendons out and switches the drivers off; the screws hold.
    Disarm(LegArgs),
    /// Holds the leg where it is, on its screws.
    ///
    /// A leg that is homed and disarmed is armed first.
    Hold(LegArgs),
    /// Finds the zero of the tendons and leaves the leg in hold, straight down.
    ///
    /// The leg must hang free, without a payload. A leg in hold is disarmed first.
    Home(LegArgs),
    /// Moves the leg to a pose and leaves it in hold.
    ///
    /// A leg that is homed and disarmed is armed first; a hold without a fault ends.
    Move(MoveArgs),
    /// Changes the bending stiffness of the leg where it is, and leaves it in hold.
    Stiffness(StiffnessArgs),
    /// Stops the leg, whatever else is going on, and leaves it in hold.
    ///
    /// The stop is repeated until the leg acknowledges it, and works beside another command that drives the leg, on CAN too.
    Stop(LegArgs),
}

#[derive(Debug, clap::Args)]
pub(crate) struct MoveArgs {
    /// The azimuth towards which the leg leans, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg, allow_negative_numbers = true)]
    azimuth: f64,
    /// The tilt from the vertical, degrees; a negative tilt is the opposite azimuth.
    #[arg(long, value_name = "DEG", value_parser = tilt_deg, allow_negative_numbers = true)]
    tilt: f64,
    /// The pretension, N; as before if left out.
    #[arg(long, alias = "level", value_name = "N", value_parser = positive, allow_negative_numbers = true, conflicts_with = "stiffness")]
    pretension: Option<f64>,
    /// The bending stiffness, N·m/rad, in the place of a pretension: of the softest tilt, unless --towards is given.
    #[arg(long, value_name = "NM_PER_RAD", value_parser = positive, allow_negative_numbers = true)]
    stiffness: Option<f64>,
    /// The azimuth of a push at the tip that meets the stiffness, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg, allow_negative_numbers = true, requires = "stiffness")]
    towards: Option<f64>,
    #[command(flatten)]
    leg: LegArgs,
}

#[derive(Debug, clap::Args)]
pub(crate) struct StiffnessArgs {
    /// The bending stiffness, N·m/rad: of the softest tilt, unless --towards is given.
    #[arg(value_name = "NM_PER_RAD", value_parser = positive, allow_negative_numbers = true)]
    stiffness: f64,
    /// The azimuth of a push at the tip that meets the stiffness, degrees.
    #[arg(long, value_name = "DEG", value_parser = azimuth_deg, allow_negative_numbers = true)]
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
            Self::Hold(leg) => reach(leg, Goal::default()),
            Self::Home(leg) => home(leg, options),
            Self::Move(args) => reach(&args.leg, args.goal()),
            Self::Stiffness(args) => reach(&args.leg, args.goal()),
            Self::Stop(leg) => run(leg, Purpose::Stop, options, Operator::stop),
        }
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

/// `leg home`, and `leg calibrate zero`.
pub(crate) fn home(leg: &LegArgs, options: Options) -> Result<(), Failure> {
    let connection = leg.open(Purpose::Calibrate, options)?;
    let telemetry = connection.watched(Operator::home)?;
    let json = json_object! {
        #[serde(flatten)]
        leg: leg_report::json(&telemetry),
        unstretched_at_zero_m: telemetry.unstretched_at_zero_m,
    };
    options.report(&json, || {
        let [a, b, c] = telemetry.unstretched_at_zero_m.map(|m| m * 1000.0);
        format!(
            "{}zero       {a:.3}  {b:.3}  {c:.3} mm of tendon when the board started\n",
            leg_report::text(&telemetry)
        )
    })
}
