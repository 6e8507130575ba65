//! JSON for the messages of schemas.

/// Implements serde's traits for the messages of a topology's schemas.
#[cfg(all(feature = "json", feature = "protobuf"))]
#[doc(hidden)]
#[macro_export]
macro_rules! __message_json {
    ($descriptors:literal $($message:ty = $name:literal)*) => {
        static POOL: $crate::private::MessagePool = $crate::private::MessagePool::new($descriptors);
        $(
            const _: () = {
                static TYPE: $crate::private::MessageType = $crate::private::MessageType::new(&POOL, $name);
                impl $crate::private::serde::Serialize for $message {
                    fn serialize<S: $crate::private::serde::Serializer>(
                        &self,
                        serializer: S,
                    ) -> ::core::result::Result<S::Ok, S::Error> {
                        TYPE.serialize(self, serializer)
                    }
                }
                impl<'de> $crate::private::serde::Deserialize<'de> for $message {
                    fn deserialize<D: $crate::private::serde::Deserializer<'de>>(
                        deserializer: D,
                    ) -> ::core::result::Result<Self, D::Error> {
                        TYPE.deserialize(deserializer)
                    }
                }
            };
        )*
    };
}

/// Without the features `json` and `protobuf`, messages of schemas have no JSON.
#[cfg(not(all(feature = "json", feature = "protobuf")))]
#[doc(hidden)]
#[macro_export]
macro_rules! __no_message_json {
    ($($any:tt)*) => {};
}
