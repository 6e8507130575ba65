//! Names from files of other programs, in texts.

/// Maximum length of a name in a text, in characters.
const LONGEST: usize = 200;

/// Shortens a name and escapes its control characters.
pub(super) fn shown(name: &str) -> String {
    let mut shown: String = name.chars().take(LONGEST).flat_map(char::escape_debug).collect();
    if name.chars().nth(LONGEST).is_some() {
        shown.push('…');
    }
    shown
}
