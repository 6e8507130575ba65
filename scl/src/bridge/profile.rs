//! A component's announcement and messages, as sent to other hosts.

use crate::plan::{Plan, Schema};
use crate::runtime_dir::{Announcement, SystemDir};
use bytes::{BufMut, Bytes, BytesMut};

/// A component's announcement, and the messages that its program was built with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Profile {
    announcement: Announcement,
    schema: Option<Bytes>,
}

/// Received bytes are not a usable profile.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// The bytes end too early, or are not an announcement.
    #[error("the received bytes are not the announcement of a component; run the same release of SCL on all hosts")]
    Malformed,
    /// The announcement has no plan, or a plan of another version.
    #[error(
        "component `{component}` announces no plan that this release can read; run the same release of SCL on all hosts"
    )]
    NoPlan {
        /// The component.
        component: String,
    },
    /// The announcement names messages that did not come with it.
    #[error("component `{component}` was announced without the schema of its messages")]
    NoMessages {
        /// The component.
        component: String,
    },
}

impl Profile {
    /// Reads what a component of this host has published, if it is complete.
    pub fn read(dir: &SystemDir, component: &str) -> Option<Self> {
        let announcement = Announcement::read(dir, component)?;
        let schema = match &announcement.schema {
            Some(hash) => Some(dir.schema(hash)?),
            None => None,
        };
        Some(Self { announcement, schema })
    }

    /// Returns the component's announcement.
    pub fn announcement(&self) -> &Announcement {
        &self.announcement
    }

    /// Encodes the profile: the length of the announcement, the announcement, the messages.
    pub fn to_bytes(&self) -> Bytes {
        let announcement = self.announcement.to_json().to_string();
        let schema = self.schema.clone().unwrap_or_default();
        let mut bytes = BytesMut::with_capacity(4 + announcement.len() + schema.len());
        bytes.put_u32(u32::try_from(announcement.len()).unwrap_or(u32::MAX));
        bytes.put_slice(announcement.as_bytes());
        bytes.put_slice(&schema);
        bytes.freeze()
    }

    /// Decodes a profile that [`to_bytes`](Self::to_bytes) has encoded on another host.
    ///
    /// # Errors
    /// The bytes are not a profile.
    pub fn from_bytes(mut bytes: Bytes) -> Result<Self, ProfileError> {
        let length = bytes.first_chunk().map(|&length| u32::from_be_bytes(length) as usize);
        let end = length.and_then(|length| length.checked_add(4)).filter(|&end| end <= bytes.len());
        let schema = bytes.split_off(end.ok_or(ProfileError::Malformed)?);
        let json = serde_json::from_slice(&bytes[4..]).map_err(|_not_json| ProfileError::Malformed)?;
        let announcement = Announcement::from_json(&json).ok_or(ProfileError::Malformed)?;
        if announcement.schema.is_some() && schema.is_empty() {
            return Err(ProfileError::NoMessages { component: announcement.component });
        }
        let schema = announcement.schema.is_some().then_some(schema);
        Ok(Self { announcement, schema })
    }

    /// The plan of the component with its messages.
    pub(super) fn plan(&self) -> Result<Plan, ProfileError> {
        let no_plan = || ProfileError::NoPlan { component: self.announcement.component.clone() };
        let mut plan = self.announcement.plan.clone().ok_or_else(no_plan)?;
        let schema = self.announcement.schema.clone().zip(self.schema.as_deref());
        plan.schema = schema.map(|(hash, descriptors)| Schema { hash, descriptors: descriptors.into() });
        Ok(plan)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_survives_the_way_and_nothing_else_is_one() {
        let mut announcement = Announcement::of_this_process("sensor");
        announcement.schema = Some("1a2b".to_owned());
        // Written in whole milliseconds.
        announcement.started = std::time::SystemTime::UNIX_EPOCH;
        let profile = Profile { announcement, schema: Some(Bytes::from_static(b"messages")) };
        let bytes = profile.to_bytes();
        assert_eq!(Profile::from_bytes(bytes.clone()).unwrap(), profile);
        let without_messages = bytes.slice(..bytes.len() - 8);
        assert!(matches!(Profile::from_bytes(without_messages), Err(ProfileError::NoMessages { .. })));
        for end in 0..bytes.len() - 8 {
            assert!(matches!(Profile::from_bytes(bytes.slice(..end)), Err(ProfileError::Malformed)), "{end} bytes");
        }
        assert!(matches!(profile.plan(), Err(ProfileError::NoPlan { .. })));
    }
}
