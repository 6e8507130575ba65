//! The plan as a C++ string literal.

/// A raw string literal for any text.
pub(super) fn literal(text: &str) -> String {
    let mut delimiter = "plan".to_owned();
    while text.contains(&format!("){delimiter}\"")) {
        delimiter.push('_');
    }
    format!("R\"{delimiter}({text}){delimiter}\"")
}

#[cfg(test)]
mod tests {
    use super::literal;

    #[test]
    fn no_text_ends_its_literal() {
        assert_eq!(literal("{}\n"), "R\"plan({}\n)plan\"");
        assert_eq!(literal("a)plan\"b"), "R\"plan_(a)plan\"b)plan_\"");
    }
}
