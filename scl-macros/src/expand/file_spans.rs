//! Places in the topology file as rustc's own spans, which only a nightly compiler gives, with the feature `nightly`.
//!
//! Without them every problem is shown at the path literal, with the place in its text.

use super::call::Call;
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
    /// Without the feature there are none.
    #[cfg(not(feature = "nightly"))]
    pub(super) fn of(_call: &Call<'_>) -> Self {
        Self {}
    }

    /// Lets the compiler include the file; it gives none to tools other than rustc.
    #[cfg(feature = "nightly")]
    pub(super) fn of(call: &Call<'_>) -> Self {
        let path = call.loaded.file.and_then(|_| call.loaded.files_read.first());
        Self { whole: path.and_then(|path| include(path, call.span)) }
    }

    /// Where a problem is shown: at its place in the topology file if that is known, otherwise at the path literal.
    #[cfg(not(feature = "nightly"))]
    pub(super) fn span(&self, call: &Call<'_>, _problem: &Diagnostic) -> Span {
        call.span
    }

    /// Where a problem is shown: at its place in the topology file if that is known, otherwise at the path literal.
    #[cfg(feature = "nightly")]
    pub(super) fn span(&self, call: &Call<'_>, problem: &Diagnostic) -> Span {
        self.find(call, problem).unwrap_or(call.span)
    }

    #[cfg(feature = "nightly")]
    fn find(&self, call: &Call<'_>, problem: &Diagnostic) -> Option<Span> {
        let (whole, at) = (self.whole.as_ref()?, problem.primary.as_ref()?.span);
        if Some(at.file) != call.loaded.file {
            return None;
        }
        let text = call.loaded.sources.file(at.file).text();
        let place = whole.subspan(as_counted_by_rustc(text, at.start)..as_counted_by_rustc(text, at.end))?;
        // Names are still looked up where the macro is called, and no "originates in the macro" is printed.
        Some(call.span.located_at(place.into()))
    }
}

/// What `include_str!` of the file expands to: a literal whose span is the whole file.
#[cfg(feature = "nightly")]
fn include(path: &Path, span: Span) -> Option<proc_macro::Literal> {
    // Unit tests run outside of the compiler.
    if !proc_macro::is_available() {
        return None;
    }
    let path = seen_from(path, span.unwrap().local_file().as_deref().and_then(Path::parent))?;
    let call: proc_macro::TokenStream = quote::quote_spanned!(span => ::core::include_str!(#path)).into();
    match call.expand_expr().ok()?.into_iter().next()? {
        proc_macro::TokenTree::Literal(literal) => Some(literal),
        _ => None,
    }
}

/// The path relative to the source file's folder if it lies inside, because messages name the file by it.
#[cfg(feature = "nightly")]
fn seen_from(path: &Path, folder: Option<&Path>) -> Option<String> {
    let path = std::path::absolute(path).ok()?;
    let folder = folder.and_then(|folder| std::path::absolute(folder).ok());
    let inside = folder.as_deref().and_then(|folder| path.strip_prefix(folder).ok());
    inside.unwrap_or(&path).to_str().map(str::to_owned)
}

/// The compiler counts the bytes of a file as if its lines ended in `\n` only, as it does for Rust files.
#[cfg(any(feature = "nightly", test))]
fn as_counted_by_rustc(text: &str, byte: u32) -> usize {
    let byte = byte as usize;
    byte - text.as_bytes()[..byte.min(text.len())].windows(2).filter(|pair| pair == b"\r\n").count()
}

#[cfg(test)]
mod tests {
    use super::as_counted_by_rustc;

    #[test]
    fn only_line_ends_of_two_bytes_count_less() {
        let text = "a:\r\n  b\rc\r\nd";
        let counted = |found: &str| as_counted_by_rustc(text, text.find(found).unwrap() as u32);
        assert_eq!([counted("a"), counted("b"), counted("c"), counted("d")], [0, 5, 7, 9]);
    }
}
