//! A topology as Mermaid text: one box per component with its gates inside, a box around each group, and one arrow per
//! connection.

use super::edge::edge_of;
use super::frame::Frame;
use scl_topology::topology::{ComponentId, Connection, GateId, Topology};

/// Draws a topology: `pub` and `push` have an arrow `-->`, `req` the dashed `<-.->`.
pub(crate) fn draw_mermaid(topology: &Topology) -> String {
    let mut text = "flowchart LR\n".to_owned();
    Drawing { topology, text: &mut text, frames: 0 }.draw_frame(&Frame::of(topology), "    ");
    text.extend(topology.connections().map(|(_, connection)| draw_connection(topology, connection)));
    text
}

struct Drawing<'a> {
    topology: &'a Topology,
    text: &'a mut String,
    /// The number of groups drawn so far.
    frames: usize,
}

impl Drawing<'_> {
    fn draw_frame(&mut self, frame: &Frame<'_>, indent: &str) {
        for (id, name) in &frame.components {
            self.draw_component(*id, name, indent);
        }
        for (name, frame) in &frame.groups {
            self.text.push_str(&format!("{indent}subgraph f{}[\"{}\"]\n", self.frames, escape(name)));
            self.frames += 1;
            self.draw_frame(frame, &format!("{indent}    "));
            self.text.push_str(&format!("{indent}end\n"));
        }
    }

    fn draw_component(&mut self, id: ComponentId, name: &str, indent: &str) {
        let (node, label) = (component_name(self.topology, id), escape(name));
        let gates = self.topology.component(id).gates();
        // Mermaid does not draw empty subgraphs, so a component without gates becomes a node.
        if gates.is_empty() {
            self.text.push_str(&format!("{indent}{node}[\"{label}\"]\n"));
            return;
        }
        self.text.push_str(&format!("{indent}subgraph {node}[\"{label}\"]\n"));
        for &id in gates {
            let (node, gate) = (node_name(self.topology, id), self.topology.gate(id));
            let (name, kind) = (escape(gate.name()), gate.kind().word());
            self.text.push_str(&format!("{indent}    {node}([\"{name}: {kind}\"])\n"));
        }
        self.text.push_str(&format!("{indent}end\n"));
    }
}

fn draw_connection(topology: &Topology, connection: &Connection) -> String {
    let (source, sink) = (node_name(topology, connection.source()), node_name(topology, connection.sink()));
    let edge = edge_of(topology, connection);
    let arrow = if edge.answered { "<-.->" } else { "-->" };
    match edge.types.as_str() {
        "" => format!("    {source} {arrow} {sink}\n"),
        types => format!("    {source} {arrow}|\"{}\"| {sink}\n", escape(types)),
    }
}

/// Returns a numbered name for the drawing: a component may be called `end` or `class`, which are keywords of Mermaid.
fn component_name(topology: &Topology, id: ComponentId) -> String {
    let number = topology.components().position(|(it, _)| it == id).unwrap_or_default();
    format!("c{number}")
}

fn node_name(topology: &Topology, id: GateId) -> String {
    let component = topology.gate(id).component();
    let number = topology.component(component).gates().iter().position(|&it| it == id).unwrap_or_default();
    format!("{}g{number}", component_name(topology, component))
}

/// Escapes a text for a quoted label. Only the quote and `#`, which starts an entity, are special there; `<` and `>`
/// would become HTML.
fn escape(text: &str) -> String {
    text.replace('#', "#35;").replace('"', "#quot;").replace('<', "#lt;").replace('>', "#gt;")
}

#[cfg(test)]
mod tests {
    use super::escape;

    #[test]
    fn labels_are_escaped() {
        assert_eq!(escape(r#"a#"<b> -> c"#), "a#35;#quot;#lt;b#gt; -#gt; c");
    }
}
