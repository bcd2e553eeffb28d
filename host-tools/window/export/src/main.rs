//! Writes the window as one page that runs in a browser alone, from any web server or from disk:
//! `cargo run --package leg-window-export -- DIR`.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::error::Error;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use wasm_bindgen_cli_support::Bindgen;

const TARGET: &str = "wasm32-unknown-unknown";

/// The page, with places for the script and for the program.
const PAGE: &str = include_str!("page.html");
const SCRIPT_PLACE: &str = "/* script */";
const PROGRAM_PLACE: &str = "/* program */";

fn main() -> ExitCode {
    let Some(directory) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!(
            "error: no directory is given\nhelp: cargo run --package leg-window-export -- DIR"
        );
        return ExitCode::from(2);
    };
    match export(&directory) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn export(directory: &Path) -> Result<(), Box<dyn Error>> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    build(&workspace)?;
    let target = target_directory(&workspace);
    let program = target.join(TARGET).join("release").join("leg_window.wasm");
    let bound = target.join("page");
    // A script without modules: a page from disk may not load any.
    let mut bindgen = Bindgen::new();
    bindgen
        .input_path(program)
        .typescript(false)
        .no_modules(true)?;
    bindgen.generate(&bound)?;
    let script = fs::read_to_string(bound.join("leg_window.js"))?;
    let program = fs::read(bound.join("leg_window_bg.wasm"))?;
    let page = page(&script, &program)?;
    fs::create_dir_all(directory)?;
    let path = directory.join("index.html");
    fs::write(&path, &page)?;
    let wire = compressed(page.as_bytes())?.len();
    println!(
        "{}: {:.2} MB, {:.2} MB over the wire where the server compresses; the program alone {:.2} MB",
        path.display(),
        megabytes(page.len()),
        megabytes(wire),
        megabytes(program.len()),
    );
    Ok(())
}

fn megabytes(bytes: usize) -> f64 {
    bytes as f64 / 1e6
}

/// The cargo of the toolchain that builds this builds the program, too.
fn build(workspace: &Path) -> Result<(), Box<dyn Error>> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args([
        "build",
        "--locked",
        "--release",
        "--lib",
        "--package",
        "leg-window",
    ]);
    command.args(["--target", TARGET]).current_dir(workspace);
    if command.status()?.success() {
        return Ok(());
    }
    Err(format!("the window does not build for {TARGET}: cargo says why; `rustup target add {TARGET}` adds the target").into())
}

fn target_directory(workspace: &Path) -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| workspace.join("target"), PathBuf::from)
}

/// The page with script and program in it.
fn page(script: &str, program: &[u8]) -> Result<String, Box<dyn Error>> {
    for place in [SCRIPT_PLACE, PROGRAM_PLACE] {
        if PAGE.matches(place).count() != 1 {
            return Err(format!("page.html has not one place {place}").into());
        }
    }
    // What ends a script in a page must not stand in one.
    let script = script.replace("</script", "<\\/script");
    let program = STANDARD.encode(compressed(program)?);
    Ok(PAGE
        .replace(SCRIPT_PLACE, &script)
        .replace(PROGRAM_PLACE, &program))
}

fn compressed(bytes: &[u8]) -> io::Result<Vec<u8>> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    encoder.finish()
}
