//! Editions of protobuf, which the schema compiler does not read, and their features, which it would ignore.

use super::lexemes::Lexemes;
use super::mistake::Mistake;
use std::path::Path;

/// Reports the edition of a file, or its first feature.
pub(super) fn find(text: &str, file: &Path) -> Option<Mistake> {
    let lexemes: Vec<(usize, &str)> = Lexemes::of(text).take(3).collect();
    if let [(start, "edition"), (_, "="), (value, edition)] = lexemes.as_slice() {
        return Some(Mistake {
            file: file.display().to_string(),
            at: *start..value + edition.trim_end().len(),
            message: format!("`{}` uses an edition of protobuf, which SCL does not read yet", file.display()),
            label: "only `proto2` and `proto3` are read".to_owned(),
            help: Some("write `syntax = \"proto3\";`, and `optional` before each field that has presence".to_owned()),
            note: Some("the bytes of messages stay the same unless the file sets features".to_owned()),
            ..Mistake::default()
        });
    }
    feature(text, file)
}

/// `option features.field_presence = EXPLICIT;`, or the same in brackets.
fn feature(text: &str, file: &Path) -> Option<Mistake> {
    let mut lexemes = Lexemes::of(text).peekable();
    let mut before = "";
    while let Some((start, lexeme)) = lexemes.next() {
        let starts_option = lexeme == "features" && matches!(before, "option" | "[" | ",");
        before = lexeme;
        let Some((next, _)) = lexemes.next_if(|(_, next)| starts_option && matches!(*next, "." | "=")) else {
            continue;
        };
        let name = lexemes.next_if(|_| text[next..].starts_with('.'));
        let end = name.map_or(start + lexeme.len(), |(at, name)| at + name.len());
        let help = match name {
            Some((_, "field_presence")) => "remove it, and write `optional` before each field that has presence",
            Some((_, "repeated_field_encoding")) => "write `[packed = true]` or `[packed = false]` instead",
            _ => "remove it",
        };
        return Some(Mistake {
            file: file.display().to_string(),
            at: start..end,
            message: format!("`{}` sets a feature, which has no effect without an edition", file.display()),
            label: "a feature of an edition of protobuf".to_owned(),
            help: Some(help.to_owned()),
            note: Some("SCL reads `proto2` and `proto3`, and no editions yet".to_owned()),
            ..Mistake::default()
        });
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_are_found_where_options_are() {
        for (text, expected) in [
            ("option features.field_presence = IMPLICIT;", Some("features.field_presence")),
            ("option features = { field_presence: IMPLICIT };", Some("features")),
            ("message A { int32 a = 1 [features . enum_type = OPEN]; }", Some("features . enum_type")),
            ("message A { int32 a = 1 [deprecated = true, features.(x.y).z = 1]; }", Some("features.(")),
            ("enum E { A = 0 [/* c */ features.x = Y]; }", Some("features.x")),
            ("message A { features.B b = 1; repeated string features = 2; }", None),
            ("option (features) = 1; option java_package = \"features.a\"; reserved a, features;", None),
            ("option (a) = { b: 1, features: 2 };", None),
            ("message features {} import \"features\";", None),
            ("option features", None),
        ] {
            let found = find(text, Path::new("a.proto")).map(|mistake| &text[mistake.at]);
            assert_eq!(found, expected, "{text}");
        }
    }
}
