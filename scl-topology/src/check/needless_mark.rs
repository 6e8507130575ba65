//! SCL0711: `unconnected: ok` on a gate that is connected. The mark would hide the loss of the connection one day.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics};

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let mut connected_at = vec![None; draft.gates.len()];
    for link in &draft.links {
        for gate in link.ends.into_iter().flatten() {
            connected_at[gate].get_or_insert(link.model.span);
        }
    }
    for (at, gate) in draft.gates.iter().enumerate() {
        let (Some(option), Some(connected_at)) = (gate.option("unconnected"), connected_at[at]) else { continue };
        if gate.options.unconnected_ok {
            let headline = format!("gate `{}` is marked `unconnected: ok`, but it is connected", draft.path(at));
            let place = option.key.span.to(option.value.span);
            let found = Diagnostic::warning("SCL0711", headline, place, "no longer needed")
                .label(connected_at, "connected here")
                .help("remove the mark");
            problems.push(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn unconnected_ok_on_a_connected_gate() {
        let yaml = r#"
components:
  - name: controller
    gates:
      - events: {pub: Event, unconnected: ok}
  - name: ui
    gates:
      - events: {sub: Event}
connections:
  - [controller.events, ui.events]
"#;
        example(
            "SCL0711",
            yaml.trim_start(),
            expect![[r#"
            warning: [SCL0711] gate `controller.events` is marked `unconnected: ok`, but it is connected
             --> topology.yaml:4:30
              |
            4 |       - events: {pub: Event, unconnected: ok}
              |                              ^^^^^^^^^^^^^^^ no longer needed
            ...
            9 |   - [controller.events, ui.events]
              |     ------------------------------ connected here
              |
              = help: remove the mark
        "#]],
        );
    }
}
