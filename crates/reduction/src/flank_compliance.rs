//! C_hub and C_tooth of a body by unit loads on its flanks, and the identities that they must fulfil.

use crate::flank_loads::{GridLoad, SparseVector, normals};
use crate::gear_body::GearBody;
use crate::hub_patterns::by_patterns;
use crate::repeated_mesh::RepeatedMesh;
use crate::stages::Stages;
use crate::tooth_submodel::ToothSubmodel;
use crate::tooth_vectors::summed;
use crate::toothed_mesh::ToothParts;
use crate::{Progress, ReductionError, Silent};
use faer::Mat;
use gearmesh_geometry::Flank;
use gearmesh_model::HubPatterns;

/// Largest asymmetry of C_hub and largest violation of the pattern identity that round-off explains.
pub(crate) const SYMMETRY_ALLOWED: f64 = 1e-10;
pub(crate) const IDENTITY_ALLOWED: f64 = 1e-9;
/// Sums of all loads with which the identities are checked: each costs a solve, and one wrong row changes it.
const SUMS: usize = 2;

pub(crate) const ROWS_BY_FIELDS: &str = "C_hub against solved fields";

/// C_hub of more numbers (32 MB) is kept by patterns where the body does not repeat.
const MOST_IN_FULL: usize = 4_000_000;

/// What comes of loads on the flanks, as the reduced gear holds it.
pub(crate) struct FlankCompliance {
    pub submodels: Vec<ToothSubmodel>,
    /// Of tooth 0's loads only where there are patterns.
    pub c_hub: Vec<f64>,
    pub c_tooth: Vec<f64>,
    pub symmetry: f64,
    pub pattern_identity: f64,
    pub rows_by_fields: f64,
    /// C_hub by patterns, where it is long and the body does not repeat, and what they leave out.
    pub patterns: Option<(HubPatterns, f64)>,
}

/// Solves the loads of one sector's teeth against all teeth, and those of one tooth on its submodel. `loads`: those of
/// tooth 0, flank by flank.
///
/// # Errors
/// [`ReductionError`] when a submodel is not held or an identity is violated by more than round-off explains.
pub(crate) fn flank_compliance<M: RepeatedMesh + ToothParts>(
    body: &GearBody<M>,
    (flanks, loads): (&[Flank], &[Vec<GridLoad>]),
    progress: &dyn Progress,
    stages: &mut Stages,
) -> Result<FlankCompliance, ReductionError> {
    let (teeth, sectors, count) = (body.mesh.teeth(), body.mesh.sectors(), loads[0].len());
    progress.stage("tooth submodel");
    let submodels: Vec<ToothSubmodel> = flanks
        .iter()
        .zip(loads)
        .map(|(&side, loads)| {
            ToothSubmodel::new(&body.model, &body.mesh, side, loads, body.deformation)
        })
        .collect::<Result<_, _>>()?;
    let of_tooth = submodels.iter().zip(loads);
    let c_tooth: Vec<f64> = of_tooth
        .flat_map(|(submodel, loads)| submodel.compliance(loads))
        .collect();
    stages.lap("tooth submodel");

    let normals = normals(loads.iter().flatten());
    let row_length = teeth * normals.len();
    let is_long = sectors == 1 && row_length * row_length > MOST_IN_FULL;
    let found = is_long
        .then(|| by_patterns(body, &normals, progress))
        .flatten();
    // By patterns the rows are those of tooth 0, with which the checks and the error estimate do.
    let (values, patterns) = match found {
        Some(found) => {
            body.count(found.solved);
            (found.first_tooth, Some((found.patterns, found.left_out)))
        }
        None => {
            progress.stage("solving flank loads");
            (body.compliance(teeth / sectors, &normals, progress), None)
        }
    };
    let rows = HubRows {
        values,
        flanks: flanks.len(),
        teeth,
        count,
    };
    stages.lap("solve");

    progress.stage("checking");
    let symmetry = rows.asymmetry();
    let by_fields = rows_by_fields(body, &normals, &rows);
    // What each entry lacks may add up in a sum of all rows.
    let left_out = by_fields.entries_in_sum * patterns.as_ref().map_or(0.0, |(_, left)| *left);
    let rows_by_fields = by_fields.off;
    let pattern_identity = pattern_identity(
        (&submodels[0], &c_tooth),
        &normals[..count],
        &rows,
        |loads, each| body.solve_each(loads, &Silent, each),
        |patterns| body.energy_products(patterns),
    );
    let c_hub = rows.into_blocks();
    for (check, found, allowed) in [
        ("symmetry of C_hub", symmetry, SYMMETRY_ALLOWED),
        ("the pattern identity", pattern_identity, IDENTITY_ALLOWED),
        (ROWS_BY_FIELDS, rows_by_fields, IDENTITY_ALLOWED + left_out),
    ] {
        checked(check, found, allowed)?;
    }
    stages.lap("checks");
    Ok(FlankCompliance {
        submodels,
        c_hub,
        c_tooth,
        symmetry,
        pattern_identity,
        rows_by_fields,
        patterns,
    })
}

