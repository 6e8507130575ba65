//! Keys of a gate that are rather a part of a value, or that hold a value: a comma or a missing colon cut them off.

use crate::habits;
use crate::parse::field::{Field, Fields};
use crate::parse::words::{is_kind, is_option};
use crate::source::Spanned;

/// `{rep: Request, Reply}`: the second type of an exchange, as a key behind the first.
pub(super) fn second_type<'n>(
    kind: Field<'_>,
    payload: Option<&Spanned<String>>,
    fields: &Fields<'n>,
) -> Option<Field<'n>> {
    let payload = payload.filter(|payload| matches!(kind.key, "req" | "rep") && !payload.value.contains("->"))?;
    let is_type = |key: &str| key.chars().next().is_some_and(char::is_uppercase) || key.contains('.');
    let is_second =
        |field: &&Field<'_>| field.value.is_null() && is_type(field.key) && field.key_span.start >= payload.span.end;
    fields.list.iter().find(is_second).copied()
}

/// `{pub: (A, B)}`, `{pub: Map<A, B>}`: the keys that belong to the type, up to the bracket that ends it.
pub(super) fn rest_of_type<'f, 'n>(kind: Field<'_>, fields: &'f Fields<'n>) -> &'f [Field<'n>] {
    let depth = |text: &str| {
        let text = text.replace("->", "").replace("=>", "");
        text.matches(['(', '<']).count() as isize - text.matches([')', '>']).count() as isize
    };
    let mut open = kind.value.text().filter(|_| kind.value.is_plain()).map_or(0, depth);
    let Some(at) = fields.list.iter().position(|field| field.key_span == kind.key_span).filter(|_| open > 0) else {
        return &[];
    };
    let rest = &fields.list[at + 1..];
    let end = rest.iter().take_while(|field| field.value.is_null()).position(|field| {
        open += depth(field.key);
        open <= 0
    });
    end.map_or(&[], |end| &rest[..=end])
}

/// `{sub: Type, queue: 1,000}`: options with a number, and the key that is the rest of it, behind a comma.
pub(super) fn cut_numbers<'n>(fields: &Fields<'n>) -> Vec<(Field<'n>, Field<'n>)> {
    let starts_with_digit = |text: &str| text.starts_with(|letter: char| letter.is_ascii_digit());
    let is_number = |field: &Field<'_>| is_option(field.key) && field.value.text().is_some_and(starts_with_digit);
    let is_rest = |field: &Field<'_>| field.value.is_null() && starts_with_digit(field.key);
    let pairs = fields.list.windows(2).filter(|pair| is_number(&pair[0]) && is_rest(&pair[1]));
    pairs.map(|pair| (pair[0], pair[1])).collect()
}

/// `{pub: Type, doc: One, two}`: the keys after the first comma of a text without quotes.
pub(super) fn rest_of_doc<'f, 'n>(fields: &'f Fields<'n>) -> &'f [Field<'n>] {
    let is_doc = |field: &Field<'_>| field.key == "doc" && field.value.is_plain() && !field.value.is_null();
    let Some(doc) = fields.list.iter().position(is_doc) else { return &[] };
    let rest = &fields.list[doc + 1..];
    let is_option = |field: &Field<'_>| is_kind(field.key) || is_option(field.key);
    let is_text = |field: &Field<'_>| field.value.is_null() && field.key_node.is_plain() && !is_option(field);
    &rest[..rest.iter().take_while(|field| is_text(field)).count()]
}

/// `{pub Type, queue 4}`: the keys that lack their colon, so that the value belongs to the key, each with the word up
/// to its end and the key that is meant.
pub(super) fn glued_keys<'n>(fields: &Fields<'n>) -> Vec<(Field<'n>, &'n str, &'n str)> {
    let known = |field: &Field<'n>| {
        let word = first_word(field.key);
        if !field.value.is_null() || word.len() == field.key.len() || !field.key_node.is_plain() {
            return None;
        }
        let bare = word.trim_start_matches(['.', '-', '$']);
        match is_kind(bare) || is_option(bare) {
            true => Some(bare),
            false if !field.key.contains('=') => None,
            false => habits::GATE.find(word)?.ways.first().copied().filter(|way| is_option(way)),
        }
    };
    fields.list.iter().filter_map(|field| Some((*field, first_word(field.key), known(field)?))).collect()
}

/// Whether a field is one of several that follow each other.
pub(super) fn is_in(fields: &[Field<'_>], field: &Field<'_>) -> bool {
    let at = field.key_span.start;
    matches!(fields, [first, .., last] | [first @ last] if (first.key_span.start..=last.key_span.start).contains(&at))
}

/// The word up to a space or an equals sign.
fn first_word(key: &str) -> &str {
    key.split([' ', '=']).next().unwrap_or(key)
}
