//! What may lie about in a folder, from bytes: files, links, folders, sockets and pipes, under names like the real
//! ones.

use arbitrary::{Result, Unstructured};
use rustix::fs::{CWD, FileType, Mode, mknodat};
use std::ffi::OsString;
use std::fs::{self, File, Permissions};
use std::io;
use std::os::unix::ffi::OsStringExt;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::os::unix::net::UnixListener;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

const PIECES: [&[u8]; 18] = [
    b"sink",
    b"source.readings--sink.readings",
    b"sink.jobs",
    b"sink.answer",
    b"source",
    b".lock",
    b".json",
    b".tcp",
    b".1a2b3c4d",
    b".00000a",
    b".",
    b"--",
    b"-",
    b" ",
    b"\n",
    b"\xff\xfe",
    "ß".as_bytes(),
    b"ggggggggggggggggggggggggggggggggggggggggggggggggggggggggggggg",
];

const CONTENTS: [&[u8]; 13] = [
    b"",
    b"1\n",
    b"-1",
    b"2147483647\n",
    b"99999999999999999999",
    b"127.0.0.1:80\n",
    b"[::1]:65535",
    b"127.0.0.1:0",
    b"{\"component\":\"sink\",\"pid\":1,\"started_ms\":18446744073709551615,\"program\":\"\",\"endpoints\":[]}",
    b"{\"component\":\"sink\",\"pid\":1,\"started_ms\":1,\"program\":\"\\u0000\",\"endpoints\":[{}]}",
    b"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[",
    b"SCLSTATS\x01\0\0\0\x18\0\0\0\0\0\0\0\0\0\0\0",
    b"\xff\xfe",
];

/// A name: mostly a real one, else one put together from pieces of them.
pub(super) fn name(bytes: &mut Unstructured<'_>, real: &[&str]) -> Result<OsString> {
    if bytes.ratio(1, 2)? {
        let ending = *bytes.choose(&["", "", ".tcp"])?;
        return Ok(format!("{}{ending}", bytes.choose(real)?).into());
    }
    let mut name = Vec::new();
    for _ in 0..bytes.int_in_range(1..=3)? {
        name.extend_from_slice(bytes.choose(&PIECES)?);
    }
    // A link or file of such a name would be another folder.
    if name.iter().all(|&byte| byte == b'.') {
        name.push(b'x');
    }
    Ok(OsString::from_vec(name))
}

/// Puts something at a free path, if the operating system has nothing against it. Links lead to one of the targets.
pub(super) fn put(bytes: &mut Unstructured<'_>, path: &Path, targets: &[PathBuf]) -> Result<()> {
    // Writing would follow a link, and wait at a pipe.
    if fs::symlink_metadata(path).is_ok() {
        return Ok(());
    }
    let _refused = match bytes.int_in_range(0..=7)? {
        0..=2 => fs::write(path, content(bytes)?),
        3 | 4 => symlink(bytes.choose(targets)?, path),
        5 => put_folder(path, bytes.arbitrary()?),
        6 => UnixListener::bind(path).map(drop),
        _ => mknodat(CWD, path, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).map_err(io::Error::from),
    };
    let is_link = fs::symlink_metadata(path).is_ok_and(|seen| seen.is_symlink());
    if !is_link && bytes.ratio(1, 4)? {
        let _refused = fs::set_permissions(path, Permissions::from_mode(bytes.int_in_range(0..=0o7777)?));
    }
    let is_file = fs::symlink_metadata(path).is_ok_and(|seen| seen.is_file());
    if is_file && bytes.ratio(1, 4)? {
        let _refused = make_old(path, bytes.arbitrary()?);
    }
    Ok(())
}

fn content(bytes: &mut Unstructured<'_>) -> Result<Vec<u8>> {
    let mut content = bytes.choose(&CONTENTS)?.to_vec();
    if bytes.ratio(1, 3)? {
        let more = bytes.int_in_range(0..=40)?.min(bytes.len());
        content.extend_from_slice(bytes.bytes(more)?);
    }
    if bytes.ratio(1, 16)? {
        content = content.repeat(1 << 12);
    }
    Ok(content)
}

fn put_folder(path: &Path, full: bool) -> io::Result<()> {
    fs::create_dir(path)?;
    if full { fs::write(path.join("inside"), "x") } else { Ok(()) }
}

fn make_old(path: &Path, seconds: u32) -> io::Result<()> {
    let time = SystemTime::now() - Duration::from_secs(seconds.into());
    File::options().append(true).open(path)?.set_modified(time)
}
