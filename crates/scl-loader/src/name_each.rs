//! What to write in the place of a folder or a pattern: the files that it stands for.

use scl_text::list::quoted_list;
use scl_topology::diagnostic::{Diagnostic, Edit, separator};
use scl_topology::source::{Sources, Spanned};

/// Maximum number of files that are written.
const MOST: usize = 10;

/// Suggests to name each of the `files` in the place of an entry; `otherwise`, if there are none or too many.
pub(crate) fn name_each(
    problem: Diagnostic,
    entry: &Spanned<String>,
    files: &[String],
    sources: &Sources,
    otherwise: &str,
) -> Diagnostic {
    let separator = separator(sources.file(entry.span.file), entry.span);
    match separator.filter(|_| (1..=MOST).contains(&files.len())) {
        Some(separator) => {
            let edit = Edit::new(entry.span, files.join(&separator));
            problem.suggest(format!("name each of them: {}", quoted_list(files)), [edit])
        }
        None => problem.help(otherwise),
    }
}
