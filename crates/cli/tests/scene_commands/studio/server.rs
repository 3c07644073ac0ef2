//! A server of the studio as a process, and requests to it.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::Value;

use crate::common::argument;

/// A server, which ends with the test.
pub struct Studio {
    pub child: Child,
    pub port: u16,
    pub token: String,
}

/// What it answered.
#[derive(Debug)]
pub struct Reply {
    pub status: u16,
    pub head: String,
    pub body: String,
}

impl Reply {
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|e| panic!("{e} in {self:?}"))
    }
}

impl Studio {
    /// Of a file.
    pub fn open(file: &Path) -> Self {
        Self::started(&["studio", argument(file), "--no-open"], Path::new("."))
    }

    /// Of a result with another one beside it.
    pub fn open_beside(file: &Path, other: &Path) -> Self {
        let words = [
            "studio",
            argument(file),
            "--beside",
            argument(other),
            "--no-open",
        ];
        Self::started(&words, Path::new("."))
    }

    /// Of nothing yet; what is made lies in a folder.
    pub fn new_in(folder: &Path) -> Self {
        Self::started(&["studio", "--no-open"], folder)
    }

    fn started(arguments: &[&str], folder: &Path) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_gearmesh"))
            .args(arguments)
            .current_dir(folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut output = BufReader::new(child.stdout.take().unwrap());
        output.read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("http://127.0.0.1:").expect(&line);
        let (port, token) = address.split_once("/?token=").unwrap();
        assert_eq!(token.len(), 48);
        Self {
            child,
            port: port.parse().unwrap(),
            token: token.to_owned(),
        }
    }

    /// Waits for the work that runs; what it came to.
    pub fn finished(&self) -> Value {
        loop {
            let progress = self.get("/api/job").json();
            if progress["running"] == Value::Bool(false) {
                return progress;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Sends lines and a body, and reads to the end of the answer.
    pub fn send(&self, lines: &[String], body: &str) -> Reply {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(60)))
            .unwrap();
        let head = lines.join("\r\n");
        let text = format!(
            "{head}\r\nConnection: close\r\nContent-Length: {}\r\n\r\n{body}",
            body.len()
        );
        // A server that refuses a long body closes before it has all of it.
        let _ = stream.write_all(text.as_bytes());
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8(answer).unwrap();
        let (head, body) = answer.split_once("\r\n\r\n").unwrap_or((&answer, ""));
        let status = head.split(' ').nth(1).and_then(|word| word.parse().ok());
        Reply {
            status: status.unwrap_or(0),
            head: head.to_owned(),
            body: body.to_owned(),
        }
    }

    pub fn lines(&self, request: &str) -> Vec<String> {
        vec![
            format!("{request} HTTP/1.1"),
            format!("Host: 127.0.0.1:{}", self.port),
            format!("X-Gearmesh-Token: {}", self.token),
        ]
    }

    pub fn get(&self, path: &str) -> Reply {
        self.send(&self.lines(&format!("GET {path}")), "")
    }

    pub fn post(&self, path: &str, body: &Value) -> Reply {
        let mut lines = self.lines(&format!("POST {path}"));
        lines.push("Content-Type: application/json".to_owned());
        self.send(&lines, &body.to_string())
    }
}

impl Drop for Studio {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
