//! Exports of codecs, and stand-ins for those whose cargo feature is off.

/// Exports the codecs whose features are on, and all codecs in a module for generated code. A row has the codec's
/// feature, which is also its word in topology files, its module and its type.
macro_rules! codecs {
    ($($feature:literal $module:ident $codec:ident)*) => {
        $(
            #[cfg(feature = $feature)]
            pub use self::$module::$codec;
        )*

        /// The codecs under the names that generated code uses, including those whose cargo feature is off.
        #[doc(hidden)]
        pub mod by_name {
            $(
                pub use self::$module::$codec;
                codec!($feature $module $codec);
            )*
        }
    };
}

/// Exports a codec, or a stand-in for it and the error that names the missing feature.
macro_rules! codec {
    ($feature:literal $module:ident $codec:ident) => {
        pub mod $module {
            #[cfg(feature = $feature)]
            pub use crate::__stand_in_codec as stand_in;
            #[cfg(feature = $feature)]
            pub use crate::codec::$codec;
            // The stand-in for the codec supports every type, so this macro generates nothing.
            #[cfg(not(feature = $feature))]
            pub use crate::__no_stand_in_codec as stand_in;

            /// Evaluated while the program compiles. The error is then about the caller, whether the sources of the
            /// standard library are installed or not.
            #[track_caller]
            #[allow(clippy::manual_assert, reason = "one of the two is always missing")]
            pub const fn is_on() {
                #[cfg(not(feature = $feature))]
                panic!(
                    "{}",
                    concat!(
                        "the codec `",
                        $feature,
                        "` is off; switch it on in Cargo.toml: ",
                        r#"scl = { package = "scl-gates", version = "..", features = [""#,
                        $feature,
                        r#""] }"#
                    )
                );
            }

            #[cfg(not(feature = $feature))]
            pub use off::$codec;
            #[cfg(not(feature = $feature))]
            mod off {
                use crate::codec::{Codec, DecodeError, EncodeError};
                use bytes::{Bytes, BytesMut};

                /// Stands in for the codec, so that the missing feature is the only error. It is never used: a program
                /// with it does not compile.
                #[derive(Debug)]
                pub struct $codec;

                impl<T> Codec<T> for $codec {
                    const NAME: &'static str = $feature;

                    fn encode(_: &T, _: &mut BytesMut) -> Result<(), EncodeError> {
                        Err(EncodeError::new($feature, "its feature is off"))
                    }

                    fn decode(_: Bytes) -> Result<T, DecodeError> {
                        Err(DecodeError::new($feature, "its feature is off"))
                    }
                }
            }
        }
    };
}
