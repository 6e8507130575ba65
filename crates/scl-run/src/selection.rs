//! `--only`, `--without` and `--as`: which components of the system are started here, and which are played.

use super::Options;
use scl_terminal::{Problem, quoted_list};

/// A choice of components.
#[derive(Debug)]
pub(crate) struct Selection<'a> {
    only: &'a [String],
    without: &'a [String],
}

impl<'a> Selection<'a> {
    /// Checks the names of both options; `source` says in messages where the components are declared.
    ///
    /// # Errors
    ///
    /// Every name that is not a component; a choice that leaves no component.
    pub(crate) fn new(options: &'a Options, components: &[String], source: &str) -> Result<Self, Vec<Problem>> {
        let selection = Self { only: &options.only, without: &options.without };
        let names: Vec<&str> = components.iter().map(String::as_str).collect();
        let played = options.played.as_ref().map_or(&[][..], |played| &played.components);
        let chosen = [("--only", selection.only), ("--without", selection.without), ("--as", played)];
        let asked = chosen.into_iter().flat_map(|(option, asked)| asked.iter().map(move |name| (option, name)));
        let unknown = asked.filter(|(_, name)| !names.contains(&name.as_str()));
        let problems: Vec<Problem> = unknown.map(|(option, name)| unknown_name(option, name, &names, source)).collect();
        if !problems.is_empty() {
            return Err(problems);
        }
        if !names.iter().any(|name| selection.includes(name)) {
            return Err(vec![Problem::new("`--without` leaves no component to start")]);
        }
        Ok(selection)
    }

    pub(crate) fn is_everything(&self) -> bool {
        self.only.is_empty() && self.without.is_empty()
    }

    pub(crate) fn includes(&self, name: &str) -> bool {
        (self.only.is_empty() || self.only.iter().any(|it| it == name)) && !self.without.iter().any(|it| it == name)
    }
}

fn unknown_name(option: &str, name: &str, names: &[&str], source: &str) -> Problem {
    let problem = Problem::new(format!("unknown component `{name}` in `{option}`"));
    let problem = problem.did_you_mean(name, names.iter().copied());
    problem.note(format!("{source} has the components {}", quoted_list(names)))
}
