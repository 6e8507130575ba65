//! C and C++ programs of tests, compiled by the system's compilers and linked with the C library of this workspace.

use crate::cargo::{build, build_alone, workspace};
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// The C library as cargo builds it, with its header.
#[derive(Debug)]
pub struct CLibrary {
    /// The folder of `libscl.so` and `libscl.a`.
    pub folder: PathBuf,
    /// The folder of `scl.h`.
    pub include: PathBuf,
}

/// A run of a compiler.
#[derive(Debug, Clone)]
pub struct Compile {
    compiler: &'static str,
    sources: Vec<PathBuf>,
    options: Vec<String>,
    library: fn() -> &'static CLibrary,
}

/// Builds the C library, once for each test program.
///
/// # Panics
/// If it does not compile.
pub fn c_library() -> &'static CLibrary {
    static LIBRARY: OnceLock<CLibrary> = OnceLock::new();
    LIBRARY.get_or_init(|| CLibrary::in_folder(build("scl-c")))
}

/// The same without shared memory, whatever other packages ask for.
fn c_library_without_shm() -> &'static CLibrary {
    static LIBRARY: OnceLock<CLibrary> = OnceLock::new();
    LIBRARY.get_or_init(|| CLibrary::in_folder(build_alone("scl-c")))
}

impl CLibrary {
    fn in_folder(folder: PathBuf) -> Self {
        Self { folder, include: workspace().join("bindings/c/include") }
    }
}

impl Compile {
    /// A C11 program, with all warnings as errors, linked with the C library.
    pub fn c(source: impl Into<PathBuf>) -> Self {
        Self::with("cc", "-std=c11", source.into())
    }

    /// A C++17 program, with all warnings as errors, linked with the C library.
    pub fn cpp(source: impl Into<PathBuf>) -> Self {
        Self::with("c++", "-std=c++17", source.into())
    }

    fn with(compiler: &'static str, standard: &str, source: PathBuf) -> Self {
        let options = [standard, "-Wall", "-Wextra", "-Werror", "-g1"].map(str::to_owned).into();
        Self { compiler, sources: vec![source], options, library: c_library }
    }

    /// One more source.
    #[must_use]
    pub fn source(mut self, source: impl Into<PathBuf>) -> Self {
        self.sources.push(source.into());
        self
    }

    /// Linked with a C library that was built without shared memory.
    #[must_use]
    pub fn without_shm(mut self) -> Self {
        self.library = c_library_without_shm;
        self
    }

    /// One more option of the compiler.
    #[must_use]
    pub fn option(mut self, option: impl Into<String>) -> Self {
        self.options.push(option.into());
        self
    }

    /// Compiles and links a program.
    ///
    /// # Panics
    /// If it does not compile.
    #[track_caller]
    pub fn program(&self, path: &Path) {
        if let Err(text) = self.try_program(path) {
            panic!("{:?} does not compile:\n{text}", self.sources);
        }
    }

    /// Compiles and links a program.
    ///
    /// # Errors
    /// What the compiler says.
    pub fn try_program(&self, path: &Path) -> Result<(), String> {
        let CLibrary { folder, .. } = (self.library)();
        // The library that it is linked with, whatever the variables say that cargo sets for tests.
        let mut rpath = OsString::from("-Wl,--disable-new-dtags,-rpath,");
        rpath.push(folder);
        // Renamed when it is complete, because another test program may be using one of the same name.
        let unfinished = path.with_extension(std::process::id().to_string());
        let output = ["-o".as_ref(), unfinished.as_os_str(), "-L".as_ref(), folder.as_os_str(), &rpath];
        // What is named last is linked last.
        self.run(&output, &["-lscl"])?;
        std::fs::rename(&unfinished, path).expect("the program is renamed");
        Ok(())
    }

    /// Compiles without making anything, for programs that must not compile.
    ///
    /// # Errors
    /// What the compiler says.
    pub fn check(&self) -> Result<(), String> {
        self.run(&["-fsyntax-only".as_ref()], &[])
    }

    fn run(&self, first: &[&OsStr], last: &[&str]) -> Result<(), String> {
        let mut command = Command::new(self.compiler);
        // Texts of the compiler in the words that tests expect.
        command.env("LC_ALL", "C").arg("-I").arg(&(self.library)().include).args(first);
        let output = command.args(&self.sources).args(&self.options).args(last).output();
        let output = output.unwrap_or_else(|error| {
            panic!("`{}` does not start: {error}; install a compiler (Debian: apt-get install gcc g++)", self.compiler)
        });
        if output.status.success() { Ok(()) } else { Err(String::from_utf8_lossy(&output.stderr).into_owned()) }
    }
}
