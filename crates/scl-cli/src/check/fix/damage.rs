//! How bad a file is, to see whether a fix made it better.

use scl_loader::Loaded;
use scl_topology::advice::Extent;
use scl_topology::diagnostic::Severity;

/// Orders files by how badly they are broken. What matters most comes first: whether the file could be read; whether it
/// is YAML; where it stops being YAML, or how many of its parts could not be read; the number of errors; the number of
/// warnings. Errors come late because a part that becomes readable may contain new ones.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Damage {
    is_unreadable: bool,
    is_cut_off: bool,
    unread: usize,
    errors: usize,
    warnings: usize,
}

impl Damage {
    pub(super) fn of(loaded: &Loaded) -> Self {
        let number_of = |severity| loaded.diagnostics.iter().filter(|found| found.severity == severity).count();
        let Extent { is_cut_off, unread } = Extent::of(&loaded.model);
        Self {
            is_unreadable: loaded.file.is_none(),
            is_cut_off,
            unread: if is_cut_off { usize::MAX - first_error(loaded) } else { unread },
            errors: number_of(Severity::Error),
            warnings: number_of(Severity::Warning),
        }
    }

    /// Number of errors and warnings.
    pub(super) fn problems(&self) -> usize {
        self.errors + self.warnings
    }
}

fn first_error(loaded: &Loaded) -> usize {
    let mut errors = loaded.diagnostics.iter().filter(|found| found.severity == Severity::Error);
    errors.find_map(|found| found.primary.as_ref()).map_or(0, |label| label.span.start as usize)
}
