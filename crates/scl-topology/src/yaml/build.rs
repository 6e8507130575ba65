//! Builds the tree from the parser's events, with an explicit stack instead of recursion.

use super::{Anchor, MAX_DEPTH, MOST_REPEATED, Node, NodeKind, Style, SyntaxError, Tree};
use crate::source::{FileId, Span};
use granit_parser::{Event, ScalarStyle, StructureStyle};
use std::collections::HashMap;

/// A collection whose end is still to come.
struct Open {
    start: Span,
    /// The number of its anchor, or 0.
    anchor: usize,
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
    /// The index in `tree.anchors` of each of the parser's anchor numbers.
    anchors: HashMap<usize, usize>,
    has_aliases: bool,
    /// What each anchor stands for, with its number of values and its depth, if there are aliases.
    values: HashMap<usize, (Node, usize, usize)>,
    /// How many values the aliases so far stand for.
    repeated: usize,
}

impl<'t> Builder<'t> {
    pub(super) fn new(text: &'t str, file: FileId, has_aliases: bool) -> Self {
        Self {
            text,
            file,
            tree: Tree::default(),
            stack: Vec::new(),
            skipped: 0,
            documents: 0,
            anchors: HashMap::new(),
            has_aliases,
            values: HashMap::new(),
            repeated: 0,
        }
    }

    pub(super) fn has_document(&self) -> bool {
        self.documents > 0
    }

    pub(super) fn event(&mut self, event: Event<'_>, at: &granit_parser::Span) {
        let span = self.span(at);
        let is_tagged = at.tag_span().is_some();
        if let Some(tag) = at.tag_span() {
            self.tree.tags.push(self.span(&tag));
        }
        match event {
            Event::DocumentStart(..) => self.documents += 1,
            // A tag or an anchor without a value is a problem of its own.
            Event::Scalar(_, _, anchor, _)
                if span.start == span.end && (is_tagged || anchor > 0 && !self.has_aliases) =>
            {
                self.attach_value(Node { span, kind: NodeKind::Unread }, anchor);
            }
            Event::Scalar(text, style, anchor, _) => self.scalar(text.into_owned(), style, span, anchor),
            Event::SequenceStart(style, anchor, _) => self.open(span, style, anchor, Content::Items(Vec::new())),
            Event::MappingStart(style, anchor, _) => {
                self.open(span, style, anchor, Content::Entries { entries: Vec::new(), key: None })
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

    fn scalar(&mut self, text: String, style: ScalarStyle, span: Span, anchor: usize) {
        let style = match style {
            ScalarStyle::Plain => Style::Plain,
            ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted => Style::Quoted,
            ScalarStyle::Literal | ScalarStyle::Folded => Style::Block,
        };
        // The parser returns `~` for a missing value.
        let text = if span.start == span.end && style == Style::Plain { String::new() } else { text };
        let span = if style == Style::Block { self.without_blank_end(span) } else { span };
        self.attach_value(Node { span, kind: NodeKind::Scalar { text, style } }, anchor);
    }

    /// Cuts off the empty lines after a text block, which the parser counts as part of it.
    fn without_blank_end(&self, span: Span) -> Span {
        let content = self.text.get(span.start as usize..span.end as usize).unwrap_or("");
        Span { end: span.start + content.trim_end().len() as u32, ..span }
    }

    fn open(&mut self, start: Span, style: StructureStyle, anchor: usize, content: Content) {
        if self.skipped > 0 || self.stack.len() >= MAX_DEPTH {
            if self.skipped == 0 {
                self.tree.too_deep.get_or_insert(start);
                self.stack.push(Open { start, anchor, flow: true, content });
            }
            self.skipped += 1;
            return;
        }
        self.stack.push(Open { start, anchor, flow: style == StructureStyle::Flow, content });
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
        let anchor = open.anchor;
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
        self.attach_value(Node { span, kind }, anchor);
    }

    /// Attaches a value that is written in the text, and keeps it for the aliases of its anchor.
    fn attach_value(&mut self, node: Node, anchor: usize) {
        if anchor != 0 && self.has_aliases && self.skipped == 0 {
            let (values, depth) = size(&node);
            self.values.insert(anchor, (node.clone(), values, depth));
        }
        self.attach(node);
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
        if self.has_aliases {
            return self.repeat(id, span);
        }
        if id.is_none() && self.is_wildcard(span) {
            let text = self.text.get(span.start as usize..span.end as usize).unwrap_or_default().to_owned();
            return self.attach(Node { span, kind: NodeKind::Scalar { text, style: Style::Plain } });
        }
        match id.and_then(|id| self.anchors.get(&id)) {
            Some(&index) => self.tree.anchors[index].aliases.push(span),
            None => self.tree.anchors.push(Anchor { definition: None, aliases: vec![span] }),
        }
        self.attach(Node { span, kind: NodeKind::Unread });
    }

    /// Whether an alias without an anchor is rather `*.gate`: a path with a wildcard in a list in brackets.
    fn is_wildcard(&self, span: Span) -> bool {
        let is_path = self.text.get(span.start as usize..span.end as usize).is_some_and(|text| text.contains('.'));
        is_path && self.stack.last().is_some_and(|open| open.flow && matches!(open.content, Content::Items(_)))
    }

    /// Puts a copy of an anchor's value in the place of an alias. Its places are those of the original.
    fn repeat(&mut self, id: Option<usize>, span: Span) {
        let Some((node, values, depth)) = id.and_then(|id| self.values.get(&id)) else {
            self.tree.anchors.push(Anchor { definition: None, aliases: vec![span] });
            return self.attach(Node { span, kind: NodeKind::Unread });
        };
        let is_too_deep = self.stack.len() + depth > MAX_DEPTH;
        if is_too_deep || self.repeated + values > MOST_REPEATED {
            let place = if is_too_deep { &mut self.tree.too_deep } else { &mut self.tree.too_much };
            place.get_or_insert(span);
            return self.attach(Node { span, kind: NodeKind::Unread });
        }
        self.repeated += values;
        self.attach(node.clone());
    }
}

/// The number of values in a node, itself included, and how many levels deep its collections are nested. The depth of
/// the tree bounds the recursion.
fn size(node: &Node) -> (usize, usize) {
    let below: Vec<(usize, usize)> = match &node.kind {
        NodeKind::Scalar { .. } | NodeKind::Unread => return (1, 0),
        NodeKind::Sequence { items } => items.iter().map(size).collect(),
        NodeKind::Mapping { entries } => entries.iter().flat_map(|(key, value)| [size(key), size(value)]).collect(),
    };
    let values = below.iter().map(|(values, _)| values).sum::<usize>() + 1;
    (values, below.iter().map(|(_, depth)| *depth).max().unwrap_or_default() + 1)
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
