//! Words of other tools, and what stands for them in a topology: one table for each place of a word.
//!
//! The words of the kinds of gate and of the codecs that other tools have stand in their own tables, as synonyms.

mod table;
mod values;

pub(crate) use table::Table;
use values::VALUES;

/// What people write who know another tool.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Habit {
    /// The words of other tools, in lower case, without `_` and `-`, and with spaces between them.
    words: &'static str,
    /// What to write, the most likely first: `key` in the place of the word, or `key: value` in that of its entry.
    pub ways: &'static [&'static str],
    /// In words, if there is nothing to write, or nothing fits.
    pub text: &'static str,
}

const fn habit(words: &'static str, ways: &'static [&'static str], text: &'static str) -> Habit {
    Habit { words, ways, text }
}

/// In the place of a section: ROS, dora, Docker Compose, Kubernetes, AUTOSAR, protobuf.
pub(crate) static SECTIONS: Table = Table::new(&[
    habit("nodes services modules processes programs tasks agents actors blocks units apps", &["components"], ""),
    habit("classes templates prototypes componenttypes componentclasses definitions defs", &["kinds"], ""),
    habit("all everybody everycomponent allcomponents injected", &["everyone"], ""),
    habit("links edges wires wiring routes bindings channels connectors", &["connections"], ""),
    habit("name systemname project robot namespace id title", &["system"], ""),
    habit(
        "proto protos protobuf protofiles messages import imports includes types",
        &["schemas"],
        "`schemas` lists the `.proto` files that define the messages",
    ),
    habit("includepaths includedirs includepath protopath protopaths importpaths schemapath", &["schema_roots"], ""),
    habit("encoding serialization serializer format rmw", &["codec"], ""),
    habit("version apiversion schemaversion formatversion edition", &["scl: 1"], ""),
    habit("topics subjects", &[], "there are no topics: each entry of `connections` joins two gates"),
    habit("spec metadata data topology graph", &[], "the sections stand at the top level, not inside another key"),
    habit(
        "launch environment env hosts networks volumes deploy machines transport",
        &[],
        "how and where programs are started stands in the launch file, not in the topology",
    ),
]);

/// In the place of a key of a component.
pub(crate) static COMPONENT: Table = Table::new(&[
    habit("id component node title label process service module", &["name"], ""),
    habit("ports pins interfaces endpoints sockets io topics channels slots", &["gates"], ""),
    habit("description comment desc summary documentation help note notes brief", &["doc"], ""),
    habit(
        "continueonerror allowfailure ignoreerrors ignorefailure besteffort mayfail",
        &["optional"],
        "`optional: true` says that peers do not wait for this component",
    ),
    habit("params config configuration arg rosparameters rosparams settings options properties", &["parameters"], ""),
    habit("mem memorylimit memlimit memorymax maxmemory memorybound ram", &["memory"], ""),
    habit(
        "required mandatory essential",
        &["optional: !"],
        "`optional: true` says that peers do not wait for this component",
    ),
    habit(
        "inputs subscribers subscriptions subscribes subscribe requires in sub",
        &[],
        "what a component receives are gates of kind `sub` in its `gates`; each entry of `connections` joins two gates",
    ),
    habit(
        "outputs publishers publications publishes publish provides out pub",
        &[],
        "what a component sends are gates of kind `pub` in its `gates`; each entry of `connections` joins two gates",
    ),
    habit(
        "services servers clients actions rpcs rpc",
        &[],
        "a service is a gate of kind `rep` in `gates`, and its client a gate of kind `req`",
    ),
    habit(
        "dependson depends after wants dependencies links needs waitfor",
        &[],
        "the order of start is not declared: each program waits for its peers, unless they are `optional: true`",
    ),
    habit(
        "command cmd exec executable entrypoint args arguments run program binary image plugin package pkg build path",
        &[],
        "which program runs a component stands in the launch file, as its `command`",
    ),
    habit(
        "env environment envfile variables",
        &[],
        "the environment of a program stands in the launch file, as its `environment`",
    ),
    habit(
        "restart respawn restartpolicy restartdelay respawndelay",
        &[],
        "when a program is started again stands in the launch file, as its `restart`",
    ),
    habit(
        "priority nice scheduler schedpolicy cpu cpus cores affinity core",
        &[],
        "processors and priority of a program stand in the launch file, as `cpu` and `priority`",
    ),
    habit(
        "healthcheck watchdog livenessprobe readinessprobe heartbeat",
        &[],
        "signs of life are required in the launch file, by `alive_within` and `ready_within`",
    ),
    habit(
        "host machine hostname address port url network networks",
        &[],
        "where a component runs stands in the launch file, under `hosts`",
    ),
    habit(
        "workingdir workdir workingdirectory cwd user volumes",
        &[],
        "how a program is started stands in the launch file, for example its `working_directory`",
    ),
    habit(
        "namespace ns",
        &[],
        "there are no namespaces: each component has a name of its own, for example `left_camera`",
    ),
    habit(
        "count replicas instances scale number",
        &[],
        "each program that runs is a component with a name of its own; components of one `kind` share their gates",
    ),
    habit(
        "type class template extends inherits instanceof is a",
        &["kind"],
        "`kind` gives a component the gates of one of the `kinds`",
    ),
    habit(
        "stacksize stack language",
        &[],
        "a component has only a name, gates and a text; what its program does stands in the program",
    ),
    habit("period rate frequency", &[], "`rate` and `period` are options of a gate that sends"),
]);

/// In the place of an option of a gate: ROS, DDS, ZeroMQ, MQTT, Kafka, gRPC, AsyncAPI.
pub(crate) static GATE: Table = Table::new(&[
    habit(
        "queuesize depth hwm rcvhwm sndhwm qsize queuelength queuelen queuedepth capacity buffer buffersize bufferlength backlog maxlen historydepth prefetch keeplast fifosize",
        &["queue"],
        "",
    ),
    habit("size maxsize", &["queue", "max_size"], ""),
    habit(
        "onfull overflow overflowpolicy droppolicy policy whenoverflow congestioncontrol iffull onoverflow discard discardpolicy leaky onoverrun overrun",
        &["when_full"],
        "",
    ),
    habit(
        "reliability qos history delivery guarantee",
        &["when_full"],
        "`queue` says how many messages may wait for a receiver, and `when_full` what happens to the others: losing the \
         oldest is the default, and `when_full: wait` loses none, if the sender has `backpressure: true`",
    ),
    habit(
        "reliable blocking block lossless flowcontrol",
        &["backpressure", "when_full: wait"],
        "a receiver with `when_full: wait` loses no message, if its sender has `backpressure: true`",
    ),
    habit("besteffort lossy conflate latestonly", &["queue: 1"], "`queue: 1` keeps only the newest message"),
    habit(
        "retain retained latch latching sticky persistent transientlocal durability durable islatched keep cached",
        &["latched"],
        "a publisher with `latched: true` keeps its last message for subscribers that join later",
    ),
    habit(
        "requesttimeout calltimeout responsetimeout rpctimeout timeoutms timeouts replytimeout maxwait rcvtimeo wait",
        &["timeout"],
        "",
    ),
    habit(
        "maxmessagesize maxmsgsize maxbytes messagesize sizelimit maxpayload maxpayloadsize maxlength limit msgsize bytes maxrequestsize",
        &["max_size"],
        "",
    ),
    habit(
        "maxinflight concurrency pipelining maxrequests parallel window maxinflightrequests outstanding concurrentrequests",
        &["in_flight"],
        "",
    ),
    habit("encoding serialization serializer format contenttype mimetype encoder wireformat mediatype", &["codec"], ""),
    habit("description comment desc summary documentation help note brief title", &["doc"], ""),
    habit("ondecodeerror onerror ondecodingerror errorpolicy invalid malformed oninvalid", &["undecodable"], ""),
    habit(
        "optional required mandatory",
        &[],
        "`optional: true` stands at the component that may be missing, beside its `name`: peers do not wait for it; a \
         gate without a peer has `unconnected: ok`",
    ),
    habit("allowunconnected mayunconnected unused open", &["unconnected: ok"], ""),
    habit("shared loadbalance loadbalancing roundrobin competing", &["share"], ""),
    habit(
        "group consumergroup queuegroup groupid",
        &[],
        "pullers share the work of a `push` gate that has `share: true`; groups need no name",
    ),
    habit(
        "topic name channel subject remap key path address endpoint bind connect port url host from to source target peer connection connections connectedto",
        &[],
        "gates need no topics and no addresses: an entry of `connections` joins two gates, `[component.gate, component.gate]`",
    ),
    habit("frequency hz ratehz fps publishrate samplerate", &["rate"], ""),
    habit("interval cycle cycletime every periodms publishperiod", &["period"], ""),
    habit("maxperiod maxinterval", &["deadline"], ""),
    habit(
        "age maxage lifespan ttl lifetime expiry expires expiration stale staleafter freshness validity",
        &["max_age"],
        "",
    ),
    habit("retries retry maxretries attempts backoff", &[], "there is no option for retries: the program calls again"),
    habit(
        "type msgtype msg message messagetype schema datatype payload interface",
        &[],
        "the type is the value of the kind, as in `pub: package.Message`",
    ),
    habit(
        "kind direction role pattern dir mode",
        &[],
        "the kind is a key, with the type as its value, as in `pub: package.Message`",
    ),
    habit("priority security encryption auth partition ordering unit", &[], "there is no such option"),
    habit(
        "transport protocol shm ipc tcp udp",
        &[],
        "the transport of a connection stands in the launch file, under `transports`",
    ),
]);

/// Parts of the names that other tools have for options, of which each word may be a part of a longer one:
/// `max_nb_message`, `rx-buffers`.
static PARTS: Table = Table::new(&[
    habit(
        "queue queued buffer buffers buffered message messages msg msgs sample samples depth backlog mailbox fifo hwm capacity",
        &["queue"],
        "",
    ),
    habit("size", &["queue", "max_size"], ""),
    habit("bytes", &["max_size"], ""),
    habit("timeout", &["timeout"], ""),
    habit("deadline", &["deadline"], ""),
    habit("rate frequency", &["rate"], ""),
    habit("period interval", &["period"], ""),
    habit("inflight outstanding concurrent concurrency", &["in_flight"], ""),
    habit("full overflow overrun policy drop discard", &["when_full"], ""),
    habit("latched latch retain retained durability", &["latched"], ""),
]);

const ACTION: &str = "an action is a `rep` gate for its goal, and a `pub` gate for its feedback";

/// In the place of the kind of a gate, without a kind that is the same.
pub(crate) static KINDS: Table = Table::new(&[
    habit("actionserver", &["rep"], ACTION),
    habit("actionclient", &["req"], ACTION),
    habit("action feedback", &[], ACTION),
    habit(
        "dealer router pair bus xpub xsub stream duplex bidirectional inout io",
        &[],
        "a gate has one direction: two gates are needed for both; `req` and `rep` may have several calls in progress",
    ),
    habit(
        "parameter param property field variable",
        &[],
        "a value that others read is sent by a `pub` gate with `latched: true`; one that others set is a `rep` gate",
    ),
    habit("timer cron signal event", &[], "there are only gates for messages; timers are the program's"),
]);

/// In the place of a codec: others that do nearly the same.
pub(crate) static CODECS: Table = Table::new(&[
    habit("bincode bitcode borsh ron", &["postcard"], ""),
    habit("bson ubjson smile", &["cbor"], ""),
    habit(
        "xml yaml toml csv flatbuffers capnp capnproto avro cdr thrift asn1 dds",
        &[],
        "scl has no such codec; a codec of your own is a Rust type, named by its path",
    ),
]);

impl Habit {
    fn words(&self) -> impl Iterator<Item = &'static str> {
        self.words.split(' ')
    }

    fn has(&self, word: &str) -> bool {
        self.words().any(|other| other == word)
    }

    /// Whether the words stand before the type of a gate.
    pub(crate) fn is_type(&self) -> bool {
        self.has("msgtype")
    }

    /// The kind of the gates that other tools list under these words.
    pub(crate) fn port(&self) -> Option<&'static str> {
        let kinds = [("inputs", "sub"), ("outputs", "pub")];
        kinds.into_iter().find(|(word, _)| self.has(word)).map(|(_, kind)| kind)
    }

    /// Whether the words stand before the kind of a gate.
    pub(crate) fn is_kind(&self) -> bool {
        self.has("direction")
    }
}

