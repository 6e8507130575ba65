//! Generated files that are made to cost a checker much. The tests count the work that they cause, and
//! `cargo bench -p scl-topology --bench cost` measures it.

/// The four inputs of a fixed size that once took minutes or all memory.
pub(crate) fn fixed() -> Vec<(&'static str, String)> {
    vec![
        ("16,000 aliases on one line", aliases(64_000)),
        ("150,000 duplicate keys", "a: 1\n".repeat(150_000)),
        ("4,000 wrong connections in one-line JSON", one_line_json(4_000)),
        ("4,000 unknown names with a common prefix", common_prefix(4_000)),
    ]
}

/// One input of about `size` bytes of each class, with its name.
pub(crate) fn filled(size: usize) -> Vec<(&'static str, String)> {
    let fill = |head: &str, unit: &str| format!("{head}{}", unit.repeat((size - head.len()) / unit.len()));
    vec![
        ("aliases", aliases(size)),
        ("duplicate keys", fill("components:\n", "  a: 1\n")),
        ("different duplicate keys", different_keys(size)),
        ("brackets", fill("components: ", "[")),
        ("closed brackets", format!("{}]", fill("components: [", "[],"))),
        ("one word on one line", fill("components: ", "a")),
        ("words on one line", format!("{}]", fill("components: [", "a b, "))),
        ("wrong connections", wrong_connections(size)),
        ("wrong connections on one line", one_line_json(size / 24)),
        ("unknown names with a common prefix", common_prefix(size / 150)),
        ("unknown gates", unknown_gates(size)),
        ("components without their gates", without_gates(size)),
        ("connections of one gate", crowd(size)),
        ("types that differ", different_types(size)),
        ("one circle", circle(size, size / 110)),
        ("many circles", circle(size, 2)),
        ("circles with common connections", knot(size, "")),
        ("allowed circles", knot(size, " # scl: allow(SCL0707) x")),
        ("gates", gates(size)),
        ("one declaration many times", fill("components:\n", "  - name: a\n    gates: []\n")),
        ("names of one sound", sound_alikes(size)),
        ("one long name", format!("components:\n  - name: a\n    gates:\n      - {}: pub\n", "g".repeat(size - 64))),
        ("two long names", two_long_names(size)),
        ("deep nesting", nested(size)),
        ("lost quotes", fill("connections:\n", "  - [\"a.b, b.a]\n")),
        ("lost brackets", fill("connections:\n", "  - [a.b, b.a\n")),
        ("one lost bracket", format!("connections: [\n{}", fill("", "  [a.b, b.a],\n"))),
        ("lost colons", fill("components:\n", "  - name a\n    gates\n      - x pub\n")),
        ("lost commas", fill("components:\n", "  - {name: a gates: []}\n")),
        ("lost spaces", fill("components:\n", "  -name:a\n")),
        ("tabs", fill("components:\n", "\t- name: a\n")),
        ("invisible characters", fill("components:\n", "  - name: a\u{200b}b\n")),
        ("wrong indentation", fill("components:\n", "  - name: a\n     gates:\n   - x: pub\n")),
        ("unknown options", fill(GATES_OF_A, "      - x: {sub: T, quue: 1}\n")),
        ("arrays", fill(GATES_OF_A, "      - x[3]: pub\n")),
        ("gates with a topic", fill(GATES_OF_A, "      - {topic: x, type: a.B}\n")),
        ("conditions of a template", fill("components:\n", "#if\n  - name: a\n    gates: [x: pub]\n")),
        ("components without gates on one line", format!("{}]", fill("components: [", "{name: a}, "))),
        ("kinds of others on one line", on_one_line(size, "{x: {publisher: T, depth: 3, best_effort: yes}}")),
        ("pairs in one word on one line", format!("{}]", fill("components: []\nconnections: [", "a.b -> c.d, "))),
        ("documents", fill("components:\n", "---\n")),
        ("conflict markers", fill("components:\n", "<<<<<<< a\n=======\n>>>>>>> b\n")),
        ("comments", fill("components: []\n", "# comment\n")),
        ("components of a kind", of_a_kind(size, 0)),
        ("connections of a kind", of_a_kind(size, size / 100)),
        ("wrong gates of a kind", of_a_kind(size, 2).replace("each k.g00", "each k.h00")),
        ("gates of everyone", everyone(size, 4)),
        ("many components of everyone", everyone(size, size / 100)),
        ("wrong gates of everyone", everyone(size, 4).replace("to: l.r", "to: l.s, except: [b, b, c]")),
        ("bounds that are too low", low_bounds(size)),
        ("bounds of a kind that are too low", of_a_kind(size, 2).replace("name: k\n", "name: k\n    memory: 1B\n")),
        ("taken gates of everyone", everyone(size, 40).replace("gates: []", "gates: [g000001: pub, g000002: pub]")),
        ("kinds without components", kinds(size)),
        ("unknown kinds", fill("components:\n", "  - {name: a, kind: b}\n")),
        ("comments for the checker", fill("components: []\n", "# scl: allow(SCL0799)\n")),
    ]
}

