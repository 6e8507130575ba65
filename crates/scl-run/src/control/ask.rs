//! `scl stop` and `scl restart`: finds the `scl run` of each component, asks it, and waits until it is done.

use super::client::{ControlledRun, find_runs};
use super::protocol::{Command, ComponentReport, Request, Response, VERSION};
use scl::runtime_dir::{ComponentState, Holder, RuntimeDir, SystemDir};
use scl_terminal::{Problem, closest_name, quoted_list};
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::thread;

/// What to do, and in which system.
pub struct Wish<'a> {
    /// Stop or restart.
    pub command: Command,
    /// The components; all if empty.
    pub components: &'a [String],
    /// The system, if the user named one.
    pub system: Option<&'a str>,
    /// The system of the working folder, asked for only if several run.
    pub here: &'a dyn Fn() -> Option<String>,
}

/// A `scl run` and its components.
struct Answering {
    run: ControlledRun,
    components: Vec<ComponentReport>,
}

/// Does it, and returns how each component is afterwards, in the order of the runs.
///
/// # Errors
///
/// Every reason why nothing was done.
pub fn ask(wish: &Wish<'_>) -> Result<Vec<ComponentReport>, Vec<Problem>> {
    let variables = |name: &str| -> Option<OsString> { std::env::var_os(name) };
    let dir = RuntimeDir::existing(&variables).map_err(|error| vec![Problem::new(error.to_string())])?;
    let Some(dir) = dir else { return Err(vec![no_run(wish, None)]) };
    let chosen = wish.system.map(str::to_owned).or_else(|| std::env::var("SCL_SYSTEM").ok());
    let mut runs = find_runs(dir.path(), chosen.as_deref().filter(|name| !name.is_empty()));
    let systems: BTreeSet<String> = runs.iter().map(|run| run.system.clone()).collect();
    if systems.len() > 1 {
        let here = (wish.here)().filter(|here| systems.contains(here));
        let here = here.ok_or_else(|| vec![several_systems(&systems)])?;
        runs.retain(|run| run.system == here);
    }
    let system = runs.first().map(|run| run.system.clone()).or(chosen).or_else(wish.here);
    let folder = system.and_then(|name| dir.existing_system(&name).ok().flatten());
    let answering: Vec<Answering> = runs.into_iter().filter_map(list).collect();
    let requests = assign(wish, answering, folder.as_ref())?;
    // At the same time, so that the slowest run decides how long it takes.
    let responses = thread::scope(|scope| {
        let asked = requests.into_iter().map(|(run, request)| scope.spawn(move || run.ask(&request)));
        let asked: Vec<_> = asked.collect();
        asked.into_iter().filter_map(|asked| asked.join().ok()).collect::<Vec<_>>()
    });
    let mut reports = Vec::new();
    let mut problems = Vec::new();
    for response in responses {
        match response {
            Ok(Response { error: Some(error), .. }) => {
                problems.push(Problem::new(format!("`scl run` refused: {error}")))
            }
            Ok(response) => reports.extend(response.components),
            Err(error) => problems.push(Problem::new(format!("no answer from `scl run`: {error}"))),
        }
    }
    if problems.is_empty() { Ok(reports) } else { Err(problems) }
}

fn list(run: ControlledRun) -> Option<Answering> {
    // One that ends at this moment runs nothing.
    let response = run.ask(&request(Command::List, &[])).ok()?;
    Some(Answering { run, components: response.components })
}

fn request(command: Command, components: &[&str]) -> Request {
    Request { version: VERSION, command, components: components.iter().map(|name| (*name).to_owned()).collect() }
}

/// Which run is asked for what.
fn assign(
    wish: &Wish<'_>,
    runs: Vec<Answering>,
    folder: Option<&SystemDir>,
) -> Result<Vec<(ControlledRun, Request)>, Vec<Problem>> {
    if wish.components.is_empty() {
        if runs.is_empty() {
            return Err(vec![no_run(wish, folder)]);
        }
        return Ok(runs.into_iter().map(|it| (it.run, request(wish.command, &[]))).collect());
    }
    let mut chosen: Vec<Vec<&str>> = vec![Vec::new(); runs.len()];
    let mut problems = Vec::new();
    for name in wish.components {
        match run_of(name, &runs) {
            Some(index) if chosen[index].contains(&name.as_str()) => {}
            Some(index) => chosen[index].push(name),
            None => problems.push(not_run(wish, name, &runs, folder)),
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let asked = runs.into_iter().zip(chosen).filter(|(_, names)| !names.is_empty());
    Ok(asked.map(|(it, names)| (it.run, request(wish.command, &names))).collect())
}

/// The run that has a component: one where it has a process, if any.
fn run_of(name: &str, runs: &[Answering]) -> Option<usize> {
    let report = |run: &Answering| run.components.iter().find(|it| it.component == name).cloned();
    let having = runs.iter().enumerate().filter_map(|(index, run)| Some((index, report(run)?)));
    having.max_by_key(|(_, report)| report.pid.is_some()).map(|(index, _)| index)
}

fn not_run(wish: &Wish<'_>, name: &str, runs: &[Answering], folder: Option<&SystemDir>) -> Problem {
    if let Some(ComponentState::Running(holder)) = folder.map(|folder| folder.state(name)) {
        let problem = Problem::new(format!("component `{name}` runs without `scl run`, as {holder}"));
        return match (wish.command, holder) {
            (Command::Stop, Holder::Process(pid)) => problem.help(format!("stop it with `kill {pid}`")),
            _ => problem,
        };
    }
    let names: Vec<&str> = runs.iter().flat_map(|run| &run.components).map(|it| it.component.as_str()).collect();
    if names.is_empty() {
        return no_run(wish, folder);
    }
    let problem = Problem::new(format!("no `scl run` has a component `{name}`"));
    let problem = match closest_name(name, names.iter().copied()) {
        Some(close) => problem.help(format!("did you mean `{close}`?")),
        None => problem,
    };
    problem.note(format!("it has the components {}", quoted_list(names)))
}

fn no_run(wish: &Wish<'_>, folder: Option<&SystemDir>) -> Problem {
    let message = match wish.system {
        Some(system) => format!("no `scl run` is running in system `{system}`"),
        None => "no `scl run` is running".to_owned(),
    };
    let names = folder.and_then(|folder| Some((folder, folder.components().ok()?)));
    let running: Vec<String> = names.map_or_else(Vec::new, |(folder, names)| {
        let holder = |name: &String| match folder.state(name) {
            ComponentState::Running(holder) => Some(format!("`{name}` as {holder}")),
            _ => None,
        };
        names.iter().filter_map(holder).collect()
    });
    let problem = Problem::new(message);
    if running.is_empty() {
        return problem.help("start the system with `scl run`");
    }
    problem.note(format!("components that run without it: {}", running.join(", ")))
}

fn several_systems(systems: &BTreeSet<String>) -> Problem {
    Problem::new("several systems run")
        .help("choose one with `--system`")
        .note(format!("the systems are {}", quoted_list(systems.iter().map(String::as_str))))
}
