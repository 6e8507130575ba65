//! Both ends of a variant, opened in a fixed order: the near end listens, the worker opens its end and reports that it
//! is open, the near end connects, and each end that sends waits for its subscriber.

use crate::components::{one_way, roundtrip};
use crate::ends::{Calls, Receiver, Sender};
use crate::engines::{self, FAR, NEAR, options};
use crate::raw::SocketPaths;
use crate::unix::FrameBuffer;
use crate::worker::{Worker, print_line, unknown_arguments};
use std::os::unix::net::{UnixListener as StdUnixListener, UnixStream as StdUnixStream};
use std::time::Duration;
use tokio::net::{UnixListener, UnixStream};
use zeromq::{PullSocket, PushSocket};

pub(crate) const CONNECT_TIMEOUT: Duration = Duration::from_secs(10);

/// The channel from the near end to the worker.
const PING: &str = "ping";
/// The channel back.
const PONG: &str = "pong";

/// A variant, and the settings that its two processes share.
#[derive(Clone, Copy)]
pub(crate) struct Setup<'a> {
    /// The variant's id: the transport or library, then the pattern, then the kind of calls, like `scl-pub-blocking`.
    pub(crate) id: &'a str,
    /// The scratch folder.
    pub(crate) folder: &'a str,
    /// The size of a message.
    pub(crate) bytes: usize,
    /// Whether the worker sends, too.
    pub(crate) is_round_trip: bool,
    /// Number of messages in a batch; only `libzmq-nodrop` needs it.
    #[cfg_attr(not(feature = "libzmq"), expect(dead_code, reason = "for `libzmq-nodrop`"))]
    pub(crate) batch: usize,
}

/// The end in the process that measures.
pub(crate) struct Near {
    /// Dropped first: the near end cleans up for both.
    pub(crate) worker: Worker,
    pub(crate) sender: Sender,
    receiver: Option<Receiver>,
    #[cfg(feature = "gateway")]
    _gateways: Option<Vec<Worker>>,
}

/// The end in the worker.
pub(crate) struct Far {
    pub(crate) receiver: Receiver,
    sender: Option<Sender>,
}

impl Near {
    /// Starts the worker with the given arguments, and connects to it.
    pub(crate) async fn open(setup: Setup<'_>, worker: &[&str]) -> scl::Result<Self> {
        let start_worker = || Worker::start_open(worker);
        #[cfg(feature = "gateway")]
        let gateways = (setup.id == "gateway").then(|| engines::start_gateways(setup.folder)).transpose()?;
        let (worker, sender, receiver) = match setup.engine() {
            "scl" | "ipc" | "tcp" | "shm" | "gateway" => {
                let worker = start_worker().await?;
                let (sender, receiver) = setup.open_client().await?;
                (worker, sender, receiver)
            }
            "unix" if setup.id.ends_with("-blocking") => {
                let listener = StdUnixListener::bind(setup.paths().path(PING))?;
                let worker = start_worker().await?;
                let (sender, receiver) = setup.split_blocking(listener.accept()?.0)?;
                (worker, sender, Some(receiver))
            }
            "unix" => {
                let listener = UnixListener::bind(setup.paths().path(PING))?;
                let worker = start_worker().await?;
                let (sender, receiver) = setup.split(listener.accept().await?.0);
                (worker, sender, Some(receiver))
            }
            "zeromq" if setup.id == "zeromq-push" => {
                let worker = start_worker().await?;
                let socket: PushSocket = setup.paths().connect(PING).await?;
                (worker, Sender::Zeromq(Box::new(socket)), None)
            }
            _ => {
                let library = setup.join(true)?;
                let mut sender = setup.sender(&library, PING).await?;
                let worker = start_worker().await?;
                let receiver = if setup.is_round_trip { Some(setup.receiver(&library, PONG).await?) } else { None };
                sender.ready().await?;
                (worker, sender, receiver)
            }
        };
        Ok(Self {
            worker,
            sender,
            receiver,
            #[cfg(feature = "gateway")]
            _gateways: gateways,
        })
    }

    /// Returns the sender, and the receiver of what the worker sends back.
    pub(crate) fn both(&mut self) -> scl::Result<(&mut Sender, &mut Receiver)> {
        Ok((&mut self.sender, self.receiver.as_mut().ok_or_else(one_way_only)?))
    }
}

