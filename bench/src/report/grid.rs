//! Cells in columns, as wide as what they hold.

use std::fmt;

/// Rows with a name each and groups of columns to its right.
pub(super) struct Grid {
    names: Vec<String>,
    groups: Vec<Group>,
}

/// Columns that stand together under one heading.
struct Group {
    heading: String,
    columns: Vec<Cells>,
}

/// What stands above a column, and one cell a row.
pub(super) type Cells = (String, Vec<String>);

impl Grid {
    pub(super) fn new(names: Vec<String>) -> Self {
        Self { names, groups: Vec::new() }
    }

    /// Adds a column on its own.
    pub(super) fn add(&mut self, column: Cells) {
        self.add_group("", vec![column]);
    }

    /// Adds columns under a heading of their own; nothing where there are none.
    pub(super) fn add_group(&mut self, heading: &str, columns: Vec<Cells>) {
        if !columns.is_empty() {
            self.groups.push(Group { heading: heading.to_owned(), columns });
        }
    }

    fn write_line(&self, f: &mut fmt::Formatter<'_>, name: &str, group: impl Fn(&Group) -> String) -> fmt::Result {
        let width = self.names.iter().map(String::len).max().unwrap_or_default();
        let groups: String = self.groups.iter().map(group).collect();
        writeln!(f, "{}", format!("{name:width$}{groups}").trim_end())
    }
}

impl fmt::Display for Grid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.groups.iter().any(|group| !group.heading.is_empty()) {
            self.write_line(f, "", |group| format!("{:>1$}", group.heading, group.widths().iter().sum()))?;
        }
        self.write_line(f, "", |group| group.line(|(heading, _)| heading))?;
        for (row, name) in self.names.iter().enumerate() {
            self.write_line(f, name, |group| group.line(|(_, cells)| cells.get(row).map_or("", String::as_str)))?;
        }
        Ok(())
    }
}

impl Group {
    /// Of each column, with two spaces before it; together at least as wide as the heading.
    fn widths(&self) -> Vec<usize> {
        let cells = |(heading, cells): &Cells| cells.iter().map(String::len).fold(heading.len(), usize::max);
        let mut widths: Vec<usize> = self.columns.iter().map(|column| cells(column) + 2).collect();
        let missing = (self.heading.len() + 2).saturating_sub(widths.iter().sum());
        if let Some(first) = widths.first_mut() {
            *first += missing;
        }
        widths
    }

    fn line<'a>(&'a self, cell: impl Fn(&'a Cells) -> &'a str) -> String {
        self.columns.iter().zip(self.widths()).map(|(column, width)| format!("{:>width$}", cell(column))).collect()
    }
}
