//! What the house promises of its own code, read from the sources: that imports run downwards, that files are short or say
//! why not, and that who names a family or a language outside of its file says why. It knows Rust's `use` lines and paths
//! as text, and nothing of what they mean.

use crate::command::metadata;
use crate::repository;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use zonal_codegen::families::text::family_names;

/// The packages whose imports are looked at, by the folder of their sources.
pub const SOURCES: [&str; 11] = [
    "bake/src",
    "cache/src",
    "codegen/src",
    "cli/src",
    "explorer/src",
    "measure/src",
    "picture/src",
    "render/src",
    "runtime/src",
    "tests/src",
    "tests/gpu/src",
];

/// Where families and languages may be named without a word: where they are made, listed and read.
const THEIR_OWN: [&str; 2] = ["codegen/src/families/", "codegen/src/emit/language/"];

/// The most lines of a file that does not say why it is longer, with the words *One file:* in its head.
pub const LONGEST: usize = 500;

/// The Rust files below a folder of the repository, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.expect("an entry can be read").path())
        .flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] })
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect();
    found.sort();
    found
}

/// A file's text without its unit tests.
fn text_of(path: &Path) -> String {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    match text.find("\n#[cfg(test)]\nmod tests") {
        Some(end) => text[..end].to_owned(),
        None => text,
    }
}

/// The module that a file is, by its path below the sources: nothing for the root of a library or a program.
fn module_of(path: &Path) -> Vec<String> {
    let mut parts: Vec<String> =
        path.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        parts.pop();
    }
    parts
}

