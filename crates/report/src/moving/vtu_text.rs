//! A moment as a VTU file (VTK XML, unstructured grid of quadrilaterals and triangles), the series as a PVD file.
//!
//! Source: VTK file formats, docs.vtk.org, "XML file formats": binary arrays are base64, compressed ones preceded by a
//! header of their own (number of blocks, size of a block, size of the last one where it is shorter, compressed sizes).

use super::{GearSurface, Moment};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fmt::Write as _;
use std::io::Write as _;

/// A triangle and a quadrilateral, in VTK's list of cells.
const VTK_TRIANGLE: u8 = 5;
const VTK_QUAD: u8 = 9;

/// Arrays that are the same at all moments, and what is needed for the others.
pub struct Series<'a> {
    surfaces: &'a [GearSurface],
    /// Cells and what belongs to them, as text.
    cells: String,
    fixed: String,
    points: usize,
    quads: usize,
}

impl<'a> Series<'a> {
    /// A series of moments of these gears.
    #[must_use]
    pub fn new(surfaces: &'a [GearSurface]) -> Self {
        let (mut corners, mut teeth, mut gears) = (Vec::new(), Vec::new(), Vec::new());
        let (mut offsets, mut types, mut end) = (Vec::new(), Vec::new(), 0_u32);
        let mut points = 0;
        for (number, surface) in surfaces.iter().enumerate() {
            for quad in &surface.quads {
                let is_triangle = quad[2] == quad[3];
                let own = &quad[..if is_triangle { 3 } else { 4 }];
                corners.extend(own.iter().flat_map(|n| (points as u32 + n).to_le_bytes()));
                end += own.len() as u32;
                offsets.extend(end.to_le_bytes());
                types.push(if is_triangle { VTK_TRIANGLE } else { VTK_QUAD });
            }
            teeth.extend(surface.teeth.iter().flat_map(|n| n.to_le_bytes()));
            let gear = (number as i32 + 1).to_le_bytes();
            gears.extend(surface.quads.iter().flat_map(|_| gear));
            points += surface.points_m.len();
        }
        let quads = teeth.len() / 4;
        let cells = [
            array("Int32", "connectivity", 1, &corners),
            array("Int32", "offsets", 1, &offsets),
            array("UInt8", "types", 1, &types),
        ];
        let fixed = [
            array("Int32", "gear", 1, &gears),
            array("Int32", "tooth", 1, &teeth),
        ];
        Self {
            surfaces,
            cells: cells.concat(),
            fixed: fixed.concat(),
            points,
            quads,
        }
    }

    /// The file of a moment. Forces of several slices in one quadrilateral add up; of line loads and pressures the
    /// largest is kept.
    #[must_use]
    pub fn moment_text(&self, moment: &Moment) -> String {
        let mut points = Vec::with_capacity(12 * self.points);
        let mut first = Vec::new();
        let mut quads = 0;
        for (surface, placement) in self.surfaces.iter().zip(&moment.placements) {
            first.push(quads);
            quads += surface.quads.len();
            for point in &surface.points_m {
                let placed = placement.point(*point);
                points.extend(placed.iter().flat_map(|x| (*x as f32).to_le_bytes()));
            }
        }
        let (mut pressure, mut line_load) = (vec![0.0_f32; quads], vec![0.0_f32; quads]);
        let mut force = vec![[0.0_f32; 3]; quads];
        for load in &moment.loads {
            let surface = &self.surfaces[load.gear];
            let flank = (load.tooth, load.side);
            let quad = first[load.gear] + surface.flank_quad(flank, load.roll_rad, load.height_m);
            pressure[quad] = pressure[quad].max(load.pressure_pa as f32);
            line_load[quad] = line_load[quad].max(load.line_load_n_per_m as f32);
            (force[quad].iter_mut().zip(load.force_n)).for_each(|(sum, part)| *sum += part as f32);
        }
        let bytes =
            |values: &[f32]| -> Vec<u8> { values.iter().flat_map(|x| x.to_le_bytes()).collect() };
        let mut varying = vec![
            array("Float32", "hertz_pressure_Pa", 1, &bytes(&pressure)),
            array("Float32", "line_load_N_per_m", 1, &bytes(&line_load)),
            array(
                "Float32",
                "contact_force_N",
                3,
                &bytes(force.as_flattened()),
            ),
        ];
        if !moment.von_mises_pa.is_empty() {
            let stress: Vec<f32> = (moment.von_mises_pa.iter().flatten())
                .map(|x| *x as f32)
                .collect();
            varying.push(array("Float32", "von_mises_Pa", 1, &bytes(&stress)));
        }
        format!(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\">\n\
             <UnstructuredGrid>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n{}</Points>\n<Cells>\n{}</Cells>\n\
             <CellData Scalars=\"hertz_pressure_Pa\">\n{}{}</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n",
            self.points,
            self.quads,
            array("Float32", "Points", 3, &points),
            self.cells,
            self.fixed,
            varying.concat()
        )
    }
}

/// An array as a text, compressed.
fn array(kind: &str, name: &str, components: usize, bytes: &[u8]) -> String {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    // Nothing fails that writes into memory.
    let packed = encoder
        .write_all(bytes)
        .and_then(|()| encoder.finish())
        .unwrap_or_default();
    let head = [1, bytes.len() as u32, 0, packed.len() as u32];
    let head: Vec<u8> = head.iter().flat_map(|n| n.to_le_bytes()).collect();
    format!(
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"binary\">{}{}</DataArray>\n",
        STANDARD.encode(head),
        STANDARD.encode(packed)
    )
}

/// The PVD file: what each moment is at (time or angle), and its file.
#[must_use]
pub fn series_text(files: &[(f64, String)]) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n",
    );
    for (at, file) in files {
        let file = file
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('"', "&quot;");
        let _ = writeln!(
            text,
            "<DataSet timestep=\"{at}\" part=\"0\" file=\"{file}\"/>"
        );
    }
    text + "</Collection>\n</VTKFile>\n"
}
