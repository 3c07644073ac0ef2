//! A gearbox in time: a scene file runs into a result file, with its progress on standard error; Enter stops it, and
//! the next call goes on from its checkpoint.
//!
//! `cargo run --example gearbox_in_time -- fe_models/dynamics_17_25.toml target/result.h5`

use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use gearmesh_operations::run::{Ran, RunHow, run};
use gearmesh_operations::{Fault, Listener, Task, Watch};
use gearmesh_scene::SceneFile;

/// Writes what it hears to standard error.
struct Spoken;

impl Listener for Spoken {
    fn begin(&self, title: &str) -> Box<dyn Task + '_> {
        Box::new(Share(title.to_owned()))
    }

    fn note(&self, text: &str) {
        let _ = writeln!(std::io::stderr(), "note: {text}");
    }

    fn warning(&self, text: &str) {
        let _ = writeln!(std::io::stderr(), "warning: {text}");
    }
}

struct Share(String);

impl Task for Share {
    fn stage(&self, name: &str) {
        let _ = writeln!(std::io::stderr(), "{}: {name}", self.0);
    }

    fn advance(&self, done: f64, total: f64) {
        let _ = write!(
            std::io::stderr(),
            "\r{}: {:.1} %",
            self.0,
            100.0 * done / total
        );
    }

    fn expect(&self, _seconds: f64) {}
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, scene, output] = &arguments[..] else {
        return Err("give a scene file and a result file".into());
    };
    let stop = Arc::new(AtomicBool::new(false));
    let theirs = Arc::clone(&stop);
    std::thread::spawn(move || {
        let mut line = String::new();
        // A closed input is no wish to stop.
        if std::io::stdin()
            .read_line(&mut line)
            .is_ok_and(|count| count > 0)
        {
            theirs.store(true, Ordering::Relaxed);
        }
    });
    let watch = Watch {
        listener: &Spoken,
        stop: &stop,
        python: None,
    };
    let how = RunHow {
        output: Some(Path::new(output)),
        restart: false,
        most_result_gb: 2.0,
        checkpoint_interval: Duration::from_secs(10),
    };
    let ran = match run(SceneFile::read(Path::new(scene))?, &how, &watch) {
        Err(failure) if failure.fault == Fault::Stopped => {
            let _ = writeln!(std::io::stderr(), "\n{failure}");
            return Ok(());
        }
        ran => ran?,
    };
    let Ran::System(result) = ran else {
        return Err("this scene is a pair at rest; see the example pair_at_rest".into());
    };
    // Figures of a column, as its file has them.
    let mut names = result.rows.columns().iter().map(|column| &column.name);
    let force = names.find(|name| name.ends_with("/force_N"));
    if let Some(name) = force {
        let values = result.rows.read(name)?;
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let _ = writeln!(std::io::stdout(), "{name}: mean {mean:.3}");
    }
    Ok(())
}
