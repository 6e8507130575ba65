//! Where a project finds SCL: a folder, or the package registry.

use scl_terminal::Problem;
use std::fmt;
use std::path::{Component, Path, PathBuf};

/// The package that programs depend on.
const PACKAGE: &str = "scl-gates";

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What the project depends on.
#[derive(Debug, Clone)]
pub(crate) enum Dependency {
    /// The folder of the crate `scl`.
    Folder {
        /// As the project's `Cargo.toml` names it: absolute, or from the project's folder.
        path: String,
        /// As this process finds it.
        found: PathBuf,
    },
    /// This version from the package registry.
    Registry,
}

impl Dependency {
    /// The folder that this program was built from, as `cargo install --path` does. Once that folder is gone, or if the
    /// program comes from the registry, the registry.
    pub(crate) fn of_this_program() -> Self {
        let sources = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).map(|repository| repository.join("scl"));
        match sources.filter(|folder| is_scl(folder)) {
            Some(found) => match found.to_str() {
                Some(path) => Self::Folder { path: path.to_owned(), found },
                None => Self::Registry,
            },
            None => Self::Registry,
        }
    }

    /// SCL in the folder that a user names, seen from `parent`, the folder that will contain the project.
    pub(crate) fn at(parent: &Path, written: &Path) -> Result<Self, Problem> {
        let shown = written.display();
        let candidates = [written.join("scl"), written.to_owned()];
        let Some(crate_folder) = candidates.into_iter().find(|folder| is_scl(&parent.join(folder))) else {
            let found = if parent.join(written).is_dir() { "is not a copy of SCL" } else { "is not a folder" };
            return Err(Problem::new(format!("`{shown}` {found}"))
                .help("name the folder of SCL's repository, which contains `scl/Cargo.toml`")
                .help("without `--path`, the project uses the SCL that this `scl` was built from"));
        };
        let found = parent.join(&crate_folder);
        let from_project = if crate_folder.is_absolute() { crate_folder } else { Path::new("..").join(crate_folder) };
        let plain: PathBuf = from_project.components().filter(|part| *part != Component::CurDir).collect();
        match plain.to_str() {
            Some(path) => Ok(Self::Folder { path: path.to_owned(), found }),
            None => Err(Problem::new(format!("the path `{shown}` is not UTF-8, so `Cargo.toml` cannot contain it"))),
        }
    }

    pub(crate) fn is_path(&self) -> bool {
        matches!(self, Self::Folder { .. })
    }

    /// The line of the project's `Cargo.toml`.
    pub(crate) fn manifest_line(&self) -> String {
        match self {
            Self::Folder { path, .. } => format!("scl = {{ package = \"{PACKAGE}\", path = {} }}", toml_text(path)),
            Self::Registry => format!("scl = {{ package = \"{PACKAGE}\", version = \"{VERSION}\" }}"),
        }
    }

    /// The command that installs the same version of `scl`.
    pub(crate) fn install_command(&self) -> String {
        match self {
            Self::Folder { path, .. } => {
                format!("cargo install --path '{}'", beside(path, "crates/scl-cli").replace('\'', r"'\''"))
            }
            Self::Registry => format!("cargo install scl-cli --version {VERSION}"),
        }
    }

    /// The versions that SCL is tested with. Cargo removes the packages that the project does not use.
    pub(crate) fn lock_file(&self) -> Option<String> {
        match self {
            Self::Folder { found, .. } => std::fs::read_to_string(found.join("../Cargo.lock")).ok(),
            Self::Registry => None,
        }
    }
}

impl fmt::Display for Dependency {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folder { path, .. } => f.write_str(path),
            Self::Registry => write!(f, "{PACKAGE} {VERSION} of the package registry"),
        }
    }
}

/// Whether this is the folder of the crate `scl`.
fn is_scl(folder: &Path) -> bool {
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
    manifest.lines().any(|line| {
        line.split_once('=')
            .is_some_and(|(key, value)| key.trim() == "name" && value.trim() == format!("\"{PACKAGE}\""))
    })
}

/// A path in the same repository as the crate `scl`.
fn beside(path: &str, name: &str) -> String {
    Path::new(path).with_file_name(name).display().to_string()
}

/// A text as TOML writes it.
fn toml_text(text: &str) -> String {
    let letter = |letter: char| match letter {
        '"' | '\\' => format!("\\{letter}"),
        letter if letter.is_control() => format!("\\u{:04x}", u32::from(letter)),
        letter => letter.to_string(),
    };
    format!("\"{}\"", text.chars().map(letter).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_registry_is_named_by_version() {
        assert_eq!(Dependency::Registry.manifest_line(), "scl = { package = \"scl-gates\", version = \"0.1.0\" }");
        assert_eq!(Dependency::Registry.install_command(), "cargo install scl-cli --version 0.1.0");
        assert_eq!(Dependency::Registry.lock_file(), None);
    }

    #[test]
    fn paths_are_quoted_for_their_readers() {
        let path = "/it's \"here\"\\\u{7f}/scl";
        let dependency = Dependency::Folder { path: path.to_owned(), found: PathBuf::from(path) };
        let line = r#"scl = { package = "scl-gates", path = "/it's \"here\"\\\u007f/scl" }"#;
        assert_eq!(dependency.manifest_line(), line);
        let command = "cargo install --path '/it'\\''s \"here\"\\\u{7f}/crates/scl-cli'";
        assert_eq!(dependency.install_command(), command);
    }
}
