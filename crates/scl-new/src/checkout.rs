//! The git repository of a checkout, as others reach it.

use scl_terminal::Problem;
use std::path::Path;
use std::process::{Command, Stdio};

/// A repository and one of its commits, or the newest one if `None`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Revision {
    /// As cargo accepts it: with a scheme, without a password.
    pub(crate) url: String,
    pub(crate) commit: Option<String>,
}

impl Revision {
    pub(crate) fn new(url: &str, commit: Option<String>) -> Result<Self, Problem> {
        let Some(url) = with_scheme(url) else {
            return Err(Problem::new(format!("`{}` is not the URL of a repository", scl_terminal::escape(url)))
                .help("for example `https://host/scl.git`; `--path` names a folder"));
        };
        Ok(Self { url, commit })
    }
}

/// The commit that is checked out in the folder; `None` if it is not the top folder of a repository.
pub(crate) fn head(repository: &Path) -> Option<String> {
    // The folder may be part of an unrelated repository.
    let top = git(repository, &["rev-parse", "--show-toplevel"])?;
    let is_top = Path::new(&top).canonicalize().ok()? == repository.canonicalize().ok()?;
    is_top.then(|| git(repository, &["rev-parse", "HEAD"]))?
}

/// The commit that is checked out in the folder, if a remote that others can reach has it, and nothing was changed
/// since. What the remote has is known from the last fetch or push; no network is used.
pub(crate) fn published(repository: &Path) -> Option<Revision> {
    let commit = head(repository)?;
    if git(repository, &["status", "--porcelain", "--untracked-files=no"]).is_some_and(|changes| !changes.is_empty()) {
        return None;
    }
    let branches = git(repository, &["branch", "--remotes", "--contains", "HEAD", "--format=%(refname:lstrip=2)"])?;
    let remotes = git(repository, &["remote"])?;
    let has_commit = |remote: &&str| {
        branches.lines().any(|branch| branch.strip_prefix(*remote).is_some_and(|rest| rest.starts_with('/')))
    };
    let mut urls =
        remotes.lines().filter(has_commit).filter_map(|remote| git(repository, &["remote", "get-url", remote]));
    let url = urls.find_map(|url| with_scheme(&url).filter(|url| !url.starts_with("file:")))?;
    Some(Revision { url, commit: Some(commit) })
}

/// Returns a URL as cargo accepts it; `None` for a path. Removes passwords and tokens from http URLs: they do not
/// belong in a manifest.
fn with_scheme(url: &str) -> Option<String> {
    if url.contains(|letter: char| letter.is_whitespace() || letter.is_control()) {
        return None;
    }
    if let Some((scheme, rest)) = url.split_once("://") {
        let known = ["https", "http", "ssh", "git", "file"].contains(&scheme) && !rest.is_empty();
        let (host, path) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
        return known.then(|| match (scheme, host.rsplit_once('@')) {
            ("https" | "http", Some((_, host))) => format!("{scheme}://{host}{path}"),
            _ => url.to_owned(),
        });
    }
    // The scp-like form `user@host:path`.
    let (host, path) = url.split_once(':')?;
    let is_host = host.contains('@') && !host.contains('/') && !path.is_empty();
    is_host.then(|| format!("ssh://{host}/{}", path.trim_start_matches('/')))
}

/// Returns the output of a git command, without trailing whitespace; `None` if it fails or git is not installed.
fn git(repository: &Path, arguments: &[&str]) -> Option<String> {
    let mut command = Command::new("git");
    command.arg("-C").arg(repository).args(arguments).stdin(Stdio::null()).stderr(Stdio::null());
    // Git sets these in hooks, where they name another repository.
    for variable in ["GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE"] {
        command.env_remove(variable);
    }
    let output = command.output().ok().filter(|output| output.status.success())?;
    String::from_utf8(output.stdout).ok().map(|text| text.trim_end().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use scl_needs::needs;

    #[test]
    fn urls_are_written_as_cargo_accepts_them() {
        for (written, expected) in [
            ("https://host/scl.git", Some("https://host/scl.git")),
            ("https://user:token@host/scl.git", Some("https://host/scl.git")),
            ("https://host/team@home/scl.git", Some("https://host/team@home/scl.git")),
            ("git@host:team/scl.git", Some("ssh://git@host/team/scl.git")),
            ("ssh://git@host:2222/scl.git", Some("ssh://git@host:2222/scl.git")),
            ("file:///srv/scl.git", Some("file:///srv/scl.git")),
            ("/srv/scl.git", None),
            ("../scl", None),
            ("ftp://host/scl", None),
            ("https://", None),
            ("https://host/a b", None),
            ("", None),
        ] {
            assert_eq!(with_scheme(written).as_deref(), expected, "{written}");
        }
    }

    #[needs("git")]
    #[test]
    fn only_a_commit_that_others_can_reach_is_published() {
        let folder = tempfile::tempdir().unwrap();
        let repository = folder.path().join("scl");
        let git = |arguments: &[&str]| {
            std::fs::create_dir_all(&repository).unwrap();
            let identity = ["-c", "user.name=a", "-c", "user.email=a@b"];
            super::git(&repository, &[&identity, arguments].concat()).unwrap()
        };
        git(&["init", "--quiet", "--initial-branch", "main"]);
        std::fs::write(repository.join("file"), "1").unwrap();
        git(&["add", "file"]);
        git(&["commit", "--quiet", "--message", "first"]);
        let commit = head(&repository).unwrap();
        assert_eq!(published(&repository), None, "no remote");

        git(&["remote", "add", "local", "/srv/scl.git"]);
        git(&["update-ref", "refs/remotes/local/main", "HEAD"]);
        assert_eq!(published(&repository), None, "a remote of this machine only");

        git(&["remote", "add", "origin", "git@host:team/scl.git"]);
        assert_eq!(published(&repository), None, "not pushed");
        git(&["update-ref", "refs/remotes/origin/main", "HEAD"]);
        let expected = Revision { url: "ssh://git@host/team/scl.git".to_owned(), commit: Some(commit) };
        assert_eq!(published(&repository), Some(expected));

        std::fs::write(repository.join("file"), "2").unwrap();
        assert_eq!(published(&repository), None, "changed since");
        std::fs::create_dir(repository.join("folder")).unwrap();
        assert_eq!(head(&repository.join("folder")), None, "inside the repository of something else");
    }
}
