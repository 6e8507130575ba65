//! The rules of all stages, so that a comment in a file can name any of them.

use super::RULES;
use crate::diagnostic::Rule;
use crate::{diagnostic, everyone, external, groups, join, kinds, parse};
use std::sync::LazyLock;

/// All rules, sorted by code.
pub static ALL: LazyLock<Vec<&'static Rule>> = LazyLock::new(|| {
    let groups = [
        parse::PITFALLS,
        parse::SHAPES,
        kinds::RULES,
        everyone::RULES,
        join::RULES,
        groups::RULES,
        RULES,
        &[&diagnostic::TOO_MANY],
        external::RULES,
    ];
    let mut all = groups.concat();
    all.sort_by_key(|rule| rule.code);
    all
});

/// Returns the rule with this code, in upper or lower case.
pub fn find(code: &str) -> Option<&'static Rule> {
    ALL.iter().copied().find(|rule| rule.code.eq_ignore_ascii_case(code))
}
