//! The firmware's version.

/// Major, minor and patch of the version in Cargo.toml.
pub const VERSION: [u8; 3] = [
    number(env!("CARGO_PKG_VERSION_MAJOR")),
    number(env!("CARGO_PKG_VERSION_MINOR")),
    number(env!("CARGO_PKG_VERSION_PATCH")),
];

/// A number of up to three digits; what does not fit into a byte fails to compile.
const fn number(text: &str) -> u8 {
    let bytes = text.as_bytes();
    let mut value = 0;
    let mut i = 0;
    while i < bytes.len() {
        value = value * 10 + bytes[i] - b'0';
        i += 1;
    }
    value
}
