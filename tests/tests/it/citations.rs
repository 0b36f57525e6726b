//! The repository cites `docs/MATH.md` by heading, and nothing that a reader does not have.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use zonal_tests::repository;

/// What is cited.
const DOCUMENT: &str = "docs/MATH.md";
/// How a citation of it begins.
const CITATION: &str = concat!("MATH", ".md#");
/// How citations began that no reader could follow: numbers of sections and of papers that are not in the repository.
const UNREADABLE: [&str; 4] =
    [concat!("MATH", " section"), concat!("MATH", ":"), concat!("paper", " 00"), concat!("Paper", " 00")];
/// Folders whose text is made by a program or is not the repository's.
const LEFT_OUT: [&str; 3] = ["target", "generated", "node_modules"];

/// The text files below a folder that may cite.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries {
        let entry = entry.expect("an entry of a folder can be read");
        let (path, name) = (entry.path(), entry.file_name());
        let name = name.to_string_lossy();
        if entry.file_type().expect("an entry has a type").is_dir() {
            if !name.starts_with('.') && !LEFT_OUT.contains(&name.as_ref()) {
                files(&path, found);
            }
        } else if [".rs", ".tera", ".md"].iter().any(|end| name.ends_with(end)) {
            found.push(path);
        }
    }
}

/// The anchor that GitHub gives a heading: small letters, spaces as hyphens, neither punctuation nor markup.
fn slug(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
}

/// The anchors of a document's headings, a repeated one once.
fn anchors(text: &str) -> HashSet<String> {
    let headings = text.lines().filter(|line| line.starts_with('#'));
    headings.map(|line| slug(line.trim_start_matches('#'))).collect()
}

/// What follows each occurrence of `start` in a line, as far as it is an anchor.
fn cited<'a>(line: &'a str, start: &str) -> Vec<&'a str> {
    let is_part = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_');
    line.split(start).skip(1).map(|rest| rest.split(|c| !is_part(c)).next().unwrap_or("")).collect()
}

#[test]
fn every_citation_of_the_mathematics_can_be_followed() {
    let root = repository("").canonicalize().expect("the repository is there");
    let document = root.join(DOCUMENT);
    let text = std::fs::read_to_string(&document).expect("the document can be read");
    let known = anchors(&text);
    let mut all = Vec::new();
    files(&root, &mut all);
    all.sort();
    let (mut citations, mut faults) = (0, Vec::new());
    for path in all.iter().filter(|path| **path != document) {
        let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        for (number, line) in text.lines().enumerate() {
            let place = format!("{}:{}", path.strip_prefix(&root).unwrap_or(path).display(), number + 1);
            for anchor in cited(line, CITATION) {
                citations += 1;
                if !known.contains(anchor) {
                    faults.push(format!("{place}: {DOCUMENT} has no heading `#{anchor}`"));
                }
            }
            for wording in UNREADABLE.iter().filter(|wording| line.contains(**wording)) {
                faults.push(format!("{place}: `{wording}` names nothing that a reader has: {}", line.trim()));
            }
        }
    }
    for (number, line) in text.lines().enumerate() {
        for anchor in cited(line, "](#").into_iter().filter(|anchor| !known.contains(*anchor)) {
            faults.push(format!("{DOCUMENT}:{}: it has no heading `#{anchor}`", number + 1));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(citations > 20, "only {citations} citations were found in {} files", all.len());
}

#[test]
fn anchors_are_those_of_github() {
    for (heading, anchor) in [
        ("The tilt", "the-tilt"),
        ("Bands 1 and 2 of the tilt", "bands-1-and-2-of-the-tilt"),
        ("Set-up from a quaternion", "set-up-from-a-quaternion"),
        ("`zhf`: lobes, and Â", "zhf-lobes-and-â"),
    ] {
        assert_eq!(slug(heading), anchor);
    }
    assert_eq!(cited("see docs/MATH.md#the-tilt), or (docs/MATH.md#lights).", "#"), ["the-tilt", "lights"]);
}
