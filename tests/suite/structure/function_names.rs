//! Names of functions: none begins with a preposition. Tests are named by sentences.

use super::{APART, metadata, workspace};
use crate::common::sources::sources;
use leg_boards::image::workspace_root;
use proc_macro2::{TokenStream, TokenTree};

const PREPOSITIONS: &str = "above across after against along among around as at before behind below beneath beside \
     between beyond but by despite down during except for from in inside into near of off on onto out outside over past per \
     since than through till to toward towards under until up upon via with within without";

/// Rust's own: conversions, builders, and what a closure is given.
const CONVENTIONS: [&str; 5] = ["as", "from", "into", "to", "with"];

/// Directories of a package that hold sources.
const SOURCES: [&str; 4] = ["src", "suite", "tests", "fuzz_targets"];

/// The names of the functions in a source, tests apart.
fn functions(source: &str) -> Vec<String> {
    let mut names = Vec::new();
    add_functions(source.parse().unwrap(), &mut names);
    names
}

fn add_functions(tokens: TokenStream, names: &mut Vec<String>) {
    let mut is_test = false;
    let mut before = String::new();
    for token in tokens {
        match &token {
            TokenTree::Group(attribute) if before == "#" => {
                is_test |= attribute.stream().to_string() == "test";
            }
            TokenTree::Group(group) => add_functions(group.stream(), names),
            TokenTree::Ident(_) if before == "fn" && std::mem::take(&mut is_test) => {}
            TokenTree::Ident(name) if before == "fn" => names.push(name.to_string()),
            _ => {}
        }
        before = token.to_string();
    }
}

fn is_preposition(name: &str) -> bool {
    let first = name.split('_').next().unwrap_or(name);
    let is_preposition = PREPOSITIONS.split_whitespace().any(|word| word == first);
    is_preposition && !CONVENTIONS.contains(&first)
}

#[test]
fn no_function_is_named_by_a_preposition() {
    let mut text = String::new();
    let apart = APART.map(|(directory, _)| metadata(&workspace_root().join(directory)).packages);
    for package in workspace().packages.iter().chain(apart.iter().flatten()) {
        let directory = package.manifest_path.parent().unwrap();
        for source in SOURCES.map(|name| directory.join(name)) {
            if source.exists() {
                sources(source.as_std_path(), &mut text);
            }
        }
    }
    let mut names = functions(&text);
    assert!(names.len() > 6000, "{} names", names.len());
    names.retain(|name| is_preposition(name));
    assert!(names.is_empty(), "{names:?}");
}

#[test]
fn functions_are_found_wherever_they_are_defined() {
    for (source, expected) in [
        ("pub fn a() {} const fn b<T>() {}", &["a", "b"][..]),
        (
            "impl A { fn c(&self, d: fn(u8)) { fn e() {} } }",
            &["c", "e"],
        ),
        ("trait A { #[must_use] fn f(&self); }", &["f"]),
        (
            "made! { fn g() {} #[test] fn h() {} fn i() {} }",
            &["g", "i"],
        ),
        ("#[test] #[ignore] fn j() { fn k() {} }", &["k"]),
        ("// fn l() {}", &[]),
    ] {
        assert_eq!(functions(source), expected, "{source}");
    }
    assert!(
        ["of", "of_rig", "without_zero"]
            .into_iter()
            .all(is_preposition)
    );
    assert!(
        !["offset", "with_rig", "byte", "from"]
            .into_iter()
            .any(is_preposition)
    );
}
