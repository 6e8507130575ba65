//! SCL0211: connections whose two ends stand on lines of their own.

use super::ends::RULE;
use crate::diagnostic::{Diagnostic, Edit};
use crate::source::{SourceFile, Span, Spanned};
use crate::yaml::Node;

/// The ends of a list of names, two by two; `None` if it is another kind of list.
pub(in crate::parse) fn of(items: &[Node]) -> Option<Vec<[Spanned<String>; 2]>> {
    let end = |item: &Node| {
        let text = item.text().filter(|_| item.is_plain())?;
        let is_name = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || "_-".contains(c));
        (text.contains('.') && text.split('.').all(is_name))
            .then(|| Spanned { value: text.to_owned(), span: item.span })
    };
    let (pairs, rest) = items.as_chunks::<2>();
    let pairs = pairs.iter().map(|[first, second]| Some([end(first)?, end(second)?])).collect::<Option<Vec<_>>>()?;
    (!pairs.is_empty() && rest.is_empty()).then_some(pairs)
}

/// All of them are one mistake.
pub(in crate::parse) fn diagnose(pairs: &[[Spanned<String>; 2]], source: &SourceFile) -> Option<Diagnostic> {
    let [first, second] = pairs.first()?;
    let whole = |[first, second]: &[Spanned<String>; 2]| Span { end: second.span.end, ..first.span };
    let problem = RULE
        .at("the two ends of a connection stand in one entry", first.span, "one end")
        .label(second.span, "the other end, in an entry of its own");
    let more = if pairs.len() > 1 { ", and join the other entries two by two in the same way" } else { "" };
    let help = format!("write `- [{}, {}]`{more}", first.value, second.value);
    // A comment between the two would be lost.
    if pairs.iter().any(|pair| source.snippet(whole(pair)).contains('#')) {
        return Some(problem.help(help));
    }
    let joined =
        |pair: &[Spanned<String>; 2]| Edit::new(whole(pair), format!("[{}, {}]", pair[0].value, pair[1].value));
    Some(problem.suggest(help, pairs.iter().map(joined)).otherwise(super::ends::FORM))
}