/// Refuses a violation of an identity that round-off does not explain.
pub(crate) fn checked(check: &'static str, found: f64, allowed: f64) -> Result<(), ReductionError> {
    if found.is_nan() || found > allowed {
        return Err(ReductionError::Check {
            check,
            found,
            allowed,
        });
    }
    Ok(())
}

/// C_hub as it is solved: for each load of the first teeth, `[tooth][flank][load]`, the responses of all teeth,
/// `[tooth][flank][response]`.
pub(crate) struct HubRows {
    pub values: Vec<f64>,
    pub flanks: usize,
    pub teeth: usize,
    /// Loads of a flank.
    pub count: usize,
}

impl HubRows {
    fn row_length(&self) -> usize {
        self.teeth * self.flanks * self.count
    }

    /// Number of rows: the loads of the first teeth.
    fn known(&self) -> usize {
        self.values.len() / self.row_length()
    }

    /// As blocks between flanks, `[load's tooth][load's flank][tooth][flank][load][response]`.
    pub fn into_blocks(self) -> Vec<f64> {
        let (count, responses) = (self.count, self.teeth * self.flanks);
        let mut blocks = Vec::with_capacity(self.values.len());
        for load_flank in 0..self.known() / count {
            for response_flank in 0..responses {
                for l in 0..count {
                    let start = ((load_flank * count + l) * responses + response_flank) * count;
                    blocks.extend_from_slice(&self.values[start..start + count]);
                }
            }
        }
        blocks
    }

    /// Largest |C_lm − C_ml| over the first teeth, relative to the largest entry.
    pub fn asymmetry(&self) -> f64 {
        let (rows, row_length) = (&self.values, self.row_length());
        let mut worst: f64 = 0.0;
        let mut largest: f64 = 0.0;
        for i in 0..self.known() {
            for j in 0..=i {
                let (a, b) = (rows[i * row_length + j], rows[j * row_length + i]);
                let difference = (a - b).abs();
                if difference.is_nan() {
                    return f64::NAN;
                }
                worst = worst.max(difference);
                largest = largest.max(a.abs());
            }
        }
        worst / largest
    }
}

/// Weights of the loads in a sum: positive, so that nothing cancels, and without any order of the grid's. A product of
/// matrices is checked by its product with such a vector: R. Freivalds, *Probabilistic machines can use less running
/// time*, Information Processing 77 (1977) 839-842.
fn weights_of_sum(loads: usize, sum: usize) -> Vec<f64> {
    let weight = |load: usize| (((load + 1) * (load + 1) * (sum + 1)) as f64).sin().abs();
    (0..loads).map(weight).collect()
}

