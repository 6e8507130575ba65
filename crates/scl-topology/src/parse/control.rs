//! Comments for the checker, such as `# scl: allow(SCL0701) reason`.

use super::Reader;
use crate::model::ControlModel;
use crate::source::{Span, Spanned};
use crate::yaml::{Node, NodeKind, Style};

const MARK: &str = "scl:";

/// How many comments and empty lines may stand between a comment and the line that it is about.
const MOST_BETWEEN: usize = 32;

impl Reader<'_> {
    /// Finds the comments in the text itself, but not in quotes or text blocks.
    pub(super) fn read_controls(&mut self, root: Option<&Node>) {
        let text = self.source.text();
        let mut candidates = text.match_indices(MARK).filter_map(|(at, _)| comment_before(text, at)).peekable();
        if candidates.peek().is_none() {
            return;
        }
        let mut texts = Vec::new();
        root.into_iter().for_each(|root| collect_texts(root, &mut texts));
        let mut line_end = 0;
        for (hash, start) in candidates {
            let next = texts.partition_point(|text: &Span| (text.start as usize) <= hash);
            let in_text = next > 0 && hash < texts[next - 1].end as usize;
            // A second mark in the same comment belongs to the text of the first.
            if !in_text && hash >= line_end {
                line_end = self.source.line_range(hash).end;
                let control = self.control(hash, start);
                self.model.controls.push(control);
            }
        }
    }

    fn control(&self, hash: usize, start: usize) -> ControlModel {
        let source = self.source;
        let line = source.line_range(hash);
        let own = source.line(hash);
        let value = source.text()[start..line.end].trim_end().to_owned();
        let span = source.span(start..start + value.len());
        let stands_alone = source.text()[line.start..hash].trim().is_empty();
        let below = source.text()[line.end..].split('\n').skip(1).take(MOST_BETWEEN);
        let is_skipped = |line: &&str| line.trim().is_empty() || line.trim_start().starts_with('#');
        let skipped = if stands_alone { below.take_while(is_skipped).count() as u32 + 1 } else { 0 };
        ControlModel { text: Spanned { value, span }, line: own + skipped }
    }
}

/// The `#` before a mark, and the place of the mark, where nothing but spaces stands between the two.
fn comment_before(text: &str, mark: usize) -> Option<(usize, usize)> {
    let before = text[..mark].trim_end_matches([' ', '\t']);
    let hash = before.strip_suffix('#')?;
    (hash.is_empty() || hash.ends_with([' ', '\t', '\n', '\r'])).then_some((hash.len(), mark))
}

/// The places of quoted texts and text blocks, in file order. The depth of the tree bounds the recursion.
fn collect_texts(node: &Node, texts: &mut Vec<Span>) {
    match &node.kind {
        NodeKind::Scalar { style: Style::Quoted | Style::Block, .. } => texts.push(node.span),
        NodeKind::Scalar { .. } | NodeKind::Unread => {}
        NodeKind::Sequence { items } => items.iter().for_each(|item| collect_texts(item, texts)),
        NodeKind::Mapping { entries } => entries.iter().for_each(|(key, value)| {
            collect_texts(key, texts);
            collect_texts(value, texts);
        }),
    }
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::parse_text;

    #[test]
    fn only_comments_are_read() {
        let text = "# scl: a\n# more\n\ncomponents: # scl: b\n  - name: x\n    doc: \"# scl: c\"\n    gates: []\n  \
                    - name: w # or # scl: d\n    doc: |\n      # scl: e\n      text\n    gates: [] #scl: f  \r\n# scl: g\n";
        let (model, _, sources) = parse_text(text);
        let found: Vec<_> = model
            .controls
            .iter()
            .map(|control| (control.text.value.as_str(), sources.snippet(control.text.span), control.line))
            .collect();
        let expected = [("scl: a", 4), ("scl: b", 4), ("scl: d", 8), ("scl: f", 12), ("scl: g", 15)];
        assert_eq!(found, expected.map(|(text, line)| (text, text, line)));
    }
}
