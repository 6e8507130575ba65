//! `scl stop` and `scl restart`: finds the `scl run` of each component, asks it, and waits until it is done.

use super::client::{ControlledRun, NoAnswer, find_runs};
use super::protocol::{Command, ComponentReport, Request, Response};
use scl::runtime_dir::{Announcement, ComponentProcess, ComponentState, RuntimeDir, SystemDir};
use scl_terminal::{Problem, choose_system, named_system, quoted_list};
use std::ffi::OsString;
use std::path::PathBuf;
use std::thread;

/// What to do, and in which system.
pub struct ControlOptions<'a> {
    /// Stop or restart.
    pub command: Command,
    /// The components; all if empty.
    pub components: &'a [String],
    /// The system, if the user named one.
    pub system: Option<&'a str>,
    /// Returns the system of the working folder. Called only if no system is named, and none or several are running.
    pub here: &'a dyn Fn() -> Option<String>,
    /// Returns the topology file of the working folder, if its system is named after the file.
    pub named_after_here: &'a dyn Fn() -> Option<PathBuf>,
    /// Whether a restart builds first.
    pub build: bool,
}

/// What was done.
#[derive(Debug, Default)]
pub struct Done {
    /// The state of each component after the request, in the order of the runs.
    pub components: Vec<ComponentReport>,
    /// Why not everything was done.
    pub problems: Vec<Problem>,
}

/// A `scl run` and its components.
struct Answering {
    run: ControlledRun,
    named_after: Option<PathBuf>,
    components: Vec<ComponentReport>,
}

/// Stops or restarts components, and waits until that is done.
///
/// # Errors
///
/// Every reason why nothing was done.
pub fn ask(options: &ControlOptions<'_>) -> Result<Done, Vec<Problem>> {
    let variables = |name: &str| -> Option<OsString> { std::env::var_os(name) };
    let dir = RuntimeDir::existing(&variables).map_err(|error| vec![Problem::new(error.to_string())])?;
    let Some(dir) = dir else { return Err(vec![no_run(options, None)]) };
    let named = named_system(options.system, &variables).map_err(|problem| vec![problem])?;
    let mut runs = find_runs(dir.path(), named.as_deref());
    let mut systems: Vec<String> = runs.iter().map(|run| run.system.clone()).collect();
    systems.dedup();
    let system = choose_system(options.system, &variables, &systems, options.here).map_err(|problem| vec![problem])?;
    runs.retain(|run| system.as_ref() == Some(&run.system));
    let folder = system.and_then(|name| dir.existing_system(&name).ok().flatten());
    let mut done = Done::default();
    let answering = list(runs, &mut done.problems);
    if named.is_none() {
        let here = (options.named_after_here)();
        let other = |it: &Answering| {
            let problem = it.run.other_system(it.named_after.as_deref(), here.as_deref())?;
            Some(problem.help(format!("if you mean the one that runs: `--system {}`", it.run.system)))
        };
        let others: Vec<Problem> = answering.iter().filter_map(other).collect();
        if !others.is_empty() {
            return Err(others);
        }
    }
    let requests = match assign(options, answering, folder.as_ref()) {
        Ok(requests) => requests,
        // The missing components may belong to a run that did not answer, so report that instead.
        Err(_) if !done.problems.is_empty() => return Err(done.problems),
        Err(problems) => return Err(problems),
    };
    if !options.components.is_empty() {
        // All components were found in other runs, so it does not matter which runs did not answer.
        done.problems.clear();
    }
    if options.command == Command::Restart
        && options.build
        && let Err(problem) = build(&requests)
    {
        return Ok(Done { problems: vec![problem], ..Done::default() });
    }
    // Ask all runs in parallel, so that the slowest one determines the total time.
    let responses = thread::scope(|scope| {
        let ask = |(run, request): (ControlledRun, Request)| run.ask(&request).map_err(|error| run.problem(&error));
        let asked = requests.into_iter().map(|request| scope.spawn(move || ask(request)));
        let asked: Vec<_> = asked.collect();
        asked.into_iter().filter_map(|asked| asked.join().ok()).collect::<Vec<_>>()
    });
    for response in responses {
        match response {
            Ok(Response { error: Some(error), .. }) => {
                done.problems.push(Problem::new(format!("`scl run` refused: {error}")))
            }
            Ok(response) => done.components.extend(response.components),
            Err(problem) => done.problems.push(problem),
        }
    }
    if options.command == Command::Stop && options.components.is_empty() {
        done.problems.extend(folder.iter().flat_map(still_running));
    }
    if done.components.is_empty() && !done.problems.is_empty() { Err(done.problems) } else { Ok(done) }
}

