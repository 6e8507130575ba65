//! Changes of a gate's kind, type and options, for proposals.

use super::draft::Draft;
use crate::diagnostic::{Edit, removal};
use crate::grammar;
use crate::source::Span;
use crate::topology::GateKind;

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

    /// The changes that give a gate another kind and, if it has a type, these types, without the options that the new
    /// kind does not have.
    pub(super) fn with_kind(&self, gate: usize, kind: GateKind, types: Option<&str>) -> Option<Vec<Edit>> {
        let (model, old) = (self.gates[gate].model, self.gates[gate].kind?);
        let mut edits = vec![Edit::new(model.kind.span, kind.word())];
        if let (Some(written), Some(types)) = (&model.payload, types) {
            edits.push(Edit::new(written.span, self.sources.quoted_as(written.span, types)));
        }
        for option in &model.options {
            let key = option.key.value.as_str();
            if grammar::option(key).is_some_and(|option| option.fits(old) && !option.fits(kind)) {
                edits.push(self.without_option(gate, key)?);
            }
        }
        Some(edits)
    }

    /// The change that gives an untyped gate a type.
    pub(super) fn with_type(&self, gate: usize, types: &str) -> Option<Edit> {
        let kind = self.gates[gate].model.kind.span;
        let file = self.sources.file(kind.file);
        let rest = file.text().get(kind.end as usize..)?;
        let Some(value) = rest.strip_prefix(':') else {
            return Some(Edit::new(kind, format!("{{{}: {types}}}", file.snippet(kind))));
        };
        let value = value.split([',', '}', '\r', '\n']).next()?;
        let start = kind.end + 1;
        let place = Span { start, end: start + value.len() as u32, ..kind };
        matches!(value.trim(), "" | "~" | "null").then(|| Edit::new(place, format!(" {types}")))
    }

    /// A gate's whole entry after some changes of it, if it is short and stands in one line.
    pub(super) fn entry_with(&self, gate: usize, edits: &[Edit]) -> Option<String> {
        let span = self.gates[gate].model.span;
        let mut entry = self.sources.snippet(span).to_owned();
        let mut sorted: Vec<&Edit> = edits.iter().collect();
        sorted.sort_by_key(|edit| std::cmp::Reverse(edit.span.start));
        for edit in sorted {
            let at = edit.span.start.checked_sub(span.start)? as usize..edit.span.end.checked_sub(span.start)? as usize;
            entry.get(at.clone())?;
            entry.replace_range(at, &edit.replacement);
        }
        (entry.len() <= LONGEST_ENTRY && !entry.contains('\n')).then_some(entry)
    }
}

/// Maximum length of an entry that a help writes out, in bytes.
const LONGEST_ENTRY: usize = 120;
