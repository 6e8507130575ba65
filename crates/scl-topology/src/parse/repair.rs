//! Finds the single change that would make a text readable: the way from "the parser stops here" to what was meant.
//!
//! A parser stops where it can no longer go on, often lines after the mistake. So every small change near that place is
//! tried (a comma, a bracket, a column, a word less), and the change that leaves the fewest problems is taken to be the
//! correction. Both the text that is read again and the number of changes are bounded.

mod again;
mod candidates;
mod line;
mod quoting;
mod tell;
mod window;

use super::dialect::Dialect;
use super::document::Document;
use super::pitfall::CheckedText;
use crate::diagnostic::Diagnostic;
use crate::source::{SourceFile, Sources};
use crate::yaml::{self, SyntaxError};
use std::ops::Range;
use window::Window;

/// A change of the text, and what it means.
#[derive(Debug, Clone)]
struct Edit {
    kind: Kind,
    /// The replacements, in file order, without overlap.
    changes: Vec<(Range<usize>, String)>,
    /// How far-fetched the change is; among changes that fix equally much, the one of the lowest cost is taken.
    cost: usize,
}

/// What a change says about the mistake.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Kind {
    /// A comma is missing after the first and before the second.
    Comma(Range<usize>, Range<usize>),
    /// A colon is missing after a word.
    Colon(Range<usize>),
    /// A bracket is never closed; the place after which it should be.
    Close(usize, Range<usize>),
    /// A bracket closes nothing; the word before which it should be opened.
    Open(usize, Range<usize>),
    /// One mark stands in the place of another.
    Instead(Range<usize>, char),
    /// A bracket is closed by one of the other kind.
    Partner(usize, usize),
    /// Something stands where nothing may stand.
    Surplus(Range<usize>),
    /// Options of a gate without the braces around them.
    Braces(Range<usize>),
    /// A word with a colon in the place of a value, and the value after it.
    SecondColon(Range<usize>),
    /// Brackets behind a type, as in `A[]`; the type with them.
    ArrayType(Range<usize>),
    /// A key, its colon and the start of its value, without a space between them.
    Space(Range<usize>),
    /// A `#` without a space before it.
    CommentSpace(usize),
    /// A list item without its dash, from its first character to the end of its line.
    Dash(Range<usize>),
    /// Another mark in the place of a dash.
    OtherMark(usize),
    /// A dash without a space after it.
    DashSpace(Range<usize>),
    /// A list item in the line of another.
    Break(usize),
    /// A parenthesis in place of a bracket.
    Parentheses(Range<usize>),
    /// A key in the line of another, with its value.
    Key(Range<usize>),
    /// A quote without a partner.
    Quote(usize),
    /// The place of a quote that is missing.
    Unquoted(usize),
    /// The first key of a component that has no name.
    Nameless(Range<usize>),
    /// A colon after which a list should be opened.
    OpenAfter(Range<usize>),
    /// A line in the wrong column: its first word, and the column meant.
    Indent(Range<usize>, usize),
    /// Characters that look like marks of YAML.
    LookAlike(Range<usize>),
    /// A text that needs quotes.
    Text(Range<usize>),
}

impl Edit {
    /// Whether a tool may apply the change: it adds a mark or moves a line, and removes no word.
    fn is_meant(&self) -> bool {
        let is_removal = matches!(
            self.kind,
            Kind::Surplus(_) | Kind::SecondColon(_) | Kind::ArrayType(_) | Kind::Quote(_) | Kind::Nameless(_)
        );
        !is_removal && self.cost < DOUBTFUL
    }
}

/// Changes of this cost or more are reported, but no tool applies them by itself.
const DOUBTFUL: usize = 4;

/// Changes that leave more problems than this explain nothing.
const MOST_PROBLEMS: usize = 2;

/// Maximum number of changes that are tried.
const MOST_TRIES: usize = 100;

/// What the best change explains.
pub(super) struct Repair {
    pub(super) problem: Diagnostic,
    /// The change leaves no problem, so it is what was meant.
    pub(super) is_sure: bool,
}

/// Maximum number of changes of the same cost that are compared with the best. If another one also leaves no problem,
/// no tool applies the change by itself.
const MOST_RIVALS: usize = 16;

/// The changes of a line that are tried.
type Ways<'w> = &'w dyn Fn(&Range<usize>, &str, &SourceFile, &Dialect) -> Vec<Edit>;

/// The best change of a text.
struct Best {
    edit: Edit,
    /// It leaves no problem.
    is_sure: bool,
    /// It is also the only such change, and one that a tool may apply.
    is_meant: bool,
}

