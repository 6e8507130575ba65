//! The grammar as text for people.
