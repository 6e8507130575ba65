//! Finds the program to run among those that cargo has built.

use super::artifacts::Artifact;
use super::metadata::default_run_of;
use scl_terminal::{Problem, quoted_list};
use std::path::Path;

/// Which of the programs of a build to run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Target {
    /// The only one, or the `default-run` of its package.
    Only,
    Bin(String),
    Example(String),
    /// The one with the name of this component or, if there is none, of its kind. Cargo targets are often named with
    /// hyphens, and cannot contain the dots of groups: `left_arm_planner` is that of `left_arm.planner`.
    OfComponent {
        name: String,
        kind: Option<String>,
    },
}

/// Returns the program that `target` selects.
///
/// # Errors
///
/// If no program matches, or more than one.
pub(crate) fn find<'a>(artifacts: &'a [Artifact], target: &Target, component: &str) -> Result<&'a Artifact, Problem> {
    find_by(artifacts, target, component, default_run_of)
}

/// The name of the program of a component or kind.
fn in_cargo(name: &str) -> String {
    name.replace('.', "_")
}

/// Like [`find`]; `default_run` returns the `default-run` of a manifest.
fn find_by<'a>(
    artifacts: &'a [Artifact],
    target: &Target,
    component: &str,
    default_run: impl Fn(&Path) -> Option<String>,
) -> Result<&'a Artifact, Problem> {
    let is_called =
        |artifact: &Artifact, name: &str| artifact.name == name || artifact.name.replace('-', "_") == in_cargo(name);
    let is_meant = |artifact: &&Artifact| match target {
        Target::Only => !artifact.is_example,
        Target::Bin(name) => !artifact.is_example && artifact.name == *name,
        Target::Example(name) => artifact.is_example && artifact.name == *name,
        Target::OfComponent { name, .. } => is_called(artifact, name),
    };
    let mut found: Vec<&Artifact> = artifacts.iter().filter(is_meant).collect();
    if let (true, Target::OfComponent { kind: Some(kind), .. }) = (found.is_empty(), target) {
        found = artifacts.iter().filter(|artifact| is_called(artifact, kind)).collect();
    }
    if found.len() > 1 && *target == Target::Only {
        found.retain(|artifact| default_run(&artifact.manifest).is_some_and(|name| name == artifact.name));
    }
    match found.as_slice() {
        [one] => Ok(one),
        [] => {
            let names = quoted_list(artifacts.iter().map(|artifact| artifact.name.as_str()));
            let built = if artifacts.is_empty() { "no programs".to_owned() } else { format!("the programs {names}") };
            let problem = Problem::new(format!("cargo has built no program for component `{component}`"));
            let help = match target {
                Target::OfComponent { name, kind } => {
                    let name = in_cargo(kind.as_ref().unwrap_or(name));
                    format!("add `src/bin/{name}.rs`, or say in `launch.yaml` how to start it")
                }
                _ => "choose one with `--bin`".to_owned(),
            };
            Err(problem.help(help).note(format!("it has built {built}")))
        }
        several => {
            let name = &several[0].name;
            let manifests = quoted_list(several.iter().filter_map(|artifact| artifact.manifest.to_str()));
            let problem =
                Problem::new(format!("cargo has built several programs `{name}` for component `{component}`"));
            Err(problem.help("choose the package with `-p`").note(format!("they are those of {manifests}")))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn artifact(name: &str, package: &str) -> Artifact {
        let executable = PathBuf::from(format!("/t/{package}/{name}"));
        Artifact { name: name.to_owned(), is_example: false, manifest: package.into(), executable }
    }

    #[test]
    fn a_program_is_found_by_its_target_and_never_guessed() {
        let all = [artifact("sensor", "p"), artifact("user-interface", "p"), artifact("sensor", "q")];
        let find = |artifacts: &[Artifact], target| {
            let found = find_by(artifacts, &target, "c", |_| Some("user-interface".to_owned()));
            found.map(|it| it.executable.display().to_string()).map_err(|problem| problem.to_string())
        };
        let bin = |name: &str| Target::Bin(name.to_owned());
        assert_eq!(find(&all[..2], bin("sensor")), Ok("/t/p/sensor".to_owned()));
        let of = |name: &str, kind: Option<&str>| {
            find(&all[..2], Target::OfComponent { name: name.to_owned(), kind: kind.map(str::to_owned) })
        };
        assert_eq!(of("user_interface", None), Ok("/t/p/user-interface".to_owned()));
        assert_eq!(of("user.interface", None), Ok("/t/p/user-interface".to_owned()));
        assert_eq!(of("left_sensor", Some("sensor")), Ok("/t/p/sensor".to_owned()));
        assert_eq!(of("sensor", Some("user_interface")), Ok("/t/p/sensor".to_owned()));
        let none = of("left_motor", Some("motor")).unwrap_err();
        assert!(none.contains("add `src/bin/motor.rs`"), "{none}");
        assert_eq!(find(&all[2..], Target::Only), Ok("/t/q/sensor".to_owned()));
        assert_eq!(find(&all, Target::Only), Ok("/t/p/user-interface".to_owned()));
        let several = find(&all, bin("sensor")).unwrap_err();
        assert!(several.contains("several programs `sensor`") && several.contains("those of `p`, `q`"), "{several}");
        let none = find(&all[..1], bin("user_interface")).unwrap_err();
        assert!(none.contains("it has built the programs `sensor`"), "{none}");
    }
}
