//! C++ programs of tests: generated headers, messages compiled by protoc, and the programs, each compiled once for each
//! content of its sources. They stay in the build folder, because programs with libprotobuf take seconds to compile.

use scl_generate::{System, Target, generate};
use scl_loader::{Request, load};
use scl_tests::{Compile, c_library, lock_file};
use std::collections::hash_map::DefaultHasher;
use std::ffi::OsStr;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;

/// How a program is compiled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Build {
    Plain,
    /// With AddressSanitizer and UndefinedBehaviorSanitizer; a leak is a failure.
    Address,
    /// With ThreadSanitizer.
    Thread,
}

/// A folder with the generated header of a topology and the headers and sources of its messages.
#[derive(Debug, Clone)]
pub(crate) struct Generated {
    pub(crate) folder: PathBuf,
    sources: Vec<PathBuf>,
}

impl Build {
    fn options(self) -> &'static [&'static str] {
        match self {
            Build::Plain => &["-pthread"],
            Build::Address => &["-pthread", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"],
            // Headers of libprotobuf add members to maps for this macro, which the installed library does not have.
            Build::Thread => &["-pthread", "-fsanitize=thread", "-O1", "-U__SANITIZE_THREAD__"],
        }
    }
}

/// The folder `bindings/cpp`.
pub(crate) fn binding() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace").join("bindings/cpp")
}

/// The options that find the headers of the binding.
pub(crate) fn include_options() -> Vec<String> {
    [binding().join("include"), c_library().include.clone()].map(|folder| format!("-I{}", folder.display())).into()
}

/// A compiled program: a source, the schema and header of a topology file, and the C library.
pub(crate) fn program(source: &Path, topology: &Path, build: Build) -> PathBuf {
    let generated = generated(topology);
    let mut options = include_options();
    options.push(format!("-I{}", generated.folder.display()));
    options.push(format!("-I{}", binding().join("tests/programs").display()));
    let inputs: Vec<PathBuf> = [&[source.to_owned(), generated.folder.clone()], &headers()[..]].concat();
    let name = source.file_stem().unwrap_or_default();
    cached(name, &inputs, &(build.options(), &options), |path| {
        let objects = generated.sources.iter().map(|source| object(source, &generated.folder, build));
        let compile = objects.fold(Compile::cpp(source), Compile::source).option("-pedantic");
        let options = options.iter().map(String::as_str).chain(build.options().iter().copied());
        options.fold(compile, Compile::option).option("-lprotobuf").program(path);
    })
}

/// The generated header of a topology file, with what protoc makes of its schemas.
pub(crate) fn generated(topology: &Path) -> Generated {
    let loaded = load(&Request::new(topology));
    let mut system = System::of(&loaded).unwrap_or_else(|| panic!("{topology:?}: {:?}", loaded.diagnostics));
    // The tests of CMake have headers without counterparts.
    system.make_testable();
    let files = generate(&system, Target::Cpp).unwrap_or_else(|clashes| panic!("{clashes:?}"));
    let texts: Vec<_> = files.iter().map(|file| &file.text).collect();
    let folder = cached(OsStr::new("generated"), &loaded.files_read, &texts, |folder| {
        fs::create_dir_all(folder).expect("a folder");
        for file in &files {
            fs::write(folder.join(&file.name), &file.text).expect("a generated file");
        }
        let home = topology.parent().expect("the folder of the topology");
        for schema in schemas(&system) {
            run(Command::new("protoc").arg("-I").arg(home).arg("--cpp_out").arg(folder).arg(schema));
        }
    });
    let sources = schemas(&system).map(|schema| folder.join(schema.replace(".proto", ".pb.cc"))).collect();
    Generated { folder, sources }
}

fn schemas(system: &System) -> impl Iterator<Item = &str> {
    let files = system.descriptors.iter().flat_map(|set| &set.file).map(|file| file.name());
    files.filter(|name| !name.starts_with("google/protobuf/"))
}

fn object(source: &Path, folder: &Path, build: Build) -> PathBuf {
    cached(OsStr::new("messages"), &[folder.to_owned(), source.to_owned()], &build.options(), |path| {
        let mut command = Command::new("c++");
        command.args(["-std=c++17", "-g1", "-c"]).arg("-I").arg(folder).args(build.options());
        run(command.arg(source).arg("-o").arg(path));
    })
    .with_extension("")
}

/// The headers of both bindings and the sources that programs share.
fn headers() -> Vec<PathBuf> {
    vec![binding().join("include"), c_library().include.clone(), binding().join("tests/programs/support.hpp")]
}

/// A file or folder that is made from inputs: made if it is not there for the same content of all inputs.
pub(crate) fn cached(name: &OsStr, inputs: &[PathBuf], more: &impl Hash, make: impl FnOnce(&Path)) -> PathBuf {
    let mut hasher = DefaultHasher::new();
    more.hash(&mut hasher);
    inputs.iter().for_each(|input| hash_content(input, &mut hasher));
    let folder = c_library().folder.join("scl-tests-cpp");
    fs::create_dir_all(&folder).expect("a folder below the build folder");
    let path = folder.join(format!("{}-{:016x}", name.to_string_lossy(), hasher.finish()));
    if !path.exists() {
        // Tests of other processes wait for what this one makes.
        let _alone = lock_file(&path.with_extension("lock"));
        if !path.exists() {
            let unfinished = path.with_extension(format!("{}.o", std::process::id()));
            make(&unfinished);
            fs::rename(&unfinished, &path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
        }
    }
    path
}

fn hash_content(path: &Path, hasher: &mut DefaultHasher) {
    if !path.is_dir() {
        return fs::read(path).unwrap_or_else(|error| panic!("{path:?}: {error}")).hash(hasher);
    }
    let mut entries: Vec<_> = fs::read_dir(path).expect("a folder").flatten().map(|entry| entry.path()).collect();
    entries.sort();
    for entry in entries {
        entry.file_name().hash(hasher);
        hash_content(&entry, hasher);
    }
}

/// Runs a tool of the system.
pub(crate) fn run(command: &mut Command) -> String {
    let advice = "on Debian: apt-get install g++ cmake pkg-config protobuf-compiler libprotobuf-dev valgrind";
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}; {advice}"));
    let text = format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?}\n{text}");
    text
}
