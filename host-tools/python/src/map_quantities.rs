//! The quantities of a map.

use leg_model_tools::workspace_map::Cell;

/// A number of a cell of a map.
pub type CellValue = fn(&Cell) -> Option<f64>;

/// The quantities of a map: those of `leg map`, each with its unit.
pub const MAP_QUANTITIES: [(&str, CellValue); 9] = [
    ("feasible", |cell| Some(f64::from(u8::from(cell.feasible)))),
    ("pretension_keeps_bounds", |cell| {
        Some(f64::from(u8::from(cell.pretension_keeps_bounds)))
    }),
    ("pretension_min_n", |cell| Some(cell.pretension_min_n)),
    ("pretension_max_n", |cell| Some(cell.pretension_max_n)),
    ("margin_n", |cell| cell.margin_n),
    ("deviation_mm", |cell| {
        Some(cell.at_pretension.ok()?.deviation_mm)
    }),
    ("stiffness_min_nm_per_rad", |cell| {
        Some(cell.at_pretension.ok()?.stiffness_min_nm_per_rad)
    }),
    ("stiffness_max_nm_per_rad", |cell| {
        Some(cell.at_pretension.ok()?.stiffness_max_nm_per_rad)
    }),
    ("deviation_nonlinear_mm", |cell| {
        cell.deviation_nonlinear_mm?.ok()
    }),
];
