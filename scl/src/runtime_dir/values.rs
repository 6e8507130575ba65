//! The values of a component's parameters, in a file that is written in place: a new file for each change would wake
//! every component of the system.
//!
//! The content is JSON, `{"gain": "2"}`, and stands in the file twice, so that a reader knows a half-written one. Both
//! are written in order, so the first half is the newer one until the second is written too.

use super::SystemDir;
use super::error::RuntimeDirError;
use super::owned_path::OwnedPath;
use super::small_file::{read_file, write_temp};
use rustix::fs::{OFlags, ftruncate};
use rustix::io::pwrite;
use serde_json::{Map, Value};
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

/// Maximum size of a file that is read, in bytes: more than thousands of values need.
const LIMIT: u64 = 64 << 20;

/// Time after which a reader gives up: a file whose component was killed while it wrote will never be whole.
const PATIENCE: Duration = Duration::from_millis(100);

/// The file of a component of this process. It stays when this is dropped: the values are wanted after its end.
#[derive(Debug)]
pub(crate) struct ValuesFile {
    placed: OwnedPath,
    /// What was written last.
    content: Vec<u8>,
    /// Whether the last write failed, so that it is logged once.
    failed: bool,
}

impl ValuesFile {
    /// Creates the file, with mode 0600 and in one step.
    ///
    /// # Errors
    /// The file cannot be created or written.
    pub(crate) fn create(
        dir: &SystemDir,
        component: &str,
        values: &[(&'static str, String)],
    ) -> Result<Self, RuntimeDirError> {
        let content = twice(values);
        let placed = place(dir, &dir.file_of(component, ".values")?, &content)?;
        Ok(Self { placed, content, failed: false })
    }

    /// Creates the file again with what was written last, if it was removed.
    ///
    /// # Errors
    /// Those of [`create`](Self::create).
    pub(crate) fn restore(&mut self, dir: &SystemDir) -> Result<(), RuntimeDirError> {
        if !self.is_in_place() {
            let path = self.placed.path().to_owned();
            self.placed = place(dir, &path, &self.content)?;
        }
        Ok(())
    }

    pub(crate) fn is_in_place(&self) -> bool {
        self.placed.is_ours()
    }

    /// Replaces the values. A file that cannot be written, or was removed, does no harm.
    pub(crate) fn write(&mut self, values: &[(&'static str, String)]) {
        self.content = twice(values);
        let written = write_all(&self.placed, &self.content);
        if let Err(error) = &written
            && !self.failed
        {
            tracing::debug!(path = %self.placed.path().display(), %error, "cannot write the values of the parameters");
        }
        self.failed = written.is_err();
    }
}

/// Reads the values that a component wrote last, by name; `None` if there are none, or they cannot be understood.
pub(crate) fn read_values(dir: &SystemDir, component: &str) -> Option<Vec<(String, String)>> {
    let path = dir.file_of(component, ".values").ok()?;
    let started = Instant::now();
    loop {
        let content = read_file(&path, LIMIT).ok()?;
        if let Some(values) = once(&content) {
            return Some(values);
        }
        if started.elapsed() >= PATIENCE {
            return None;
        }
        std::thread::yield_now();
    }
}

/// Removes the file of a component that does not run.
pub(crate) fn remove_values(dir: &SystemDir, component: &str) {
    if let Ok(path) = dir.file_of(component, ".values") {
        // Usually there is none.
        let _removed = std::fs::remove_file(path);
    }
}

fn place(dir: &SystemDir, path: &Path, content: &[u8]) -> Result<OwnedPath, RuntimeDirError> {
    Ok(write_temp(dir.folder(), path, content)?.rename(path, OFlags::WRONLY)?.stay())
}

fn write_all(placed: &OwnedPath, content: &[u8]) -> io::Result<()> {
    for half in [0, 1] {
        let (mut at, end) = (half * content.len() / 2, (half + 1) * content.len() / 2);
        while at < end {
            match pwrite(placed.file(), &content[at..end], at as u64)? {
                0 => return Err(io::ErrorKind::WriteZero.into()),
                written => at += written,
            }
        }
    }
    Ok(ftruncate(placed.file(), content.len() as u64)?)
}

/// The content of the file.
fn twice(values: &[(&'static str, String)]) -> Vec<u8> {
    let values: Map<String, Value> =
        values.iter().map(|(name, value)| ((*name).to_owned(), value.as_str().into())).collect();
    let text = format!("{}\n", Value::Object(values));
    text.repeat(2).into_bytes()
}

/// The values, if the content is whole.
fn once(content: &[u8]) -> Option<Vec<(String, String)>> {
    let (first, second) = content.split_at(content.len() / 2);
    if first != second {
        return None;
    }
    let values: Map<String, Value> = serde_json::from_slice(first).ok()?;
    values.into_iter().map(|(name, value)| Some((name, value.as_str()?.to_owned()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runtime_dir::RuntimeDir;
    use std::sync::atomic::{AtomicBool, Ordering};

    fn folder() -> (tempfile::TempDir, SystemDir) {
        let root = tempfile::tempdir().unwrap();
        let variable = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| root.path().into());
        let dir = RuntimeDir::locate(&variable).unwrap().system("rover").unwrap();
        (root, dir)
    }

    #[test]
    fn values_stay_after_the_component() {
        let (_root, dir) = folder();
        assert_eq!(read_values(&dir, "controller"), None);
        let mut file = ValuesFile::create(&dir, "controller", &[("gain", "0.8".to_owned())]).unwrap();
        file.write(&[("gain", "10.25".to_owned()), ("name", "a \"b\"\nc".to_owned())]);
        file.write(&[("gain", "2".to_owned()), ("name", String::new())]);
        drop(file);
        let expected = [("gain", "2"), ("name", "")].map(|(name, value)| (name.to_owned(), value.to_owned()));
        assert_eq!(read_values(&dir, "controller"), Some(expected.to_vec()));
    }

    #[test]
    fn a_file_that_was_removed_is_restored_with_its_values() {
        let (_root, dir) = folder();
        let mut file = ValuesFile::create(&dir, "controller", &[("gain", "0.8".to_owned())]).unwrap();
        std::fs::remove_file(file.placed.path()).unwrap();
        file.write(&[("gain", "2".to_owned())]);
        assert!(!file.is_in_place());
        file.restore(&dir).unwrap();
        assert_eq!(read_values(&dir, "controller"), Some(vec![("gain".to_owned(), "2".to_owned())]));
    }

    #[test]
    fn a_file_that_is_not_whole_has_no_values() {
        let whole = twice(&[("gain", "0.8".to_owned())]);
        assert!(once(&whole).is_some());
        for length in 0..whole.len() {
            assert_eq!(once(&whole[..length]), None, "{length}");
        }
        let newer = twice(&[("gain", "0.9".to_owned())]);
        for length in 1..whole.len() {
            let torn = [&newer[..length], &whole[length..]].concat();
            let is_whole = once(&torn).is_some();
            assert_eq!(is_whole, torn == whole || torn == newer, "{length}");
        }
    }

    #[test]
    fn a_reader_gets_one_of_the_values_that_were_written() {
        let (_root, dir) = folder();
        let of = |number: usize| [("gain", "7".repeat(number)), ("name", "x".repeat(100 - number))];
        let mut file = ValuesFile::create(&dir, "controller", &of(1)).unwrap();
        let ended = AtomicBool::new(false);
        std::thread::scope(|threads| {
            threads.spawn(|| {
                for number in (1..100).cycle().take(5000) {
                    file.write(&of(number));
                }
                ended.store(true, Ordering::SeqCst);
            });
            let mut read = 0;
            while !ended.load(Ordering::SeqCst) {
                // On a busy machine a reader may find a half-written file until its patience ends.
                let Some(values) = read_values(&dir, "controller") else { continue };
                let [(_, gain), (_, name)] = values.as_slice() else { panic!("{values:?}") };
                assert_eq!(gain.len() + name.len(), 100);
                read += 1;
            }
            assert!(read_values(&dir, "controller").is_some() || read > 0);
        });
    }
}
