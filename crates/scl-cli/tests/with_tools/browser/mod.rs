//! A real browser, Chromium, without a window.

use crate::system::{ChildGuard, SpawnGuarded};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{ChildStdout, Command, Stdio};
use tempfile::TempDir;

/// Runs each line of its input as the body of a function with the page, and prints the result as JSON.
const DRIVER: &str = r#"
const { chromium } = require("playwright-core");
const run = async () => {
  const browser = await chromium.launch({ executablePath: process.argv[1], args: ["--no-sandbox"] });
  const page = await browser.newPage({ viewport: { width: 1200, height: 800 } });
  page.setDefaultTimeout(0);
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => { if (message.type() === "error") errors.push(message.text()); });
  const Body = Object.getPrototypeOf(async () => {}).constructor;
  for await (const line of require("readline").createInterface({ input: process.stdin })) {
    const result = await new Body("page", "errors", line)(page, errors);
    console.log(JSON.stringify(result === undefined ? null : result));
  }
  await browser.close();
};
run().catch((error) => { console.error(error); process.exit(1); });
"#;

/// A browser with one page.
pub(crate) struct Browser {
    process: ChildGuard,
    results: BufReader<ChildStdout>,
    /// Where it has its profile.
    _folder: TempDir,
}

impl Browser {
    pub(crate) fn start() -> Self {
        let modules = crate::npm::installed("playwright-core", "1.56.1");
        let mut command = Command::new("node");
        command.args(["-e", DRIVER]).arg(scl_needs::path_of!("chromium")).env("NODE_PATH", modules);
        let folder = tempfile::tempdir().unwrap();
        command.env("TMPDIR", folder.path()).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut process = command.spawn_guarded();
        let results = BufReader::new(process.stdout.take().unwrap());
        Self { process, results, _folder: folder }
    }

    /// Runs JavaScript on one line, with `page` and `errors`, and returns what it returns.
    pub(crate) fn run(&mut self, script: &str) -> Value {
        writeln!(self.process.stdin.as_mut().unwrap(), "{}", script.replace('\n', " ")).unwrap();
        let mut line = String::new();
        self.results.read_line(&mut line).unwrap();
        serde_json::from_str(&line).unwrap_or_else(|error| panic!("{script}: {error}: {line}"))
    }
}

impl Drop for Browser {
    /// Lets the browser close: its processes would go on writing to the folder.
    fn drop(&mut self) {
        drop(self.process.stdin.take());
        _ = self.process.wait();
    }
}
