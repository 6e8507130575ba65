//! SCL0801: a gate whose own socket path is longer than the kernel allows. The name of a connection's socket is
//! shortened instead, see [`resolve`](crate::resolve).

use super::draft::Draft;
use super::named::{LONGEST_NAME, Noun};
use super::parameter::Parameters;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::ComponentModel;
use crate::resolve::{CONTRACT_LENGTH, TAP};
use crate::socket_paths::SocketPaths;
use crate::topology::{GateKind, Parameter};
use scl_plan::SET_SOCKET;

/// SCL0801.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0801",
    severity: Severity::Error,
    title: "socket path too long",
    explanation: "Names become parts of socket paths, which the kernel limits to 107 bytes. The check assumes the \
                  longest usual runtime folder, so that the file works for every user. Shorten the names; the names of \
                  whole connections are shortened automatically.",
    example: " components:
   - name: navigation_and_guidance_supervisor
     gates:
-      - commanded_trajectory_and_velocity_profile_of_the_vehicle: pub
+      - commanded_trajectory: pub
",
};

pub(super) fn check(
    draft: &Draft<'_>,
    parameters: &Parameters,
    paths: &SocketPaths,
    system: &str,
    problems: &mut Diagnostics,
) {
    let folder = paths.folder(system);
    for (at, component) in draft.components.iter().map(|component| component.model).enumerate() {
        let parameters = parameters.of(at, component.of);
        let Some(parameter) = parameters.iter().find(|it| it.declared().live) else { continue };
        let name = &component.name.value;
        let length = folder.len() + name.len() + 1 + SET_SOCKET.len();
        if name.len() <= LONGEST_NAME && Noun::Component.is_well_formed(name) && length > paths.limit {
            let path = format!("{folder}{name}.{SET_SOCKET}");
            problems.push(report_set(component, parameter, paths.limit, path));
        }
    }
    for (at, gate) in draft.gates.iter().enumerate() {
        let Some(ending) = gate.kind.and_then(longest_ending) else { continue };
        let names = [draft.component_name(at), &gate.model.name.value];
        // Repeated gates and names that are too long or malformed are reported by other rules.
        if gate.duplicate
            || names.iter().any(|name| name.len() > LONGEST_NAME)
            || !Noun::Component.is_well_formed(names[0])
            || !Noun::Gate.is_well_formed(names[1])
        {
            continue;
        }
        let length = folder.len() + names[0].len() + 1 + names[1].len() + ending.len();
        if length > paths.limit {
            problems.push(report(draft, at, paths.limit, format!("{folder}{}{ending}", draft.path(at))));
        }
    }
}

/// The end of the longest socket name that belongs to one gate of this kind; `sub`, `req` and `push` have no socket.
fn longest_ending(kind: GateKind) -> Option<String> {
    let tap = kind.listens().then(|| TAP.to_owned());
    // All contracts have the same length.
    let all_peers = matches!(kind, GateKind::Rep | GateKind::Pull).then(|| format!(".{}", "*".repeat(CONTRACT_LENGTH)));
    tap.into_iter().chain(all_peers).max_by_key(String::len)
}

fn report(draft: &Draft<'_>, gate: usize, limit: usize, path: String) -> Diagnostic {
    let length = path.len();
    let component = &draft.components[draft.gates[gate].component].model.name;
    let name = &draft.gates[gate].model.name;
    let headline = format!("the socket path of this gate has {length} bytes; the kernel allows {limit}");
    RULE.at(headline, name.span, format!("{} bytes", name.value.len()))
        .label(component.span, format!("{} bytes", component.value.len()))
        .help(format!("shorten the names by {} bytes", length - limit))
        .note(format!("path: {path}"))
        .note("the folder is the longest usual one, so that the file works for every user of the machine")
}

/// The socket where the live parameters of a component can be changed.
fn report_set(component: &ComponentModel, parameter: &Parameter, limit: usize, path: String) -> Diagnostic {
    let (length, name) = (path.len(), &component.name);
    let headline = format!("the socket path of the parameters has {length} bytes; the kernel allows {limit}");
    RULE.at(headline, name.span, format!("{} bytes", name.value.len()))
        .label(parameter.span(), "can be changed while the program runs, through this socket")
        .help(format!("shorten the name by {} bytes, or that of the system", length - limit))
        .note(format!("path: {path}"))
        .note("the folder is the longest usual one, so that the file works for every user of the machine")
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn each_socket_of_a_gate_fits_or_is_refused() {
        // In the system `topology`, 73 bytes are left for component, dot, gate and ending.
        let judged = |kind: &str, length: usize| {
            let name = "g".repeat(length);
            let yaml = format!(
                "components:\n  - name: {}\n    gates:\n      - {name}: {{{kind}, unconnected: ok}}\n",
                "c".repeat(20)
            );
            advice(&yaml).contains("SCL0801")
        };
        let longest = |kind: &str| (1..=64).rev().find(|&length| !judged(kind, length));
        let kinds = ["pub: T", "rep: A -> B", "pull: T", "sub: T", "req: A -> B", "push: T"];
        assert_eq!(kinds.map(longest), [Some(48), Some(43), Some(43), Some(64), Some(64), Some(64)]);
    }

    #[test]
    fn the_socket_of_live_parameters_fits_or_is_refused() {
        let file = |kinds: bool, name: &str, live: &str| {
            let parameters = format!("parameters: [{{gain: {{f64: 1{live}}}}}]");
            match kinds {
                false => {
                    format!("system: {}\ncomponents:\n  - {{name: {name}, {parameters}, gates: []}}\n", "s".repeat(40))
                }
                true => format!(
                    "system: {}\nkinds:\n  - {{name: motor, {parameters}, gates: []}}\ncomponents:\n  - {{name: {name}, kind: motor}}\n",
                    "s".repeat(40)
                ),
            }
        };
        for kinds in [false, true] {
            let is_told = |length: usize, live| advice(&file(kinds, &"c".repeat(length), live)).contains("SCL0801");
            assert_eq!([37, 38].map(|length| is_told(length, ", live: true")), [false, true], "{kinds}");
            assert!(!is_told(38, ""), "{kinds}");
        }
    }

    #[test]
    fn socket_path_too_long() {
        rule_example(
            &RULE,
            expect![[r#"
                error: [SCL0801] the socket path of this gate has 129 bytes; the kernel allows 107
                 --> topology.yaml:4:9
                  |
                2 |   - name: navigation_and_guidance_supervisor
                  |           ---------------------------------- 34 bytes
                3 |     gates:
                4 |       - commanded_trajectory_and_velocity_profile_of_the_vehicle: pub
                  |         ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ 56 bytes
                  |
                  = help: shorten the names by 22 bytes
                  = note: path: /run/user/4294967295/scl/topology/navigation_and_guidance_supervisor.commanded_trajectory_and_velocity_profile_of_the_vehicle.tap
                  = note: the folder is the longest usual one, so that the file works for every user of the machine
            "#]],
        );
    }
}
