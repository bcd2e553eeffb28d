//! An evaluation as one array, in the order that `precision` gives its parts.

use leg_model::Evaluation;

/// The numbers of an evaluation, in the order of its fields.
pub(super) fn flatten<T: Copy + Into<f64>>(evaluation: &Evaluation<T>) -> Vec<f64> {
    let e = evaluation;
    let commanded = e.commanded.iter();
    let commanded: Vec<T> = commanded
        .flat_map(|c| [c.pretension_n, c.stiffness_nm_per_rad])
        .collect();
    let numbers = [
        &e.lengths_m[..],
        e.moment_map_m.as_flattened(),
        &e.pretension_direction,
        &e.load_moment_nm,
        &e.joint_moment_nm,
        &e.tensions_n,
        &e.tensions_min_n,
        &e.pretension_range_n,
        e.stiffness_nm_per_rad.as_flattened(),
        e.stiffness_joint_nm_per_rad.as_flattened(),
        e.stiffness_k2_exact_nm_per_rad.as_flattened(),
        e.stiffness_k2_printed_nm_per_rad.as_flattened(),
        &e.bending_stiffness_nm_per_rad,
        &[e.axial_stretch_m],
        &[e.deviation_m, e.deviation_with_load_stiffness_m],
        &e.unstretched_m,
        &[e.torsion_rad],
        &commanded,
    ];
    numbers.concat().into_iter().map(Into::into).collect()
}
