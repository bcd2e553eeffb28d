//! Circles of a directed graph.

use std::collections::{BTreeMap, BTreeSet};

/// The largest sets of names of which each leads to each other one.
pub fn circles(edges: &BTreeSet<(String, String)>) -> Vec<Vec<String>> {
    let mut reached: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (from, to) in edges {
        reached.entry(from).or_default().insert(to);
    }
    // Each round lets a name reach what the names that it reaches reach.
    for _ in edges {
        let last = reached.clone();
        for names in reached.values_mut() {
            let further = names.iter().filter_map(|name| last.get(name)).flatten();
            *names = names
                .iter()
                .chain(&further.copied().collect::<BTreeSet<_>>())
                .copied()
                .collect();
        }
        if last == reached {
            break;
        }
    }
    let mut circles: Vec<Vec<String>> = Vec::new();
    for (name, names) in &reached {
        let known = circles.iter().flatten().any(|known| known == name);
        if names.contains(name) && !known {
            let back = |other: &&&str| reached.get(**other).is_some_and(|n| n.contains(name));
            circles.push(names.iter().filter(back).map(|n| (*n).to_owned()).collect());
        }
    }
    circles
}
