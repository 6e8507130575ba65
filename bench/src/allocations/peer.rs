//! The opposite side, a worker process whose allocations are not counted.

use super::components::Far;
use super::reading::Reading;
use crate::raw::SocketPaths;
use crate::runtime::start_runtime;
use crate::unix::echo;
use crate::worker::unknown_arguments;
use std::io::ErrorKind;
use std::path::Path;
use tokio::net::UnixStream;

/// Plays the opposite of a role forever. The arguments are the role's id and the scratch folder.
pub(crate) fn run_peer(arguments: &[&str]) -> scl::Result<()> {
    let [role, folder] = arguments else { return Err(unknown_arguments(arguments)) };
    start_runtime()?.block_on(async {
        if *role == "unix" {
            let path = SocketPaths::new(folder, "unix").path("stream");
            return echo(connect(&path).await?, size_of::<Reading>()).await;
        }
        let mut far = Far::open_with(scl::OpenOptions::new().runtime_dir(*folder).system("allocations")).await?;
        let reading = Reading::default();
        loop {
            match *role {
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

/// Connects as soon as the other side listens.
async fn connect(path: &Path) -> std::io::Result<UnixStream> {
    loop {
        match UnixStream::connect(path).await {
            Err(error) if error.kind() == ErrorKind::NotFound => tokio::task::yield_now().await,
            connected => return connected,
        }
    }
}
