//! The keys of a launch file, told once: for the reader, its messages and the tables of `docs/launch.md`.

/// A key of a mapping.
pub(super) struct Key {
    pub(super) name: &'static str,
    /// What its value looks like, for the tables.
    #[cfg_attr(not(test), expect(dead_code, reason = "only the page shows it"))]
    pub(super) value: &'static str,
    /// What it means, for the tables.
    #[cfg_attr(not(test), expect(dead_code, reason = "only the page shows it"))]
    pub(super) meaning: &'static str,
}

/// The values of `transport`.
pub(super) const TRANSPORTS: [&str; 2] = ["ipc", "tcp"];

/// The keys at the top of the file.
pub(super) const TOP: &[Key] = &[
    Key { name: "build", value: "command", meaning: "Runs first, in the folder of the launch file." },
    Key { name: "components", value: "mapping from names to entries", meaning: "The components to start. Required." },
    Key {
        name: "environment",
        value: "mapping from names to texts or numbers",
        meaning: "Variables for all programs and builds, added to those of `scl run`.",
    },
    Key {
        name: "profiles",
        value: "mapping from names to mappings like `components`",
        meaning: "Other programs for components, chosen with `--profile`.",
    },
    Key {
        name: "topology",
        value: "path",
        meaning: "The topology file, from the folder of the launch file. Default: `topology.yaml`, if there is one.",
    },
    Key {
        name: "transport",
        value: "`ipc` or `tcp`",
        meaning: "Sets `SCL_TRANSPORT` for all programs. Default: the environment's, or `ipc`.",
    },
];

/// The keys of a component, in `components` and in a profile.
pub(super) const COMPONENT: &[Key] = &[
    Key {
        name: "build",
        value: "command",
        meaning: "Makes the program. Runs before any component starts, in the component's folder.",
    },
    Key { name: "command", value: "command", meaning: "The program and its arguments. Required in `components`." },
    Key {
        name: "environment",
        value: "mapping from names to texts or numbers",
        meaning: "Variables for this program. They win over those of all programs.",
    },
    Key {
        name: "folder",
        value: "path",
        meaning: "Working folder of the program and its build, from the folder of the launch file. Default: that folder.",
    },
];
