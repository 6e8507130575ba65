//! The process that sends. It starts the receivers itself, so that they inherit its priority.

use super::{BYTES, PERIOD, VARIANTS};
use crate::one_way::{Channel, Timing};
use crate::runtime::start_runtime;
use crate::worker::{print_line, unknown_arguments};

/// Sends batches on each variant in turn, and prints the report of each batch. The arguments are the scratch folder,
/// the size of a batch and the number of rounds.
pub(crate) fn run_source(arguments: &[&str]) -> scl::Result<()> {
    let [folder, batch, rounds] = arguments else { return Err(unknown_arguments(arguments)) };
    let (batch, rounds): (usize, usize) = (batch.parse()?, rounds.parse()?);
    let runtime = start_runtime()?;
    let mut channels = Vec::new();
    for variant in VARIANTS {
        channels.push(runtime.block_on(Channel::open(variant, folder, BYTES, batch, Timing::EachMessage))?);
    }
    runtime.block_on(async {
        // The first round is warm-up.
        for round in 0..=rounds {
            for channel in &mut channels {
                channel.send_periodically(PERIOD).await?;
                let report = channel.batch_report().await?;
                if round > 0 {
                    print_line(&report.to_line())?;
                }
            }
        }
        Ok(())
    })
}
