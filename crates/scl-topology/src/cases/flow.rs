//! Converts a text to flow style, as in JSON, if its mistake can be made there.

use crate::source::Sources;
use crate::yaml::{self, Node, NodeKind, Style, Tree};

pub(crate) fn of(text: &str) -> Option<String> {
    let mut sources = Sources::new();
    let file = sources.add("t.yaml", text);
    let Tree { root, error, anchors, tags, second_document, too_deep, .. } =
        yaml::read(sources.file(file).text(), file, false);
    let is_sound = error.is_none() && anchors.is_empty() && tags.is_empty() && too_deep.is_none();
    // Comments speak of lines, and there is only one here.
    let has_lines =
        second_document.is_some() || text.contains(" #") || text.starts_with(['%', '-', '#']) || text.contains('\t');
    let root = root.filter(|root| is_sound && !has_lines && matches!(root.kind, NodeKind::Mapping { .. }))?;
    let flow = written(&root, &sources)?;
    (flow != text.trim_end()).then(|| format!("{flow}\n"))
}

fn written(node: &Node, sources: &Sources) -> Option<String> {
    let snippet = sources.snippet(node.span);
    match &node.kind {
        // The mistake may be in how its lines are indented.
        _ if snippet.starts_with(['[', '{']) && snippet.contains('\n') => None,
        NodeKind::Scalar { style: Style::Block, .. } | NodeKind::Unread => None,
        NodeKind::Scalar { style, .. } => {
            let is_kept = *style == Style::Quoted || !snippet.contains(['\n', ',', '[', ']', '{', '}', '\u{3000}']);
            is_kept.then(|| snippet.to_owned())
        }
        NodeKind::Sequence { items } => {
            let items: Option<Vec<String>> = items.iter().map(|item| written(item, sources)).collect();
            let items = items.filter(|items| items.iter().all(|item| !item.is_empty()))?;
            Some(format!("[{}]", items.join(", ")))
        }
        NodeKind::Mapping { entries } => {
            let entry = |(key, value): &(Node, Node)| {
                let key = matches!(key.kind, NodeKind::Scalar { .. }).then(|| written(key, sources))??;
                let is_glued = key.contains(':') && value.span.start == value.span.end;
                (!key.is_empty() && !is_glued).then_some(())?;
                Some(format!("{key}: {}", written(value, sources)?))
            };
            let entries: Option<Vec<String>> = entries.iter().map(entry).collect();
            Some(format!("{{{}}}", entries?.join(", ")))
        }
    }
}
