//! The values that programs get for the parameters of components: those of the launch file, then those of `SCL_SET` in
//! the environment of `scl run`, then those of `--set`. The last one counts.

use super::super::Options;
use super::super::launch_file::{LaunchComponent, Opens, Source};
use super::super::system_names::SystemNames;
use scl_plan::{Assignment, ParameterPlan, SET_VARIABLE, assignments, set_text};
use scl_terminal::{Problem, quoted_list};
use scl_topology::parse::meant_values;
use std::collections::{HashMap, HashSet};
use std::ffi::OsString;

/// What a value comes from, unless it is the launch file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Origin {
    Variable,
    Option,
}

/// The values of the parameters of a system.
#[derive(Debug)]
pub(super) struct Values<'n> {
    known: Option<&'n SystemNames>,
    /// One for each parameter that has a value, in the order of the topology.
    given: Vec<Assignment>,
    /// Whether programs would inherit other values.
    is_inherited: bool,
}

impl<'n> Values<'n> {
    /// Collects the values for all components, started or not; `inherited` is `SCL_SET` of `scl run`.
    ///
    /// # Errors
    ///
    /// Every value from elsewhere than the launch file that no parameter can have; the launch file has been checked.
    pub(super) fn new(
        options: &Options,
        inherited: Option<&str>,
        components: &[LaunchComponent],
        known: Option<&'n SystemNames>,
    ) -> Result<Self, Vec<Problem>> {
        let failed =
            |reason| vec![Problem::new(format!("cannot read `{SET_VARIABLE}`: {reason}")).note(origin_of_variable())];
        let of_variable = assignments(inherited.unwrap_or_default()).map_err(failed)?;
        let of_variable = of_variable.into_iter().map(|it| (Origin::Variable, it));
        let given: Vec<_> = of_variable.chain(options.set.iter().map(|it| (Origin::Option, it.clone()))).collect();
        let problems = given.iter().filter_map(|(origin, it)| problem(*origin, it, components, known));
        let problems: Vec<Problem> = problems.collect();
        if !problems.is_empty() {
            return Err(problems);
        }
        let of_file = components.iter().flat_map(|component| {
            component.parameters.iter().map(|(parameter, value)| Assignment {
                component: component.name.clone(),
                parameter: parameter.clone(),
                value: value.clone(),
            })
        });
        let mut given = last_of_each(of_file.chain(given.into_iter().map(|(_, it)| it)));
        if let Some(known) = known {
            sort(&mut given, known);
        }
        Ok(Self { known, given, is_inherited: inherited.is_some_and(|text| !text.is_empty()) })
    }

    /// The problems of components whose programs could not open them because a parameter has no value.
    pub(super) fn unset(&self, started: &[LaunchComponent]) -> Vec<Problem> {
        let programs = started.iter().filter(|component| matches!(component.source, Source::Command(_)));
        programs.flat_map(|component| self.unset_of(&component.name, Some(&component.place))).collect()
    }

    /// As [`unset`](Self::unset), for one component and the place of its entry in the launch file, if there is one.
    pub(super) fn unset_of(&self, component: &str, place: Option<&str>) -> Vec<Problem> {
        let has_value = |name: &str| self.given.iter().any(|it| it.component == component && it.parameter == name);
        let unset = self.known.into_iter().flat_map(|known| known.without_value(component, has_value));
        let problem = |plan: &ParameterPlan| {
            let name = &plan.name;
            let problem = Problem::new(format!("parameter `{component}.{name}` ({}) has no value", plan.kind));
            let option = format!("`--set {component}.{name}=...`");
            match place {
                Some(place) => {
                    problem.at(place).help(format!("add `parameters: {{{name}: ...}}` to its entry, or give {option}"))
                }
                None => {
                    problem.help(format!("give {option}, or write a launch file with `parameters: {{{name}: ...}}`"))
                }
            }
        };
        unset.map(problem).collect()
    }

    /// The variable for the program of a component. A recording is played as it is, whatever the values are.
    pub(super) fn variable(&self, component: &LaunchComponent) -> Option<(String, String)> {
        match component.source {
            Source::Command(_) => self.variable_of(&component.name, &component.opens),
            Source::Replay(_) => self.cleared(),
        }
    }

    /// The variable for a program. Programs of one kind get the values of all its components, so that one unit file can
    /// start each of them.
    pub(super) fn variable_of(&self, component: &str, opens: &Opens) -> Option<(String, String)> {
        let of_kind = self.known.and_then(|known| known.components_of(known.kind_of(component)?));
        let of_kind: HashSet<&str> = of_kind.unwrap_or_default().iter().map(String::as_str).collect();
        let is_for =
            |name: &str| name == component || *opens == Opens::Any || opens.names(name) || of_kind.contains(name);
        let text = set_text(self.given.iter().filter(|it| is_for(&it.component)));
        if text.is_empty() { self.cleared() } else { Some((SET_VARIABLE.to_owned(), text)) }
    }

