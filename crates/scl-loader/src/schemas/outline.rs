//! The names that a schema file declares, as far as they can be seen without compiling it.
//!
//! While a schema is broken, programs that use its messages must not get errors saying that these do not exist.

use super::lexemes;

/// The package of a schema file and the messages and enums in it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Outline {
    /// For example `rover.v1`; empty if there is none.
    pub package: String,
    /// The messages and enums; a nested one is preceded by the names of the messages around it: `["Pose", "Axis"]`.
    pub types: Vec<Vec<String>>,
}

/// Types nested deeper than this are left out: no schema has them, and each level needs a module.
const DEEPEST: usize = 8;

/// More types than this are left out.
const MOST: usize = 10_000;

/// Reads the outline of any text.
pub(super) fn outline(text: &str) -> Outline {
    let mut outline = Outline::default();
    // For each open brace, the message that it belongs to, or `None` if it opens something else.
    let mut open: Vec<Option<String>> = Vec::new();
    let mut words: Vec<&str> = Vec::new();
    for token in lexemes::words(text) {
        match token {
            ";" => {
                if let (["package", name @ ..], true) = (words.as_slice(), open.is_empty()) {
                    outline.package = name.concat();
                }
                words.clear();
            }
            "{" => {
                let declared = match words.as_slice() {
                    [.., "message", name] => Some((*name, true)),
                    [.., "enum", name] => Some((*name, false)),
                    _ => None,
                };
                if let Some((name, _)) = declared {
                    outline.declare(&open, name);
                }
                open.push(declared.filter(|(_, is_message)| *is_message).map(|(name, _)| name.to_owned()));
                words.clear();
            }
            "}" => {
                open.pop();
                words.clear();
            }
            word => {
                // A statement has few words, but a file that is not a schema may have any number.
                if words.len() < 100 {
                    words.push(word);
                }
            }
        }
    }
    outline
}

impl Outline {
    /// The full names of the messages and enums.
    pub(super) fn full_names(&self) -> impl Iterator<Item = String> {
        self.types.iter().map(|path| match self.package.as_str() {
            "" => path.join("."),
            package => format!("{package}.{}", path.join(".")),
        })
    }

    fn declare(&mut self, open: &[Option<String>], name: &str) {
        if open.len() >= DEEPEST || self.types.len() >= MOST {
            return;
        }
        let outer: Option<Vec<String>> = open.iter().cloned().collect();
        if let Some(mut path) = outer {
            path.push(name.to_owned());
            self.types.push(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_seen_in_broken_files() {
        let text = "syntax = \"proto3\"; // package no;\npackage rover . v1;\n/* message No {} */\nmessage Pose {\n  \
                    message Axis { enum Kind { A = 0; } double x 1; }\n  oneof o { string message = 2; }\n}\n\
                    enum Level { LOW = 0; }\nservice S { rpc Do(message) returns (enum) {} }\nmessage Late {";
        let found = outline(text);
        assert_eq!(found.package, "rover.v1");
        let names: Vec<String> = found.types.iter().map(|path| path.join(".")).collect();
        assert_eq!(names, ["Pose", "Pose.Axis", "Pose.Axis.Kind", "Level", "Late"]);
    }

    #[test]
    fn any_text_has_an_outline() {
        let nested = "message A {".repeat(100_000);
        for text in
            ["", "\"", "'\n", "/*", "//", "}", "message", "message {", "package", "ä{", "message \u{1F600} {", &nested]
        {
            outline(text);
        }
        assert_eq!(outline(&nested).types.len(), DEEPEST);
    }
}
