//! A language server as a process, and the little of the protocol that the tests need.

use crate::system::{ChildGuard, SpawnGuarded};
use serde_json::{Value, json};
use std::collections::{HashMap, VecDeque};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{ChildStdin, ChildStdout, Command, Stdio};

/// The error code of an answer about text that has changed since.
const CONTENT_MODIFIED: i64 = -32801;

/// A running language server. It is killed when the value is dropped.
pub(crate) struct Server {
    _process: ChildGuard,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    /// Notifications that came while an answer was awaited.
    notified: VecDeque<Value>,
    last_id: u64,
    /// What the server is told when it asks for its configuration, section by section.
    settings: Value,
}

impl Server {
    /// Starts a server for a folder and greets it.
    pub(crate) fn start(command: &mut Command, folder: &Path, settings: Value) -> Self {
        let mut process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn_guarded();
        let (input, output) = (process.stdin.take().unwrap(), BufReader::new(process.stdout.take().unwrap()));
        let mut server = Self { _process: process, input, output, notified: VecDeque::new(), last_id: 0, settings };
        let capabilities = json!({
            "workspace": { "configuration": true },
            "textDocument": {
                "completion": { "completionItem": { "documentationFormat": ["plaintext"] } },
                "hover": { "contentFormat": ["plaintext"] },
                "publishDiagnostics": { "relatedInformation": true },
            },
            "experimental": { "serverStatusNotification": true },
        });
        let root = uri(folder);
        let folders = json!([{ "uri": root, "name": "test" }]);
        server.request(
            "initialize",
            json!({
                "processId": null, "rootUri": root, "capabilities": capabilities, "workspaceFolders": folders,
                "initializationOptions": server.settings,
            }),
        );
        server.notify("initialized", json!({}));
        server
    }

