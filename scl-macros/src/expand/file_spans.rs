//! Positions in the topology file as spans of rustc. Only a nightly compiler provides them, with the feature `nightly`.
//!
//! Without them every problem is reported at the path literal, and its text names the position.

use super::context::Context;
use proc_macro2::Span;
use scl_topology::diagnostic::Diagnostic;
#[cfg(feature = "nightly")]
use std::path::Path;

/// The topology file as the compiler knows it.
pub(super) struct FileSpans {
    #[cfg(feature = "nightly")]
    whole: Option<proc_macro::Literal>,
}

impl FileSpans {
    /// Without the feature there are no spans.
    #[cfg(not(feature = "nightly"))]
    pub(super) fn of(_context: &Context<'_>) -> Self {
        Self {}
    }

    /// Makes the compiler include the file. Tools other than rustc may not support that.
    #[cfg(feature = "nightly")]
    pub(super) fn of(context: &Context<'_>) -> Self {
        let path = context.loaded.file.and_then(|_| context.loaded.files_read.first());
        Self { whole: path.and_then(|path| include(path, context.span)) }
    }

    /// Where a problem is reported: the path literal.
    #[cfg(not(feature = "nightly"))]
    pub(super) fn span(&self, context: &Context<'_>, _problem: &Diagnostic) -> Span {
        context.span
    }

    /// Where a problem is reported: its position in the topology file if that is known, otherwise the path literal.
    #[cfg(feature = "nightly")]
    pub(super) fn span(&self, context: &Context<'_>, problem: &Diagnostic) -> Span {
        self.find(context, problem).unwrap_or(context.span)
    }

    #[cfg(feature = "nightly")]
    fn find(&self, context: &Context<'_>, problem: &Diagnostic) -> Option<Span> {
        let (whole, position) = (self.whole.as_ref()?, problem.primary.as_ref()?.span);
        if Some(position.file) != context.loaded.file {
            return None;
        }
        let text = context.loaded.sources.file(position.file).text();
        let range = rustc_offset(text, position.start)..rustc_offset(text, position.end);
        let found = whole.subspan(range)?;
        // Names still resolve where the macro is invoked, and rustc does not add "originates in the macro".
        Some(context.span.located_at(found.into()))
    }
}

/// The expansion of `include_str!`: a literal whose span is the whole file.
#[cfg(feature = "nightly")]
fn include(path: &Path, span: Span) -> Option<proc_macro::Literal> {
    // Unit tests run outside of the compiler.
    if !proc_macro::is_available() {
        return None;
    }
    let path = relative_to(path, span.unwrap().local_file().as_deref().and_then(Path::parent))?;
    let invocation: proc_macro::TokenStream = quote::quote_spanned!(span => ::core::include_str!(#path)).into();
    match invocation.expand_expr().ok()?.into_iter().next()? {
        proc_macro::TokenTree::Literal(literal) => Some(literal),
        _ => None,
    }
}

/// The path relative to the source file's folder if the file is inside it. Messages name the file by this path.
#[cfg(feature = "nightly")]
fn relative_to(path: &Path, folder: Option<&Path>) -> Option<String> {
    let path = std::path::absolute(path).ok()?;
    let folder = folder.and_then(|folder| std::path::absolute(folder).ok());
    let inside = folder.as_deref().and_then(|folder| path.strip_prefix(folder).ok());
    inside.unwrap_or(&path).to_str().map(str::to_owned)
}

/// A byte offset as rustc counts it: for every file, as if each line ended in `\n` only.
#[cfg(any(feature = "nightly", test))]
fn rustc_offset(text: &str, byte: u32) -> usize {
    let byte = byte as usize;
    byte - text.as_bytes()[..byte.min(text.len())].windows(2).filter(|pair| pair == b"\r\n").count()
}

#[cfg(test)]
mod tests {
    use super::rustc_offset;

    #[test]
    fn only_line_ends_of_two_bytes_count_less() {
        let text = "a:\r\n  b\rc\r\nd";
        let counted = |found: &str| rustc_offset(text, text.find(found).unwrap() as u32);
        assert_eq!([counted("a"), counted("b"), counted("c"), counted("d")], [0, 5, 7, 9]);
    }
}
