//! The keys of a component that may also stand in `defaults`: restarts, time limits, processors, priority, descriptors.

use super::super::policy::{Policy, Restart, RestartDelay, RestartLimit};
use super::keys::{Form, form_of};
use super::reader::{Keys, Reader, wrong};
use super::rules::WRONG_VALUE;
use super::value::{flag, number, path, shown, texts};
use scl_terminal::{closest_name, parse_duration};
use scl_topology::diagnostic::Edit;
use scl_topology::parse::Field;
use scl_topology::yaml::{Node, NodeKind};
use std::time::Duration;

/// Declares the settings: name, type, and the function that reads the value and returns `None` for a wrong one.
macro_rules! settings {
    ($($(#[$doc:meta])* $name:ident: $type:ty = $read:expr,)*) => {
        /// Settings as written; a setting that is not written is `None`.
        #[derive(Debug, Clone, PartialEq, Eq, Default)]
        pub(crate) struct Settings {
            $($(#[$doc])* pub(crate) $name: Option<$type>,)*
        }

        impl Settings {
            /// These settings; the settings of `base` replace missing ones.
            pub(crate) fn over(self, base: &Settings) -> Settings {
                let base = base.clone();
                Settings { $($name: self.$name.or(base.$name),)* }
            }
        }

        impl Reader<'_> {
            /// Reads the settings of a mapping, whose keys have been checked.
            pub(super) fn read_settings(&mut self, keys: &Keys<'_, '_>) -> Settings {
                Settings { $($name: self.read_setting(keys, stringify!($name), $read),)* }
            }
        }
    };
}

settings! {
    restart: Restart = |value| Restart::of(value.text()?),
    restart_delay: RestartDelay = |value| restart_delay(value.text()?),
    restart_limit: RestartLimit = |value| restart_limit(value.text()?),
    essential: bool = flag,
    stop_within: Duration = |value| any_duration(value.text()?),
    ready_within: Duration = |value| limit(value.text()?),
    alive_within: Duration = |value| limit(value.text()?),
    /// At least one.
    cpu: Vec<usize> = processors,
    /// 1 to 99.
    priority: u8 = |value| priority(value.text()?),
    /// At least one.
    descriptors: u64 = |value| number(value).filter(|most| *most > 0),
    /// As written.
    working_directory: String = path,
}

impl Settings {
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
    /// Reads the value of a key with `read`, which returns `None` for a wrong one.
    pub(super) fn read_setting<T>(
        &mut self,
        keys: &Keys<'_, '_>,
        key: &str,
        read: impl Fn(&Node) -> Option<T>,
    ) -> Option<T> {
        let field = keys.get(key)?;
        let read = read(field.value);
        if read.is_none() {
            self.wrong_value(field);
        }
        read
    }

    /// Reports a value that does not have the form that its key needs.
    pub(super) fn wrong_value(&mut self, field: Field<'_>) {
        let form = form_of(field.key);
        self.wrong_form(field, form, &format!("`{}`", field.key));
    }

    /// Reports a value that does not have this form; `what` names the value in the message.
    pub(super) fn wrong_form(&mut self, field: Field<'_>, form: Form, what: &str) {
        if matches!(field.value.kind, NodeKind::Unread) {
            return;
        }
        let message = format!("{what} is {}, not {}", form.description(), shown_value(form, field.value));
        let problem = wrong(&WRONG_VALUE, message, field);
        let meant = field.value.text().and_then(|text| likely(form, text.trim()));
        let Some(meant) = meant else { return self.report(problem) };
        let help = format!("did you mean `{}: {meant}`?", field.key);
        let edits = [Edit::new(field.value.span, meant)];
        // A number without a unit may have been meant in milliseconds.
        let is_certain = form != Form::Duration;
        self.report(if is_certain { problem.propose(help, edits) } else { problem.suggest(help, edits) });
    }
}

/// Describes a wrong value. Where a list is expected, a list is shown with its items.
fn shown_value(form: Form, value: &Node) -> String {
    let items = texts(value).filter(|items| form == Form::Processors && !items.is_empty());
    items.map_or_else(|| shown(value), |items| format!("`[{}]`", items.join(", ")))
}

/// Guesses what was meant by a wrong value.
fn likely(form: Form, text: &str) -> Option<String> {
    match form {
        Form::Word(words) => closest_name(&text.replace(['-', ' '], "_"), words.iter().copied()).map(str::to_owned),
        Form::Flag => match text.to_lowercase().as_str() {
            "yes" | "on" | "y" | "1" => Some("true".to_owned()),
            "no" | "off" | "n" | "0" => Some("false".to_owned()),
            other => closest_name(other, ["true", "false"]).map(str::to_owned),
        },
        Form::Port => text.parse::<u16>().ok().filter(|port| *port != 0).map(|port| port.to_string()),
        // Assume seconds for a number without a unit, as most other tools do.
        Form::Duration => Some(format!("{text}s")).filter(|meant| limit(meant).is_some()),
        Form::DelayRange => {
            let meant = text.replacen("...", "..", 1).replacen('-', "..", 1).replacen(" to ", "..", 1);
            restart_delay(&meant).map(|_| meant)
        }
        Form::RestartLimit => {
            let meant = text.replace('/', " in ").replace(" per ", " in ");
            restart_limit(&meant).map(|_| meant)
        }
        Form::Priority => {
            let meant = format!("fifo:{}", text.rsplit([':', ' ', '-']).next().unwrap_or(text));
            priority(&meant).map(|_| meant)
        }
        _ => None,
    }
}

fn any_duration(text: &str) -> Option<Duration> {
    parse_duration(text.trim()).ok()
}

/// Parses a time limit, which must not be zero.
fn limit(text: &str) -> Option<Duration> {
    any_duration(text).filter(|time| !time.is_zero())
}

fn restart_delay(text: &str) -> Option<RestartDelay> {
    let (first, longest) = text.split_once("..").unwrap_or((text, text));
    let (first, longest) = (any_duration(first)?, any_duration(longest)?);
    (first <= longest).then_some(RestartDelay { first, longest })
}

fn restart_limit(text: &str) -> Option<RestartLimit> {
    let (count, within) = text.split_once(" in ")?;
    Some(RestartLimit { count: count.trim().parse().ok()?, within: limit(within)? })
}

fn processors(value: &Node) -> Option<Vec<usize>> {
    let processor = |value: &Node| {
        let number = number(value).and_then(|number| usize::try_from(number).ok());
        number.filter(|number| *number < rustix::thread::CpuSet::MAX_CPU)
    };
    match value.items() {
        Some(numbers) if !numbers.is_empty() => numbers.iter().map(processor).collect(),
        Some(_) => None,
        None => Some(vec![processor(value)?]),
    }
}

fn priority(text: &str) -> Option<u8> {
    text.strip_prefix("fifo:")?.parse().ok().filter(|priority| (1..=99).contains(priority))
}
