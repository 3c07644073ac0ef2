//! Printing: data to standard output, progress, warnings and errors to standard error.

use crate::progress_lines::ProgressLines;
use gearmesh_operations::{Listener, Task, Watch};
use gearmesh_report::printable;
use indicatif::{HumanDuration, ProgressBar, ProgressState, ProgressStyle};
use std::cell::Cell;
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// A line of data. A reader that has seen enough (`| head`) ends the printing, not the work; any other loss of data
/// ends the program with exit code 1.
pub fn data(text: impl std::fmt::Display) {
    match writeln!(std::io::stdout(), "{}", printable(&text.to_string())) {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => {
            error(format!("standard output: {cause}"));
            std::process::exit(1);
        }
        _ => {}
    }
}

/// A JSON document.
pub fn json(value: &serde_json::Value) {
    data(format!("{value:#}"));
}

/// What a command found, as JSON or as lines for people.
pub fn found(
    as_json: bool,
    figures: impl FnOnce() -> serde_json::Value,
    lines: impl FnOnce() -> Vec<String>,
) {
    match as_json {
        true => json(&figures()),
        false => lines().into_iter().for_each(data),
    }
}

/// A remark on standard error. Nobody can be told that standard error is closed.
pub fn note(text: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "{}", printable(&text.to_string()));
}

/// A warning.
pub fn warning(text: impl std::fmt::Display) {
    note(format!("warning: {text}"));
}

/// Says what is wrong with the words of a command, or prints the help that was asked for; returns the exit code. What
/// is wrong has no colours: the words may be names of files.
pub fn usage(told: &clap::Error) -> u8 {
    if told.use_stderr() {
        note(told.to_string().trim_end());
        return 2;
    }
    // A reader of the help that stops reading is no error.
    let _ = told.print();
    0
}

/// An error.
pub fn error(text: impl std::fmt::Display) {
    note(format!("error: {text}"));
}

/// Prints what an operation says.
struct Console;

impl Listener for Console {
    fn begin(&self, title: &str) -> Box<dyn Task + '_> {
        Box::new(Bar {
            title: title.to_owned(),
            shown: OnceLock::new(),
        })
    }

    fn note(&self, text: &str) {
        note(text);
    }

    fn warning(&self, text: &str) {
        warning(text);
    }
}

/// Operations are listened to; Ctrl-C ends the program.
pub fn watch() -> Watch<'static> {
    Watch {
        listener: &Console,
        ..Watch::unattended()
    }
}

/// A bar whose kind shows at its first word.
struct Bar {
    title: String,
    shown: OnceLock<Shown>,
}

enum Shown {
    /// A task in stages.
    Stages(StageBar),
    /// A task of one piece.
    Run(Mutex<RunBar>),
}

impl Task for Bar {
    fn stage(&self, name: &str) {
        let stages = || Shown::Stages(StageBar::new(&self.title));
        if let Shown::Stages(bar) = self.shown.get_or_init(stages) {
            bar.stage(name);
        }
    }

    fn advance(&self, done: f64, total: f64) {
        let run = || Shown::Run(Mutex::new(RunBar::new(&self.title)));
        match self.shown.get_or_init(run) {
            Shown::Stages(bar) => bar.advance(done, total),
            Shown::Run(bar) => {
                let bar = bar.lock().unwrap_or_else(PoisonError::into_inner);
                bar.advance(done, total);
            }
        }
    }

    fn expect(&self, seconds: f64) {
        if let Some(Shown::Stages(bar)) = self.shown.get() {
            bar.expect(seconds);
        }
    }
}

/// Remarks on the progress where standard error is no terminal.
const REMARK_EVERY: Duration = Duration::from_secs(10);

/// A run with a bar and the time to go; where standard error is no terminal, a remark now and then.
struct RunBar {
    title: String,
    bar: ProgressBar,
    begun: Instant,
    /// Share of the work at the first call, and when the last remark was made.
    state: Cell<(Option<f64>, Instant)>,
    lines: ProgressLines,
}

impl RunBar {
    /// A bar for a kind of run.
    fn new(title: &str) -> Self {
        let bar = ProgressBar::new(10_000);
        if let Ok(style) =
            ProgressStyle::with_template("{msg} {bar:30} {percent_precise} %, {eta} to go")
        {
            bar.set_style(style);
        }
        let now = Instant::now();
        Self {
            title: printable(title).into_owned(),
            bar,
            begun: now,
            state: Cell::new((None, now)),
            lines: ProgressLines::from_environment(),
        }
    }

