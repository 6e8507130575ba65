//! A topology as Mermaid text: one box per component with its gates inside, and one arrow per connection.

use super::edge::edge_of;
use scl_topology::topology::{Component, ComponentId, Connection, GateId, Topology};

/// Draws a topology: `pub` and `push` have an arrow `-->`, `req` the dashed `<-.->`.
pub(crate) fn draw_mermaid(topology: &Topology) -> String {
    let components = topology.components().map(|(id, component)| draw_component(topology, id, component));
    let connections = topology.connections().map(|(_, connection)| draw_connection(topology, connection));
    format!("flowchart LR\n{}{}", components.collect::<String>(), connections.collect::<String>())
}

fn draw_component(topology: &Topology, id: ComponentId, component: &Component) -> String {
    let name = component_name(topology, id);
    let label = escape(component.name());
    // Mermaid does not draw empty subgraphs, so a component without gates becomes a node.
    if component.gates().is_empty() {
        return format!("    {name}[\"{label}\"]\n");
    }
    let gates = component.gates().iter().map(|&id| {
        let gate = topology.gate(id);
        format!("        {}([\"{}: {}\"])\n", node_name(topology, id), escape(gate.name()), gate.kind().word())
    });
    format!("    subgraph {name}[\"{label}\"]\n{}    end\n", gates.collect::<String>())
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
