//! The parser's errors, sorted into the groups that our rules tell apart.

use granit_parser::{ErrorKind, ScanError};

/// Where and why a text stops being valid YAML.
#[derive(Debug, Clone)]
pub(crate) struct SyntaxError {
    /// The byte at which the parser noticed it, often after the place of the mistake.
    pub(crate) at: usize,
    /// The group.
    pub(crate) kind: SyntaxErrorKind,
    /// The parser's message.
    pub(crate) words: String,
}

/// The groups of syntax errors, by the rules that may explain them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum SyntaxErrorKind {
    /// A quoted text does not end, or goes on after its end.
    Quote,
    /// A `[` or `{` right after a colon.
    Glued,
    /// A character that starts no value.
    Character(char),
    /// A tab in a place where only spaces can be.
    Tab,
    /// An anchor, alias or tag that is not well formed.
    Property,
    /// `%` at the start of a line.
    Directive,
    /// A limit of the parser, far beyond ours.
    Limit,
    /// Everything else.
    Other,
}

impl SyntaxError {
    pub(super) fn new(error: &ScanError, text_len: usize) -> Self {
        let at = error.marker().byte_offset().unwrap_or(text_len).min(text_len);
        Self { at, kind: kind_of(error.kind()), words: error.kind().to_string() }
    }
}

fn kind_of(kind: &ErrorKind) -> SyntaxErrorKind {
    use ErrorKind as E;
    match kind {
        E::FlowMappingValueAdjacentCollection => SyntaxErrorKind::Glued,
        E::UnclosedQuotedScalar
        | E::DocumentIndicatorInQuotedScalar
        | E::InvalidQuotedScalarIndent
        | E::InvalidTrailingSingleQuotedScalar
        | E::InvalidTrailingDoubleQuotedScalar => SyntaxErrorKind::Quote,
        E::UnexpectedCharacter { character } => SyntaxErrorKind::Character(*character),
        E::TabNotAllowed
        | E::TabInBlockIndentation
        | E::TabAtBlockScalarStart
        | E::TabInIndentation
        | E::TabInPlainScalar => SyntaxErrorKind::Tab,
        E::MissingAnchorOrAliasName | E::UndeclaredTagHandle => SyntaxErrorKind::Property,
        E::DirectiveDisallowed | E::MissingDocumentEndBeforeDirective => SyntaxErrorKind::Directive,
        E::RecursionLimitExceeded => SyntaxErrorKind::Limit,
        _ => SyntaxErrorKind::Other,
    }
}
