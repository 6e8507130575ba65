//! `scl get` and `scl set`: the values of the parameters of running components.

use crate::format::FormatArgument;
use crate::observed::SystemArgument;
use clap::Args;
use scl::parameters::{AskError, ask_to_set, values};
use scl::runtime_dir::ComponentState;
use scl_observe::{Component, System, block_on, problem_of};
use scl_plan::{Assignment, ParameterPlan};
use scl_terminal::{Problem, Table, escape, parse_duration, print_err, print_out};
use scl_text::gate_name::component_and_gate;
use scl_topology::parse::meant_values;
use serde_json::{Map, Value, json};
use std::process::ExitCode;
use std::time::Duration;

/// Show the values of parameters that running components have.
///
/// A component writes them when it starts, and whenever one is set. Of one that was killed, they are the last ones.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl get                            all of the running system
  scl get controller                 those of a component
  scl get controller.gain            the value alone
  scl get --format json | jq -r .controller.gain

Exit code: 0 shown, 2 there is no such system, component or parameter, or the component does not run.")]
pub(crate) struct GetArguments {
    /// The parameter, as `component.parameter`, or the component; all of the running system without it.
    #[arg(value_name = "PARAMETER|COMPONENT")]
    name: Option<String>,
    #[command(flatten)]
    system: SystemArgument,
    #[command(flatten)]
    format: FormatArgument,
}

/// The body of `scl get`.
pub(crate) fn get(arguments: &GetArguments) -> Result<ExitCode, Problem> {
    let system = System::find(arguments.system.name())?;
    let Some(name) = &arguments.name else {
        let running: Vec<Component> = system.components().into_iter().filter(Component::is_running).collect();
        arguments.format.print(|| all_to_json(&running), || table(&running));
        return Ok(ExitCode::SUCCESS);
    };
    let (component, parameter) = find(&system, name)?;
    let Some(parameter) = parameter else {
        let only = [component];
        arguments.format.print(|| only[0].parameters_to_json(), || table(&only));
        return Ok(ExitCode::SUCCESS);
    };
    let value = component.parameters().find(|(plan, _)| plan.name == parameter.name).and_then(|(_, value)| value);
    let Some(value) = value else {
        return Err(Problem::new(format!("the value of `{}.{}` is not known here", component.name, parameter.name))
            .note("a tool plays the component, or it runs on another host"));
    };
    arguments.format.print(|| json!(value), || format!("{}\n", escape(value)));
    Ok(ExitCode::SUCCESS)
}

/// Change live parameters of running components.
///
/// The program is told at once; a value that the parameter cannot have is refused, and nothing changes. Several values
/// of one component change together. `scl run` keeps what was set when it starts the component again; what holds at
/// every start belongs into the launch file.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl set controller.gain=2
  scl set controller.mode auto
  scl set controller.gain=2 controller.mode=auto other.period=10ms
  scl set 'logger.names=[left, right]'

Exit code: 0 set, 1 the component did not answer within --timeout, 2 nothing was set: the parameter is unknown or not live,
it cannot have the value, or the component does not run.")]
pub(crate) struct SetArguments {
    /// What to set, as `component.parameter=value`; or a parameter and its value.
    #[arg(value_name = "PARAMETER=VALUE", required = true, allow_negative_numbers = true)]
    values: Vec<String>,
    /// How long to wait for the answer of each component.
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = parse_duration)]
    timeout: Duration,
    #[command(flatten)]
    system: SystemArgument,
}

