//! The page that a benchmark writes: figures in, Markdown out.

use std::fmt::Write;

use super::case::Stages;
use super::host::Host;
use super::projection::Projected;

/// Loads for which the time after the factorisation is stated.
pub const STATED_LOADS: f64 = 256.0;

/// One case.
#[derive(Debug, Clone)]
pub struct Row {
    /// Program and settings.
    pub program: String,
    /// Its figures, or why there are none.
    pub outcome: Result<Figures, String>,
}

/// Figures of a case that ended well.
#[derive(Debug, Clone)]
pub struct Figures {
    /// Wall time of the whole process \[s\].
    pub wall_s: f64,
    /// Processor time \[s\].
    pub cpu_s: f64,
    /// Peak memory \[byte\].
    pub peak_bytes: f64,
    /// Where the program tells its stages.
    pub stages: Option<Stages>,
    /// Loads that were solved.
    pub loads: f64,
    /// All loads of all teeth came out: ours by repetition. Else the time for them is scaled.
    pub complete: bool,
}

impl Figures {
    /// Assembly, factorisation and `loads` solved \[s\], from the loads that were.
    fn scaled_s(&self, loads: f64) -> Option<f64> {
        let stages = self.stages.filter(|_| !self.complete)?;
        Some(stages.assembly_s + stages.factor_s + stages.solve_s / self.loads * loads)
    }

    /// All loads of all teeth \[s\], without the mesh. Where nothing is scaled, whatever else the program does counts.
    fn all_loads_s(&self, all_loads: f64) -> Option<f64> {
        if self.complete {
            return Some(self.wall_s - self.stages.and_then(|s| s.mesh_s).unwrap_or(0.0));
        }
        self.scaled_s(all_loads)
    }
}

/// The cases on one mesh; the first is what the others are compared with.
#[derive(Debug, Clone)]
pub struct MeshSize {
    /// Factors on the default element lengths: in the cross-section, along the axis.
    pub lengths: [f64; 2],
    /// Degrees of freedom, bore included; or why there is no mesh.
    pub dofs: Result<u64, String>,
    /// Unit loads on both flanks of all teeth.
    pub all_loads: f64,
    /// The cases.
    pub rows: Vec<Row>,
    /// Lines on single elements beside the flank grid, or why there are none.
    pub projected: Result<Projected, String>,
}

impl MeshSize {
    /// The lines on single elements in words; the first case has the grid's loads.
    fn projected_words(&self) -> String {
        let first = self.rows.first().and_then(|row| row.outcome.as_ref().ok());
        let solved = first.and_then(|figures| Some((figures.loads, figures.stages?.solve_s)));
        match (&self.projected, solved) {
            (Ok(projected), Some((loads, solve_s))) => projected.words(loads, solve_s),
            (Err(reason), _) => format!("No lines on single elements: {reason}."),
            (Ok(_), None) => "No lines on single elements: the gear was not reduced.".into(),
        }
    }
}

