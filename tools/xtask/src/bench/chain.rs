//! `cargo xtask bench chain`: time of a step of a chain over its number of links, beside Exudyn.

use std::collections::BTreeMap;
use std::process::{Command, ExitCode};

use serde_json::Value;

use super::host::Host;
use super::{Bench, Options, TIMEOUT_S, measure, write_whole};
use crate::console::say;
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// What the throw-away environment installs.
const EXUDYN: &str = "exudyn==1.13.6";

/// Steps from the release, as in the bench.
const STEPS: usize = 50;

/// Milliseconds a step and where the last link is.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Figures {
    step_ms: f64,
    last_m: [f64; 2],
}

/// One length of chain; what was not measured is empty.
#[derive(Debug, Default)]
struct Row {
    dense: Option<Figures>,
    sparse: Option<Figures>,
    exudyn: Option<Figures>,
}

/// Measures and writes docs/benchmarks/chain.md.
///
/// # Errors
/// [`XtaskError`] where the bench does not build or the page cannot be written.
pub fn chain(workspace: &Workspace, options: &Options) -> Result<ExitCode, XtaskError> {
    let bench = Bench::prepare(workspace, options)?;
    say("== our own");
    let ours = bench.own("chain")?;
    let mut rows = read_ours(&ours);
    say("== Exudyn");
    let mut command = bench.python_script("solver_venv.py");
    command
        .arg(bench.scratch.join("exudyn-venv"))
        .args([EXUDYN, "exudyn"]);
    let made = measure(&bench.python, &bench.scripts, TIMEOUT_S, &command);
    let peer = match &made {
        Ok(made) => {
            let python = made.stdout.trim().to_owned();
            for (links, row) in &mut rows {
                let mut command = Command::new(&python);
                command
                    .arg(bench.scripts.join("chain_exudyn.py"))
                    .args([links.to_string(), STEPS.to_string()]);
                let run = measure(&bench.python, &bench.scripts, TIMEOUT_S, &command);
                row.exudyn = run.ok().and_then(|run| figures(run.stdout.lines().last()?));
            }
            EXUDYN.replace("==", " ")
        }
        Err(reason) => format!("not measured: {}", bench.without_place(reason)),
    };
    let page = page(&Host::find(workspace.root()), &peer, &rows);
    write_whole(&workspace.root().join("docs/benchmarks/chain.md"), &page)?;
    Ok(ExitCode::SUCCESS)
}

/// The bench's lines, by number of links.
fn read_ours(stdout: &str) -> BTreeMap<u64, Row> {
    let mut rows: BTreeMap<u64, Row> = BTreeMap::new();
    for line in stdout.lines() {
        let Ok(told) = serde_json::from_str::<Value>(line) else {
            continue;
        };
        let (Some(links), Some(solver)) = (told["links"].as_u64(), told["solver"].as_str()) else {
            continue;
        };
        let row = rows.entry(links).or_default();
        let place = if solver == "dense" {
            &mut row.dense
        } else {
            &mut row.sparse
        };
        *place = figures(line);
    }
    rows
}

fn figures(line: &str) -> Option<Figures> {
    let told: Value = serde_json::from_str(line).ok()?;
    let place = |axis: usize| told["last_body_m"][axis].as_f64();
    Some(Figures {
        step_ms: told["step_ms"].as_f64()?,
        last_m: [place(0)?, place(1)?],
    })
}

fn page(host: &Host, peer: &str, rows: &BTreeMap<u64, Row>) -> String {
    let mut text = format!(
        "# Time of a step over the number of bodies\n\nWritten by `cargo xtask bench chain`; do not edit.\n\n\
         | | |\n| --- | --- |\n| processor | {}, {} cores |\n| memory | {} |\n| system | {} |\n| date | {} |\n| commit | {} |\n\
         | other program | {peer} |\n\n\
         A chain of links on revolute joints with parallel axes, released level, {STEPS} steps of 1 ms from the release; milliseconds a step, of several runs the fastest. The rightmost column \
         is how far the last link of both programs is apart then. Dense and sparse are our two solvers; which one a run takes is chosen by the \
         size (docs/decisions/0010-sparse-system-matrix.md). Exudyn: implicit generalized-alpha of index 3, modified Newton, its sparse solver, one run with its start.\n\n\
         | links | unknowns | dense ms | sparse ms | Exudyn ms | apart m |\n| ---: | ---: | ---: | ---: | ---: | ---: |\n",
        host.cpu, host.cores, host.memory, host.system, host.date, host.commit
    );
    for (links, row) in rows {
        let time = |figures: Option<Figures>| {
            figures.map_or("–".to_owned(), |figures| {
                format!("{:.3}", figures.step_ms)
            })
        };
        let apart = row.sparse.zip(row.exudyn).map_or("–".to_owned(), |(a, b)| {
            let [x, y] = [0, 1].map(|axis| a.last_m[axis] - b.last_m[axis]);
            format!("{:.0e}", x.hypot(y))
        });
        text.push_str(&format!(
            "| {links} | {} | {} | {} | {} | {apart} |\n",
            11 * links,
            time(row.dense),
            time(row.sparse),
            time(row.exudyn)
        ));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_the_bench_become_rows() {
        let rows = read_ours(
            "Compiling\n{\"links\": 20, \"solver\": \"dense\", \"step_ms\": 0.2, \"last_body_m\": [1.9, -0.1]}\n\
             {\"links\": 20, \"solver\": \"sparse\", \"step_ms\": 0.1, \"last_body_m\": [1.9, -0.1]}\n",
        );
        let times = rows
            .get(&20)
            .map(|row| [row.dense, row.sparse].map(|f| f.map(|f| f.step_ms)));
        assert_eq!(times, Some([Some(0.2), Some(0.1)]));
        assert_eq!(figures("{}"), None);
    }
}
