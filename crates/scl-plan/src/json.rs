//! Plans as JSON. One format for one component and for a whole system:
//!
//! ```text
//! {"version": 1, "system": "rover", "components": [{"name": .., "gates": [..], ..}], "schemas": {"<hash>": "<base64>"}}
//! ```
//!
//! A component refers to its schema by the hash, because most components of a system share one.

mod object;
mod parameter;
mod read;
mod write;
