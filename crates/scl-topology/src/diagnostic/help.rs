//! What a diagnostic advises: words, or changes of text as data, for `scl check --fix` and for editors.

use super::{Diagnostic, clipped};
use crate::source::{SourceFile, Span};
use scl_text::list::either;
use std::borrow::Cow;

/// One help of a diagnostic: what is allowed at its place, or what to write.
///
/// A help that says what to write carries it as [`Proposal`]s. Before a file's problems are shown,
/// [`try_advice`](crate::advice::try_advice) applies each of them to a copy of the text, and removes those that do not
/// help.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Help {
    wording: Wording,
    /// The changes that it proposes: none for words alone, several for alternatives.
    pub proposals: Vec<Proposal>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Wording {
    Text(String),
    /// Shown only if no proposal of the diagnostic is left.
    Otherwise(String),
    /// The words before and after those of the proposals.
    Choice(&'static str, &'static str),
}

/// One way to solve a problem: changes of text that belong together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Proposal {
    /// What an alternative is called, for example the name that may be meant.
    word: String,
    /// The replacements, which do not overlap.
    pub edits: Vec<Edit>,
    /// The rule knows the mistake to be here and nowhere else.
    is_certain: bool,
    /// Whether this is certainly what was meant: `scl check --fix` applies it. Set by the trial alone.
    pub is_sure: bool,
}

/// Maximum number of changes of one proposal: with more, its help is words alone, because every output lists them.
const MOST_EDITS: usize = 10_000;

/// One replacement of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Edit {
    /// What is replaced; an empty span inserts.
    pub span: Span,
    /// The new text; empty to remove the old one. Line breaks are `\n`, whatever the file has.
    pub replacement: String,
}

impl Edit {
    /// The replacement of a span.
    pub fn new(span: Span, replacement: impl Into<String>) -> Self {
        Self { span, replacement: replacement.into() }
    }
}

impl Proposal {
    fn new(word: String, edits: Vec<Edit>, is_certain: bool) -> Self {
        Self { word, edits, is_certain, is_sure: false }
    }
}

impl Help {
    /// The text, which may have several lines.
    pub fn text(&self) -> Cow<'_, str> {
        match &self.wording {
            Wording::Text(text) | Wording::Otherwise(text) => text.into(),
            Wording::Choice(before, after) => {
                let words: Vec<&str> = self.proposals.iter().map(|proposal| proposal.word.as_str()).collect();
                format!("{before}{}{after}", either(&words)).into()
            }
        }
    }

    /// What one of the proposals does: the text, or, if it is one of several, its replacement.
    pub fn title(&self, proposal: &Proposal) -> Cow<'_, str> {
        match proposal.edits.as_slice() {
            [edit] if self.proposals.len() > 1 => format!("replace with `{}`", edit.replacement).into(),
            _ => self.text(),
        }
    }
}

impl Diagnostic {
    /// Adds a help in words: what is allowed, or what to find out. One that says what to write is a
    /// [`proposal`](Self::propose).
    pub fn help(self, text: impl Into<String>) -> Self {
        self.with_help(Wording::Text(clipped(text)), Vec::new())
    }

    /// Adds helps: none, one or several.
    pub fn helps<T: Into<String>>(self, texts: impl IntoIterator<Item = T>) -> Self {
        texts.into_iter().fold(self, Self::help)
    }

    /// Adds a help that is shown only if no proposal is left after the trial. Does nothing if there is a help with
    /// these words alone.
    pub fn otherwise(self, text: impl Into<String>) -> Self {
        let text = clipped(text);
        let says_so = |help: &Help| help.proposals.is_empty() && help.text() == text;
        if self.helps.iter().any(says_so) { self } else { self.with_help(Wording::Otherwise(text), Vec::new()) }
    }

    /// Adds a help with the changes that it describes. The mistake is known to be at their place: if they pass the
    /// trial, and nothing else is proposed, `scl check --fix` applies them.
    pub fn propose(self, text: impl Into<String>, edits: impl IntoIterator<Item = Edit>) -> Self {
        self.with_way(text, edits, true)
    }

    /// Adds a help with changes that may be meant. Editors offer them.
    pub fn suggest(self, text: impl Into<String>, edits: impl IntoIterator<Item = Edit>) -> Self {
        self.with_way(text, edits, false)
    }

    /// Adds the names that a wrong `word` may have meant, if there are any. The word is at the primary place, perhaps
    /// in quotes; if it is written in another way, for example with escapes, they are told in words alone.
    pub fn did_you_mean<S: AsRef<str>>(self, word: &str, names: &[S]) -> Self {
        self.choose_word(("did you mean ", "?"), word, names)
    }

