//! The enums in generated code, in macros.

/// An enum of things that have names in the topology file.
#[doc(hidden)]
#[macro_export]
macro_rules! __named {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $text:literal,)* }) => {
        $(#[$doc])*
        #[allow(dead_code, non_camel_case_types)]
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name {
            $($(#[$variant_doc])* $variant,)*
        }

        #[allow(dead_code)]
        impl $name {
            /// All of them, in the order of the topology file.
            pub const ALL: &'static [Self] = &[$(Self::$variant),*];

            /// Its name in the topology file.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $text,)*
                }
            }
        }

        impl ::core::fmt::Display for $name {
            fn fmt(&self, out: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                out.write_str(self.name())
            }
        }
    };
}

/// The enum of the components of a kind.
#[doc(hidden)]
#[macro_export]
macro_rules! __instances {
    ($(#[$doc:meta])* $name:ident { $($variants:tt)* }) => {
        $crate::__named! { $(#[$doc])* $name { $($variants)* } }

        impl $crate::private::Senders for $name {
            fn of(connection: &$crate::private::ConnectionSpec) -> ::core::option::Option<Self> {
                Self::ALL.iter().copied().find(|component| component.name() == connection.peer_component)
            }
        }
    };
}

/// The enum of a parameter that is one of several words.
#[doc(hidden)]
#[macro_export]
macro_rules! __choice {
    ($(#[$doc:meta])* $name:ident { $($variants:tt)* }) => {
        $crate::__named! { $(#[$doc])* $name { $($variants)* } }

        impl $crate::private::FromParameter for $name {
            fn from_value(value: &$crate::plan::ParameterValue) -> ::core::option::Option<Self> {
                match value {
                    $crate::plan::ParameterValue::Text(word) => {
                        Self::ALL.iter().copied().find(|known| known.name() == word)
                    }
                    _ => ::core::option::Option::None,
                }
            }
        }
    };
}

/// The enum of the senders of a gate.
#[doc(hidden)]
#[macro_export]
macro_rules! __senders {
    ($(#[$doc:meta])* $name:ident {
        $($(#[$variant_doc:meta])* $variant:ident = ($component:literal, $gate:literal),)*
    }) => {
        $(#[$doc])*
        #[allow(dead_code, non_camel_case_types)]
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name {
            $($(#[$variant_doc])* $variant,)*
        }

        impl $crate::private::Senders for $name {
            fn of(connection: &$crate::private::ConnectionSpec) -> ::core::option::Option<Self> {
                match (connection.peer_component, connection.peer_gate) {
                    $(($component, $gate) => ::core::option::Option::Some(Self::$variant),)*
                    _ => ::core::option::Option::None,
                }
            }
        }
    };
}
