//! Changes of a list of files or folders at the top level, for proposals.

use super::Edit;
use crate::source::{SourceFile, Span, Spanned};
use scl_text::list::quoted_list;

/// The longest list that is written out, in bytes.
const LONGEST: usize = 80;

/// The change that adds an item to the list of a section, and what to write, as in
/// `` write `schemas: [a.proto, b.proto]` ``. `None` if the list is not written as one, or the item would need quotes.
pub fn appended(source: &SourceFile, key: &str, items: &[Spanned<String>], item: &str) -> Option<(String, Edit)> {
    let (first, last) = (items.first()?.span, items.last()?.span);
    if !is_plain(item) {
        return None;
    }
    let line = source.line_range(last.start as usize);
    let head = source.text().get(line.start..last.start as usize)?;
    if source.text().get(..first.start as usize)?.trim_end().ends_with('[') {
        let all: Vec<&str> = items.iter().map(|item| source.snippet(item.span)).chain([item]).collect();
        let whole = format!("{key}: [{}]", all.join(", "));
        let text = if whole.len() > LONGEST {
            format!("add {} to `{key}`", quoted_list([item]))
        } else {
            format!("write `{whole}`")
        };
        return Some((text, Edit::new(Span { start: last.end, ..last }, format!(", {item}"))));
    }
    let indent = head.strip_suffix("- ").filter(|indent| indent.trim().is_empty())?;
    let rest = source.text().get(last.end as usize..line.end)?.trim_end();
    let end = last.end + rest.len() as u32;
    let edit = Edit::new(Span { start: end, end, ..last }, format!("\n{indent}- {item}"));
    Some((format!("add `- {item}` to `{key}`"), edit))
}

/// The change that adds a section with a list of one item above the section `below`, of which `within` is a part, and
/// what to write.
pub fn new_list(source: &SourceFile, below: &str, within: Span, key: &str, item: &str) -> Option<(String, Edit)> {
    let at = source.text().get(..within.start as usize)?.rfind(below)?;
    if !is_plain(item) || source.line_range(at).start != at {
        return None;
    }
    let section = format!("{key}: [{item}]");
    let span = Span { start: at as u32, end: at as u32, ..within };
    Some((format!("add `{section}`"), Edit::new(span, format!("{section}\n"))))
}

/// What stands between two items of the list that has an item here. `None` if the item shares its line with a key.
pub fn separator(source: &SourceFile, item: Span) -> Option<String> {
    let line = source.line_range(item.start as usize);
    let head = source.text().get(line.start..item.start as usize)?;
    match head.strip_suffix("- ") {
        Some(indent) if indent.trim().is_empty() => Some(format!("\n{indent}- ")),
        _ => head.trim_end().ends_with(['[', ',']).then(|| ", ".to_owned()),
    }
}

/// Whether a path needs no quotes in a list.
fn is_plain(item: &str) -> bool {
    let is_letter = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-' | '.' | '/');
    item.starts_with(|letter: char| letter.is_alphanumeric() || letter == '.') && item.chars().all(is_letter)
}

#[cfg(test)]
mod tests {
    use super::{appended, new_list};
    use crate::advice::apply;
    use crate::diagnostic::Diagnostics;
    use crate::parse::parse;
    use crate::source::Sources;

    #[test]
    fn an_item_is_added_in_the_style_of_its_list() {
        for (before, text, after) in [
            ("schemas: [a.proto]\n", "write `schemas: [a.proto, b.proto]`", "schemas: [a.proto, b.proto]\n"),
            (
                "schemas: [\n  a.proto,\n]\n",
                "write `schemas: [a.proto, b.proto]`",
                "schemas: [\n  a.proto, b.proto,\n]\n",
            ),
            ("schemas:\n- 'a.proto'  # A\n", "add `- b.proto` to `schemas`", "schemas:\n- 'a.proto'  # A\n- b.proto\n"),
            ("schemas:\n  - a.proto", "add `- b.proto` to `schemas`", "schemas:\n  - a.proto\n  - b.proto"),
            ("schemas: a.proto\n", "", ""),
        ] {
            let mut sources = Sources::new();
            let file = sources.add("", before);
            let mut problems = Diagnostics::new();
            let model = parse(&sources, file, &mut problems);
            problems.discard();
            let source = sources.file(file);
            let told = appended(source, "schemas", &model.schemas, "b.proto")
                .map(|(told, edit)| (told, apply(before, &[&edit]).unwrap()));
            assert_eq!(told.unwrap_or_default(), (text.to_owned(), after.to_owned()));
            assert_eq!(appended(source, "schemas", &model.schemas, "b c"), None);
            let above = new_list(source, "schemas", model.schemas[0].span, "schema_roots", "proto");
            let above = above.map(|(_, edit)| apply(before, &[&edit]).unwrap());
            assert_eq!(above.unwrap(), format!("schema_roots: [proto]\n{before}"));
        }
    }
}
