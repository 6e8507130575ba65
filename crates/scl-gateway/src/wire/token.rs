//! The token of an end of a route, while it is open.

use super::command::{Command, Declared};
use super::keys::{self, Side};
use super::{Link, random};

#[derive(Debug)]
pub(super) struct EndToken {
    link: Link,
    key: String,
    side: Side,
    open: Option<Declared>,
}

impl EndToken {
    pub(super) fn new(link: &Link, key: &str, side: Side) -> Self {
        EndToken { link: link.clone(), key: key.to_owned(), side, open: None }
    }

    /// Declares or withdraws the token. Returns its new number if it was opened.
    pub(super) fn set_open(&mut self, open: bool) -> Option<u64> {
        if open == self.open.is_some() {
            return None;
        }
        if !open {
            self.open = None;
            return None;
        }
        let number = random();
        let key = keys::end_token(&self.key, self.side, &self.link.instance, number);
        self.open = Some(Declared::new(&self.link.commands, |id| Command::Token { id, key }));
        Some(number)
    }
}
