//! How long the tests take.
//!
//! By default the faults are short and few, so that all tests take some minutes. With `SCL_TEST_LONG=1` in the
//! environment they are as long and as many as the gateway promises to survive: half a minute without a network, a
//! hundred kills.

//! Only then rates are judged, which tell as much of the machine as of the gateway.

pub(crate) fn is_long() -> bool {
    short_or_long(false, true)
}

/// The value for short tests or that for long ones.
pub(crate) fn short_or_long<T>(short: T, long: T) -> T {
    match std::env::var("SCL_TEST_LONG").as_deref() {
        Ok("1") => long,
        Ok(other) => panic!("SCL_TEST_LONG={other}, not `1`"),
        Err(_) => short,
    }
}
