//! Parses `cargo run` commands: what to build, and the arguments of the program.

use super::Target;
use std::path::Path;

/// Options of `cargo run` whose value is the next word.
const WITH_VALUE: [&str; 16] = [
    "-p",
    "--package",
    "--bin",
    "--example",
    "-F",
    "--features",
    "--target",
    "--target-dir",
    "--manifest-path",
    "--profile",
    "-j",
    "--jobs",
    "--color",
    "--config",
    "-Z",
    "--lockfile-path",
];

/// A command that runs a program with cargo.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CargoRun {
    /// `cargo build` with the options of the command, without those that choose the program.
    pub(crate) build: Vec<String>,
    /// The options of `cargo build` that choose the program, such as `--bin sensor`; may be empty.
    pub(crate) choice: Vec<String>,
    pub(crate) target: Target,
    /// The arguments of the program.
    pub(crate) arguments: Vec<String>,
}

impl CargoRun {
    /// Parses a command. Returns `None` if it is not `cargo run`, chooses several programs, or sets `--message-format`.
    pub(crate) fn parse(words: &[String]) -> Option<Self> {
        let (cargo, rest) = words.split_first()?;
        if Path::new(cargo).file_name()? != "cargo" {
            return None;
        }
        let toolchain = rest.first().filter(|word| word.starts_with('+'));
        let rest = &rest[toolchain.iter().len()..];
        let (_, rest) = rest.split_first().filter(|(command, _)| matches!(command.as_str(), "run" | "r"))?;
        let mut build: Vec<String> = [Some(cargo), toolchain].into_iter().flatten().cloned().collect();
        build.push("build".to_owned());
        let (mut choice, mut target) = (Vec::new(), Target::Only);
        let mut rest = rest.iter().peekable();
        while let Some(word) = rest.next_if(|word| word.starts_with('-')) {
            let (name, mut value) = match word.split_once('=') {
                Some((name, value)) if word.starts_with("--") => (name, Some(value.to_owned())),
                _ => (word.as_str(), None),
            };
            let is_joined = value.is_some();
            if !is_joined && WITH_VALUE.contains(&name) {
                value = Some(rest.next()?.clone());
            }
            match name {
                "--" => break,
                "-q" | "--quiet" => {}
                "--message-format" => return None,
                "--bin" | "--example" if target != Target::Only => return None,
                "--bin" | "--example" => {
                    let value = value?;
                    choice = vec![name.to_owned(), value.clone()];
                    target = if name == "--bin" { Target::Bin(value) } else { Target::Example(value) };
                }
                _ => {
                    build.push(word.clone());
                    build.extend(value.filter(|_| !is_joined));
                }
            }
        }
        Some(Self { build, choice, target, arguments: rest.cloned().collect() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Option<(String, String, Target, String)> {
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        let run = CargoRun::parse(&words)?;
        Some((run.build.join(" "), run.choice.join(" "), run.target, run.arguments.join(" ")))
    }

    #[test]
    fn options_are_told_from_the_arguments_of_the_program() {
        let bin = |name: &str| Target::Bin(name.to_owned());
        let cases = [
            ("cargo run", ("cargo build", "", Target::Only, "")),
            ("cargo run --quiet --bin sensor", ("cargo build", "--bin sensor", bin("sensor"), "")),
            (
                "cargo r -q --bin=sensor --release x -y",
                ("cargo build --release", "--bin sensor", bin("sensor"), "x -y"),
            ),
            (
                "/usr/bin/cargo +nightly run -p a --features=b --bin c -- --bin d",
                ("/usr/bin/cargo +nightly build -p a --features=b", "--bin c", bin("c"), "--bin d"),
            ),
            (
                "cargo run --example e --target-dir t 5",
                ("cargo build --target-dir t", "--example e", Target::Example("e".to_owned()), "5"),
            ),
        ];
        for (line, (build, choice, target, arguments)) in cases {
            assert_eq!(parse(line), Some((build.into(), choice.into(), target, arguments.into())), "{line}");
        }
    }

    #[test]
    fn other_commands_are_left_as_they_are() {
        for line in
            ["cargo build", "cargo", "./cargo-run", "env cargo run", "cargo run --bin a --bin b", "cargo run --bin"]
        {
            assert_eq!(parse(line), None, "{line}");
        }
    }
}