/// The paths of a use tree, with what stands before its braces before each of its parts.
fn expand(tree: &str) -> Vec<String> {
    let Some((head, rest)) = tree.split_once('{') else { return vec![tree.trim().to_owned()] };
    let inner = rest.rsplit_once('}').map_or(rest, |(inner, _)| inner);
    let (mut parts, mut depth, mut start) = (Vec::new(), 0, 0);
    for (i, c) in inner.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                parts.push(&inner[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    parts.push(&inner[start..]);
    parts
        .iter()
        .filter(|part| !part.trim().is_empty())
        .flat_map(|part| expand(&format!("{head}{}", part.trim())))
        .collect()
}

/// The paths that a text names, from `crate`, `super` or a child module on.
fn paths(text: &str, children: &BTreeSet<String>) -> Vec<String> {
    let code: String =
        text.lines().filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect();
    let mut found = Vec::new();
    for (at, _) in code.match_indices("use ") {
        let tree = code[at + 4..].split(';').next().unwrap_or_default();
        found.extend(expand(&tree.replace('\n', " ")));
    }
    for start in ["crate::", "super::"] {
        for (at, _) in code.match_indices(start) {
            let path: String =
                code[at..].chars().take_while(|c| c.is_alphanumeric() || matches!(c, '_' | ':')).collect();
            // A path before braces is expanded above.
            if !path.ends_with("::") {
                found.push(path);
            }
        }
    }
    let begins = |path: &String| path.split("::").next().is_some_and(|first| children.contains(first));
    found.retain(|path| path.starts_with("crate::") || path.starts_with("super::") || begins(path));
    found
}

/// For every file of a package's sources those that it imports from, by their paths below the sources.
pub fn imports(sources: &str) -> BTreeMap<String, BTreeSet<String>> {
    let folder = repository(sources);
    let all = files(&folder);
    let below = |path: &PathBuf| path.strip_prefix(&folder).expect("lies below").to_owned();
    let modules: BTreeMap<Vec<String>, String> = all
        .iter()
        .map(|path| (module_of(&below(path)), below(path).to_string_lossy().into_owned()))
        .filter(|(module, _)| !module.is_empty())
        .collect();
    let mut graph = BTreeMap::new();
    for path in &all {
        let own = module_of(&below(path));
        let children = modules.keys().filter(|module| module.len() == own.len() + 1 && module.starts_with(&own));
        let children: BTreeSet<String> = children.map(|module| module[own.len()].clone()).collect();
        let name = below(path).to_string_lossy().into_owned();
        let mut targets = BTreeSet::new();
        for found in paths(&text_of(path), &children) {
            let mut parts: Vec<String> = found.split("::").map(|part| part.trim().to_owned()).collect();
            let mut absolute: Vec<String> = match parts[0].as_str() {
                "crate" => vec![],
                "super" => own[..own.len().saturating_sub(1)].to_vec(),
                _ => own.clone(),
            };
            if matches!(parts[0].as_str(), "crate" | "super") {
                parts.remove(0);
            }
            while parts.first().is_some_and(|part| part == "super") {
                absolute.pop();
                parts.remove(0);
            }
            absolute.extend(parts);
            // The longest beginning that is a module.
            let target = (1..=absolute.len()).rev().find_map(|length| modules.get(&absolute[..length]));
            targets.extend(target.filter(|target| **target != name).cloned());
        }
        graph.insert(name, targets);
    }
    graph
}

/// The files of a package so that each imports only from those after it, or a circle.
///
/// # Errors
///
/// The files of a circle, in order.
pub fn downwards(graph: &BTreeMap<String, BTreeSet<String>>) -> Result<Vec<String>, Vec<String>> {
    fn visit(
        file: &str,
        graph: &BTreeMap<String, BTreeSet<String>>,
        open: &mut Vec<String>,
        done: &mut Vec<String>,
    ) -> Result<(), Vec<String>> {
        if done.iter().any(|known| known == file) {
            return Ok(());
        }
        if let Some(start) = open.iter().position(|known| known == file) {
            return Err(open[start..].to_vec());
        }
        open.push(file.to_owned());
        for target in graph.get(file).into_iter().flatten() {
            visit(target, graph, open, done)?;
        }
        open.pop();
        done.push(file.to_owned());
        Ok(())
    }
    let (mut open, mut done) = (Vec::new(), Vec::new());
    for file in graph.keys() {
        visit(file, graph, &mut open, &mut done)?;
    }
    done.reverse();
    Ok(done)
}

/// The files that are longer than [`LONGEST`] lines and do not say why in their head.
pub fn too_long() -> Vec<(String, usize)> {
    let all = SOURCES.iter().chain(&[
        "tests/tests",
        "tests/gpu/tests",
        "bake/tests",
        "cache/tests",
        "measure/tests",
        "render/tests",
    ]);
    let mut found = Vec::new();
    for folder in all {
        for path in files(&repository(folder)) {
            let text = std::fs::read_to_string(&path).expect("a source can be read");
            let head: Vec<&str> = text.lines().take_while(|line| line.starts_with("//!")).collect();
            let lines = text.lines().count();
            if lines > LONGEST && !head.iter().any(|line| line.contains("One file:")) {
                let name = path.strip_prefix(repository("")).unwrap_or(&path).to_string_lossy().into_owned();
                found.push((name, lines));
            }
        }
    }
    found
}

/// A place that names a family or a language outside of its own file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named {
    /// The file and the line.
    pub place: String,
    /// `family` or `language`.
    pub what: &'static str,
    /// What it says about that, if anything.
    pub reason: Option<String>,
}

/// Whether a line imports a language, or reaches for one by its path.
fn names_language(line: &str) -> bool {
    let path = line.split("language::").nth(1).unwrap_or_default();
    let words = path.split(|c: char| !c.is_alphanumeric() && c != '_').collect::<Vec<_>>();
    ["WGSL", "GLSL", "RUST", "wgsl", "glsl", "rust"].iter().any(|name| words.contains(name))
}

/// Every place that names a family or a language outside of its own file, tests left out. A reason stands in the comment
/// above, `// Names a family: …` or `// Names a language: …`; neighbours share it, and so do lines after it that only
/// lead up to the place.
pub fn names() -> Vec<Named> {
    let folder = repository("codegen/src/families");
    let own: Vec<String> = files(&folder)
        .iter()
        .map(|path| module_of(path.strip_prefix(&folder).expect("lies below")).first().cloned().unwrap_or_default())
        .filter(|name| !["", "all", "family", "parts", "pieces", "several", "text", "toy"].contains(&name.as_str()))
        .collect();
    let specs: Vec<String> = family_names().iter().map(|name| format!("\"{name}:")).collect();
    let mut found = Vec::new();
    for sources in SOURCES.iter().filter(|sources| !sources.starts_with("tests")) {
        for path in files(&repository(sources)) {
            let name = path.strip_prefix(repository("")).unwrap_or(&path).to_string_lossy().into_owned();
            let is_test = name.ends_with("tests.rs") || THEIR_OWN.iter().any(|folder| name.starts_with(folder));
            if is_test {
                continue;
            }
            let text = text_of(&path);
            let lines: Vec<&str> = text.lines().collect();
            let what = |line: &str| -> Option<&'static str> {
                let code = line.trim_start();
                if code.starts_with("//") {
                    return None;
                }
                let family = own.iter().any(|file| {
                    code.match_indices(&format!("families::{file}")).any(|(at, path)| {
                        !code[at + path.len()..].starts_with(|c: char| c.is_alphanumeric() || c == '_')
                    })
                });
                let spec = sources.starts_with("codegen")
                    && (specs.iter().any(|spec| code.contains(spec)) || code.contains("usual(\""));
                match (family || spec, names_language(code)) {
                    (true, _) => Some("family"),
                    (_, true) => Some("language"),
                    _ => None,
                }
            };
            for (at, line) in lines.iter().enumerate() {
                let Some(what) = what(line) else { continue };
                let marker = format!("// Names a {what}: ");
                // Up to the marker, over neighbours and the lines of one statement or one comment.
                let above = lines[..at].iter().rev().take(14).take_while(|line| !line.trim().is_empty());
                let own = above.take(14).find_map(|line| line.trim_start().strip_prefix(&marker));
                found.push(Named { place: format!("{name}:{}", at + 1), what, reason: own.map(str::to_owned) });
            }
        }
    }
    found
}

