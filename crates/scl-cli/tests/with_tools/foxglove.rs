//! `scl foxglove`, with the protocol's client for JavaScript.

#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../parameters.rs"]
mod parameters;

use crate::npm;
use crate::rover::Rover;
use crate::system::{ChildGuard, SpawnGuarded};
use scl_needs::needs;
use scl_value::{MessageType, to_json};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

/// A client, what it has been told, and functions for scripts.
const CLIENT: &str = r#"
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const socket = new (require("ws").WebSocket)(process.argv[1], ["foxglove.sdk.v1"]);
socket.binaryType = "arraybuffer";
const client = new FoxgloveClient({ ws: socket });
const topics = {}, services = {}, shown = new Map(), waiting = [];
const events = [];
const happened = (event) => { events.push(event); waiting.slice().forEach((look) => look(event)); };
const text = (value) => JSON.stringify(value, (_, it) => typeof it === "bigint" ? String(it) : it);
setTimeout(() => { console.error("nothing more has happened than", text(events.slice(-20))); process.exit(1); }, 120_000);
// The first event, from now on, for which `found` returns something.
const until = (found) => new Promise((resolve) => {
  const look = (event) => {
    const result = found(event);
    if (result === undefined) return;
    waiting.splice(waiting.indexOf(look), 1);
    resolve(result);
  };
  waiting.push(look);
  look({});
});
client.on("advertise", (channels) => { channels.forEach((it) => { topics[it.topic] = it; }); happened({}); });
client.on("unadvertise", (ids) => ids.forEach((id) => Object.values(topics).filter((it) => it.id === id).forEach((it) => delete topics[it.topic])));
client.on("advertiseServices", (all) => { all.forEach((it) => { services[it.name] = it; }); happened({}); });
for (const name of ["serverInfo", "status", "parameterValues", "serviceCallResponse", "serviceCallFailure", "connectionGraphUpdate", "error"])
  client.on(name, (event) => happened({ [name]: event }));
client.on("message", ({ subscriptionId, timestamp, data }) =>
  happened({ message: { topic: shown.get(subscriptionId), timestamp, data: Buffer.from(data.buffer, data.byteOffset, data.byteLength) } }));
const bytes = (value) => new Uint8Array(Buffer.from(JSON.stringify(value)));
const topic = (name) => until(() => topics[name]);
const show = async (name) => { const { id } = await topic(name); shown.set(client.subscribe(id), name); };
const message = async (name) => { await show(name); return until(({ message }) => message?.topic === name ? message : undefined); };
const call = async (name, request) => {
  const { id } = await until(() => services[name]);
  client.sendServiceCallRequest({ serviceId: id, callId: 1, encoding: "json", data: new DataView(bytes(request).buffer) });
  return until(({ serviceCallResponse: done, serviceCallFailure: failed }) =>
    failed?.message ?? (done && JSON.parse(new TextDecoder().decode(done.data))));
};
const publish = (name, value, encoding = "json") => {
  const id = client.advertise({ topic: name, encoding, schemaName: "" });
  client.sendMessage(id, bytes(value));
  return id;
};
// The client does not know yet what is told of a recording that is played.
const known = socket.onmessage;
socket.onmessage = (event) => {
  const view = typeof event.data !== "string" && new DataView(event.data);
  if (!view || view.getUint8(0) !== 5) return known(event);
  happened({ state: { status: view.getUint8(1), time: view.getBigUint64(2, true), speed: view.getFloat32(10, true) } });
};
// Play (0) or pause (1), at this speed, from here or from a time; the request is called `a`.
const control = (command, speed, to) => {
  const request = new DataView(new ArrayBuffer(20));
  [[0, 3], [1, command], [6, to === undefined ? 0 : 1], [15, 1], [19, 97]].forEach(([at, byte]) => request.setUint8(at, byte));
  request.setFloat32(2, speed, true);
  request.setBigUint64(7, to ?? 0n, true);
  socket.send(request);
  return until((it) => it.state);
};
const info = until(({ serverInfo }) => serverInfo);
client.on("open", async () => {
  const result = await (async () => { SCRIPT })();
  console.log(text(result));
  process.exit(0);
});
client.on("error", (error) => { console.error(error); process.exit(1); });
"#;

