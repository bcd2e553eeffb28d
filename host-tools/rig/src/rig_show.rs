//! What the model makes of a rig file.

use crate::current_output;
use crate::recorded_signals;
use crate::rig_file::derived::{self, DerivedGain, derived_gains};
use crate::rig_file::{Buckling, RigFile};
use crate::rig_settings;
use leg_base::failure::Failure;
use leg_base::json_line::to_line;
use leg_model::JointStiffness;
use serde::Serialize;

/// The numbers of a rig that its file does not give directly.
#[derive(Debug, Serialize)]
struct RigSummary {
    support: &'static str,
    #[serde(flatten)]
    joint: JointStiffness<f64>,
    critical_load_n: Option<f64>,
    pull_by_critical_at_pretension: Option<f64>,
    pull_by_critical_at_f_max: Option<f64>,
    tip_below_joint_m: f64,
    leg_mass_kg: f64,
    leg_centroid_m: f64,
    pretension_n: f64,
    f_min_n: f64,
    f_max_n: f64,
    stiffness_at_pretension_n_per_m: [f64; 3],
    elongation_factor: f64,
    tilt_deg: f64,
    keeps_station: bool,
    recorded: Vec<&'static str>,
    current_outputs: [&'static str; 3],
    derived: Vec<DerivedGain>,
}

impl RigSummary {
    fn new(file: &RigFile) -> Self {
        let parameters = &file.parameters;
        let buckling = file.buckling();
        Self {
            support: file.support_name.word(),
            joint: *file.support.joint(),
            critical_load_n: buckling.map(|found| found.critical_n),
            pull_by_critical_at_pretension: buckling.map(|found| found.at_pretension),
            pull_by_critical_at_f_max: buckling.map(|found| found.at_f_max),
            tip_below_joint_m: parameters.joint_length_m + parameters.leg_length_m,
            leg_mass_kg: parameters.leg_mass_kg,
            leg_centroid_m: parameters.leg_centroid_m,
            pretension_n: file.pretension_n,
            f_min_n: file.f_min_n,
            f_max_n: file.f_max_n,
            stiffness_at_pretension_n_per_m: file.stiffnesses_n_per_m(),
            elongation_factor: file.elongation_factor,
            tilt_deg: file.tilt_deg,
            keeps_station: file.keeps_station,
            recorded: recorded_signals::words(file.recorded).collect(),
            current_outputs: file
                .actuators
                .each_ref()
                .map(|actuator| current_output::word(actuator.current_output)),
            derived: derived_gains(file),
        }
    }
}

/// Where the leg has measured its tendons, what it found.
fn elongation_words(factor: f64) -> String {
    if factor == 1.0 {
        return String::new();
    }
    format!("elongation             {factor} times that of the curve or stiffness, measured\n")
}

/// A table for people.
#[must_use]
pub fn words(file: &RigFile) -> String {
    let summary = RigSummary::new(file);
    let [first, second, third] = summary.stiffness_at_pretension_n_per_m;
    format!(
        "support                {}\n\
         joint, bending         {:.4} N·m/rad\n\
         joint, torsion         {:.4} N·m/rad\n\
         joint, along the leg   {:.3e} m/N\n\
         {}\
         tip below the joint    {:.1} mm\n\
         leg                    {} kg, centroid {:.1} mm below the joint\n\
         tensions               {} to {} N, pretension {} N\n\
         tendons at pretension  {first:.0}, {second:.0}, {third:.0} N/m\n\
         {}\
         workspace              tilt to {}°\n\
         after a command        {}\n\
         recorded at every tick {}\n\
         {}{}{}",
        summary.support,
        summary.joint.bending_nm_per_rad,
        summary.joint.torsion_nm_per_rad,
        summary.joint.axial_compliance_m_per_n,
        file.buckling().map_or_else(String::new, buckling_words),
        summary.tip_below_joint_m * 1000.0,
        summary.leg_mass_kg,
        summary.leg_centroid_m * 1000.0,
        summary.f_min_n,
        summary.f_max_n,
        summary.pretension_n,
        elongation_words(summary.elongation_factor),
        summary.tilt_deg,
        if summary.keeps_station {
            "keeps station"
        } else {
            "held"
        },
        match &summary.recorded[..] {
            [] => "nothing".into(),
            signals => signals.join(", "),
        },
        current_words(summary.current_outputs),
        rig_settings::changes(file),
        derived::table(&summary.derived),
    )
}

/// What the current outputs show, where that is not both directions at all motors.
fn current_words(outputs: [&str; 3]) -> String {
    match outputs {
        ["bidirectional", "bidirectional", "bidirectional"] => String::new(),
        [a, b, c] if a == b && b == c => format!("current outputs        {a}\n"),
        outputs => format!("current outputs        {}\n", outputs.join(", ")),
    }
}

fn buckling_words(buckling: Buckling) -> String {
    let Buckling {
        critical_n,
        at_pretension,
        at_f_max,
    } = buckling;
    let warning = if at_f_max >= 1.0 {
        "warning                the joint buckles before all tendons pull with the highest tension: make its flexures\n\
         \u{20}                      thicker or shorter, or lower `f_max_n`\n"
    } else {
        ""
    };
    format!(
        "joint, buckling        at {critical_n:.0} N; the tendons pull with {at_pretension:.2} of it at the pretension, \
         {at_f_max:.2} at the maximum tension\n{warning}"
    )
}

/// One line of JSON for machines, in SI units.
///
/// # Errors
/// A [`Failure`] if the numbers have no form in JSON.
pub fn json(file: &RigFile) -> Result<String, Failure> {
    to_line(&RigSummary::new(file))
}
