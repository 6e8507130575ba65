//! The sections `include` and `exports`.

use super::Reader;
use super::field::Field;
use crate::diagnostic::Edit;
use crate::grammar::{EXPORTS, INCLUDE_KEYS};
use crate::groups::{BAD_ENTRY, BAD_EXPORT};
use crate::habits;
use crate::model::{ExportModel, IncludeModel};
use crate::source::Spanned;
use crate::suggest::similar;
use crate::yaml::{Node, NodeKind};
use scl_text::list::quoted_list;

/// Whether a key is `file` misspelt, or its name in other tools.
fn is_file(key: &str) -> bool {
    habits::FILE.contains(&habits::compact(key).as_str()) || !similar(key, [INCLUDE_KEYS[0]]).is_empty()
}

impl Reader<'_> {
    pub(super) fn read_includes(&mut self, section: Field<'_>) -> Vec<IncludeModel> {
        let NodeKind::Sequence { items } = &section.value.kind else {
            let files = self.read_files(section, "included file", "a file");
            return files.into_iter().map(IncludeModel::plain).collect();
        };
        items.iter().filter_map(|item| self.read_include(item)).collect()
    }

    fn read_include(&mut self, item: &Node) -> Option<IncludeModel> {
        let NodeKind::Mapping { entries } = &item.kind else {
            return self.name(item, "included file", "a file").map(IncludeModel::plain);
        };
        let fields = self.fields(entries, "this entry of `include`");
        let [file, group] = INCLUDE_KEYS;
        let file_meant = fields.list.iter().copied().find(|field| fields.get(file).is_none() && is_file(field.key));
        for field in fields.list.iter().filter(|field| !INCLUDE_KEYS.contains(&field.key)) {
            // It may be the name of the group.
            self.model.components_unread = true;
            let found =
                BAD_ENTRY.at(format!("unknown key `{}` in an entry of `include`", field.key), field.key_span, "");
            let found = match fields.get(group) {
                _ if file_meant.is_some_and(|meant| meant.key_span == field.key_span) => {
                    found.propose(format!("write `{file}`"), [Edit::new(field.key_span, file)])
                }
                // Whatever a path has beside it is the name of the group.
                None => found.propose(format!("write `{group}`"), [Edit::new(field.key_span, group)]),
                Some(_) => found.did_you_mean(field.key, &similar(field.key, INCLUDE_KEYS)),
            };
            self.report(found.note(format!("keys: {}", quoted_list(INCLUDE_KEYS))));
        }
        let name = match fields.get(group) {
            Some(field) => match self.name_in(field, "name of the group") {
                Some(name) => Some(name),
                None => {
                    self.model.components_unread = true;
                    return None;
                }
            },
            None => None,
        };
        let Some(field) = fields.get(file).or(file_meant) else {
            self.model.cut_off = true;
            if !fields.damaged {
                let found = BAD_ENTRY.at("an entry of `include` names no file", item.span, "no `file`");
                self.report(found.help("write `file:` and the path, or the path alone"));
            }
            return None;
        };
        let file = self.name_in(field, "included file")?;
        Some(IncludeModel { file, group: name, span: item.span })
    }

    /// `{command: planner.command}`, or a list of such entries.
    pub(super) fn read_exports(&mut self, section: Field<'_>) {
        match &section.value.kind {
            NodeKind::Mapping { entries } => self.read_export_entries(entries),
            NodeKind::Sequence { items } => {
                for item in items {
                    match &item.kind {
                        NodeKind::Mapping { entries } => self.read_export_entries(entries),
                        NodeKind::Unread => {}
                        _ => self.report_export(item),
                    }
                }
            }
            NodeKind::Unread => self.model.cut_off = true,
            _ if section.value.is_null() => {}
            _ => self.report_export(section.value),
        }
    }

    fn read_export_entries(&mut self, entries: &[(Node, Node)]) {
        let fields = self.fields(entries, &format!("`{EXPORTS}`"));
        for field in fields.list {
            let name = Spanned { value: field.key.to_owned(), span: field.key_span };
            if let Some(gate) = self.name_in(field, "gate") {
                self.model.exports.push(ExportModel { name, gate });
            }
        }
    }

    fn report_export(&mut self, node: &Node) {
        let found =
            BAD_EXPORT.at(format!("`{EXPORTS}` gives gates a name for the outside"), node.span, "no name and gate");
        let found = match node.text().and_then(|text| Some((text, scl_text::gate_name::split(text)?.1))) {
            Some((gate, name)) => {
                let written = format!("{{{name}: {gate}}}");
                found.propose(format!("write `{written}`"), [Edit::new(node.span, written)])
            }
            None => found,
        };
        self.report(found.otherwise("write `exports: {command: planner.command}`"));
    }
}