/// Returns the problem that the best change stands for, if any change makes the text readable.
pub(super) fn find(error: &SyntaxError, text: &CheckedText, source: &SourceFile, dialect: &Dialect) -> Option<Repair> {
    find_among(&candidates::of_line, error, text, source, dialect)
}

/// As [`find`], but only tries to put texts in quotes, and returns the problem only if no other is left.
pub(super) fn find_text(
    error: &SyntaxError,
    text: &CheckedText,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Diagnostic> {
    let ways: Ways<'_> = &|line, text, _, dialect| quoting::likely(line, text, dialect);
    find_among(ways, error, text, source, dialect).filter(|repair| repair.is_sure).map(|repair| repair.problem)
}

fn find_among(
    ways: Ways<'_>,
    error: &SyntaxError,
    text: &CheckedText,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Repair> {
    let text = &text.text;
    let window = window::around(error, text, source)?;
    let whole = find_in(&window, ways, error, text, source, dialect);
    let is_complete = whole.is_some();
    let best = whole.or_else(|| {
        // A second mistake further down may make the whole window unreadable, so leave out the lines below.
        parts(&window, error, text, source, dialect)
            .filter_map(|part| find_in(&part, ways, error, text, source, dialect))
            .find(|best| best.is_sure)
    })?;
    let Best { edit, is_sure, is_meant } = best;
    let later = again::later(&edit, ways, text, dialect);
    let is_meant = is_meant && if later.edits.is_empty() { is_complete } else { later.is_meant };
    Some(Repair { problem: tell::tell(&edit, &later.edits, text, source, dialect, is_meant), is_sure })
}

/// The parts of a window without the lines below the mistake, if the mistake is in them.
fn parts(
    window: &Window,
    error: &SyntaxError,
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
) -> impl Iterator<Item = Window> {
    let parts = window.without_lines_below(error, text, source).into_iter();
    parts.filter(move |part| problems_left(&part.with(None, text), dialect) != Some(0))
}

/// The best change of a part of the text.
fn find_in(
    window: &Window,
    ways: Ways<'_>,
    error: &SyntaxError,
    text: &str,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Best> {
    let lines = window::suspects(error, text, source, window);
    let mut edits: Vec<(usize, Edit)> = Vec::new();
    for edit in lines.iter().flat_map(|line| ways(line, text, source, dialect)) {
        if edit.changes.iter().all(|(range, _)| range.start >= window.range.start && range.end <= window.range.end) {
            let distance = edit.changes.first().map_or(0, |(range, _)| range.start.abs_diff(error.at));
            edits.push((distance, edit));
        }
    }
    edits.sort_by_key(|(distance, edit)| (edit.cost, *distance));
    let mut best: Option<(usize, usize)> = None;
    for (at, (_, edit)) in edits.iter().take(MOST_TRIES).enumerate() {
        let most = best.map_or(MOST_PROBLEMS, |(left, _)| left - 1);
        if let Some(left) = problems_left(&window.with(Some(edit), text), dialect).filter(|left| *left <= most) {
            best = Some((left, at));
            // The remaining edits are not cheaper and cannot leave fewer problems.
            if left == 0 {
                break;
            }
        }
    }
    let (left, at) = best?;
    let edit = &edits[at].1;
    let rivals = edits[at + 1..].iter().map(|(_, rival)| rival).take_while(|rival| rival.cost == edit.cost);
    let mended = window.with(Some(edit), text);
    let mut rivals =
        rivals.take(MOST_RIVALS).map(|rival| window.with(Some(rival), text)).filter(|other| *other != mended);
    let is_meant = left == 0 && edit.is_meant() && !rivals.any(|other| problems_left(&other, dialect) == Some(0));
    Some(Best { edit: edit.clone(), is_sure: left == 0, is_meant })
}

/// Number of problems in a text; `None` if it cannot be read.
fn problems_left(text: &str, dialect: &Dialect) -> Option<usize> {
    let mut sources = Sources::new();
    let file = sources.add("", text);
    let tree = yaml::read(sources.file(file).text(), file, dialect.has_aliases);
    if tree.error.is_some() || tree.too_deep.is_some() {
        return None;
    }
    let anchors = tree.anchors.iter().filter(|anchor| !dialect.has_aliases || anchor.definition.is_none());
    let odd = anchors.count() + tree.tags.len() + usize::from(tree.second_document.is_some());
    Some(odd + (dialect.mistakes)(&Document::of(tree), sources.file(file)))
}
