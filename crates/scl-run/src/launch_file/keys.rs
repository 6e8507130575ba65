//! The keys of a launch file, defined once for the reader, its messages and the tables of `docs/launch.md`.

use super::super::policy::Restart;
use super::super::terminal::StandardInput;
use super::words::is_bare;
use scl_text::list::either;

/// A key of a mapping.
pub(super) struct Key {
    pub(super) name: &'static str,
    /// Names that other tools use for it, or that users may expect.
    pub(super) also: &'static [&'static str],
    /// What its value looks like.
    pub(super) form: Form,
    /// What applies without it, for the tables and `scl explain`.
    pub(super) default: &'static str,
    /// What it means, for the tables and `scl explain`.
    pub(super) meaning: &'static str,
    /// Whether it may also stand in `defaults`.
    pub(super) in_defaults: bool,
}

/// What the value of a key looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// One of these words.
    Word(&'static [&'static str]),
    Duration,
    DelayRange,
    RestartLimit,
    Flag,
    Processors,
    Priority,
    Port,
    /// A positive number.
    Count,
    /// Something else, as this description says.
    Other(&'static str),
}

const COMMAND: Form = Form::Other("a command");
const PATH: Form = Form::Other("a path");
const VALUES: Form = Form::Other("a mapping from names to values like `{gain: 1.5}`");
const VARIABLES: Form = Form::Other("a mapping from names to texts or numbers");

impl Form {
    /// Describes the form, for messages (`restart_delay` is ...) and for the tables.
    pub(super) fn description(self) -> String {
        match self {
            Form::Word(words) => either(words),
            Form::Duration => "a time like `500ms` or `3s`".to_owned(),
            Form::DelayRange => "a range like `100ms..5s`, or one time".to_owned(),
            Form::RestartLimit => "a number of restarts and a time, like `5 in 1m`".to_owned(),
            Form::Flag => "`true` or `false`".to_owned(),
            Form::Processors => "a list of processors like `[2, 3]`, counted from 0, or one of them".to_owned(),
            Form::Priority => "`fifo:1` to `fifo:99`".to_owned(),
            Form::Count => "a number like `4096`".to_owned(),
            Form::Port => "a number, 1 to 65535".to_owned(),
            Form::Other(description) => description.to_owned(),
        }
    }
}

/// A key with nothing but a command as its value.
const KEY: Key = Key { name: "", also: &[], form: COMMAND, default: "", meaning: "", in_defaults: false };

/// Whether a key at the top of the file is the user's own, which is ignored as in a topology file.
pub(super) fn is_own(key: &str) -> bool {
    key.starts_with("x-")
}

/// The keys at the top of the file.
pub(super) const TOP: &[Key] = &[
    Key {
        name: "build",
        also: &["make", "prebuild"],
        meaning: "Runs first, in the folder of the launch file.",
        default: "nothing",
        ..KEY
    },
    Key {
        name: "components",
        also: &["nodes", "services", "processes", "programs", "apps", "containers", "tasks", "units", "component"],
        form: Form::Other("a mapping from names to entries"),
        default: "required",
        meaning: "The components to start.",
        ..KEY
    },
    Key {
        name: "defaults",
        also: &["default"],
        form: Form::Other("a mapping with keys of entries"),
        default: "nothing",
        meaning: "Applies to every component whose entry lacks the key.",
        ..KEY
    },
    Key {
        name: "environment",
        also: &["env", "variables", "vars", "envs", "environ"],
        form: VARIABLES,
        default: "none",
        meaning: "Variables for all programs and builds, added to those of `scl run`.",
        ..KEY
    },
    Key {
        name: "gateway",
        also: &["gateways", "bridge"],
        form: Form::Other("a mapping with [its own keys](#hosts)"),
        default: "required with `hosts`",
        meaning: "How the gateways of the hosts reach each other. See [Hosts](#hosts).",
        ..KEY
    },
    Key {
        name: "hosts",
        also: &["machines", "host", "computers"],
        form: Form::Other("a mapping from names to [entries](#hosts)"),
        default: "one host",
        meaning: "Which components run on which host, chosen with `--host`. See [Hosts](#hosts).",
        ..KEY
    },
    Key {
        name: "profiles",
        also: &["profile", "variants", "configurations"],
        form: Form::Other("a mapping from names to mappings like `components`"),
        default: "none",
        meaning: "Other programs or settings for components, chosen with `--profile`.",
        ..KEY
    },
    Key {
        name: "topology",
        also: &["topology_file", "wiring", "system_file"],
        form: PATH,
        default: "`topology.yaml`, if there is one",
        meaning: "The topology file, relative to the folder of the launch file.",
        ..KEY
    },
    Key {
        name: "transport",
        also: &["rmw", "middleware", "protocol"],
        form: Form::Word(&scl::TransportKind::WORDS),
        default: "the environment's, or `ipc`",
        meaning: "The transport of all connections. See [Transports](#transports).",
        ..KEY
    },
    Key {
        name: "transports",
        form: Form::Other("a mapping from gates like `camera.frames` to transports"),
        default: "none",
        meaning: "The transport of single connections, by a gate at either end. See [Transports](#transports).",
        ..KEY
    },
];