/// A running `scl foxglove`.
struct Foxglove {
    address: String,
    process: ChildGuard,
}

impl Foxglove {
    fn start(rover: &Rover, arguments: &[&str]) -> Self {
        Self::of(&mut scl_foxglove(rover, &[&["--port", "0"], arguments].concat()))
    }

    fn of(command: &mut Command) -> Self {
        let mut process = command.stdout(Stdio::piped()).spawn_guarded();
        let mut address = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut address).unwrap();
        Self { address: address.trim().to_owned(), process }
    }

    /// Runs JavaScript with a client, and returns what it returns.
    #[track_caller]
    fn run(&self, script: &str) -> Value {
        let packages = [npm::installed("@foxglove/ws-protocol", "0.8.0"), npm::installed("ws", "8.18.3")];
        let mut node = Command::new("node");
        node.arg("-e").arg(CLIENT.replace("SCRIPT", script)).arg(&self.address);
        let output = node.env("NODE_PATH", std::env::join_paths(packages).unwrap()).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{script}: {error}");
        serde_json::from_slice(&output.stdout).unwrap_or_else(|problem| panic!("{script}: {problem}: {error}"))
    }
}

/// `scl foxglove`, whose program the workspace has built beside `scl`.
fn scl_foxglove(rover: &Rover, arguments: &[&str]) -> Command {
    let program = Path::new(env!("CARGO_BIN_EXE_scl")).with_file_name("scl-foxglove");
    assert!(program.is_file(), "`{}` is missing; run `cargo build -p scl-foxglove` first", program.display());
    rover.scl(&[&["foxglove"], arguments].concat())
}

#[test]
#[needs("node", "npm")]
fn panels_get_topics_with_schemas_and_what_they_show() {
    let rover = Rover::start();
    let foxglove = Foxglove::start(&rover, &[]);
    let channel = |name: &str| {
        let script =
            format!("const it = await topic('{name}'); return [it.encoding, it.schemaName, it.schemaEncoding];");
        foxglove.run(&script)
    };
    assert_eq!(channel("/sensor/measurements"), json!(["protobuf", "rover.Measurement", "protobuf"]));
    assert_eq!(channel("/sensor/position"), json!(["json", "rover.Position", "jsonschema"]));
    assert_eq!(channel("/controller/commands/request"), json!(["protobuf", "rover.Command", "protobuf"]));
    assert_eq!(channel("/controller/commands/reply"), json!(["protobuf", "rover.Status", "protobuf"]));
    assert_eq!(channel("/logger/events"), json!(["protobuf", "rover.Event", "protobuf"]));
    assert_eq!(channel("/sensor/image")[0], "raw");

    let read = foxglove.run(
        "const { timestamp, data } = await message('/sensor/measurements');
         const position = await message('/sensor/position');
         return { speed: data.readDoubleLE(1), field: data[0], position: JSON.parse(position.data),
                  age: (BigInt(Date.now()) * 1000000n - timestamp) / 1000000n };",
    );
    assert_eq!(read["field"], 9, "{read}");
    assert!(read["position"]["latitude"].is_number(), "{read}");
    let age: i64 = read["age"].as_str().unwrap().parse().unwrap();
    assert!((-1..600_000).contains(&age), "{read}");

    let graph = foxglove.run(
        "client.subscribeConnectionGraph();
         return await until(({ connectionGraphUpdate: it }) => it?.publishedTopics.length ? it : undefined);",
    );
    let published = graph["publishedTopics"].as_array().unwrap();
    assert!(published.contains(&json!({"name": "/sensor/measurements", "publisherIds": ["sensor"]})), "{graph}");
    let events = published.iter().find(|it| it["name"] == "/logger/events").unwrap();
    let mut senders: Vec<_> =
        events["publisherIds"].as_array().unwrap().iter().map(|id| id.as_str().unwrap()).collect();
    senders.sort_unstable();
    assert_eq!(senders, ["controller", "sensor"], "{graph}");
    let subscribed = graph["subscribedTopics"].as_array().unwrap();
    assert!(subscribed.contains(&json!({"name": "/logger/events", "subscriberIds": ["logger"]})), "{graph}");
    let services = json!([{"name": "/controller/commands", "providerIds": ["controller"]}]);
    assert_eq!(graph["advertisedServices"], services, "{graph}");
}

