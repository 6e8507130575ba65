//! Compiles the libzmq publisher that needs an option which the Rust binding lacks.

fn main() {
    #[cfg(feature = "libzmq")]
    lossless_publisher::compile();
}

#[cfg(feature = "libzmq")]
mod lossless_publisher {
    use std::path::Path;

    const SOURCE: &str = "src/libzmq/lossless_publisher.cpp";

    pub(super) fn compile() {
        println!("cargo:rerun-if-changed={SOURCE}");
        // `zmq-sys2` exports the paths of the library that it compiled as `DEP_ZMQ_*`.
        let [output, library, headers] =
            ["OUT_DIR", "DEP_ZMQ_LIB", "DEP_ZMQ_INCLUDE"].map(|name| std::env::var_os(name).expect(name));
        let mut compiler = cc::Build::new().cpp(true).opt_level(2).get_compiler().to_command();
        compiler.arg(SOURCE).arg("-I").arg(headers);
        compiler.arg("-o").arg(Path::new(&output).join("lossless_publisher"));
        // Link statically: the program must run on machines without libzmq and the C++ standard library.
        compiler.arg(Path::new(&library).join("libzmq.a")).args(["-static-libstdc++", "-static-libgcc", "-pthread"]);
        let status = compiler.status().expect("the C++ compiler starts");
        assert!(status.success(), "the C++ compiler failed on {SOURCE}");
    }
}
