//! A crack in one tooth of an otherwise sound gear, as rows that add to the compliance.
//!
//! The cracked gear is the sound one with the nodes along the crack doubled ([`DoubledNodes`]): everything is solved
//! with the sound gear's factor, by its repetition. With K_p the coupling of the jumps and S their stiffness, loads i,
//! j and gauges g have
//!
//! ```text
//! S = K_pp − K_pᵀK⁻¹K_p = LLᵀ,   R = −L⁻¹ K_pᵀK⁻¹ [N, g],   C_c = C + RᵀR,   R ≈ V Vᵀ R: rows φ = Vᵀ R
//! ```
//!
//! V: the eigenvectors of RRᵀ over all normal loads with the largest eigenvalues. docs/theory/crack.md derives it.

use crate::flank_compliance::{IDENTITY_ALLOWED, checked};
use crate::flank_loads::{GridLoad, SparseVector, directions};
use crate::gauge_row::gauge_row;
use crate::gear_body::GearBody;
use crate::shaft_faces::HeldFaces;
use crate::tooth_vectors::on_tooth;
use crate::{Progress, ReductionError};
use faer::{Mat, Side};
use gearmesh_fe::DoubledNodes;
use gearmesh_geometry::{CrackDefinition, Flank, GearDefinition};
use gearmesh_model::{GaugeRows, RootCrack};

/// Eigenvalues of RRᵀ below this share of the largest compliance that the crack adds are left out: no compliance errs
/// by more.
const LEFT_OUT: f64 = 1e-8;
/// Jumps that are solved for together: a batch takes the displacements of all sectors for each.
const BATCH: usize = 32;
/// Name of the check that the jumps' stiffness is symmetric.
pub const CRACK_SYMMETRY: &str = "symmetry of the crack's stiffness";

/// Rows of the crack and what it adds to the gauges.
pub struct CrackedRows {
    /// For the model.
    pub crack: RootCrack,
    /// Added to each gauge's [`GaugeRows::adjoint`] on the flanks of the crack's side:
    /// `[gauge][tooth][load][component]`.
    pub gauges: Vec<Vec<f64>>,
    /// Asymmetry of the jumps' condensed stiffness, relative.
    pub asymmetry: f64,
    /// Jumps that were solved for.
    pub jumps: usize,
}

/// Computes the rows of a gear's crack. `loads` are those of the crack's side of tooth 0, `faces` those at which its
/// shaft goes on.
///
/// # Errors
/// [`ReductionError::AtCrack`] where loads or gauges touch the crack, [`ReductionError::Fe`] where the crack cuts a
/// part off.
pub fn root_crack(
    gear: &GearDefinition,
    definition: &CrackDefinition,
    (body, faces): (&GearBody, Option<&HeldFaces>),
    loads: &[GridLoad],
    progress: &dyn Progress,
) -> Result<CrackedRows, ReductionError> {
    progress.stage("solving the crack");
    let Some((nodes, beyond)) = body.mesh.crack(0) else {
        return Err(ReductionError::NoCrackLine);
    };
    let doubled = DoubledNodes::new(&body.model, &body.dofs, &nodes, &beyond)?;
    let gauges: Vec<SparseVector> = gear
        .gauges
        .iter()
        .map(|g| gauge_row(gear, &body.mesh, &body.model, g, 0))
        .collect::<Result<_, _>>()?;
    let touches = |row: &SparseVector| row.iter().any(|e| nodes.contains(&((e.0 / 3) as u32)));
    let near = gear.gauges.iter().zip(&gauges);
    let mut near = near.filter(|(gauge, row)| gauge.tooth == definition.tooth && touches(row));
    let what = match near.next() {
        Some((gauge, _)) => Some(format!("gauge {}", gauge.name)),
        None => { loads.iter() }
            .any(|load| touches(&load.normal))
            .then(|| "the loaded flank".to_owned()),
    };
    if let Some(what) = what {
        return Err(ReductionError::AtCrack { what });
    }

    let on_flank = directions(loads);
    let columns: Vec<SparseVector> = (doubled.coupling().iter())
        .map(|column| on_tooth(&body.mesh, column, definition.tooth))
        .collect();
    let (jumps, of_flank) = (doubled.count(), on_flank.len());
    let read = (&doubled, &on_flank[..], &gauges[..]);
    let products = jump_products(gear, (body, definition.tooth), read, &columns, progress);
    let [mut of_jumps, mut of_loads, mut of_gauges] = products;
    if let Some(faces) = faces {
        let flank = at_faces(gear, definition.side, faces, of_flank);
        let own = faces.read(&columns);
        of_jumps -= faces.excess(own.as_ref(), own.as_ref());
        of_loads -= faces.excess(own.as_ref(), flank.as_ref());
        of_gauges -= faces.excess(own.as_ref(), faces.gauges.as_ref());
    }
    let factor = doubled.factor(of_jumps.as_ref())?;
    checked(CRACK_SYMMETRY, factor.asymmetry(), IDENTITY_ALLOWED)?;
    let r = factor.rows(of_loads.as_ref());
    let r_gauges = factor.rows(of_gauges.as_ref());
    let added = r_gauges.transpose() * &r;
    let gauges = (0..gear.gauges.len())
        .map(|gauge| (0..r.ncols()).map(|load| added[(gauge, load)]).collect())
        .collect();

    let normals = Mat::from_fn(jumps, r.ncols() / 3, |i, load| r[(i, 3 * load)]);
    let (rows, left_out) = compressed(&normals)?;
    let section = body.mesh.section.crack.as_ref();
    Ok(CrackedRows {
        crack: RootCrack {
            tooth: definition.tooth,
            side: definition.side,
            mouth_radius_m: section.map_or(0.0, |line| line.mouth_radius_m),
            depth_m: definition.depth_m,
            angle_rad: definition.angle_rad,
            rows,
            left_out,
        },
        gauges,
        asymmetry: factor.asymmetry(),
        jumps,
    })
}

