//! The viewer without async, which keeps frames and may be forked.

use crate::Viewer;
use crate::picture::number_of;
use scl::bytes::Bytes;
use scl_tests::{is_shared, ranges, say};

pub(crate) fn play() -> scl::Result<()> {
    let mut viewer = Viewer::open_blocking()?;
    say("open");
    let mut kept: Vec<Bytes> = Vec::new();
    for command in std::io::stdin().lines() {
        match command?.as_str() {
            "keep" => {
                let frame = viewer.frames.recv_blocking()?;
                assert!(is_shared(&frame));
                kept.push(frame);
                say("kept");
            }
            "receive" => say(number_of(viewer.frames.recv_blocking()?)),
            "kept" => say(ranges(&kept.iter().map(number_of).collect::<Vec<_>>())),
            "release" => {
                kept.clear();
                say("released");
            }
            other => say(format!("unknown command `{other}`")),
        }
    }
    Ok(())
}
