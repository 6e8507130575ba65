//! SCL measured beside the raw sockets it is made of, interleaved in one run: absolute times drift, ratios hold.
//!
//! `cargo run --release -p scl-bench -- roundtrip [BYTES]`

mod figures;
mod roundtrip;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let measured = match words.as_slice() {
        ["roundtrip"] => roundtrip::measure(20),
        ["roundtrip", bytes] => match bytes.parse() {
            Ok(bytes) => roundtrip::measure(bytes),
            Err(_) => return usage(),
        },
        ["wall", folder] => roundtrip::send_back(folder),
        _ => return usage(),
    };
    match measured {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:?}");
            ExitCode::FAILURE
        }
    }
}

fn usage() -> ExitCode {
    eprintln!("usage: scl-bench roundtrip [BYTES]");
    ExitCode::from(2)
}