    /// So much of it is done.
    fn advance(&self, done: f64, total: f64) {
        if self.lines.are_asked_for() {
            return self.lines.tell(&self.title, done, total);
        }
        let (first, told) = self.state.get();
        let first = first.unwrap_or(done);
        let now = Instant::now();
        // A sum of times is printed without its rounding, a count without digits.
        let whole = (1e6 * total).round() / 1e6;
        let digits = if done.fract() == 0.0 && total.fract() == 0.0 {
            0
        } else {
            5
        };
        self.bar
            .set_message(format!("{}: {done:.digits$} of {whole}", self.title));
        self.bar.set_position((1e4 * done / total) as u64);
        let due = now - told >= REMARK_EVERY;
        self.state.set((Some(first), if due { now } else { told }));
        if due && self.bar.is_hidden() && done > first {
            let left = (now - self.begun).as_secs_f64() * (total - done) / (done - first);
            note(format!(
                "{}: {done:.digits$} of {whole}, about {:#} to go",
                self.title,
                HumanDuration(Duration::from_secs_f64(left.max(0.0)))
            ));
        }
    }
}

impl Drop for RunBar {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// Stages with a bar and the time to go; where standard error is no terminal, a remark now and then.
struct StageBar {
    title: String,
    now: Mutex<Stage>,
    lines: ProgressLines,
}

/// The present stage.
struct Stage {
    bar: ProgressBar,
    name: String,
    begun: Instant,
    /// When the last remark was made, or the work began.
    told: Instant,
}

impl Stage {
    /// Makes a remark where there is no bar to be seen and the last one is long ago.
    fn remark(&mut self, title: &str, to_go: Option<Duration>) {
        let now = Instant::now();
        if !self.bar.is_hidden() || now - self.told < REMARK_EVERY {
            return;
        }
        self.told = now;
        let to_go = to_go.map_or_else(String::new, |left| {
            format!(", about {:#} to go", HumanDuration(left))
        });
        note(format!("{title}: {}{to_go}", self.name));
    }
}

impl StageBar {
    /// A bar for the stages of `title`.
    fn new(title: &str) -> Self {
        let now = Instant::now();
        Self {
            title: printable(title).into_owned(),
            now: Mutex::new(Stage {
                bar: ProgressBar::new_spinner(),
                name: String::new(),
                begun: now,
                told: now,
            }),
            lines: ProgressLines::from_environment(),
        }
    }

    fn with(&self, act: impl FnOnce(&mut Stage)) {
        if let Ok(mut stage) = self.now.lock() {
            act(&mut stage);
        }
    }

    fn stage(&self, name: &str) {
        self.with(|stage| {
            stage.bar.finish_and_clear();
            let name = &*printable(name);
            stage.bar = ProgressBar::new_spinner().with_message(format!("{}: {name}", self.title));
            stage.bar.enable_steady_tick(Duration::from_millis(200));
            name.clone_into(&mut stage.name);
            stage.begun = Instant::now();
            if self.lines.are_asked_for() {
                self.lines.tell(name, 0.0, 0.0);
            } else {
                stage.remark(&self.title, None);
            }
        });
    }

    fn advance(&self, done: f64, total: f64) {
        self.with(|stage| {
            if self.lines.are_asked_for() {
                return self.lines.tell(&stage.name, done, total);
            }
            if stage.bar.length().is_none() {
                stage.bar.set_length(total as u64);
                if let Ok(style) =
                    ProgressStyle::with_template("{msg} {bar:30} {pos}/{len}, {eta} to go")
                {
                    stage.bar.set_style(style);
                }
            }
            stage.bar.set_position(done as u64);
            let left = (total - done.min(total)) / done.max(1.0);
            stage.remark(&self.title, Some(stage.begun.elapsed().mul_f64(left)));
        });
    }

    fn expect(&self, seconds: f64) {
        if seconds < 1.0 {
            return;
        }
        let left = Duration::from_secs_f64(seconds);
        let end = Instant::now() + left;
        let to_go = move |_: &ProgressState, text: &mut dyn std::fmt::Write| {
            // Nobody can be told that a terminal's line cannot be written.
            let _ = match end.checked_duration_since(Instant::now()) {
                Some(left) => write!(text, "about {:#} to go", HumanDuration(left)),
                None => write!(text, "a little longer than expected"),
            };
        };
        self.with(|stage| {
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {to_go}") {
                stage.bar.set_style(style.with_key("to_go", to_go));
            }
            if left >= REMARK_EVERY && !self.lines.are_asked_for() {
                // A wait that is worth a word whenever the last one was.
                stage.told = stage.told.checked_sub(REMARK_EVERY).unwrap_or(stage.told);
                stage.remark(&self.title, Some(left));
            }
        });
    }
}

impl Drop for StageBar {
    fn drop(&mut self) {
        self.with(|stage| stage.bar.finish_and_clear());
    }
}
