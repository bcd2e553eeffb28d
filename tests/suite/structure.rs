//! How the project is cut: crates point only down, siblings inside a crate form no circle, a type has a name of its own and no
//! function that of a preposition, few programs are linked.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod circles;
mod function_names;
mod modules;
mod type_names;

use cargo_metadata::{Metadata, MetadataCommand, Package};
use circles::circles;
use leg_boards::image::workspace_root;
use modules::Modules;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

/// The crates from the top down: each may use those of the rows below its own.
const LAYERS: [&[&str]; 11] = [
    &["leg-tests"],
    &["leg-cli"],
    &["leg-bench", "leg-host"],
    &["leg-boards", "leg-recording"],
    &["stm32g474-emulator"],
    &["leg-sim"],
    &["leg-model-tools"],
    &["leg-rig", "leg-qemu", "leg-stm32g474"],
    &["leg-firmware-bench", "leg-base"],
    &["leg-firmware"],
    &["leg-model"],
];

const CRATES_MAX: usize = 16;
const EDGES_MAX: usize = 70;

/// Programs that `cargo test` links: one for the unit tests of each crate that has some, and two.
const TEST_PROGRAMS_MAX: usize = 10;

/// Workspaces of their own, and the uppermost crate of the layers that each may use.
const APART: [(&str, &str); 3] = [
    ("host-tools/python", "leg-host"),
    ("host-tools/window", "leg-recording"),
    ("tests/fuzz", "leg-firmware-bench"),
];

/// Siblings that use each other in a circle: crate, parent, members. No circle may be added, and none that is gone may
/// stay here.
const CIRCLES: &[(&str, &str, &str)] = &[
    ("tendon-leg", "", "arguments rig"),
    ("leg-fuzz", "", "host_requests requests"),
];

fn workspace() -> Metadata {
    metadata(&workspace_root())
}

/// The packages of the workspace in a directory.
fn metadata(directory: &Path) -> Metadata {
    let manifest = directory.join("Cargo.toml");
    let mut command = MetadataCommand::new();
    command.manifest_path(manifest).no_deps();
    command.exec().unwrap()
}

fn layer(name: &str) -> usize {
    let layer = LAYERS.iter().position(|layer| layer.contains(&name));
    layer.unwrap_or_else(|| panic!("{name} stands in no layer"))
}

/// The crates of this workspace that a crate uses, in its tests as well.
fn used<'a>(package: &'a Package, members: &BTreeSet<&str>) -> BTreeSet<&'a str> {
    let names = package.dependencies.iter().map(|used| used.name.as_str());
    names.filter(|name| members.contains(name)).collect()
}

#[test]
fn crates_point_only_down() {
    let workspace = workspace();
    let members: BTreeSet<&str> = workspace.packages.iter().map(|p| p.name.as_str()).collect();
    let mut edges = 0;
    for package in &workspace.packages {
        for used in used(package, &members) {
            let (user, used_layer) = (layer(&package.name), layer(used));
            assert!(user < used_layer, "{} uses {used}", package.name);
            edges += 1;
        }
    }
    println!("{} crates, {edges} edges", members.len());
    assert!(members.len() <= CRATES_MAX, "{members:?}");
    assert!(edges <= EDGES_MAX, "{edges} edges");
}

#[test]
fn workspaces_of_their_own_use_only_what_stands_below_them() {
    for (directory, uppermost) in APART {
        for package in metadata(&workspace_root().join(directory)).packages {
            for used in &package.dependencies {
                if LAYERS.concat().contains(&used.name.as_str()) {
                    let (highest, used_layer) = (layer(uppermost), layer(&used.name));
                    assert!(highest <= used_layer, "{} uses {}", package.name, used.name);
                }
            }
        }
    }
}

#[test]
fn siblings_form_no_circle() {
    let mut found = Vec::new();
    let apart = APART.map(|(directory, _)| metadata(&workspace_root().join(directory)).packages);
    for package in workspace().packages.iter().chain(apart.iter().flatten()) {
        let source = package.manifest_path.parent().unwrap().join("src");
        if package.name == "leg-tests" {
            continue;
        }
        let modules = Modules::read(source.as_std_path());
        for (parent, uses) in modules.sibling_uses() {
            for members in circles(&uses) {
                found.push((
                    package.name.to_string(),
                    parent.join("::"),
                    members.join(" "),
                ));
            }
        }
    }
    let found: Vec<(&str, &str, &str)> = found
        .iter()
        .map(|(name, parent, members)| (name.as_str(), parent.as_str(), members.as_str()))
        .collect();
    assert_eq!(found, CIRCLES, "circles found, and circles listed");
}

#[test]
fn few_test_programs_are_linked() {
    let workspace = workspace();
    let members = workspace.workspace_default_packages();
    let targets = members.iter().flat_map(|package| &package.targets);
    let programs: Vec<&str> = targets
        .filter(|target| target.test)
        .map(|target| target.name.as_str())
        .collect();
    println!("{} programs: {programs:?}", programs.len());
    assert!(programs.len() <= TEST_PROGRAMS_MAX, "{programs:?}");
}

