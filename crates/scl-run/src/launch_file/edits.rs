//! Changes of the text of a launch file, for the proposals of problems.

use super::reader::Reader;
use super::words::flow_word;
use scl_topology::diagnostic::{Edit, removal};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;

impl Reader<'_> {
    /// What stands at a place.
    pub(super) fn written(&self, span: Span) -> &str {
        self.source.snippet(span)
    }

    /// From a key to the end of its value; `None` if the value stands elsewhere or has an anchor.
    pub(super) fn whole_entry(&self, field: Field<'_>) -> Option<Span> {
        let (key, value) = (field.key_span, field.value.span);
        let text = self.source.text();
        if value.start == value.end {
            let colon = text.get(key.end as usize..)?.find(':').filter(|at| *at < 2)?;
            return Some(Span { end: key.end + colon as u32 + 1, ..key });
        }
        let between = text.get(key.end as usize..value.start as usize)?.trim_start().strip_prefix(':')?.trim();
        // A list at the column of its key starts behind its first dash.
        (between.is_empty() || between == "-" && field.value.items().is_some()).then(|| key.to(value))
    }

    /// Removes a key with its value; `None` if it shares its line with something that stays.
    pub(super) fn remove_entry(&self, field: Field<'_>) -> Option<Edit> {
        removal(self.source, self.whole_entry(field)?)
    }

    /// Writes something else in place of a key and its value.
    pub(super) fn replace_entry(&self, field: Field<'_>, text: impl Into<String>) -> Option<Edit> {
        self.whole_entry(field).map(|span| Edit::new(span, text))
    }

    /// Adds an entry to a mapping with at least one entry.
    pub(super) fn add_entry(&self, mapping: &Node, entry: &str) -> Option<Edit> {
        let entries = mapping.entries()?;
        let (first, last) = (entries.first()?.0.span, &entries.last()?.1);
        if self.is_flow(mapping) {
            let behind = Span { start: last.span.end, ..last.span };
            let is_inside = behind.end < mapping.span.end && last.span.start > first.start && !last.is_null();
            return is_inside.then(|| Edit::new(behind, format!(", {entry}")));
        }
        let indent = " ".repeat(self.source.column(first.start));
        Some(Edit::new(Span { end: first.start, ..first }, format!("{entry}\n{indent}")))
    }

    /// As [`add_entry`](Self::add_entry), behind the last entry.
    pub(super) fn add_last(&self, mapping: &Node, entry: &str) -> Option<Edit> {
        let (key, value) = mapping.entries()?.last()?;
        let last = Field { key: key.text()?, key_span: key.span, key_node: key, value };
        self.add_behind(mapping, last, entry)
    }

    /// Adds an entry to a mapping, behind another one.
    pub(super) fn add_behind(&self, mapping: &Node, field: Field<'_>, entry: &str) -> Option<Edit> {
        if self.is_flow(mapping) {
            return self.add_entry(mapping, entry);
        }
        let (text, end) = (self.source.text(), field.value.span.end.max(field.key_span.end) as usize);
        let line_end = text.get(end..)?.find(['\r', '\n']).map_or(text.len(), |at| end + at) as u32;
        let indent = " ".repeat(self.source.column(field.key_span.start));
        Some(Edit::new(Span { start: line_end, end: line_end, ..field.key_span }, format!("\n{indent}{entry}")))
    }

    /// What stands between an entry and the next one: a line break and the indentation, or a comma.
    pub(super) fn separator_of_entries(&self, field: Field<'_>) -> String {
        let column = self.source.column(field.key_span.start);
        let line = self.source.line_text(self.source.line_column(field.key_span.start).line);
        match line.len() - line.trim_start().len() == column {
            true => format!("\n{}", " ".repeat(column)),
            false => ", ".to_owned(),
        }
    }

    /// Whether an item stands in a list in brackets, in one line with its neighbours or its bracket.
    pub(super) fn is_in_brackets(&self, item: Span) -> bool {
        let behind = self.source.text().get(item.end as usize..).unwrap_or_default().trim_start();
        behind.starts_with([']', ','])
    }

    /// Whether a list or a mapping stands in brackets.
    pub(super) fn is_flow(&self, node: &Node) -> bool {
        self.written(node.span).starts_with(['[', '{'])
    }

    /// The text of a value as it may stand in brackets. `None` for a list or a mapping of several lines, and for one
    /// with comments.
    pub(super) fn in_brackets(&self, value: &Node) -> Option<String> {
        match value.text() {
            Some(text) if value.is_plain() => Some(flow_word(text)),
            Some(text) if !self.written(value.span).starts_with(['"', '\'']) => Some(flow_word(text)),
            _ => {
                let written = self.written(value.span);
                let is_whole = value.text().is_some() || self.is_flow(value);
                (is_whole && !written.contains(['\n', '#']) && !written.is_empty()).then(|| written.to_owned())
            }
        }
    }
}
