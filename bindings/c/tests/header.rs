//! The header is what cbindgen writes today.

use std::path::Path;

#[test]
fn the_header_is_current() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_file(package.join("cbindgen.toml")).unwrap();
    let mut written = Vec::new();
    cbindgen::generate_with_config(package, config).unwrap().write(&mut written);
    let written = String::from_utf8(written).unwrap();
    let header = package.join("include/scl.h");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&header, &written).unwrap();
    }
    let committed = std::fs::read_to_string(&header).unwrap_or_default();
    let advice = "include/scl.h is not current: run `UPDATE_EXPECT=1 cargo test -p scl-c` and read the difference";
    assert!(committed == written, "{advice}");
}