/// A library or a program of the workspace as cargo knows it.
#[derive(Clone, Debug, serde::Deserialize)]
pub struct Target {
    kind: Vec<String>,
    /// Its first file.
    src_path: PathBuf,
    /// Whether cargo looks for unit tests in it.
    pub test: bool,
    /// Whether cargo looks for examples in its documentation.
    pub doctest: bool,
}

/// All libraries and programs of the workspace.
///
/// # Panics
///
/// If cargo does not list them.
pub fn targets() -> Vec<Target> {
    #[derive(serde::Deserialize)]
    struct Package {
        targets: Vec<Target>,
    }
    #[derive(serde::Deserialize)]
    struct Workspace {
        packages: Vec<Package>,
    }
    let workspace: Workspace = serde_json::from_value(metadata()).expect("packages have targets");
    let targets = workspace.packages.into_iter().flat_map(|package| package.targets);
    targets.filter(|target| target.kind.iter().any(|kind| kind == "lib" || kind == "bin")).collect()
}

/// What of a target cargo is told not to look for and is there all the same: its file, and what was found.
pub fn overlooked(target: &Target) -> Vec<String> {
    let folder = target.src_path.parent().expect("a file is in a folder");
    let of_target = match target.kind.iter().any(|kind| kind == "lib") {
        true => files(folder),
        false => vec![target.src_path.clone()],
    };
    let mut found = Vec::new();
    for (looks, mark) in [(target.test, "#[test]"), (target.doctest || target.kind == ["bin"], "/// ```")] {
        let has = |path: &&PathBuf| {
            std::fs::read_to_string(path).is_ok_and(|text| text.lines().any(|line| line.trim_start().starts_with(mark)))
        };
        if !looks {
            found.extend(of_target.iter().filter(has).map(|path| format!("{}: {mark}", path.display())));
        }
    }
    found
}