#[test]
#[needs("node", "npm")]
fn a_component_that_starts_later_appears() {
    let mut rover = Rover::stopped();
    let foxglove = Foxglove::start(&rover, &["--system", "rover"]);
    rover.play_alone("sensor");
    assert_eq!(foxglove.run("return (await message('/sensor/measurements')).data[0];"), 9);
}

/// The messages of codecs that panels do not know, sent by `scl pub`.
#[test]
#[needs("node", "npm")]
fn cbor_and_messagepack_are_sent_as_json() {
    for codec in ["cbor", "msgpack"] {
        let rover = Rover::of(&format!(
            "system: rover\ncomponents:\n  - name: sensor\n    gates:\n      \
             - position: {{pub: Position, codec: {codec}, unconnected: ok}}\n"
        ));
        let position = r#"{"latitude": 1.5, "longitude": -2.5, "fix": "good"}"#;
        let _sender = rover.scl(&["pub", "sensor.position", position, "--rate", "20"]).spawn_guarded();
        let foxglove = Foxglove::start(&rover, &["--system", "rover"]);
        let read = foxglove.run(
            "const { encoding, schemaName } = await topic('/sensor/position');
             return { encoding, schemaName, message: JSON.parse((await message('/sensor/position')).data) };",
        );
        let message = json!({"latitude": 1.5, "longitude": -2.5, "fix": "good"});
        assert_eq!(read, json!({"encoding": "json", "schemaName": "Position", "message": message}));
    }
}

#[test]
#[needs("node", "npm")]
fn topics_for_maps_and_3d_are_made_of_messages() {
    let rover = Rover::start();
    rover.write(
        "panels.yaml",
        "/rover/place: {from: /sensor/position, schema: foxglove.LocationFix,
            message: {frame_id: start, latitude: =latitude, longitude: =longitude}}\n\
         /rover/nowhere: {from: /sensor/positions, schema: foxglove.LocationFix, message: {}}\n\
         /rover/turn: {from: /sensor/position, schema: foxglove.FrameTransform, message: {rotation: =quaternion(fix)}}\n\
         /rover/wrong: {from: /sensor/position, schema: foxglove.LocationFix, message: {latitude: =latitud}}\n",
    );
    let mut started = scl_foxglove(&rover, &["--port", "0", "--topics", "panels.yaml"]);
    let mut foxglove = Foxglove::of(started.stderr(Stdio::piped()));
    let place = foxglove.run(
        "await show('/rover/turn');
         const { timestamp, data } = await message('/rover/place');
         const { encoding, schemaName, schemaEncoding, schema } = await topic('/rover/place');
         return [[encoding, schemaName, schemaEncoding], [...Buffer.from(schema, 'base64')], [...data], timestamp];",
    );
    assert_eq!(place[0], json!(["protobuf", "foxglove.LocationFix", "protobuf"]));
    let bytes = |value: &Value| serde_json::from_value::<Vec<u8>>(value.clone()).unwrap();
    let messages = MessageType::new(Some("foxglove.LocationFix"), "protobuf", Some(&bytes(&place[1]))).unwrap();
    let read: Value = serde_json::from_str(&to_json(&messages.decode(&bytes(&place[2])).unwrap())).unwrap();
    assert_eq!(read["frame_id"], "start", "{read}");
    assert!(read["latitude"].as_f64().unwrap() > 0.0, "{read}");
    let nanoseconds: u64 = place[3].as_str().unwrap().parse().unwrap();
    let text = read["timestamp"].as_str().unwrap();
    assert!(
        text.ends_with(&format!("{:09}Z", nanoseconds % 1_000_000_000)) || nanoseconds.is_multiple_of(1000),
        "{text}"
    );
    let mut notes = BufReader::new(foxglove.process.stderr.take().unwrap()).lines().map(Result::unwrap);
    for expected in [
        "error: message `rover.Position` has no field `latitud`",
        " --> topic `/rover/wrong`, made of /sensor/position",
        "  = help: did you mean `latitude`?",
        "  = note: its fields: `latitude`, `longitude`, `fix`",
        "note: nothing that runs sends what is needed for `/rover/nowhere`, which is made of /sensor/positions",
        "note: a message of /sensor/position is not sent as `/rover/turn`: field `fix` has no numbers `x`, `y` and `z`: roll, pitch and yaw",
    ] {
        assert_eq!(notes.next().unwrap(), expected);
    }
}

