//! The crates that the code being compiled can name, as passed to the compiler with `--extern`.

use std::collections::BTreeSet;
use std::path::Path;

/// The names of the crates, or `None` if they are not known: rust-analyzer runs macros without these arguments, and
/// rustdoc is to show types as they are written.
pub(crate) fn of_compiler() -> Option<BTreeSet<String>> {
    let program = std::env::current_exe().ok()?;
    if program.file_stem()?.to_string_lossy().contains("rustdoc") {
        return None;
    }
    of_arguments(std::env::args_os().skip(1).filter_map(|argument| argument.into_string().ok()))
}

/// Reads the names from the compiler's arguments. Every program that calls the macro names at least `scl`, so without
/// any name the crates are not known.
fn of_arguments(arguments: impl Iterator<Item = String>) -> Option<BTreeSet<String>> {
    let arguments = arguments.flat_map(|argument| match argument.strip_prefix('@') {
        // Cargo writes the arguments to a file, one per line, if they are too long for a command line.
        Some(file) => std::fs::read_to_string(Path::new(file)).unwrap_or_default().lines().map(str::to_owned).collect(),
        None => vec![argument],
    });
    let mut names = BTreeSet::new();
    let mut is_value = false;
    for argument in arguments {
        let value = if is_value { Some(argument.as_str()) } else { argument.strip_prefix("--extern=") };
        names.extend(value.and_then(name));
        is_value = !is_value && argument == "--extern";
    }
    (!names.is_empty()).then_some(names)
}

/// The name in `[options:]name[=path]`, unless the option `noprelude` keeps it out of scope.
fn name(value: &str) -> Option<String> {
    let before_path = value.split('=').next().unwrap_or_default();
    let (options, name) = before_path.rsplit_once(':').unwrap_or(("", before_path));
    (!options.split(',').any(|option| option == "noprelude")).then(|| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(arguments: &[&str]) -> Option<Vec<String>> {
        let arguments = arguments.iter().map(|&argument| argument.to_owned());
        of_arguments(arguments).map(|names| names.into_iter().collect())
    }

    #[test]
    fn names_come_from_every_form_of_the_option() {
        let arguments = [
            "--crate-name",
            "gps",
            "--extern",
            "scl=/d/libscl.rlib",
            "--extern=camera=x",
            "--extern",
            "priv,nounused:nav=y",
            "--extern",
            "proc_macro",
            "--extern=noprelude:hidden=z",
        ];
        let expected = ["camera", "nav", "proc_macro", "scl"].map(str::to_owned).to_vec();
        assert_eq!(names(&arguments), Some(expected));
        assert_eq!(names(&["--crate-name", "gps"]), None);
    }

    #[test]
    fn long_arguments_are_in_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("arguments");
        std::fs::write(&file, "--extern\nscl=/a b/libscl.rlib\n--extern=camera\n").unwrap();
        let found = names(&[&format!("@{}", file.display())]);
        assert_eq!(found, Some(vec!["camera".to_owned(), "scl".to_owned()]));
    }
}
