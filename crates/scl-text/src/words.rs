//! Enums whose values are words in files and environment variables.

/// Declares an enum with a word for each variant: its constants `ALL` and `WORDS`, in the order in which messages list
/// them, and its functions `word` and `of`.
///
/// ```
/// scl_text::words! {
///     /// What a lamp does.
///     #[derive(Debug, Clone, Copy, PartialEq)]
///     pub enum Lamp {
///         /// It is lit.
///         On = "on",
///         /// It is dark.
///         Off = "off",
///     }
/// }
///
/// assert_eq!(Lamp::On.word(), "on");
/// assert_eq!(Lamp::of("off"), Some(Lamp::Off));
/// assert_eq!(Lamp::of("OFF"), None);
/// assert_eq!((Lamp::ALL, Lamp::WORDS), ([Lamp::On, Lamp::Off], ["on", "off"]));
/// ```
#[macro_export]
macro_rules! words {
    ($(#[$outer:meta])* $visible:vis enum $name:ident { $($(#[$inner:meta])* $variant:ident = $word:literal,)+ }) => {
        $(#[$outer])*
        $visible enum $name {
            $($(#[$inner])* $variant,)+
        }

        impl $name {
            /// The words, in the order in which messages list them.
            $visible const WORDS: [&'static str; [$($word),+].len()] = [$($word),+];

            /// All of them, in the same order.
            $visible const ALL: [Self; Self::WORDS.len()] = [$(Self::$variant),+];

            /// The word in files.
            $visible const fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }

            /// The value with this word.
            $visible fn of(word: &str) -> Option<Self> {
                match word {
                    $($word => Some(Self::$variant),)+
                    _ => None,
                }
            }
        }
    };
}
