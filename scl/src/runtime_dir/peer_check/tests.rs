//! What connecting ends and `ready` say about peers that were built differently.

use super::*;
use crate::runtime_dir::{OwnedPath, RuntimeDir};
use crate::spec::{GateKind, GateOptions, WhenFull};
use crate::transport_choice::TransportChoice;
use tempfile::TempDir;

fn nav() -> (TempDir, SystemDir) {
    let root = tempfile::tempdir().unwrap();
    let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| root.path().into());
    let dir = RuntimeDir::locate(&variable).unwrap().system("nav").unwrap();
    (root, dir)
}

/// A component with one gate, which is connected to one gate of another component.
struct Build {
    gate: (&'static str, &'static str, GateKind),
    peer: (&'static str, &'static str),
    payload: &'static str,
    codec: &'static str,
    contract: &'static str,
    schema: Option<crate::spec::Schema>,
}

const GPS: Build = Build {
    gate: ("gps", "position", GateKind::Pub),
    peer: ("pilot", "position"),
    payload: "nav.Position",
    codec: "protobuf",
    contract: "aaaa",
    schema: None,
};

const PILOT: Build = Build { gate: ("pilot", "position", GateKind::Sub), peer: ("gps", "position"), ..GPS };

impl Build {
    fn spec(&self) -> ComponentSpec {
        let (component, name, kind) = self.gate;
        let connection = ConnectionSpec {
            peer_component: self.peer.0,
            peer_gate: self.peer.1,
            endpoint: "gps.position--pilot.position.aaaa",
            contract: self.contract,
            required: true,
            queue: 1,
            when_full: WhenFull::DropOldest,
            max_size: 1 << 20,
            max_age: None,
        };
        let gate = GateSpec {
            name,
            kind,
            payload: self.payload,
            codec: self.codec,
            declared_at: "nav.yaml:3:4",
            endpoint: if kind == GateKind::Rep { "gps.position.aaaa" } else { "" },
            tap: if kind == GateKind::Pub { "gps.position.tap" } else { "" },
            contract: self.contract,
            options: GateOptions::DEFAULT,
            connections: Vec::leak(vec![connection]),
        };
        let (gates, schema) = (Vec::leak(vec![gate]), self.schema);
        ComponentSpec { system: "nav", name: component, declared_at: "nav.yaml:1:2", parameters: &[], gates, schema }
    }

    fn announce(&self, dir: &SystemDir) -> OwnedPath {
        Announcement::of(&self.spec(), &TransportChoice::default()).publish(dir).unwrap()
    }

    /// What this component says about its peer: when it connects, and when it waits for the peer.
    fn says(&self, dir: &SystemDir) -> (String, String) {
        let own = self.spec();
        let (gate, connection) = (&own.gates[0], &own.gates[0].connections[0]);
        (
            check_peer(dir, &own, gate, connection).err().unwrap_or_default(),
            explain_missing(dir, &own, gate, connection),
        )
    }
}

#[test]
fn a_peer_that_is_not_running_or_announces_nothing_is_allowed() {
    let (_root, dir) = nav();
    let not_running = (String::new(), "is not running".to_owned());
    assert_eq!(PILOT.says(&dir), not_running);
    let stale = Build { contract: "bbbb", payload: "nav.Old", ..GPS }.announce(&dir);
    assert_eq!(PILOT.says(&dir), not_running);
    let _lock = ComponentLock::take(&dir, "gps").unwrap();
    drop(stale);
    assert_eq!(PILOT.says(&dir), (String::new(), "is running in this process but not connected".to_owned()));
}

#[test]
fn peers_of_the_same_build_are_compatible() {
    let (_root, dir) = nav();
    let _locks = ["gps", "pilot"].map(|component| ComponentLock::take(&dir, component).unwrap());
    let _announced = [GPS.announce(&dir), PILOT.announce(&dir)];
    for build in [GPS, PILOT] {
        assert_eq!(build.says(&dir), (String::new(), "is running in this process but not connected".to_owned()));
    }
}

