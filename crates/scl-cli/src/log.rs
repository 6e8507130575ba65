//! `scl log`: what a component has printed, also after it and `scl run` have ended.

use crate::format::FormatArgument;
use crate::load::system_of_folder;
use clap::{Args, ValueEnum};
use scl_run::{LogEntry, LogFolder, LogReader, LogStream, running_systems};
use scl_terminal::{
    Problem, choose_system, escape, escape_json, output_is_closed, output_is_terminal, parse_duration, print_out,
    quoted_list, reader_has_gone, timestamp,
};
use std::collections::VecDeque;
use std::env;
use std::ffi::OsString;
use std::io;
use std::process::ExitCode;
use std::thread::sleep;
use std::time::{Duration, SystemTime};

/// Number of earlier lines that are shown before new ones are followed.
const LINES_BEFORE: usize = 10;

/// How often a followed log is examined.
const LOOK: Duration = Duration::from_millis(100);

/// Show what a component has printed under `scl run`, also after both have ended.
///
/// The log is in files below `$XDG_STATE_HOME/scl`, or `~/.local/state/scl`; the newest 12 to 16 MiB of each component
/// are kept.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl log sensor                          everything that is kept
  scl log sensor -n 100                   the last 100 lines
  scl log sensor -f                       what it prints from now on, and ten lines before
  scl log sensor --since 5min --stream stderr
  scl log sensor --format json | jq -r 'select(.run == 3) | .text'

