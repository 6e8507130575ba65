//! The Rust names that components and gates get.

/// Words that are keywords in some edition from 2015 to 2024, or reserved for one to come; sorted.
const KEYWORDS: [&str; 48] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "do", "dyn", "else", "enum",
    "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod", "move",
    "mut", "override", "priv", "pub", "ref", "return", "static", "struct", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// Words that stay keywords even with `r#` before them.
const UNESCAPABLE: [&str; 5] = ["crate", "self", "Self", "super", "_"];

/// The type of a component: `user_interface` and `user-interface` become `UserInterface`, `left_arm.planner` becomes
/// `LeftArmPlanner`; capitals stay as they are.
pub fn component_type(name: &str) -> String {
    let mut out = String::with_capacity(name.len());
    for word in name.split(['_', '-', '.']) {
        let mut letters = word.chars();
        if let Some(first) = letters.next() {
            out.push(first.to_ascii_uppercase());
            out.push_str(letters.as_str());
        }
    }
    if out.is_empty() || out.starts_with(|first: char| first.is_ascii_digit()) {
        out.insert(0, '_');
    }
    out
}

/// The field of a gate, without `r#`: `setPoint` and `set-point` become `set_point`. Of a component, the word for it in
/// names of functions: `left_arm.planner` becomes `left_arm_planner`.
pub fn gate_field(name: &str) -> String {
    if name.bytes().all(|byte| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_') {
        return name.to_owned();
    }
    let mut out = String::with_capacity(name.len() + 4);
    let letters: Vec<char> = name.chars().collect();
    for (at, &letter) in letters.iter().enumerate() {
        if letter.is_ascii_uppercase() && starts_word(&letters, at) {
            out.push('_');
        }
        out.push(if matches!(letter, '-' | '.') { '_' } else { letter.to_ascii_lowercase() });
    }
    out
}

/// A capital starts a word after a small letter or a digit, and as the last of several capitals: `GPSFix` is `gps_fix`.
fn starts_word(letters: &[char], at: usize) -> bool {
    let Some(&before) = at.checked_sub(1).and_then(|at| letters.get(at)) else { return false };
    let next_is_small = letters.get(at + 1).is_some_and(char::is_ascii_lowercase);
    before.is_ascii_lowercase() || before.is_ascii_digit() || (before.is_ascii_uppercase() && next_is_small)
}

/// Whether a field of this name is written with `r#`.
pub fn is_keyword(name: &str) -> bool {
    KEYWORDS.binary_search(&name).is_ok()
}

/// Whether the word cannot be a name even with `r#`.
pub fn is_unescapable(name: &str) -> bool {
    UNESCAPABLE.contains(&name)
}

/// A type name that would suit a gate, for examples that can be pasted: `measurements` gives `Measurement`.
pub(crate) fn example_type(gate: &str) -> String {
    let name = component_type(gate);
    match name.strip_suffix('s') {
        Some(singular) if singular.len() > 1 && !singular.ends_with(['s', 'u', 'i']) => singular.to_owned(),
        _ => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_become_types() {
        let cases = [
            ("user_interface", "UserInterface"),
            ("user-interface", "UserInterface"),
            ("pySysMoCo", "PySysMoCo"),
            ("left_arm.planner", "LeftArmPlanner"),
            ("GPS_", "GPS"),
            ("_1", "_1"),
            ("_", "_"),
        ];
        for (name, expected) in cases {
            assert_eq!(component_type(name), expected);
        }
    }

    #[test]
    fn every_keyword_is_found() {
        assert!(KEYWORDS.iter().all(|word| is_keyword(word)) && !is_keyword("sensor"));
    }

    #[test]
    fn gates_become_fields() {
        let cases = [
            ("core_mon", "core_mon"),
            ("set-point", "set_point"),
            ("setPoint", "set_point"),
            ("GPSFix", "gps_fix"),
            ("v2Data", "v2_data"),
            ("_x", "_x"),
            ("A_B", "a_b"),
            ("left_arm.mainPlanner", "left_arm_main_planner"),
        ];
        for (name, expected) in cases {
            assert_eq!(gate_field(name), expected);
        }
    }

    #[test]
    fn example_types_are_singular() {
        for (gate, expected) in [
            ("measurements", "Measurement"),
            ("set-point", "SetPoint"),
            ("pass", "Pass"),
            ("status", "Status"),
            ("s", "S"),
        ] {
            assert_eq!(example_type(gate), expected);
        }
    }
}
