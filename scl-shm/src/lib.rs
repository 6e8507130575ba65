//! Messages in shared memory under the connections of SCL, over iceoryx2.
