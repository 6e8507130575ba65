//! The layout of the live display. Only the terminal's own sixteen colours are used, so that it suits dark and light
//! ones.

use super::Order;
use super::rows::{COMPONENT_COLUMNS, GATE_COLUMNS, TEXT_COLUMNS, component_cells, gate_cells};
use super::view::View;
use clap::ValueEnum;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Cell, Paragraph, Row, Table, TableState};
use scl_observe::{Activity, GateRow};
use scl_terminal::{bytes_text, escape, shorten};

/// Columns that are left out on narrow terminals, in this order, until the names have enough room.
const DISPENSABLE: [&str; 8] = ["RECEIVED", "SENT", "LOST", "KIND", "WAIT", "SINCE", "PID", "MEM"];

/// The room that names need before columns are left out.
const NAME_WIDTH: usize = 20;

/// Draws the whole display.
pub(super) fn draw(frame: &mut Frame<'_>, view: &View) {
    let components = u16::try_from(view.snapshot.components.len()).unwrap_or(u16::MAX);
    // Gates keep at least half of the terminal.
    let components = components.saturating_add(1).min((frame.area().height / 2).max(2));
    let details = view.detailed().map_or(0, |gate| details_height(gate, view, frame.area().height));
    let heights = [1, components, 1].map(Constraint::Length).into_iter();
    let heights = heights.chain([Constraint::Min(0), Constraint::Length(details), Constraint::Length(1)]);
    let [head, components, _, gates, details, foot] = Layout::vertical(heights).areas(frame.area());
    frame.render_widget(headline(view), head);
    draw_components(frame, components, view);
    draw_gates(frame, gates, view);
    if let Some(gate) = view.detailed() {
        draw_details(frame, details, gate, view);
    }
    frame.render_widget(keys(view), foot);
}

fn headline(view: &View) -> Line<'static> {
    let components = &view.snapshot.components;
    let count = |wanted: fn(Activity) -> bool| components.iter().filter(|row| wanted(row.activity)).count();
    let running = count(|activity| !matches!(activity, Activity::Dead | Activity::Stopped));
    let mut text = format!("{} of {} components running", running, components.len());
    for (count, word) in
        [(count(|it| matches!(it, Activity::Hangs(_))), "hang"), (count(|it| it == Activity::Dead), "dead")]
    {
        if count > 0 {
            text.push_str(&format!(", {count} {word}"));
        }
    }
    let name = Span::styled(escape(&view.snapshot.system).into_owned(), Modifier::BOLD);
    let paused = if view.paused { "  paused" } else { "" };
    Line::from(vec![name, Span::raw(format!("  {text}")), Span::styled(paused, Modifier::REVERSED)])
}

fn keys(view: &View) -> Line<'static> {
    let order = view.order.to_possible_value().map_or(String::new(), |it| it.get_name().to_owned());
    let bold = |text: &'static str| Span::styled(text, Modifier::BOLD);
    let sorted = format!(" sorted by {order}  ");
    let keys = [("q", " quit  "), ("↑↓", " choose  "), ("Enter", " details  "), ("s", &sorted), ("space", " pause")];
    keys.into_iter().flat_map(|(key, text)| [bold(key), Span::raw(text.to_owned())]).collect()
}

fn draw_components(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let rows: Vec<_> = view.snapshot.components.iter().map(|row| component_cells(row).to_vec()).collect();
    let styles: Vec<_> =
        view.snapshot.components.iter().map(|row| activity_style(row.activity, view.colours)).collect();
    let sorted_by = match view.order {
        Order::Cpu => "CPU",
        Order::Memory => "MEM",
        _ => "",
    };
    let table = TextTable { columns: &COMPONENT_COLUMNS, rows, sorted_by };
    let style = |row: usize, heading: &str| if heading == "STATE" { styles[row] } else { Style::new() };
    frame.render_widget(table.fit(area.width, style), area);
}

fn draw_gates(frame: &mut Frame<'_>, area: Rect, view: &View) {
    let gates = &view.snapshot.gates;
    let rows: Vec<_> = gates.iter().map(|row| gate_cells(row).to_vec()).collect();
    let sorted_by = match view.order {
        Order::Rate => "RATE",
        Order::Waiting => "WAIT",
        Order::Dropped => "DROP",
        _ => "",
    };
    let is_bad = |gate: &GateRow, heading: &str| match heading {
        "DROP" => gate.dropped().is_some_and(|dropped| dropped > 0),
        "LOST" => gate.figures.as_ref().is_some_and(|figures| figures.lost > 0),
        "PEERS" => gate.figures.as_ref().is_some_and(|figures| figures.peers < gate.connections.len() as u64),
        _ => false,
    };
    let style = |row: usize, heading: &str| coloured(Color::Yellow, view.colours && is_bad(&gates[row], heading));
    let table = TextTable { columns: &GATE_COLUMNS, rows, sorted_by };
    let table = table.fit(area.width, style).row_highlight_style(Modifier::REVERSED);
    let mut state = TableState::default();
    state.select(view.selected());
    frame.render_stateful_widget(table, area, &mut state);
}

fn details_height(gate: &GateRow, view: &View, height: u16) -> u16 {
    let lines = gate.connections.len() + 2 + usize::from(parameters(gate, view).is_some());
    u16::try_from(lines).unwrap_or(u16::MAX).min(height / 3)
}

/// The live parameters of a gate's component, in a line: `gain = 2  mode = auto`; `None` if it has none.
fn parameters(gate: &GateRow, view: &View) -> Option<Line<'static>> {
    let component = view.snapshot.components.iter().find(|row| row.name == gate.component)?;
    let values: Vec<String> =
        component.parameters.iter().map(|(name, value)| format!("{name} = {}", escape(value))).collect();
    (!values.is_empty()).then(|| Line::raw(format!("  {}", values.join("  "))))
}

