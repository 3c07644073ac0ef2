//! Child processes that end: what has printed no line for too long is killed, and what it had printed is kept.

use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

/// Longest time without a line. The slowest test takes two minutes on a quiet machine.
pub const SILENCE: Duration = Duration::from_secs(12 * 60);
/// How often the child is looked at while it prints nothing.
const LOOK: Duration = Duration::from_millis(100);
/// How long lines are waited for once the child has ended: one that it started may hold its pipes open.
const GRACE: Duration = Duration::from_secs(2);

/// What came of a child.
#[derive(Debug)]
pub struct Ended {
    /// How it ended.
    pub status: ExitStatus,
    /// What it printed: standard output, after it standard error, after it why it was killed.
    pub output: String,
}

/// A line of a child.
struct Line {
    is_output: bool,
    text: String,
}

/// Runs a command without standard input. `hear` gets each line of its standard output at once. After `silence` without
/// a line on either pipe it is killed.
///
/// # Errors
/// Those of the system where the program cannot be started or waited for.
pub fn run(
    command: &mut Command,
    silence: Duration,
    mut hear: impl FnMut(&str),
) -> std::io::Result<Ended> {
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()?;
    let lines = lines_of(&mut child);
    let (mut output, mut errors) = (String::new(), String::new());
    let mut keep = |line: Line| {
        if line.is_output {
            hear(&line.text);
            output.push_str(&line.text);
        } else {
            errors.push_str(&line.text);
        }
    };
    let mut last = Instant::now();
    let mut killed = false;
    let status = loop {
        match lines.recv_timeout(LOOK) {
            Ok(line) => {
                keep(line);
                last = Instant::now();
                continue;
            }
            // Both pipes are closed: only its end is left.
            Err(RecvTimeoutError::Disconnected) => std::thread::sleep(LOOK),
            Err(RecvTimeoutError::Timeout) => {}
        }
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if last.elapsed() > silence {
            killed = true;
            child.kill()?;
            break child.wait()?;
        }
    };
    let end = Instant::now() + GRACE;
    while let Ok(line) = lines.recv_timeout(end.saturating_duration_since(Instant::now())) {
        keep(line);
    }
    output.push_str(&errors);
    if killed {
        let minutes = silence.as_secs_f64() / 60.0;
        output.push_str(&format!(
            "killed: it had printed nothing for {minutes} minutes; what it did last stands above\n"
        ));
    }
    Ok(Ended { status, output })
}

/// The lines of both pipes, as they come.
fn lines_of(child: &mut Child) -> Receiver<Line> {
    let (sender, receiver) = channel();
    if let Some(pipe) = child.stdout.take() {
        send_lines(pipe, true, sender.clone());
    }
    if let Some(pipe) = child.stderr.take() {
        send_lines(pipe, false, sender);
    }
    receiver
}

/// Sends the lines of a pipe from a thread of its own, until it is closed or nobody listens.
fn send_lines(pipe: impl Read + Send + 'static, is_output: bool, sender: Sender<Line>) {
    std::thread::spawn(move || {
        let mut reader = BufReader::new(pipe);
        let mut bytes = Vec::new();
        while matches!(reader.read_until(b'\n', &mut bytes), Ok(1..)) {
            let text = String::from_utf8_lossy(&bytes).into_owned();
            if sender.send(Line { is_output, text }).is_err() {
                return;
            }
            bytes.clear();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str, silence: Duration) -> (Ended, Vec<String>) {
        let mut heard = Vec::new();
        let ended = run(Command::new("sh").args(["-c", script]), silence, |line| {
            heard.push(line.to_owned());
        });
        (ended.unwrap_or_else(|error| panic!("{error}")), heard)
    }

    #[test]
    fn lines_are_heard_and_kept() {
        let (ended, heard) = shell("echo a; echo b >&2; echo c; exit 3", SILENCE);
        assert_eq!(ended.status.code(), Some(3));
        assert_eq!(heard, ["a\n", "c\n"]);
        assert_eq!(ended.output, "a\nc\nb\n", "not killed");
    }

    #[test]
    fn what_is_silent_is_killed_and_what_it_printed_is_kept() {
        let begun = Instant::now();
        let (ended, _) = shell("echo begun; exec sleep 60", Duration::from_millis(300));
        assert!(!ended.status.success());
        assert!(
            ended.output.starts_with("begun\nkilled: "),
            "{}",
            ended.output
        );
        assert!(begun.elapsed() < Duration::from_secs(30));
    }

    #[test]
    fn what_a_child_leaves_behind_is_not_waited_for() {
        let begun = Instant::now();
        let (ended, heard) = shell("sleep 60 & echo done", SILENCE);
        assert!(ended.status.success());
        assert_eq!(heard, ["done\n"]);
        assert!(begun.elapsed() < Duration::from_secs(30));
    }
}
