//! What the rules about YAML itself need to know about the kind of file that they check.

use super::document::Document;
use crate::source::SourceFile;

/// A kind of YAML file. The rules about YAML (`SCL01xx`) hold for each of them; what they say and propose differs.
#[derive(Debug)]
pub struct Dialect {
    /// What messages call such a file: `topology`.
    pub noun: &'static str,
    /// A minimal file, for the message about an empty one.
    pub minimal: &'static str,
    /// How many levels of lists and mappings it needs.
    pub levels: usize,
    /// Whether `*alias` stands for the value with the `&anchor`.
    pub has_aliases: bool,
    /// What to write in place of the merge key `<<`.
    pub instead_of_merge: &'static str,
    /// Whether a word is a key that may stand alone in its line, before its value.
    pub is_key: fn(&str) -> bool,
    /// Looks a word up among the keys and values that the format knows.
    pub word: fn(&str) -> Option<&'static str>,
    /// The number of mistakes in a text without syntax errors: of several ways to correct one, the best leaves the
    /// fewest.
    pub mistakes: fn(&Document, &SourceFile) -> usize,
}
