//! A temporary folder for the sockets of a benchmark.

use tempfile::TempDir;

/// A temporary folder, removed when dropped. Its subfolder `raw` is for sockets that are not SCL's.
pub(crate) struct ScratchFolder {
    _folder: TempDir,
    pub(crate) path: String,
}

impl ScratchFolder {
    pub(crate) fn new() -> scl::Result<Self> {
        let folder = tempfile::Builder::new().prefix("scl-bench").tempdir()?;
        std::fs::create_dir(folder.path().join("raw"))?;
        let not_utf8 =
            || scl::Error::message(format!("the name of the folder `{}` is not UTF-8", folder.path().display()));
        let path = folder.path().to_str().ok_or_else(not_utf8)?.to_owned();
        Ok(Self { _folder: folder, path })
    }
}
