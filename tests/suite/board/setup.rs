//! What a first run installs, and what it asks the user to install.

use leg_boards::setup::{PYTHON, Package, Programs, QEMU, SetupError, TARGET, ensure, has_target};
use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::Command;

/// An apt-get that installs both programs beside itself, and a sudo that asks for nothing.
const FAKE_PROGRAMS: &str = r#"
cat > apt-get <<'END'
#!/bin/sh
echo "$DEBIAN_FRONTEND" "$@" >> "$(dirname "$0")/calls"
case "$*" in *" install "*)
    for program in qemu-system-arm python3; do
        printf '#!/bin/sh\n' > "$(dirname "$0")/$program"
        chmod +x "$(dirname "$0")/$program"
    done;;
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

/// What was reported, and the program or the text of the error.
fn ensured(package: &Package, programs: &Programs) -> (Vec<String>, Result<OsString, String>) {
    let mut reports = Vec::new();
    let outcome = ensure(package, programs, &mut |what| reports.push(what.to_owned()));
    let outcome = outcome.map(OsString::from);
    (reports, outcome.map_err(|error| error.to_string()))
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
fn a_missing_program_is_named_with_what_installs_it() {
    let cases = [
        (&QEMU, "`qemu-system-arm`", "LEG_QEMU"),
        (
            &PYTHON,
            "`python3 (3.11 or later, with venv)`",
            "python.org",
        ),
    ];
    for (package, name, otherwise) in cases {
        let (reports, outcome) = ensured(package, &only_in("/nowhere"));
        assert_eq!(reports, [""; 0], "nothing can be installed without apt-get");
        let text = outcome.err().unwrap_or_default();
        assert!(
            text.starts_with(&format!("{name} is missing; install it: ")),
            "{text}"
        );
        let commands = [
            "apt-get install",
            "dnf install",
            "pacman -S",
            "brew install",
            otherwise,
        ];
        assert!(
            commands.iter().any(|command| text.contains(command)),
            "{text}"
        );
    }
}

#[test]
fn a_missing_program_is_installed_where_apt_get_may_be_used() -> io::Result<()> {
    let cases = [
        (&QEMU, "qemu-system-arm", "qemu-system-arm"),
        (&PYTHON, "python3", "python3 python3-venv"),
    ];
    for (package, program, packages) in cases {
        let directory = tempfile::tempdir()?;
        run_shell(directory.path(), FAKE_PROGRAMS)?;
        let programs = only_in(directory.path());
        let (reports, outcome) = ensured(package, &programs);
        assert_eq!(reports, [format!("installing {} by apt-get", package.name)]);
        let path = directory.path().join(program);
        assert_eq!(outcome, Ok(path.clone().into()));
        let apt = "noninteractive -o DPkg::Lock::Timeout=300";
        assert_eq!(
            std::fs::read_to_string(directory.path().join("calls"))?,
            format!("{apt} update\n{apt} install -y --no-install-recommends {packages}\n")
        );
        let (reports, outcome) = ensured(package, &programs);
        assert_eq!(reports, [""; 0], "the second time it is there");
        assert_eq!(outcome, Ok(path.into()));
    }
    Ok(())
}

#[test]
fn a_failing_apt_get_is_quoted() -> io::Result<()> {
    let directory = tempfile::tempdir()?;
    let failing =
        "printf '#!/bin/sh\\necho no network >&2; exit 100\\n' > apt-get; chmod +x apt-get";
    run_shell(directory.path(), FAKE_PROGRAMS)?;
    run_shell(directory.path(), failing)?;
    let (_, outcome) = ensured(&QEMU, &only_in(directory.path()));
    let text = outcome.err().unwrap_or_default();
    assert!(
        text.contains("apt-get -o DPkg::Lock::Timeout=300 update` failed"),
        "{text}"
    );
    assert!(text.ends_with("no network\n"), "{text}");
    Ok(())
}

#[test]
fn a_python_that_is_too_old_is_missing() -> io::Result<()> {
    let directory = tempfile::tempdir()?;
    run_shell(
        directory.path(),
        "printf '#!/bin/sh\\nexit 1\\n' > python3; chmod +x python3",
    )?;
    let (_, outcome) = ensured(&PYTHON, &only_in(directory.path()));
    assert!(outcome.is_err_and(|text| text.contains("is missing")));
    Ok(())
}

#[test]
fn a_named_qemu_that_is_not_there_is_not_replaced() {
    let programs = Programs {
        named_qemu: Some("/nowhere/qemu".into()),
        ..Programs::from_environment()
    };
    let (reports, outcome) = ensured(&QEMU, &programs);
    assert_eq!(reports, [""; 0]);
    let text = "LEG_QEMU names `/nowhere/qemu`, which is no program; correct it or unset it";
    assert_eq!(outcome, Err(text.to_owned()));
}

#[test]
fn a_missing_rust_is_named() {
    let outcome = has_target(&only_in("/nowhere"), TARGET);
    assert!(matches!(outcome, Err(SetupError::RustMissing("rustc"))));
}
