//! Names that the languages which are asked for take and naga keeps: one check, over the tables of what each reserves.

use crate::emit::language::Target;

/// What a name is for, which decides how strict its check is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    /// A function or a constant, whose name must survive every compiler.
    Item,
    /// The stem of files, which is part of an include guard too.
    Stem,
}

/// Returns why a name cannot be used in some of the languages and what to do, or nothing.
pub fn fault(name: &str, purpose: Use, targets: &[Target]) -> Option<(String, String)> {
    let rule = "write ASCII letters, digits and single underscores, beginning with a letter";
    let fault = |why: &str, help: &str| Some((format!("`{name}` {why}"), help.to_owned()));
    let mut chars = name.chars();
    let begins = chars.next().is_some_and(|c| c.is_ascii_alphabetic());
    if !begins || !chars.all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return fault("is no identifier", rule);
    }
    if name.len() > 64 {
        return fault("is longer than 64 characters", "shorten it");
    }
    if let Some((why, help)) = targets.iter().find_map(|language| (language.refuses)(name)) {
        return fault(why, help);
    }
    if name.ends_with('_') {
        return fault("ends in an underscore", rule);
    }
    let mut tables = targets.iter().flat_map(|language| language.reserved);
    if let Some(table) = tables.find(|table| table.words.split_whitespace().any(|word| word == name)) {
        return fault(&format!("is {}", table.what), "choose another name, with a prefix perhaps");
    }
    let renaming = targets.iter().find(|language| language.renames_digits);
    if let (Use::Item, Some(language), true) = (purpose, renaming, name.ends_with(|c: char| c.is_ascii_digit())) {
        return fault(
            &format!("ends in a digit, and naga renames such a function in {}", language.title),
            &format!("end it in a letter, as in `{name}_fn`, or put the number first"),
        );
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::language;

    #[cfg(feature = "check")]
    #[test]
    fn everything_that_naga_reserves_is_refused() {
        for word in naga::keywords::wgsl::RESERVED {
            assert!(fault(word, Use::Item, &language::ALL).is_some(), "{word}");
        }
    }

    #[test]
    fn every_word_of_the_tables_is_refused_and_says_why() {
        let tables = language::ALL.iter().flat_map(|language| language.reserved);
        for word in tables.flat_map(|table| table.words.split_whitespace()) {
            let (message, _) = fault(word, Use::Stem, &language::ALL).unwrap();
            assert!(message.contains("reserved") || message.contains("built-in"), "{message}");
        }
        for word in ["sampler2D", "isampler2DArray", "uimageBuffer", "gl_city", "GL_city", "samplerCube"] {
            assert!(fault(word, Use::Stem, &language::ALL).unwrap().0.contains("reserved"), "{word}");
        }
    }

    #[test]
    fn shapes_of_names() {
        for (name, part) in [
            ("", "no identifier"),
            ("5th", "no identifier"),
            ("_x", "no identifier"),
            ("a-b", "no identifier"),
            ("größe", "no identifier"),
            ("a__b", "`__`"),
            ("a_", "underscore"),
            ("vec3", "digit"),
            ("sh5", "digit"),
        ] {
            assert!(fault(name, Use::Item, &language::ALL).unwrap().0.contains(part), "{name}");
        }
        assert_eq!(fault("sh5_rotate", Use::Item, &language::ALL), None);
        assert_eq!(fault("scene2", Use::Stem, &language::ALL), None);
    }

    #[test]
    fn a_name_is_refused_only_where_its_language_is_asked_for() {
        for (name, language) in
            [("light0", &language::WGSL), ("texture", &language::WGSL), ("gl_city", &language::GLSL)]
        {
            assert!(fault(name, Use::Item, &[language]).is_some(), "{name}");
            assert_eq!(fault(name, Use::Item, &[&language::RUST]), None);
        }
    }
}
