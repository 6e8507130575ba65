//! What is proposed for the habits of other tools, and for what no program can have been meant to get.

use super::super::system_names::SystemNames;
use super::LaunchDocument;
use expect_test::{Expect, expect};
use scl_topology::advice::apply;

/// Each problem of a text with its notes, and what each proposal makes of the changed lines.
fn told(text: &str) -> String {
    let names = SystemNames {
        components: ["a", "b"].map(str::to_owned).to_vec(),
        gates: ["a.images", "b.images"].map(str::to_owned).to_vec(),
        ..SystemNames::default()
    };
    let found = LaunchDocument::parse("launch.yaml", text).read(Some(&names)).err().unwrap_or_default();
    let mut out = String::new();
    for problem in &found {
        out.push_str(&format!("{}\n", problem.message));
        for help in problem.shown_helps() {
            out.push_str(&format!("  {}\n", help.text()));
            for way in &help.proposals {
                let changed = apply(text, &way.edits.iter().collect::<Vec<_>>()).unwrap_or_default();
                let lines = changed.lines().filter(|line| !text.lines().any(|old| old == *line)).map(str::trim_start);
                let lines: Vec<&str> = lines.collect();
                out.push_str(&format!("    {} {}\n", if way.is_sure { "=>" } else { "?>" }, lines.join(" | ")));
            }
        }
        problem.notes.iter().for_each(|note| out.push_str(&format!("  ({note})\n")));
    }
    out
}

/// What is told about entries of component `a`.
#[track_caller]
fn check_entries(entries: &[&str], expected: &Expect) {
    let all = entries.iter().map(|entry| {
        let lines = entry.replace('\n', "\n    ");
        format!("# {entry}\n{}", told(&format!("components:\n  a:\n    {lines}\n  b: {{command: ./b}}\n")))
    });
    expected.assert_eq(&all.collect::<String>());
}

