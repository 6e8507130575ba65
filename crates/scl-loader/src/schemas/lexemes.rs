//! The words, strings and punctuation of a schema file, as far as they can be seen without compiling it.

/// Words, strings and punctuation with their offsets, without comments.
pub(super) struct Lexemes<'t> {
    text: &'t str,
    at: usize,
}

/// Words and punctuation, without comments and strings.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    Lexemes::of(text).map(|(_, lexeme)| lexeme).filter(|lexeme| !is_string(lexeme))
}

/// Whether a lexeme is a string. Its quotes are part of the lexeme.
pub(super) fn is_string(lexeme: &str) -> bool {
    lexeme.starts_with(['"', '\''])
}

impl<'t> Lexemes<'t> {
    pub(super) fn of(text: &'t str) -> Self {
        Self { text, at: 0 }
    }

    fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }
}

impl<'t> Iterator for Lexemes<'t> {
    type Item = (usize, &'t str);

    fn next(&mut self) -> Option<(usize, &'t str)> {
        loop {
            self.at = self.text.len() - self.rest().trim_start().len();
            let (start, rest) = (self.at, self.rest());
            let first = rest.chars().next()?;
            let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
            let is_comment = rest.starts_with("//") || rest.starts_with("/*");
            let length = match first {
                '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
                '/' if is_comment => rest[2..].find("*/").map_or(rest.len(), |end| end + 4),
                '"' | '\'' => string_length(rest, first),
                _ if is_word(first) => rest.find(|letter| !is_word(letter)).unwrap_or(rest.len()),
                _ => first.len_utf8(),
            };
            self.at += length;
            if !is_comment {
                return Some((start, &rest[..length]));
            }
        }
    }
}

/// Returns the length of the string at the start of `text`. An unterminated string ends with its line.
fn string_length(text: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (at, letter) in text.char_indices().skip(1) {
        match letter {
            '\n' => return at + 1,
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            _ if letter == quote => return at + 1,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lexemes_keep_their_places() {
        let text = "import /* a; */ \"b.proto\"; // c\nd.e = 'f\n";
        let expected =
            [(0, "import"), (16, "\"b.proto\""), (25, ";"), (32, "d"), (33, "."), (34, "e"), (36, "="), (38, "'f\n")];
        assert_eq!(Lexemes::of(text).collect::<Vec<_>>(), expected);
        assert_eq!(words(text).collect::<String>(), "import;d.e=");
    }

    #[test]
    fn comments_and_strings_end_where_the_language_says() {
        let cases = [("/*/ a */ b", "b"), (r#""a\" b" c"#, "c"), ("'\\", ""), ("/*/", ""), ("\"a\\\nb", "b")];
        for (text, expected) in cases {
            assert_eq!(words(text).collect::<String>(), expected, "{text}");
        }
    }
}
