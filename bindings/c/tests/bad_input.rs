//! What C programs get wrong, and what they are told.
