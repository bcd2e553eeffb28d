//! Names of public types: each stands for one type in the whole workspace.

use super::modules::skip_attribute;
use super::workspace;
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// Names of several types, and why each of them may be.
const EXCEPTIONS: [(&str, &str); 5] = [
    ("Args", "the arguments of each command of `leg`"),
    ("Keys", "the keys of the terminal, on Unix and elsewhere"),
    ("PseudoTerminal", "on Unix, and its absence elsewhere"),
    ("QemuSession", "on Unix, and its absence elsewhere"),
    ("Serial", "the serial line, on Unix and elsewhere"),
];

/// The files in which types of a name are defined.
type Definitions = BTreeMap<String, Vec<String>>;

/// Adds the types of every source below a directory, test code apart.
fn read_directory(directory: &Path, definitions: &mut Definitions) {
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.file_stem().unwrap() == "tests" {
            continue;
        }
        if path.is_dir() {
            read_directory(&path, definitions);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            for name in public_types(&text) {
                let files = definitions.entry(name).or_default();
                files.push(path.display().to_string());
            }
        }
    }
}

/// The names of the types in a source that are public in any way.
fn public_types(source: &str) -> Vec<String> {
    let mut names = Vec::new();
    add_public_types(source.parse().unwrap(), &mut names);
    names
}

fn add_public_types(tokens: TokenStream, names: &mut Vec<String>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut rest: &[TokenTree] = &tokens;
    while let [first, after @ ..] = rest {
        rest = match first {
            TokenTree::Punct(hash) if hash.as_char() == '#' => skip_attribute(after),
            TokenTree::Group(group) => {
                add_public_types(group.stream(), names);
                after
            }
            TokenTree::Ident(word) if word == "pub" => {
                names.extend(type_name(after));
                after
            }
            _ => after,
        };
    }
}

/// The name of the type whose definition follows a `pub`.
fn type_name(tokens: &[TokenTree]) -> Option<String> {
    let tokens = match tokens {
        [TokenTree::Group(scope), after @ ..] if scope.delimiter() == Delimiter::Parenthesis => {
            after
        }
        _ => tokens,
    };
    match tokens {
        [TokenTree::Ident(kind), TokenTree::Ident(name), ..] => {
            let kinds = ["struct", "enum", "trait", "type", "union"];
            kinds
                .iter()
                .any(|word| kind == word)
                .then(|| name.to_string())
        }
        _ => None,
    }
}

#[test]
fn a_public_type_has_a_name_of_its_own() {
    let mut definitions = Definitions::new();
    for package in workspace().packages {
        if package.name != "leg-tests" {
            let source = package.manifest_path.parent().unwrap().join("src");
            read_directory(source.as_std_path(), &mut definitions);
        }
    }
    assert!(definitions.len() > 500, "{} names", definitions.len());
    definitions.retain(|_, files| files.len() > 1);
    for (name, reason) in EXCEPTIONS {
        let several = definitions.remove(name);
        assert!(several.is_some(), "{name} ({reason}) stands for one type");
    }
    assert!(definitions.is_empty(), "{definitions:#?}");
}

#[test]
fn public_types_are_found_wherever_they_are_defined() {
    for (source, expected) in [
        ("pub struct A; pub(crate) enum B {}", &["A", "B"][..]),
        ("pub(super) type C<T> = Vec<T>; pub trait D {}", &["C", "D"]),
        ("made! { pub struct E { pub kind: F } }", &["E"]),
        ("mod inner { pub union G { a: u8 } }", &["G"]),
        ("#[derive(Clone)] pub struct H;", &["H"]),
        ("struct I; impl J { type K = L; pub fn f() {} }", &[]),
        ("// pub struct M;", &[]),
        ("#[cfg(test)] mod tests { pub struct N; }", &[]),
    ] {
        assert_eq!(public_types(source), expected, "{source}");
    }
}
