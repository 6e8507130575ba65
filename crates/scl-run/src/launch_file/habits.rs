//! Keys of other tools that a launch file does not have: why not, and what to write instead.

use super::words::bare;

/// Words of other tools with one meaning.
pub(super) struct Habit {
    /// Without case and marks.
    pub(super) words: &'static [&'static str],
    /// What to know, and what to do instead.
    pub(super) instead: &'static str,
    /// Whether nothing is lost without the key.
    pub(super) can_go: bool,
    /// If the value is a mapping: its keys, without case and marks, that have a key here. The values of several for
    /// the same key are its parts, in this order.
    pub(super) parts: &'static [(&'static str, &'static str)],
}

const fn habit(words: &'static [&'static str], instead: &'static str) -> Habit {
    Habit { words, instead, can_go: true, parts: &[] }
}

/// A habit whose key says something that has to be written in another way.
const fn meant(words: &'static [&'static str], instead: &'static str) -> Habit {
    Habit { can_go: false, ..habit(words, instead) }
}

impl Habit {
    /// The habit that knows a word.
    pub(super) fn of(word: &str) -> Option<&'static Habit> {
        let word = bare(word);
        HABITS.iter().find(|habit| habit.words.contains(&word.as_str()))
    }
}

/// Words for keys that have a counterpart are in the tables of the [keys](super::keys).
const HABITS: &[Habit] = &[
    habit(
        &[
            "dependson",
            "after",
            "before",
            "requires",
            "wants",
            "bindsto",
            "partof",
            "links",
            "order",
            "dependencies",
            "waitfor",
        ],
        "components start in any order: programs wait for their peers",
    ),
    meant(
        &["image", "container", "containername", "dockerfile", "pullpolicy", "imagepullpolicy", "initcontainers"],
        "programs run on this machine without containers: `command` names the program",
    ),
    habit(
        &["ports", "expose", "network", "networks", "networkmode", "hostname", "dns", "extrahosts"],
        "programs meet by the connections of the topology: no ports are published",
    ),
    habit(
        &[
            "volumes",
            "mounts",
            "volumemounts",
            "devices",
            "tmpfs",
            "readonly",
            "privileged",
            "capadd",
            "secrets",
            "configs",
        ],
        "programs use the files and devices of this machine as they are",
    ),
    meant(
        &["user", "group", "uid", "gid", "runas", "supplementarygroups", "securitycontext"],
        "programs run as the user of `scl run`",
    ),
    meant(
        &["replicas", "instances", "numprocs", "scale", "concurrency"],
        "a component is one process: each further one is a component of its own in the topology",
    ),
    Habit {
        words: &["healthcheck", "livenessprobe", "readinessprobe", "startupprobe", "liveness", "health"],
        instead: "programs send signs of life by themselves: `alive_within` is the longest time between two of them",
        can_go: false,
        parts: &[("interval", "alive_within"), ("periodseconds", "alive_within"), ("startperiod", "ready_within")],
    },
    Habit {
        words: &["restartpolicy", "deploy"],
        instead: "`restart`, `restart_delay` and `restart_limit` say when a program is started again",
        can_go: false,
        parts: &[
            ("condition", "restart"),
            ("name", "restart"),
            ("delay", "restart_delay"),
            ("maxattempts", "restart_limit"),
            ("maximumretrycount", "restart_limit"),
            ("window", "restart_limit"),
        ],
    },
    meant(
        &["envfile", "environmentfile", "dotenv", "passenvironment"],
        "variables stand in `environment`; those of the shell that starts `scl run` are passed on",
    ),
    habit(
        &[
            "output",
            "log",
            "logs",
            "logging",
            "stdout",
            "stderr",
            "stdoutlogfile",
            "stderrlogfile",
            "redirectstderr",
            "logfile",
            "outfile",
            "errorfile",
            "standardoutput",
            "standarderror",
            "emulatetty",
            "sigtermtimeout",
            "loglevel",
        ],
        "the output of all programs is shown with the names of their components",
    ),
    meant(
        &["ns", "namespace", "remap", "remappings", "inputs", "outputs", "gates", "connections", "topics"],
        "gates and connections are declared in the topology",
    ),
    meant(
        &["pkg", "package", "plugin", "composablenodes", "executortype", "operator"],
        "`command` names the program, by its path or as it is found in the search path",
    ),
    meant(
        &["config", "extraarguments"],
        "a program gets values in `parameters`, as arguments in its `command`, or as variables in `environment`",
    ),
    meant(
        &[
            "nice",
            "cpushares",
            "cpuquota",
            "cpuweight",
            "memlimit",
            "memory",
            "memorymax",
            "resources",
            "limits",
            "shmsize",
            "oomscoreadj",
        ],
        "computing time and memory are not limited here; the `command` may start with a tool that does, such as `nice`",
    ),
    meant(
        &["stopsignal", "killsignal", "killmode", "sendsigkill", "stopasgroup", "killasgroup"],
        "every program and all its processes get SIGTERM, and SIGKILL after `stop_within`",
    ),
    meant(
        &["execstartpre", "prestart", "prelaunch", "prerun", "beforescript", "setup"],
        "what has to be done before the start belongs into `build`, or before the program in a `command` for the shell",
    ),
    meant(
        &["execstop", "execstoppost", "poststop", "execreload", "execstartpost", "teardown"],
        "nothing is run at the end: programs get SIGTERM",
    ),
    meant(
        &["enabled", "enable", "disabled", "disable", "autostart", "active", "if", "unless", "condition", "skip"],
        "what is in `components` is started: what is not always wanted belongs into `profiles` at the top of the file",
    ),
    meant(
        &["startdelay", "delay", "sleep", "timer", "wait", "launchdelay"],
        "nothing delays a start: programs wait for their peers, in any order",
    ),
    habit(&["shell", "usershell"], "a `command` that is a text with the syntax of the shell is given to `/bin/sh`"),
    meant(
        &["include", "includes", "extends", "import", "imports", "inherit", "inherits"],
        "other files are not included: `defaults` and `profiles` share settings inside of the file",
    ),
    habit(
        &["watch", "reload", "autoreload"],
        "files are not watched: `scl restart` builds and starts components again",
    ),
    habit(
        &["version", "apiversion", "kind", "metadata", "spec", "schemaversion"],
        "a launch file has no version and no kind",
    ),
    habit(
        &["name", "system", "id", "label", "labels", "tags", "annotations"],
        "components and hosts are named by their keys, and the system by `system` in the topology",
    ),
    habit(
        &["doc", "description", "comment", "note", "notes", "title", "help"],
        "what is meant for readers is a comment: `# ...`",
    ),
    habit(&["language", "lang", "runtime", "type"], "any program can run a component: `command` starts it"),
];

#[cfg(test)]
mod tests {
    use super::super::keys;
    use super::{HABITS, bare};

    #[test]
    fn each_word_has_one_meaning() {
        let mut words: Vec<&str> = HABITS.iter().flat_map(|habit| habit.words.iter().copied()).collect();
        assert!(words.iter().all(|word| bare(word) == *word), "{words:?}");
        words.sort_unstable();
        assert!(words.windows(2).all(|pair| pair[0] != pair[1]), "{words:?}");
        let keys = || [keys::TOP, keys::COMPONENT, keys::HOST, keys::GATEWAY].into_iter().flatten();
        for (habit, part) in HABITS.iter().flat_map(|habit| habit.parts.iter().map(move |part| (habit, part))) {
            assert!(keys().any(|key| key.name == part.1), "{:?}", habit.words);
        }
    }
}
