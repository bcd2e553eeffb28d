//! Instructions of the model's kernels on the emulated core, against their budgets.

mod budget;
mod tick;

pub use budget::{InstructionBudget, kernel_budget};

use leg_firmware_bench::kernels::{Kernel, KernelInput};
use leg_firmware_bench::protocol::{KernelRequest, Refusal, Reply, Request};
use leg_model::RigParameters;
use leg_sim::link::{Link, LinkError};
use serde::Serialize;

const AZIMUTHS_DEG: [f32; 8] = [0.0, 15.0, 60.0, 100.0, 145.0, 200.0, 250.0, 310.0];
const TILTS_DEG: [f32; 7] = [0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0];
const PAYLOADS_KG: [f32; 2] = [0.0, 2.0];

/// How far off the pose forward kinematics starts: as in the reference programs.
const START_OFF_DEG: f32 = 2.0;

/// Poses at which each kernel is counted.
pub const POSES: usize = AZIMUTHS_DEG.len() * TILTS_DEG.len() * PAYLOADS_KG.len();

/// Why there are no counts.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// A kernel has no result at a pose of the workspace.
    #[error("{kernel} refuses a pose of the workspace: {1}; this is a fault in the model", kernel = .0.name())]
    Model(Kernel, leg_model::Error),
    /// The link counts no instructions.
    #[error(
        "this firmware cannot count instructions; count on an emulated board whose clock is made for it"
    )]
    NoCounter,
    /// The firmware answered something else.
    #[error("the firmware's reply is no count; build host and firmware from the same sources")]
    WrongReply,
    /// The simulation of which each tick is counted failed.
    #[error("the ticks cannot be counted: {0}")]
    Tick(String),
    /// The link failed.
    #[error(transparent)]
    Link(#[from] LinkError),
}

/// Instructions of one kernel over all poses.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Its name.
    pub kernel: String,
    /// Fewest instructions.
    pub minimum: u32,
    /// As many poses take fewer as take more.
    pub median: u32,
    /// Most instructions.
    pub maximum: u32,
    /// What it may take.
    pub budget: InstructionBudget,
    /// Whether it stays within that.
    pub passed: bool,
}

/// Counts every kernel at every pose on the paper's rig, and every tick of a scenario on every ready rig. Calls `done`
/// after each kernel and each scenario.
///
/// # Errors
/// The first count that cannot be had.
pub fn measure(link: &mut dyn Link, mut done: impl FnMut()) -> Result<Vec<Cost>, CostError> {
    let mut costs = Vec::new();
    for kernel in Kernel::ALL {
        let counts = inputs().map(|input| count(link, KernelRequest { kernel, input }));
        let counts = counts.collect::<Result<_, _>>()?;
        let budget = kernel_budget(kernel);
        costs.push(Cost::from_counts(kernel.name(), counts, budget));
        done();
    }
    for counted in tick::counted() {
        costs.push(tick::measure(link, &counted)?);
        done();
    }
    Ok(costs)
}

/// How often [`measure`] calls `done`.
#[must_use]
pub const fn measurements() -> usize {
    Kernel::ALL.len() + tick::COUNTED
}

impl Cost {
    fn from_counts(name: &str, mut counts: Vec<u32>, budget: InstructionBudget) -> Self {
        counts.sort_unstable();
        let count = |i: usize| counts.get(i).copied().unwrap_or(0);
        let (minimum, maximum) = (count(0), count(counts.len().saturating_sub(1)));
        Self {
            kernel: name.into(),
            minimum,
            median: count(counts.len() / 2),
            maximum,
            budget,
            passed: budget.passes(minimum, maximum),
        }
    }
}

fn count(link: &mut dyn Link, request: KernelRequest) -> Result<u32, CostError> {
    let kernel = request.kernel;
    match link.ask(&Request::Count(request))? {
        Reply::Counted(count) => Ok(count),
        Reply::Refused(Refusal::Model(error)) => Err(CostError::Model(kernel, error)),
        Reply::Refused(Refusal::NoCounter) => Err(CostError::NoCounter),
        _ => Err(CostError::WrongReply),
    }
}

fn inputs() -> impl Iterator<Item = KernelInput> {
    PAYLOADS_KG.into_iter().flat_map(|payload_kg| {
        TILTS_DEG.into_iter().flat_map(move |tilt_deg| {
            AZIMUTHS_DEG
                .into_iter()
                .map(move |azimuth_deg| input(azimuth_deg, tilt_deg, payload_kg))
        })
    })
}

fn input(azimuth_deg: f32, tilt_deg: f32, payload_kg: f32) -> KernelInput {
    KernelInput {
        rig: RigParameters::<f32, 3>::TABLE_1,
        azimuth_rad: azimuth_deg.to_radians(),
        tilt_rad: tilt_deg.to_radians(),
        start_azimuth_rad: azimuth_deg.to_radians(),
        start_tilt_rad: (tilt_deg + START_OFF_DEG).to_radians(),
        length_errors_m: [0.0; 3],
        payload_kg,
        pretension_n: 70.0,
        f_min_n: 8.0,
        f_max_n: 150.0,
        stiffness_n_per_m: 99_450.0,
        demand_nm_per_rad: 100.0,
    }
}
