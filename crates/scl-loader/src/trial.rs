//! The trial of advice: each copy of the file is checked as the file itself was.

use crate::{Loaded, Request, files, schemas};
use scl_topology::advice::{self, ChangedCopy, Extent, Judged};
use scl_topology::check::{Facts, check_with_parts};
use scl_topology::diagnostic::{Diagnostic, Diagnostics};
use scl_topology::source::{FileId, SourceFile, Spanned};
use std::borrow::Cow;

/// Removes the proposals that do not solve their problem. `facts` and `of_schemas` are what the schemas of the file
/// declare, and what is wrong with them: only a copy that names other schemas has them compiled again.
pub(crate) fn try_advice(
    request: &Request,
    loaded: &mut Loaded,
    file: FileId,
    facts: &Facts,
    of_schemas: &[Diagnostic],
) {
    let mut found = Judged { problems: std::mem::take(&mut loaded.diagnostics), extent: Extent::of(&loaded.model) };
    let judge = |copies: &[ChangedCopy]| {
        let mut sources = ChangedCopy::replace_in(copies, &loaded.sources);
        let mut problems = Diagnostics::new();
        let files::Files { model, parts, .. } =
            files::read(request, file, &loaded.included, &mut sources, &mut problems);
        let names = |of: &[Spanned<String>]| of.iter().map(|name| name.value.clone()).collect::<Vec<_>>();
        let is_same = names(&model.schemas) == names(&loaded.model.schemas)
            && names(&model.schema_roots) == names(&loaded.model.schema_roots);
        let facts = match is_same {
            true => {
                problems.extend(of_schemas.iter().cloned());
                Cow::Borrowed(facts)
            }
            false => {
                let compiled = schemas::compile(request, &model, &mut sources, &mut problems);
                Cow::Owned(Facts { messages: compiled.messages, unlisted: compiled.unlisted, ..facts.clone() })
            }
        };
        let (_, problems) = check_with_parts(&model, &parts, &facts, &sources, problems);
        Judged { problems, extent: Extent::of(&model) }
    };
    let files = std::iter::once(file).chain(loaded.included.iter().map(|file| file.file));
    let files: Vec<&SourceFile> = files.map(|file| loaded.sources.file(file)).collect();
    advice::try_advice_in_files(&mut found, &files, judge);
    loaded.diagnostics = found.problems;
}