    /// The live parameters of each component that a program opens, if it has any.
    pub(super) fn live_of(&self, component: &str, opens: &Opens) -> Vec<(String, Vec<String>)> {
        let components = self.known.iter().flat_map(|known| &known.components);
        let opened = components.filter(|name| *name == component || *opens == Opens::Any || opens.names(name));
        let live = opened.map(|name| {
            let parameters = self.known.map_or(&[][..], |known| known.parameters_of(name));
            let live = parameters.iter().filter(|parameter| parameter.live).map(|parameter| parameter.name.to_string());
            (name.clone(), live.collect::<Vec<_>>())
        });
        live.filter(|(_, live)| !live.is_empty()).collect()
    }

    /// The variable for a program that gets no values: empty, if it would inherit others.
    pub(super) fn cleared(&self) -> Option<(String, String)> {
        self.is_inherited.then(|| (SET_VARIABLE.to_owned(), String::new()))
    }
}

/// `SCL_SET` in our own environment.
///
/// # Errors
///
/// If it is not UTF-8.
pub(super) fn inherited() -> Result<Option<String>, Vec<Problem>> {
    let text = |text: OsString| {
        let wrong = |_| vec![Problem::new(format!("`{SET_VARIABLE}` is not UTF-8")).note(origin_of_variable())];
        text.into_string().map_err(wrong)
    };
    std::env::var_os(SET_VARIABLE).map(text).transpose()
}

fn origin_of_variable() -> String {
    format!("`{SET_VARIABLE}` is in the environment of `scl`")
}

impl Origin {
    fn shown(self) -> &'static str {
        match self {
            Origin::Variable => SET_VARIABLE,
            Origin::Option => "--set",
        }
    }

    fn note(self) -> Option<String> {
        (self == Origin::Variable).then(origin_of_variable)
    }
}

/// Why a value can be that of no parameter. Without a topology, only the component is known.
fn problem(
    origin: Origin,
    given: &Assignment,
    components: &[LaunchComponent],
    known: Option<&SystemNames>,
) -> Option<Problem> {
    let Assignment { component, parameter, value } = given;
    let in_origin = format!("in `{}`", origin.shown());
    let noted = |problem: Problem| origin.note().into_iter().fold(problem, Problem::note);
    let (source, names): (_, Vec<&str>) = match known {
        Some(known) => ("topology", known.components.iter().map(String::as_str).collect()),
        None => ("launch file", components.iter().map(|component| component.name.as_str()).collect()),
    };
    if !names.contains(&component.as_str()) {
        let problem = Problem::new(format!("unknown component `{component}` {in_origin}"));
        let problem = match known.and_then(|known| known.components_of(component)) {
            Some(of_kind) => {
                problem.help(format!("it is a kind: name one of its components, {}", quoted_list(of_kind)))
            }
            None => problem.did_you_mean(component, names.iter().copied()),
        };
        return Some(noted(problem.note(format!("the {source} has the components {}", quoted_list(names)))));
    }
    let declared = known?.parameters_of(component);
    let Some(plan) = declared.iter().find(|plan| plan.name == *parameter) else {
        let problem = Problem::new(format!("unknown parameter `{}` {in_origin}", given.path()));
        let names = || declared.iter().map(|plan| &*plan.name);
        let problem = problem.did_you_mean(parameter, names());
        return Some(noted(problem.note(match declared {
            [] => format!("component `{component}` has no parameters"),
            _ => format!("component `{component}` has the parameters {}", quoted_list(names())),
        })));
    };
    let reason = plan.read(value).err()?;
    let problem = Problem::new(format!("wrong value of `{}` {in_origin}: {reason}", given.path()));
    let meant = meant_values(plan, value).into_iter();
    Some(noted(meant.fold(problem, |problem, meant| problem.help(format!("did you mean `{meant}`?")))))
}

/// One value for each parameter, the last one, at the place of the first.
fn last_of_each(all: impl Iterator<Item = Assignment>) -> Vec<Assignment> {
    let mut kept: Vec<Assignment> = Vec::new();
    let mut indices: HashMap<String, usize> = HashMap::new();
    for given in all {
        match indices.get(&given.path()) {
            Some(at) => kept[*at] = given,
            None => {
                indices.insert(given.path(), kept.len());
                kept.push(given);
            }
        }
    }
    kept
}

/// Sorts values in the order of the topology, so that equal values become equal texts.
fn sort(given: &mut [Assignment], known: &SystemNames) {
    let indices: HashMap<&str, usize> = known.components.iter().map(String::as_str).zip(0..).collect();
    let of_parameter =
        |it: &Assignment| known.parameters_of(&it.component).iter().position(|plan| plan.name == it.parameter);
    given.sort_by_cached_key(|it| (indices.get(it.component.as_str()).copied(), of_parameter(it)));
}

#[cfg(test)]
mod tests;