/// The habit that a part of a longer name of an option comes from, the last part first.
pub(crate) fn of_part(key: &str) -> Option<&'static Habit> {
    let hump = |pair: (char, char)| pair.0.is_lowercase() && pair.1.is_uppercase();
    let mut words = String::new();
    let mut before = ' ';
    for letter in key.chars() {
        words.extend(hump((before, letter)).then_some('_'));
        words.push(letter);
        before = letter;
    }
    words.rsplit(['_', '-', ' ', '.']).find_map(|word| PARTS.find(word))
}

/// The habit that a value of an option comes from.
pub(crate) fn of_value(option: &str, word: &str) -> Option<&'static Habit> {
    let (_, table) = VALUES.iter().find(|(key, _)| *key == option)?;
    table.find(word)
}

/// Other names of the key `file` in an entry of `include`, as [`compact`] makes them.
pub(crate) const FILE: [&str; 8] = ["path", "filename", "source", "src", "from", "include", "topology", "yaml"];

/// `true` or `false` in the words of other formats.
pub(crate) fn boolean(word: &str) -> Option<&'static str> {
    scl_text::suggest::boolean(&compact(word))
}

/// A word in lower case, without the marks between its parts: `DropOldest` and `drop-oldest` are the same.
pub(crate) fn compact(word: &str) -> String {
    word.chars().filter(|letter| !matches!(letter, '_' | '-' | ' ')).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::{CODECS, COMPONENT, GATE, KINDS, PARTS, SECTIONS, Table, VALUES, compact};
    use crate::grammar::{self, Codec, GateKind, OPTIONS, option};

    /// Checks the words of a table; `known` are those that mean something at their place.
    fn check(place: &str, table: &Table, known: &[&str], takes: impl Fn(&str) -> bool) {
        let mut seen: Vec<&str> = Vec::new();
        for habit in table.habits() {
            assert!(!habit.ways.is_empty() || !habit.text.is_empty(), "{place}: {:?}", habit.words);
            for word in habit.words() {
                assert_eq!(*word, compact(word), "{place}");
                assert!(!known.contains(&word), "{place}: `{word}` is right there");
                assert!(!seen.contains(&word), "{place}: `{word}` twice");
                seen.push(word);
            }
            habit.ways.iter().for_each(|way| assert!(takes(way), "{place}: {way}"));
        }
    }

    #[test]
    fn habits_are_unknown_words_and_lead_to_known_ones() {
        let sections = grammar::words(&grammar::SECTIONS);
        let keys = grammar::words(&grammar::COMPONENT_KEYS);
        let options: Vec<&str> = OPTIONS.iter().map(|option| option.key).collect();
        let key = |way: &str| way.split(": ").next().unwrap_or(way).to_owned();
        check("section", &SECTIONS, &sections, |way| sections.contains(&key(way).as_str()));
        check("component", &COMPONENT, &keys, |way| keys.contains(&key(way).as_str()));
        check("kind", &KINDS, &GateKind::ALL.map(GateKind::word), |way| GateKind::of(way).is_some());
        check("codec", &CODECS, &Codec::words().collect::<Vec<_>>(), |way| Codec::of(way).is_some());
        check("gate", &GATE, &options, |way| options.contains(&key(way).as_str()));
        check("part", &PARTS, &[], |way| options.contains(&key(way).as_str()));
        for (of, table) in &VALUES {
            let shape = option(of).map_or(grammar::MEMORY_SHAPE, |option| option.shape);
            check(of, table, &[], |way| shape.fits(way, true));
        }
    }
}
