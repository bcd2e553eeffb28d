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
        Err(error) => Err(Failure::from_error(error)),
    }
}

/// A value that serialises as an object with these keys, in this order. serde's attributes may stand before a key.
///
/// A crate that uses it needs `serde` with the feature `derive`.
#[macro_export]
macro_rules! json_object {
    ($($(#[$attribute:meta])* $key:ident: $value:expr),+ $(,)?) => {{
        // Each key is also the name of a type parameter.
        #[allow(non_camel_case_types)]
        let object = {
            #[derive(serde::Serialize)]
            struct Object<$($key),+> {
                $($(#[$attribute])* $key: $key),+
            }
            Object { $($key: $value),+ }
        };
        object
    }};
}
