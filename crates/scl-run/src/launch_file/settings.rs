//! The keys of a component that may also stand in `defaults`: restarts, limits of time, processors, priority,
//! descriptors.

use super::super::policy::{Policy, Restart, RestartDelay, RestartLimit};
use super::keys::{Form, form_of};
use super::reader::{KeyPath, Reader, joined, scalar_text, shown};
use scl_terminal::{Problem, closest_name, parse_duration};
use serde_yaml::{Mapping, Value};
use std::time::Duration;

/// Settings as written: what is not is `None`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Settings {
    pub(crate) restart: Option<Restart>,
    pub(crate) restart_delay: Option<RestartDelay>,
    pub(crate) restart_limit: Option<RestartLimit>,
    pub(crate) essential: Option<bool>,
    pub(crate) stop_within: Option<Duration>,
    pub(crate) ready_within: Option<Duration>,
    pub(crate) alive_within: Option<Duration>,
    /// At least one.
    pub(crate) cpu: Option<Vec<usize>>,
    /// 1 to 99.
    pub(crate) priority: Option<u8>,
    /// At least one.
    pub(crate) descriptors: Option<u64>,
    /// As written.
    pub(crate) working_directory: Option<String>,
}

impl Settings {
    /// These settings, and those of `base` that are missing here.
    pub(crate) fn over(self, base: &Settings) -> Settings {
        let base = base.clone();
        Settings {
            restart: self.restart.or(base.restart),
            restart_delay: self.restart_delay.or(base.restart_delay),
            restart_limit: self.restart_limit.or(base.restart_limit),
            essential: self.essential.or(base.essential),
            stop_within: self.stop_within.or(base.stop_within),
            ready_within: self.ready_within.or(base.ready_within),
            alive_within: self.alive_within.or(base.alive_within),
            cpu: self.cpu.or(base.cpu),
            priority: self.priority.or(base.priority),
            descriptors: self.descriptors.or(base.descriptors),
            working_directory: self.working_directory.or(base.working_directory),
        }
    }

    /// The policy of the component; `grace` is the time to stop where none is written.
    pub(crate) fn policy(&self, grace: Duration) -> Policy {
        let default = Policy::default();
        Policy {
            restart: self.restart.unwrap_or(default.restart),
            delay: self.restart_delay.unwrap_or(default.delay),
            limit: self.restart_limit.unwrap_or(default.limit),
            essential: self.essential.unwrap_or(default.essential),
            stop_within: self.stop_within.unwrap_or(grace),
            ready_within: self.ready_within,
            alive_within: self.alive_within,
        }
    }
}

impl Reader<'_> {
    /// Reads the settings of a mapping, whose keys have been checked.
    pub(super) fn read_settings(&mut self, keys: &Mapping, at: KeyPath<'_>) -> Settings {
        Settings {
            restart: self.read_setting(keys, at, "restart", restart),
            restart_delay: self.read_setting(keys, at, "restart_delay", restart_delay),
            restart_limit: self.read_setting(keys, at, "restart_limit", restart_limit),
            essential: self.read_setting(keys, at, "essential", Value::as_bool),
            stop_within: self.read_setting(keys, at, "stop_within", any_duration),
            ready_within: self.read_setting(keys, at, "ready_within", limit),
            alive_within: self.read_setting(keys, at, "alive_within", limit),
            cpu: self.read_setting(keys, at, "cpu", processors),
            priority: self.read_setting(keys, at, "priority", priority),
            descriptors: self.read_setting(keys, at, "descriptors", descriptors),
            working_directory: self.read_path(keys.get("working_directory"), &joined(at, "working_directory")),
        }
    }

    /// Reads the value of a key with `read`, which returns `None` for a wrong one.
    pub(super) fn read_setting<T>(
        &mut self,
        keys: &Mapping,
        at: KeyPath<'_>,
        key: &str,
        read: impl Fn(&Value) -> Option<T>,
    ) -> Option<T> {
        let value = keys.get(key)?;
        let read = read(value);
        if read.is_none() {
            self.wrong_value(&joined(at, key), value);
        }
        read
    }

    /// Reports a value that is not what the key's row in the table says; the last of `at` is the key.
    pub(super) fn wrong_value(&mut self, at: KeyPath<'_>, value: &Value) {
        let key = at.last().copied().unwrap_or_default();
        let form = form_of(key);
        let problem = Problem::new(format!("`{key}` is {}, not {}", form.description(), shown_value(form, value)));
        let problem = problem.at(self.text.place(at));
        let help = likely(form, value).map(|meant| format!("did you mean `{key}: {meant}`?"));
        self.problems.push(match help {
            Some(help) => problem.help(help),
            None => problem,
        });
    }
}

