//! Generated code where the dependency has another name and common names mean something else.
