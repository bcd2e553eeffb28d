use super::{Programs, SetupError};
use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::Command;

/// An apt-get that installs the emulator beside itself, and a sudo that asks for nothing.
const FAKE_PROGRAMS: &str = r#"
cat > apt-get <<'END'
#!/bin/sh
echo "$DEBIAN_FRONTEND" "$@" >> "$(dirname "$0")/calls"
case "$*" in *" install "*)
    printf '#!/bin/sh\n' > "$(dirname "$0")/qemu-system-arm"
    chmod +x "$(dirname "$0")/qemu-system-arm";;
esac
END
cat > sudo <<'END'
#!/bin/sh
shift
exec "$@"
END
chmod +x apt-get sudo
"#;

fn only_in(directory: impl Into<OsString>) -> Programs {
    Programs {
        path: Some(directory.into()),
        named_qemu: None,
    }
}

/// What was reported, and what came of it.
fn ensure_qemu(programs: &Programs) -> (Vec<String>, Result<OsString, SetupError>) {
    let mut reports = Vec::new();
    let outcome = programs.ensure_qemu(&mut |what| reports.push(what.to_owned()));
    (reports, outcome.map(OsString::from))
}

fn run_shell(directory: &Path, script: &str) -> io::Result<()> {
    // Written by a child: a script that this process still had open for writing could not be run.
    let status = Command::new("sh")
        .args(["-ec", script])
        .current_dir(directory)
        .status()?;
    assert!(status.success());
    Ok(())
}

#[test]
fn a_missing_qemu_is_named_with_what_installs_it() {
    let (reports, outcome) = ensure_qemu(&only_in("/nowhere"));
    assert_eq!(reports, [""; 0], "nothing can be installed without apt-get");
    let text = outcome.map_or_else(|error| error.to_string(), |_| String::new());
    assert!(
        text.starts_with("`qemu-system-arm` is missing; install it: "),
        "{text}"
    );
    let commands = [
        "apt-get install",
        "dnf install",
        "pacman -S",
        "brew install",
        "LEG_QEMU",
    ];
    assert!(
        commands.iter().any(|command| text.contains(command)),
        "{text}"
    );
}

#[test]
fn a_missing_qemu_is_installed_where_apt_get_may_be_used() -> io::Result<()> {
    let directory = tempfile::tempdir()?;
    run_shell(directory.path(), FAKE_PROGRAMS)?;
    let programs = only_in(directory.path());
    let (reports, outcome) = ensure_qemu(&programs);
    assert_eq!(reports, ["installing qemu-system-arm by apt-get"]);
    let qemu = directory.path().join("qemu-system-arm");
    assert_eq!(outcome.ok(), Some(qemu.clone().into()));
    assert_eq!(
        std::fs::read_to_string(directory.path().join("calls"))?,
        "noninteractive -o DPkg::Lock::Timeout=300 update\n\
         noninteractive -o DPkg::Lock::Timeout=300 install -y --no-install-recommends qemu-system-arm\n"
    );
    let (reports, outcome) = ensure_qemu(&programs);
    assert_eq!(reports, [""; 0], "the second time it is there");
    assert_eq!(outcome.ok(), Some(qemu.into()));
    Ok(())
}

#[test]
fn a_failing_apt_get_is_quoted() -> io::Result<()> {
    let directory = tempfile::tempdir()?;
    let failing =
        "printf '#!/bin/sh\\necho no network >&2; exit 100\\n' > apt-get; chmod +x apt-get";
    run_shell(directory.path(), FAKE_PROGRAMS)?;
    run_shell(directory.path(), failing)?;
    let (_, outcome) = ensure_qemu(&only_in(directory.path()));
    let text = outcome.map_or_else(|error| error.to_string(), |_| String::new());
    assert!(
        text.contains("apt-get -o DPkg::Lock::Timeout=300 update` failed"),
        "{text}"
    );
    assert!(text.ends_with("no network\n"), "{text}");
    Ok(())
}

#[test]
fn a_named_qemu_that_is_not_there_is_not_replaced() {
    let programs = Programs {
        named_qemu: Some("/nowhere/qemu".into()),
        ..Programs::of_this_process()
    };
    let (reports, outcome) = ensure_qemu(&programs);
    assert_eq!(reports, [""; 0]);
    assert_eq!(
        outcome.map_err(|error| error.to_string()),
        Err(
            "LEG_QEMU names `/nowhere/qemu`, which is no program; correct it or unset it"
                .to_owned()
        )
    );
}

#[test]
fn a_missing_rust_is_named() {
    assert_eq!(
        only_in("/nowhere")
            .has_target()
            .map_err(|error| error.to_string()),
        Err("`rustc` is missing; install Rust with rustup, which brings it".to_owned())
    );
}