/// The keys of a component, in `components` and in a profile, and those of `defaults`.
pub(super) const COMPONENT: &[Key] = &[
    Key {
        name: "alive_within",
        also: &["watchdog", "watchdog_sec", "watchdog_timeout", "wdt", "wdt_timeout", "heartbeat", "alive"],
        form: Form::Duration,
        default: "no limit",
        meaning: "Longest time between two signs of life. See [Readiness and watchdog](#readiness-and-watchdog).",
        in_defaults: true,
    },
    Key {
        name: "build",
        also: &["make", "compile", "build_command"],
        default: "nothing",
        meaning: "Builds the program. Runs before any component starts, in the component's folder.",
        ..KEY
    },
    Key {
        name: "command",
        also: &[
            "cmd",
            "run",
            "exec",
            "program",
            "exec_start",
            "executable",
            "entrypoint",
            "script",
            "path",
            "binary",
            "main",
        ],
        default: "this or `replay` is required",
        meaning: "The program and its arguments.",
        ..KEY
    },
    Key {
        name: "cpu",
        also: &["cpus", "affinity", "cores", "cpuset", "cpuset_cpus", "cpu_affinity", "taskset", "processors"],
        form: Form::Processors,
        default: "all",
        meaning: "The processors that the program may use.",
        in_defaults: true,
    },
    Key {
        name: "descriptors",
        also: &["nofile", "ulimit", "ulimits", "fds", "limit_nofile", "min_fds", "open_files"],
        form: Form::Count,
        default: "as `scl run`",
        meaning: "How many file descriptors the program may open. See [Processors and priority](#processors-and-priority).",
        in_defaults: true,
    },
    Key {
        name: "environment",
        also: &["env", "variables", "vars", "envs", "environ"],
        form: VARIABLES,
        default: "none",
        meaning: "Variables for this program. They win over those of all programs.",
        ..KEY
    },
    Key {
        name: "essential",
        also: &["required", "critical", "mandatory"],
        form: Form::Flag,
        default: "`true`",
        meaning: "Whether its failure stops the other components.",
        in_defaults: true,
    },
    Key {
        name: "input",
        also: &["stdin", "tty", "terminal", "interactive", "stdin_open", "standard_input", "console"],
        form: Form::Word(&StandardInput::WORDS),
        default: "`empty`",
        meaning: "The program's standard input. One component may have the terminal. See [The terminal](#the-terminal).",
        ..KEY
    },
    Key {
        name: "opens",
        also: &["plays", "also"],
        form: Form::Other("a list of components like `[sensor, controller]`, or `any`"),
        default: "its own component",
        meaning: "Components that the program may open besides its own. See [The right program](#the-right-program).",
        ..KEY
    },
    Key {
        name: "parameters",
        also: &["param", "params", "parameter", "rosparam", "ros_parameters", "ros_params"],
        form: VALUES,
        default: "the defaults of the topology",
        meaning: "Values of the component's parameters. See [Parameters](#parameters).",
        ..KEY
    },
    Key {
        name: "priority",
        also: &["sched", "scheduler", "rtprio", "cpu_scheduling_priority", "realtime", "rt_priority"],
        form: Form::Priority,
        default: "an ordinary program",
        meaning: "Real-time priority of the program. See [Processors and priority](#processors-and-priority).",
        in_defaults: true,
    },
    Key {
        name: "ready_within",
        also: &["startup_timeout", "start_timeout", "timeout_start_sec", "ready_timeout", "listen_timeout", "timeout"],
        form: Form::Duration,
        default: "no limit",
        meaning: "How long it may take to be ready. See [Readiness and watchdog](#readiness-and-watchdog).",
        in_defaults: true,
    },
    Key {
        name: "replay",
        also: &["play", "recording", "bag", "rosbag", "playback", "mcap"],
        form: PATH,
        default: "none",
        meaning: "In place of a command: plays the component from this recording, from the working directory.",
        ..KEY
    },
    Key {
        name: "restart",
        also: &["respawn", "autorestart", "restart_policy", "on_exit"],
        form: Form::Word(&Restart::WORDS),
        default: "`never`",
        meaning: "When the program is started again after it has ended.",
        in_defaults: true,
    },
    Key {
        name: "restart_delay",
        also: &["respawn_delay", "restart_sec", "backoff", "exp_backoff_restart_delay", "restart_backoff"],
        form: Form::DelayRange,
        default: "`100ms..5s`",
        meaning: "Time before a restart. It doubles with each restart, and is reset after a minute without one.",
        in_defaults: true,
    },
    Key {
        name: "restart_limit",
        also: &["max_restarts", "retries", "respawn_max_retries", "start_limit_burst", "startretries", "max_retries"],
        form: Form::RestartLimit,
        default: "`5 in 1m`",
        meaning: "A component that would need more restarts than that has failed.",
        in_defaults: true,
    },
    Key {
        name: "stop_within",
        also: &[
            "grace",
            "stop_timeout",
            "timeout",
            "stop_grace_period",
            "timeout_stop_sec",
            "stopwaitsecs",
            "kill_timeout",
            "termination_grace_period_seconds",
            "sigkill_timeout",
        ],
        form: Form::Duration,
        default: "`--grace`, or `5s`",
        meaning: "How long it may take to stop before it is killed.",
        in_defaults: true,
    },
    Key {
        name: "working_directory",
        also: &["folder", "directory", "cwd", "working_dir", "workdir", "dir", "chdir"],
        form: PATH,
        default: "the folder of the launch file",
        meaning: "Where the program and its build run, relative to the folder of the launch file.",
        in_defaults: true,
    },
];

