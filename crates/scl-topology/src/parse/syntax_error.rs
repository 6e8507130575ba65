//! Why the parser stopped: the rule that explains it best.

use super::dialect::Dialect;
use super::pitfall::{
    CheckedText, bracket, depth, habit, indentation, missing_space, needs_quotes, not_yaml, quote, reserved_character,
    tab, unsupported,
};
use super::repair;
use crate::diagnostic::Diagnostic;
use crate::source::SourceFile;
use crate::yaml::{SyntaxError, SyntaxErrorKind, Tree};

/// Explains why the parser stopped. Returns `None` if it did not, or if a problem that is already reported explains it.
pub(super) fn explain(tree: &Tree, text: &CheckedText, source: &SourceFile, dialect: &Dialect) -> Option<Diagnostic> {
    let error = tree.error.as_ref()?;
    if error.kind == SyntaxErrorKind::Limit {
        // The parser may reach its own, higher limit before it emits the first value that exceeds ours.
        return tree.too_deep.is_none().then(|| depth::diagnose(source.span(error.at..error.at), dialect));
    }
    if text.is_mended {
        return None;
    }
    if is_text_told(tree, error, source) {
        return None;
    }
    let known = habit::template::at_error(error, &text.text, source)
        .or_else(|| habit::find(error, &text.text, source, dialect))
        .or_else(|| habit::prose::shallow_block(error, &text.text, source, dialect))
        .or_else(|| repair::find_text(error, text, source, dialect));
    if known.is_some() {
        return known;
    }
    let explained = match error.kind {
        SyntaxErrorKind::Glued => missing_space::at_bracket(error, &text.text, source, dialect),
        SyntaxErrorKind::Quote => quote::find(error, &text.text, source),
        SyntaxErrorKind::Character(character) => Some(reserved_character::diagnose(error.at, character, source)),
        SyntaxErrorKind::Property => reserved_character::find(error.at, source),
        SyntaxErrorKind::Tab => Some(tab::elsewhere(error.at, source)),
        SyntaxErrorKind::Directive => Some(unsupported::diagnose_directive(source, error.at, dialect)),
        _ => None,
    };
    let explained = explained
        .or_else(|| needs_quotes::bad_escape(error, &text.text, source))
        .or_else(|| habit::hidden::find(error, &text.text, source, dialect))
        .or_else(|| habit::prose::find(error, &text.text, source, dialect))
        .or_else(|| missing_space::before(error, source, dialect))
        .or_else(|| quote::find(error, &text.text, source));
    if explained.is_some() {
        return explained;
    }
    let repair = repair::find(error, text, source, dialect);
    if repair.as_ref().is_some_and(|repair| repair.is_sure) {
        return repair.map(|repair| repair.problem);
    }
    bracket::find(error, &text.text, source)
        .or_else(|| not_yaml::missing_dash_space(error, source))
        .or_else(|| not_yaml::missing_colon(error, source, dialect))
        .or_else(|| indentation::find(error, &text.text, source))
        .or_else(|| repair.map(|repair| repair.problem))
        .or_else(|| Some(not_yaml::diagnose(error, source)))
}

/// Whether a `*`, `&` or `!` that begins a text in the line of the error is reported.
fn is_text_told(tree: &Tree, error: &SyntaxError, source: &SourceFile) -> bool {
    let line = source.line_range(error.at);
    let anchors = tree.anchors.iter().flat_map(|anchor| anchor.definition.iter().chain(&anchor.aliases));
    let mut starts = anchors.chain(&tree.tags).filter(|at| line.contains(&(at.start as usize)));
    starts.any(|at| needs_quotes::at_start(*at, source).is_some())
}
