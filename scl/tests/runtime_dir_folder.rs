//! Which folder is the runtime folder, and which folders are refused.
#![allow(clippy::unwrap_used)]

use std::{
    ffi::OsString,
    fs,
    os::unix::{
        ffi::OsStringExt,
        fs::{MetadataExt, PermissionsExt, chown, symlink},
    },
    path::{Path, PathBuf},
};

use scl::runtime_dir::{RuntimeDir, RuntimeDirError};

type Variables<'v> = &'v [(&'v str, &'v Path)];

fn locate(variables: Variables<'_>) -> Result<RuntimeDir, RuntimeDirError> {
    let value = |name: &str| variables.iter().find(|(known, _)| *known == name).map(|(_, path)| path.into());
    RuntimeDir::locate(&value)
}

fn refusal(variables: Variables<'_>) -> String {
    locate(variables).unwrap_err().to_string()
}

fn mode(path: &Path) -> u32 {
    fs::metadata(path).unwrap().mode() & 0o7777
}

fn create(path: &Path, mode: u32) {
    fs::create_dir(path).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
}

fn own_user() -> u32 {
    rustix::process::geteuid().as_raw()
}

#[test]
fn the_first_that_applies_is_created_with_mode_0700() {
    let root = tempfile::tempdir().unwrap();
    let [chosen, session, temporary] = ["chosen/deep", "session", "tmp"].map(|name| root.path().join(name));
    let (relative, missing) = (Path::new("session"), root.path().join("missing"));
    for folder in [&session, &temporary] {
        create(folder, 0o755);
    }
    let of_user = temporary.join(format!("scl-{}", own_user()));
    let (all, empty) = (("XDG_RUNTIME_DIR", session.as_path()), Path::new(""));
    let tmp = ("TMPDIR", temporary.as_path());
    let cases: [(Variables<'_>, PathBuf); 6] = [
        (&[("SCL_RUNTIME_DIR", &chosen), all, tmp], chosen.clone()),
        (&[("SCL_RUNTIME_DIR", empty), all, tmp], session.join("scl")),
        (&[all, tmp], session.join("scl")),
        (&[("XDG_RUNTIME_DIR", &missing), tmp], of_user.clone()),
        (&[("XDG_RUNTIME_DIR", relative), tmp], of_user.clone()),
        (&[tmp], of_user),
    ];
    for (variables, expected) in cases {
        // The first time it is created, the second time it exists.
        for _ in 0..2 {
            assert_eq!(locate(variables).unwrap().path(), expected);
            assert_eq!(mode(&expected), 0o700);
        }
    }
    assert_eq!(mode(&root.path().join("chosen")), 0o700);
}

#[test]
fn a_session_folder_of_another_user_does_not_apply() {
    let temporary = tempfile::tempdir().unwrap();
    let foreign = foreign_folder(temporary.path());
    let found = locate(&[("XDG_RUNTIME_DIR", &foreign), ("TMPDIR", temporary.path())]).unwrap();
    assert_eq!(found.path(), temporary.path().join(format!("scl-{}", own_user())));
}

#[test]
fn a_name_that_is_not_utf8_is_allowed() {
    let root = tempfile::tempdir().unwrap();
    let odd = root.path().join(OsString::from_vec(b"r\xff\xfen".to_vec()));
    assert_eq!(locate(&[("SCL_RUNTIME_DIR", &odd)]).unwrap().path(), odd);
    assert!(odd.is_dir());
}

#[test]
fn a_relative_folder_is_refused() {
    assert_eq!(
        refusal(&[("SCL_RUNTIME_DIR", Path::new("run/scl"))]),
        "`SCL_RUNTIME_DIR` is `run/scl`, which is not an absolute path\n\
         help: use an absolute path, so that all components use the same folder wherever they are started"
    );
}

#[test]
fn links_and_files_are_refused() {
    let root = tempfile::tempdir().unwrap();
    let [real, link, dangling, file] = ["real", "link", "dangling", "file"].map(|name| root.path().join(name));
    create(&real, 0o700);
    symlink(&real, &link).unwrap();
    symlink(root.path().join("nowhere"), &dangling).unwrap();
    fs::write(&file, "").unwrap();
    let slash = root.path().join("link/");
    for (path, found) in
        [(&link, "a symbolic link"), (&slash, "a symbolic link"), (&dangling, "a symbolic link"), (&file, "a file")]
    {
        let text = refusal(&[("SCL_RUNTIME_DIR", path)]);
        assert!(text.contains(&format!("is {found}, not a folder\nhelp: remove it")), "{text}");
    }
    assert!(!root.path().join("nowhere").exists());
    // The same in a folder that everybody may write to, where such an attack would happen.
    symlink(&real, root.path().join(format!("scl-{}", own_user()))).unwrap();
    assert!(refusal(&[("TMPDIR", root.path())]).contains("is a symbolic link, not a folder"));
}

#[test]
fn folders_open_to_others_are_refused() {
    let cases = [
        // Mode, the error if the user chose the folder, the error if it is the default.
        (0o700, "", ""),
        (0o755, "", "every user may access"),
        (0o750, "", "the group may access"),
        (0o770, "the group may write to", "the group may write to"),
        (0o720, "the group may write to", "the group may write to"),
        (0o702, "every user may write to", "every user may write to"),
        (0o1777, "every user may write to", "every user may write to"),
        (0o701, "", "every user may access"),
    ];
    for (mode, chosen, default) in cases {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join(format!("scl-{}", own_user()));
        create(&path, mode);
        let shown = path.display();
        for (expected, variable) in [(chosen, ("SCL_RUNTIME_DIR", path.as_path())), (default, ("TMPDIR", root.path()))]
        {
            let found = locate(&[variable]).map_or_else(|error| error.to_string(), |_| String::new());
            let text = format!(
                "{expected} the runtime folder `{shown}` (mode {mode:04o})\n\
                 help: run `chmod 700 '{shown}'`, or choose another folder with `SCL_RUNTIME_DIR`"
            );
            assert_eq!(found, if expected.is_empty() { String::new() } else { text }, "{mode:o}");
        }
    }
}

#[test]
fn a_folder_of_another_user_is_refused() {
    let root = tempfile::tempdir().unwrap();
    let foreign = foreign_folder(root.path());
    let error = locate(&[("SCL_RUNTIME_DIR", &foreign)]).unwrap_err();
    assert!(matches!(error, RuntimeDirError::ForeignOwner { owner, user, .. } if owner != user && user == own_user()));
    assert!(error.to_string().contains("help: run all components of a system as the same user"), "{error}");
}

#[test]
fn a_folder_that_cannot_be_created_is_an_error_with_a_source() {
    let error = locate(&[("SCL_RUNTIME_DIR", Path::new("/proc/scl/run"))]).unwrap_err();
    assert!(error.to_string().starts_with("cannot create the runtime folder `/proc/scl/run`\nhelp: "), "{error}");
    assert!(std::error::Error::source(&error).is_some());
    let zero = PathBuf::from(OsString::from_vec(b"/tmp/a\0b".to_vec()));
    assert!(refusal(&[("SCL_RUNTIME_DIR", &zero)]).starts_with("cannot create the runtime folder"));
}

#[test]
fn the_folder_of_a_system_is_verified_too() {
    let root = tempfile::tempdir().unwrap();
    let runtime = locate(&[("SCL_RUNTIME_DIR", root.path())]).unwrap();
    let rover = runtime.system("rover").unwrap();
    assert_eq!(rover.folder(), root.path().join("rover"));
    assert_eq!(mode(rover.folder()), 0o700);
    for name in ["", ".", "..", ".hidden", "a/b", "/tmp", "a\0b", "a b", "ä"] {
        let text = runtime.system(name).unwrap_err().to_string();
        assert!(text.starts_with(&format!("`{name}` cannot be the name of a system\nhelp: ")), "{text}");
    }
    create(&root.path().join("open"), 0o755);
    symlink(rover.folder(), root.path().join("link")).unwrap();
    assert!(matches!(runtime.system("open"), Err(RuntimeDirError::OpenToOthers { .. })));
    assert!(matches!(runtime.system("link"), Err(RuntimeDirError::NotAFolder { .. })));
}

#[test]
fn paths_up_to_the_limit_fit_and_longer_ones_are_explained() {
    let root = tempfile::tempdir().unwrap();
    let used = root.path().as_os_str().len() + "/rover/".len();
    let rover = locate(&[("SCL_RUNTIME_DIR", root.path())]).unwrap().system("rover").unwrap();
    let longest = "g".repeat(107 - used);
    assert_eq!(rover.path(&longest).unwrap().as_os_str().len(), 107);
    let longer = longest + "g";
    let room = root.path().as_os_str().len() - 1;
    assert_eq!(
        rover.path(&longer).unwrap_err().to_string(),
        format!(
            "the path of the socket `{}/{longer}` takes 108 bytes, but the operating system allows 107\n\
             help: set `SCL_RUNTIME_DIR` to a folder of at most {room} bytes, such as `/tmp/scl`, \
             or shorten the names of the components and gates",
            rover.folder().display()
        )
    );
    // The temporary name of seven bytes must fit too, even if the endpoint is shorter.
    let folder = root.path().join("d".repeat(99 - root.path().as_os_str().len() - "/".len() - "/s".len()));
    let deep = locate(&[("SCL_RUNTIME_DIR", &folder)]).unwrap().system("s").unwrap();
    assert_eq!(deep.path("a.b").unwrap().as_os_str().len(), 103);
    let deeper = locate(&[("SCL_RUNTIME_DIR", &folder)]).unwrap().system("s2").unwrap();
    assert!(matches!(deeper.path("a.b"), Err(RuntimeDirError::PathTooLong { length: 108, .. })));
    let hopeless = rover.path(&"g".repeat(200)).unwrap_err().to_string();
    assert!(hopeless.ends_with("no folder is short enough"), "{hopeless}");
}

#[test]
fn endpoints_that_are_not_file_names_or_are_reserved_are_refused() {
    let root = tempfile::tempdir().unwrap();
    let rover = locate(&[("SCL_RUNTIME_DIR", root.path())]).unwrap().system("rover").unwrap();
    for endpoint in ["", ".00000a", "../escape", "a/b", "a\0"] {
        assert!(matches!(rover.path(endpoint), Err(RuntimeDirError::BadName { .. })), "{endpoint:?}");
    }
    // As the topology shortens long names.
    assert!(rover.path("sensor.measurements--contr~a2b3c4d5.1a2b3c4d").is_ok());
    for endpoint in ["sensor.lock", "sensor.json", "sensor.tcp", "sensor.schema"] {
        assert!(matches!(rover.path(endpoint), Err(RuntimeDirError::ReservedName { .. })), "{endpoint}");
    }
}

/// A folder of another user. Only root can create one; for other users, `/usr` is one.
fn foreign_folder(root: &Path) -> PathBuf {
    if own_user() != 0 {
        return "/usr".into();
    }
    let path = root.join("foreign");
    create(&path, 0o700);
    chown(&path, Some(65_534), None).unwrap();
    path
}