/// What the held faces feel of the loads on one side of all teeth, so many each.
fn at_faces(gear: &GearDefinition, side: Flank, faces: &HeldFaces, of_flank: usize) -> Mat<f64> {
    let sides = &gear.reduction.flanks;
    let first = sides.iter().position(|&s| s == side).unwrap_or_default() * of_flank;
    let (rows, columns) = (gear.tooth.teeth * of_flank, faces.flank.ncols());
    Mat::from_fn(rows, columns, |row, q| {
        let (tooth, place) = (row / of_flank, row % of_flank);
        faces.flank[(tooth * sides.len() * of_flank + first + place, q)]
    })
}

/// K_pᵀ K⁻¹ of the jumps themselves, of the loads on all teeth, and of the gauges. `columns`: the jumps' coupling on
/// the cracked tooth.
fn jump_products(
    gear: &GearDefinition,
    (body, cracked): (&GearBody, usize),
    (doubled, on_flank, gauges): (&DoubledNodes, &[&SparseVector], &[SparseVector]),
    columns: &[SparseVector],
    progress: &dyn Progress,
) -> [Mat<f64>; 3] {
    let coupling = doubled.coupling().iter();
    let vectors: Vec<&SparseVector> = (coupling.chain(on_flank.iter().copied()))
        .chain(gauges)
        .collect();
    let (jumps, of_flank, teeth) = (doubled.count(), on_flank.len(), gear.tooth.teeth);
    let mut of_jumps = Mat::zeros(jumps, jumps);
    let mut of_loads = Mat::zeros(jumps, teeth * of_flank);
    let mut of_gauges = Mat::zeros(jumps, gauges.len());
    for (batch, chunk) in columns.chunks(BATCH).enumerate() {
        let rows: Vec<&SparseVector> = chunk.iter().collect();
        let readings = body.readings(&rows, &vectors, &crate::Silent);
        for (number, reading) in readings.iter().enumerate() {
            let row = batch * BATCH + number;
            let at = |tooth: usize| &reading[tooth * vectors.len()..][..vectors.len()];
            for (column, value) in at(cracked)[..jumps].iter().enumerate() {
                of_jumps[(row, column)] = *value;
            }
            for tooth in 0..teeth {
                for (column, value) in at(tooth)[jumps..][..of_flank].iter().enumerate() {
                    of_loads[(row, tooth * of_flank + column)] = *value;
                }
            }
            for (column, gauge) in gear.gauges.iter().enumerate() {
                of_gauges[(row, column)] = at(gauge.tooth)[jumps + of_flank + column];
            }
        }
        progress.advance(batch * BATCH + chunk.len(), jumps);
    }
    [of_jumps, of_loads, of_gauges]
}

impl CrackedRows {
    /// Adds to the gauges' rows what the crack makes of them.
    pub fn add_to_gauges(&self, gear: &GearDefinition, rows: &mut [GaugeRows]) {
        let flanks = &gear.reduction.flanks;
        let index = flanks.iter().position(|&side| side == self.crack.side);
        let per_flank = self
            .gauges
            .first()
            .map_or(0, |g| g.len() / gear.tooth.teeth);
        for (row, added) in rows.iter_mut().zip(&self.gauges) {
            for (tooth, added) in added.chunks_exact(per_flank).enumerate() {
                let start = (tooth * flanks.len() + index.unwrap_or_default()) * per_flank;
                for (value, added) in row.adjoint[start..][..per_flank].iter_mut().zip(added) {
                    *value += added;
                }
            }
        }
    }
}

/// φ = VᵀR, `[row][load]`, and the bound of what is left out relative to the largest added compliance of one load.
fn compressed(r: &Mat<f64>) -> Result<(Vec<f64>, f64), ReductionError> {
    let gram = r * r.transpose();
    let eigen = gram
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| ReductionError::Check {
            check: "the crack's rows",
            found: f64::NAN,
            allowed: 0.0,
        })?;
    // Ascending.
    let values = eigen.S().column_vector();
    let n = values.nrows();
    let most = (0..r.ncols()).fold(0.0, |most: f64, load| {
        most.max(r.col(load).squared_norm_l2())
    });
    let kept = (0..n)
        .rev()
        .take_while(|&k| values[k] > LEFT_OUT * most)
        .count()
        .max(1);
    let rows = eigen.U().subcols(n - kept, kept).transpose() * r;
    let next = if kept < n {
        values[n - kept - 1].max(0.0)
    } else {
        0.0
    };
    let flat = (0..kept)
        .rev()
        .flat_map(|k| (0..r.ncols()).map(move |load| (k, load)))
        .map(|at| rows[at])
        .collect();
    Ok((flat, next / most))
}
