//! Names for which `scl generate` would refuse a topology without errors.

use super::CheckArguments;
#[cfg(feature = "generate")]
use super::Format;
#[cfg(feature = "generate")]
use crate::generate::Language;
#[cfg(feature = "generate")]
use clap::ValueEnum;
use scl_loader::Loaded;
use scl_topology::diagnostic::Diagnostic;

/// What `scl generate` would refuse.
#[derive(Default)]
pub(super) struct Refusals {
    /// In the languages given with `--for`.
    pub(super) problems: Vec<Diagnostic>,
    /// In the others, one line for each: names that clash only there are no problem of the file, unless it has such
    /// programs.
    pub(super) notes: Vec<String>,
}

impl Refusals {
    #[cfg(not(feature = "generate"))]
    pub(super) fn of(_: &Loaded, _: &CheckArguments) -> Self {
        Self::default()
    }

    #[cfg(feature = "generate")]
    pub(super) fn of(loaded: &Loaded, arguments: &CheckArguments) -> Self {
        let asked_for = &arguments.languages;
        let mut others = vec![Language::C, Language::Cpp, Language::Python];
        others.retain(|other| arguments.format == Format::Text && !asked_for.contains(other));
        if asked_for.is_empty() && others.is_empty() {
            return Self::default();
        }
        let Some(system) = scl_generate::System::of(loaded) else { return Self::default() };
        let clashes = |language: &Language| scl_generate::find_clashes(&system, language.target());
        let notes = others.iter().filter_map(|other| {
            let clash = clashes(other).into_iter().next()?;
            let word = other.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
            Some(format!("{}; `scl check --for {word}` shows where\n", clash.message))
        });
        Self { problems: asked_for.iter().flat_map(clashes).collect(), notes: notes.collect() }
    }
}
