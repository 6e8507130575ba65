//! The trial of advice: each copy of the file is checked as the file itself was.

use crate::{Loaded, Request, schemas};
use scl_topology::advice::{self, Extent, Judged};
use scl_topology::check::{Facts, check};
use scl_topology::diagnostic::{Diagnostic, Diagnostics};
use scl_topology::parse::parse;
use scl_topology::source::{FileId, Spanned};
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
    let judge = |text: &str| {
        let mut sources = loaded.sources.with_text(file, text);
        let mut problems = Diagnostics::new();
        let model = parse(&sources, file, &mut problems);
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
        check(&model, &facts, &sources, &mut problems);
        Judged { problems: problems.into_sorted(), extent: Extent::of(&model) }
    };
    advice::try_advice(&mut found, loaded.sources.file(file), judge);
    loaded.diagnostics = found.problems;
}
