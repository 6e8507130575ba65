//! Topology files from disk or standard input, for every command, and their problems on standard error.

use crate::exit::COULD_NOT_DO;
use anstream::{AutoStream, ColorChoice};
use clap::Args;
use scl_loader::{Loaded, Request, load, load_bytes};
use scl_terminal::print_err;
use scl_text::size;
use scl_topology::diagnostic::{Diagnostic, MOST_LISTED, Severity, limit, render, render_styled};
use scl_topology::external::UNREADABLE_FILE;
use std::io::{self, Read};
use std::path::Path;
use std::process::ExitCode;

/// The topology file that is used if there is one in the working folder.
pub(crate) const TOPOLOGY: &str = "topology.yaml";

/// The path that stands for standard input.
pub(crate) const STDIN: &str = "-";

/// What messages call standard input.
const STDIN_NAME: &str = "<stdin>";

/// How messages name a file: as the user did.
pub(crate) fn shown_path(path: &Path) -> String {
    if path.as_os_str() == STDIN { STDIN_NAME.to_owned() } else { path.display().to_string() }
}

/// How large a file may be.
#[derive(Debug, Clone, Copy, Default, Args)]
pub(crate) struct MaxSize {
    /// Accept files up to this size, for example 8MiB, as `max_size` of the macro does [default: 1MiB].
    #[arg(long, value_name = "SIZE", value_parser = parse_size)]
    max_size: Option<u64>,
}

/// Reads `8MiB`, as in the topology file.
pub(crate) fn parse_size(text: &str) -> Result<u64, String> {
    size::parse(text).map_err(|_| match size::suggestions(text).as_slice() {
        [] => "expected a whole number and a unit, for example `8MiB`".to_owned(),
        likely => format!("did you mean `{}`?", likely.join("` or `")),
    })
}

/// What to load for a path; `-` is standard input.
pub(crate) fn request(path: &Path, max_size: MaxSize) -> Request {
    let max_size = max_size.max_size.unwrap_or(Request::MAX_SIZE);
    if path.as_os_str() != STDIN {
        return Request { max_size, ..Request::new(path) };
    }
    // As if the text were `topology.yaml` in the working folder, which determines where schemas are searched for and
    // the system's default name.
    Request { shown_as: STDIN_NAME.to_owned(), max_size, ..Request::new(TOPOLOGY) }
}

/// Reads and checks a file, or standard input for `-`.
pub(crate) fn load_file(path: &Path, max_size: MaxSize) -> Loaded {
    let request = request(path, max_size);
    if path.as_os_str() != STDIN {
        return load(&request);
    }
    let mut bytes = Vec::new();
    match io::stdin().lock().take(request.max_size.saturating_add(1)).read_to_end(&mut bytes) {
        Ok(_) => load_bytes(&request, bytes),
        Err(error) => {
            let problem = UNREADABLE_FILE.without_place("standard input cannot be read").note(error.to_string());
            Loaded { diagnostics: vec![problem], ..Loaded::default() }
        }
    }
}

/// The name of the system in the working folder, if its topology file has one.
#[cfg(feature = "run")]
pub(crate) fn system_of_folder() -> Option<String> {
    let path = Path::new(TOPOLOGY);
    // Errors elsewhere in the file do not matter.
    let loaded = path.is_file().then(|| load_file(path, MaxSize::default()))?;
    let checked = loaded.topology.as_ref().map(|topology| topology.system().to_owned());
    checked.or_else(|| Some(loaded.model.system?.value))
}

/// Returns the topology file in the working folder if it gives its system no name, so that the system is named after
/// the file.
#[cfg(feature = "run")]
pub(crate) fn named_after_here() -> Option<std::path::PathBuf> {
    let path = Path::new(TOPOLOGY);
    let loaded = path.is_file().then(|| load_file(path, MaxSize::default()))?;
    if loaded.model.system.is_some() { None } else { path.canonicalize().ok() }
}

/// Shows diagnostics on standard error, each followed by an empty line.
pub(crate) fn show_diagnostics<'d>(loaded: &Loaded, shown: impl IntoIterator<Item = &'d Diagnostic>) {
    let plain = matches!(AutoStream::choice(&io::stderr()), ColorChoice::Never);
    let render = if plain { render } else { render_styled };
    shown.into_iter().for_each(|it| print_err(&format!("{}\n\n", render(it, &loaded.sources))));
}

/// Shows those problems of a topology file that are at least as bad as `worst`: the first ones if there are many.
pub(crate) fn show_problems(loaded: &Loaded, worst: Severity) {
    let path = loaded.file.map_or("", |file| loaded.sources.file(file).path());
    let shown = loaded.diagnostics.iter().filter(|it| it.severity <= worst).cloned().collect();
    show_diagnostics(loaded, &limit(shown, MOST_LISTED, path));
}

/// Shows the errors, and returns the exit code of a command that needs a topology without errors: 1, or 2 if the file
/// could not be read.
pub(crate) fn unsound(loaded: &Loaded) -> ExitCode {
    show_errors(loaded);
    ExitCode::from(if loaded.file.is_some() { 1 } else { COULD_NOT_DO })
}

/// Shows only the errors, for commands that cannot continue with them.
pub(crate) fn show_errors(loaded: &Loaded) {
    show_problems(loaded, Severity::Error);
}
