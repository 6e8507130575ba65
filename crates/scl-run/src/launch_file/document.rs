//! A launch file as YAML with places: reports its mistakes, and where they are.

use super::LaunchFile;
use super::dialect::LAUNCH;
use super::reader::Reader;
use super::rules::{UNCHECKED, WRONG_VALUE};
use super::unset::unset_parameters;
use crate::system_names::SystemNames;
use scl_terminal::Problem;
use scl_topology::advice::{Extent, Judged, try_advice};
use scl_topology::diagnostic::{Diagnostic, Diagnostics, Edit, Severity, render};
use scl_topology::parse::{Document, read_document};
use scl_topology::source::{FileId, SourceFile, Sources};
use scl_topology::yaml::Node;

/// The YAML of a launch file, parsed.
pub(crate) struct LaunchDocument {
    pub(super) sources: Sources,
    file: FileId,
    document: Document,
    /// The problems that were found while the YAML was parsed, with advice that was not tried yet.
    found: Vec<Diagnostic>,
}

impl LaunchDocument {
    /// Reads the YAML; `path` is how messages name the file.
    pub(crate) fn parse(path: &str, text: &str) -> Self {
        let mut sources = Sources::new();
        let file = sources.add(path, text);
        Self::of(sources, file)
    }

    fn of(sources: Sources, file: FileId) -> Self {
        let mut problems = Diagnostics::new();
        let document = read_document(sources.file(file), &LAUNCH, &mut problems);
        Self { sources, file, document, found: problems.into_sorted() }
    }

    /// The topology file that the launch file names. [`read`](Self::read) reports a value that is not a path.
    fn topology(&self) -> Option<(&str, &Node)> {
        let mut entries = self.document.root.as_ref()?.entries()?.iter();
        let (_, value) = entries.find(|(key, _)| key.text() == Some("topology"))?;
        let path = value.text().filter(|path| !path.is_empty())?;
        Some((path, value))
    }

    /// The topology file that the launch file names, and the place where it is named.
    pub(crate) fn topology_with_place(&self) -> Option<(&str, String)> {
        self.topology().map(|(path, value)| (path, self.source().place(value.span)))
    }

    /// Checks that all of the text could be parsed.
    ///
    /// # Errors
    ///
    /// The problems in the text.
    pub(crate) fn check_text(&self) -> Result<(), Vec<Problem>> {
        if self.document.is_partial { self.read_shown(None).map(drop) } else { Ok(()) }
    }

    /// Reads the keys; `known` are the names of the topology where there is one.
    ///
    /// # Errors
    ///
    /// Every mistake of the file, sorted by place. If a part of the text cannot be parsed, only the problems of the
    /// text: any others may be consequences. Warnings alone are no mistakes.
    pub(crate) fn read(&self, known: Option<&SystemNames>) -> Result<LaunchFile, Vec<Diagnostic>> {
        let (file, problems) = self.check(known);
        let is_wrong = problems.iter().any(|problem| problem.severity == Severity::Error);
        if is_wrong { Err(problems) } else { Ok(file) }
    }

    /// What the file says, as far as it can be read, and its mistakes and warnings with advice that was tried.
    pub(super) fn check(&self, known: Option<&SystemNames>) -> (LaunchFile, Vec<Diagnostic>) {
        let (file, problems) = self.judge(known);
        let mut found = self.judged(problems);
        try_advice(&mut found, self.source(), |copy| {
            let copy = Self::of(self.sources.with_text(self.file, copy), self.file);
            copy.judged(copy.judge(known).1)
        });
        (file, found.problems)
    }

    fn judged(&self, problems: Vec<Diagnostic>) -> Judged {
        Judged { problems, extent: Extent { is_cut_off: self.document.is_partial, unread: 0 } }
    }

    /// What the file says, as far as it can be read, and its problems.
    fn judge(&self, known: Option<&SystemNames>) -> (LaunchFile, Vec<Diagnostic>) {
        if self.document.is_partial {
            return (LaunchFile::default(), self.found.clone());
        }
        let (file, mut problems) = Reader::new(self.source(), known, &LAUNCH).read(&self.document);
        // Drop problems at the place of a syntax problem: they are its consequences.
        let place = |problem: &Diagnostic| problem.primary.as_ref().map(|label| label.span);
        problems.retain(|problem| !self.found.iter().any(|of_text| place(of_text) == place(problem)));
        problems.extend(self.found.iter().cloned());
        let mut found = problems.into_sorted();
        // A value with several aliases is read, and reported, several times.
        found.dedup();
        (file, found)
    }

    /// Like [`read`](Self::read), with problems that are rendered for the user.
    pub(crate) fn read_shown(&self, known: Option<&SystemNames>) -> Result<LaunchFile, Vec<Problem>> {
        self.read(known).map_err(|found| self.problems(&found))
    }

    fn problems(&self, found: &[Diagnostic]) -> Vec<Problem> {
        found.iter().map(|problem| Problem::rendered(render(problem, &self.sources))).collect()
    }

    fn source(&self) -> &SourceFile {
        self.sources.file(self.file)
    }
}

/// The result of looking for the topology of a launch file.
#[derive(Debug)]
pub enum LaunchTopology {
    /// There is none: names are not checked.
    None,
    /// The topology file at this path has errors, so names cannot be checked.
    Wrong(String),
    /// The launch file names a topology file that does not exist; these may be meant.
    Missing(Vec<String>),
    /// The names in the topology.
    Names(SystemNames),
}

/// What is wrong with a launch file.
#[derive(Debug)]
pub struct CheckedLaunchFile {
    /// Every mistake, sorted by place.
    pub diagnostics: Vec<Diagnostic>,
    /// A part of the text could not be read.
    pub is_partial: bool,
}

/// Checks a launch file. `topology` finds the names of the topology; it gets the path of the file that the launch file
/// names, if it names one.
pub fn check_launch_file(
    sources: &Sources,
    file: FileId,
    topology: impl FnOnce(Option<&str>) -> LaunchTopology,
) -> CheckedLaunchFile {
    let document = LaunchDocument::of(sources.clone(), file);
    let found = topology(document.topology().map(|(path, _)| path));
    let known = if let LaunchTopology::Names(names) = &found { Some(names) } else { None };
    let (launch, mut diagnostics) = document.check(known);
    // Not tried with the advice: the fix of a mistake would bring them to light, and be refused.
    let is_sound = diagnostics.iter().all(|problem| problem.severity != Severity::Error);
    let unset = known.zip(document.document.root.as_ref()).filter(|_| is_sound);
    diagnostics.extend(unset.into_iter().flat_map(|(known, root)| unset_parameters(root, &launch, known)));
    diagnostics.sort_by_key(|problem| problem.primary.as_ref().map(|label| label.span));
    let of_topology = match (&found, document.topology()) {
        (LaunchTopology::Missing(likely), Some((path, field))) => {
            let message = format!("the topology file does not exist: `{path}`");
            let problem = WRONG_VALUE.at(message, field.span, "");
            let problem = likely.iter().fold(problem, |problem, path| {
                problem.suggest(format!("did you mean `{path}`?"), [Edit::new(field.span, path)])
            });
            Some(problem.note("paths are relative to the folder of the launch file"))
        }
        (LaunchTopology::Wrong(path), _) => {
            let problem =
                UNCHECKED.without_place(format!("the topology `{path}` has errors, so names are not checked"));
            Some(problem.help(format!("run `scl check {path}`")))
        }
        _ => None,
    };
    diagnostics.splice(0..0, of_topology);
    CheckedLaunchFile { diagnostics, is_partial: document.document.is_partial }
}

#[cfg(test)]
mod tests;
