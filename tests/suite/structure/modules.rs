//! The modules of one crate and what each uses of the others, read from its sources.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The names from the crate's root to a module; empty for the root.
pub type ModulePath = Vec<String>;

/// Where imports of imports end, should they form a loop.
const IMPORTS_FOLLOWED_MAX: usize = 8;

/// A crate's modules, test code apart.
#[derive(Default)]
pub struct Modules {
    known: BTreeSet<ModulePath>,
    /// What a name that a module imports stands for, as a path seen from that module.
    imports: BTreeMap<(ModulePath, String), Vec<String>>,
    uses: Vec<(ModulePath, Vec<String>)>,
}

impl Modules {
    /// Reads every source below a directory.
    pub fn read(source: &Path) -> Self {
        let mut modules = Self::default();
        modules.read_directory(source, &Vec::new());
        modules
    }

    fn read_directory(&mut self, directory: &Path, parent: &ModulePath) {
        for entry in fs::read_dir(directory).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
            if name == "tests" || path.ends_with("src/bin") {
                continue;
            }
            let mut module = parent.clone();
            if !["lib", "main"].contains(&name.as_str()) {
                module.push(name);
            }
            if path.is_dir() {
                self.read_directory(&path, &module);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                self.read_source(&fs::read_to_string(&path).unwrap(), &module);
            }
        }
    }

    /// Reads the source of one module.
    pub fn read_source(&mut self, source: &str, module: &[String]) {
        self.known.insert(module.to_vec());
        let tokens: TokenStream = source.parse().unwrap();
        self.read_tokens(&tokens.into_iter().collect::<Vec<_>>(), module);
    }

    fn read_tokens(&mut self, tokens: &[TokenTree], module: &[String]) {
        let mut rest = tokens;
        while let [first, after @ ..] = rest {
            rest = match first {
                TokenTree::Punct(hash) if hash.as_char() == '#' => skip_attribute(after),
                TokenTree::Group(group) => {
                    self.read_tokens(&group.stream().into_iter().collect::<Vec<_>>(), module);
                    after
                }
                TokenTree::Ident(word) if word == "use" => self.read_use(after, module),
                TokenTree::Ident(word) if word == "mod" => self.read_inline(after, module),
                TokenTree::Ident(_) => self.read_path(rest, module),
                _ => after,
            };
        }
    }

    /// A module whose body stands in its parent's file.
    fn read_inline<'a>(&mut self, tokens: &'a [TokenTree], module: &[String]) -> &'a [TokenTree] {
        let [TokenTree::Ident(name), TokenTree::Group(body), after @ ..] = tokens else {
            return tokens;
        };
        let inner = [module, &[name.to_string()]].concat();
        self.known.insert(inner.clone());
        self.read_tokens(&body.stream().into_iter().collect::<Vec<_>>(), &inner);
        after
    }

    /// A path inside of an item, such as `super::name::function`.
    fn read_path<'a>(&mut self, tokens: &'a [TokenTree], module: &[String]) -> &'a [TokenTree] {
        let (path, after) = leading_path(tokens);
        if ["crate", "super", "self"].contains(&path[0].as_str()) {
            self.uses.push((module.to_vec(), path));
        }
        after
    }

    fn read_use<'a>(&mut self, tokens: &'a [TokenTree], module: &[String]) -> &'a [TokenTree] {
        // A capture such as `impl Iterator + use<'_>` is no import.
        if tokens.first().is_some_and(|token| is(token, '<')) {
            return tokens;
        }
        let end = tokens.iter().position(|token| is(token, ';')).unwrap();
        self.read_use_tree(&tokens[..end], &[], module);
        &tokens[end..]
    }

    fn read_use_tree(&mut self, tokens: &[TokenTree], prefix: &[String], module: &[String]) {
        let (path, rest) = leading_path(tokens);
        let mut path = [prefix, &path].concat();
        match rest {
            [.., TokenTree::Group(group)] if group.delimiter() == Delimiter::Brace => {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                for tree in inner.split(|token| is(token, ',')) {
                    if !tree.is_empty() {
                        self.read_use_tree(tree, &path, module);
                    }
                }
            }
            _ => {
                if path.len() > 1 && path.last().is_some_and(|name| name == "self") {
                    path.pop();
                }
                let alias = match rest {
                    [TokenTree::Ident(_as), TokenTree::Ident(alias)] => alias.to_string(),
                    _ => path.last().unwrap().clone(),
                };
                self.imports.insert((module.to_vec(), alias), path.clone());
                self.uses.push((module.to_vec(), path));
            }
        }
    }

    /// The module that a path names or that the named item stands in, imports followed to their origin; none outside
    /// of the crate.
    fn resolve(&self, from: &[String], path: &[String], followed: usize) -> Option<ModulePath> {
        let mut module = from.to_vec();
        let inside = ["crate", "super", "self"].contains(&path[0].as_str());
        for (index, name) in path.iter().enumerate() {
            let child = [&module[..], std::slice::from_ref(name)].concat();
            let import = self.imports.get(&(module.clone(), name.clone()));
            match (name.as_str(), import) {
                ("crate", _) => module.clear(),
                ("super", _) => drop(module.pop()),
                ("self", _) => {}
                _ if self.known.contains(&child) => module = child,
                (_, Some(import)) if followed < IMPORTS_FOLLOWED_MAX && import != path => {
                    let path = [import, &path[index + 1..]].concat();
                    return self.resolve(&module, &path, followed + 1);
                }
                _ if index == 0 && !inside => return None,
                _ => break,
            }
        }
        Some(module)
    }

    /// Which sibling uses which, by their parent.
    pub fn sibling_uses(&self) -> BTreeMap<ModulePath, BTreeSet<(String, String)>> {
        let mut siblings: BTreeMap<ModulePath, BTreeSet<(String, String)>> = BTreeMap::new();
        for (from, path) in &self.uses {
            let Some(to) = self.resolve(from, path, 0) else {
                continue;
            };
            let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
            if let (Some(user), Some(used)) = (from.get(common), to.get(common)) {
                let uses = siblings.entry(from[..common].to_vec()).or_default();
                uses.insert((user.clone(), used.clone()));
            }
        }
        siblings
    }
}

fn is(token: &TokenTree, punctuation: char) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == punctuation)
}

/// What follows an attribute; after `#[cfg(test)]` also its item is left out.
pub fn skip_attribute(tokens: &[TokenTree]) -> &[TokenTree] {
    let [TokenTree::Group(attribute), after @ ..] = tokens else {
        return tokens;
    };
    if attribute.stream().to_string().replace(' ', "") != "cfg(test)" {
        return after;
    }
    let ends = |token: &TokenTree| {
        is(token, ';')
            || matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace)
    };
    let end = after.iter().position(ends).unwrap();
    &after[end + 1..]
}

/// The names of a path at the beginning of the tokens, and what follows it.
fn leading_path(tokens: &[TokenTree]) -> (Vec<String>, &[TokenTree]) {
    let mut path = Vec::new();
    let mut rest = tokens;
    while let [TokenTree::Ident(name), after @ ..] = rest {
        path.push(name.to_string());
        rest = after;
        match after {
            [first, second, more @ ..] if is(first, ':') && is(second, ':') => rest = more,
            _ => break,
        }
    }
    (path, rest)
}
