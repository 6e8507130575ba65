//! What is proposed for the habits of other tools, and for what no program can have been meant to get.

mod paths;
mod shapes;

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
    let found = LaunchDocument::parse("launch.yaml", text).check(Some(&names)).1;
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
            "command:\n  - ./a\n  - --rate 100\n  - --port 5",
            "command: [\"./a b\", 'c d', e f]",
            "command: [./a, '|', tee, log]",
            "command: [./a, 2>, log file]",
            "command: [./a, $HOME/x]",
            "command: [./a, '$HOME']",
            "command: [./a, -r, $(RATE), '$HOME']\nenvironment: {RATE: 5}",
            "command: [./a, $(find maps)/hall.yaml]",
            "command: [./a, '${{ env.RATE }}']",
            "command: [./a, $(arg rate)]",
            "command: ./a ${{ env.RATE }} $(find maps)/b",
            "command: ./a ${{ inputs.rate }}",
            "command: ./a $(RATE) $(nproc)\nenvironment: {RATE: 5}",
            "command: ./a $(RATE) $HOME ${A:-b} '{{.Name}}' $(find . -name a)",
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
              write two items: `--rate` and `100`
                => command: [./a, --rate, 100]
              (an argument with spaces is written in quotes)
            # command:
              - ./a
              - --rate 100
              - --port 5
            `--rate 100` is a single word of this list, so it is a single argument
              write each as two items, like `--rate` and `100`
                => - --rate | - 100 | - --port | - 5
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
            # command: [./a, -r, $(RATE), '$HOME']
            environment: {RATE: 5}
            `$(RATE)` is passed on as it is: a list is executed without a shell
              write `5`
                ?> command: [./a, -r, 5, '$HOME']
              write `command: ./a -r $RATE '$HOME'`
                ?> command: ./a -r $RATE '$HOME'
              (a text is given to the shell if it needs one)
            # command: [./a, $(find maps)/hall.yaml]
            `$(find maps)/hall.yaml` is passed on as it is: a list is executed without a shell
              write `hall.yaml`, relative to the working directory
                ?> command: [./a, hall.yaml]
              write `command: ./a hall.yaml`
                ?> command: ./a hall.yaml
              (a text is given to the shell if it needs one)
            # command: [./a, '${{ env.RATE }}']
            `${{ env.RATE }}` is passed on as it is: a list is executed without a shell
              write `command: ./a $RATE`
                ?> command: ./a $RATE
              (a text is given to the shell if it needs one)
            # command: [./a, $(arg rate)]
            `$(arg rate)` is passed on as it is: a list is executed without a shell
              write the value itself
            # command: ./a ${{ env.RATE }} $(find maps)/b
            `${{ env.RATE }}` is not replaced: the shell does not know this notation
              write `$RATE`
                ?> command: ./a $RATE b
            # command: ./a ${{ inputs.rate }}
            `${{ inputs.rate }}` is not replaced: the shell does not know this notation
              write the value itself, or `$NAME` for a variable of `environment`
            # command: ./a $(RATE) $(nproc)
            environment: {RATE: 5}
            `$(RATE)` is not replaced: the shell does not know this notation
              write `$RATE`
                ?> command: ./a $RATE $(nproc)
            # command: ./a $(RATE) $HOME ${A:-b} '{{.Name}}' $(find . -name a)
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
            "command: ./a\nrestart_policy: {condition: any, max_attempts: 3, window: 120s, mode: x}",
            "command: ./a\ndeploy:\n  replicas: 1\n  restart_policy: {delay: 5s}",
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
            "command: ./a\nenvironment: A=\"b\",C='d,e'",
            "command: ./a\nenvironment: A=b,C=d",
            "command: ./a\nenvironment:\n  A: b\n  restart: on_failure\n  cpu: 1",
            "command: ./a\nenvironment: {restart: a, CPU: 1}",
            "command: ./a\nbuild: {context: ./x, args: {A: b}}",
            "command: ./a\nbuild: {context: ./x, args: {A: b c}}",
            "command: ./a\nreplay: a.mcap",
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
            restart_policy: {condition: any, max_attempts: 3, window: 120s, mode: x}
            unknown key `restart_policy` in component `a`
              write `restart: always`, `restart_limit: 3 in 120s`; nothing stands for `mode`
                ?> restart: always | restart_limit: 3 in 120s
              (`restart`, `restart_delay` and `restart_limit` say when a program is started again)
            # command: ./a
            deploy:
              replicas: 1
              restart_policy: {delay: 5s}
            unknown key `deploy` in component `a`
              write `restart_delay: 5s`; nothing stands for `replicas`
                ?> restart_delay: 5s
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
              move the entry from `components` into a profile, at the top of the file: `profiles: {debug: {a: {command: ...}}}`
                ?> profiles: | debug: | a: | command: ./a
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
            # command: ./a
            environment: A="b",C='d,e'
            `environment` is a mapping, not `A="b",C='d,e'`
              write `environment: {A: b, C: "d,e"}`
                => environment: {A: b, C: "d,e"}
            # command: ./a
            environment: A=b,C=d
            `environment` is a mapping, not `A=b,C=d`
              write `environment: {A: b, C: d}`
                ?> environment: {A: b, C: d}
              write `environment: {A: "b,C=d"}`
                ?> environment: {A: "b,C=d"}
            # command: ./a
            environment:
              A: b
              restart: on_failure
              cpu: 1
            `restart` is a variable here, not the key of the entry
              write it beside `environment`: `restart: on_failure`
                ?> restart: on_failure | cpu: 1
            # command: ./a
            environment: {restart: a, CPU: 1}
            # command: ./a
            build: {context: ./x, args: {A: b}}
            this `build` is not a command
              write `build: make -C ./x A=b`
                ?> build: make -C ./x A=b
              (`build` is a command that builds the program: a text, or a list of its words)
            # command: ./a
            build: {context: ./x, args: {A: b c}}
            this `build` is not a command
              (`build` is a command that builds the program: a text, or a list of its words)
            # command: ./a
            replay: a.mcap
            component `a` has both a `command` and a `replay`
              play the recording: remove `command`
                ?> 
              run the program: remove `replay`
                ?> 
        "##]],
    );
}
