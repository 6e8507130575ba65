//! The builds of programs that cargo makes, and the paths that cargo reports for them.

use super::super::cargo::{CargoRun, built_before, find};
use super::super::component::MadeByCargo;
use super::super::program::{Build, Program};
use super::{Built, RunPlan};
use scl_terminal::Problem;

/// Adds the cargo build of a component's program. A build that differs only in the program that it makes is extended,
/// if there is one, because cargo builds several programs at once.
pub(super) fn add(builds: &mut Vec<Build>, program: Program, component: &str, cargo: &CargoRun) -> MadeByCargo {
    let is_same = |build: &Build| match &build.cargo_choices {
        // Do not combine builds with and without a choice of program: without one, cargo builds all programs.
        Some(choices) => build.program == program && choices.iter().all(|it| it.is_empty() == cargo.choice.is_empty()),
        None => false,
    };
    let (name, choice) = (component.to_owned(), cargo.choice.clone());
    let build = builds.iter().position(is_same).unwrap_or_else(|| {
        builds.push(Build { components: Vec::new(), program, cargo_choices: Some(Vec::new()) });
        builds.len() - 1
    });
    builds[build].components.push(name);
    let choices = builds[build].cargo_choices.get_or_insert_default();
    // The components of a kind have the same program.
    if !choices.contains(&choice) {
        choices.push(choice);
    }
    MadeByCargo { build, target: cargo.target.clone() }
}

impl RunPlan {
    /// Puts the programs that cargo has made into the commands.
    ///
    /// # Errors
    ///
    /// Every component whose program is not among them.
    pub(crate) fn take_built(&mut self, built: &Built) -> Result<(), Vec<Problem>> {
        let mut problems = Vec::new();
        for component in &mut self.components {
            let Some(made) = &component.made_by_cargo else { continue };
            let artifacts = built.get(made.build).map_or(&[][..], Vec::as_slice);
            match find(artifacts, &made.target, &component.name) {
                Ok(artifact) => component.program.command[0] = artifact.executable.clone().into_os_string(),
                Err(problem) => problems.push(problem),
            }
        }
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }

    /// Like [`take_built`](Self::take_built), but with the programs of earlier builds.
    ///
    /// # Errors
    ///
    /// Every component whose program cargo does not know, or the failure of `cargo metadata`.
    pub(crate) fn find_programs_built_before(&mut self) -> Result<(), Vec<Problem>> {
        let programs = self.builds.iter().map(|build| match &build.cargo_choices {
            Some(_) => built_before(&build.program),
            None => Ok(Vec::new()),
        });
        let built: Result<Built, Problem> = programs.collect();
        self.take_built(&built.map_err(|problem| vec![problem])?)
    }
}
