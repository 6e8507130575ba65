//! The text of a YAML file as a tree in which every node knows its place.
//!
//! Only this file and those below it know the YAML parser. A text with a syntax error yields the tree of what precedes
//! the error, together with the error.

mod build;
mod syntax_error;

use crate::source::{FileId, Span};
use granit_parser::{Event, Parser};

pub(crate) use syntax_error::{SyntaxError, SyntaxErrorKind};

/// Maximum depth of the tree. A deeper file is no topology; the limit keeps every walk over the tree from overflowing
/// the stack.
pub(crate) const MAX_DEPTH: usize = 16;

/// How many values all aliases of a file may stand for, so that a small text does not become an enormous tree.
pub(crate) const MOST_REPEATED: usize = 10_000;

/// One value and its place.
#[derive(Debug, Clone)]
pub struct Node {
    /// From its first to its last character, including quotes and brackets.
    pub span: Span,
    /// The value.
    pub kind: NodeKind,
}

/// The shapes of a value.
#[derive(Debug, Clone)]
pub enum NodeKind {
    /// Text; empty and plain where no value is written.
    Scalar {
        /// As written, without quotes and escapes.
        text: String,
        /// How it is written.
        style: Style,
    },
    /// A list.
    Sequence {
        /// In file order.
        items: Vec<Node>,
    },
    /// Keys and values.
    Mapping {
        /// In file order; a key may occur twice.
        entries: Vec<(Node, Node)>,
    },
    /// A place whose value could not be read, and about which a problem is reported already.
    Unread,
}

/// How a scalar is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// Without quotes.
    Plain,
    /// In single or double quotes.
    Quoted,
    /// After `|` or `>`.
    Block,
}

impl Node {
    /// The text of a scalar; `None` for "no value", lists and mappings.
    pub fn text(&self) -> Option<&str> {
        match &self.kind {
            NodeKind::Scalar { text, .. } if !self.is_null() => Some(text),
            _ => None,
        }
    }

    /// The items of a list.
    pub fn items(&self) -> Option<&[Node]> {
        match &self.kind {
            NodeKind::Sequence { items } => Some(items),
            _ => None,
        }
    }

    /// The keys and values of a mapping.
    pub fn entries(&self) -> Option<&[(Node, Node)]> {
        match &self.kind {
            NodeKind::Mapping { entries } => Some(entries),
            _ => None,
        }
    }

    /// Whether a scalar stands without quotes, so that YAML may read it as something other than text.
    pub fn is_plain(&self) -> bool {
        matches!(self.kind, NodeKind::Scalar { style: Style::Plain, .. })
    }

    /// Whether it is "no value" as YAML reads it: nothing, `~` or `null`.
    pub fn is_null(&self) -> bool {
        matches!(&self.kind, NodeKind::Scalar { text, style: Style::Plain }
            if matches!(text.as_str(), "" | "~" | "null" | "Null" | "NULL"))
    }
}

/// `&name`, and the `*name` that refer to it.
#[derive(Debug, Clone)]
pub(crate) struct Anchor {
    /// `&name`; none for aliases of a name that nothing defines.
    pub(crate) definition: Option<Span>,
    /// Each `*name`.
    pub(crate) aliases: Vec<Span>,
}

/// What was read of a text.
#[derive(Debug, Default)]
pub(crate) struct Tree {
    /// The first document's value; none in a file without any.
    pub(crate) root: Option<Node>,
    /// Where the text stops being valid YAML.
    pub(crate) error: Option<SyntaxError>,
    /// Anchors in the order of their definition.
    pub(crate) anchors: Vec<Anchor>,
    /// Each `!tag`.
    pub(crate) tags: Vec<Span>,
    /// The `---` of a second document; what follows it is not read.
    pub(crate) second_document: Option<Span>,
    /// The first value nested deeper than [`MAX_DEPTH`].
    pub(crate) too_deep: Option<Span>,
    /// The first alias past [`MOST_REPEATED`].
    pub(crate) too_much: Option<Span>,
}

impl Tree {
    /// Whether a part of the text could not be read, so that what seems to be missing may be in it.
    pub(crate) fn is_partial(&self) -> bool {
        self.error.is_some() || self.too_deep.is_some() || self.too_much.is_some() || self.second_document.is_some()
    }
}

/// Reads a text. Takes linear time and never fails: errors are part of the result. With `has_aliases`, an alias becomes
/// a copy of the anchor's value, otherwise [`NodeKind::Unread`].
pub(crate) fn read(text: &str, file: FileId, has_aliases: bool) -> Tree {
    let mut builder = build::Builder::new(text, file, has_aliases);
    for next in Parser::new_from_str_with_options(text, options()) {
        match next {
            Ok((Event::DocumentStart(..), span)) if builder.has_document() => {
                builder.second_document(&span);
                break;
            }
            Ok((event, span)) => builder.event(event, &span),
            Err(error) => {
                builder.fail(SyntaxError::new(&error, text.len()));
                break;
            }
        }
    }
    builder.finish()
}

fn options() -> granit_parser::Options {
    granit_parser::options! {
        emit_comments: false,
        emit_anchor_events: true,
        emit_unresolved_aliases: true,
        // The limit of the YAML specification; the keys that have a meaning here are far shorter.
        simple_key_max_lookahead: 1024,
    }
}

#[cfg(test)]
mod tests;
