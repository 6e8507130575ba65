//! A topology as Graphviz text: one table per component, one port per gate, one frame per group, and one edge per
//! connection.

use super::edge::edge_of;
use super::frame::Frame;
use scl_topology::topology::{Component, Connection, GateId, Topology};

const STYLE: &str = "    rankdir=LR;
    node [shape=plain, fontname=\"sans-serif\"];
    edge [fontname=\"sans-serif\", fontsize=10];
";

/// Draws a topology. Edges of requests are dashed and have two heads.
pub(crate) fn draw_dot(topology: &Topology) -> String {
    let components = Drawing { topology, frames: 0 }.draw_frame(&Frame::of(topology));
    let connections = topology.connections().map(|(_, connection)| draw_connection(topology, connection));
    let connections: String = connections.collect();
    format!("digraph \"{}\" {{\n{STYLE}{components}{connections}}}\n", escape_quoted(topology.system()))
}

struct Drawing<'a> {
    topology: &'a Topology,
    /// The number of groups drawn so far.
    frames: usize,
}

impl Drawing<'_> {
    /// Graphviz draws a frame around a subgraph whose name starts with `cluster`.
    fn draw_frame(&mut self, frame: &Frame<'_>) -> String {
        let components = frame.components.iter();
        let mut text: String =
            components.map(|(id, name)| draw_component(self.topology, self.topology.component(*id), name)).collect();
        for (name, frame) in &frame.groups {
            let (number, label) = (self.frames, escape_quoted(name));
            self.frames += 1;
            text.push_str(&format!("    subgraph cluster_{number} {{\n        label=\"{label}\";\n"));
            text.extend(self.draw_frame(frame).lines().map(|line| format!("    {line}\n")));
            text.push_str("    }\n");
        }
        text
    }
}

fn draw_component(topology: &Topology, component: &Component, title: &str) -> String {
    let (name, title) = (escape_quoted(component.name()), escape_html(title));
    let gates = component.gates().iter().map(|&id| {
        let gate = topology.gate(id);
        let (name, kind) = (escape_html(gate.name()), gate.kind().word());
        format!("            <tr><td port=\"{name}\" align=\"left\">{name}: {kind}</td></tr>\n")
    });
    let gates: String = gates.collect();
    format!(
        "    \"{name}\" [label=<
        <table border=\"0\" cellborder=\"1\" cellspacing=\"0\" cellpadding=\"4\">
            <tr><td bgcolor=\"lightgrey\"><b>{title}</b></td></tr>
{gates}        </table>>];
"
    )
}

fn draw_connection(topology: &Topology, connection: &Connection) -> String {
    let (source, sink) = (port(topology, connection.source()), port(topology, connection.sink()));
    let edge = edge_of(topology, connection);
    let label = if edge.types.is_empty() { None } else { Some(format!("label=\"{}\"", escape_quoted(&edge.types))) };
    let style = edge.answered.then(|| "style=dashed, dir=both".to_owned());
    match label.into_iter().chain(style).collect::<Vec<_>>().join(", ").as_str() {
        "" => format!("    {source} -> {sink};\n"),
        attributes => format!("    {source} -> {sink} [{attributes}];\n"),
    }
}

fn port(topology: &Topology, id: GateId) -> String {
    let gate = topology.gate(id);
    let component = topology.component(gate.component()).name();
    format!("\"{}\":\"{}\"", escape_quoted(component), escape_quoted(gate.name()))
}

fn escape_quoted(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n")
}

fn escape_html(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_escaped() {
        assert_eq!(escape_quoted("a\"b\\c"), r#"a\"b\\c"#);
        assert_eq!(escape_html("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
    }
}