Exit code: 0 shown, 2 there is no such log.")]
pub(crate) struct LogArguments {
    /// The component.
    #[arg(value_name = "COMPONENT")]
    component: String,
    /// Wait for further lines until Ctrl-C.
    #[arg(long, short)]
    follow: bool,
    /// Show the last lines only.
    #[arg(long, short = 'n', value_name = "LINES")]
    lines: Option<usize>,
    /// Show only lines that are at most this old, for example `5min`.
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    since: Option<Duration>,
    /// Show lines of this stream only.
    #[arg(long, value_enum, value_name = "STREAM")]
    stream: Option<StreamArgument>,
    /// The system [default: $SCL_SYSTEM, or the only one that runs, or that of ./topology.yaml, or the only one with
    /// logs].
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
    #[command(flatten)]
    format: FormatArgument,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum StreamArgument {
    /// Standard output.
    Stdout,
    /// Standard error.
    Stderr,
}

/// The body of `scl log`.
pub(crate) fn log(arguments: &LogArguments) -> Result<ExitCode, Problem> {
    let system = find_system(arguments.system.as_deref())?;
    let folder = LogFolder::of(&system, &variable).ok_or_else(|| no_folder(&system))?;
    if !folder.components().contains(&arguments.component) {
        return Err(no_log(&system, &folder, &arguments.component));
    }
    let unreadable = |error| Problem::new(format!("cannot read the log of `{}`: {error}", arguments.component));
    let mut reader = LogReader::new(&folder, &arguments.component);
    let mut printer = Printer::new(arguments);
    print_existing(arguments, &mut reader, &mut printer).map_err(unreadable)?;
    // Follow until a signal ends the process or the reader closes the output.
    while arguments.follow && !output_is_closed() && !reader_has_gone() {
        match reader.next_entry().map_err(unreadable)? {
            Some(entry) => printer.print(&entry),
            None => sleep(LOOK),
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Prints the existing entries, or only the last of them.
fn print_existing(arguments: &LogArguments, reader: &mut LogReader, printer: &mut Printer) -> io::Result<()> {
    let kept = arguments.lines.or((arguments.follow && arguments.since.is_none()).then_some(LINES_BEFORE));
    let mut last = VecDeque::new();
    while let Some(entry) = reader.next_entry()?.filter(|_| !output_is_closed()) {
        match kept {
            None => printer.print(&entry),
            Some(kept) if printer.wants(&entry) => {
                last.push_back(entry);
                last.drain(..last.len().saturating_sub(kept));
            }
            Some(_) => {}
        }
    }
    last.iter().for_each(|entry| printer.print(entry));
    Ok(())
}

/// Writes entries, and says where another process of the component begins.
struct Printer {
    /// The earliest time that is asked for, as in the entries. Times in this form sort as text.
    earliest: Option<String>,
    stream: Option<StreamArgument>,
    is_json: bool,
    run: Option<u64>,
    /// Whether control characters are shown as escapes. In a pipe, programs get what was printed.
    escapes: bool,
}

impl Printer {
    fn new(arguments: &LogArguments) -> Self {
        let earliest = arguments.since.map(|since| {
            let now = SystemTime::now();
            timestamp(now.checked_sub(since).unwrap_or(SystemTime::UNIX_EPOCH))
        });
        let (is_json, escapes) = (arguments.format.is_json(), output_is_terminal());
        Self { earliest, stream: arguments.stream, is_json, run: None, escapes }
    }

    /// Whether the arguments select an entry.
    fn wants(&self, entry: &LogEntry) -> bool {
        let is_late = self.earliest.as_ref().is_none_or(|earliest| entry.time >= *earliest);
        is_late && self.stream.is_none_or(|stream| stream.is(entry.stream))
    }

    fn print(&mut self, entry: &LogEntry) {
        if self.wants(entry) {
            print_out(&self.text(entry));
        }
    }

    fn text(&mut self, entry: &LogEntry) -> String {
        if self.is_json {
            // Serializing strings and numbers cannot fail.
            return format!("{}\n", escape_json(&serde_json::to_string(entry).unwrap_or_default()));
        }
        let is_other = self.run.replace(entry.run).is_some_and(|run| run != entry.run);
        let run = if is_other { format!("-- process {} --\n", entry.run) } else { String::new() };
        let text = if self.escapes { escape(&entry.text) } else { entry.text.as_str().into() };
        let cut = if entry.cut_bytes > 0 { format!("… ({} bytes more)", entry.cut_bytes) } else { String::new() };
        format!("{run}{} {} {text}{cut}\n", entry.time, entry.stream.word())
    }
}

impl StreamArgument {
    fn is(self, stream: LogStream) -> bool {
        matches!((self, stream), (Self::Stdout, LogStream::Stdout) | (Self::Stderr, LogStream::Stderr))
    }
}

fn variable(name: &str) -> Option<OsString> {
    env::var_os(name)
}

/// The system that is meant, or the only one with logs.
fn find_system(name: Option<&str>) -> Result<String, Problem> {
    if let Some(chosen) = choose_system(name, &variable, &running_systems(), &system_of_folder)? {
        return Ok(chosen);
    }
    match &LogFolder::systems(&variable)[..] {
        [only] => Ok(only.clone()),
        [] => Err(Problem::new("no system has logs").help("`scl run` writes them")),
        several => Err(Problem::new("several systems have logs")
            .help(format!("name one: `--system {}`, or set `SCL_SYSTEM`", several[0]))
            .note(format!("systems: {}", quoted_list(several)))),
    }
}

fn no_folder(system: &str) -> Problem {
    Problem::new(format!("there are no logs of system `{}`", escape(system))).help(
        "set `HOME` or `XDG_STATE_HOME` to an absolute path, and name a system with letters, digits and underscores",
    )
}

fn no_log(system: &str, folder: &LogFolder, component: &str) -> Problem {
    let problem = Problem::new(format!("there is no log of component `{}` of system `{system}`", escape(component)));
    let components = folder.components();
    let names = || components.iter().map(String::as_str);
    let problem = problem.did_you_mean_or(component, names(), |problem| {
        problem.help("`scl run` writes logs of the components that it starts")
    });
    let problem = problem.note(format!("looked in `{}`", folder.path.display()));
    if components.is_empty() { problem } else { problem.note(format!("logs: {}", quoted_list(names()))) }
}
