//! The section `[calibration]`: what was measured of the sensors of the three axes.

use crate::calibration::{
    CELL_N_PER_CODE, CELL_ZERO_CODE, COUNTS_SIGN, CURRENT_A_PER_CODE, Calibration, M_PER_COUNT,
};
use crate::toml_problem::{Fault, Problem};
use crate::toml_section::Section;

/// The name of the section.
pub(super) const CALIBRATION: &str = "calibration";

const FIELDS: [crate::fields::Field; 5] = [
    M_PER_COUNT,
    COUNTS_SIGN,
    CELL_N_PER_CODE,
    CELL_ZERO_CODE,
    CURRENT_A_PER_CODE,
];

/// The calibration; nothing is measured of what is left out.
pub(super) fn read(root: &Section<'_>) -> Result<Calibration, Fault> {
    let Some(section) = root.optional(CALIBRATION, &FIELDS.map(|field| field.name))? else {
        return Ok(Calibration::default());
    };
    Ok(Calibration {
        m_per_count: section.array(&[M_PER_COUNT; 3])?,
        counts_sign: counts_sign(&section)?,
        cell_n_per_code: section.array(&[CELL_N_PER_CODE; 3])?,
        cell_zero_code: section.array(&[CELL_ZERO_CODE; 3])?,
        current_a_per_code: section.array(&[CURRENT_A_PER_CODE; 3])?,
    })
}

fn counts_sign(section: &Section<'_>) -> Result<[f64; 3], Fault> {
    let Some(signs) = section.array(&[COUNTS_SIGN; 3])? else {
        return Ok(Calibration::default().counts_sign);
    };
    match signs.into_iter().find(|sign| sign.abs() != 1.0) {
        None => Ok(signs),
        Some(other) => Err(Fault {
            span: section.span_of_key(COUNTS_SIGN.name).unwrap_or(0..0),
            problem: Problem::Choice {
                key: COUNTS_SIGN.name,
                found: other.to_string(),
                choices: "1 or -1 for each axis",
            },
        }),
    }
}
