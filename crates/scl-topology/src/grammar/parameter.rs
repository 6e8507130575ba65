//! The types and keys of parameters.

use scl_plan::Scalar;

/// The key of the parameters of a component.
pub const PARAMETERS: &str = "parameters";

/// The type of a parameter that is one of several words.
pub const ONE_OF: &str = "one_of";

/// The type of a parameter that is a list.
pub const LIST: &str = "list";

/// The types: those of single values, then the others.
pub const TYPES: [&str; Scalar::WORDS.len() + 2] = {
    let mut types = [ONE_OF; Scalar::WORDS.len() + 2];
    let mut at = 0;
    while at < Scalar::WORDS.len() {
        types[at] = Scalar::WORDS[at];
        at += 1;
    }
    types[at + 1] = LIST;
    types
};

/// The key of a parameter that can be changed while the program runs.
pub const LIVE: &str = "live";

/// The keys beside the type.
pub const PARAMETER_KEYS: [&str; 6] = ["default", "range", "length", "unit", "doc", LIVE];

/// The longest list of a fixed length.
pub(crate) const LONGEST_LIST: u32 = 10_000;

/// Reads the length of a list; `None` if it is out of range.
pub(crate) fn length(text: &str) -> Option<u32> {
    text.parse().ok().filter(|length| (1..=LONGEST_LIST).contains(length))
}
