//! Time and memory of assembly, factorisation and solve for a mesh of a given size.
//!
//! ```text
//! cargo run -p gearmesh-fe --example factor_size -- ring  400 25 11      around, radial, axial elements
//! cargo run -p gearmesh-fe --example factor_size -- block 49 49 49
//! ```
//!
//! The default ring has 125 k nodes, 375 k degrees of freedom. Prints one line per step, with the processor
//! time and memory of the process where /proc tells them.

use std::error::Error;
use std::io::Write;
use std::time::Instant;

use faer::Mat;
use gearmesh_fe::{
    DofMap, DofOrdering, Element, Factor, FeModel, Material, NodeGraph, StructuredMesh,
    assemble_stiffness_with_graph,
};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let shape = arguments.first().map_or("ring", String::as_str);
    let mut counts = if shape == "block" {
        [49, 49, 49]
    } else {
        [400, 25, 11]
    };
    for (count, text) in counts.iter_mut().zip(arguments.iter().skip(1)) {
        *count = text.parse()?;
    }
    let (mesh, held) = if shape == "block" {
        let mesh = StructuredMesh::block(counts, [0.05; 3]);
        let held = mesh.nodes_where(|x| x[0] == 0.0);
        (mesh, held)
    } else {
        let mesh = StructuredMesh::ring(counts, [0.025, 0.075], 0.023);
        let held = mesh.nodes_where(|x| x[0].hypot(x[1]) < 0.025_001);
        (mesh, held)
    };
    let mut out = std::io::stdout();
    let model = FeModel::new(
        mesh.nodes,
        mesh.hexes,
        Material::new(210e9, 0.3)?,
        Element::Hex8Incompatible,
    )?;
    let dofs = DofMap::with_fixed_nodes(model.node_count(), &held)?;
    writeln!(
        out,
        "{shape} {counts:?}: {} nodes, {} free DOFs",
        model.node_count(),
        dofs.free_count()
    )?;

    let start = Instant::now();
    let graph = NodeGraph::new(&model, &dofs)?;
    let k = assemble_stiffness_with_graph(&model, &dofs, &graph)?;
    writeln!(
        out,
        "assemble   {:7.2} s   nnz(K) {:.1} M   {}",
        elapsed(start),
        k.compute_nnz() as f64 / 1e6,
        memory()
    )?;

    let start = Instant::now();
    let ordering = DofOrdering::nested_dissection(&graph, &dofs)?;
    writeln!(out, "order      {:7.2} s   {}", elapsed(start), memory())?;

    let factor = Factor::new(&k, ordering)?;
    let info = factor.info();
    writeln!(
        out,
        "factor     {:7.2} s + {:.2} s symbolic   nnz(L) {:.1} M   {:.0} Gflop   smallest relative pivot {:.1e}   {}",
        info.numeric_seconds,
        info.symbolic_seconds,
        info.nnz_l as f64 / 1e6,
        info.flops / 1e9,
        info.smallest_relative_pivot,
        memory()
    )?;

    let columns = 64;
    let rhs = Mat::<f64>::from_fn(factor.size(), columns, |i, j| {
        ((i * 31 + j * 17) % 23) as f64 - 11.0
    });
    let mut x = rhs.clone();
    let start = Instant::now();
    factor.solve_in_place(x.as_mut());
    let seconds = elapsed(start);
    let residual = (&k * &x - &rhs).norm_max() / rhs.norm_max();
    writeln!(
        out,
        "solve {columns}   {seconds:7.2} s   {:.3} s per right-hand side   residual {residual:.1e}   {}",
        seconds / columns as f64,
        memory()
    )?;
    let mut one: Vec<f64> = (0..factor.size()).map(|i| (i % 23) as f64 - 11.0).collect();
    let start = Instant::now();
    factor.solve_slice_in_place(&mut one);
    writeln!(out, "solve 1    {:7.2} s   {}", elapsed(start), memory())?;
    Ok(())
}

fn elapsed(start: Instant) -> f64 {
    start.elapsed().as_secs_f64()
}

/// Processor time of the process so far, current and peak resident memory; empty where the system does not tell.
fn memory() -> String {
    // Fields 14 and 15 of /proc/self/stat: user and system time in ticks of 10 ms.
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks: f64 = stat
        .split_whitespace()
        .skip(13)
        .take(2)
        .filter_map(|t| t.parse::<f64>().ok())
        .sum();
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let gigabytes = |key: &str| {
        let line = status.lines().find(|l| l.starts_with(key))?;
        line.split_whitespace()
            .nth(1)?
            .parse::<f64>()
            .ok()
            .map(|kb| kb / 1048576.0)
    };
    match (gigabytes("VmRSS:"), gigabytes("VmHWM:")) {
        (Some(now), Some(peak)) => format!(
            "cpu {:.1} s, memory {now:.2} GiB, peak {peak:.2} GiB",
            ticks / 100.0
        ),
        _ => String::new(),
    }
}
