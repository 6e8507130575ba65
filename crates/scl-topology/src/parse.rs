//! Turns a text into a [`Model`], and reports a problem for every malformed part.
//!
//! The parser never stops at a problem: a gate without a kind does not end its component, and if a text is not valid
//! YAML, the part before the error is kept.

mod component;
mod connection;
mod control;
mod dialect;
mod document;
mod entry;
mod exchange;
mod extension;
mod field;
mod fields;
mod gate;
mod include;
mod meant;
mod name;
mod option;
mod parameter;
mod pitfall;
mod repair;
mod sections;
mod shape;
mod shared_gate;
mod syntax_error;
#[cfg(test)]
mod testing;
mod topology_dialect;
mod words;

pub use dialect::Dialect;
pub use document::Document;
pub use field::{Field, Fields};
pub use fields::fields;
pub use meant::meant_values;
pub(crate) use parameter::{LIST_FORM, NO_PARAMETER};
pub(crate) use pitfall::habit::template::{FILL_IN, placeholder};
pub(crate) use pitfall::look_alike::LETTER;
pub(crate) use pitfall::{MISREAD, RULES as PITFALLS};
pub(crate) use shape::RULES as SHAPES;

use crate::diagnostic::{Diagnostic, Diagnostics, Edit};
use crate::model::Model;
use crate::source::{FileId, SourceFile, Sources, Span, Spanned};
use crate::suggest::Searches;
use crate::yaml::{self, Node, NodeKind};
use crate::{everyone, kinds};
use entry::Entry;
use topology_dialect::TOPOLOGY;

/// Reads a topology that is one file: [`parse_part`] and [`complete`].
///
/// ```
/// use scl_topology::{diagnostic::{Diagnostics, render}, parse::parse, source::Sources};
///
/// let mut sources = Sources::new();
/// let file = sources.add("topology.yaml", "components:\n  - name: 1.10\n    gates: []\n");
/// let mut problems = Diagnostics::new();
/// let model = parse(&sources, file, &mut problems);
/// assert_eq!(model.components.len(), 1);
/// let problems = problems.into_sorted();
/// assert!(render(&problems[0], &sources).starts_with("error: [SCL0109] a name is expected here"));
/// ```
pub fn parse(sources: &Sources, file: FileId, problems: &mut Diagnostics) -> Model {
    let mut model = parse_part(sources, file, Part::Main, problems);
    complete(&mut model, sources, problems);
    model
}

/// Which of the files of a system is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The topology file itself.
    Main,
    /// A file that another one includes. It need not have any section.
    Included,
}

/// Reads one file as it is written, without those that it includes.
///
/// Malformed parts are left out of the model, and each of them is reported in `problems`: all of `SCL01xx` and
/// `SCL02xx`. After a syntax error, the model holds what precedes it, and only problems of the text itself are
/// reported, as the others may be its consequences. Takes linear time and does not panic, whatever the text.
pub fn parse_part(sources: &Sources, file: FileId, part: Part, problems: &mut Diagnostics) -> Model {
    let source = sources.file(file);
    let document = read_document(source, &TOPOLOGY, problems);
    let mut reader = Reader::new(source);
    reader.part = part;
    reader.read_root(&document);
    reader.read_controls(document.root.as_ref());
    let Reader { model, problems: found, .. } = reader;
    // Problems with the shape may follow from a syntax error, so report them only if the whole text could be read.
    match document.is_partial {
        true => found.discard(),
        false => problems.append(found),
    }
    model
}

/// Gives each component the gates and connections of its kind and of `everyone`, once all files of a system are joined.
///
/// What is wrong with kinds and `everyone` is reported in `problems`: all of `SCL13xx` and `SCL14xx`.
pub fn complete(model: &mut Model, sources: &Sources, problems: &mut Diagnostics) {
    // What is missing may be in the part of a file that could not be read.
    let is_partial = model.cut_off;
    let mut found = Diagnostics::new();
    everyone::expand(model, sources, &mut found);
    kinds::expand(model, sources, &mut found);
    match is_partial {
        true => found.discard(),
        false => problems.append(found),
    }
}