const GATES_OF_A: &str = "components:\n  - name: a\n    gates:\n";

fn on_one_line(size: usize, gate: &str) -> String {
    let gates = format!("{gate}, ").repeat(size / (gate.len() + 2));
    format!("components: [{{name: a, gates: [{gates}]}}]\n")
}

fn aliases(size: usize) -> String {
    format!("components: [&a x{}]\n", ", *a".repeat(size / 4 - 8))
}

fn one_line_json(connections: usize) -> String {
    let pairs: Vec<String> = (0..connections).map(|at| format!("[\"a.x{at}\", \"b.y{at}\"]")).collect();
    let component = |name: &str, gate: &str| format!("{{\"name\": \"{name}\", \"gates\": [{{\"{gate}\": \"pub\"}}]}}");
    let components = [component("a", "out"), component("b", "in")].join(", ");
    format!("{{\"components\": [{components}], \"connections\": [{}]}}\n", pairs.join(", "))
}

fn common_prefix(names: usize) -> String {
    let mut text = String::from("components:\n");
    for at in 0..names {
        text.push_str(&format!("  - name: a_rather_long_common_prefix_{at:05}\n    gates:\n      - x: pub\n"));
    }
    text.push_str("connections:\n");
    for at in 0..names {
        text.push_str(&format!(
            "  - [a_rather_long_common_prefix_{:05}.x, a_rather_long_common_prefix_{at:05}q.x]\n",
            at
        ));
    }
    text
}

fn wrong_connections(size: usize) -> String {
    let head =
        "components:\n  - name: a\n    gates:\n      - x: pub\n  - name: b\n    gates:\n      - x: sub\nconnections:\n";
    let lines: String = (0..size / 24).map(|at| format!("  - [a.x, b{at:06}.x]\n")).collect();
    format!("{head}{lines}")
}

fn nested(size: usize) -> String {
    // A block of depth d has about d * d / 2 bytes of indentation.
    let depth = ((2 * size) as f64).sqrt() as usize - 2;
    (0..depth).map(|depth| format!("{}a:\n", " ".repeat(depth))).collect()
}

fn gates(size: usize) -> String {
    let gates: String = (0..size / 28).map(|at| format!("      - gate_{at:08}: sub\n")).collect();
    format!("components:\n  - name: a\n    gates:\n{gates}connections: []\n")
}

fn unknown_gates(size: usize) -> String {
    let count = size / 60;
    let gates: String = (0..count).map(|at| format!("      - gate_{at:06}: pub\n")).collect();
    let lines: String = (0..count).map(|at| format!("  - [a.gate_{at:06}q, b.x]\n")).collect();
    format!(
        "components:\n  - name: a\n    gates:\n{gates}  - name: b\n    gates:\n      - x: sub\nconnections:\n{lines}"
    )
}

/// Components of a kind with many gates, and some connections of all of them. What they stand for is limited.
fn of_a_kind(size: usize, connections: usize) -> String {
    let gates: String = (0..size / 100).map(|at| format!("      - g{at:06}: pub\n")).collect();
    let components: String = (0..size / 100).map(|at| format!("  - {{name: c{at:06}, kind: k}}\n")).collect();
    let pairs: String = (0..connections).map(|at| format!("  - [each k.g{at:06}, b.x]\n")).collect();
    format!(
        "kinds:\n  - name: k\n    gates:\n{gates}components:\n{components}  - {{name: b, gates: [x: sub]}}\n\
         connections:\n{pairs}"
    )
}

/// Components, and gates of everyone.
fn everyone(size: usize, components: usize) -> String {
    let components: String = (0..components).map(|at| format!("  - {{name: c{at:06}, gates: []}}\n")).collect();
    let left = size.saturating_sub(components.len()) / 40;
    let gates: String = (0..left).map(|at| format!("  - g{at:06}: {{push: T, to: l.r}}\n")).collect();
    format!("components:\n{components}  - {{name: l, gates: [r: pull]}}\neveryone:\n{gates}connections: []\n")
}

