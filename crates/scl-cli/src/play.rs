//! What `scl pub` and `scl call` share: playing a component that is not running.

use crate::load::{MaxSize, TOPOLOGY, load_file, show_errors, shown_path};
use crate::observed::SystemArgument;
use clap::Args;
use scl::OpenOptions;
use scl::runtime_dir::{ComponentState, RuntimeDir, SystemDir};
use scl::untyped::Component;
use scl_observe::{System, problem_of};
use scl_plan::{GateKind, GatePlan, Plan, SystemPlan};
use scl_terminal::{Problem, choose_system, closest_name, escape, named_system, quoted_list};
use scl_text::gate_name::split;
use scl_value::MessageType;
use std::path::{Path, PathBuf};

/// Where the plan of the component comes from.
#[derive(Args)]
pub(crate) struct PlayArguments {
    /// The topology file [default: ./topology.yaml, or else what the running components announce].
    #[arg(long, value_name = "FILE")]
    topology: Option<PathBuf>,
    #[command(flatten)]
    system: SystemArgument,
}

/// The plans of the components of a system.
pub(crate) struct Plans {
    source: Source,
    /// The name of the system that the user has given, if any.
    system: Option<String>,
}

enum Source {
    Topology { plans: SystemPlan, file: String },
    Announcements(System),
}

impl Plans {
    pub(crate) fn find(arguments: &PlayArguments) -> Result<Self, Problem> {
        let system = arguments.system.name().map(str::to_owned);
        let file = match &arguments.topology {
            Some(file) => file.as_path(),
            None if Path::new(TOPOLOGY).is_file() => Path::new(TOPOLOGY),
            None => return Ok(Self { source: Source::Announcements(System::find(arguments.system.name())?), system }),
        };
        let loaded = load_file(file, MaxSize::default());
        let shown = shown_path(file);
        let Some(plans) = loaded.system_plan() else {
            show_errors(&loaded);
            let problem = Problem::new(format!("the topology `{}` cannot be used", escape(&shown)));
            return Err(problem.help("correct the errors above, or choose another file with `--topology FILE`"));
        };
        // The file in the working folder may describe a different system than the one meant. Without `--system`,
        // however, `SCL_SYSTEM` only renames the file's system.
        let variables = |name: &str| std::env::var_os(name);
        let name = arguments.system.name();
        if arguments.topology.is_none() && (name.is_some() || named_system(name, &variables)?.is_none()) {
            let runtime_dir = RuntimeDir::existing(&variables).ok().flatten();
            let running = runtime_dir.and_then(|dir| dir.running_systems().ok()).unwrap_or_default();
            let chosen = choose_system(name, &variables, &running, &|| Some(plans.system.clone()))?;
            if chosen.is_some_and(|chosen| chosen != plans.system) {
                return Ok(Self { source: Source::Announcements(System::find(arguments.system.name())?), system });
            }
        }
        Ok(Self { source: Source::Topology { plans, file: shown }, system })
    }

    /// The plan of a component.
    pub(crate) fn component(&self, name: &str) -> Result<Plan, Problem> {
        match &self.source {
            Source::Announcements(system) => system.plan_of(name),
            Source::Topology { plans, file } => plans.component(name).cloned().map_err(|_| {
                let names = || plans.components.iter().map(|plan| plan.component.as_str());
                let problem = Problem::new(format!("system `{}` has no component `{}`", plans.system, escape(name)));
                problem.did_you_mean(name, names()).note(format!("components in `{file}`: {}", quoted_list(names())))
            }),
        }
    }

    /// Returns the plan of a gate's component, and that of the gate itself.
    pub(crate) fn gate(&self, name: &str) -> Result<(Plan, GatePlan), Problem> {
        let Some((component, gate)) = split(name) else {
            let problem = Problem::new(format!("`{}` is not the name of a gate", escape(name)));
            return Err(problem.help("write `component.gate`"));
        };
        let plan = self.component(component)?;
        match plan.gate(gate).cloned() {
            Some(gate) => Ok((plan, gate)),
            None => Err(self.unknown_gate(&plan, gate)),
        }
    }

    /// Whether a process runs a component.
    pub(crate) fn is_running(&self, component: &str) -> bool {
        self.holder(component).is_some()
    }

    /// Describes the process that runs a component; `None` if none is known.
    pub(crate) fn holder(&self, component: &str) -> Option<String> {
        match self.dir()?.state(component) {
            ComponentState::Running(holder) => Some(holder.to_string()),
            ComponentState::Dead | ComponentState::Stopped => None,
        }
    }

    /// Opens a component as its program would.
    ///
    /// Its `pull` and `rep` gates stay closed: nobody would do the work or answer the requests that they take.
    pub(crate) async fn open(&self, plan: &Plan) -> Result<Component, Problem> {
        let takes_work = |gate: &GatePlan| matches!(gate.kind, GateKind::Pull | GateKind::Rep);
        let gates = plan.gates.iter().filter(|gate| !takes_work(gate)).cloned().collect();
        let plan = Plan { gates, ..plan.clone() };
        let mut options = OpenOptions::new().stands_in();
        if let Some(system) = self.system_name() {
            options = options.system(system);
        }
        Component::open_with(&plan, options).await.map_err(|error| problem_of(&error))
    }

    /// Returns the system in whose runtime folder the components meet; `None` leaves the choice to the environment and
    /// the plan.
    fn system_name(&self) -> Option<String> {
        match &self.source {
            Source::Announcements(system) => Some(system.name().to_owned()),
            Source::Topology { .. } => self.system.clone(),
        }
    }

    fn dir(&self) -> Option<SystemDir> {
        let plans = match &self.source {
            Source::Announcements(system) => return Some(system.dir().clone()),
            Source::Topology { plans, .. } => plans,
        };
        let variables = |name: &str| std::env::var_os(name);
        let chosen = named_system(self.system.as_deref(), &variables).ok()?;
        let name = chosen.unwrap_or_else(|| plans.system.clone());
        RuntimeDir::existing(&variables).ok()??.existing_system(&name).ok()?
    }

    fn unknown_gate(&self, plan: &Plan, gate: &str) -> Problem {
        let problem = Problem::new(format!("component `{}` has no gate `{}`", plan.component, escape(gate)));
        let names = || plan.gates.iter().map(|gate| gate.name.as_str());
        let problem = match closest_name(gate, names()) {
            Some(near) => problem.help(format!("did you mean `{}.{near}`?", plan.component)),
            None => problem,
        };
        let full: Vec<String> = names().map(|name| format!("{}.{name}", plan.component)).collect();
        match (&self.source, full.is_empty()) {
            (_, true) => problem.note("it has no gates"),
            (Source::Topology { .. }, false) => problem.note(format!("its gates: {}", quoted_list(&full))),
            (Source::Announcements(_), false) => {
                problem.note(format!("gates that it or its running peers know: {}", quoted_list(&full)))
            }
        }
    }
}

/// How the messages of a type at a gate are read and written.
pub(crate) fn message_type(plan: &Plan, gate: &GatePlan, type_name: Option<&str>) -> Result<MessageType, Problem> {
    let descriptors = plan.schema.as_ref().map(|schema| &*schema.descriptors);
    MessageType::new(type_name, &gate.codec, descriptors).map_err(|error| {
        Problem::new(format!("messages of `{}.{}` cannot be written: {error}", plan.component, gate.name))
    })
}
