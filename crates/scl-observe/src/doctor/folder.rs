//! The runtime folder: whether it can be used, how long the names of sockets may be, and the room on its disk.

use super::{Examined, Finding};
use rustix::fs::statvfs;
use scl::runtime_dir::RuntimeDir;
use scl_terminal::{bytes_text, escape, message_and_help};
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::MetadataExt;
use std::path::Path;

const CHECK: &str = "runtime folder";
const SOCKETS: &str = "socket paths";
const DISK: &str = "disk";

/// The longest path of a Unix socket in bytes.
const SOCKET_PATH: usize = 107;

/// Number of bytes for the names of system and socket below which usual names may not fit: the checker shortens names
/// so that they fit into the longest default folder, `/run/user/4294967295/scl`.
const USUAL_NAMES: usize = SOCKET_PATH - "/run/user/4294967295/scl/".len();

/// Less free memory or disk space than this, in bytes, is reported.
const SCARCE: u64 = 16 << 20;

pub(super) fn check(examined: &Examined<'_>) -> Vec<Finding> {
    match RuntimeDir::existing(&|name| examined.variable(name)) {
        Ok(Some(dir)) => vec![usable(dir.path()), socket_paths(dir.path()), disk(dir.path())],
        Ok(None) => vec![Finding::note(CHECK, "it does not exist yet; the first component creates it")],
        Err(error) => {
            let (message, help) = message_and_help(&error);
            let finding = Finding::error(CHECK, escape(&message));
            vec![match help {
                Some(help) => finding.help(help),
                None => finding.help("choose another folder with `SCL_RUNTIME_DIR`"),
            }]
        }
    }
}

/// Reports a folder as usable; its owner and mode were checked when it was found.
fn usable(path: &Path) -> Finding {
    let mode = fs::metadata(path).map_or(0, |found| found.mode() & 0o7777);
    Finding::ok(CHECK, format!("`{}`, mode {mode:04o}", escape(&path.to_string_lossy())))
}

fn socket_paths(path: &Path) -> Finding {
    let room = SOCKET_PATH.saturating_sub(path.as_os_str().as_bytes().len() + 1);
    judge_room(room)
}

fn judge_room(room: usize) -> Finding {
    let text = format!("{room} bytes are left for the names of system and socket");
    if room >= USUAL_NAMES {
        Finding::ok(SOCKETS, text)
    } else {
        Finding::warning(SOCKETS, format!("{text}, {USUAL_NAMES} are usual: components with long names cannot start"))
            .help("choose a shorter folder with `SCL_RUNTIME_DIR`")
    }
}

fn disk(path: &Path) -> Finding {
    match statvfs(path) {
        Ok(found) => judge_disk(found.f_bavail.saturating_mul(found.f_frsize), found.f_favail),
        Err(error) => Finding::warning(DISK, format!("cannot read how much is free: {error}")),
    }
}

fn judge_disk(free: u64, free_files: u64) -> Finding {
    let text = format!("{} free where the runtime folder is", bytes_text(free as f64));
    if free == 0 || free_files == 0 {
        Finding::error(DISK, "nothing is free where the runtime folder is: components cannot start")
            .help("remove files there, or choose another folder with `SCL_RUNTIME_DIR`")
    } else if free < SCARCE {
        Finding::warning(DISK, format!("only {text}")).help("remove files there")
    } else {
        Finding::ok(DISK, text)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Severity;
    use super::*;
    use std::ffi::OsString;
    use std::os::unix::fs::PermissionsExt;

    fn found(folder: &Path) -> Vec<Finding> {
        let variables: [(OsString, OsString); 1] = [("SCL_RUNTIME_DIR".into(), folder.into())];
        check(&Examined { variables: &variables, systems: Vec::new() })
    }

    #[test]
    fn a_folder_is_usable_missing_or_refused() {
        let folder = tempfile::tempdir().unwrap();
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o700)).unwrap();
        let ok = found(folder.path());
        assert_eq!(ok[0].severity, Severity::Ok, "{ok:?}");
        assert!(ok[0].message.ends_with(", mode 0700"), "{ok:?}");
        let missing = found(&folder.path().join("missing"));
        assert_eq!((missing.len(), missing[0].severity), (1, Severity::Note));
        assert!(!folder.path().join("missing").exists());
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o777)).unwrap();
        let open = found(folder.path());
        assert_eq!(open[0].severity, Severity::Error);
        assert!(open[0].help.is_some(), "{open:?}");
        assert_eq!(found(Path::new("relative"))[0].severity, Severity::Error);
    }

    #[test]
    fn room_is_judged() {
        for (room, expected) in [(0, Severity::Warning), (81, Severity::Warning), (82, Severity::Ok)] {
            assert_eq!(judge_room(room).severity, expected, "{room}");
        }
        for (free, files, expected) in [
            (0, 9, Severity::Error),
            (1 << 30, 0, Severity::Error),
            (1 << 20, 9, Severity::Warning),
            (1 << 30, 9, Severity::Ok),
        ] {
            assert_eq!(judge_disk(free, files).severity, expected, "{free} {files}");
        }
    }
}