fn draw_details(frame: &mut Frame<'_>, area: Rect, gate: &GateRow, view: &View) {
    let bytes = gate.figures.as_ref().map_or("-".to_owned(), |it| bytes_text(it.bytes as f64));
    let counts = gate
        .figures
        .as_ref()
        .map_or("rejected -".to_owned(), |it| format!("rejected {}  undecodable {}", it.rejected, it.undecodable));
    // Only gates that declare a time have these.
    let timed = gate.figures.as_ref().map_or([0; 2], |it| [it.missed, it.expired]);
    let timed: String = ["missed", "expired"]
        .into_iter()
        .zip(timed)
        .filter(|(_, count)| *count > 0)
        .map(|(word, count)| format!("  {word} {count}"))
        .collect();
    let about = format!("{}  {}  {}  {bytes}  {counts}{timed}", gate.name(), gate.payload, gate.codec);
    let about = Line::styled(escape(&about).into_owned(), Modifier::BOLD);
    let connections = gate.connections.iter().enumerate().map(|(index, connection)| {
        let (word, colour) = match connection.connected {
            Some(true) => ("connected", Color::Green),
            Some(false) => ("not connected", Color::Yellow),
            None => ("unknown", Color::Reset),
        };
        let figures = gate.figures.as_ref().and_then(|it| it.connections.get(index));
        let figures = figures.map_or(String::new(), |it| {
            let counts = [
                ("taken", it.taken),
                ("not yet", it.waiting),
                ("replaced", it.replaced),
                ("dropped", it.dropped),
                ("lost", it.lost),
                ("missed", it.missed),
                ("expired", it.expired),
            ];
            // Only a connection with `queue: 1`, `deadline` or `max_age` has these.
            let is_rare = |word: &str| matches!(word, "replaced" | "missed" | "expired");
            let shown = counts.into_iter().filter(|(word, count)| !is_rare(word) || *count > 0);
            shown.map(|(word, count)| format!("  {word} {count}")).collect()
        });
        let peer = format!("  {}  ", escape(&connection.peer));
        Line::from(vec![Span::raw(peer), Span::styled(word, coloured(colour, view.colours)), Span::raw(figures)])
    });
    frame.render_widget(
        Paragraph::new(
            [Line::default(), about].into_iter().chain(parameters(gate, view)).chain(connections).collect::<Vec<_>>(),
        ),
        area,
    );
}

fn activity_style(activity: Activity, colours: bool) -> Style {
    match activity {
        Activity::Ready => coloured(Color::Green, colours),
        Activity::Waiting => coloured(Color::Yellow, colours),
        Activity::Hangs(_) | Activity::Dead => coloured(Color::Red, colours).add_modifier(Modifier::BOLD),
        Activity::Running => Style::new(),
        Activity::Stopped => Style::new().add_modifier(Modifier::DIM),
    }
}

fn coloured(colour: Color, colours: bool) -> Style {
    if colours { Style::new().fg(colour) } else { Style::new() }
}

/// Cells under headings. The first column takes the room that is left.
struct TextTable<'t> {
    columns: &'t [&'static str],
    rows: Vec<Vec<String>>,
    sorted_by: &'t str,
}

impl TextTable<'_> {
    /// Returns the table for a terminal of this width, with as many columns as fit. `style` returns the style of a cell
    /// from its row number and heading.
    fn fit(&self, width: u16, style: impl Fn(usize, &str) -> Style) -> Table<'static> {
        let widths: Vec<usize> = (0..self.columns.len()).map(|column| self.width(column)).collect();
        let mut shown: Vec<usize> = (0..self.columns.len()).collect();
        let name_width = widths[0].min(NAME_WIDTH);
        let taken = |shown: &[usize]| shown.iter().skip(1).map(|column| widths[*column] + 2).sum::<usize>();
        for dispensable in DISPENSABLE {
            if name_width + taken(&shown) > usize::from(width) {
                shown.retain(|column| self.columns[*column] != dispensable);
            }
        }
        let name_width = widths[0].min(usize::from(width).saturating_sub(taken(&shown)).max(1));
        let heading = |column: usize| {
            let heading = self.columns[column];
            let style = Style::new().add_modifier(Modifier::BOLD);
            let is_sorted = heading == self.sorted_by;
            let style = if is_sorted { style.add_modifier(Modifier::UNDERLINED) } else { style };
            Cell::from(Self::aligned(column, heading.to_owned())).style(style)
        };
        let rows = self.rows.iter().enumerate().map(|(number, row)| {
            Row::new(shown.iter().map(|&column| {
                let text = escape(&row[column]).into_owned();
                let text = if column == 0 { shorten(&text, name_width) } else { text };
                Cell::from(Self::aligned(column, text)).style(style(number, self.columns[column]))
            }))
        });
        let constraints = shown.iter().map(|&column| match column {
            0 => Constraint::Length(u16::try_from(name_width).unwrap_or(u16::MAX)),
            _ => Constraint::Length(u16::try_from(widths[column]).unwrap_or(u16::MAX)),
        });
        Table::new(rows, constraints).header(Row::new(shown.iter().map(|&column| heading(column)))).column_spacing(2)
    }

    fn width(&self, column: usize) -> usize {
        let cells = self.rows.iter().map(|row| row[column].chars().count());
        cells.max().unwrap_or(0).max(self.columns[column].len())
    }

    fn aligned(column: usize, text: String) -> Line<'static> {
        if column < TEXT_COLUMNS { Line::raw(text) } else { Line::raw(text).right_aligned() }
    }
}

#[cfg(test)]
mod tests;
