//! Environment variables of SCL: values that components would refuse, and names that nothing reads.

use super::{Examined, Finding};
use scl::examine::{VARIABLES, wrong_variables};
use scl_terminal::{closest_name, escape, quoted_list};
use std::ffi::OsString;
use std::fs;
use std::os::unix::ffi::OsStringExt;

const CHECK: &str = "environment";

/// Variables of SCL that are not settings of a component: `scl run`, `scl simulate` and builds set them.
const OTHERS: [&str; 8] = [
    "SCL_COMPONENT",
    "SCL_CPP_INCLUDE_DIR",
    "SCL_EXECUTABLE",
    "SCL_INCLUDE_DIR",
    "SCL_LIBRARY",
    "SCL_SIMULATION",
    "SCL_STARTED_BY",
    "SCL_TIMEOUT",
];

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    let variable = |name: &str| examined.variable(name);
    let mut findings: Vec<Finding> = wrong_variables(&variable)
        .iter()
        .map(|error| {
            Finding::error(CHECK, escape(&error.to_string())).help("correct or unset it; components refuse to start")
        })
        .collect();
    findings.extend(unknown_names(examined.variables, "this shell"));
    for (_, component, pid) in examined.running() {
        let variables = pid.map(variables_of).unwrap_or_default();
        findings.extend(unknown_names(&variables, &format!("component `{}`", component.name)));
    }
    if findings.is_empty() {
        let set: Vec<_> = VARIABLES.into_iter().filter(|name| examined.variable(name).is_some()).collect();
        let text = if set.is_empty() { "no variable of SCL is set".to_owned() } else { quoted_list(set) };
        findings.push(Finding::ok(CHECK, text));
    }
    findings
}

fn unknown_names(variables: &[(OsString, OsString)], whose: &str) -> Vec<Finding> {
    let names = variables.iter().filter_map(|(name, _)| name.to_str());
    let known = |name: &str| VARIABLES.contains(&name) || OTHERS.contains(&name) || name.starts_with("SCL_TEST_");
    let unknown = names.filter(|name| name.starts_with("SCL_") && !known(name));
    let finding = |name: &str| {
        let finding = Finding::warning(CHECK, format!("{whose} sets `{}`, which nothing reads", escape(name)));
        match closest_name(name, VARIABLES) {
            Some(close) => finding.help(format!("did you mean `{close}`?")),
            None => finding.help(format!("components read {}", quoted_list(VARIABLES))),
        }
    };
    unknown.map(finding).collect()
}

/// The environment with which a process was started.
fn variables_of(pid: u32) -> Vec<(OsString, OsString)> {
    let Ok(environment) = fs::read(format!("/proc/{pid}/environ")) else { return Vec::new() };
    let entries = environment.split(|byte| *byte == 0).filter_map(|entry| {
        let end = entry.iter().position(|byte| *byte == b'=')?;
        let text = |bytes: &[u8]| OsString::from_vec(bytes.to_vec());
        Some((text(&entry[..end]), text(&entry[end + 1..])))
    });
    entries.collect()
}

#[cfg(test)]
mod tests {
    use super::super::Severity;
    use super::*;

    fn found(variables: &[(&str, &str)]) -> Vec<(Severity, String, String)> {
        let variables: Vec<_> = variables.iter().map(|(name, value)| (name.into(), value.into())).collect();
        let examined = Examined { variables: &variables, systems: Vec::new() };
        check(&examined).into_iter().map(|it| (it.severity, it.message, it.help.unwrap_or_default())).collect()
    }

    #[test]
    fn wrong_values_are_errors_and_wrong_names_warnings() {
        assert_eq!(found(&[("HOME", "/")]), [(Severity::Ok, "no variable of SCL is set".to_owned(), String::new())]);
        assert_eq!(found(&[("SCL_LOG", "info")]), [(Severity::Ok, "`SCL_LOG`".to_owned(), String::new())]);
        let all = found(&[("SCL_LOG", "loud"), ("SCL_SCHED", "rr:1"), ("SCL_TRANSPROT", "tcp"), ("SCL_COLOUR", "1")]);
        let severities: Vec<_> = all.iter().map(|(severity, ..)| *severity).collect();
        assert_eq!(severities, [Severity::Error, Severity::Error, Severity::Warning, Severity::Warning]);
        assert!(all[0].1.contains("SCL_LOG") && all[0].1.contains("loud"), "{all:?}");
        assert!(all[1].1.contains("`fifo:1` to `fifo:99`"), "{all:?}");
        assert_eq!(all[2].1, "this shell sets `SCL_TRANSPROT`, which nothing reads");
        assert_eq!(all[2].2, "did you mean `SCL_TRANSPORT`?");
        assert!(all[3].2.starts_with("components read `SCL_CPU`"), "{all:?}");
    }

    #[test]
    fn every_documented_variable_is_known() {
        let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/environment.md");
        let page = std::fs::read_to_string(page).unwrap();
        let names = page.split('`').filter(|word| word.starts_with("SCL_"));
        let variables: Vec<_> = names.map(|name| (name.into(), "".into())).collect();
        assert!(variables.len() > 8, "{variables:?}");
        assert!(unknown_names(&variables, "this shell").is_empty(), "{variables:?}");
    }

    #[test]
    fn the_environment_of_a_process_is_read() {
        let own = variables_of(std::process::id());
        assert!(own.iter().any(|(name, _)| name == "PATH"), "{own:?}");
    }
}
