//! The templates, and how their files become those of a project.

use crate::dependency::Dependency;
use crate::name::code_name;

/// A set of files to begin with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Template {
    /// Two programs and one connection, without async.
    Minimal,
    /// A sensor, a controller and a display, with commands, a launch file and tests.
    Control,
    /// Four wheels of one kind, a chassis and a logger, with deadlines, a launch file and tests.
    Drive,
}

/// The name that stands in the templates.
const NAME: &str = "rover";

/// The line of `Cargo.toml` that says where SCL is.
const DEPENDENCY: &str = "scl = { package = \"scl-gates\", version = \"0.1.0\" }";

/// The command of the CI file that installs `scl`, up to the options that do not depend on where SCL is.
const INSTALL: &str = "cargo install scl-cli --version 0.1.0";

/// The step of the CI file after which a note is inserted if the project names SCL by a path.
const CHECKOUT: &str = "      - uses: actions/checkout@v4\n";

const NOTE_ON_PATH: &str = "      # Cargo.toml and the last steps name SCL by its path on the machine on which this project was made.\n      \
                            # Here, check SCL out at that path, or name its git repository in their place.\n";

const OWN_WORKSPACE: &str = "\n# This package is not a member of the workspace in the folders above.\n[workspace]\n";

/// The path and the text of a file of a template.
macro_rules! files {
    ($template:literal: $($path:literal = $source:literal),+ $(,)?) => {
        &[$(($path, include_str!(concat!("../templates/", $template, "/", $source)))),+]
    };
}

const MINIMAL: &[(&str, &str)] = files!("minimal":
    "Cargo.toml" = "Cargo.toml.template",
    "topology.yaml" = "topology.yaml",
    "rover.proto" = "rover.proto",
    "src/bin/sensor.rs" = "src/bin/sensor.rs",
    "src/bin/display.rs" = "src/bin/display.rs",
    ".github/workflows/ci.yml" = ".github/workflows/ci.yml",
    "README.md" = "README.md",
    ".gitignore" = ".gitignore",
);

const CONTROL: &[(&str, &str)] = files!("control":
    "Cargo.toml" = "Cargo.toml.template",
    "topology.yaml" = "topology.yaml",
    "rover.proto" = "rover.proto",
    "src/lib.rs" = "src/lib.rs",
    "src/controller.rs" = "src/controller.rs",
    "src/bin/sensor.rs" = "src/bin/sensor.rs",
    "src/bin/controller.rs" = "src/bin/controller.rs",
    "src/bin/display.rs" = "src/bin/display.rs",
    "tests/controller.rs" = "tests/controller.rs",
    "launch.yaml" = "launch.yaml",
    ".github/workflows/ci.yml" = ".github/workflows/ci.yml",
    "README.md" = "README.md",
    ".gitignore" = ".gitignore",
);

const DRIVE: &[(&str, &str)] = files!("drive":
    "Cargo.toml" = "Cargo.toml.template",
    "topology.yaml" = "topology.yaml",
    "rover.proto" = "rover.proto",
    "src/lib.rs" = "src/lib.rs",
    "src/wheel.rs" = "src/wheel.rs",
    "src/chassis.rs" = "src/chassis.rs",
    "src/bin/wheel.rs" = "src/bin/wheel.rs",
    "src/bin/chassis.rs" = "src/bin/chassis.rs",
    "src/bin/logger.rs" = "src/bin/logger.rs",
    "tests/wheel.rs" = "tests/wheel.rs",
    "tests/chassis.rs" = "tests/chassis.rs",
    "launch.yaml" = "launch.yaml",
    ".github/workflows/ci.yml" = ".github/workflows/ci.yml",
    "README.md" = "README.md",
    ".gitignore" = ".gitignore",
);

impl Template {
    /// All templates.
    pub const ALL: [Template; 3] = [Template::Minimal, Template::Control, Template::Drive];

    /// The names of its programs, which are those of its components, or of their kinds.
    pub(crate) fn programs(self) -> Vec<&'static str> {
        let program = |(path, _): &(&'static str, _)| path.strip_prefix("src/bin/")?.strip_suffix(".rs");
        self.sources().iter().filter_map(program).collect()
    }

    /// The paths and texts of the template's own files.
    fn sources(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Template::Minimal => MINIMAL,
            Template::Control => CONTROL,
            Template::Drive => DRIVE,
        }
    }

    /// The paths and texts of a project.
    pub(crate) fn files(self, name: &str, scl: &Dependency, in_workspace: bool) -> Vec<(String, String)> {
        let file = |&(path, text): &(&str, &str)| {
            let mut text = text.replace(DEPENDENCY, &scl.manifest_line()).replace(INSTALL, &scl.install_command());
            if matches!(scl, Dependency::Folder { .. }) {
                text = text.replace(CHECKOUT, &format!("{CHECKOUT}{NOTE_ON_PATH}"));
            }
            let mut text = with_name(&text, name);
            if path == "Cargo.toml" && in_workspace {
                text.push_str(OWN_WORKSPACE);
            }
            (path.replace(NAME, &code_name(name)), text)
        };
        self.sources().iter().map(file).collect()
    }
}

/// Replaces the name of the template. Code cannot spell every name, so the places that are not code are replaced first.
fn with_name(text: &str, name: &str) -> String {
    let with_whole_name = ["name = \"rover\"", "system: rover\n", "# rover\n"]
        .iter()
        .fold(text.to_owned(), |text, words| text.replace(words, &words.replace(NAME, &format!("\0{name}\0"))));
    // The parts between zero bytes are names, which stay as they are even if they contain `rover`.
    let parts = with_whole_name.split('\0').enumerate();
    parts
        .map(|(index, part)| if index % 2 == 0 { part.replace(NAME, &code_name(name)) } else { part.to_owned() })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The templates are valid as they are, for the name and the dependency that stand in them.
    #[test]
    fn a_template_is_a_project() {
        for template in Template::ALL {
            let files = template.files(NAME, &Dependency::Registry, false);
            let files: Vec<(&str, &str)> = files.iter().map(|(path, text)| (&**path, &**text)).collect();
            assert_eq!(files, template.sources());
            for (path, text) in files {
                assert_eq!(path == "Cargo.toml", text.contains(DEPENDENCY), "{path}");
                assert_eq!(path.ends_with("ci.yml"), text.contains(INSTALL) && text.contains(CHECKOUT), "{path}");
            }
        }
    }
}