#[test]
fn peers_of_another_build_are_named_with_what_differs() {
    let (_root, dir) = nav();
    let _lock = ComponentLock::take(&dir, "gps").unwrap();
    let cases = [
        (
            Build { contract: "bbbb", payload: "nav.Fix", codec: "json", ..GPS },
            "was built with type `nav.Fix` and codec `json`, this program expects `nav.Position` and `protobuf`; \
             build both from the same topology",
        ),
        (
            Build { contract: "bbbb", codec: "\u{1b}[31m", ..GPS },
            "was built with type `nav.Position` and codec `\\u{1b}[31m`, this program expects `nav.Position` and \
             `protobuf`; build both from the same topology",
        ),
        (
            Build { contract: "bbbb", gate: ("gps", "position", GateKind::Rep), ..GPS },
            "was built with `position` as a `rep` gate, which does not fit the `sub` gate of this program; \
             build both from the same topology",
        ),
        (
            Build { peer: ("display", "position"), ..GPS },
            "was built without a connection between `pilot.position` and `gps.position`; \
             build both from the same topology",
        ),
        (
            Build { gate: ("gps", "fix", GateKind::Pub), ..GPS },
            "was built without a connection between `pilot.position` and `gps.position`; \
             build both from the same topology",
        ),
    ];
    for (gps, expected) in cases {
        let _announced = gps.announce(&dir);
        let (check, explanation) = PILOT.says(&dir);
        assert_eq!(check, format!("`gps` (this process) {expected}"));
        assert_eq!(explanation, format!("is running in this process but {expected}"));
    }
}

#[test]
fn an_announcement_of_an_older_format_is_compared_by_its_gates() {
    let (_root, dir) = nav();
    let _lock = ComponentLock::take(&dir, "gps").unwrap();
    for (contract, expected) in [("aaaa", ""), ("bbbb", "was built with type `nav.Fix` and codec `json`")] {
        let old = format!(
            r#"{{"component": "gps", "pid": 7, "started_ms": 1, "program": "/bin/gps", "endpoints": [{{
                "gate": "position", "endpoint": "gps.position--pilot.position.{contract}", "contract": "{contract}",
                "payload": "nav.Fix", "codec": "json"}}]}}"#
        );
        std::fs::write(dir.folder().join("gps.json"), old).unwrap();
        let (check, _) = PILOT.says(&dir);
        assert!(check.contains(expected) && check.is_empty() == expected.is_empty(), "{check}");
    }
}