/// Runs the builds of the components to restart. The old processes are replaced only if all builds succeed.
fn build(requests: &[(ControlledRun, Request)]) -> Result<(), Problem> {
    for (run, request) in requests {
        let question = Request { command: Command::Builds, ..request.clone() };
        let response = run.ask(&question).map_err(|error| run.problem(&error))?;
        if let Some(error) = response.error {
            return Err(Problem::new(format!("`scl run` refused: {error}")));
        }
        response.builds.iter().try_for_each(super::build::run)?;
    }
    Ok(())
}

/// Asks each run for the states of its components. Runs that end before they answer are left out; other failures are
/// added to `problems`.
fn list(runs: Vec<ControlledRun>, problems: &mut Vec<Problem>) -> Vec<Answering> {
    let mut answering = Vec::new();
    for run in runs {
        match run.ask(&Request::new(Command::List, Vec::new())) {
            Ok(response) => {
                answering.push(Answering { run, named_after: response.named_after, components: response.components })
            }
            Err(NoAnswer::Ended) => {}
            Err(error) => problems.push(run.problem(&error)),
        }
    }
    answering
}

/// Returns a problem for each component that runs without `scl run`, and therefore is not stopped with all others.
/// Components of other hosts, which a gateway only mirrors here, are left out.
fn still_running(folder: &SystemDir) -> Vec<Problem> {
    let is_here = |name: &String| Announcement::read(folder, name).is_none_or(|it| it.host.is_none());
    let names = folder.components().unwrap_or_default().into_iter().filter(is_here);
    let running = names.filter_map(|name| match folder.state(&name) {
        ComponentState::Running(holder) => Some(without_run(&name, holder, Command::Stop)),
        _ => None,
    });
    running.collect()
}

fn without_run(name: &str, holder: ComponentProcess, command: Command) -> Problem {
    let problem = Problem::new(format!("component `{name}` runs without `scl run`, as {holder}"));
    match (command, holder) {
        (Command::Stop, ComponentProcess::Process(pid)) => problem.help(format!("stop it with `kill {pid}`")),
        _ => problem,
    }
}

/// Decides which request each run gets.
fn assign(
    options: &ControlOptions<'_>,
    runs: Vec<Answering>,
    folder: Option<&SystemDir>,
) -> Result<Vec<(ControlledRun, Request)>, Vec<Problem>> {
    if options.components.is_empty() {
        if runs.is_empty() {
            return Err(vec![no_run(options, folder)]);
        }
        return Ok(runs.into_iter().map(|it| (it.run, Request::new(options.command, Vec::new()))).collect());
    }
    let mut chosen: Vec<Vec<String>> = vec![Vec::new(); runs.len()];
    let mut problems = Vec::new();
    for name in options.components {
        match run_of(name, &runs) {
            Some(index) if chosen[index].contains(name) => {}
            Some(index) => chosen[index].push(name.clone()),
            None => problems.push(not_run(options, name, &runs, folder)),
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let asked = runs.into_iter().zip(chosen).filter(|(_, names)| !names.is_empty());
    Ok(asked.map(|(it, names)| (it.run, Request::new(options.command, names))).collect())
}

/// Returns the index of a run that has the component, preferably one in which the component has a process.
fn run_of(name: &str, runs: &[Answering]) -> Option<usize> {
    let report = |run: &Answering| run.components.iter().find(|it| it.component == name).cloned();
    let having = runs.iter().enumerate().filter_map(|(index, run)| Some((index, report(run)?)));
    having.max_by_key(|(_, report)| report.pid.is_some()).map(|(index, _)| index)
}

fn not_run(options: &ControlOptions<'_>, name: &str, runs: &[Answering], folder: Option<&SystemDir>) -> Problem {
    if let Some(ComponentState::Running(holder)) = folder.map(|folder| folder.state(name)) {
        return without_run(name, holder, options.command);
    }
    let names: Vec<&str> = runs.iter().flat_map(|run| &run.components).map(|it| it.component.as_str()).collect();
    if names.is_empty() {
        return no_run(options, folder);
    }
    let problem = Problem::new(format!("no `scl run` has a component `{name}`"));
    let problem = problem.did_you_mean(name, names.iter().copied());
    problem.note(format!("it has the components {}", quoted_list(names)))
}

/// Returns the folder of the user's session if sockets are looked for there, but it does not exist, as after a logout.
fn missing_session() -> Option<PathBuf> {
    let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    let session = variable("XDG_RUNTIME_DIR").filter(|_| variable("SCL_RUNTIME_DIR").is_none());
    session.map(PathBuf::from).filter(|session| !session.exists())
}

fn no_run(options: &ControlOptions<'_>, folder: Option<&SystemDir>) -> Problem {
    let message = match options.system {
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
    let problem = match missing_session() {
        Some(folder) => problem.note(format!(
            "`XDG_RUNTIME_DIR` is `{}`, which does not exist, so systems that were started there are not found",
            folder.display()
        )),
        None => problem,
    };
    if running.is_empty() {
        return problem.help("start the system with `scl run`");
    }
    problem.note(format!("components that run without it: {}", running.join(", ")))
}
