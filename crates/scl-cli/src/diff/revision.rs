//! A topology and its schemas at a git revision, checked out into a temporary folder.

use scl_terminal::{Problem, escape};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// The files of one revision.
pub(super) struct Revision {
    /// Deleted when this is dropped.
    _folder: TempDir,
    /// The topology file.
    pub(super) path: PathBuf,
    /// For messages: `HEAD~1:topology.yaml`.
    pub(super) shown: String,
}

impl Revision {
    /// Reads the topology file `path`, and all files of its repository that it may include or name as schemas.
    ///
    /// # Errors
    /// The file is not in a git repository, there is no such revision, or it does not have the file.
    pub(super) fn read(name: &str, path: &Path) -> Result<Self, Problem> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let top = git(folder, &["rev-parse", "--show-toplevel"])
            .map_err(|note| Problem::new(format!("`{}` is not in a git repository", folder.display())).note(note))?;
        let prefix = git(folder, &["rev-parse", "--show-prefix"]).map_err(unreadable)?;
        let top = Path::new(&top);
        let commit = format!("{name}^{{commit}}");
        let commit = git(top, &["rev-parse", "--verify", "--quiet", "--end-of-options", &commit])
            .map_err(|note| unknown(top, name, &note))?;
        let target = tempfile::tempdir().map_err(unreadable)?;
        let index = target.path().join("index");
        let wanted = format!("{prefix}{file}");
        let with_index = |arguments: &[&str], input: &[u8]| run(top, arguments, Some(&index), input);
        with_index(&["read-tree", &commit], &[]).map_err(unreadable)?;
        let all = with_index(&["ls-files", "-z"], &[]).map_err(unreadable)?;
        let is_needed = |name: &&[u8]| {
            [".proto", ".yaml", ".yml"].iter().any(|end| name.ends_with(end.as_bytes())) || *name == wanted.as_bytes()
        };
        let names: Vec<&[u8]> = all.split(|byte| *byte == 0).filter(is_needed).collect();
        if !names.contains(&wanted.as_bytes()) {
            return Err(Problem::new(format!("revision `{}` has no file `{}`", escape(name), escape(&wanted))));
        }
        let tree = target.path().join("tree");
        let into = format!("--prefix={}/", tree.display());
        with_index(&["checkout-index", "-z", "--stdin", &into], &names.join(&0)).map_err(unreadable)?;
        Ok(Self { _folder: target, path: tree.join(wanted), shown: format!("{name}:{}", path.display()) })
    }
}

/// The first line that git prints.
fn git(folder: &Path, arguments: &[&str]) -> Result<String, String> {
    let output = run(folder, arguments, None, &[])?;
    Ok(String::from_utf8_lossy(&output).lines().next().unwrap_or_default().to_owned())
}

/// Runs git. Returns its standard output, or its standard error if it fails. With `index`, git uses that file as its
/// index and leaves the repository's alone.
fn run(folder: &Path, arguments: &[&str], index: Option<&Path>, input: &[u8]) -> Result<Vec<u8>, String> {
    let mut command = Command::new("git");
    command.arg("-C").arg(folder).args(arguments).envs(index.map(|index| ("GIT_INDEX_FILE", index)));
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    #[expect(clippy::disallowed_methods, reason = "it is waited for below")]
    let mut process = command.spawn().map_err(|error| format!("cannot run `git`: {error}"))?;
    if let Some(mut stdin) = process.stdin.take() {
        // If git does not read it, its exit code says why.
        let _written = stdin.write_all(input);
    }
    let output = process.wait_with_output().map_err(|error| format!("cannot run `git`: {error}"))?;
    match output.status.success() {
        true => Ok(output.stdout),
        false => Err(String::from_utf8_lossy(&output.stderr).trim().replace('\n', "; ")),
    }
}

fn unknown(top: &Path, name: &str, note: &str) -> Problem {
    let problem = Problem::new(format!("there is no git revision `{}`", escape(name)));
    let problem = if note.is_empty() { problem } else { problem.note(escape(note)) };
    let is_shallow = git(top, &["rev-parse", "--is-shallow-repository"]).is_ok_and(|text| text == "true");
    match is_shallow {
        true => problem.help("this clone is shallow: run `git fetch --unshallow`"),
        false => problem.help("two files are compared with `scl diff OLD NEW`"),
    }
}

fn unreadable(error: impl std::fmt::Display) -> Problem {
    Problem::new(format!("cannot read the git repository: {error}"))
}
