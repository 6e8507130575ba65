//! The resource map: remembers what was observed, in a database, and answers queries about it.

pub mod database;
pub mod keeper;
pub mod recorder;
pub mod statistics;

use std::io;
use std::path::PathBuf;
use std::time::Duration;

use clap::Parser;
use scl::runtime_dir::{RuntimeDir, RuntimeDirError};
use tokio::sync::mpsc::error::TrySendError;

use self::keeper::{Job, Keeper};
use self::recorder::{Refused, Settings};
use crate::ResourceMap;
use crate::ospecorr::Statistics;

/// How often observations are written, in one transaction each time: the disk is accessed ten times a second instead of
/// fifty times, and a crash loses a tenth of a second.
const FLUSH_PERIOD: Duration = Duration::from_millis(100);

/// Keeps observations in a database and answers queries about them.
#[derive(Debug, Parser)]
pub struct Options {
    /// File of the database; the default is resource_map.sqlite in the runtime folder of the system.
    #[arg(long, value_name = "FILE")]
    database: Option<PathBuf>,
    /// Maximum size of the database in MiB.
    #[arg(long, value_name = "MIB", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    max_size: u64,
}

impl Options {
    /// Returns the settings of the recorder.
    ///
    /// # Errors
    /// There is no runtime folder.
    pub fn settings(self) -> Result<Settings, RuntimeDirError> {
        let path = match self.database {
            Some(path) => path,
            None => default_folder()?.join("resource_map.sqlite"),
        };
        Ok(Settings { path, max_bytes: self.max_size << 20 })
    }
}

/// Returns the folder of the system, which is usually in memory: observations from before the last boot say little
/// about today's spectrum.
fn default_folder() -> Result<PathBuf, RuntimeDirError> {
    let system = std::env::var("SCL_SYSTEM").ok().filter(|it| !it.is_empty());
    let folder = RuntimeDir::locate(&|name| std::env::var_os(name))?;
    Ok(folder.system(system.as_deref().unwrap_or("ospecorr"))?.folder().to_owned())
}

/// Runs the resource map until the database turns out to be one that this program cannot use, and returns the reason.
pub async fn run(mut map: ResourceMap, mut keeper: Keeper) -> scl::Result<Refused> {
    let mut tick = scl::time::interval(FLUSH_PERIOD)?;
    loop {
        tokio::select! {
            refused = &mut keeper.refused => {
                return Ok(refused.map_err(|_| io::Error::other("the thread of the database has ended"))?);
            }
            // Reserve a place before receiving: while the thread is behind, blocks wait in the gate's longer queue.
            block = async { Ok::<_, scl::Error>((keeper.jobs.reserve().await.ok(), map.occupancy.recv().await?)) } => {
                if let (Some(place), block) = block? {
                    place.send(Job::Add(block.channels));
                }
            }
            ticked = tick.tick() => {
                ticked?;
                tick.skip_missed();
                // If the queue is full, the flush of a later tick will do.
                let _ = keeper.jobs.try_send(Job::Flush);
            }
            request = map.queries.recv() => {
                if let Err(TrySendError::Full(Job::Answer(request))) = keeper.jobs.try_send(Job::Answer(request?)) {
                    let error = "the database is too slow".to_owned();
                    let _gone = request.reply(&Statistics { channels: Vec::new(), error });
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ResourceMapPeer;
    use crate::ospecorr::occupancy::Channel;
    use crate::ospecorr::{Occupancy, Query};
    use crate::resource_map::recorder::Recorder;
    use rusqlite::Connection;
    use std::fs;
    use std::path::Path;
    use tempfile::TempDir;
    use tokio::task::JoinHandle;

    /// A resource map with its database in this folder.
    async fn start(folder: &TempDir) -> scl::Result<(JoinHandle<scl::Result<Refused>>, ResourceMapPeer)> {
        let (map, peer) = ResourceMap::test().await?;
        let settings = Settings { path: path(folder.path()), max_bytes: 1 << 20 };
        let keeper = Keeper::start(Recorder::new(settings, |line| println!("{line}")))?;
        Ok((tokio::spawn(run(map, keeper)), peer))
    }

    fn path(folder: &Path) -> PathBuf {
        folder.join("map.sqlite")
    }

    async fn observe(peer: &mut ResourceMapPeer, count: u64) -> scl::Result<()> {
        for time_us in 0..count {
            let channels = vec![Channel { power_db: 10.0, occupied: true, threshold_db: 3.0 }];
            peer.occupancy.send(&Occupancy { time_us, channels }).await?;
        }
        Ok(())
    }

    /// Asks until this many observations are there, because nothing says whether a query or a block arrives first.
    async fn ask_for(peer: &mut ResourceMapPeer, observations: u32) -> scl::Result<Statistics> {
        loop {
            let statistics = peer.queries.call(&Query { seconds: 60.0 }).await?;
            if statistics.channels.first().is_some_and(|it| it.observations >= observations) {
                return Ok(statistics);
            }
        }
    }

    #[tokio::test]
    async fn what_was_observed_is_told_and_kept() -> scl::Result<()> {
        let folder = tempfile::tempdir()?;
        let (running, mut peer) = start(&folder).await?;
        observe(&mut peer, 500).await?;
        let statistics = ask_for(&mut peer, 500).await?;
        assert_eq!((statistics.channels[0].observations, statistics.channels[0].occupied), (500, 1.0));

        // The thread writes the rest when the component ends.
        running.abort();
        assert!(running.await.is_err());
        let (_running, mut peer) = start(&folder).await?;
        assert_eq!(ask_for(&mut peer, 500).await?.channels[0].observations, 500);
        Ok(())
    }

    #[tokio::test]
    async fn a_query_for_a_nonsensical_time_is_answered_with_an_error() -> scl::Result<()> {
        let folder = tempfile::tempdir()?;
        let (_running, mut peer) = start(&folder).await?;
        let statistics = peer.queries.call(&Query { seconds: -1.0 }).await?;
        assert_eq!(statistics.error, "seconds must be above 0 and at most 3600, not -1");
        Ok(())
    }

    #[tokio::test]
    async fn it_ends_when_the_database_is_not_its_own() -> scl::Result<()> {
        let folder = tempfile::tempdir()?;
        Connection::open(path(folder.path())).unwrap().execute_batch("CREATE TABLE bookmark (url TEXT)").unwrap();
        let (running, _peer) = start(&folder).await?;
        let refused = running.await.unwrap()?;
        assert!(refused.to_string().contains("it belongs to another program"), "{refused}");
        assert_eq!(fs::read_dir(folder.path())?.count(), 1, "only that database is there");
        Ok(())
    }

    #[test]
    fn options_are_checked() {
        for arguments in [["--max-size", "0"], ["--max-size", "-1"], ["--size", "1"]] {
            let error = Options::try_parse_from([&["resource_map"], arguments.as_slice()].concat()).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{error}");
        }
    }
}
