//! Keys of an entry that stand beside its name, because they are not indented enough.

use super::keys::Key;
use super::reader::Reader;
use super::rules::WRONG_SHAPE;
use scl_topology::diagnostic::Edit;
use scl_topology::source::Span;
use scl_topology::yaml::Node;
use std::borrow::Cow;

impl Reader<'_> {
    /// Reports `allowed` keys beside the empty entry that they belong to, and returns the other entries.
    pub(super) fn without_outdented<'n>(
        &mut self,
        entries: &'n [(Node, Node)],
        allowed: &[Key],
    ) -> Cow<'n, [(Node, Node)]> {
        let known = self.known.map(|known| known.components.as_slice()).unwrap_or_default();
        let is_key = |(name, _): &(Node, Node)| {
            let name = name.text().filter(|name| allowed.iter().any(|key| key.name == *name));
            name.is_some_and(|name| !known.iter().any(|known| known == name))
        };
        // A run of keys, and the empty entry above it.
        let is_run = |one: &(Node, Node), other: &(Node, Node)| is_key(other) && (is_key(one) || one.1.is_null());
        let runs: Vec<&[(Node, Node)]> = entries.chunk_by(is_run).collect();
        let is_outdented = |run: &&&[(Node, Node)]| run.len() > 1 && run.first().is_some_and(|first| !is_key(first));
        let found: Vec<&[(Node, Node)]> = runs.iter().filter(is_outdented).copied().collect();
        if found.is_empty() {
            return Cow::Borrowed(entries);
        }
        let inner = entries.iter().filter_map(|(_, value)| value.entries()?.first());
        let column = inner.map(|(key, _)| self.source.column(key.span.start));
        let name_column = found.first().and_then(|run| run.first()).map_or(0, |(name, _)| self.column(name));
        let column = column.filter(|column| *column > name_column).min().unwrap_or(name_column + 2);
        for run in found {
            let [(name, _), keys @ ..] = run else { continue };
            let [(first, _), others @ ..] = keys else { continue };
            let (owner, key) = (self.written(name.span), self.written(first.span));
            let message = format!("`{key}` stands beside `{owner}`, not in its entry");
            let problem = WRONG_SHAPE.at(message, first.span, "").label(name.span, "the entry without keys");
            let problem = problem.labels(others.iter().map(|(other, _)| (other.span, "this one too")));
            let text = match others.is_empty() {
                true => format!("indent `{key}` by {column} spaces, below `{owner}`"),
                false => format!("indent the keys by {column} spaces, below `{owner}`"),
            };
            let edits: Option<Vec<Vec<Edit>>> =
                keys.iter().map(|(key, value)| self.indented_to(column, key, value)).collect();
            self.report(match edits {
                Some(edits) => problem.propose(text, edits.concat()),
                None => problem.help(text),
            });
        }
        let kept = runs.into_iter().filter(|run| !is_outdented(&run)).flatten();
        Cow::Owned(kept.cloned().collect())
    }

    fn column(&self, node: &Node) -> usize {
        self.source.column(node.span.start)
    }

    /// Moves the lines of an entry, which starts its line, to a column further right.
    pub(super) fn indented_to(&self, column: usize, key: &Node, value: &Node) -> Option<Vec<Edit>> {
        let text = self.source.text();
        let indent = self.column(key);
        let line = (key.span.start as usize).checked_sub(indent)?;
        text.get(line..key.span.start as usize).filter(|before| before.trim().is_empty())?;
        let deeper = " ".repeat(column.checked_sub(indent)?);
        let whole = text.get(line..value.span.end.max(key.span.end) as usize)?;
        let breaks = whole.match_indices('\n').map(|(at, _)| line + at + 1);
        let at = |at: usize| Span { start: at as u32, end: at as u32, ..key.span };
        Some([line].into_iter().chain(breaks).map(|start| Edit::new(at(start), deeper.as_str())).collect())
    }
}
