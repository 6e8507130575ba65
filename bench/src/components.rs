//! The components of the benchmarks, one system per benchmark.

pub(crate) mod fanout {
    scl::topology!("fanout.yaml");
}

pub(crate) mod fresh {
    scl::topology!("fresh.yaml");
}

pub(crate) mod one_way {
    scl::topology!("one_way.yaml");
}

pub(crate) mod restart {
    scl::topology!("restart.yaml");
}

pub(crate) mod roundtrip {
    scl::topology!("roundtrip.yaml");
}
