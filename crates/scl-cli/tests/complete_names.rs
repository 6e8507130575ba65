//! Completion of the names of gates and components, in the shells for which it is.

use crate::rover::Rover;
use scl_needs::needs;
use std::path::Path;
use std::process::{Command, Stdio};

/// What is typed, and what is offered.
const CASES: [(&str, &str); 7] = [
    ("scl info sensor.m", "sensor.measurements"),
    ("scl info logg", "logger logger.events logger.images"),
    ("scl info --system rover controller.s", "controller.sensor"),
    ("scl info --system other sens", ""),
    ("scl hz controller.a", "controller.actuator"),
    ("scl hz sensor.image sensor.po", "sensor.position"),
    ("scl info nothing", ""),
];

#[test]
fn the_hidden_command_prints_names() {
    let rover = Rover::start();
    for (arguments, expected) in [
        (&["complete-gates", "controller.c"][..], "controller.commands\n"),
        (&["complete-gates", "--components"], "actuator\ncontroller\nlogger\nsensor\nuser_interface\n"),
        (&["complete-gates", "--components", "se"], "sensor\n"),
        (&["complete-gates", "--system", "other"], ""),
        (&["complete-gates", "--", "-x"], ""),
    ] {
        assert_eq!(rover.text(arguments), expected, "{arguments:?}");
    }
}

#[test]
fn without_a_system_nothing_is_offered() {
    assert_eq!(Rover::stopped().text(&["complete-gates"]), "");
}

#[test]
fn bash_completes_names() {
    let rover = with_script("bash");
    for (words, expected) in CASES {
        let last = words.split(' ').count() - 1;
        let ask = format!(
            "source ./script; COMP_WORDS=({words}); COMP_CWORD={last}; \
             _scl_with_names scl \"${{COMP_WORDS[{last}]}}\" \"${{COMP_WORDS[{last} - 1]}}\"; echo \"${{COMPREPLY[*]}}\""
        );
        assert_eq!(sorted(&answer(&rover, "bash", &["-c", &ask])), expected, "{words}");
    }
    // Options and commands are completed as before.
    let ask = "source ./script; COMP_WORDS=(scl info --form); COMP_CWORD=2; _scl_with_names scl --form info; \
               echo \"${COMPREPLY[*]}\"";
    assert_eq!(answer(&rover, "bash", &["-c", ask]), "--format");
}

#[test]
fn the_scripts_ask_for_the_names_that_a_command_takes() {
    let script = |shell| {
        let output = Command::new(env!("CARGO_BIN_EXE_scl")).args(["completions", shell]).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let fish = script("fish");
    assert!(fish.contains("__fish_seen_subcommand_from info\" -f -a \"(__fish_scl_names --components)\""), "{fish}");
    let zsh = script("zsh");
    assert!(zsh.contains("info:) wanted=\"gates components\" ;;"), "{zsh}");
    assert!(zsh.ends_with("compdef _scl_with_names scl\nfi\n"), "{zsh}");
}

#[needs("fish")]
#[test]
fn fish_completes_names() {
    let rover = with_script("fish");
    for (words, expected) in CASES {
        let offered = answer(&rover, "fish", &["-c", &format!("source ./script; complete -C '{words}'")]);
        assert_eq!(sorted(&offered), expected, "{words}");
    }
}

#[needs("zsh")]
#[test]
fn zsh_completes_names() {
    let rover = with_script("zsh");
    for (words, expected) in CASES {
        // What the completion system would add is printed instead.
        let (before, current) = words.rsplit_once(' ').unwrap();
        let ask = format!(
            "compdef() {{ :; }}; compadd() {{ shift; print -r -- $@; }}; source ./script; \
             words=({words}); CURRENT=${{#words}}; PREFIX={current:?}; _scl_with_names # after {before}"
        );
        assert_eq!(sorted(&answer(&rover, "zsh", &["-f", "-c", &ask])), expected, "{words}");
    }
}

fn with_script(shell: &str) -> Rover {
    let rover = Rover::start();
    std::fs::write(rover.path("script"), rover.text(&["completions", shell])).unwrap();
    rover
}

/// What a shell prints that finds `scl` in its `PATH`.
fn answer(rover: &Rover, shell: &str, arguments: &[&str]) -> String {
    let scl = rover.scl(&[]);
    let mut command = Command::new(shell);
    command.args(arguments).current_dir(rover.path("")).stdin(Stdio::null());
    command.env("HOME", rover.path("")).envs(scl.get_envs().filter_map(|(name, value)| Some((name, value?))));
    let folder = Path::new(env!("CARGO_BIN_EXE_scl")).parent().unwrap().to_owned();
    let path = std::env::var_os("PATH").unwrap();
    let folders = [folder].into_iter().chain(std::env::split_paths(&path));
    let answer = command.env("PATH", std::env::join_paths(folders).unwrap()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&answer.stderr), "", "{arguments:?}");
    String::from_utf8(answer.stdout).unwrap().trim().to_owned()
}

fn sorted(offered: &str) -> String {
    let mut names: Vec<&str> = offered.split_whitespace().collect();
    names.sort_unstable();
    names.join(" ")
}