/// The body of `scl set`.
pub(crate) fn set(arguments: &SetArguments) -> Result<ExitCode, Problem> {
    let wanted = wanted(&arguments.values)?;
    let system = System::find(arguments.system.name())?;
    // All are checked before the first is set.
    let mut components: Vec<(Component, Vec<Assignment>)> = Vec::new();
    for assignment in wanted {
        let component = checked(&system, &assignment)?;
        match components.iter_mut().find(|(known, _)| known.name == component.name) {
            Some((_, assignments)) => assignments.push(assignment),
            None => components.push((component, vec![assignment])),
        }
    }
    for (component, assignments) in &components {
        let values = assignments.iter().map(|it| (it.parameter.as_str(), it.value.as_str()));
        let asked = ask_to_set(system.dir(), &component.name, values, arguments.timeout);
        match block_on(async { Ok(asked.await) })? {
            Ok(()) => print_out(&shown(&system, component, assignments)),
            Err(AskError::NoAnswer { component, .. }) => {
                let message = format!("component `{component}` did not answer within {:?}", arguments.timeout);
                let problem = Problem::new(message).help("`scl list` tells whether it hangs");
                print_err(&problem.note("it may still set the values when it goes on").to_string());
                return Ok(ExitCode::FAILURE);
            }
            Err(error) => return Err(problem_of(&error)),
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// The values to set: `a.b=1 c.d=2`, or `a.b 1`.
fn wanted(words: &[String]) -> Result<Vec<Assignment>, Problem> {
    if let [path, value] = words
        && !path.contains('=')
    {
        return Ok(vec![read(&format!("{path}={value}"))?]);
    }
    words.iter().map(|word| read(word)).collect()
}

fn read(text: &str) -> Result<Assignment, Problem> {
    Assignment::parse(text).map_err(|reason| {
        Problem::new(escape(&reason).into_owned()).help("write for example `scl set controller.gain=2`")
    })
}

/// Checks what can be known of a value before its component is asked.
fn checked(system: &System, assignment: &Assignment) -> Result<Component, Problem> {
    let Assignment { component, parameter, value } = assignment;
    let found = system.component(component)?;
    if let Some(host) = found.host() {
        return Err(Problem::new(format!("component `{component}` runs on host `{}`", escape(host)))
            .help(format!("set it there: `scl set {}={value}`", assignment.path())));
    }
    if !matches!(found.state, ComponentState::Running(_)) {
        let start = format!("give the value at the start: `scl run --set {}={}`", assignment.path(), escape(value));
        return Err(not_running(component).help(start));
    }
    let Some(plan) = found.plan() else { return Ok(found) };
    let declared = plan.parameters.iter().find(|known| known.name == *parameter);
    let declared = declared.ok_or_else(|| unknown(&found, parameter))?;
    let path = assignment.path();
    if !declared.live {
        let problem = Problem::new(format!("parameter `{path}` is fixed while its program runs"));
        return Err(problem
            .help(format!("give the value at the start: `scl run --set {path}={}`", escape(value)))
            .help("or declare it with `live: true`, and build the program anew")
            .note(format!("declared at {}", declared.declared_at)));
    }
    match declared.read(value) {
        Ok(_) => Ok(found),
        Err(reason) => {
            let problem = Problem::new(format!("wrong value of `{path}`: {}", escape(&reason)));
            let meant = meant_values(declared, value).into_iter();
            let problem =
                meant.fold(problem, |problem, meant| problem.help(format!("did you mean `{}`?", escape(&meant))));
            Err(problem.note(format!("it is {}, declared at {}", declared.described(), declared.declared_at)))
        }
    }
}

fn not_running(component: &str) -> Problem {
    Problem::new(format!("component `{component}` is not running"))
}

/// What has changed, a line each: `controller.gain: 0.8 -> 2`.
fn shown(system: &System, before: &Component, assignments: &[Assignment]) -> String {
    let now = values(system.dir(), &before.name).unwrap_or_default();
    let value = |values: &[(String, String)], name: &str| {
        values.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone())
    };
    let line = |it: &Assignment| {
        let now = value(&now, &it.parameter).unwrap_or_else(|| it.value.clone());
        match value(&before.values, &it.parameter) {
            Some(old) if old != now => format!("{}: {old} -> {now}", it.path()),
            _ => format!("{}: {now}", it.path()),
        }
    };
    assignments.iter().map(|it| format!("{}\n", escape(&line(it)))).collect()
}

/// A component, and one of its parameters, by a name that may be either.
fn find(system: &System, name: &str) -> Result<(Component, Option<ParameterPlan>), Problem> {
    let all = system.components();
    let (component, parameter) = component_and_gate(name, |name| all.iter().any(|it| it.name == name));
    let component = system.component(component)?;
    // Of one that has ended, nothing is known.
    if component.announcement.is_none() {
        return Err(not_running(&component.name));
    }
    let declared = |parameter: &str| {
        let found = component.plan().and_then(|plan| plan.parameters.iter().find(|known| known.name == parameter));
        found.cloned().ok_or_else(|| unknown(&component, parameter))
    };
    let parameter = parameter.map(declared).transpose()?;
    Ok((component, parameter))
}

fn unknown(component: &Component, parameter: &str) -> Problem {
    let names: Vec<&str> = component.parameters().map(|(plan, _)| &*plan.name).collect();
    let name = &component.name;
    let problem = Problem::new(format!("component `{name}` has no parameter `{}`", escape(parameter)));
    if names.is_empty() {
        return problem.note("it has no parameters");
    }
    problem.did_you_mean(parameter, names.iter().copied()).note(format!("`scl get {name}` shows all"))
}

fn table(components: &[Component]) -> String {
    let mut table = Table::with_headings(&["PARAMETER", "VALUE", "UNIT", "LIVE"], &[]);
    for component in components {
        for (plan, value) in component.parameters() {
            let live = if plan.live { "live" } else { "" };
            let value = escape(value.unwrap_or("?")).into_owned();
            table.row([&format!("{}.{}", component.name, plan.name), &value, plan.unit.as_deref().unwrap_or(""), live]);
        }
    }
    if table.is_empty() { "no parameters\n".to_owned() } else { table.text() }
}

fn all_to_json(components: &[Component]) -> Value {
    let with_parameters = components.iter().filter(|component| component.parameters().next().is_some());
    with_parameters.map(|it| (it.name.clone(), it.parameters_to_json())).collect::<Map<_, _>>().into()
}
