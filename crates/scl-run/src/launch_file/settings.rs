//! The keys of a component that may also stand in `defaults`: restarts, time limits, processors, priority, descriptors.

use super::super::policy::{Policy, Restart, RestartDelay, RestartLimit};
use super::forms::{any_duration, limit, priority, restart_delay, restart_limit};
use super::keys::{Form, form_of};
use super::likely::{Likely, likely};
use super::reader::{Keys, Reader, wrong};
use super::rules::WRONG_VALUE;
use super::value::{flag, number, path, processors, shown, texts};
use super::words::bare;
use scl_text::rate;
use scl_topology::diagnostic::{Diagnostic, Edit};
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
        self.wrong_form(field, field.key, &format!("`{}`", field.key));
    }

    /// Reports a value that does not have the form of `key`; `what` names the value in the message.
    pub(super) fn wrong_form(&mut self, field: Field<'_>, key: &str, what: &str) {
        if matches!(field.value.kind, NodeKind::Unread) {
            return;
        }
        let form = form_of(key);
        let message = format!("{what} is {}, not {}", form.description(), shown_value(form, field.value));
        let problem = self.with_template(wrong(&WRONG_VALUE, message, field), field.value);
        if is_unlimited(key, field.value)
            && let Some(edit) = self.remove_entry(field)
        {
            let text = format!("without `{}`, there is no limit: remove it", field.key);
            return self.report(problem.suggest(text, [edit]));
        }
        let Likely { values, is_certain } = likely(key, field.value);
        let meant = |value: &str| {
            let help = format!("did you mean `{}: {value}`?", field.key);
            // An empty value has no place of its own.
            (help, [Edit::new(field.value.span, value)])
        };
        let problem = values.iter().fold(problem, |problem, value| match meant(value) {
            (help, edits) if is_certain => problem.propose(help, edits),
            (help, edits) => problem.suggest(help, edits),
        });
        let text = field.value.text().unwrap_or_default();
        let advice = match key {
            "restart_delay" if values.len() > 1 => {
                Some("the second time is the longest delay, so it cannot be shorter than the first")
            }
            _ if text.contains('…') => Some("`…` is a single character: write two dots"),
            "cpu" if text.starts_with("0x") => Some("processors are counted from 0, and a mask is written as a list"),
            _ if rate::period(text).is_some() => Some("a time is the period of a rate, not the rate"),
            _ if !values.is_empty() => None,
            "cpu" if text.contains(|letter: char| letter == '.' || letter == '%' || letter.is_alphabetic()) => {
                Some("an amount of computing time cannot be set")
            }
            "descriptors" => Some("the largest possible number is what `ulimit -Hn` prints"),
            _ => None,
        };
        self.report(problem.notes(advice));
    }

    /// Adds a note to the problem of a value that is a placeholder of a template.
    pub(super) fn with_template(&self, problem: Diagnostic, value: &Node) -> Diagnostic {
        let written = self.written(value.span);
        let is_placeholder = written.starts_with("{{") || written.starts_with("${") || written.starts_with("<%");
        match is_placeholder {
            true => problem.note("placeholders of templates and of the shell are not replaced here"),
            false => problem,
        }
    }
}

/// Whether the value of a time limit says that there is none.
fn is_unlimited(key: &str, value: &Node) -> bool {
    let is_limit = matches!(key, "ready_within" | "alive_within" | "cpu" | "descriptors");
    let text = value.text().map(bare).unwrap_or_default();
    let is_zero = || {
        matches!(key, "ready_within" | "alive_within")
            && (text == "0" || any_duration(&text).is_some_and(|time| time.is_zero()))
    };
    is_limit
        && (matches!(text.as_str(), "none" | "infinity" | "inf" | "never" | "off" | "all" | "any" | "false")
            || is_zero())
}

/// Describes a wrong value. Where a list is expected, a list is shown with its items.
fn shown_value(form: Form, value: &Node) -> String {
    let items = texts(value).filter(|items| form == Form::Processors && !items.is_empty());
    items.map_or_else(|| shown(value), |items| format!("`[{}]`", items.join(", ")))
}
