//! Carries what passes some connections, late or not while they are cut.
//!
//! Both programs of such a connection talk to the conductor. It reads between the turns of the programs, so that what a
//! program has sent in a turn has left it at the end of the turn.

mod link;

use crate::routes::Route;
use link::Link;
use rustix::event::{Timespec, epoll};
use rustix::io::Errno;
use std::io;
use std::mem::MaybeUninit;
use std::os::fd::OwnedFd;
use std::time::Duration;

/// The connections that the conductor carries.
#[derive(Debug)]
pub(crate) struct Network {
    seed: u64,
    routes: Vec<Watched>,
    /// In the order in which they were made.
    links: Vec<Link>,
    /// Tells when an end of a link can be read or written again.
    ready: OwnedFd,
    /// Number of links that were made.
    made: u64,
}

#[derive(Debug)]
struct Watched {
    route: Route,
    /// Up to when nothing passes it.
    cut_until: Duration,
    /// Number of links that were made on it.
    made: u64,
}

impl Network {
    pub(crate) fn new(seed: u64, routes: Vec<Route>) -> io::Result<Self> {
        let routes = routes.into_iter().map(|route| Watched { route, cut_until: Duration::ZERO, made: 0 }).collect();
        let ready = epoll::create(epoll::CreateFlags::CLOEXEC)?;
        Ok(Self { seed, routes, links: Vec::new(), ready, made: 0 })
    }

    /// Whether programs have to say to what they connect.
    pub(crate) fn is_of_use(&self) -> bool {
        !self.routes.is_empty()
    }

    /// Carries a connection that a component has made to the socket of this name, if it is one of the routes. Returns
    /// the end that the component uses from now on.
    pub(crate) fn join(&mut self, component: &str, endpoint: &str, connected: OwnedFd) -> io::Result<Option<OwnedFd>> {
        let is_it = |it: &Watched| it.route.component == component && it.route.endpoint == endpoint;
        let Some(index) = self.routes.iter().position(is_it) else { return Ok(None) };
        let it = &mut self.routes[index];
        let (link, own) = Link::new(self.made, index, &it.route, self.seed, it.made, connected)?;
        link.watch(&self.ready)?;
        (it.made, self.made) = (it.made + 1, self.made + 1);
        self.links.push(link);
        Ok(Some(own))
    }

    /// Lets nothing pass the connections of a component or gate for a while.
    pub(crate) fn cut(&mut self, target: &str, until: Duration) {
        for it in self.routes.iter_mut().filter(|it| it.route.ends_at(target)) {
            it.cut_until = it.cut_until.max(until);
        }
    }

    /// Takes what programs have sent, and gives what is due.
    pub(crate) fn carry(&mut self, now: Duration) -> io::Result<()> {
        if self.links.is_empty() {
            return Ok(());
        }
        self.look()?;
        for link in &mut self.links {
            link.carry(now, self.routes[link.route].cut_until);
        }
        self.links.retain(|link| !link.is_over());
        debug_assert!(self.due().is_none_or(|due| due > now), "what is due was given");
        Ok(())
    }

    /// When something has to be given next.
    pub(crate) fn due(&self) -> Option<Duration> {
        self.links.iter().filter_map(|link| link.due(self.routes[link.route].cut_until)).min()
    }

    fn look(&mut self) -> io::Result<()> {
        let mut events = [MaybeUninit::<epoll::Event>::uninit(); 64];
        loop {
            let found = match epoll::wait(&self.ready, &mut events, Some(&Timespec::default())) {
                Ok((found, _)) => found,
                Err(Errno::INTR) => continue,
                Err(error) => return Err(error.into()),
            };
            for event in &*found {
                let (number, end) = link::of_event(event.data.u64());
                if let Some(link) = self.links.iter_mut().find(|link| link.number == number) {
                    link.note(end, event.flags);
                }
            }
            if found.len() < events.len() {
                return Ok(());
            }
        }
    }
}