/// Reads a YAML file of any kind, and reports what is wrong with the text itself: all of `SCL01xx` that does not depend
/// on what the values mean.
///
/// Takes linear time and does not panic, whatever the text.
pub fn read_document(source: &SourceFile, dialect: &Dialect, problems: &mut Diagnostics) -> Document {
    let text = pitfall::check_text(source, dialect, problems);
    let tree = yaml::read(&text.text, source.id(), dialect.has_aliases);
    pitfall::check_tree(&tree, source, dialect, problems);
    problems.extend(syntax_error::explain(&tree, &text, source, dialect));
    let mut document = Document::of(tree);
    document.is_partial |= text.is_incomplete;
    document
}

/// A text such as `command:./sensor`, `command ./sensor` or `command：./sensor` in the place of a mapping, where a key
/// has lost its space or its colon.
pub fn damaged_key(node: &Node, source: &SourceFile, dialect: &Dialect) -> Option<Diagnostic> {
    let without_colon = || {
        let word = node.text().filter(|_| node.is_plain())?.split(' ').next().filter(|word| (dialect.is_key)(word))?;
        let start = node.span.start as usize;
        let end = start + word.len();
        let colon = vec![Edit::new(source.span(end..end), ":")];
        Some(pitfall::missing_mark::colon_after(&(start..end), source.text(), source).carry(colon, false))
    };
    glued(node, source, dialect).or_else(without_colon)
}

/// The problem of a missing space after `:`, or of a character that looks like another, if that explains why a list or
/// mapping is missing.
fn glued(node: &Node, source: &SourceFile, dialect: &Dialect) -> Option<Diagnostic> {
    let look_alike = || pitfall::look_alike::in_word(node, node.text()?, "the text", source);
    pitfall::missing_space::in_node(node, source, dialect).or_else(look_alike)
}

/// The walk over the tree: where it reads, what it found so far.
struct Reader<'s> {
    source: &'s SourceFile,
    part: Part,
    problems: Diagnostics,
    model: Model,
    /// Connections stand where they do not belong, and a problem says so.
    has_stray_connections: bool,
    /// How many problems may still search the whole file, so that time stays linear.
    searches: Searches,
    /// What the items of the list declare that is being read.
    reads: Entry,
    /// The component that is being read, or else the last one.
    component: Option<Span>,
    /// The last item of the list of connections.
    last_connection: Option<Span>,
}

impl<'s> Reader<'s> {
    fn new(source: &'s SourceFile) -> Self {
        let (problems, model) = (Diagnostics::new(), Model::default());
        Reader {
            source,
            part: Part::Main,
            problems,
            model,
            has_stray_connections: false,
            searches: Searches::default(),
            reads: Entry::Component,
            component: None,
            last_connection: None,
        }
    }

    fn read_root(&mut self, document: &Document) {
        self.model.cut_off = document.is_partial;
        match &document.root {
            Some(Node { kind: NodeKind::Mapping { entries, .. }, .. }) => self.read_sections(entries),
            Some(root) if !root.is_null() && !matches!(root.kind, NodeKind::Unread) => {
                self.report(shape::top_level::diagnose(root, self.source, &TOPOLOGY));
            }
            // Nothing is in the file, and a problem says so.
            _ => self.model.components_unread = true,
        }
    }

    fn report(&mut self, problem: Diagnostic) {
        self.problems.push(problem);
    }
}

/// The text of a scalar, with its place; `None` for "no value", lists and mappings.
fn scalar(node: &Node) -> Option<Spanned<String>> {
    Some(Spanned { value: node.text()?.to_owned(), span: node.span })
}

/// What a message calls a value of this shape.
fn shape_word(node: &Node) -> &'static str {
    match &node.kind {
        _ if node.is_null() => "empty",
        NodeKind::Scalar { .. } | NodeKind::Unread => "text",
        NodeKind::Sequence { .. } => "a list",
        NodeKind::Mapping { .. } => "a mapping",
    }
}

/// From the `-` before a list item to its end; in brackets, just the item.
fn with_dash(item: Span, source: &SourceFile) -> Span {
    let before = source.text().get(..item.start as usize).unwrap_or("");
    let trimmed = before.trim_end_matches([' ', '\n', '\r']);
    if trimmed.ends_with('-') { Span { start: trimmed.len() as u32 - 1, ..item } } else { item }
}

#[cfg(test)]
mod tests;
#[cfg(test)]
mod variants;
