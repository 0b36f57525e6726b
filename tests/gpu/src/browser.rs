//! A browser as a device: `tests/browser/bench.mjs` starts it and passes jobs to a page, which runs WGSL as WebGPU and
//! GLSL as WebGL2. A message is two lengths (32 bits, little-endian), JSON of the first and numbers of the second.

use crate::job::Job;
use crate::system::missing;
use crate::wrap::TARGETS;
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use zonal_codegen::emit::language::Target;

/// A browser with the bench's page.
#[derive(Debug)]
pub struct Browser {
    process: Child,
    /// Closed to end the process.
    jobs: Option<ChildStdin>,
    answers: ChildStdout,
    /// What the page says of itself.
    about: Value,
}

impl Browser {
    /// Starts it.
    ///
    /// # Errors
    ///
    /// If Node is missing or the script fails, which then says why.
    pub fn open() -> Result<Self, String> {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../browser/bench.mjs");
        let mut process = Command::new("node")
            .arg(script)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|_| missing("Node", "nodejs npm"))?;
        let (Some(jobs), Some(answers)) = (process.stdin.take(), process.stdout.take()) else {
            return Err("a process has no pipes".to_owned());
        };
        let mut browser = Self { process, jobs: Some(jobs), answers, about: Value::Null };
        browser.about = browser.answer()?.0;
        Ok(browser)
    }

    /// The browser's version and what computes a language.
    pub fn name(&self, target: Target) -> String {
        let word = |key: &str| self.about[key].as_str().unwrap_or("unknown").to_owned();
        format!("Chromium {}, {}", word("version"), word(target.name))
    }

    fn answer(&mut self) -> Result<(Value, Vec<u8>), String> {
        let mut read = |length: usize| {
            let mut bytes = vec![0; length];
            match self.answers.read_exact(&mut bytes) {
                Ok(()) => Ok(bytes),
                Err(_) => Err("the browser's script ended".to_owned()),
            }
        };
        let mut length = || read(4).map(|bytes| bytes.iter().rev().fold(0, |sum, &byte| sum << 8 | usize::from(byte)));
        let [head, body] = [length()?, length()?];
        let head = serde_json::from_slice(&read(head)?).map_err(|error| error.to_string())?;
        Ok((head, read(body)?))
    }

    /// Runs a shader.
    ///
    /// # Errors
    ///
    /// What the page says: the message of a compiler.
    pub fn run(&mut self, job: &Job<'_>) -> Result<Vec<f32>, String> {
        let Job { target, text, inputs, count, takes, gives } = *job;
        let head = json!({
            "language": target.name, "text": text, "count": count, "inputs": takes, "outputs": gives,
            "targets": TARGETS.min(gives),
        });
        let (head, body): (String, &[u8]) = (head.to_string(), bytemuck::cast_slice(inputs));
        let lengths = [head.len(), body.len()].map(|length| (length as u32).to_le_bytes()).concat();
        let jobs = self.jobs.as_mut().ok_or("the browser is closed")?;
        for bytes in [&lengths, head.as_bytes(), body] {
            jobs.write_all(bytes).map_err(|error| format!("the browser's script takes no job: {error}"))?;
        }
        let (head, body) = self.answer()?;
        match head["error"].as_str() {
            Some(error) => Err(error.to_owned()),
            None => Ok(bytemuck::pod_collect_to_vec(&body)),
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        self.jobs = None;
        // Whether it ends well says nothing about what it has computed.
        let _ = self.process.wait();
    }
}
