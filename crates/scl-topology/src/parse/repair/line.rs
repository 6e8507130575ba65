//! One line as words and marks, each with the brackets that are open before it.

use crate::parse::pitfall::scan;
use std::ops::Range;

/// A word, a quoted text or a single mark.
#[derive(Debug, Clone)]
pub(super) struct Token {
    pub(super) range: Range<usize>,
    pub(super) class: Class,
    /// The brackets that are open before it, the outermost first.
    pub(super) open: Vec<usize>,
}

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Class {
    Word,
    Open,
    Close,
    Comma,
    Colon,
    /// A dash with a space after it, or at the end of the line.
    Dash,
    /// A quote without a partner in the line.
    Quote,
    /// A mark that YAML does not use here: `;`, `=`, `(`, `)`.
    Other,
}

impl Token {
    /// Whether a value may end with it.
    pub(super) fn ends_value(&self) -> bool {
        matches!(self.class, Class::Word | Class::Close)
    }

    /// Whether a value may begin with it.
    pub(super) fn begins_value(&self) -> bool {
        matches!(self.class, Class::Word | Class::Open)
    }
}

/// The tokens of a line without its comment, and the brackets that are open after it.
pub(super) fn tokens(line: &Range<usize>, text: &str) -> (Vec<Token>, Vec<usize>) {
    let before = &text[..line.start];
    // The brackets that the text above leaves open: none for a line in block style.
    let mut open = scan::scan(before).open_brackets;
    let content = &text[line.clone()];
    let mut tokens = Vec::new();
    let mut at = content.len() - content.trim_start().len();
    while let Some(first) = content[at..].chars().next() {
        let length = length(&content[at..], first);
        let range = line.start + at..line.start + at + length;
        if first == '#' && (at == 0 || content[..at].ends_with([' ', '\t'])) {
            break;
        }
        if !first.is_whitespace() {
            let class = class(&content[at..], first, length);
            tokens.push(Token { range: range.clone(), class, open: open.clone() });
            match class {
                Class::Open => open.push(range.start),
                Class::Close => drop(open.pop()),
                _ => {}
            }
        }
        at += length;
    }
    (tokens, open)
}

fn length(rest: &str, first: char) -> usize {
    let quoted = |quote: char| rest[1..].find(quote).map_or(1, |end| end + 2);
    match first {
        '"' | '\'' => quoted(first),
        '[' | ']' | '{' | '}' | ',' | ';' | '=' | '(' | ')' => 1,
        '-' if rest.starts_with("->") => 2,
        '-' if !rest[1..].starts_with(char::is_alphanumeric) => 1,
        ':' if !rest.starts_with("::") => 1,
        letter if letter.is_whitespace() => letter.len_utf8(),
        _ => {
            let mut end = 0;
            let mut letters = rest.char_indices().peekable();
            while let Some((at, letter)) = letters.next() {
                let next = letters.peek().map(|(_, next)| *next);
                let ends = match letter {
                    ':' if next == Some(':') => {
                        letters.next();
                        end = at + 2;
                        continue;
                    }
                    ':' | '[' | ']' | '{' | '}' | ',' | ';' | '=' | '(' | ')' => true,
                    '"' => true,
                    letter => letter.is_whitespace(),
                };
                if ends {
                    break;
                }
                end = at + letter.len_utf8();
            }
            end.max(first.len_utf8())
        }
    }
}

fn class(rest: &str, first: char, length: usize) -> Class {
    match first {
        '[' | '{' => Class::Open,
        ']' | '}' => Class::Close,
        ',' => Class::Comma,
        ':' if length == 1 => Class::Colon,
        '-' if length == 1 && rest[1..].chars().next().is_none_or(char::is_whitespace) => Class::Dash,
        '"' | '\'' if length == 1 => Class::Quote,
        ';' | '=' | '(' | ')' => Class::Other,
        _ => Class::Word,
    }
}