/// Σ w_l p_l of loads p, for the weights of each sum.
fn sums_of(loads: &[&SparseVector]) -> Vec<SparseVector> {
    let sum = |k| {
        let weights = weights_of_sum(loads.len(), k);
        let entries = loads.iter().zip(weights);
        summed(
            entries
                .flat_map(|(load, weight)| load.iter().map(move |&(dof, p)| (dof, weight * p)))
                .collect(),
        )
    };
    (0..SUMS).map(sum).collect()
}

/// Sums of all rows of C_hub beside readings of solved fields.
struct RowsByFields {
    /// Largest difference, relative to the largest value.
    off: f64,
    /// The largest entry in every row of a sum, over the largest value.
    entries_in_sum: f64,
}

/// Compares sums of all rows of C_hub with what all teeth read of the solved fields of the same sums of loads. By
/// repetition C_hub is made of products of half solves, symmetric by construction: this goes the other way, out to
/// every tooth again.
fn rows_by_fields(
    body: &GearBody<impl RepeatedMesh>,
    normals: &[&SparseVector],
    c_hub: &HubRows,
) -> RowsByFields {
    let (c_rows, row_length) = (&c_hub.values, c_hub.row_length());
    let loads = sums_of(normals);
    let loads: Vec<&SparseVector> = loads.iter().collect();
    let entry = c_rows.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let (mut worst, mut largest, mut weights): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for (k, reading) in body.readings(&loads, normals, &Silent).iter().enumerate() {
        let mut sum = vec![0.0; row_length];
        for (row, weight) in c_rows
            .chunks(row_length)
            .zip(weights_of_sum(normals.len(), k))
        {
            for (sum, c) in sum.iter_mut().zip(row) {
                *sum += weight * c;
            }
        }
        weights = weights.max(weights_of_sum(normals.len(), k).iter().sum());
        for (a, b) in sum.iter().zip(reading) {
            worst = worst.max((a - b).abs());
            largest = largest.max(a.abs());
        }
    }
    RowsByFields {
        off: worst / largest,
        entries_in_sum: weights * entry / largest,
    }
}

/// ‖ΨᵀKΨ − C_g‖ / ‖C_g‖ over sums of all patterns of tooth 0's first flank, with K applied to them: `solve_each` solves
/// for loads, `energy_products` takes XᵀKX of fields.
pub(crate) fn pattern_identity(
    (submodel, c_tooth): (&ToothSubmodel, &[f64]),
    normals: &[&SparseVector],
    c_hub: &HubRows,
    solve_each: impl FnOnce(&[&SparseVector], &mut dyn FnMut(usize, &[f64])),
    energy_products: impl FnOnce(&[Vec<f64>]) -> Mat<f64>,
) -> f64 {
    let (c_rows, row_length) = (&c_hub.values, c_hub.row_length());
    let count = normals.len();
    let weights: Vec<Vec<f64>> = (0..SUMS).map(|k| weights_of_sum(count, k)).collect();
    let loads = sums_of(normals);
    let loads: Vec<&SparseVector> = loads.iter().collect();
    let mut patterns: Vec<Vec<f64>> = Vec::with_capacity(SUMS);
    solve_each(&loads, &mut |k, u| {
        let mut pattern = u.to_vec();
        submodel.subtract(&weights[k], &mut pattern);
        patterns.push(pattern);
    });
    let energy = energy_products(&patterns);
    let c_g = |l: usize, m: usize| c_rows[l * row_length + m] - c_tooth[l * count + m];
    let (mut difference, mut norm) = (0.0, 0.0);
    for (a, of_a) in weights.iter().enumerate() {
        for (b, of_b) in weights.iter().enumerate() {
            let row = |l: usize| of_b.iter().enumerate().map(move |(m, w)| w * c_g(l, m));
            let rows = of_a.iter().enumerate();
            let expected: f64 = rows.map(|(l, w)| w * row(l).sum::<f64>()).sum();
            difference += (energy[(a, b)] - expected).powi(2);
            norm += expected * expected;
        }
    }
    (difference / norm).sqrt()
}