/// Components with a bound that are all connected to one, which has a bound, too.
fn low_bounds(size: usize) -> String {
    let count = size / 100;
    let components = (0..count).map(|at| format!("  - {{name: c{at:06}, memory: 1MiB, gates: [x: {{pub: T}}]}}\n"));
    let pairs = (0..count).map(|at| format!("  - [c{at:06}.x, b.x]\n"));
    let (components, pairs): (String, String) = (components.collect(), pairs.collect());
    format!("components:\n  - {{name: b, memory: 1MiB, gates: [x: {{sub: T}}]}}\n{components}connections:\n{pairs}")
}

/// Kinds, and connections of kinds with similar names.
fn kinds(size: usize) -> String {
    let kinds: String = (0..size / 80).map(|at| format!("  - {{name: kind_{at:06}, gates: [x: pub]}}\n")).collect();
    let pairs: String = (0..size / 80).map(|at| format!("  - [each kind_{at:06}q.x, each kind_{at:06}.y]\n")).collect();
    format!("kinds:\n{kinds}components: []\nconnections:\n{pairs}")
}

fn two_long_names(size: usize) -> String {
    let [one, other] = ["g", "h"].map(|letter| letter.repeat(size / 2 - 100));
    format!("components:\n  - name: a\n    gates:\n      - {one}: pub\nconnections:\n  - [a.{other}, b.x]\n")
}

fn crowd(size: usize) -> String {
    let head =
        "components:\n  - name: a\n    gates:\n      - x: rep\n  - name: b\n    gates:\n      - x: rep\nconnections:\n";
    format!("{head}{}", "  - [a.x, b.x]\n".repeat(size / 16))
}

/// Components that ask each other in circles of `length`.
/// Components that each ask the next four.
fn knot(size: usize, comment: &str) -> String {
    let count = size / (160 + 4 * comment.len());
    let component = "    gates:\n      - i: rep\n      - o0: req\n      - o1: req\n      - o2: req\n      - o3: req\n";
    let components = (0..count).map(|at| format!("  - name: c{at}\n{component}"));
    let steps = (0..count).flat_map(|at| (0..4).map(move |step| (at, step)));
    let lines = steps.map(|(at, step)| format!("  - [c{at}.o{step}, c{}.i]{comment}\n", (at + 1 + step) % count));
    format!("components:\n{}connections:\n{}", components.collect::<String>(), lines.collect::<String>())
}

fn circle(size: usize, length: usize) -> String {
    let count = size / 110 / length * length;
    let components = (0..count).map(|at| format!("  - name: c{at:06}\n    gates:\n      - o: req\n      - i: rep\n"));
    let next = |at: usize| if (at + 1).is_multiple_of(length) { at + 1 - length } else { at + 1 };
    let lines = (0..count).map(|at| format!("  - [c{at:06}.o, c{:06}.i]\n", next(at)));
    format!("components:\n{}connections:\n{}", components.collect::<String>(), lines.collect::<String>())
}

fn different_keys(size: usize) -> String {
    let keys: String = (0..size / 20).map(|at| format!("k{at:06}: 1\n")).collect();
    format!("{keys}{keys}")
}

fn without_gates(size: usize) -> String {
    let count = size / 40;
    let components: String = (0..count / 2).map(|at| format!("  - name: c{at:06}\n    gates: []\n")).collect();
    let lines: String = (0..count / 2).map(|at| format!("  - [c{at:06}, c{at:06}]\n")).collect();
    format!("components:\n{components}connections:\n{lines}")
}

fn different_types(size: usize) -> String {
    let count = size / 64;
    let gates: String = (0..count).map(|at| format!("      - g{at:06}: {{sub: T{at:06}}}\n")).collect();
    let lines: String = (0..count).map(|at| format!("  - [a.x, b.g{at:06}]\n")).collect();
    format!(
        "components:\n  - name: a\n    gates:\n      - x: {{pub: T}}\n  - name: b\n    gates:\n{gates}connections:\n{lines}"
    )
}

fn sound_alikes(size: usize) -> String {
    let names = (0..size / 50).map(|at| {
        let name: String = (0..12).map(|bit| if at >> bit & 1 == 0 { 'a' } else { 'A' }).collect();
        format!("  - name: {name}\n    gates:\n      - x: pub\n")
    });
    format!("components:\n{}", names.collect::<String>())
}