/// The keys of a host, in `hosts`.
pub(super) const HOST: &[Key] = &[
    Key {
        name: "address",
        also: &["ip", "hostname", "addr", "host", "ansible_host", "ansible_ssh_host"],
        form: Form::Other("an IP address or a DNS name"),
        default: "required",
        meaning: "Where the gateway of the host listens, and where the other hosts find it.",
        ..KEY
    },
    Key {
        name: "components",
        also: &["nodes", "services", "processes"],
        form: Form::Other("a list of components like `[sensor, controller]`"),
        default: "required",
        meaning: "What runs there. Every component of the topology is on one host.",
        ..KEY
    },
    Key {
        name: "port",
        form: Form::Port,
        default: "that of `gateway`",
        meaning: "The TCP port of the host's gateway.",
        ..KEY
    },
];

/// The keys of `gateway`.
pub(super) const GATEWAY: &[Key] = &[
    Key {
        name: "certificates",
        also: &["keys", "certs", "tls"],
        form: PATH,
        default: "required, unless all hosts are on loopback",
        meaning: "The folder with the certificates, relative to the folder of the launch file. `scl gateway keys` makes it.",
        ..KEY
    },
    Key {
        name: "insecure",
        also: &["allow_insecure", "unencrypted", "plaintext"],
        form: Form::Flag,
        default: "`false`",
        meaning: "Accepts other addresses than loopback without certificates. Everybody on the network can then listen and send.",
        ..KEY
    },
    Key {
        name: "port",
        form: Form::Port,
        default: "required, unless each host has its own",
        meaning: "The TCP port of the gateways.",
        ..KEY
    },
];

/// Whether a word, without case and marks, is another tool's name for a key.
pub(super) fn is_called(key: &Key, bare_word: &str) -> bool {
    let first = bare_word.as_bytes().first();
    key.also.iter().any(|name| name.as_bytes().first() == first && is_bare(name, bare_word))
}

/// Returns the form of the value of a key. The name must be that of a known key.
pub(super) fn form_of(name: &str) -> Form {
    TOP.iter().chain(COMPONENT).chain(HOST).chain(GATEWAY).find(|key| key.name == name).map_or(KEY.form, |key| key.form)
}