/// Describes a wrong value: a list by its items, where one is expected.
fn shown_value(form: Form, value: &Value) -> String {
    let items = value.as_sequence().filter(|items| form == Form::Processors && !items.is_empty());
    let texts = items.and_then(|items| items.iter().map(scalar_text).collect::<Option<Vec<String>>>());
    texts.map_or_else(|| shown(value), |texts| format!("`[{}]`", texts.join(", ")))
}

/// What was probably meant by a wrong value.
pub(super) fn likely(form: Form, value: &Value) -> Option<String> {
    let text = scalar_text(value)?;
    let text = text.trim();
    let candidate = match form {
        Form::Word(words) => {
            return closest_name(&text.replace(['-', ' '], "_"), words.iter().copied()).map(str::to_owned);
        }
        Form::Flag => match text.to_lowercase().as_str() {
            "yes" | "on" | "y" | "1" => return Some("true".to_owned()),
            "no" | "off" | "n" | "0" => return Some("false".to_owned()),
            word => return closest_name(word, ["true", "false"]).map(str::to_owned),
        },
        Form::Port => return text.parse::<u16>().ok().filter(|port| *port != 0).map(|port| port.to_string()),
        // A number without its unit: seconds, as nearly every other tool has it.
        Form::Duration => format!("{text}s"),
        Form::DelayRange => text.replacen("...", "..", 1).replacen('-', "..", 1).replacen(" to ", "..", 1),
        Form::RestartLimit => text.replace('/', " in ").replace(" per ", " in "),
        Form::Priority => format!("fifo:{}", text.rsplit([':', ' ', '-']).next().unwrap_or(text)),
        _ => return None,
    };
    let read = Value::from(candidate.as_str());
    let usable = match form {
        Form::Duration => limit(&read).is_some(),
        Form::DelayRange => restart_delay(&read).is_some(),
        Form::RestartLimit => restart_limit(&read).is_some(),
        _ => priority(&read).is_some(),
    };
    usable.then_some(candidate)
}

fn restart(value: &Value) -> Option<Restart> {
    let word = value.as_str()?;
    Restart::WORDS.into_iter().find(|(name, _)| *name == word).map(|(_, restart)| restart)
}

fn any_duration(value: &Value) -> Option<Duration> {
    parse_duration(value.as_str()?.trim()).ok()
}

/// A time in which something must happen, so not zero.
fn limit(value: &Value) -> Option<Duration> {
    any_duration(value).filter(|time| !time.is_zero())
}

fn restart_delay(value: &Value) -> Option<RestartDelay> {
    let text = value.as_str()?;
    let (first, longest) = text.split_once("..").unwrap_or((text, text));
    let (first, longest) = (parse_duration(first.trim()).ok()?, parse_duration(longest.trim()).ok()?);
    (first <= longest).then_some(RestartDelay { first, longest })
}

fn restart_limit(value: &Value) -> Option<RestartLimit> {
    let (count, within) = value.as_str()?.split_once(" in ")?;
    let within = parse_duration(within.trim()).ok().filter(|time| !time.is_zero())?;
    Some(RestartLimit { count: count.trim().parse().ok()?, within })
}

fn processors(value: &Value) -> Option<Vec<usize>> {
    let number = |value: &Value| {
        let number = value.as_u64().and_then(|number| usize::try_from(number).ok());
        number.filter(|number| *number < rustix::thread::CpuSet::MAX_CPU)
    };
    match value {
        Value::Sequence(numbers) if !numbers.is_empty() => numbers.iter().map(number).collect(),
        Value::Number(_) => Some(vec![number(value)?]),
        _ => None,
    }
}

fn descriptors(value: &Value) -> Option<u64> {
    value.as_u64().filter(|most| *most > 0)
}

fn priority(value: &Value) -> Option<u8> {
    value.as_str()?.strip_prefix("fifo:")?.parse().ok().filter(|priority| (1..=99).contains(priority))
}
