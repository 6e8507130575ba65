//! `examples/ospecorr` on a band with a primary user.
