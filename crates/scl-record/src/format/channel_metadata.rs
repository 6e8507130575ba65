//! The description of a channel's gate, stored as metadata of the MCAP channel.

use scl_plan::GateKind;
use std::collections::BTreeMap;

/// The gate of a channel.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ChannelMetadata {
    /// Key `kind`: `pub`, `pull` or `rep`.
    pub kind: GateKind,
    /// Key `type`: the type of this channel's messages, as in the topology file. Missing for bytes.
    pub type_name: Option<String>,
    /// Key `codec`: the codec, as in the topology file.
    pub codec: String,
    /// Key `contract`: the gate's contract.
    pub contract: String,
    /// Key `peers`: the gates at the other ends, separated by spaces: `controller.sensor display.sensor`.
    pub peers: Vec<String>,
}

impl ChannelMetadata {
    /// Returns the metadata as the map in the file.
    pub fn to_map(&self) -> BTreeMap<String, String> {
        let mut map = BTreeMap::from([
            (KIND.to_owned(), self.kind.word().to_owned()),
            (CODEC.to_owned(), self.codec.clone()),
            (CONTRACT.to_owned(), self.contract.clone()),
            (PEERS.to_owned(), self.peers.join(" ")),
        ]);
        if let Some(type_name) = &self.type_name {
            map.insert(TYPE.to_owned(), type_name.clone());
        }
        map
    }

    /// Names what a map lacks, for messages: `` `kind`, `codec` ``, or `` known `kind` ``.
    pub fn missing(map: &BTreeMap<String, String>) -> String {
        let missing: Vec<_> =
            [KIND, CODEC, CONTRACT, PEERS].into_iter().filter(|key| !map.contains_key(*key)).collect();
        if missing.is_empty() { format!("known `{KIND}`") } else { scl_terminal::quoted_list(missing) }
    }

    /// Reads the map; `None` if a key is missing or the kind unknown.
    pub fn from_map(map: &BTreeMap<String, String>) -> Option<Self> {
        Some(Self {
            kind: GateKind::of(map.get(KIND)?)?,
            type_name: map.get(TYPE).cloned(),
            codec: map.get(CODEC)?.clone(),
            contract: map.get(CONTRACT)?.clone(),
            peers: map.get(PEERS)?.split_whitespace().map(str::to_owned).collect(),
        })
    }
}

const KIND: &str = "kind";
const TYPE: &str = "type";
const CODEC: &str = "codec";
const CONTRACT: &str = "contract";
const PEERS: &str = "peers";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metadata_is_read_as_it_is_written() {
        for (type_name, peers) in
            [(Some("rover.Measurement".to_owned()), vec!["a.b".to_owned(), "c.d".to_owned()]), (None, vec![])]
        {
            let metadata = ChannelMetadata {
                kind: GateKind::Pub,
                type_name,
                codec: "protobuf".to_owned(),
                contract: "hl75aqsl".to_owned(),
                peers,
            };
            assert_eq!(ChannelMetadata::from_map(&metadata.to_map()), Some(metadata));
        }
        assert_eq!(ChannelMetadata::from_map(&BTreeMap::new()), None);
    }
}
