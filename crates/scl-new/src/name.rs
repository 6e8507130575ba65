//! Names of projects. They become names of systems, packages, modules and folders.

use scl_loader::{Request, load_bytes};
use scl_terminal::{Problem, quoted_list};
use scl_topology::diagnostic::{Diagnostic, Severity};
use scl_topology::rust_name::{is_keyword, is_unescapable};

/// Names of packages that cargo does not accept, or that hide a crate of the standard library.
const OF_CARGO: [&str; 5] = ["alloc", "core", "proc_macro", "std", "test"];

/// Crates that the programs name. A module of this name would hide them.
const OF_DEPENDENCIES: [&str; 3] = ["scl", "tokio", "tracing"];

/// Types that the programs name. A module of this name would hide them.
const OF_TYPES: [&str; 16] = [
    "bool", "char", "f32", "f64", "i8", "i16", "i32", "i64", "i128", "isize", "str", "u8", "u16", "u32", "u64", "usize",
];

/// The name as code spells it: the package of the messages, and the module that is generated from it.
pub(crate) fn code_name(name: &str) -> String {
    name.replace('-', "_").to_ascii_lowercase()
}

/// Checks a name before anything is written; `programs` are those of the template.
pub(crate) fn check(name: &str, programs: &[&str]) -> Result<(), Problem> {
    let shown = name.escape_debug();
    if name.contains('/') {
        let last = name.trim_end_matches('/').rsplit('/').next().unwrap_or_default().escape_debug();
        return Err(Problem::new(format!("`{shown}` is a path, not a name"))
            .help(format!("change to the folder that should contain the project, and run `scl new {last}` there")));
    }
    if name.is_empty() || name.chars().any(char::is_control) {
        return Err(Problem::new(format!("`{shown}` cannot be a name")).help("write letters, digits and `_`"));
    }
    let quoted = format!("'{}'", name.replace('\'', "''"));
    if let Some(found) = checker_problem(&quoted) {
        return Err(as_problem(name, &found));
    }
    let code = code_name(name);
    let reserved = |why: String| {
        Err(Problem::new(format!("a project cannot be called `{name}`"))
            .note(why)
            .help(format!("for example `my_{code}`")))
    };
    if code.chars().all(|letter| letter == '_') {
        return Err(Problem::new(format!("`{name}` has no letter")).help("write a word, for example `rover`"));
    }
    if checker_problem(name).is_some() {
        return reserved(format!("`{name}` means something else in YAML, unless it is quoted"));
    }
    if is_keyword(&code) || is_unescapable(&code) {
        return reserved(format!(
            "`{code}` is a keyword of Rust, and the messages of the project get a module of this name"
        ));
    }
    if OF_CARGO.contains(&code.as_str()) {
        return reserved(format!("the names {} are reserved by cargo and Rust", quoted_list(OF_CARGO)));
    }
    if OF_DEPENDENCIES.contains(&code.as_str()) {
        return reserved(format!("the project depends on a crate called `{code}`"));
    }
    if OF_TYPES.contains(&code.as_str()) {
        return reserved(format!("`{code}` is a type of Rust, which the module of the messages would hide"));
    }
    if programs.contains(&code.as_str()) {
        return reserved(format!("its components are called {}", quoted_list(programs)));
    }
    Ok(())
}

/// Returns the first error that the checker reports for a system whose name is written like this in the file.
fn checker_problem(written: &str) -> Option<Diagnostic> {
    let text = format!("system: {written}\ncomponents:\n  - name: sensor\n    gates: []\n");
    let found = load_bytes(&Request::new("topology.yaml"), text.into_bytes());
    found.diagnostics.into_iter().find(|it| it.severity == Severity::Error)
}

/// Converts an error of the checker. Its place is left out, because no file of the user contains it.
fn as_problem(name: &str, found: &Diagnostic) -> Problem {
    let problem =
        Problem::new(format!("[{}] {}", found.code(), found.message)).at(format!("`{}`", name.escape_debug()));
    let problem = found.shown_helps().fold(problem, |problem, help| problem.help(help.text()));
    found.all_notes().fold(problem, |problem, note| problem.note(note))
}
