//! Meshes as input of finite element programs: Abaqus and CalculiX (.inp), Nastran (.bdf).
//!
//! Written here and not by meshio, whose files fail: CalculiX reads 20 columns of a number and meshio writes 23; a
//! Nastran field has 16 columns and a negative coordinate of meshio's takes 17; hexahedra become C3D8RH, a hybrid
//! element with one point of integration.

use std::io::{self, Write};

use gearmesh_model::{CellKind, MeshData};

/// Numbers on one line of an Abaqus file, at most.
const ABAQUS_ROW: usize = 16;

/// What a deck says beside the mesh.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DeckOptions<'a> {
    /// Unit of the written coordinates.
    pub length_unit: &'a str,
    /// Its length \[m\].
    pub metres_per_unit: f64,
    /// Whether hexahedra of eight nodes have incompatible modes, which Abaqus files name.
    pub incompatible_modes: bool,
}

/// Writes nodes, elements (set `body`, of several kinds `body_KIND`) and node sets for Abaqus and CalculiX.
pub(crate) fn write_abaqus(
    out: &mut impl Write,
    mesh: &MeshData,
    options: DeckOptions<'_>,
) -> io::Result<()> {
    writeln!(
        out,
        "*HEADING\ngearmesh mesh, lengths in {}\n*NODE",
        options.length_unit
    )?;
    for (number, point) in (1..).zip(&mesh.points) {
        let [x, y, z] = point.map(|x| x / options.metres_per_unit);
        writeln!(out, "{number}, {x:.13e}, {y:.13e}, {z:.13e}")?;
    }
    let mut number = 0_usize;
    for (&kind, nodes) in &mesh.cells {
        let set = match mesh.cells.len() {
            1 => "body".to_owned(),
            _ => format!("body_{}", kind.name()),
        };
        let name = abaqus_name(kind, options.incompatible_modes);
        writeln!(out, "*ELEMENT, TYPE={name}, ELSET={set}")?;
        for element in nodes.chunks_exact(kind.node_count()) {
            number += 1;
            let row = std::iter::once(number).chain(element.iter().map(|&node| node as usize + 1));
            write_rows(out, row)?;
        }
    }
    for (name, set) in &mesh.point_sets {
        writeln!(out, "*NSET, NSET={name}")?;
        write_rows(out, set.iter().map(|&node| node as usize + 1))?;
    }
    Ok(())
}

/// Numbers with commas, as many on a line as Abaqus takes; a comma at the end says that more follow.
fn write_rows(out: &mut impl Write, numbers: impl Iterator<Item = usize>) -> io::Result<()> {
    for (place, number) in numbers.enumerate() {
        match place % ABAQUS_ROW {
            0 if place > 0 => write!(out, ",\n{number}")?,
            0 => write!(out, "{number}")?,
            _ => write!(out, ",{number}")?,
        }
    }
    writeln!(out)
}

const fn abaqus_name(kind: CellKind, incompatible_modes: bool) -> &'static str {
    match kind {
        CellKind::Hex8 if incompatible_modes => "C3D8I",
        CellKind::Hex8 => "C3D8",
        CellKind::Hex20 => "C3D20",
        CellKind::Tet10 => "C3D10",
        CellKind::Wedge6 => "C3D6",
        CellKind::Wedge15 => "C3D15",
    }
}

/// Writes nodes, elements (property 1 with material 1, which the user states) and node sets (`SET1`) as Nastran bulk
/// data.
pub(crate) fn write_nastran(
    out: &mut impl Write,
    mesh: &MeshData,
    options: DeckOptions<'_>,
) -> io::Result<()> {
    writeln!(
        out,
        "$ gearmesh mesh, lengths in {}; material 1 is to be added\nSOL 101\nCEND\nBEGIN BULK",
        options.length_unit
    )?;
    for (number, point) in (1..).zip(&mesh.points) {
        let [x, y, z] = point.map(|x| sixteen_columns(x / options.metres_per_unit));
        writeln!(
            out,
            "{:<8}{number:<16}{:<16}{x:>16}{y:>16}*\n{:<8}{z:>16}",
            "GRID*", "", "*"
        )?;
    }
    for (number, (kind, nodes)) in (1..).zip(mesh.iter_cells()) {
        let (name, order) = nastran_element(kind);
        let nodes = order.iter().map(|&place| nodes[place] as usize + 1);
        write_card(out, name, [number, 1].into_iter().chain(nodes))?;
    }
    write_card(out, "PSOLID", [1, 1].into_iter())?;
    for (number, (name, set)) in (1..).zip(&mesh.point_sets) {
        writeln!(out, "$ set {number}: {name}")?;
        let nodes = set.iter().map(|&node| node as usize + 1);
        write_card(out, "SET1", std::iter::once(number).chain(nodes))?;
    }
    writeln!(out, "ENDDATA")
}

/// One card in fields of eight columns, eight numbers a line.
fn write_card(
    out: &mut impl Write,
    name: &str,
    numbers: impl Iterator<Item = usize>,
) -> io::Result<()> {
    write!(out, "{name:<8}")?;
    for (place, number) in numbers.enumerate() {
        if place > 0 && place % 8 == 0 {
            write!(out, "+\n{:<8}", "+")?;
        }
        write!(out, "{number:<8}")?;
    }
    writeln!(out)
}

/// A number with as many digits as sixteen columns hold: eleven to thirteen.
fn sixteen_columns(value: f64) -> String {
    let mut digits = 12;
    loop {
        let text = format!("{value:.digits$E}");
        if text.len() <= 16 {
            return text;
        }
        digits -= 1;
    }
}

/// Nastran's name of an element and its order of the nodes: edges between the layers before those of the upper one.
const fn nastran_element(kind: CellKind) -> (&'static str, &'static [usize]) {
    match kind {
        CellKind::Hex8 => ("CHEXA", &[0, 1, 2, 3, 4, 5, 6, 7]),
        CellKind::Hex20 => (
            "CHEXA",
            &[
                0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15,
            ],
        ),
        CellKind::Tet10 => ("CTETRA", &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]),
        CellKind::Wedge6 => ("CPENTA", &[0, 1, 2, 3, 4, 5]),
        CellKind::Wedge15 => (
            "CPENTA",
            &[0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11],
        ),
    }
}
