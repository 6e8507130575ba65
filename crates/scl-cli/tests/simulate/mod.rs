//! `scl simulate`: programs in simulated time.

mod chaos;
mod components;
mod in_rust;
mod mistakes;
mod races;
mod scenarios;

use crate::system::System;
use expect_test::{ExpectFile, expect_file};
use scl::plan::{Plan, SystemPlan};
use std::process::{Command, Output};

/// Runs a simulation in a system's folder.
fn simulate(system: &System, arguments: &[&str]) -> Output {
    system.scl(&[&["simulate"], arguments].concat()).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// What `scl simulate` has written, without the line that depends on the speed of the machine.
#[track_caller]
fn errors(output: &Output) -> String {
    let (before, figures) = text(&output.stderr).split_once("scl: simulated ").map_or_else(
        || (text(&output.stderr), String::new()),
        |(before, figures)| (before.to_owned(), figures.to_owned()),
    );
    assert!(figures.is_empty() || figures.contains(" times as fast as real time, with "), "{figures}");
    before
}

fn lines_of<'a>(output: &'a str, component: &str) -> Vec<&'a str> {
    output.lines().filter(|line| line.starts_with(component)).collect()
}

/// A system of one C program.
fn of_program(source: &str, entry: &str, options: &[&str]) -> System {
    let system = System::of_files(&[
        ("program.c", source),
        ("launch.yaml", &format!("components:\n  program: {{command: [./program]{entry}}}\n")),
    ]);
    let mut compiler = Command::new("cc");
    compiler.args(["-std=gnu11", "-Wall", "-Wextra", "-Werror", "-pthread", "-o", "program"]).args(options);
    let compiled = compiler.arg("program.c").current_dir(system.path("")).status().unwrap();
    assert!(compiled.success());
    system
}

/// A system whose programs are the test of this name in processes of their own, started in this order. The variable
/// `plays` tells each which component it is, and `plan.json` is the plan.
fn of_components(topology: &str, test: &str, plays: &str, order: &[&str]) -> System {
    let program = std::env::current_exe().unwrap();
    let command = format!("[{program:?}, --exact, {test}, --nocapture, --test-threads, 2]");
    let entry = |name: &&str| {
        format!(
            "  {name}: {{command: {command}, environment: {{{plays}: {name}}}, restart: on_failure, \
             restart_delay: 100ms..1s, restart_limit: 100 in 1h}}\n"
        )
    };
    let launch = format!("components:\n{}", order.iter().map(entry).collect::<String>());
    let system = System::of_files(&[("topology.yaml", topology), ("launch.yaml", &launch)]);
    let plan = system.scl(&["plan"]).output().unwrap();
    assert!(plan.status.success(), "{}", text(&plan.stderr));
    system.write("plan.json", &text(&plan.stdout));
    system
}

/// The plan of a component, in a process that plays it.
fn plan(component: &str) -> Plan {
    let system = SystemPlan::from_json(&std::fs::read_to_string("plan.json").unwrap()).unwrap();
    system.component(component).unwrap().clone()
}

#[track_caller]
fn check(output: &Output, code: i32, expected: &ExpectFile) {
    expected.assert_eq(&format!("{}---\n{}", text(&output.stdout), errors(output)));
    assert_eq!(output.status.code(), Some(code));
}

#[test]
fn all_waits_of_the_c_library_follow_simulated_time() {
    let system = of_program(include_str!("waits.c"), "", &[]);
    check(&simulate(&system, &[]), 0, &expect_file!["waits.txt"]);
}

#[test]
fn restarts_and_limits_count_in_simulated_time() {
    let source = "#include <stdio.h>\n#include <unistd.h>\nint main(void) { puts(\"starts\"); sleep(90); return 3; }\n";
    let entry = ", restart: on_failure, restart_delay: 10s..1m, restart_limit: 3 in 1h";
    let system = of_program(source, entry, &[]);
    check(&simulate(&system, &[]), 1, &expect_file!["restarts.txt"]);
    check(&simulate(&system, &["--until", "3min"]), 0, &expect_file!["until.txt"]);
}

#[test]
fn the_first_thread_is_woken_by_the_signal_that_stops_the_program() {
    let source = include_str!("stops.c");
    for way in ["sleep", "pause", "poll", "sigwait", "read"] {
        let system = of_program(source, &format!(", environment: {{WAY: {way}}}"), &[]);
        let output = simulate(&system, &["--until", "1h"]);
        assert_eq!(text(&output.stdout), format!("program | {way} was ended by a signal\n"), "{}", errors(&output));
        assert_eq!(output.status.code(), Some(0));
    }
}

#[test]
fn a_shell_that_becomes_the_program_gives_its_seat_to_it() {
    let source = "#include <stdio.h>\n#include <unistd.h>\nint main(void) { sleep(900); puts(\"done\"); }\n";
    let system = of_program(source, "", &[]);
    system.write("launch.yaml", "components:\n  program: {command: exec ./program}\n");
    let output = simulate(&system, &[]);
    assert_eq!(
        (text(&output.stdout).as_str(), errors(&output).as_str()),
        ("program | done\n", "program  ended with exit code 0 after 900.0 s\n")
    );
}

#[test]
fn random_numbers_come_from_the_seed() {
    let source = "\
#include <stdio.h>
#include <sys/random.h>
int main(void) { unsigned number; getrandom(&number, sizeof number, 0); printf(\"%u\\n\", number); }
";
    let system = of_program(source, "", &[]);
    let number = |arguments: &[&str]| text(&simulate(&system, arguments).stdout);
    assert_eq!(number(&[]), number(&["--seed", "0"]));
    assert_ne!(number(&[]), number(&["--seed", "1"]));
}
