//! The header is what cbindgen writes today.

use scl_tests::Compile;
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

#[test]
fn the_header_compiles_without_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let source = folder.path().join("header.c");
    std::fs::write(&source, "#include <scl.h>\nint main(void) { return scl_abi() == SCL_ABI ? SCL_OK : 1; }\n")
        .unwrap();
    Compile::c(&source).option("-pedantic").check().unwrap();
    // The static library has everything but the libraries of the system.
    let program = folder.path().join("static");
    let library = scl_tests::c_library().folder.join("libscl.a");
    let mut compile = std::process::Command::new("cc");
    compile.arg("-I").arg(&scl_tests::c_library().include).arg(&source).arg(library);
    assert!(compile.args(["-lpthread", "-ldl", "-lm", "-o"]).arg(&program).status().unwrap().success());
    assert!(std::process::Command::new(&program).status().unwrap().success());
}
