//! One side of a connection, of SCL or of what it is compared with.

use crate::components::restart::{Publisher, Puller, Pusher, Replier, Requester, Subscriber};
use crate::ends::{Calls, Receiver, Sender};
use crate::link::open;
use crate::raw::SocketPaths;
use crate::worker::unknown_arguments;
use scl::bytes::Bytes;
use scl::{Rep, Req};
use zeromq::PubSocket;

pub(super) enum Side {
    Sends(Sender),
    Receives(Receiver),
    Calls(Req<Bytes, Bytes>),
    Replies(Rep<Bytes, Bytes>),
}

impl Side {
    /// Opens the side that the variant `id` restarts (`scl-publisher`), or the one that survives.
    pub(super) async fn open(id: &str, is_restarted: bool, folder: &str) -> scl::Result<Self> {
        let (library, restarted) = id.split_once('-').ok_or_else(|| unknown_arguments(&[id]))?;
        let role = if is_restarted { restarted } else { opposite(restarted) };
        let options = scl::OpenOptions::new().runtime_dir(folder).system(id);
        let paths = SocketPaths::new(folder, id);
        #[cfg(feature = "libzmq")]
        let mark = crate::libzmq::HighWaterMark::Default;
        Ok(match (library, role) {
            ("scl", "publisher") => Self::Sends(Sender::Pub(open!(Publisher, options, false).stream, Calls::default())),
            ("scl", "subscriber") => Self::Receives(Receiver::Sub(open!(Subscriber, options, false).stream, false)),
            ("scl", "pusher") => Self::Sends(Sender::Push(open!(Pusher, options, false).stream, Calls::default())),
            ("scl", "puller") => Self::Receives(Receiver::Pull(open!(Puller, options, false).stream, false)),
            ("scl", "requester") => Self::Calls(open!(Requester, options, false).stream),
            ("scl", "replier") => Self::Replies(open!(Replier, options, false).stream),
            ("zeromq", "publisher") => Self::Sends(Sender::Zeromq(Box::new(paths.bind::<PubSocket>("stream").await?))),
            ("zeromq", "subscriber") => Self::Receives(Receiver::Zeromq(Box::new(paths.connect_sub("stream").await?))),
            #[cfg(feature = "libzmq")]
            ("libzmq", "publisher") => Self::Sends(Sender::Libzmq(paths.bind_libzmq("stream", zmq2::PUB, mark)?)),
            #[cfg(feature = "libzmq")]
            ("libzmq", "subscriber") => {
                Self::Receives(Receiver::Libzmq(paths.connect_libzmq("stream", zmq2::SUB, mark)?))
            }
            _ => return Err(unknown_arguments(&[id])),
        })
    }
}

fn opposite(role: &str) -> &str {
    let pairs = [["publisher", "subscriber"], ["pusher", "puller"], ["requester", "replier"]];
    let other = pairs.iter().find(|pair| pair.contains(&role)).and_then(|pair| pair.iter().find(|it| **it != role));
    other.copied().unwrap_or(role)
}