#[test]
fn what_no_program_can_get_is_told() {
    check_entries(
        &[
            "command: [./a --rate 100]",
            "command: [./a, --rate 100]",
            "command: [\"./a b\", 'c d', e f]",
            "command: [./a, '|', tee, log]",
            "command: [./a, 2>, log file]",
            "command: [./a, $HOME/x]",
            "command: [./a, '$HOME']",
            "command: [sh, -c, echo $HOME]",
            "command: [~/a, -v]",
            "command: [“./a”, -v]",
            "command: ./a —rate 5",
            "command: ./a \\\n  --rate 5",
            "command: |\n  ./a \\\n  --rate 5",
            "command: ./a\nworking_directory: ~/x",
            "command: ./a\nworking_directory: $HOME/x",
            "replay: “x.mcap”",
        ],
        &expect![[r##"
            # command: [./a --rate 100]
            `./a --rate 100` is a single word of this list, so it is the name of the program
              write each word as an item: `./a, --rate, 100`
                => command: [./a, --rate, 100]
              (a name with spaces is written in quotes)
            # command: [./a, --rate 100]
            `--rate 100` is a single word of this list, so it is a single argument
              write two items: `--rate, 100`
                => command: [./a, --rate, 100]
              (an argument with spaces is written in quotes)
            # command: ["./a b", 'c d', e f]
            # command: [./a, '|', tee, log]
            the program would get `|` as an argument: a list is executed without a shell
              write `command: ./a | tee log`
                ?> command: ./a | tee log
              (a text is given to the shell if it needs one)
            # command: [./a, 2>, log file]
            the program would get `2>` as an argument: a list is executed without a shell
              write `command: ./a 2> 'log file'`
                ?> command: ./a 2> 'log file'
              (a text is given to the shell if it needs one)
            # command: [./a, $HOME/x]
            `$HOME/x` is passed on as it is: a list is executed without a shell
              write `command: ./a $HOME/x`
                ?> command: ./a $HOME/x
              (a text is given to the shell if it needs one)
            # command: [./a, '$HOME']
            # command: [sh, -c, echo $HOME]
            # command: [~/a, -v]
            `~/a` is passed on as it is: a list is executed without a shell
              write `command: ~/a -v`
                ?> command: ~/a -v
              (a text is given to the shell if it needs one)
            # command: [“./a”, -v]
            `“` is not a quote here: it becomes a part of the word
              write `"./a"`
                => command: ["./a", -v]
            # command: ./a —rate 5
            `—` is not the hyphen that options start with
              write `./a --rate 5`
                ?> command: ./a --rate 5
            # command: ./a \
              --rate 5
            this `\` becomes a part of the next word
              remove the `\` at the end of the line
                => command: ./a
              (YAML joins the lines of a text by a space, without any mark)
            # command: |
              ./a \
              --rate 5
            # command: ./a
            working_directory: ~/x
            `working_directory` is a path as it is written: no shell replaces a part of `~/x`
              a path is absolute, or relative to the folder of the launch file
            # command: ./a
            working_directory: $HOME/x
            `working_directory` is a path as it is written: no shell replaces a part of `$HOME/x`
              a path is absolute, or relative to the folder of the launch file
            # replay: “x.mcap”
            `“` is not a quote here: it becomes a part of the word
              write `"x.mcap"`
                => replay: "x.mcap"
        "##]],
    );
}

#[test]
fn keys_of_other_tools_are_understood() {
    check_entries(
        &[
            "command: ./a\nWorkingDirectory: x",
            "ExecStart: ./a",
            "image: a:latest",
            "entrypoint: ./a\ncommand: [-v]",
            "script: a.py\ninterpreter: python3\nargs: [-v]",
            "command: [./a]\nargs:\n  - -v",
            "args: -v",
            "command: ./a\ndepends_on:\n  - b",
            "command: ./a\nports: ['80:80']",
            "command: ./a\nrestart_policy: {condition: on-failure, delay: 5}",
            "command: ./a\nrestart-policy: unless-stopped",
            "command: ./a\ntty: true\nstdin_open: true",
            "command: ./a\ninput: terminal\ntty: true",
            "command: ./a\noptional: yes",
            "command: ./a\nTimeoutStopSec: 5",
            "command: ./a\ntimeout: 5s",
            "command: ./a\nmachine: board",
            "command: ./a\nprofiles: [debug]",
            "command: ./a\ntransport: shm",
            "command: ./a\nenv:\n  - A=b c\n  - B=",
            "command: ./a\nenvironment:\n  - name: A\n    value: 1",
            "command: ./a\nenvironment: A=b",
        ],
        &expect![[r##"
            # command: ./a
            WorkingDirectory: x
            unknown key `WorkingDirectory` in component `a`
              did you mean `working_directory`?
                => working_directory: x
            # ExecStart: ./a
            unknown key `ExecStart` in component `a`
              did you mean `command`?
                => command: ./a
            # image: a:latest
            unknown key `image` in component `a`
              (programs run on this machine without containers: `command` names the program)
            # entrypoint: ./a
            command: [-v]
            unknown key `entrypoint` in component `a`
              write `command: [./a, -v]`
                => command: [./a, -v]
            # script: a.py
            interpreter: python3
            args: [-v]
            unknown key `script` in component `a`
              write `command: [python3, a.py, -v]`
                => command: [python3, a.py, -v]
            # command: [./a]
            args:
              - -v
            unknown key `args` in component `a`
              write `command: [./a, -v]`
                => command: [./a, -v]
            # args: -v
            unknown key `args` in component `a`
              (`command` has the program and all of its arguments)
            # command: ./a
            depends_on:
              - b
            unknown key `depends_on` in component `a`
              remove `depends_on`
                ?> 
              (components start in any order: programs wait for their peers)
            # command: ./a
            ports: ['80:80']
            unknown key `ports` in component `a`
              remove `ports`
                ?> 
              (programs meet by the connections of the topology: no ports are published)
            # command: ./a
            restart_policy: {condition: on-failure, delay: 5}
            unknown key `restart_policy` in component `a`
              write `restart: on_failure`, `restart_delay: 5s`
                ?> restart: on_failure | restart_delay: 5s
              (`restart`, `restart_delay` and `restart_limit` say when a program is started again)
            # command: ./a
            restart-policy: unless-stopped
            unknown key `restart-policy` in component `a`
              write `restart: always`
                ?> restart: always
            # command: ./a
            tty: true
            stdin_open: true
            unknown key `tty` in component `a`
              write `input: terminal`
                ?> input: terminal
            # command: ./a
            input: terminal
            tty: true
            unknown key `tty` in component `a`
              `input` is what this is called here: remove one of the two
                ?> 
              (`input` is there already)
            # command: ./a
            optional: yes
            unknown key `optional` in component `a`
              write `essential: false`
                => essential: false
            # command: ./a
            TimeoutStopSec: 5
            unknown key `TimeoutStopSec` in component `a`
              write `stop_within: 5s`
                ?> stop_within: 5s
            # command: ./a
            timeout: 5s
            unknown key `timeout` in component `a`
              write `ready_within: 5s`
                ?> ready_within: 5s
              write `stop_within: 5s`
                ?> stop_within: 5s
            # command: ./a
            machine: board
            unknown key `machine` in component `a`
              (a host lists its components, in `hosts` at the top of the file)
            # command: ./a
            profiles: [debug]
            unknown key `profiles` in component `a`
              (a component that is not always started has its entry in a profile, in `profiles` at the top of the file)
            # command: ./a
            transport: shm
            unknown key `transport` in component `a`
              `transports` at the top of the file has the transports of single gates: `transports: {a.images: shm}`
                ?> transports: {a.images: shm}
            # command: ./a
            env:
              - A=b c
              - B=
            unknown key `env` in component `a`
              write `environment: {A: b c, B: ""}`
                ?> environment: {A: b c, B: ""}
            # command: ./a
            environment:
              - name: A
                value: 1
            `environment` is a mapping, not a list
              write `environment: {A: 1}`
                => environment: {A: 1}
            # command: ./a
            environment: A=b
            `environment` is a mapping, not `A=b`
              write `environment: {A: b}`
                => environment: {A: b}
        "##]],
    );
}

#[test]
fn other_shapes_are_understood() {
    let texts = [
        "components:\n- name: a\n  command: ./a\n- name: b\n  command: ./b\n",
        "components:\n  - a:\n      command: ./a\n  - b: {command: ./b}\n",
        "components:\n  - {name: a, command: ./a}\n",
        "components: {a: ./a, b: [./b, -v]}\n",
        "a:\n  command: ./a\nb:\n  command: ./b\n",
        "components:\n  a:\n    command: ./a\nb:\n  command: ./b\n",
        "services:\n  a: {command: ./a}\nversion: '3'\n",
        "restart: always\ncomponents: {a: {command: ./a}}\n",
        "components: {a: {command: ./a}}\ntransports: shm\n",
        "components: {a: {command: ./a}}\ntransports: {images: shm}\n",
        "components: {x: {command: ./a}, b: {command: ./b}}\ntransports: {x.images: shm}\n",
        "components: {a: {command: ./a, input: terminal}, b: {command: ./b, input: terminal}}\n",
        "components: {a: {command: ./a}}\ndefaults: always\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nhosts:\n  one: {address: 'tcp://127.0.0.1:80', components: a}\n  two: {address: 127.0.0.2}\ngateway: 7447\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nprofiles:\n  debug: {command: ./a -v}\n",
        "components: {a: {command: ./a, opens: [b.images]}, b: {command: ./b, opens: b}}\n",
        "a: ./a -v\nb: ./b\n",
        "components: {a: {command: ./a}}\nenvironment:\n- A=b\n- C=\n",
        "components: {a: {command: ./a}}\nenvironment: {A: b,c=d, E: 1}\n",
        "components: {a: {command: ./a}}\ndefaults: {env: {A: 1}}\n",
        "components:\n  a: {command: ./a}\n  a: {restart: always, environment: {A: 1}}\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nprofiles:\n  debug:\n    components:\n      a: {command: ./x}\n  sim:\n    command: ./a_sim\n    restart: never\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\ntransports:\n  a.images: shm\n  board: {address: 127.0.0.1, components: [a, b]}\ngateway: {port: 80}\n",
        "components: {a: {command: ./a}, b: {command: ./b, machine: two}}\nhosts:\n  one: {address: 127.0.0.1, components: [a]}\n  two: {address: 127.0.0.2}\n",
        "components: {a: {command: ./a}, b: {command: ./b}}\nhosts:\n  one: {address: 192.0.2.1, components: [a, b], insecure: true}\n  two: {address: 192.0.2.2, components: [b]}\ngateway: {port: 80}\n",
    ];
    let all = texts.map(|text| format!("# {text}{}", told(text)));
    let all = all.join("");
    expect![[r##"
        # components:
        - name: a
          command: ./a
        - name: b
          command: ./b
        `components` is a mapping from names to entries, not a list
          write each name as a key, in place of its `-`
            => a: | command: ./a | b: | command: ./b
        # components:
          - a:
              command: ./a
          - b: {command: ./b}
        `components` is a mapping from names to entries, not a list
          write each name as a key, in place of its `-`
            => a: | b: {command: ./b}
        # components:
          - {name: a, command: ./a}
        `components` is a mapping from names to entries, not a list
          write each name as a key, in place of its `-`
            => a: {command: ./a}
        # components: {a: ./a, b: [./b, -v]}
        the entry of component `a` is a mapping, not `./a`
          write `a: {command: ./a}`
            => components: {a: {command: ./a}, b: [./b, -v]}
        the entry of component `b` is a mapping, not a list
          write `b: {command: [./b, -v]}`
            => components: {a: ./a, b: {command: [./b, -v]}}
        # a:
          command: ./a
        b:
          command: ./b
        component `a` stands at the top of the file
          write `components:` above it, and indent it
            => components: | a: | command: ./a | b: | command: ./b
        # components:
          a:
            command: ./a
        b:
          command: ./b
        component `b` stands at the top of the file
          indent it below `components`
            => b: | command: ./b
        # services:
          a: {command: ./a}
        version: '3'
        unknown key `services` in a launch file
          did you mean `components`?
            => components:
        unknown key `version` in a launch file
          remove `version`
            ?> 
          (a launch file has no version and no kind)
        # restart: always
        components: {a: {command: ./a}}
        unknown key `restart` in a launch file
          for all components, `restart` stands in `defaults`
            ?> defaults: {restart: always}
        # components: {a: {command: ./a}}
        transports: shm
        `transports` is a mapping, not `shm`
          write `transport: shm`
            => transport: shm
        # components: {a: {command: ./a}}
        transports: {images: shm}
        a gate is named `component.gate`, not `images`
          did you mean `a.images`?
            ?> transports: {a.images: shm}
          did you mean `b.images`?
            ?> transports: {b.images: shm}
        # components: {x: {command: ./a}, b: {command: ./b}}
        transports: {x.images: shm}
        unknown component `x`
          did you mean `a`?
            ?> components: {a: {command: ./a}, b: {command: ./b}} | transports: {a.images: shm}
          (the topology has the components `a`, `b`)
        # components: {a: {command: ./a, input: terminal}, b: {command: ./b, input: terminal}}
        the components `a` and `b` both have `input: terminal`
          remove `input` from `a`
            ?> components: {a: {command: ./a}, b: {command: ./b, input: terminal}}
          remove `input` from `b`
            ?> components: {a: {command: ./a, input: terminal}, b: {command: ./b}}
          (only one component can read from the terminal)
        # components: {a: {command: ./a}}
        defaults: always
        `defaults` is a mapping, not `always`
          write `defaults: {restart: always}`
            => defaults: {restart: always}
        # components: {a: {command: ./a}, b: {command: ./b}}
        hosts:
          one: {address: 'tcp://127.0.0.1:80', components: a}
          two: {address: 127.0.0.2}
        gateway: 7447
        `address` is an address alone, not `tcp://127.0.0.1:80`
          write `address: 127.0.0.1, port: 80`
            => one: {address: 127.0.0.1, components: a, port: 80}
        host `one` has no list of `components`
          write `components: [a]`
            => one: {address: 'tcp://127.0.0.1:80', components: [a]}
        host `two` has no list of `components`
          what is on no other host: `components: [a, b]`
            ?> two: {address: 127.0.0.2, components: [a, b]}
        `gateway` is a mapping, not `7447`
          with all hosts on this machine: `gateway: {port: 7447}`
            ?> gateway: {port: 7447}
          with certificates, which `scl gateway keys` makes: `gateway: {port: 7447, certificates: ./keys}`
            ?> gateway: {port: 7447, certificates: ./keys}
          without certificates, so that everybody on the network can listen and send: `gateway: {port: 7447, insecure: true}`
            ?> gateway: {port: 7447, insecure: true}
        # components: {a: {command: ./a}, b: {command: ./b}}
        profiles:
          debug: {command: ./a -v}
        profile `debug` has the key `command` in place of components
          write `a: {command: ./a -v}`
            ?> debug: {a: {command: ./a -v}}
          (a profile is a mapping from components to entries)
        # components: {a: {command: ./a, opens: [b.images]}, b: {command: ./b, opens: b}}
        unknown component `b.images`
          did you mean `b`?
            ?> components: {a: {command: ./a, opens: [b]}, b: {command: ./b, opens: b}}
          (components are listed here, not gates)
          (the topology has the components `a`, `b`)
        `opens` is a list of components like `[sensor, controller]`, or `any`, not `b`
          write `opens: [b]`
            => components: {a: {command: ./a, opens: [b.images]}, b: {command: ./b, opens: [b]}}
        # a: ./a -v
        b: ./b
        component `a` stands at the top of the file
          write `components:` above it, and indent it
            => components: | a: {command: ./a -v} | b: {command: ./b}
        # components: {a: {command: ./a}}
        environment:
        - A=b
        - C=
        `environment` is a mapping, not a list
          write `environment: {A: b, C: ""}`
            => environment: {A: b, C: ""}
        # components: {a: {command: ./a}}
        environment: {A: b,c=d, E: 1}
        `c=d` is not the name of an environment variable
          a text with a comma needs quotes: `"b,c=d"`
            ?> environment: {A: "b,c=d", E: 1}
        # components: {a: {command: ./a}}
        defaults: {env: {A: 1}}
        unknown key `env` in `defaults`
          `environment` belongs at the top of the file
        # components:
          a: {command: ./a}
          a: {restart: always, environment: {A: 1}}
        the key `a` is written twice in `components`
          merge the two into one, or remove one of them
          write what is here in the first `a`
            ?> a: {command: ./a, restart: always, environment: {A: 1}}
          (YAML tools disagree which one wins: PyYAML silently keeps the second)
        # components: {a: {command: ./a}, b: {command: ./b}}
        profiles:
          debug:
            components:
              a: {command: ./x}
          sim:
            command: ./a_sim
            restart: never
        profile `debug` has `components` in place of their entries
          remove `components:`
            => a: {command: ./x}
          (a profile is a mapping from components to entries)
        profile `sim` has the key `command` in place of components
          write `a:` above it, and indent it
            ?> a: | command: ./a_sim | restart: never
          (a profile is a mapping from components to entries)
        # components: {a: {command: ./a}, b: {command: ./b}}
        transports:
          a.images: shm
          board: {address: 127.0.0.1, components: [a, b]}
        gateway: {port: 80}
        `hosts:` is missing above `board`
          write `hosts:` above it
            => hosts:
        # components: {a: {command: ./a}, b: {command: ./b, machine: two}}
        hosts:
          one: {address: 127.0.0.1, components: [a]}
          two: {address: 127.0.0.2}
        unknown key `machine` in component `b`
          list `b` in `components` of host `two`, and remove this
            ?> components: {a: {command: ./a}, b: {command: ./b}} | two: {address: 127.0.0.2, components: [b]}
          (a host lists its components, in `hosts` at the top of the file)
        `gateway` is missing, but `hosts` needs it
          with all hosts on this machine: `gateway: {port: 7447}`
            ?> gateway: {port: 7447}
          with certificates, which `scl gateway keys` makes: `gateway: {port: 7447, certificates: ./keys}`
            ?> gateway: {port: 7447, certificates: ./keys}
          without certificates, so that everybody on the network can listen and send: `gateway: {port: 7447, insecure: true}`
            ?> gateway: {port: 7447, insecure: true}
        # components: {a: {command: ./a}, b: {command: ./b}}
        hosts:
          one: {address: 192.0.2.1, components: [a, b], insecure: true}
          two: {address: 192.0.2.2, components: [b]}
        gateway: {port: 80}
        unknown key `insecure` in host `one`
          `insecure` belongs into `gateway`
            ?> one: {address: 192.0.2.1, components: [a, b]} | gateway: {port: 80, insecure: true}
        component `b` is on two hosts, `one` and `two`
          remove it from `one`
            ?> one: {address: 192.0.2.1, components: [a], insecure: true}
    "##]].assert_eq(&all);
}