/// The units of other projects' crates that a cargo command compiles, by everything that may differ between two.
fn foreign_units(command: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(command)
        .args(["--unit-graph", "-Zunstable-options"])
        // The toolchain is pinned, and with it what it calls unstable.
        .env("RUSTC_BOOTSTRAP", "1")
        // As the files set it, whatever CI does.
        .env_remove("CARGO_PROFILE_DEV_DEBUG")
        .env_remove("CARGO_PROFILE_DEV_CODEGEN_UNITS")
        .current_dir(workspace_root())
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let graph: Value = serde_json::from_slice(&output.stdout).unwrap();
    let units = graph["units"].as_array().unwrap().iter();
    let foreign = units.filter(|unit| unit["pkg_id"].as_str().unwrap().starts_with("registry"));
    let parts = |unit: &Value| {
        let (target, profile) = (&unit["target"]["name"], &unit["profile"]);
        let (mode, features) = (&unit["mode"], &unit["features"]);
        let (level, debug) = (&profile["opt_level"], &profile["debuginfo"]);
        format!(
            "{} {target} {mode} {features} {level} {debug}",
            unit["pkg_id"]
        )
    };
    foreign.map(parts).collect()
}

#[test]
fn both_commands_share_the_build_of_the_dependencies() {
    let (leg, tests) = (
        foreign_units(&["build", "--bin", "leg"]),
        foreign_units(&["test"]),
    );
    let again: Vec<&String> = leg.difference(&tests).collect();
    println!(
        "leg: {} units, tests: {}, compiled twice: {}",
        leg.len(),
        tests.len(),
        again.len()
    );
    assert!(leg.len() > 100, "{leg:?}");
    assert!(again.is_empty(), "{again:#?}");
}

/// The lines of a manifest's section, but comments.
fn section<'a>(manifest: &'a str, heading: &str) -> BTreeSet<&'a str> {
    let lines = manifest.lines();
    let lines = lines.skip_while(|line| *line != heading);
    let lines = lines.skip(1).take_while(|line| !line.starts_with('['));
    let lines = lines.filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.collect()
}

/// Else a check of the package in the target folder of this workspace compiles again what is there.
#[test]
fn the_python_package_is_checked_as_this_workspace_is() {
    let read = |name: &str| std::fs::read_to_string(workspace_root().join(name)).unwrap();
    let here = read("Cargo.toml");
    let python = read("host-tools/python/Cargo.toml");
    let locked = read("host-tools/python/Cargo.lock");
    let is_used = |line: &&str| {
        let name = line.split(' ').next().unwrap_or_default();
        name.contains('*') || locked.contains(&format!("name = \"{name}\"\n"))
    };
    let heading = "[profile.dev.package]";
    let expected: BTreeSet<&str> = section(&here, heading)
        .into_iter()
        .filter(is_used)
        .collect();
    assert!(expected.len() > 20, "{expected:?}");
    assert_eq!(section(&python, heading), expected);
    let heading = "[profile.dev]";
    let expected = section(&here, heading);
    assert!(expected.len() > 1, "{expected:?}");
    assert_eq!(section(&python, heading), expected);
}

/// Asserts which siblings of made-up sources, each a module's path and its text, form circles.
#[track_caller]
fn assert_circles(sources: &[(&str, &str)], expected: &[(&str, &str)]) {
    let mut modules = Modules::default();
    for (module, source) in sources {
        let path: Vec<String> = module.split_terminator("::").map(String::from).collect();
        modules.read_source(source, &path);
    }
    let mut found = Vec::new();
    for (parent, uses) in modules.sibling_uses() {
        let members = circles(&uses).into_iter().map(|members| members.join(" "));
        found.extend(members.map(|members| (parent.join("::"), members)));
    }
    let found: Vec<(&str, &str)> = found.iter().map(|(p, m)| (&**p, &**m)).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_circle_is_found_whatever_path_it_takes() {
    let root = (
        "",
        "mod a; mod b; mod c; pub use c::{Made as Renamed, other};",
    );
    let b = ("b", "fn f() { crate::c::g::<super::Renamed>(); }");
    for closing in [
        "use crate::a::A;",
        "use super::{b, a::{self, A}};",
        "fn g() -> Vec<crate::a::A> {}",
        "mod inner { impl super::super::a::A {} }",
    ] {
        assert_circles(
            &[root, ("a", "use crate::b::f;"), b, ("c", closing)],
            &[("", "a b c")],
        );
    }
    let through_an_import = [root, ("a", ""), b, ("c", "use crate::b::f;")];
    assert_circles(&through_an_import, &[("", "b c")]);
    let deeper = [
        ("a", "mod b; mod c;"),
        ("a::b", "use super::c::C;"),
        ("a::c", "use crate::a::b::B;"),
    ];
    assert_circles(&deeper, &[("a", "b c")]);
}

#[test]
fn parents_tests_comments_and_other_crates_close_no_circle() {
    let parent = ("", "mod a; mod b; pub struct Shared; use a::A;");
    let a = (
        "a",
        "use crate::Shared; use super::b::B; fn captures() -> impl Fn() + use<> {}",
    );
    for open in [
        "// crate::a::A",
        "const TEXT: &str = \"crate::a::A\";",
        "#[cfg(test)] mod tests { use crate::a::A; }",
        "#[cfg(test)] use crate::a::A;",
        "use a::A;",
        "use crate::Shared;",
    ] {
        assert_circles(&[parent, a, ("b", open)], &[]);
    }
}

/// What somebody reads first.
#[test]
fn the_front_page_is_short() {
    let text = std::fs::read_to_string(workspace_root().join("README.md")).unwrap();
    let (lines, words) = (text.lines().count(), text.split_whitespace().count());
    assert!(
        lines <= 250 && words <= 1800,
        "{lines} lines, {words} words"
    );
}
