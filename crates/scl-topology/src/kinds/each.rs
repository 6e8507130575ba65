//! Ends of connections that stand for all components of a kind: `each motor.state`. SCL1305 to SCL1308.

use super::{Known, MOST, too_many};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::model::ConnectionModel;
use crate::source::{Sources, Span, Spanned};
use crate::suggest::Searches;
use scl_text::gate_name::split;
use scl_text::list::listed;

/// SCL1305.
pub(super) const NO_KIND: Rule = Rule {
    code: "SCL1305",
    severity: Severity::Error,
    title: "`each` of something that is no kind",
    explanation: "`each motor.state` connects that gate of every component of the kind `motor`. The word after `each` \
                  must be a kind; a single component stands without `each`.",
    example: " kinds:
   - name: motor
     gates:
       - state: {pub: MotorState}
 components:
   - {name: left_motor, kind: motor}
   - name: controller
     gates:
       - motors: {sub: MotorState}
 connections:
-  - [each motor.state, each controller.motors]
+  - [each motor.state, controller.motors]
",
};

/// SCL1306.
pub(super) const WITHOUT_EACH: Rule = Rule {
    code: "SCL1306",
    severity: Severity::Error,
    title: "kind in a connection without `each`",
    explanation: "A connection joins gates of components. A kind is no component: write `each motor.state` for that \
                  gate of all components of the kind, or name one of them.",
    example: " kinds:
   - name: motor
     gates:
       - state: {pub: MotorState}
 components:
   - {name: left_motor, kind: motor}
   - name: controller
     gates:
       - motors: {sub: MotorState}
 connections:
-  - [motor.state, controller.motors]
+  - [each motor.state, controller.motors]
",
};

/// SCL1307.
pub(super) const TWICE: Rule = Rule {
    code: "SCL1307",
    severity: Severity::Error,
    title: "`each` at both ends",
    explanation: "One connection for each component can have `each` at one end only: with two, it could mean pairs of \
                  components or all with all. Write these connections one by one.",
    example: " kinds:
   - name: wheel
     gates:
       - speed: {pub: Speed}
   - name: brake
     gates:
       - speed: {sub: Speed}
 components:
   - {name: left_wheel, kind: wheel}
   - {name: left_brake, kind: brake}
 connections:
-  - [each wheel.speed, each brake.speed]
+  - [left_wheel.speed, left_brake.speed]
",
};

/// SCL1308.
pub(super) const NO_GATE: Rule = Rule {
    code: "SCL1308",
    severity: Severity::Error,
    title: "kind has no such gate",
    explanation: "A connection names a gate that the kind does not declare. The name is probably misspelt, or the gate \
                  is missing in the kind.",
    example: " kinds:
   - name: motor
     gates:
       - state: {pub: MotorState}
 components:
   - {name: left_motor, kind: motor}
   - name: controller
     gates:
       - motors: {sub: MotorState}
 connections:
-  - [each motor.status, controller.motors]
+  - [each motor.state, controller.motors]
",
};

/// The word before the name of a kind.
pub(crate) const EACH: &str = "each";

/// Maximum number of gates that a help names.
const MOST_GATES: usize = 3;

/// What connections become.
#[derive(Default)]
pub(super) struct Ends {
    pub(super) connections: Vec<ConnectionModel>,
    /// The gates of connections that are left out, because a problem is reported for them.
    pub(super) broken: Vec<Spanned<String>>,
    /// There are too many, and a problem says so.
    pub(super) is_cut_off: bool,
}

/// What follows `each` in an end of a connection.
pub(crate) fn each_of(end: &str) -> Option<&str> {
    let rest = end.strip_prefix(EACH)?;
    rest.starts_with(char::is_whitespace).then(|| rest.trim_start())
}

/// The end of a connection that stands for a gate of all components of a kind.
pub(crate) fn each_end(kind: &str, gate: &str) -> String {
    format!("{EACH} {kind}.{gate}")
}

/// `every motor.state`, `each.motor.state`, `each: motor.state`: the word, and what stands after the mark.
fn without_mark(end: &str) -> (&str, &str) {
    let is_letter = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-');
    let word = &end[..end.find(|letter| !is_letter(letter)).unwrap_or(end.len())];
    let path = end[word.len()..].trim_start_matches(|letter| !is_letter(letter));
    let is_word = word.eq_ignore_ascii_case(EACH) || end[word.len()..].starts_with(char::is_whitespace);
    if is_word && !path.is_empty() { (word, path) } else { ("", end) }
}