    /// As [`did_you_mean`](Self::did_you_mean), with other text around the names.
    pub(crate) fn choose_word<S: AsRef<str>>(
        self,
        lead: (&'static str, &'static str),
        word: &str,
        names: &[S],
    ) -> Self {
        let Some(at) = self.place_of(word) else {
            return if names.is_empty() { self } else { self.help(format!("{}{}{}", lead.0, either(names), lead.1)) };
        };
        self.choose(lead, names.iter().map(|name| (name.as_ref(), Edit::new(at, name.as_ref()))))
    }

    /// The place of a word at the primary place, without its quotes.
    fn place_of(&self, word: &str) -> Option<Span> {
        let span = self.primary.as_ref()?.span;
        match ((span.end - span.start) as usize).checked_sub(word.len())? {
            0 => Some(span),
            2 => Some(Span { start: span.start + 1, end: span.end - 1, ..span }),
            _ => None,
        }
    }

    /// Adds a help with one change for each word; a single one is proposed as certain. `lead` is the text before and
    /// after the words.
    pub fn choose<'w>(
        self,
        lead: (&'static str, &'static str),
        ways: impl IntoIterator<Item = (&'w str, Edit)>,
    ) -> Self {
        self.choose_all(lead, ways.into_iter().map(|(word, edit)| (word, vec![edit])))
    }

    /// As [`choose`](Self::choose), with several changes that belong together for each word.
    pub(crate) fn choose_all<'w>(
        self,
        (before, after): (&'static str, &'static str),
        ways: impl IntoIterator<Item = (&'w str, Vec<Edit>)>,
    ) -> Self {
        let mut ways: Vec<_> = ways.into_iter().collect();
        ways.iter_mut().for_each(|(_, edits)| edits.truncate(MOST_EDITS));
        if ways.is_empty() {
            return self;
        }
        let is_only = ways.len() == 1;
        let proposals = ways.into_iter().map(|(word, edits)| Proposal::new(clipped(word), edits, is_only)).collect();
        self.with_help(Wording::Choice(before, after), proposals)
    }

    /// Adds the removal of an item or an entry; in words alone if it shares its line with something else.
    pub(crate) fn propose_removal(self, text: impl Into<String>, source: &SourceFile, span: Span) -> Self {
        match removal(source, span) {
            Some(removed) => self.propose(text, [removed]),
            None => self.help(text),
        }
    }

    /// Suggests the removal of an item or an entry; in words alone if it shares its line with something else.
    pub fn suggest_removal(self, text: impl Into<String>, source: &SourceFile, span: Span) -> Self {
        match removal(source, span) {
            Some(removed) => self.suggest(text, [removed]),
            None => self.help(text),
        }
    }

    /// Adds words to the first help.
    pub(crate) fn extend_help(mut self, more: &str) -> Self {
        if let Some(Wording::Text(text)) = self.helps.first_mut().map(|help| &mut help.wording) {
            text.push_str(more);
        }
        self
    }

    /// Makes the first help, which has words alone, a proposal of these changes.
    pub(crate) fn carry(mut self, edits: Vec<Edit>, is_certain: bool) -> Self {
        let is_short = edits.len() <= MOST_EDITS;
        if let Some(help) = self.helps.first_mut().filter(|help| is_short && help.proposals.is_empty()) {
            help.proposals.push(Proposal::new(String::new(), edits, is_certain));
        }
        self
    }

    /// Extends each proposal by the changes of the same proposal of problems that are the same mistake elsewhere.
    pub(crate) fn join_proposals(&mut self, others: Vec<Diagnostic>) {
        for other in others {
            for (help, same) in
                self.helps.iter_mut().zip(other.helps).filter(|(help, same)| help.wording == same.wording)
            {
                let pairs = help.proposals.iter_mut().zip(same.proposals);
                let pairs = pairs.filter(|(one, two)| one.word == two.word && one.edits.len() < MOST_EDITS);
                pairs.for_each(|(one, two)| one.edits.extend(two.edits));
            }
        }
    }

    /// Marks all proposals as possible only: the mistake may be elsewhere.
    pub(crate) fn doubt(&mut self) {
        self.proposals_mut().for_each(|proposal| proposal.is_certain = false);
    }

    /// Removes all helps.
    pub fn clear_helps(&mut self) {
        self.helps.clear();
    }

    /// The helps to show: those that stand in for proposals only if there are none.
    pub fn shown_helps(&self) -> impl Iterator<Item = &Help> {
        let has_proposal = self.proposals().next().is_some();
        self.helps.iter().filter(move |help| !(has_proposal && matches!(help.wording, Wording::Otherwise(_))))
    }