impl Far {
    /// Opens the worker's end, reports that it is open, and waits for the subscriber if this end sends.
    pub(crate) async fn open(setup: Setup<'_>) -> scl::Result<Self> {
        let paths = setup.paths();
        let (receiver, mut sender) = match setup.engine() {
            "scl" | "ipc" | "tcp" | "shm" | "gateway" => setup.open_server().await?,
            "unix" if setup.id.ends_with("-blocking") => {
                let (sender, receiver) = setup.split_blocking(StdUnixStream::connect(paths.path(PING))?)?;
                (receiver, Some(sender))
            }
            "unix" => {
                let (sender, receiver) = setup.split(UnixStream::connect(paths.path(PING)).await?);
                (receiver, Some(sender))
            }
            "zeromq" if setup.id == "zeromq-push" => {
                let socket: PullSocket = paths.bind(PING).await?;
                (Receiver::Zeromq(Box::new(socket)), None)
            }
            _ => {
                let library = setup.join(false)?;
                let sender = if setup.is_round_trip { Some(setup.sender(&library, PONG).await?) } else { None };
                (setup.receiver(&library, PING).await?, sender)
            }
        };
        print_line("open")?;
        if let Some(sender) = &mut sender {
            sender.ready().await?;
        }
        #[cfg(feature = "libzmq")]
        if let Receiver::Libzmq(socket) = &receiver {
            // Wait without a timeout from now on: other variants take their turns between two batches.
            socket.set_rcvtimeo(-1)?;
        }
        Ok(Self { receiver, sender })
    }

    /// Returns the receiver, and the sender that sends back.
    pub(crate) fn both(&mut self) -> scl::Result<(&mut Receiver, &mut Sender)> {
        Ok((&mut self.receiver, self.sender.as_mut().ok_or_else(one_way_only)?))
    }
}

fn one_way_only() -> scl::Error {
    scl::Error::message("this variant sends in one direction only")
}

/// Opens a component of SCL, with async or without.
macro_rules! open {
    ($component:ty, $options:expr, $is_blocking:expr) => {
        if $is_blocking {
            <$component>::open_blocking_with($options)?
        } else {
            <$component>::open_with($options).await?
        }
    };
}

/// Opens a component of SCL and waits until its peer is connected.
macro_rules! connect {
    ($component:ty, $options:expr, $is_blocking:expr) => {{
        let component = open!($component, $options, $is_blocking);
        if $is_blocking {
            component.ready_blocking(CONNECT_TIMEOUT)?;
        } else {
            component.ready(CONNECT_TIMEOUT).await?;
        }
        component
    }};
}
pub(crate) use {connect, open};

impl Setup<'_> {
    /// The transport or library.
    fn engine(&self) -> &str {
        self.id.split('-').next().unwrap_or_default()
    }

    fn paths(&self) -> SocketPaths {
        SocketPaths::new(self.folder, self.id)
    }

    /// Opens the component of SCL that measures.
    async fn open_client(&self) -> scl::Result<(Sender, Option<Receiver>)> {
        let (calls, options) = (Calls::of(self.id), options(self.id, self.folder, NEAR));
        Ok(match (self.engine(), self.is_round_trip) {
            ("scl", true) => {
                let client = connect!(roundtrip::Client, options, calls.is_blocking);
                (Sender::Pub(client.ping, calls), Some(Receiver::Sub(client.pong, calls.is_blocking)))
            }
            (_, true) => {
                let client = connect!(engines::Client, options, calls.is_blocking);
                (Sender::Pub(client.ping, calls), Some(Receiver::Sub(client.pong, calls.is_blocking)))
            }
            ("scl", false) if self.id.contains("-push") => {
                (Sender::Push(connect!(one_way::Pusher, options, calls.is_blocking).jobs, calls), None)
            }
            ("scl", false) => (Sender::Pub(connect!(one_way::Source, options, calls.is_blocking).stream, calls), None),
            (_, false) => (Sender::Pub(connect!(engines::Source, options, calls.is_blocking).stream, calls), None),
        })
    }

    /// Opens the worker's component of SCL.
    async fn open_server(&self) -> scl::Result<(Receiver, Option<Sender>)> {
        let (calls, options) = (Calls::of(self.id), options(self.id, self.folder, FAR));
        let is_blocking = calls.is_blocking;
        Ok(match (self.engine(), self.is_round_trip) {
            ("scl", true) => {
                let echo = open!(roundtrip::Echo, options, is_blocking);
                (Receiver::Sub(echo.ping, is_blocking), Some(Sender::Pub(echo.pong, calls)))
            }
            (_, true) => {
                let echo = open!(engines::Echo, options, is_blocking);
                (Receiver::Sub(echo.ping, is_blocking), Some(Sender::Pub(echo.pong, calls)))
            }
            ("scl", false) if self.id.contains("-push") => {
                (Receiver::Pull(open!(one_way::Puller, options, is_blocking).jobs, is_blocking), None)
            }
            ("scl", false) => (Receiver::Sub(open!(one_way::Sink, options, is_blocking).stream, is_blocking), None),
            (_, false) => (Receiver::Sub(open!(engines::Sink, options, is_blocking).stream, is_blocking), None),
        })
    }

    fn split(&self, stream: UnixStream) -> (Sender, Receiver) {
        let (reading, writing) = stream.into_split();
        (Sender::Unix(writing), Receiver::Unix(reading, FrameBuffer::new(self.bytes)))
    }

    fn split_blocking(&self, stream: StdUnixStream) -> scl::Result<(Sender, Receiver)> {
        let writing = stream.try_clone()?;
        Ok((Sender::UnixBlocking(writing), Receiver::UnixBlocking(stream, FrameBuffer::new(self.bytes))))
    }
}

