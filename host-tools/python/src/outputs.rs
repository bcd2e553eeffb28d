//! What an evaluation gives of a pose: the names and shapes of `leg eval`.

use leg_model::{Error, Evaluation, MapEvaluation};

/// The whole model at a pose.
pub struct Whole {
    /// All but the nonlinear deviation.
    pub found: Evaluation<f64>,
    /// The nonlinear deviation, m, if it was asked for and has a meaning.
    pub deviation_nonlinear_m: Option<f64>,
}

/// An output: a number, a vector or a matrix of each pose.
pub struct Output {
    /// Its name.
    pub name: &'static str,
    /// Its shape for one pose.
    pub shape: &'static [usize],
    /// Of the whole model.
    pub whole: fn(&Whole, &mut [f64]),
    /// Of what a map shows, to the last bit, at a fraction of the cost; none if that has it not.
    pub map: Option<MapOutput>,
}

/// An output of what a map shows.
type MapOutput = fn(&MapEvaluation<f64>, &mut [f64]) -> Result<(), Error>;

/// The output that is true or false.
pub const FEASIBLE: &str = "feasible";

/// The output that takes far longer than all the rest: nobody gets it who does not ask for it.
pub const NONLINEAR: &str = "deviation_nonlinear_m";

macro_rules! outputs {
    ($($name:expr, $shape:expr, |$found:ident| $value:expr $(, map |$map:ident| $of_map:expr)?;)*) => {
        /// Every output, in the order of `leg eval`.
        pub const OUTPUTS: &[Output] = &[$(Output {
            name: $name,
            shape: &$shape,
            whole: |$found, out| out.copy_from_slice(&$value),
            map: outputs!(@map $(|$map| $of_map)?),
        },)*];
    };
    (@map) => { None };
    (@map |$map:ident| $of_map:expr) => {
        Some(|$map, out| {
            out.copy_from_slice(&$of_map);
            Ok(())
        })
    };
}

outputs! {
    "lengths_m", [3], |at| at.found.lengths_m;
    "moment_map_m", [3, 3], |at| at.found.moment_map_m.as_flattened();
    "pretension_direction", [3], |at| at.found.pretension_direction;
    "load_moment_nm", [3], |at| at.found.load_moment_nm;
    "joint_moment_nm", [3], |at| at.found.joint_moment_nm;
    "tensions_n", [3], |at| at.found.tensions_n, map |at| at.tensions_n?;
    "tensions_min_n", [3], |at| at.found.tensions_min_n;
    "level_range_n", [2], |at| at.found.pretension_range_n, map |at| at.pretension_range_n;
    FEASIBLE, [], |at| [truth(at.found.feasible)], map |at| [truth(is_range(at.pretension_range_n))];
    "stiffness_nm_per_rad", [3, 3], |at| at.found.stiffness_nm_per_rad.as_flattened();
    "stiffness_joint_nm_per_rad", [3, 3], |at| at.found.stiffness_joint_nm_per_rad.as_flattened();
    "stiffness_k2_exact_nm_per_rad", [3, 3], |at| at.found.stiffness_k2_exact_nm_per_rad.as_flattened();
    "stiffness_k2_printed_nm_per_rad", [3, 3], |at| at.found.stiffness_k2_printed_nm_per_rad.as_flattened();
    "bending_stiffness_nm_per_rad", [2], |at| at.found.bending_stiffness_nm_per_rad, map |at| at.bending_stiffness_nm_per_rad?;
    "axial_stretch_m", [], |at| [at.found.axial_stretch_m];
    "deviation_m", [], |at| [at.found.deviation_m], map |at| [at.deviation_m?];
    "deviation_with_load_stiffness_m", [], |at| [at.found.deviation_with_load_stiffness_m];
    "unstretched_m", [3], |at| at.found.unstretched_m;
    "torsion_rad", [], |at| [at.found.torsion_rad];
    "commanded_level_n", [], |at| [at.found.commanded.map_or(f64::NAN, |answer| answer.pretension_n)];
    "commanded_stiffness_nm_per_rad", [], |at| [at.found.commanded.map_or(f64::NAN, |answer| answer.stiffness_nm_per_rad)];
    NONLINEAR, [], |at| [at.deviation_nonlinear_m.unwrap_or(f64::NAN)];
}

fn truth(value: bool) -> f64 {
    f64::from(u8::from(value))
}

fn is_range([lowest, highest]: [f64; 2]) -> bool {
    lowest <= highest
}

/// The output of a name.
pub fn named(name: &str) -> Option<&'static Output> {
    OUTPUTS.iter().find(|output| output.name == name)
}