#[test]
#[needs("node", "npm")]
fn parameters_are_shown_and_set() {
    let rover = parameters::rover();
    let foxglove = Foxglove::start(&rover, &["--control"]);
    let values = "
        client.getParameters([], 'all');
        const { parameters } = await until(({ parameterValues: it }) => it?.id === 'all' ? it : undefined);
        return parameters;";
    let gain = |value: f64| json!({"name": "controller.gain", "type": "float64", "value": value});
    let rest = json!([
        {"name": "controller.mode", "value": "manual"}, {"name": "controller.names", "value": []},
        {"name": "controller.pin", "value": 4},
    ]);
    let read = foxglove.run(values);
    assert_eq!(read[0], gain(0.8));
    assert_eq!(json!(read.as_array().unwrap()[1..]), rest);

    // Another client learns of it, and of what is not possible.
    let set = foxglove.run(
        "client.subscribeParameterUpdates(['controller.gain']);
         client.setParameters([{ name: 'controller.gain', value: 2.5 }]);
         return await until(({ parameterValues: it }) => it?.parameters.find(({ value }) => value === 2.5));",
    );
    assert_eq!(set, gain(2.5));
    assert_eq!(rover.text(&["get", "controller.gain"]), "2.5\n");
    let refused = |parameter: &str| {
        let script =
            format!("client.setParameters([{parameter}], 'set'); return (await until((it) => it.status)).message;");
        foxglove.run(&script).as_str().unwrap().to_owned()
    };
    let error = refused("{ name: 'controller.gain', value: 11 }");
    assert!(error.contains("`11` is not from 0 to 10"), "{error}");
    let error = refused("{ name: 'controller.pin', value: 5 }");
    assert!(error.contains("live"), "{error}");
    let error = refused("{ name: 'controller.gian', value: 1 }");
    assert!(error.contains("did you mean `gain`?"), "{error}");
    let error = refused("{ name: 'controller.mode', value: { a: 1 } }");
    assert!(error.contains("expected `manual` or `auto`"), "{error}");
    let error = refused("{ name: 'controller.mode' }");
    assert!(error.contains("`controller.mode` cannot be removed"), "{error}");
}

#[test]
#[needs("node", "npm")]
fn gates_are_called_and_messages_published_in_place_of_what_does_not_run() {
    let mut rover = Rover::start();
    let foxglove = Foxglove::start(&rover, &["--control"]);
    let error = foxglove.run("return await call('/controller/commands', { target_speed: 0.5 });");
    assert!(error.as_str().unwrap().contains("every requester of `controller.commands` is running"), "{error}");
    rover.stop("user_interface");
    let reply = foxglove.run("return await call('/controller/commands', { target_speed: 0.5 });");
    assert_eq!(reply["accepted"], true, "{reply}");
    let error = foxglove.run("return await call('/controller/commands', { target_sped: 0.5 });");
    assert!(error.as_str().unwrap().contains("did you mean `target_speed`?"), "{error}");

    let refused = |topic: &str, encoding: &str| {
        let script = format!(
            "publish('{topic}', {{ speed: 1.5 }}, '{encoding}'); return (await until((it) => it.status)).message;"
        );
        foxglove.run(&script).as_str().unwrap().to_owned()
    };
    let error = refused("/sensor/measurements", "json");
    assert!(error.contains("component `sensor` is already running"), "{error}");
    let error = refused("/sensor/measurements/request", "json");
    assert!(error.contains("this is no gate; name it `/component/gate`"), "{error}");
    let error = refused("/sensor/measurements", "protobuf");
    assert!(error.contains("messages are published as `json`, not as `protobuf`"), "{error}");
    rover.stop("sensor");
    let error = refused("/sensor/measurement", "json");
    assert!(error.contains("did you mean `sensor.measurements`?"), "{error}");
    // Until the channel is observed, too: a panel sees what passes from then on.
    let seen = foxglove.run(
        "await show('/sensor/measurements');
         const id = publish('/sensor/measurements', { speed: 1.5, count: 7 });
         setInterval(() => client.sendMessage(id, bytes({ speed: 1.5, count: 7 })), 50);
         const { data } = await until(({ message }) => message);
         return [data.readDoubleLE(1), data[10]];",
    );
    assert_eq!(seen, json!([1.5, 7]), "{seen}");
}

