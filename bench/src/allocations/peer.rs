//! The opposite side, a worker process whose allocations are not counted.

use super::components::Far;
use super::reading::Reading;
use crate::runtime::start_runtime;
use crate::worker::unknown_arguments;

/// Plays the opposite of a role forever. The arguments are the role's id and the scratch folder.
pub(crate) fn run_peer(arguments: &[&str]) -> scl::Result<()> {
    let [role, folder] = *arguments else { return Err(unknown_arguments(arguments)) };
    start_runtime()?.block_on(async {
        let mut far = Far::open_with(scl::OpenOptions::new().runtime_dir(folder).system("allocations")).await?;
        let reading = Reading::default();
        loop {
            match role {
                "publish" => {
                    far.subscribe.recv().await?;
                }
                "subscribe" => far.publish.send(&reading).await?,
                "push" => {
                    far.pull.recv().await?;
                }
                "pull" => far.push.send(&reading).await?,
                "request" => far.reply.recv().await?.reply(&reading)?,
                "reply" => {
                    far.request.call(&reading).await?;
                }
                "publish-and-subscribe" => {
                    far.subscribe.recv().await?;
                    far.publish.send(&reading).await?;
                }
                _ => return Err(unknown_arguments(arguments)),
            }
        }
    })
}
