//! Where a project finds SCL: a folder, a git repository, or the package registry.

use crate::checkout::{Revision, head, published};
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
    Git(Revision),
    /// This version from the package registry.
    Registry,
}

impl Dependency {
    /// The revision that this program was built from, if its checkout has a remote that has it, too; otherwise the
    /// folder of the checkout. Once that is gone, or if the program comes from the registry, the registry.
    pub(crate) fn of_this_program() -> Self {
        let Some(found) = own_sources() else { return Self::Registry };
        match (found.parent().and_then(published), found.to_str()) {
            (Some(revision), _) => Self::Git(revision),
            (None, Some(path)) => Self::Folder { path: path.to_owned(), found },
            (None, None) => Self::Registry,
        }
    }

    /// A repository that a user names. The default revision is the one that this program was built from.
    pub(crate) fn in_repository(url: &str, revision: Option<&str>) -> Result<Self, Problem> {
        let commit = match revision {
            Some(revision) => Some(revision.to_owned()),
            None => own_sources().and_then(|sources| head(sources.parent()?)),
        };
        Ok(Self::Git(Revision::new(url, commit)?))
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

    /// What a user should know before handing the project on.
    pub(crate) fn note(&self) -> Option<String> {
        match self {
            Self::Folder { path, .. } => Some(format!(
                "it builds on this machine only, because SCL is at `{path}`; `--git URL` names a repository that others can reach"
            )),
            Self::Git(Revision { commit: None, .. }) => {
                Some("it uses the newest commit of that repository; `--rev COMMIT` pins one".to_owned())
            }
            Self::Git(_) => None,
            Self::Registry => {
                Some("if the registry does not have it, use `--git` or `--path` with SCL's repository".to_owned())
            }
        }
    }

    /// The line of the project's `Cargo.toml`.
    pub(crate) fn manifest_line(&self) -> String {
        match self {
            Self::Folder { path, .. } => format!("scl = {{ package = \"{PACKAGE}\", path = {} }}", toml_text(path)),
            Self::Git(Revision { url, commit }) => {
                let rev = commit.as_ref().map(|commit| format!(", rev = {}", toml_text(commit))).unwrap_or_default();
                format!("scl = {{ package = \"{PACKAGE}\", git = {}{rev} }}", toml_text(url))
            }
            Self::Registry => format!("scl = {{ package = \"{PACKAGE}\", version = \"{VERSION}\" }}"),
        }
    }

    /// The command that installs the same version of `scl`.
    pub(crate) fn install_command(&self) -> String {
        match self {
            Self::Folder { path, .. } => {
                let command = Path::new(path).with_file_name("crates/scl-cli");
                format!("cargo install --path {}", shell_text(&command.display().to_string()))
            }
            Self::Git(Revision { url, commit }) => {
                let rev = commit.as_ref().map(|commit| format!(" --rev {}", shell_text(commit))).unwrap_or_default();
                format!("cargo install --git {}{rev} scl-cli", shell_text(url))
            }
            Self::Registry => format!("cargo install scl-cli --version {VERSION}"),
        }
    }

    /// The lock file with the versions that SCL is tested with. Cargo removes the packages that the project does not
    /// use.
    pub(crate) fn lock_file(&self) -> Option<String> {
        match self {
            Self::Folder { found, .. } => std::fs::read_to_string(found.join("../Cargo.lock")).ok(),
            Self::Git(_) => own_sources().and_then(|scl| std::fs::read_to_string(scl.join("../Cargo.lock")).ok()),
            Self::Registry => None,
        }
    }
}

impl fmt::Display for Dependency {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folder { path, .. } => f.write_str(path),
            Self::Git(Revision { url, commit: None }) => f.write_str(url),
            Self::Git(Revision { url, commit: Some(commit) }) => write!(f, "{url} at {commit}"),
            Self::Registry => write!(f, "{PACKAGE} {VERSION} of the package registry"),
        }
    }
}

/// The folder of the crate `scl` in the checkout that this program was built from, if it is still there.
fn own_sources() -> Option<PathBuf> {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2)?.join("scl");
    is_scl(&sources).then_some(sources)
}

/// Whether this is the folder of the crate `scl`.
fn is_scl(folder: &Path) -> bool {
    let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
    manifest.lines().any(|line| {
        line.split_once('=')
            .is_some_and(|(key, value)| key.trim() == "name" && value.trim() == format!("\"{PACKAGE}\""))
    })
}

/// Quotes a text as one word of a shell.
fn shell_text(text: &str) -> String {
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// Quotes a text as a TOML string.
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
    fn repositories_are_named_by_url_and_commit() {
        let at = |commit| Dependency::in_repository("https://host/it's.git", commit).unwrap();
        let dependency = at(Some("4f1d2ab"));
        let line = r#"scl = { package = "scl-gates", git = "https://host/it's.git", rev = "4f1d2ab" }"#;
        assert_eq!(dependency.manifest_line(), line);
        let command = r"cargo install --git 'https://host/it'\''s.git' --rev '4f1d2ab' scl-cli";
        assert_eq!(dependency.install_command(), command);
        assert_eq!(dependency.note(), None);
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
