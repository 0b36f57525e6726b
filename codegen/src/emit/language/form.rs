//! Forms of a file for what takes it in otherwise than as a file of its language: the text that was checked, with a line
//! before it, under another name, or without what a parser of single functions does not read.

/// A form of a language's files.
pub struct Form {
    /// Its name in scenes and on the command line.
    pub name: &'static str,
    /// The extension of its files.
    pub extension: &'static str,
    /// What takes it in.
    pub what: &'static str,
    /// The text, from the name of the file without its extension and the language's own text.
    pub text: fn(stem: &str, text: String) -> String,
}

impl PartialEq for Form {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.extension == other.extension
    }
}

impl Eq for Form {}

impl std::fmt::Debug for Form {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// What the form is called that has functions alone.
pub(super) const BARE: &str = "bare";
/// What is said of it.
pub(super) const BARE_WHAT: &str =
    "functions alone, for wgslFn and glslFn of three.js and what else reads one at a time";

/// Returns a text without its comments, which have lines of their own, and without what `drops` says.
pub(super) fn bare(text: &str, drops: impl Fn(&str) -> bool) -> String {
    let kept = text.lines().filter(|line| !line.trim_start().starts_with("//") && !drops(line));
    let mut out = String::with_capacity(text.len());
    for line in kept {
        if !(line.is_empty() && (out.is_empty() || out.ends_with("\n\n"))) {
            out.push_str(line);
            out.push('\n');
        }
    }
    out
}
