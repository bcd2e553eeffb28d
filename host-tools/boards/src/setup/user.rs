//! The user to whom this process belongs.

/// The system's number of the user. Where there are none, as on Windows, directories for temporary files are each user's own.
#[cfg(unix)]
pub fn number() -> u32 {
    rustix::process::geteuid().as_raw()
}

#[cfg(not(unix))]
pub fn number() -> u32 {
    0
}

/// Whether the user may do everything.
pub fn is_root() -> bool {
    cfg!(unix) && number() == 0
}