#[cfg(feature = "protobuf")]
mod messages {
    use super::*;
    use crate::runtime_dir::publish_schema;
    use crate::spec::Schema;
    use prost::Message;
    use prost_types::field_descriptor_proto::Type;
    use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};
    use std::fs;

    /// `nav.Position` with two fields of type double.
    fn position(hash: &'static str, fields: [&str; 2]) -> Schema {
        let field = |(number, name): (i32, &str)| FieldDescriptorProto {
            name: Some(name.to_owned()),
            number: Some(number),
            r#type: Some(Type::Double.into()),
            ..Default::default()
        };
        let field = (1..).zip(fields).map(field).collect();
        let message = DescriptorProto { name: Some("Position".to_owned()), field, ..Default::default() };
        let file =
            FileDescriptorProto { package: Some("nav".to_owned()), message_type: vec![message], ..Default::default() };
        Schema { hash, descriptors: Vec::leak(FileDescriptorSet { file: vec![file] }.encode_to_vec()) }
    }

    fn running(gps: &Build, dir: &SystemDir) -> (ComponentLock, OwnedPath) {
        let lock = ComponentLock::take(dir, "gps").unwrap();
        publish_schema(dir, &gps.schema.unwrap()).unwrap();
        (lock, gps.announce(dir))
    }

    const SWAPPED: &str = "message `nav.Position`: field 1 is `lat` (double) here, but `lon` (double) in \
                           `gps` (this process); build both with the same schemas";

    #[test]
    fn swapped_fields_are_refused_and_named() {
        let (_root, dir) = nav();
        let gps = Build { schema: Some(position("1111", ["lon", "lat"])), ..GPS };
        let pilot = Build { schema: Some(position("2222", ["lat", "lon"])), ..PILOT };
        let (lock, announced) = running(&gps, &dir);
        assert_eq!(pilot.says(&dir), (SWAPPED.to_owned(), format!("is incompatible: {SWAPPED}")));
        // The result is remembered, so the file is read only once.
        fs::remove_file(dir.folder().join("1111.schema")).unwrap();
        assert_eq!(pilot.says(&dir).0, SWAPPED);
        drop((lock, announced));
        let gps = Build { schema: Some(position("3333", ["lat", "lon"])), ..GPS };
        let _running = running(&gps, &dir);
        assert_eq!(pilot.says(&dir).0, "");
    }

    #[test]
    fn schemas_are_compared_only_if_both_are_known_and_different() {
        let (_root, dir) = nav();
        let [swapped, straight] = [position("1111", ["lon", "lat"]), position("2222", ["lat", "lon"])];
        let schema = Some(straight);
        let allowed = [
            (GPS, Build { schema, ..PILOT }),
            (Build { schema: Some(swapped), ..GPS }, PILOT),
            // The hash says that they are the same, so the file is not read.
            (Build { schema: Some(Schema { hash: "2222", ..swapped }), ..GPS }, Build { schema, ..PILOT }),
            (Build { schema: Some(swapped), codec: "raw", ..GPS }, Build { schema, codec: "raw", ..PILOT }),
        ];
        let _lock = ComponentLock::take(&dir, "gps").unwrap();
        for (gps, pilot) in allowed {
            let _announced = gps.announce(&dir);
            assert_eq!(pilot.says(&dir).0, "");
        }
    }

    #[test]
    fn a_schema_that_cannot_be_read_is_refused() {
        let (_root, dir) = nav();
        let gps = Build { schema: Some(position("1111", ["lon", "lat"])), ..GPS };
        let pilot = Build { schema: Some(position("2222", ["lat", "lon"])), ..PILOT };
        let _running = running(&gps, &dir);
        let file = dir.folder().join("1111.schema");
        let sound = fs::read(&file).unwrap();
        let damage: [(&dyn Fn(), &str); 4] = [
            (&|| fs::remove_file(&file).unwrap(), "No such file"),
            (&|| fs::write(&file, &sound[..sound.len() - 1]).unwrap(), "failed to decode Protobuf message"),
            (&|| fs::write(&file, b"\xff\xfe garbage").unwrap(), "failed to decode Protobuf message"),
            (&|| fs::File::create(&file).unwrap().set_len((16 << 20) + 1).unwrap(), "file too large"),
        ];
        for (damage, reason) in damage {
            damage();
            let (check, _) = pilot.says(&dir);
            let start = format!(
                "cannot compare the messages of `gps` (this process) with those of this program: cannot read `{}`: ",
                file.display()
            );
            assert!(check.starts_with(&start) && check.contains(reason), "{check}");
        }
        // Nothing of that was remembered.
        fs::write(&file, &sound).unwrap();
        assert_eq!(pilot.says(&dir).0, SWAPPED);
    }

    #[test]
    fn a_schema_is_written_once_and_replaced_if_its_length_differs() {
        let (_root, dir) = nav();
        let schema = position("1111", ["lon", "lat"]);
        let file = dir.folder().join("1111.schema");
        publish_schema(&dir, &schema).unwrap();
        assert_eq!(fs::read(&file).unwrap(), schema.descriptors);
        let written = || std::os::unix::fs::MetadataExt::ino(&fs::metadata(&file).unwrap());
        let first = written();
        assert_eq!(std::os::unix::fs::MetadataExt::mode(&fs::metadata(&file).unwrap()) & 0o7777, 0o600);
        publish_schema(&dir, &schema).unwrap();
        assert_eq!(written(), first);
        let connection = || std::os::unix::fs::symlink("x".repeat(schema.descriptors.len()), &file).unwrap();
        let replacements: [&dyn Fn(); 2] = [&|| fs::write(&file, "half").unwrap(), &connection];
        for replace in replacements {
            fs::remove_file(&file).unwrap();
            replace();
            publish_schema(&dir, &schema).unwrap();
            assert_eq!(fs::read(&file).unwrap(), schema.descriptors);
        }
        let bad = Schema { hash: "../1111", ..schema };
        assert!(publish_schema(&dir, &bad).unwrap_err().to_string().contains("cannot be the name of a schema"));
    }
}
