//! New projects, for `scl new`: templates of files, all of which are written, or none.
//!
//! The templates are the folders below `templates/`, embedded in the binary. They are valid projects for a system
//! `rover`; [`create`] replaces its name and the dependency on SCL. A folder with a `Cargo.toml` would be left out when
//! this crate is packaged, which is why that one file has another name.
#![cfg_attr(test, allow(clippy::unwrap_used))]
#![deny(missing_docs)]

mod checkout;
mod dependency;
mod name;
mod template;
mod write;

pub use template::Template;

use dependency::Dependency;
use scl_terminal::Problem;
use std::path::{Path, PathBuf};

/// What to create.
#[derive(Debug, Clone)]
pub struct Project {
    /// The name of the folder, the system and the cargo package.
    pub name: String,
    /// The template of its files.
    pub template: Template,
    /// Where the project finds SCL.
    pub scl: Source,
}

/// Where a project finds SCL.
#[derive(Debug, Clone)]
pub enum Source {
    /// The revision that this program was built from, if its checkout has a remote that others can reach and that has
    /// this revision; else the folder of the checkout; if it is gone, the package registry.
    OfThisProgram,
    /// SCL's repository on this machine, or the crate `scl` in it, from the folder in which the project is created.
    Folder(PathBuf),
    /// A git repository that others can reach.
    Git {
        /// With a scheme, or in the form `user@host:path`.
        url: String,
        /// A commit or a tag; by default the commit that this program was built from.
        revision: Option<String>,
    },
}

/// A created project.
#[derive(Debug, Clone)]
pub struct Created {
    /// The paths of its files, from its folder.
    pub files: Vec<String>,
    /// What its `Cargo.toml` says about SCL: a path, a revision, or a version in the package registry.
    pub scl: String,
    /// What to know before handing the project on.
    pub note: Option<String>,
}

/// Creates the project as a folder in `parent`.
///
/// # Errors
///
/// If the name cannot be used, a file or folder with that name exists, the folder does not contain SCL, the URL is
/// invalid, or the files cannot be written. Nothing is left behind then.
pub fn create(parent: &Path, project: &Project) -> Result<Created, Problem> {
    name::check(&project.name, &project.template.programs())?;
    write::check_absent(parent, &project.name)?;
    let dependency = match &project.scl {
        Source::Folder(path) => Dependency::at(parent, path)?,
        Source::Git { url, revision } => Dependency::in_repository(url, revision.as_deref())?,
        Source::OfThisProgram => Dependency::of_this_program(),
    };
    let mut files = project.template.files(&project.name, &dependency, is_in_workspace(parent));
    files.extend(dependency.lock_file().map(|text| ("Cargo.lock".to_owned(), text)));
    write::write_all(parent, &project.name, &files)?;
    let files = files.into_iter().map(|(path, _)| path).collect();
    Ok(Created { files, scl: dependency.to_string(), note: dependency.note() })
}

/// Whether cargo would take a package in this folder for a member of the workspace around it.
fn is_in_workspace(parent: &Path) -> bool {
    let Ok(parent) = std::path::absolute(parent) else { return false };
    let manifests = parent.ancestors().filter_map(|folder| std::fs::read_to_string(folder.join("Cargo.toml")).ok());
    manifests.into_iter().any(|text| text.lines().any(|line| line.starts_with("[workspace")))
}
