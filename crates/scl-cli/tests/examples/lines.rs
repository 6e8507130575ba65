//! The table in the readme of the aircraft: how long each program is. `UPDATE_EXPECT=1` writes it anew.

use crate::example;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;

const BEGIN: &str = "<!-- Written by `UPDATE_EXPECT=1 cargo test -p scl-cli --test examples lines`. -->\n";
const END: &str = "<!-- End of the table. -->\n";

/// Language, folder, and the main modules of its programs. A program consists of the modules that its main module uses.
const PROGRAMS: [(&str, &str, &[&str]); 4] = [
    ("C", "c", &["autopilot", "gps_sensor"]),
    ("C++", "cpp", &["blackbox"]),
    (
        "Python",
        "python",
        &["configuration", "power_management", "mission_arbiter", "uav_mission", "communication", "gps_nmea"],
    ),
    ("Rust", "src", &["simulator", "autopilot"]),
];

#[test]
fn the_readme_counts_the_lines_of_each_program() {
    let folder = example("arcade");
    let file = folder.join("README.md");
    let readme = std::fs::read_to_string(&file).unwrap();
    let (before, rest) = readme.split_once(BEGIN).unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    let expected = format!("{before}{BEGIN}{}{END}{after}", table(&folder));
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&file, expected).unwrap();
    } else {
        assert!(readme == expected, "the table of README.md is old; `UPDATE_EXPECT=1` writes\n{}", table(&folder));
    }
}

fn table(folder: &Path) -> String {
    let mut table = "\n| program | language | lines |\n|---|---|---|\n".to_owned();
    for (language, below, programs) in PROGRAMS {
        let modules = modules(&folder.join(below));
        let used: Vec<_> = programs.iter().map(|program| closure(program, programs, &modules)).collect();
        let users = |module: &str| used.iter().filter(|modules| modules.contains(module)).count();
        let lines = |is_counted: &dyn Fn(&str) -> bool| -> usize {
            modules.iter().filter(|(module, _)| is_counted(module)).map(|(_, text)| lines_of(text)).sum()
        };
        for (program, modules) in programs.iter().zip(&used) {
            let own = lines(&|module| modules.contains(module) && users(module) == 1);
            writeln!(table, "| `{program}` | {language} | {own} |").unwrap();
        }
        let shared = lines(&|module| users(module) > 1);
        if shared > 0 {
            writeln!(table, "| shared by several of these | {language} | {shared} |").unwrap();
        }
    }
    table + "\n"
}

/// A program's main module, and all that it uses; the main modules of other programs are not its own.
fn closure(program: &str, programs: &[&str], modules: &BTreeMap<String, String>) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open = vec![program.to_owned()];
    while let Some(module) = open.pop() {
        let is_other = module != program && programs.contains(&&*module);
        let Some(text) = modules.get(&module).filter(|_| !is_other) else { continue };
        if found.insert(module) {
            open.extend(used_by(text));
        }
    }
    found
}

/// Names of modules in `#include "x.h"`, `from x import`, `import x`, `use crate::x` and `arcade::x::y`.
fn used_by(text: &str) -> Vec<String> {
    let name =
        |rest: &str| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default().to_owned();
    let starts = ["#include \"", "from ", "import "];
    let imports =
        text.lines().flat_map(|line| starts.iter().filter_map(move |start| line.strip_prefix(start)).map(name));
    let paths = ["crate::", "arcade::"].into_iter().flat_map(|start| text.split(start).skip(1)).map(name);
    imports.chain(paths).collect()
}

/// Texts by module: `x.c` and `x.h` are one, and so are `x.rs`, `x/y.rs` and `bin/x.rs`.
fn modules(folder: &Path) -> BTreeMap<String, String> {
    let mut modules = BTreeMap::<String, String>::new();
    let mut open = vec![folder.to_owned()];
    while let Some(below) = open.pop() {
        for entry in std::fs::read_dir(&below).unwrap() {
            let path = entry.unwrap().path();
            let inside = path.strip_prefix(folder).unwrap();
            let is_source =
                path.extension().is_some_and(|it| ["c", "h", "cpp", "hpp", "py", "rs"].contains(&it.to_str().unwrap()));
            if path.is_dir() && !path.ends_with("tests") {
                open.push(path);
            } else if is_source && !path.ends_with("arcade_scl.py") {
                let names: Vec<_> =
                    inside.with_extension("").iter().map(|it| it.to_str().unwrap().to_owned()).collect();
                let module = if names[0] == "bin" { &names[1] } else { &names[0] };
                let text = std::fs::read_to_string(&path).unwrap();
                // Tests of Rust are in the same file.
                let text = text.split("#[cfg(test)]").next().unwrap();
                modules.entry(module.clone()).or_default().push_str(text);
            }
        }
    }
    modules
}

fn lines_of(text: &str) -> usize {
    text.lines().filter(|line| !line.trim().is_empty()).count()
}

#[test]
fn a_program_has_the_modules_that_it_uses() {
    let module = |name: &str, text: &str| (name.to_owned(), text.to_owned());
    let modules = BTreeMap::from([
        module("one", "from shared import f\nimport own\n"),
        module("own", "import sys\n"),
        module("shared", "x = 1\n"),
        module("two", "#include \"shared.h\"\nuse crate::world::World;\nuse crate::one::x;"),
        module("world", ""),
    ]);
    let names = |program| closure(program, &["one", "two"], &modules).into_iter().collect::<Vec<_>>().join(" ");
    assert_eq!(names("one"), "one own shared");
    assert_eq!(names("two"), "shared two world");
}
