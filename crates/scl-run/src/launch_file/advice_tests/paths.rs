//! Paths of other systems.

use super::{check_entries, told};
use expect_test::expect;

#[test]
fn escapes_in_a_path_are_told() {
    check_entries(
        &[
            r#"command: ["build\bin\a", "a\tb"]"#,
            r#"command: [./a, "a\tb"]"#,
            "command: ./a\nworking_directory: ${path.module}/control",
            "command: ./a\nworking_directory: $HOME/control",
            "command: ./a\nworking_directory: \".\\Programs\\new\"",
            "command: ./a\nworking_directory: \"new\\\\programs\"",
            "replay: \"C:\\\\flights\\\\mon day\\t\"",
        ],
        &expect![[r##"
            # command: ["build\bin\a", "a\tb"]
            this path has characters in it that cannot be seen
              write `build/bin/a`
                ?> command: [build/bin/a, "a\tb"]
            # command: [./a, "a\tb"]
            # command: ./a
            working_directory: ${path.module}/control
            `working_directory` is a path as it is written: no shell replaces a part of `${path.module}/control`
              write `control`, if `${path.module}` is the folder of the launch file
                ?> working_directory: control
              a path is absolute, or relative to the folder of the launch file
            # command: ./a
            working_directory: $HOME/control
            `working_directory` is a path as it is written: no shell replaces a part of `$HOME/control`
              a path is absolute, or relative to the folder of the launch file
            # command: ./a
            working_directory: ".\Programs\new"
            this path has characters in it that cannot be seen
              write `./Programs/new`
                ?> working_directory: ./Programs/new
            # command: ./a
            working_directory: "new\\programs"
            # replay: "C:\\flights\\mon day\t"
            this path has characters in it that cannot be seen
              write `C:/flights/mon day/t`
                ?> replay: C:/flights/mon day/t
        "##]],
    );
}

#[test]
fn a_variable_does_not_get_its_old_value() {
    check_entries(
        &[
            "command: ./a\nenvironment: {PATH: '/opt/bin:$PATH', PS1: '$PS', A: '$AB', LD_LIBRARY_PATH: '${LD_LIBRARY_PATH}:b'}",
        ],
        &expect![[r#"
            # command: ./a
            environment: {PATH: '/opt/bin:$PATH', PS1: '$PS', A: '$AB', LD_LIBRARY_PATH: '${LD_LIBRARY_PATH}:b'}
            values are passed on as written: `PATH` does not get its old value in place of `$PATH`
              a command as one text is run by a shell, which knows the old value: `command: PATH=/opt/bin:$PATH exec ...`
            values are passed on as written: `LD_LIBRARY_PATH` does not get its old value in place of `$LD_LIBRARY_PATH`
              a command as one text is run by a shell, which knows the old value: `command: LD_LIBRARY_PATH=${LD_LIBRARY_PATH}:b exec ...`
        "#]],
    );
}

#[test]
fn an_unknown_component_is_told_once() {
    let components = "components: {a: {command: ./a}, b: {command: ./b}}\n";
    let file = format!("{components}profiles:\n  bench:\n    c: {{cpu: 1}}\n");
    expect![[r#"
        unknown component `c`
          (a launch file starts the components of the topology, and nothing else)
          (the topology has the components `a`, `b`)
    "#]]
    .assert_eq(&told(&file));
}

#[test]
fn what_is_meant_is_proposed() {
    let components = "components: {a: {command: ./a}, b: {command: ./b}}\n";
    let file = format!("{components}profiles: {{bench: {{a: {{priority: fifo: 80}}}}}}\n");
    expect![[r#"
        a key has one value, and this is a second colon
          write `priority: fifo:80`
            ?> profiles: {bench: {a: {priority: fifo:80}}}
    "#]]
    .assert_eq(&told(&file));
    let file = format!("{components}defaults: {{build: make, cpu: 2:3, restart_delay: 1s..=2m}}\n");
    expect![[r#"
        unknown key `build` in `defaults`
          `build` belongs at the top of the file
            ?> build: make | defaults: {cpu: 2:3, restart_delay: 1s..=2m}
          or into the entries of components, if it is not the same for all
        `cpu` is a list of processors like `[2, 3]`, counted from 0, or one of them, not `2:3`
          did you mean `cpu: [2, 3]`?
            => defaults: {build: make, cpu: [2, 3], restart_delay: 1s..=2m}
        `restart_delay` is a range like `100ms..5s`, or one time, not `1s..=2m`
          did you mean `restart_delay: 1s..2m`?
            => defaults: {build: make, cpu: 2:3, restart_delay: 1s..2m}
    "#]]
    .assert_eq(&told(&file));
}
