//! Topology files as a [`Dialect`].

use super::dialect::Dialect;
use super::document::Document;
use super::words::{COMPONENT_KEYS, SECTIONS, is_kind, known_word};
use super::{Reader, shape};
use crate::diagnostic::{Diagnostic, Severity};
use crate::kinds;
use crate::model::Model;
use crate::source::SourceFile;

/// Topology files.
pub(super) static TOPOLOGY: Dialect = Dialect {
    noun: "topology",
    minimal: "components:\n  - name: sensor\n    gates:\n      - measurements: pub",
    levels: 6,
    has_aliases: false,
    instead_of_merge: "write the keys out",
    is_key: |word| SECTIONS.contains(&word) || COMPONENT_KEYS.contains(&word),
    word: known_word,
    mistakes,
};

fn mistakes(document: &Document, source: &SourceFile) -> usize {
    let mut reader = Reader::new(source);
    reader.read_root(document);
    let Reader { model, problems, .. } = reader;
    let found = problems.into_sorted();
    // A part of a file may contain only one section, so missing sections do not count.
    let counts =
        |found: &&Diagnostic| found.severity == Severity::Error && found.code() != shape::missing::SECTION.code;
    found.iter().filter(counts).count() + implausible(&model)
}

/// Number of gates, components, kinds and ends that have the right shape, but implausible words in it.
fn implausible(model: &Model) -> usize {
    let is_name = |name: &str| {
        let is_letter = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-');
        name.chars().all(is_letter) && !name.starts_with('-')
    };
    let is_type = |written: &str| {
        written.split("->").all(|part| !part.trim().contains(|c: char| c.is_whitespace() || "[]{},;#".contains(c)))
    };
    let owners = || model.components.iter().chain(&model.kinds);
    let gates = owners().flat_map(|owner| &owner.gates);
    let odd_gates = gates.filter(|gate| {
        let kind = &gate.kind.value;
        !is_name(&gate.name.value)
            || !kind.is_empty() && !is_kind(kind)
            || gate.payload.as_ref().is_some_and(|payload| !is_type(&payload.value))
    });
    let are_names = |text: &str| text.split('.').all(|name| !name.is_empty() && is_name(name));
    let odd_owners = owners().filter(|owner| !are_names(&owner.name.value));
    let is_end = |end: &str| {
        let end = kinds::each_of(end).unwrap_or(end);
        end.contains('.') && are_names(end)
    };
    let odd_ends = model.connections.iter().flat_map(|pair| &pair.ends).filter(|end| !is_end(&end.value));
    odd_gates.count() + odd_owners.count() + odd_ends.count()
}
