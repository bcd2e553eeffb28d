//! The settings of a leg, as a rig gives them.

use crate::arguments;
use leg_firmware::settings::Settings;
use leg_host::operator::{Operator, OperatorError};
use leg_rig::control_settings;
use pyo3::prelude::*;

/// Those that a rig gives.
pub(super) fn from_rig(rig: &Bound<'_, PyAny>) -> PyResult<Settings> {
    let rig = arguments::rig_or_default(Some(rig))?;
    Ok(control_settings::settings(&rig, &rig.gains, None))
}

/// Replaces those of a leg, and keeps them over a reset if that is asked for.
pub(super) fn set(
    operator: &mut Operator,
    settings: &Settings,
    save: bool,
) -> Result<(), OperatorError> {
    operator.set_settings(settings)?;
    if save {
        operator.save_settings()?;
    }
    Ok(())
}
