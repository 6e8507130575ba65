//! Takes over the terminal, and restores it on every exit path.
#![allow(clippy::disallowed_methods, reason = "the library that draws writes to the terminal")]

use crossterm::cursor::Show;
use crossterm::execute;
use crossterm::terminal::{
    Clear, ClearType, EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode, size,
};
use ratatui::backend::CrosstermBackend;
use ratatui::layout::Rect;
use ratatui::{Frame, Terminal, TerminalOptions, Viewport};
use std::io::{self, Stdout, stdout};
use std::panic;

/// The terminal in raw mode and with its alternate screen. Dropping it restores the terminal.
pub(super) struct Screen {
    terminal: Terminal<CrosstermBackend<Stdout>>,
    size: (u16, u16),
}

impl Screen {
    /// Takes the terminal over. A panic restores it before its message is printed.
    pub(super) fn enter() -> io::Result<Self> {
        let print = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            restore();
            print(info);
        }));
        take_over().and_then(|()| Self::of_size(size()?)).inspect_err(|_| restore())
    }

    /// Draws, in the size that the terminal has now.
    pub(super) fn draw(&mut self, draw: impl FnOnce(&mut Frame<'_>)) -> io::Result<()> {
        let now = size()?;
        if now != self.size {
            execute!(stdout(), Clear(ClearType::All))?;
            self.terminal = Self::terminal(now)?;
            self.size = now;
        }
        self.terminal.draw(draw).map(drop)
    }

    /// Restores the terminal while `pause` runs, then takes it over again; the next frame is drawn in full.
    pub(super) fn leave_during(&mut self, pause: impl FnOnce()) -> io::Result<()> {
        restore();
        pause();
        take_over()?;
        self.terminal = Self::terminal(self.size)?;
        Ok(())
    }

    fn of_size(size: (u16, u16)) -> io::Result<Self> {
        Ok(Self { terminal: Self::terminal(size)?, size })
    }

    /// Creates a terminal of a fixed size. If ratatui followed the size by itself, it would ask the terminal for the
    /// cursor position, and wait for an answer that the thread for keys reads.
    fn terminal((width, height): (u16, u16)) -> io::Result<Terminal<CrosstermBackend<Stdout>>> {
        let viewport = Viewport::Fixed(Rect::new(0, 0, width, height));
        Terminal::with_options(CrosstermBackend::new(stdout()), TerminalOptions { viewport })
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        restore();
    }
}

fn take_over() -> io::Result<()> {
    enable_raw_mode()?;
    execute!(stdout(), EnterAlternateScreen)
}

fn restore() {
    // Ignore errors and try the rest: the terminal may be gone.
    let _ = disable_raw_mode();
    let _ = execute!(stdout(), LeaveAlternateScreen, Show);
}