    /// The proposals of all helps.
    pub fn proposals(&self) -> impl Iterator<Item = &Proposal> {
        self.helps.iter().flat_map(|help| &help.proposals)
    }

    fn proposals_mut(&mut self) -> impl Iterator<Item = &mut Proposal> {
        self.helps.iter_mut().flat_map(|help| &mut help.proposals)
    }

    /// Keeps the proposals for which `passes`, called in their order, returns true; helps of which none is left go. The
    /// only proposal offered becomes sure if it is certain and passes.
    pub(crate) fn keep_proposals(&mut self, mut passes: impl FnMut() -> bool) {
        let is_only = self.proposals().take(2).count() == 1;
        self.helps.retain_mut(|help| {
            let is_words = help.proposals.is_empty();
            help.proposals.retain_mut(|proposal| {
                let is_kept = passes();
                proposal.is_sure = is_kept && is_only && proposal.is_certain;
                is_kept
            });
            is_words || !help.proposals.is_empty()
        });
    }

    fn with_way(self, text: impl Into<String>, edits: impl IntoIterator<Item = Edit>, is_certain: bool) -> Self {
        let edits: Vec<Edit> = edits.into_iter().take(MOST_EDITS + 1).collect();
        debug_assert!(!edits.is_empty(), "a proposal changes something");
        if edits.len() > MOST_EDITS {
            return self.help(text);
        }
        let way = Proposal::new(String::new(), edits, is_certain);
        self.with_help(Wording::Text(clipped(text)), vec![way])
    }

    fn with_help(mut self, wording: Wording, proposals: Vec<Proposal>) -> Self {
        self.helps.push(Help { wording, proposals });
        self
    }
}

/// The removal of an item or an entry with its comma, or with its line. `None` if it shares its line with something
/// else.
pub fn removal(source: &SourceFile, span: Span) -> Option<Edit> {
    removed(source, span).map(|removed| Edit::new(removed, ""))
}

fn removed(source: &SourceFile, span: Span) -> Option<Span> {
    let text = source.text();
    let (before, after) = (text.get(..span.start as usize)?, text.get(span.end as usize..)?);
    let line = source.line_range(span.start as usize);
    let head = text.get(line.start..span.start as usize)?.trim_start();
    let rest = &after[..after.len() - after.trim_start_matches([' ', '\t', '\r']).len()];
    let is_last = matches!(after[rest.len()..].chars().next(), None | Some('\n'));
    if (head.is_empty() || head == "- ") && is_last {
        let end = span.end as usize + rest.len();
        return Some(match end == text.len() {
            // The last line has no line break of its own, so remove the one before it.
            true => Span {
                start: before[..line.start].trim_end_matches(['\r', '\n']).len() as u32,
                end: end as u32,
                ..span
            },
            false => Span { start: line.start as u32, end: end as u32 + 1, ..span },
        });
    }
    if before.trim_end().ends_with(',') {
        return Some(Span { start: before.trim_end().len() as u32 - 1, ..span });
    }
    let spaces = after.len() - after.trim_start().len();
    let behind = after.trim_start().strip_prefix(',')?;
    let end = span.end as usize + spaces + 1 + (behind.len() - behind.trim_start_matches(' ').len());
    Some(Span { end: end as u32, ..span })
}

#[cfg(test)]
mod tests {
    use super::removed;
    use crate::source::{Sources, Span};

    #[test]
    fn an_item_goes_with_its_comma_or_its_line() {
        for (text, item, left) in [
            ("- a\n- [x]\n- b\n", "[x]", "- a\n- b\n"),
            ("- a\r\n- [x]\r\n- b\r\n", "[x]", "- a\r\n- b\r\n"),
            ("- a\n- [x]", "[x]", "- a"),
            ("- a\r\n- [x]", "[x]", "- a"),
            ("[a, x, b]", "x", "[a, b]"),
            ("[a, x]", "x", "[a]"),
            ("[x, a]", "x", "[a]"),
            ("[\n  x,\n  a\n]", "x", "[\n  \n  a\n]"),
            ("[x]", "x", "-"),
            ("- x # why", "x", "-"),
        ] {
            let mut sources = Sources::new();
            let file = sources.add("t.yaml", text);
            let start = text.find(item).unwrap();
            let span = Span { file, start: start as u32, end: (start + item.len()) as u32 };
            let found = removed(sources.file(file), span);
            let without = |span: Span| format!("{}{}", &text[..span.start as usize], &text[span.end as usize..]);
            assert_eq!(found.map_or("-".to_owned(), without), left, "{text:?}");
        }
    }
}
