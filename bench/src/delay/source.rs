//! The process that sends. It starts the receivers itself, so that they have its priority.

use super::{BYTES, PERIOD, WAYS};
use crate::one_way::Lane;
use crate::processes::{say, start_runtime, wrong_words};

/// Sends batches of so many messages on each way in turn, so many times; says what the receivers say.
pub(crate) fn play_source(words: &[&str]) -> scl::Result<()> {
    let [folder, batch, rounds] = words else { return Err(wrong_words(words)) };
    let (batch, rounds): (usize, usize) = (batch.parse()?, rounds.parse()?);
    let runtime = start_runtime()?;
    let lanes = WAYS.iter().map(|way| Lane::open(&runtime, way, folder, BYTES, batch));
    let mut lanes = lanes.collect::<scl::Result<Vec<Lane>>>()?;
    runtime.block_on(async {
        // The first round only warms up.
        for round in 0..=rounds {
            for lane in &mut lanes {
                lane.send_steadily(PERIOD).await?;
                let received = lane.received().await?;
                if round > 0 {
                    say(&received.to_line())?;
                }
            }
        }
        Ok(())
    })
}