/// Replaces each connection with `each` by one of each component of the kind.
pub(super) fn replace(
    known: &Known<'_>,
    connections: Vec<ConnectionModel>,
    sources: &Sources,
    problems: &mut Diagnostics,
) -> Ends {
    let mut reader = Reader { known, sources, searches: Searches::default(), ends_left: MOST, problems };
    let mut ends = Ends::default();
    for connection in connections {
        let span = connection.span;
        if reader.read(connection, &mut ends).is_none() {
            reader.problems.push(too_many(span, "connections"));
            ends.is_cut_off = true;
            break;
        }
    }
    ends
}

/// What an end of a connection is.
enum End {
    /// A gate, as far as this stage knows.
    Gate,
    /// `each`, with the number of the kind, and the gate.
    Each(usize, String),
    /// It is reported.
    Broken,
}

struct Reader<'a, 'm> {
    known: &'a Known<'m>,
    sources: &'a Sources,
    searches: Searches,
    /// How many ends `each` may still stand for.
    ends_left: usize,
    problems: &'a mut Diagnostics,
}

impl Reader<'_, '_> {
    /// Reads a connection; `None` if it stands for too many.
    fn read(&mut self, connection: ConnectionModel, ends: &mut Ends) -> Option<()> {
        let found = connection.ends.each_ref().map(|end| self.end(end));
        for end in &found {
            let number = if let End::Each(kind, _) = end { self.known.components_of[*kind].len() } else { 0 };
            self.ends_left = self.ends_left.checked_sub(number)?;
        }
        let (at, kind, gate) = match &found {
            [End::Gate, End::Gate] => {
                ends.connections.push(connection);
                return Some(());
            }
            [End::Each(kind, gate), End::Gate] => (0, *kind, gate),
            [End::Gate, End::Each(kind, gate)] => (1, *kind, gate),
            _ => {
                if let [End::Each(..), End::Each(..)] = found {
                    self.report_twice(&connection);
                }
                self.leave_out(&connection, &found, ends);
                return Some(());
            }
        };
        let name = &self.known.model.kinds[kind].name.value;
        for component in self.known.components_in(kind, connection.group) {
            let mut one = connection.clone();
            one.ends[at].value = format!("{component}.{gate}");
            one.each[at] = Some(name.clone());
            ends.connections.push(one);
        }
        Some(())
    }

    /// Notes the gates at both ends, so that nobody calls them unconnected.
    fn leave_out(&self, connection: &ConnectionModel, found: &[End; 2], ends: &mut Ends) {
        for (end, found) in connection.ends.iter().zip(found) {
            let named = |value: String| Spanned { value, span: end.span };
            match found {
                End::Each(kind, gate) => {
                    let components = self.known.components_in(*kind, connection.group);
                    ends.broken.extend(components.map(|component| named(format!("{component}.{gate}"))));
                }
                End::Gate => ends.broken.push(end.clone()),
                End::Broken => ends.broken.push(named(each_of(&end.value).unwrap_or(&end.value).to_owned())),
            }
        }
    }

    fn end(&mut self, end: &Spanned<String>) -> End {
        let known = self.known;
        let text = end.value.as_str();
        let each = each_of(text);
        let (word, path) = each.map_or_else(|| without_mark(text), |path| (EACH, path));
        let Some((name, gate)) = split(path) else {
            return if each.is_some() { self.misshapen(end, path) } else { End::Gate };
        };
        match known.kinds.get(name) {
            // A component of this name is reported, too.
            Some(_) if word.is_empty() && known.components.contains_key(name) => End::Gate,
            Some(kind) if each.is_some() => self.gate(end, *kind, gate),
            Some(kind) if !gate.contains(char::is_whitespace) => self.without_each(end, *kind, path),
            None if word.eq_ignore_ascii_case(EACH) => self.no_kind(end, name, gate),
            None if word.is_empty() && !known.components.contains_key(name) => self.plural(end, name, gate),
            _ => End::Gate,
        }
    }

    fn gate(&mut self, end: &Spanned<String>, at: usize, gate: &str) -> End {
        let kind = &self.known.model.kinds[at];
        if self.known.gates.contains(&(at, gate)) || kind.gates_unread {
            return End::Each(at, gate.to_owned());
        }
        let name = &kind.name.value;
        let gates = || kind.gates.iter().map(|gate| gate.name.value.as_str());
        let found = NO_GATE.at(format!("kind `{name}` has no gate `{gate}`"), end.span, "");
        let near = self.searches.similar(gate, gates());
        let found = self.choose(found, end, near.iter().map(|gate| each_end(name, gate)));
        let only = kind.gates.iter().find(|declared| near == [declared.name.value.as_str()]);
        let found = match only.map(|declared| declared.name.span) {
            // This name may be the one that is misspelt.
            Some(declared) => {
                let edit = Edit::new(declared, self.sources.quoted_as(declared, gate));
                found
                    .label(declared, "a similar gate is declared here")
                    .suggest(format!("or rename the gate to `{gate}`"), [edit])
            }
            None => found.label(kind.name.span, "the kind is declared here"),
        };
        self.problems.push(match kind.gates.is_empty() {
            true => found,
            false => found.note(format!("gates of `{name}`: {}", listed(gates()))),
        });
        End::Broken
    }

