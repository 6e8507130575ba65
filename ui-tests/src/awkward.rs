//! Random schemas with names that some language cannot write, or cannot tell apart. Other tests compare what the checks
//! say of them with what compilers do.

use std::collections::HashSet;
use std::fmt::Write;

/// A topology and its schemas.
#[derive(Debug)]
pub struct System {
    /// The text of the topology file.
    pub topology: String,
    /// The names and texts of the schemas.
    pub schemas: Vec<(String, String)>,
}

/// Words that meet in some language: keywords, names of the standard libraries, of generated code and of SCL, and words
/// that differ only in case or underscores.
const WORDS: [&str; 86] = [
    "gps",
    "GPS",
    "Gps",
    "gps_",
    "status",
    "Status",
    "STATUS",
    "Status_",
    "kind",
    "Kind",
    "KIND",
    "mode",
    "Mode",
    "MODE",
    "MODE_AUTO",
    "AUTO",
    "Auto",
    "type",
    "Type",
    "self",
    "Self",
    "crate",
    "super",
    "extern",
    "gen",
    "async",
    "fn",
    "try",
    "_",
    "__",
    "_1",
    "GPS_1",
    "GPS1",
    "log",
    "std",
    "core",
    "alloc",
    "scl",
    "prost",
    "image",
    "NULL",
    "class",
    "concept",
    "export",
    "requires",
    "namespace",
    "linux",
    "errno",
    "None",
    "True",
    "Warning",
    "list",
    "int",
    "bool",
    "Bool",
    "i32",
    "f64",
    "str",
    "String",
    "string",
    "Option",
    "Result",
    "Vec",
    "Box",
    "Some",
    "Ok",
    "Default",
    "Clone",
    "Debug",
    "Message",
    "Enumeration",
    "set_kind",
    "push_kind",
    "get_kind",
    "has_kind",
    "clear",
    "close",
    "name",
    "test",
    "x",
    "DESCRIPTOR",
    "keys",
    "Name",
    "A",
    "A_b",
    "aB",
];

/// SplitMix64: the same seed gives the same schemas everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % limit as u64) as usize
    }

    /// A word that is not in use; protobuf compares the case, and a part of the names is plain.
    fn word(&mut self, used: &mut HashSet<String>) -> String {
        loop {
            let word = match self.below(3) {
                0 => format!("{}{}", ["Pose", "axis", "Fix", "value"][self.below(4)], self.below(9)),
                _ => WORDS[self.below(WORDS.len())].to_owned(),
            };
            if used.insert(word.clone()) {
                return word;
            }
        }
    }
}

/// A system that depends on the seed only. Not every one is valid: protobuf has rules for names as well.
pub fn system(seed: u64) -> System {
    let mut random = Random(seed);
    let mut schemas = Vec::new();
    let mut messages = Vec::new();
    for index in 0..=random.below(2) {
        let is_proto3 = random.below(2) == 0;
        let parts = random.below(3);
        let package: Vec<String> = (0..parts).map(|_| random.word(&mut HashSet::new())).collect();
        let mut file = File { random: &mut random, is_proto3, text: String::new() };
        let declared = file.declarations();
        let mut text = format!("syntax = \"proto{}\";\n", if is_proto3 { 3 } else { 2 });
        if !package.is_empty() {
            writeln!(text, "package {};", package.join(".")).expect("a text takes all");
        }
        let full = |name: &String| package.iter().chain([name]).cloned().collect::<Vec<_>>().join(".");
        messages.extend(declared.iter().map(full));
        schemas.push((format!("schema_{index}.proto"), text + &file.text));
    }
    let names: Vec<&str> = schemas.iter().map(|(name, _)| name.as_str()).collect();
    let mut topology =
        format!("system: random_{seed}\nschemas: [{}]\nconnections: []\ncomponents:\n", names.join(", "));
    let mut components = HashSet::new();
    for _ in 0..=random.below(2) {
        writeln!(topology, "  - name: {}\n    gates:", random.word(&mut components)).expect("a text takes all");
        let mut gates = HashSet::new();
        for _ in 0..=random.below(2) {
            let message = &messages[random.below(messages.len())];
            let gate = random.word(&mut gates);
            writeln!(topology, "      - {gate}: {{pub: {message}, unconnected: ok}}").expect("a text takes all");
        }
    }
    System { topology, schemas }
}

struct File<'r> {
    random: &'r mut Random,
    is_proto3: bool,
    text: String,
}

impl File<'_> {
    /// Declares some enums and messages, and returns the names of the messages.
    fn declarations(&mut self) -> Vec<String> {
        let mut enums = Vec::new();
        let mut used = HashSet::new();
        if self.random.below(2) == 0 {
            enums.push(self.enumeration(&mut used));
        }
        let count = 1 + self.random.below(3);
        (0..count).map(|_| self.message(&mut used, &enums, 0)).collect()
    }

    /// The values of an enum are declared beside it.
    fn enumeration(&mut self, used: &mut HashSet<String>) -> String {
        let name = self.random.word(used);
        let mut values = String::new();
        for number in 0..=self.random.below(3) {
            let value = self.random.word(used);
            write!(values, "{value} = {number}; ").expect("a text takes all");
        }
        writeln!(self.text, "enum {name} {{ {values}}}").expect("a text takes all");
        name
    }

    fn message(&mut self, used: &mut HashSet<String>, enums: &[String], depth: usize) -> String {
        let name = self.random.word(used);
        writeln!(self.text, "message {name} {{").expect("a text takes all");
        let mut members = HashSet::from([name.clone()]);
        let mut enums = enums.to_vec();
        let mut nested = Vec::new();
        if depth < 2 && self.random.below(4) == 0 {
            nested.push(self.message(&mut members, &enums, depth + 1));
        }
        if self.random.below(4) == 0 {
            enums.push(self.enumeration(&mut members));
        }
        let types: Vec<String> =
            ["int32", "bool", "double", "string"].map(str::to_owned).into_iter().chain(nested).collect();
        let mut number = 0;
        for _ in 0..self.random.below(4) {
            number += 1;
            let kind = match enums.get(self.random.below(2 * enums.len() + 1)) {
                Some(declared) => declared.clone(),
                None => types[self.random.below(types.len())].clone(),
            };
            let kind = match self.random.below(4) {
                0 => format!("repeated {kind}"),
                1 => format!("map<int32, {kind}>"),
                2 if self.is_proto3 => kind,
                _ => format!("optional {kind}"),
            };
            let field = self.random.word(&mut members);
            writeln!(self.text, "{kind} {field} = {number};").expect("a text takes all");
        }
        for _ in 0..self.random.below(5) / 3 {
            let oneof = self.random.word(&mut members);
            let mut fields = String::new();
            for _ in 0..=self.random.below(2) {
                number += 1;
                let (kind, field) = (types[self.random.below(types.len())].clone(), self.random.word(&mut members));
                write!(fields, "{kind} {field} = {number}; ").expect("a text takes all");
            }
            writeln!(self.text, "oneof {oneof} {{ {fields}}}").expect("a text takes all");
        }
        writeln!(self.text, "}}").expect("a text takes all");
        name
    }
}
