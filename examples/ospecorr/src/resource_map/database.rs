//! The database file: one table of observations in SQLite.

use std::path::Path;
use std::time::Duration;

use rusqlite::{Connection, ErrorCode, OpenFlags, TransactionBehavior, ffi};

use super::statistics::Observation;

/// Identifies these databases in the header of the file, so that those of other programs are not accepted: `OSPR`.
const APPLICATION_ID: i32 = 0x4F53_5052;

/// Schema version, also in the header of the file. Increment it when the tables below change.
const SCHEMA_VERSION: i32 = 1;

/// Observations in order of their times: without row numbers, the primary key is the order in the file.
const SCHEMA: &str = "
    CREATE TABLE observation (
        time_us INTEGER NOT NULL, -- since 1970
        channel INTEGER NOT NULL,
        power_db REAL NOT NULL,
        occupied INTEGER NOT NULL,
        PRIMARY KEY (time_us, channel)
    ) STRICT, WITHOUT ROWID;
";

/// How long to wait for a lock; short, because observations and queries wait, too.
const BUSY_TIMEOUT: Duration = Duration::from_millis(50);

const PAGE_BYTES: u64 = 4096;

/// The length at which the log is copied into the file; short, because what is in the log when the disk becomes full
/// still needs space in the file.
const LOG_PAGES: u32 = 32;

/// Why a database was not opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The file has other tables.
    #[error("it belongs to another program")]
    Foreign,
    /// The tables have another schema version.
    #[error("it has schema version {found}, this program knows version {SCHEMA_VERSION}")]
    Version {
        /// The schema version of the file.
        found: i32,
    },
    /// SQLite reported an error.
    #[error(transparent)]
    Sqlite(#[from] rusqlite::Error),
}

/// What is wrong with a database, and so what can be done about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// Another process has locked it.
    Locked,
    /// It has reached its maximum size, or the disk is full.
    Full,
    /// It is damaged, or not a database.
    Corrupt,
    /// Anything else.
    Other,
}

impl Trouble {
    /// Classifies an error.
    pub fn of(error: &rusqlite::Error) -> Self {
        match error.sqlite_error_code() {
            Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => Self::Locked,
            Some(ErrorCode::DiskFull) => Self::Full,
            Some(ErrorCode::DatabaseCorrupt | ErrorCode::NotADatabase) => Self::Corrupt,
            _ => Self::Other,
        }
    }
}

/// An open database.
pub struct Database {
    connection: Connection,
}

impl Database {
    /// Opens or creates a database of at most `max_bytes`, and checks its integrity.
    ///
    /// # Errors
    /// See [`OpenError`].
    pub fn open(path: &Path, max_bytes: u64) -> Result<Self, OpenError> {
        let flags = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_CREATE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let mut connection = Connection::open_with_flags(path, flags)?;
        connection.busy_timeout(BUSY_TIMEOUT)?;
        prepare_tables(&mut connection)?;
        // With a write-ahead log other processes can read while this one writes. `NORMAL` may lose the last
        // transactions in a power failure, but does not damage the file.
        connection.pragma_update(None, "journal_mode", "WAL")?;
        connection.pragma_update(None, "synchronous", "NORMAL")?;
        connection.pragma_update(None, "wal_autocheckpoint", LOG_PAGES)?;
        let max_pages = u32::try_from(max_bytes / PAGE_BYTES).unwrap_or(u32::MAX);
        connection.pragma_update(None, "max_page_count", max_pages)?;
        check_bytes(&connection)?;
        Ok(Self { connection })
    }

    /// Writes observations and removes those from before `oldest_us`, in one transaction: all of it or nothing.
    ///
    /// # Errors
    /// Errors of SQLite.
    pub fn write(&mut self, new: impl Iterator<Item = Observation>, oldest_us: i64) -> rusqlite::Result<()> {
        let transaction = self.connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
        transaction.prepare_cached("DELETE FROM observation WHERE time_us < ?1")?.execute([oldest_us])?;
        {
            let mut insert =
                transaction.prepare_cached("INSERT OR REPLACE INTO observation VALUES (?1, ?2, ?3, ?4)")?;
            for Observation { time_us, channel, power_db, occupied } in new {
                insert.execute((time_us, channel, power_db, occupied))?;
            }
        }
        transaction.commit()
    }

    /// Calls `each` with the observations from `from_us` on, in order of their times.
    ///
    /// # Errors
    /// Errors of SQLite.
    pub fn read(&self, from_us: i64, mut each: impl FnMut(Observation)) -> rusqlite::Result<()> {
        let query = "SELECT time_us, channel, power_db, occupied FROM observation WHERE time_us >= ?1 \
                     ORDER BY time_us, channel";
        let mut select = self.connection.prepare_cached(query)?;
        let mut rows = select.query([from_us])?;
        while let Some(row) = rows.next()? {
            each(Observation {
                time_us: row.get(0)?,
                channel: row.get(1)?,
                power_db: row.get(2)?,
                occupied: row.get(3)?,
            });
        }
        Ok(())
    }

    /// Removes the observations from the oldest quarter of the recorded time. The file does not grow from then on: the
    /// space that this frees is enough.
    ///
    /// # Errors
    /// Errors of SQLite.
    pub fn remove_oldest(&mut self) -> rusqlite::Result<()> {
        let delete = "DELETE FROM observation WHERE time_us < \
                      (SELECT min(time_us) + (max(time_us) - min(time_us)) / 4 FROM observation)";
        self.connection.execute(delete, [])?;
        // Copy the log into the database file and truncate it.
        self.connection.query_one("PRAGMA wal_checkpoint(TRUNCATE)", [], |_| Ok(()))?;
        let pages: u32 = self.connection.pragma_query_value(None, "page_count", |row| row.get(0))?;
        self.connection.pragma_update(None, "max_page_count", pages)
    }
}

/// Makes sure that the file has this program's tables. Creates them if it is empty.
fn prepare_tables(connection: &mut Connection) -> Result<(), OpenError> {
    // Lock out other writers, so none of them creates tables in between.
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let number = |pragma| transaction.pragma_query_value(None, pragma, |row| row.get::<_, i32>(0));
    let (application, version) = (number("application_id")?, number("user_version")?);
    let tables: i64 = transaction.query_one("SELECT count(*) FROM sqlite_schema", [], |row| row.get(0))?;
    match (application, version, tables) {
        (0, 0, 0) => {
            transaction.execute_batch(SCHEMA)?;
            transaction.pragma_update(None, "application_id", APPLICATION_ID)?;
            transaction.pragma_update(None, "user_version", SCHEMA_VERSION)?;
            transaction.commit()?;
            Ok(())
        }
        (APPLICATION_ID, SCHEMA_VERSION, _) => Ok(()),
        (APPLICATION_ID, found, _) => Err(OpenError::Version { found }),
        _ => Err(OpenError::Foreign),
    }
}

fn check_bytes(connection: &Connection) -> rusqlite::Result<()> {
    let found: String = connection.pragma_query_value(None, "quick_check", |row| row.get(0))?;
    if found == "ok" {
        return Ok(());
    }
    Err(rusqlite::Error::SqliteFailure(ffi::Error::new(ffi::SQLITE_CORRUPT), Some(found)))
}
