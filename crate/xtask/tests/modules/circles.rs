//! Which modules of a crate use each other in a circle.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;

use crate::source::{Module, read};

/// A way through re-exports longer than this leads nowhere.
const MOST_REEXPORTS: usize = 16;

/// A line of one module that names what another defines.
struct Arrow {
    from: usize,
    to: usize,
    line: usize,
    path: String,
}

/// Every circle in the crate with this root file, each as a text that names its files and lines.
///
/// A module *uses* another when its source, outside tests, has a path to something that the other defines. A
/// path through a re-export counts as a use of the module that defines the name. `mod` alone is no use. A
/// call of a method names no module and is not seen.
///
/// The rule: among the modules that stand side by side in one module, none comes back to itself by what it
/// and the modules within it use. The crate root counts as one of the modules that it declares. So `a` and
/// `a/x` may use each other, because `a/x` stands within `a`. `a/x` and `a/y` may not, and neither may `a`
/// and `b`: once anything in `a` uses anything in `b`, nothing in `b` may use anything in `a`.
pub(crate) fn circles(root: &Path) -> Vec<String> {
    let modules = read(root);
    let mut levels: BTreeMap<Option<usize>, Vec<(Arrow, [usize; 2])>> = BTreeMap::new();
    for arrow in arrows(&modules) {
        if let Some((level, rooms)) = rooms(&modules, &arrow) {
            levels.entry(level).or_default().push((arrow, rooms));
        }
    }
    let folder = root.parent().unwrap_or(Path::new(""));
    levels.values().flat_map(|arrows| circles_among(&modules, arrows, folder)).collect()
}

fn arrows(modules: &[Module]) -> Vec<Arrow> {
    let mut arrows = Vec::new();
    for (from, module) in modules.iter().enumerate() {
        for mention in &module.mentions {
            // The crate root itself, where a path ends there, is no definition.
            let Some(to) = defining_module(modules, from, &mention.path, MOST_REEXPORTS) else { continue };
            let through = mention.path.first().and_then(|first| module.imports.get(first));
            let imported = through.and_then(|import| defining_module(modules, from, import, MOST_REEXPORTS));
            // The import says so already.
            if imported != Some(to) {
                arrows.push(Arrow { from, to, line: mention.line, path: mention.path.join("::") });
            }
        }
    }
    arrows
}

/// The module that defines what a path within the module `from` names, if it is of this crate.
fn defining_module(modules: &[Module], from: usize, path: &[String], reexports: usize) -> Option<usize> {
    let (first, rest) = path.split_first()?;
    match first.as_str() {
        "crate" => definition(modules, 0, rest, reexports),
        "self" => definition(modules, from, rest, reexports),
        "super" => definition(modules, modules[from].parent?, rest, reexports),
        // A name by itself came by an import, which has been counted, or was defined here.
        _ if rest.is_empty() && reexports == MOST_REEXPORTS => None,
        _ => definition(modules, from, path, reexports),
    }
}

/// As [`defining_module`], for a path that begins in `module` itself.
fn definition(modules: &[Module], module: usize, path: &[String], reexports: usize) -> Option<usize> {
    let Some((first, rest)) = path.split_first() else { return Some(module).filter(|&module| module != 0) };
    let here = &modules[module];
    if first == "super" {
        return definition(modules, here.parent?, rest, reexports);
    }
    if let Some(&child) = here.children.get(first) {
        // What is not found there comes from a macro or another crate, by way of the child.
        return definition(modules, child, rest, reexports).or(Some(child));
    }
    if here.items.contains(first) {
        return Some(module);
    }
    let reexports = reexports.checked_sub(1)?;
    if let Some(import) = here.imports.get(first) {
        let whole: Vec<String> = import.iter().chain(rest).cloned().collect();
        return imported(modules, module, &whole, first, reexports);
    }
    here.globs.iter().find_map(|glob| {
        let whole: Vec<String> = glob.iter().chain(path).cloned().collect();
        defining_module(modules, module, &whole, reexports)
    })
}

/// Where an import leads; one of another crate's name, as `use toml;`, leads out.
fn imported(
    modules: &[Module],
    module: usize,
    path: &[String],
    name: &str,
    reexports: usize,
) -> Option<usize> {
    if path.first().is_some_and(|first| first == name) && !modules[module].children.contains_key(name) {
        return None;
    }
    defining_module(modules, module, path, reexports)
}

/// The module that holds both ends of an arrow, `None` for the crate itself, and the two rooms side by side
/// in it that the arrow joins; none where one end is within the other.
fn rooms(modules: &[Module], arrow: &Arrow) -> Option<(Option<usize>, [usize; 2])> {
    let (from, to) = (rooms_above(modules, arrow.from), rooms_above(modules, arrow.to));
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let level = shared.checked_sub(1).map(|last| from[last]);
    Some((level, [*from.get(shared)?, *to.get(shared)?]))
}

/// The rooms that hold a module, from the one in the crate root to its own.
fn rooms_above(modules: &[Module], module: usize) -> Vec<usize> {
    let mut rooms = vec![module];
    while let Some(parent) = modules[rooms[rooms.len() - 1]].parent.filter(|&parent| parent != 0) {
        rooms.push(parent);
    }
    rooms.reverse();
    rooms
}

fn circles_among(modules: &[Module], arrows: &[(Arrow, [usize; 2])], folder: &Path) -> Vec<String> {
    let mut next: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for (_, [from, to]) in arrows {
        next.entry(*from).or_default().insert(*to);
    }
    let reached: BTreeMap<usize, BTreeSet<usize>> =
        next.keys().map(|&room| (room, reached_from(&next, room))).collect();
    let comes_back = |a: usize, b: usize| {
        reached.get(&a).is_some_and(|all| all.contains(&b))
            && reached.get(&b).is_some_and(|all| all.contains(&a))
    };
    let circles: BTreeSet<Vec<usize>> = reached
        .keys()
        .map(|&room| reached.keys().copied().filter(|&other| comes_back(room, other)).collect::<Vec<_>>())
        .filter(|circle| circle.len() > 1)
        .collect();
    let named = |module: usize| {
        let file = &modules[module].file;
        file.strip_prefix(folder).unwrap_or(file).display().to_string()
    };
    circles
        .iter()
        .map(|circle| {
            let rooms: Vec<String> = circle.iter().map(|&room| named(room)).collect();
            let mut text = format!("a circle of {}\n", rooms.join(", "));
            let mut lines: BTreeMap<(String, usize, String), Vec<&str>> = BTreeMap::new();
            for (arrow, [from, to]) in arrows {
                if from != to && circle.contains(from) && circle.contains(to) {
                    let line = (named(arrow.from), arrow.line, named(arrow.to));
                    lines.entry(line).or_default().push(&arrow.path);
                }
            }
            for ((from, line, to), paths) in lines {
                // A String takes whatever is written to it.
                let _ = writeln!(text, "  {from}:{line} uses {to}: {}", paths.join(", "));
            }
            text
        })
        .collect()
}

fn reached_from(next: &BTreeMap<usize, BTreeSet<usize>>, room: usize) -> BTreeSet<usize> {
    let mut reached = BTreeSet::new();
    let mut waiting = vec![room];
    while let Some(room) = waiting.pop() {
        waiting.extend(next.get(&room).into_iter().flatten().filter(|&&other| reached.insert(other)));
    }
    reached
}