/// The state of a library that both ends of a process share.
enum Library {
    Sockets,
    #[cfg(feature = "shm")]
    Iceoryx(std::rc::Rc<crate::iceoryx::Participant>),
    #[cfg(feature = "gateway")]
    Zenoh(std::rc::Rc<crate::zenoh_peer::Peer>),
}

impl Setup<'_> {
    #[cfg_attr(not(feature = "gateway"), expect(unused_variables, reason = "one peer of zenoh listens"))]
    fn join(&self, is_near: bool) -> scl::Result<Library> {
        Ok(match self.engine() {
            #[cfg(feature = "shm")]
            "iceoryx" => Library::Iceoryx(crate::iceoryx::Participant::join()?),
            #[cfg(feature = "gateway")]
            "zenoh" => Library::Zenoh(crate::zenoh_peer::Peer::join(&self.paths().path("port"), is_near)?),
            _ => Library::Sockets,
        })
    }

    async fn sender(&self, library: &Library, channel: &str) -> scl::Result<Sender> {
        Ok(match library {
            #[cfg(feature = "shm")]
            Library::Iceoryx(participant) => {
                let (channel, copies) = (self.service(channel), self.id.contains("-copy"));
                Sender::Iceoryx(Box::new(participant.sending(&channel, self.bytes, copies)?))
            }
            #[cfg(feature = "gateway")]
            Library::Zenoh(peer) => Sender::Zenoh(peer.sending(&format!("bench/{channel}"))?),
            Library::Sockets => match self.engine() {
                "zeromq" => Sender::Xpub(self.paths().bind(channel).await?),
                #[cfg(feature = "libzmq")]
                "libzmq" if self.id == "libzmq-nodrop" => Sender::LibzmqNodrop(
                    crate::libzmq::start_lossless_publisher(&self.paths(), channel, self.bytes, self.batch).await?,
                ),
                #[cfg(feature = "libzmq")]
                "libzmq" => {
                    let (kind, mark) = crate::libzmq::sending_kind(self.id);
                    Sender::Libzmq(self.paths().bind_libzmq(channel, kind, mark)?)
                }
                _ => return Err(unknown_arguments(&[self.id])),
            },
        })
    }

    async fn receiver(&self, library: &Library, channel: &str) -> scl::Result<Receiver> {
        Ok(match library {
            #[cfg(feature = "shm")]
            Library::Iceoryx(participant) => {
                Receiver::Iceoryx(Box::new(participant.receiving(&self.service(channel))?))
            }
            #[cfg(feature = "gateway")]
            Library::Zenoh(peer) => Receiver::Zenoh(peer.receiving(&format!("bench/{channel}"))?),
            Library::Sockets => match self.engine() {
                "zeromq" => Receiver::Zeromq(Box::new(self.paths().connect_sub(channel).await?)),
                #[cfg(feature = "libzmq")]
                "libzmq" => {
                    let (kind, mark) = crate::libzmq::receiving_kind(self.id);
                    Receiver::Libzmq(self.paths().connect_libzmq(channel, kind, mark)?)
                }
                _ => return Err(unknown_arguments(&[self.id])),
            },
        })
    }

    /// The name of a channel of iceoryx2.
    #[cfg(feature = "shm")]
    fn service(&self, channel: &str) -> String {
        format!("{}/{}/{channel}", self.folder, self.id)
    }
}