/// The whole page.
pub fn page(host: &Host, program: &str, solver: &str, sizes: &[MeshSize]) -> String {
    let mut page = format!(
        "# The offline stage: time and memory\n\n\
        Written by `cargo xtask bench offline`; do not edit.\n\n\
        | | |\n| --- | --- |\n\
        | processor | {}, {} cores |\n| memory | {} |\n| system | {} |\n| date | {} |\n| commit | {} |\n\
        | program | {program} |\n| direct solver of scikit-fem | {solver} |\n\n",
        host.cpu, host.cores, host.memory, host.system, host.date, host.commit
    );
    page.push_str(
        "Gear 2 (`fe_models/gear2.toml`), both flanks loaded. Each case is one process on all \
        cores; memory is the largest resident set of it or a child. *Rest* is what is in no other stage: start, reading files, \
        and, of ours, near field, gauges, checks and the model file.\n\n\
        - **ours, symmetry**: `gearmesh reduce --no-error-estimate`, all loads of all teeth.\n\
        - **ours, off**: the same with `symmetry = \"off\"`, one factorisation of the whole gear and the loads of one tooth. That \
        it needs no other tooth's loads is repetition again; a program that knows nothing of it solves all.\n\
        - **scikit-fem**: its assembly of trilinear hexahedra, as many couplings as ours, and the solver named above (Pardiso: \
        symmetric positive definite, no iterative refinement, 64 loads at a time as ours).\n\
        - **CalculiX**: one static step, one load, with its default solver; it tells no stages. C3D8I has incompatible modes \
        as ours, but keeps them as unknowns of the whole system; C3D8 has the nodes' unknowns only.\n\n\
        *256 loads*: assembly, factorisation and the solution for 256 loads, from the loads that were solved. *All loads*: the \
        same for both flanks of all teeth, scaled by the number of loads; of ours with symmetry the whole run less the mesh, \
        nothing scaled. *Ratio*: to ours with symmetry, all loads, without the mesh.\n",
    );
    for size in sizes {
        let [section, axis] = size.lengths;
        let lengths = format!(
            "Default element lengths times {section} in the cross-section and {axis} along the axis."
        );
        match &size.dofs {
            Ok(dofs) => {
                let _ = write!(
                    page,
                    "\n## {} degrees of freedom, {} loads in all\n\n{lengths}\n\n{}\n{}\n",
                    thousands(*dofs),
                    size.all_loads,
                    table(size),
                    size.projected_words()
                );
            }
            Err(reason) => {
                let _ = write!(page, "\n## No mesh\n\n{lengths} {}\n", cell(reason));
            }
        }
    }
    page
}

fn table(size: &MeshSize) -> String {
    let mut table = String::from(
        "| program | mesh s | assembly s | factor s | solve s | loads solved | rest s | wall s | processor s | peak GB \
        | 256 loads s | all loads s | ratio |\n|",
    );
    table.push_str(" --- |");
    table.push_str(&" ---: |".repeat(12));
    table.push('\n');
    let reference_s = size
        .rows
        .first()
        .and_then(|row| row.outcome.as_ref().ok())
        .filter(|figures| figures.complete)
        .and_then(|figures| figures.all_loads_s(size.all_loads));
    for row in &size.rows {
        let _ = match &row.outcome {
            Ok(figures) => writeln!(
                table,
                "| {} | {} |",
                cell(&row.program),
                cells(figures, size.all_loads, reference_s).join(" | ")
            ),
            Err(reason) => writeln!(
                table,
                "| {} | {}{}",
                cell(&row.program),
                cell(reason),
                " |".repeat(12)
            ),
        };
    }
    table
}

fn cells(figures: &Figures, all_loads: f64, reference_s: Option<f64>) -> Vec<String> {
    let seconds = |value: Option<f64>| value.map_or("–".to_owned(), |s| format!("{s:.1}"));
    let stage = |of: fn(&Stages) -> f64| seconds(figures.stages.as_ref().map(of));
    let rest_s = figures
        .stages
        .map(|s| figures.wall_s - s.mesh_s.unwrap_or(0.0) - s.assembly_s - s.factor_s - s.solve_s);
    let all_loads_s = figures.all_loads_s(all_loads);
    let ratio = all_loads_s.zip(reference_s).map(|(all, ours)| all / ours);
    vec![
        seconds(figures.stages.and_then(|s| s.mesh_s)),
        stage(|s| s.assembly_s),
        stage(|s| s.factor_s),
        stage(|s| s.solve_s),
        figures.loads.to_string(),
        seconds(rest_s),
        seconds(Some(figures.wall_s)),
        seconds(Some(figures.cpu_s)),
        format!("{:.2}", figures.peak_bytes / 1e9),
        seconds(figures.scaled_s(STATED_LOADS)),
        seconds(all_loads_s),
        ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.1}")),
    ]
}

/// Text that stays in one cell.
pub(super) fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