#[test]
#[needs("node", "npm")]
fn panels_only_look_without_control() {
    let rover = parameters::rover();
    let foxglove = Foxglove::start(&rover, &[]);
    let capabilities = foxglove.run("return (await info).capabilities;");
    assert_eq!(capabilities, json!(["connectionGraph", "parameters", "parametersSubscribe"]));
    let error = foxglove.run(
        "client.setParameters([{ name: 'controller.gain', value: 2.5 }], 'set');
         return (await until((it) => it.status)).message;",
    );
    assert_eq!(error, "start `scl foxglove --control` to set parameters");
    assert_eq!(rover.text(&["get", "controller.gain"]), "0.8\n");
}

#[test]
#[needs("node", "npm")]
fn a_recording_is_played_as_panels_ask() {
    let rover = Rover::start();
    let recorded = rover.scl(&["record", "-o", "flight.mcap", "--for", "1s"]).output().unwrap();
    assert!(recorded.status.success(), "{recorded:?}");
    let foxglove = Foxglove::start(&rover, &["--replay", "flight.mcap"]);
    let script = "
        const { capabilities, dataStartTime: from, dataEndTime: to } = await info;
        const time = ({ sec, nsec }) => BigInt(sec) * 1000000000n + BigInt(nsec);
        const seen = [];
        await show('/sensor/measurements');
        client.on('message', ({ timestamp }) => seen.push(timestamp));
        const playing = await control(0, 100, time(from));
        const ended = await until(({ state }) => state?.status === 3 ? state : undefined);
        const all = seen.length;
        const inside = seen.every((it) => it >= time(from) && it <= time(to));
        const ordered = seen.every((it, index) => index === 0 || it >= seen[index - 1]);
        const back = await control(1, 1, time(from));
        return { capabilities, playing, ended, all, inside, ordered, back, from: time(from), to: time(to) };";
    let played = foxglove.run(script);
    assert_eq!(played["capabilities"], json!(["playbackControl", "time"]), "{played}");
    assert_eq!(played["playing"], json!({"status": 0, "time": played["from"], "speed": 100}), "{played}");
    assert_eq!(played["ended"], json!({"status": 3, "time": played["to"], "speed": 100}), "{played}");
    assert_eq!((&played["inside"], &played["ordered"]), (&json!(true), &json!(true)), "{played}");
    assert_eq!(played["back"], json!({"status": 1, "time": played["from"], "speed": 1}), "{played}");
    let recorded = rover.json(&["info", "flight.mcap", "--format", "json"]);
    let gates = recorded["gates"].as_array().unwrap();
    let gate = gates.iter().find(|it| it["gate"] == "sensor.measurements").unwrap();
    assert_eq!(played["all"], gate["messages"], "{gate}");
}

#[test]
fn what_cannot_be_served_is_explained() {
    let rover = Rover::start();
    let error = |arguments: &[&str]| {
        let output = scl_foxglove(&rover, arguments).output().unwrap();
        assert_eq!((output.status.code(), &*output.stdout), (Some(2), &b""[..]), "{arguments:?}: {output:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port().to_string();
    let in_use = error(&["--port", &port]);
    assert!(in_use.contains(&format!("cannot listen at 127.0.0.1:{port}: ")), "{in_use}");
    assert!(in_use.contains("choose another port with `--port`"), "{in_use}");
    let unknown = error(&["--system", "rovre"]);
    assert!(unknown.contains("did you mean `rover`?"), "{unknown}");
    rover.write("flight.mcap", "not a recording");
    let damaged = error(&["--replay", "flight.mcap"]);
    assert!(damaged.contains("flight.mcap"), "{damaged}");
    let both = error(&["--replay", "flight.mcap", "--control"]);
    assert!(both.contains("cannot be used with"), "{both}");
}
