//! The parser's events, put together to a tree. Works on a stack of its own, never on the program's.

use super::{Anchor, MAX_DEPTH, Node, NodeKind, Style, SyntaxError, Tree};
use crate::source::{FileId, Span};
use granit_parser::{Event, ScalarStyle, StructureStyle};
use std::collections::HashMap;

/// A collection whose end is still to come.
struct Open {
    start: Span,
    flow: bool,
    content: Content,
}

enum Content {
    Items(Vec<Node>),
    Entries { entries: Vec<(Node, Node)>, key: Option<Node> },
}

pub(super) struct Builder<'t> {
    text: &'t str,
    file: FileId,
    tree: Tree,
    stack: Vec<Open>,
    /// How many collections are open below the deepest that is kept.
    skipped: usize,
    documents: usize,
    /// The place in `tree.anchors` of each of the parser's anchor numbers.
    anchors: HashMap<usize, usize>,
}

impl<'t> Builder<'t> {
    pub(super) fn new(text: &'t str, file: FileId) -> Self {
        let (tree, stack, anchors) = (Tree::default(), Vec::new(), HashMap::new());
        Self { text, file, tree, stack, skipped: 0, documents: 0, anchors }
    }

    pub(super) fn has_document(&self) -> bool {
        self.documents > 0
    }

    pub(super) fn event(&mut self, event: Event<'_>, at: &granit_parser::Span) {
        let span = self.span(at);
        if let Some(tag) = at.tag_span() {
            self.tree.tags.push(self.span(&tag));
        }
        match event {
            Event::DocumentStart(..) => self.documents += 1,
            Event::Scalar(text, style, ..) => self.scalar(text.into_owned(), style, span),
            Event::SequenceStart(style, ..) => self.open(span, style, Content::Items(Vec::new())),
            Event::MappingStart(style, ..) => {
                self.open(span, style, Content::Entries { entries: Vec::new(), key: None })
            }
            Event::SequenceEnd | Event::MappingEnd => self.close(Some(span)),
            Event::Anchor(id, _) => self.anchor(id, span),
            Event::Alias(id) => self.alias(Some(id), span),
            Event::UnresolvedAlias(_) => self.alias(None, span),
            _ => {}
        }
    }

    pub(super) fn second_document(&mut self, at: &granit_parser::Span) {
        self.tree.second_document = Some(self.span(at));
    }

    pub(super) fn fail(&mut self, error: SyntaxError) {
        self.tree.error = Some(error);
    }

    /// Closes what a syntax error left open, so that the part before it is kept.
    pub(super) fn finish(mut self) -> Tree {
        self.skipped = self.skipped.min(1);
        while self.skipped > 0 || !self.stack.is_empty() {
            self.close(None);
        }
        self.tree
    }

    fn span(&self, at: &granit_parser::Span) -> Span {
        let range = at.byte_range().unwrap_or(0..0);
        Span { file: self.file, start: range.start as u32, end: range.end.max(range.start) as u32 }
    }

    fn scalar(&mut self, text: String, style: ScalarStyle, span: Span) {
        let style = match style {
            ScalarStyle::Plain => Style::Plain,
            ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted => Style::Quoted,
            ScalarStyle::Literal | ScalarStyle::Folded => Style::Block,
        };
        // The parser says `~` where nothing is written.
        let text = if span.start == span.end && style == Style::Plain { String::new() } else { text };
        let span = if style == Style::Block { self.without_blank_end(span) } else { span };
        self.attach(Node { span, kind: NodeKind::Scalar { text, style } });
    }

    /// The parser counts the empty lines after a text block to it.
    fn without_blank_end(&self, span: Span) -> Span {
        let content = self.text.get(span.start as usize..span.end as usize).unwrap_or("");
        Span { end: span.start + content.trim_end().len() as u32, ..span }
    }

    fn open(&mut self, start: Span, style: StructureStyle, content: Content) {
        if self.skipped > 0 || self.stack.len() >= MAX_DEPTH {
            if self.skipped == 0 {
                self.tree.too_deep.get_or_insert(start);
                self.stack.push(Open { start, flow: true, content });
            }
            self.skipped += 1;
            return;
        }
        self.stack.push(Open { start, flow: style == StructureStyle::Flow, content });
    }

    fn close(&mut self, end: Option<Span>) {
        if self.skipped > 1 {
            self.skipped -= 1;
            return;
        }
        let Some(open) = self.stack.pop() else { return };
        let unread = self.skipped == 1;
        self.skipped = 0;
        let span = closed_span(&open, end);
        let kind = match open.content {
            _ if unread => NodeKind::Unread,
            Content::Items(items) => NodeKind::Sequence { items },
            Content::Entries { mut entries, key } => {
                if let Some(key) = key {
                    let value = Node { span: Span { start: key.span.end, ..key.span }, kind: NodeKind::Unread };
                    entries.push((key, value));
                }
                NodeKind::Mapping { entries }
            }
        };
        self.attach(Node { span, kind });
    }

    fn attach(&mut self, node: Node) {
        if self.skipped > 0 {
            return;
        }
        match self.stack.last_mut().map(|open| &mut open.content) {
            None if self.tree.root.is_none() => self.tree.root = Some(node),
            None => {}
            Some(Content::Items(items)) => items.push(node),
            Some(Content::Entries { entries, key }) => match key.take() {
                Some(key) => entries.push((key, node)),
                None => *key = Some(node),
            },
        }
    }

    fn anchor(&mut self, id: usize, span: Span) {
        self.anchors.insert(id, self.tree.anchors.len());
        self.tree.anchors.push(Anchor { definition: Some(span), aliases: Vec::new() });
    }

    fn alias(&mut self, id: Option<usize>, span: Span) {
        match id.and_then(|id| self.anchors.get(&id)) {
            Some(&index) => self.tree.anchors[index].aliases.push(span),
            None => self.tree.anchors.push(Anchor { definition: None, aliases: vec![span] }),
        }
        self.attach(Node { span, kind: NodeKind::Unread });
    }
}

/// A collection in brackets ends with its bracket; the parser lets the others run to the next token, so they end with
/// their last child here.
fn closed_span(open: &Open, end: Option<Span>) -> Span {
    let last_child = match &open.content {
        Content::Items(items) => items.last().map(|item| item.span.end),
        Content::Entries { key: Some(key), .. } => Some(key.span.end),
        Content::Entries { entries, key: None } => entries.last().map(|(key, value)| key.span.end.max(value.span.end)),
    };
    let end = match end {
        Some(end) if open.flow => end.end,
        _ => last_child.unwrap_or(open.start.end),
    };
    Span { end: end.max(open.start.start), ..open.start }
}