    /// Opens a document with this text.
    pub(crate) fn open(&mut self, path: &Path, language: &str, text: &str) {
        let document = json!({ "uri": uri(path), "languageId": language, "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    /// Closes a document.
    pub(crate) fn close(&mut self, path: &Path) {
        self.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri(path) } }));
    }

    /// What is offered right behind `marker` in the text.
    pub(crate) fn complete_behind(&mut self, path: &Path, text: &str, marker: &str) -> Vec<String> {
        let before = &text[..text.find(marker).unwrap() + marker.len()];
        let items = self.complete(path, before);
        items.iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
    }

    /// What is offered behind the text `before`.
    pub(crate) fn complete(&mut self, path: &Path, before: &str) -> Vec<Value> {
        let found = self.request("textDocument/completion", end_of(path, before));
        let items = if found.is_array() { &found } else { &found["items"] };
        // `null` if nothing is offered.
        items.as_array().cloned().unwrap_or_default()
    }

    /// What hovering over the last letter of `marker` shows, as JSON.
    pub(crate) fn hover(&mut self, path: &Path, text: &str, marker: &str) -> String {
        self.request("textDocument/hover", on(path, text, marker)).to_string()
    }

    /// Where the name that ends with `marker` is defined.
    pub(crate) fn definition(&mut self, path: &Path, text: &str, marker: &str) -> Value {
        self.request("textDocument/definition", on(path, text, marker))
    }

    /// The changes that give the name that ends with `marker` another one.
    pub(crate) fn rename(&mut self, path: &Path, text: &str, marker: &str, name: &str) -> Value {
        let mut request = on(path, text, marker);
        request["newName"] = json!(name);
        self.request("textDocument/rename", request)
    }

    /// Asks for the diagnostics of a document.
    pub(crate) fn diagnostics_of(&mut self, path: &Path) -> Vec<Value> {
        let document = json!({ "textDocument": { "uri": uri(path) } });
        self.request("textDocument/diagnostic", document)["items"].as_array().unwrap().clone()
    }

    /// Waits until rust-analyzer has read everything; returns what it could not read.
    pub(crate) fn wait_until_quiescent(&mut self) -> String {
        loop {
            let message = match self.notified.pop_front() {
                Some(message) => message,
                None => self.read(),
            };
            if message["method"] == "experimental/serverStatus" && message["params"]["quiescent"] == true {
                return message["params"]["message"].as_str().unwrap_or_default().to_owned();
            }
        }
    }

    /// Waits for the next diagnostics of this document.
    pub(crate) fn diagnostics(&mut self, path: &Path) -> Vec<Value> {
        loop {
            let message = match self.notified.pop_front() {
                Some(message) => message,
                None => self.read(),
            };
            let is_about = message["params"]["uri"] == uri(path);
            if message["method"] == "textDocument/publishDiagnostics" && is_about {
                return message["params"]["diagnostics"].as_array().unwrap().clone();
            }
        }
    }

    /// Waits until every one of these documents has diagnostics, and gives their numbers in the same order.
    pub(crate) fn counts_of_diagnostics(&mut self, paths: &[PathBuf]) -> Vec<usize> {
        let mut counts: HashMap<String, usize> = HashMap::new();
        while !paths.iter().all(|path| counts.contains_key(&uri(path))) {
            let message = match self.notified.pop_front() {
                Some(message) => message,
                None => self.read(),
            };
            if message["method"] == "textDocument/publishDiagnostics" {
                let found = message["params"]["diagnostics"].as_array().unwrap().len();
                counts.insert(message["params"]["uri"].as_str().unwrap().to_owned(), found);
            }
        }
        paths.iter().map(|path| counts[&uri(path)]).collect()
    }

    pub(crate) fn notify(&mut self, method: &str, params: Value) {
        self.write(&json!({ "jsonrpc": "2.0", "method": method, "params": params }));
    }

    /// Sends a request until it is answered: the server cancels those that something newer has overtaken.
    pub(crate) fn request(&mut self, method: &str, params: Value) -> Value {
        loop {
            let answer = self.request_once(method, &params);
            if answer["error"]["data"]["retriggerRequest"] != true && answer["error"]["code"] != CONTENT_MODIFIED {
                assert!(answer.get("error").is_none(), "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }

    fn request_once(&mut self, method: &str, params: &Value) -> Value {
        self.last_id += 1;
        let id = self.last_id;
        self.write(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params }));
        loop {
            let message = self.read();
            if message.get("method").is_none() && message["id"] == json!(id) {
                return message;
            }
            self.notified.push_back(message);
        }
    }

    fn write(&mut self, message: &Value) {
        let text = message.to_string();
        write!(self.input, "Content-Length: {}\r\n\r\n{text}", text.len()).unwrap();
        self.input.flush().unwrap();
    }

    /// The next message that is no question. Questions are answered: with the settings, else with nothing.
    fn read(&mut self) -> Value {
        loop {
            let message = self.read_any();
            if message.get("method").is_none() || message.get("id").is_none() {
                return message;
            }
            let sections = message["params"]["items"].as_array();
            let setting = |item: &Value| item["section"].as_str().map_or(Value::Null, |it| self.settings[it].clone());
            let answer = match message["method"].as_str() {
                Some("workspace/configuration") => sections.unwrap().iter().map(setting).collect(),
                _ => Value::Null,
            };
            self.write(&json!({ "jsonrpc": "2.0", "id": message["id"], "result": answer }));
        }
    }

    fn read_any(&mut self) -> Value {
        let mut length = 0;
        loop {
            let mut line = String::new();
            assert_ne!(self.output.read_line(&mut line).unwrap(), 0, "the language server has ended");
            match line.trim_end().split_once(": ") {
                Some((key, value)) if key.eq_ignore_ascii_case("content-length") => length = value.parse().unwrap(),
                Some(_) => {}
                None => break,
            }
        }
        let mut body = vec![0; length];
        self.output.read_exact(&mut body).unwrap();
        serde_json::from_slice(&body).unwrap()
    }
}

/// The URI of a path of plain letters.
pub(crate) fn uri(path: &Path) -> String {
    format!("file://{}", path.display())
}

/// The last letter of the first `marker`.
fn on(path: &Path, text: &str, marker: &str) -> Value {
    end_of(path, &text[..text.find(marker).unwrap() + marker.len() - 1])
}

/// The place behind the text `before`.
fn end_of(path: &Path, before: &str) -> Value {
    let (line, column) = (before.matches('\n').count(), before.rsplit('\n').next().unwrap().len());
    json!({ "textDocument": { "uri": uri(path) }, "position": { "line": line, "character": column } })
}
