//! A protobuf schema with fields of every sort, and messages of it, for the tests of this crate.

use crate::MessageType;
use prost::Message;
use prost_reflect::{DescriptorPool, MessageDescriptor};
use std::collections::HashMap;
use std::sync::{LazyLock, Mutex};

const SCHEMA: &str = r#"
syntax = "proto3";
package rover;
import "google/protobuf/any.proto";
import "google/protobuf/duration.proto";
import "google/protobuf/empty.proto";
import "google/protobuf/field_mask.proto";
import "google/protobuf/struct.proto";
import "google/protobuf/timestamp.proto";
import "google/protobuf/wrappers.proto";

enum Mode { IDLE = 0; AUTO = 1; MANUAL = 2; }
enum Word { NULL = 0; TRUE = 1; Inf = 2; }
message Point { double x = 1; double y = 2; }
message Measurement {
  float speed = 1;
  double position = 2;
  int32 i32 = 3; int64 i64 = 4; uint32 u32 = 5; uint64 u64 = 6;
  sint32 s32 = 7; sint64 s64 = 8; fixed32 f32 = 9; fixed64 f64 = 10; sfixed32 sf32 = 11; sfixed64 sf64 = 12;
  bool on = 13;
  string unit = 14;
  bytes raw_data = 15;
  Mode mode = 16;
  Point pose = 17;
  repeated float samples = 18;
  repeated Point track = 19;
  map<string, int32> counts = 20;
  map<int32, Point> points = 21;
  oneof target { double angle = 22; string place = 23; Point goal = 24; }
  optional int32 limit = 25;
  Measurement inner = 26;
  repeated Mode modes = 27;
  map<bool, string> flags = 28;
}
message Known {
  google.protobuf.Timestamp at = 1;
  google.protobuf.Duration took = 2;
  google.protobuf.Struct extra = 3;
  google.protobuf.Any any = 4;
  google.protobuf.FloatValue maybe = 5;
  google.protobuf.FieldMask mask = 6;
  google.protobuf.Value value = 7;
  google.protobuf.ListValue list = 8;
  google.protobuf.Empty empty = 9;
}
message Words { Word word = 1; repeated Word words = 2; map<string, Word> by_name = 3; google.protobuf.StringValue maybe = 4; }
message Newer { float speed = 1; string added = 100; int32 number = 101; }
"#;

/// The schema as a serialized `FileDescriptorSet`.
pub(crate) fn descriptors() -> &'static [u8] {
    static COMPILED: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("rover.proto"), SCHEMA).unwrap();
        protox::compile(["rover.proto"], [folder.path()]).unwrap().encode_to_vec()
    });
    &COMPILED
}

/// A message of the schema, in a codec.
pub(crate) fn message_type(name: &str, codec: &str) -> MessageType {
    // Reading the schema takes longer than most tests.
    static KNOWN: LazyLock<Mutex<HashMap<(String, String), MessageType>>> = LazyLock::new(Mutex::default);
    let new = || MessageType::new(Some(name), codec, Some(descriptors())).unwrap();
    KNOWN.lock().unwrap().entry((name.to_owned(), codec.to_owned())).or_insert_with(new).clone()
}

/// The description of a message of the schema.
pub(crate) fn descriptor(name: &str) -> MessageDescriptor {
    static POOL: LazyLock<DescriptorPool> = LazyLock::new(|| DescriptorPool::decode(descriptors()).unwrap());
    POOL.get_message_by_name(name).unwrap()
}
