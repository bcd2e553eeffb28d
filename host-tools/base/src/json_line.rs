//! What machines read: one JSON value a line.

use crate::failure::Failure;
use serde::Serialize;

/// One line of JSON.
///
/// # Errors
/// A [`Failure`] if the value has no form in JSON.
pub fn to_line<T: Serialize + ?Sized>(value: &T) -> Result<String, Failure> {
    match serde_json::to_string(value) {
        Ok(json) => Ok(json + "\n"),
        Err(error) => Err(Failure::from_error(&error)),
    }
}
