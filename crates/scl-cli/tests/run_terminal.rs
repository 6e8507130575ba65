//! The terminal of `scl run`, lent to one component. `script` gives the test a terminal.

use crate::system::{FOREVER, Started, System};
use std::process::{Command, Stdio};

/// Reads a line, changes the terminal's modes, and leaves them so.
const KEYBOARD: &str = "\
read line && echo \"line $line\"
stty -icanon -echo
trap 'echo interrupted; exit 0' INT
echo changed
read more
";

/// Runs a command of the shell on a terminal of its own.
fn on_terminal(system: &System, command: &str) -> Started {
    let scl = system.scl(&[]);
    let mut script = Command::new("script");
    script.args(["-qec", command, "/dev/null"]).stdin(Stdio::piped()).current_dir(system.path(""));
    script.env("SCL", scl.get_program()).env("SHELL", "/bin/sh").env("NO_COLOR", "1");
    script.envs(scl.get_envs().filter_map(|(name, value)| Some((name, value?))));
    Started::spawn(&mut script)
}

#[test]
fn one_component_reads_from_the_terminal_and_ctrl_c_stops_all() {
    let launch = format!(
        "components:\n  keyboard: {{command: [/bin/sh, keyboard.sh], input: terminal}}\n  other: {{command: {FOREVER:?}}}\n"
    );
    let system = System::of_files(&[("launch.yaml", &launch), ("keyboard.sh", KEYBOARD)]);
    let mut run = on_terminal(&system, "\"$SCL\" run; echo \"code $?\"; stty -a");
    run.write_input("hello\n");
    run.wait_for_line("keyboard | line hello");
    run.wait_for_line("keyboard | changed");
    run.write_input("\x03");
    run.wait_for("scl: received SIGINT");
    run.wait_for_line("code 0");
    let (_, modes, _) = run.finish();
    assert!(modes.split_whitespace().any(|mode| mode == "icanon"), "{modes}");
    assert!(modes.split_whitespace().any(|mode| mode == "echo"), "{modes}");
}

#[test]
fn a_component_that_uses_the_terminal_without_it_is_told() {
    let launch = "components:\n  greedy: {command: [/bin/sh, -c, 'read line </dev/tty']}\n";
    let system = System::of_files(&[("launch.yaml", launch)]);
    let mut run = on_terminal(&system, "exec \"$SCL\" run");
    run.wait_for_line(
        "greedy  stopped by SIGTTIN: it uses the terminal; write `input: terminal` in the entry of `greedy`",
    );
    run.write_input("\x03");
    run.wait_for("greedy  killed by signal 2 (SIGINT)");
    run.finish();
}

#[test]
fn without_a_terminal_the_input_is_empty_and_the_reason_is_told() {
    let system = System::of_files(&[("launch.yaml", "components: {keyboard: {command: [cat], input: terminal}}\n")]);
    let output = system.run(&[]);
    let err = String::from_utf8(output.stderr).unwrap();
    let expected = "keyboard  its standard input is empty: the standard input of `scl run` is not its terminal\n";
    assert!(err.contains(expected), "{err}");
    assert!(output.status.success());
}

#[test]
fn the_input_of_the_other_programs_is_empty() {
    let system = System::of(&[("reader", "cat; echo end")]);
    // That of `scl run` stays open.
    let mut run = system.start_with(&[], |command| {
        command.stdin(Stdio::piped());
    });
    run.wait_for_line("reader | end");
    assert_eq!(run.finish().0.code(), Some(0));
}

#[test]
fn ctrl_z_stops_the_run_and_the_program_on_the_terminal_until_fg() {
    // The signal interrupts a read.
    let keyboard = "trap 'echo continued' CONT; echo ready; while :; do read line && echo \"line $line\"; done";
    let other = "while read line < go; do echo $line > went; done";
    let launch = format!(
        "components:\n  keyboard: {{command: [/bin/sh, -c, {keyboard:?}], input: terminal}}\n  other: {{command: {other:?}}}\n"
    );
    let system = System::of_files(&[("launch.yaml", &launch)]);
    let (go, went) = (system.make_pipe("go"), system.make_pipe("went"));
    let mut run = on_terminal(&system, "set -m; \"$SCL\" run; echo \"stopped $?\"; read line; fg; echo \"code $?\"");
    run.wait_for_line("keyboard | ready");
    run.write_input("\x1a");
    run.wait_until("stopped", |line| line.contains("stopped "));
    std::fs::write(go, "on\n").unwrap();
    assert_eq!(std::fs::read_to_string(went).unwrap(), "on\n", "the others run on");
    run.write_input("\n");
    run.wait_for_line("keyboard | continued");
    run.write_input("again\n");
    run.wait_for_line("keyboard | line again");
    run.write_input("\x03");
    run.wait_for("code ");
    run.finish();
}

#[test]
fn in_raw_mode_ctrl_c_is_a_key_and_a_stop_from_elsewhere_stops_all() {
    let keyboard = "stty raw -echo; echo raw; head -c 1 | od -An -tx1; exec tail -f /dev/null";
    let launch = format!("components: {{keyboard: {{command: [/bin/sh, -c, {keyboard:?}], input: terminal}}}}\n");
    let topology = "system: rover\ncomponents:\n  - name: keyboard\nconnections: []\n";
    let system = System::of_files(&[("launch.yaml", &launch), ("topology.yaml", topology)]);
    let mut run = on_terminal(&system, "\"$SCL\" run; echo \"code $?\"");
    run.wait_for_line("keyboard | raw");
    run.write_input("\x03");
    run.wait_for_line("keyboard |  03");
    assert!(system.scl(&["stop"]).output().unwrap().status.success());
    run.wait_for_line("code 0");
    run.finish();
}