    fn no_kind(&mut self, end: &Spanned<String>, name: &str, gate: &str) -> End {
        if self.known.model.kinds_unread || self.known.unknown.contains(name) {
            return End::Broken;
        }
        let found = NO_KIND.at(format!("`{name}` is no kind"), end.span, "");
        let names = &self.known.names;
        if let Some(component) = self.known.components.get(name) {
            let found = found.label(component.name.span, "this is a component");
            let kind = component.kind.as_ref().filter(|kind| self.known.kinds.contains_key(kind.value.as_str()));
            let each = kind.map(|kind| each_end(&kind.value, gate));
            let alone = format!("{name}.{gate}");
            let found = self.choose(found, end, std::iter::once(alone).chain(each));
            self.problems.push(found);
            return End::Broken;
        }
        let near = self.searches.similar(name, names.iter().copied());
        let found = self.choose(found, end, near.iter().map(|name| each_end(name, gate)));
        self.problems.push(match names.is_empty() {
            true => found.help("kinds are declared in the section `kinds`"),
            false => found.note(format!("declared kinds: {}", listed(names))),
        });
        End::Broken
    }

    /// `motor.state`, `every motor.state`.
    fn without_each(&mut self, end: &Spanned<String>, at: usize, path: &str) -> End {
        let kind = &self.known.model.kinds[at];
        let found = WITHOUT_EACH
            .at(format!("`{}` is a kind, not a component", kind.name.value), end.span, "")
            .label(kind.name.span, "the kind is declared here");
        let found = self.choose(found, end, std::iter::once(format!("{EACH} {path}")));
        let components = self.known.components_of[at].iter().map(|(component, _)| component);
        self.problems.push(match components.len() {
            0 => found,
            _ => found.note(format!("components of the kind: {}", listed(components))),
        });
        match split(path) {
            Some((_, gate)) => End::Each(at, gate.to_owned()),
            None => End::Broken,
        }
    }

    /// `motors.state`, where `motor` is a kind.
    fn plural(&mut self, end: &Spanned<String>, name: &str, gate: &str) -> End {
        let one = name.strip_suffix('s').and_then(|one| Some((one, *self.known.kinds.get(one)?)));
        match one {
            Some((one, kind)) => self.without_each(end, kind, &format!("{one}.{gate}")),
            None => End::Gate,
        }
    }

    /// `each motor`, without a gate.
    fn misshapen(&mut self, end: &Spanned<String>, path: &str) -> End {
        let Some(&at) = self.known.kinds.get(path) else { return End::Gate };
        let gates = self.known.model.kinds[at].gates.iter().map(|gate| gate.name.value.as_str());
        let found = NO_GATE.at(format!("which gate of each `{path}`?"), end.span, "no gate");
        let found = match gates.len() <= MOST_GATES {
            true => self.choose(found, end, gates.clone().map(|gate| each_end(path, gate))),
            false => found,
        };
        self.problems.push(found.note(format!("gates of `{path}`: {}", listed(gates))));
        End::Broken
    }

    fn report_twice(&mut self, connection: &ConnectionModel) {
        let [first, second] = &connection.ends;
        self.problems.push(
            TWICE
                .at("`each` stands at both ends of the connection", second.span, "one connection for each")
                .label(first.span, "and for each")
                .help("name the components: one connection for each pair that belongs together"),
        );
    }

    /// Proposes what may be meant by an end.
    fn choose(&self, found: Diagnostic, end: &Spanned<String>, ways: impl Iterator<Item = String>) -> Diagnostic {
        choose(found, end.span, ways, self.sources)
    }
}

/// Proposes what may be written in a place.
pub(crate) fn choose(found: Diagnostic, at: Span, ways: impl Iterator<Item = String>, sources: &Sources) -> Diagnostic {
    let ways: Vec<String> = ways.collect();
    let edit = |way: &String| Edit::new(at, sources.quoted_as(at, way));
    found.choose(("write ", ""), ways.iter().map(|way| (way.as_str(), edit(way))))
}
