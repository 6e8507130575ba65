//! Which system a command means: one rule for all of them.

use crate::{Problem, quoted_list};
use std::ffi::OsString;

/// Returns the system that a command means: the one named with `--system`, else `$SCL_SYSTEM`, else the only one that
/// runs, else that of the topology file in the working folder, which `here` reads. `None` if none of these names a
/// system.
///
/// # Errors
/// Several systems run, and the topology file is not that of one of them; or the variable is not UTF-8.
pub fn choose_system(
    name: Option<&str>,
    variables: &dyn Fn(&str) -> Option<OsString>,
    running: &[String],
    here: &dyn Fn() -> Option<String>,
) -> Result<Option<String>, Problem> {
    if let Some(named) = named_system(name, variables)? {
        return Ok(Some(named));
    }
    match running {
        [] => Ok(here()),
        [only] => Ok(Some(only.clone())),
        several => match here().filter(|here| several.contains(here)) {
            Some(here) => Ok(Some(here)),
            None => Err(Problem::new("several systems are running")
                .help(format!("name one: `--system {}`, or set `SCL_SYSTEM`", several[0]))
                .note(format!("running: {}", quoted_list(several)))),
        },
    }
}

/// The system that the user has named: with `--system`, else with `$SCL_SYSTEM`.
///
/// # Errors
/// The variable is not UTF-8.
pub fn named_system(
    name: Option<&str>,
    variables: &dyn Fn(&str) -> Option<OsString>,
) -> Result<Option<String>, Problem> {
    if let Some(name) = name {
        return Ok(Some(name.to_owned()));
    }
    let Some(value) = variables("SCL_SYSTEM").filter(|value| !value.is_empty()) else { return Ok(None) };
    let not_text = |value: OsString| {
        Problem::new(format!("`SCL_SYSTEM` is `{}`, which is not valid UTF-8", value.to_string_lossy()))
            .help("name the system with `--system`")
    };
    value.into_string().map(Some).map_err(not_text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_that_names_a_system_decides() {
        let choose = |name, variable: Option<&str>, running: &[&str], here: Option<&str>| {
            let running: Vec<String> = running.iter().map(|name| (*name).to_owned()).collect();
            let variables = |_: &str| variable.map(OsString::from);
            choose_system(name, &variables, &running, &|| here.map(str::to_owned))
        };
        let named = |name: &str| Ok(Some(name.to_owned()));
        assert_eq!(choose(Some("a"), Some("b"), &["c"], Some("d")), named("a"));
        assert_eq!(choose(None, Some("b"), &["c"], Some("d")), named("b"));
        assert_eq!(choose(None, Some(""), &["c"], Some("d")), named("c"));
        assert_eq!(choose(None, None, &["c", "d"], Some("d")), named("d"));
        assert_eq!(choose(None, None, &[], Some("d")), named("d"));
        assert_eq!(choose(None, None, &[], None), Ok(None));
        let problem = choose(None, None, &["c", "e"], Some("d")).unwrap_err().to_string();
        assert_eq!(
            problem,
            "error: several systems are running\n  = help: name one: `--system c`, or set `SCL_SYSTEM`\n  \
             = note: running: `c`, `e`\n"
        );
    }
}