/// `758043` as `758 043`.
pub(super) fn thousands(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figures(wall_s: f64, stages: Option<Stages>, loads: f64, complete: bool) -> Figures {
        Figures {
            wall_s,
            cpu_s: 2.0 * wall_s,
            peak_bytes: 1.5e9,
            stages,
            loads,
            complete,
        }
    }

    fn example() -> MeshSize {
        let row = |program: &str, outcome| Row {
            program: program.into(),
            outcome,
        };
        let stages = |mesh_s, solve_s| {
            Some(Stages {
                mesh_s: Some(mesh_s),
                assembly_s: 1.0,
                factor_s: 9.0,
                solve_s,
            })
        };
        MeshSize {
            lengths: [1.0, 1.0],
            dofs: Ok(758_043),
            all_loads: 1000.0,
            rows: vec![
                row("ours", Ok(figures(22.0, stages(2.0, 4.0), 1000.0, true))),
                row("whole", Ok(figures(40.0, stages(3.0, 19.8), 198.0, false))),
                row("one load", Ok(figures(50.0, None, 1.0, false))),
                row("big", Err("killed | at 22 GB\nat once".into())),
            ],
            projected: Ok(Projected {
                solutions: 25.0,
                solutions_s: 1.0,
                projection_s: 0.05,
                apart: 1e-4,
            }),
        }
    }

    #[test]
    fn a_row_has_stages_scaled_times_and_the_ratio() {
        let table = table(&example());
        let lines: Vec<&str> = table.lines().collect();
        // All loads: 22 - 2 of the mesh; rest: 22 - 2 - 1 - 9 - 4.
        assert_eq!(
            lines[2],
            "| ours | 2.0 | 1.0 | 9.0 | 4.0 | 1000 | 6.0 | 22.0 | 44.0 | 1.50 | – | 20.0 | 1.0 |"
        );
        // 0.1 s a load: 10 + 25.6 for 256, 10 + 100 for all, 110/20 as ratio.
        assert_eq!(
            lines[3],
            "| whole | 3.0 | 1.0 | 9.0 | 19.8 | 198 | 7.2 | 40.0 | 80.0 | 1.50 | 35.6 | 110.0 | 5.5 |"
        );
        assert_eq!(
            lines[4],
            "| one load | – | – | – | – | 1 | – | 50.0 | 100.0 | 1.50 | – | – | – |"
        );
    }

    #[test]
    fn every_line_has_all_columns_also_where_a_case_failed() {
        let table = table(&example());
        for line in table.lines() {
            let bars = line.replace("\\|", "").matches('|').count();
            assert_eq!(bars, 14, "{line}");
        }
        assert!(table.contains("| big | killed \\| at 22 GB at once |"));
    }

    #[test]
    fn without_our_own_figures_there_is_no_ratio() {
        let mut size = example();
        size.rows[0].outcome = Err("stopped".into());
        let table = table(&size);
        assert!(table.contains("| 110.0 | – |"), "{table}");
    }

    #[test]
    fn the_page_names_machine_and_commit_and_a_mesh_that_failed() {
        let host = Host {
            cpu: "Some CPU".into(),
            cores: 2,
            memory: "24 GB".into(),
            system: "Linux".into(),
            date: "today".into(),
            commit: "abc, clean tree".into(),
        };
        let failed = MeshSize {
            lengths: [3.2, 5.0],
            dofs: Err("exit code 2: no gmsh".into()),
            all_loads: 1.0,
            rows: Vec::new(),
            projected: Err("the gear was not reduced".into()),
        };
        let page = page(&host, "dev", "Pardiso", &[example(), failed]);
        for part in [
            "| processor | Some CPU, 2 cores |",
            "25 solutions in 1.00 s, 42.0 ms a contact point",
            "The grid's 1000 loads took 4.0 s once",
            "| commit | abc, clean tree |",
            "| direct solver of scikit-fem | Pardiso |",
            "## 758 043 degrees of freedom, 1000 loads in all",
            "## No mesh\n\nDefault element lengths times 3.2 in the cross-section and 5 along the axis. exit code 2: no gmsh",
        ] {
            assert!(page.contains(part), "{part}\n{page}");
        }
    }

    #[test]
    fn numbers_are_grouped() {
        assert_eq!(thousands(7), "7");
        assert_eq!(thousands(142_101), "142 101");
        assert_eq!(thousands(1_000_000), "1 000 000");
    }
}
