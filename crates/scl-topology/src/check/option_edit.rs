//! Changes of a gate's options, for proposals.

use super::draft::Draft;
use crate::diagnostic::{Edit, removal};
use crate::source::Span;

impl Draft<'_> {
    /// The change that gives a gate an option, or another value of it.
    pub(super) fn with_option(&self, gate: usize, key: &str, value: &str) -> Edit {
        let draft = &self.gates[gate];
        let (model, kind) = (draft.model, draft.model.kind.span);
        if let Some(option) = draft.option(key) {
            return Edit::new(option.value.span, value);
        }
        let file = self.sources.file(kind.file);
        let head = Span { start: model.name.span.end, end: kind.start, ..kind };
        let end = Span { start: model.span.end, ..model.span };
        let last = model.options.last().map(|option| option.value.span);
        let end = last.or(model.payload.as_ref().map(|payload| payload.span)).map_or(end, |last| Span {
            start: last.end,
            end: last.end,
            ..last
        });
        match file.snippet(head) {
            head if head.contains(['{', ',']) => Edit::new(end, format!(", {key}: {value}")),
            head if head.contains('\n') => {
                let indent = file.column(kind.start);
                Edit::new(end, format!("\n{}{key}: {value}", " ".repeat(indent)))
            }
            _ => Edit::new(kind, format!("{{{}: , {key}: {value}}}", file.snippet(kind))),
        }
    }

    /// The change that removes an option of a gate, if it has the option and it can be removed.
    pub(super) fn without_option(&self, gate: usize, key: &str) -> Option<Edit> {
        let option = self.gates[gate].option(key)?;
        let entry = option.key.span.to(option.value.span);
        removal(self.sources.file(entry.file), entry)
    }
}
