//! Plain iceoryx2 as its users write it: publish and subscribe, and an event for each message that wakes the receiver.
//!
//! Loaned payloads are never initialised, which is the point of loaning. The time of a message is in its header, so
//! that receivers do not read the payload either.

use iceoryx2::node::{Node, NodeBuilder};
use iceoryx2::port::listener::Listener;
use iceoryx2::port::notifier::Notifier;
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::{Config, SignalHandlingMode, ipc};
use iceoryx2::sample::Sample;
use std::mem::MaybeUninit;
use std::rc::Rc;
use std::time::Duration;

/// Messages that a subscriber's buffer holds.
const BUFFER: usize = 16;

/// How long cleaning up after killed workers may take.
const CLEANUP_TIMEOUT: Duration = Duration::from_secs(1);

/// The bytes of a message.
pub(crate) type Payload = [MaybeUninit<u8>];

/// A received message. Its header is the time at which it was sent.
pub(crate) type Received = Sample<ipc::Service, Payload, u64>;

/// The iceoryx2 node of this process. When dropped, it removes what killed workers have left in shared memory.
pub(crate) struct Participant(Node<ipc::Service>);

/// The sending end of a channel.
pub(crate) struct Sending {
    publisher: Publisher<ipc::Service, Payload, u64>,
    notifier: Notifier<ipc::Service>,
    /// The payload that is copied into each message; `None` if messages are loaned.
    copied: Option<Vec<MaybeUninit<u8>>>,
    /// Dropped last, because it cleans up.
    _participant: Rc<Participant>,
}

/// The receiving end of a channel.
pub(crate) struct Receiving {
    subscriber: Subscriber<ipc::Service, Payload, u64>,
    listener: Listener<ipc::Service>,
    _participant: Rc<Participant>,
}

impl Participant {
    pub(crate) fn join() -> scl::Result<Rc<Self>> {
        // Ignore configuration files, and clean up only at the end: two workers starting at once would both clean up.
        let mut config = Config::default();
        config.global.node.cleanup_dead_nodes_on_creation = false;
        config.global.service.cleanup_dead_nodes_on_open = false;
        let node = NodeBuilder::new().config(&config).signal_handling_mode(SignalHandlingMode::Disabled);
        Ok(Rc::new(Self(node.create::<ipc::Service>()?)))
    }

    /// Opens the sending end of a channel for messages of up to `bytes` bytes, which are copied if `copies` is true and
    /// loaned otherwise.
    pub(crate) fn sending(self: &Rc<Self>, channel: &str, bytes: usize, copies: bool) -> scl::Result<Sending> {
        let messages = self.messages(channel)?;
        let publisher = messages.publisher_builder().initial_max_slice_len(bytes).create()?;
        let notifier = self.events(channel)?.notifier_builder().create()?;
        let copied = copies.then(|| vec![MaybeUninit::new(7); bytes]);
        Ok(Sending { publisher, notifier, copied, _participant: Rc::clone(self) })
    }

    pub(crate) fn receiving(self: &Rc<Self>, channel: &str) -> scl::Result<Receiving> {
        let listener = self.events(channel)?.listener_builder().create()?;
        let subscriber = self.messages(channel)?.subscriber_builder().create()?;
        Ok(Receiving { subscriber, listener, _participant: Rc::clone(self) })
    }

    fn messages(
        &self,
        channel: &str,
    ) -> scl::Result<iceoryx2::service::port_factory::publish_subscribe::PortFactory<ipc::Service, Payload, u64>> {
        let name = format!("{channel}/messages").as_str().try_into()?;
        let service = self.0.service_builder(&name).publish_subscribe::<Payload>().user_header::<u64>();
        // With overflow disabled, the sender waits instead of losing messages.
        let service = service.max_publishers(1).max_subscribers(1).enable_safe_overflow(false).history_size(0);
        Ok(service.subscriber_max_buffer_size(BUFFER).open_or_create()?)
    }

    fn events(&self, channel: &str) -> scl::Result<iceoryx2::service::port_factory::event::PortFactory<ipc::Service>> {
        Ok(self.0.service_builder(&format!("{channel}/events").as_str().try_into()?).event().open_or_create()?)
    }
}

impl Drop for Participant {
    fn drop(&mut self) {
        let _state = self.0.blocking_cleanup_dead_nodes(CLEANUP_TIMEOUT);
    }
}

impl Sending {
    /// Sends a message. An end that copies sends a copy of `received` or of its own payload; an end that loans sends
    /// `bytes` bytes of whatever the memory contains.
    pub(crate) fn send(&self, bytes: usize, received: Option<&Payload>, time: u64) -> scl::Result<()> {
        let loan = |bytes| self.publisher.loan_slice_uninit(bytes);
        let mut sample = match (&self.copied, received) {
            (Some(_), Some(received)) => loan(received.len())?.write_from_slice(received),
            (Some(own), None) => loan(own.len())?.write_from_slice(own),
            // `uninit` writes nothing, so an optimised build contains no loop.
            (None, _) => loan(bytes)?.write_from_fn(|_| MaybeUninit::uninit()),
        };
        *sample.user_header_mut() = time;
        sample.send()?;
        self.notifier.notify()?;
        Ok(())
    }
}

impl Receiving {
    /// Waits for the next message.
    pub(crate) fn receive(&self) -> scl::Result<Received> {
        loop {
            if let Some(sample) = self.subscriber.receive()? {
                return Ok(sample);
            }
            self.listener.blocking_wait(|_| {})?;
        }
    }
}
