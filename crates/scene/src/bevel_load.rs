//! A bevel pair under the torques of its `[load]`: its slices, and what deflects. For `gearmesh tca` and for studies.

use gearmesh_bevel::pair_file::LoadRequest;
use gearmesh_bevel::{PairDesign, PairFile};
use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::{BevelSlices, DrivetrainError, LoadedContact, LoadedPair};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;

use crate::pair::figure_table::{RestFigure, figures};
use crate::pair::warnings::ELASTIC_SHARE;

/// Slices of rigid gears where the file says nothing, and more where a light load touches few of them.
const SLICES: usize = 31;

/// What was found under load.
#[derive(Debug)]
pub struct LoadedBevel {
    /// The flanks in slices.
    pub flanks: BevelSlices,
    /// Flanks that press.
    pub side: Flank,
    /// Slices along the face.
    pub slices: usize,
    /// One for each torque.
    pub found: Vec<LoadedContact>,
}

/// What is found under a torque, for its figures.
#[derive(Debug, Clone, Copy)]
pub struct BevelTorque<'a> {
    /// Contacts.
    pub found: &'a LoadedContact,
    /// Slices along the face.
    pub slices: usize,
}

/// The figures of a torque: as those of other pairs (`pair/figure_table.rs`).
#[must_use]
pub fn bevel_figures<'a>() -> [RestFigure<BevelTorque<'a>>; 14] {
    figures! {
        "torque" "torque" Torque All |t| t.found.torque_nm;
        "loaded_te_mean" "TE mean" Angle All |t| t.found.mean_rad();
        "loaded_te_peak_to_peak" "TE pk-pk" Angle All |t| t.found.peak_to_peak_rad();
        "best_pair_share_least" "best pair least" Share All |t| t.found.load_shares()[0];
        "best_pair_share_largest" "largest" Share All |t| t.found.load_shares()[1];
        "loaded_pairs_mean" "pairs" Factor All |t| t.found.mean_pairs();
        "pressure_largest" "p max" Pressure All |t| t.found.pressures_pa()[0];
        "pressure_off_tips" "off tips" Pressure All |t| t.found.pressures_pa()[1];
        "pressure_inside" "inside" Pressure All |t| t.found.pressures_pa()[2];
        "load_on_tips_share" "on tips" Share All |t| t.found.tip_share();
        "pattern_toe_share" "pattern toe" Share All |t| t.found.pattern(t.slices)[0][0];
        "pattern_heel_share" "heel" Share All |t| t.found.pattern(t.slices)[0][1];
        "pattern_root_share" "root" Share All |t| t.found.pattern(t.slices)[1][0];
        "pattern_tip_share" "tip" Share All |t| t.found.pattern(t.slices)[1][1];
    }
}

impl LoadedBevel {
    /// What is to be said of pressures beyond what steel carries elastically ([`ELASTIC_SHARE`]); `young_pa`: the
    /// softer member's modulus.
    #[must_use]
    pub fn too_much_pressure(&self, young_pa: f64) -> Option<String> {
        let limit_pa = ELASTIC_SHARE * young_pa;
        let [of, torque_nm] = (self.found.iter())
            .map(|of| [of.pressures_pa()[0], of.torque_nm])
            .filter(|[pressure, _]| *pressure > limit_pa)
            .max_by(|a, b| a[0].total_cmp(&b[0]))?;
        Some(format!(
            "at {torque_nm} N m the pressure reaches {:.2} GPa, {:.1} % of Young's modulus: above {} % ({:.2} GPa) steel yields, and the elastic contact computed here no longer holds",
            1e-9 * of,
            100.0 * of / young_pa,
            100.0 * ELASTIC_SHARE,
            1e-9 * limit_pa
        ))
    }
}

/// Why a pair cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum BevelLoadError {
    /// Shorter slices than the models tell apart.
    #[error(
        "load.slices: found {found}, allowed with these models is at most {most}, the slices of the coarser one; state fewer, or reduce the members with more `slices`"
    )]
    Slices {
        /// Slices that are asked for.
        found: usize,
        /// Slices of the coarser model.
        most: usize,
    },
    /// No contact, or models that are not those of the pair.
    #[error(transparent)]
    Contact(#[from] DrivetrainError),
}

/// Loads a pair with its reduced members, or as rigid gears whose surfaces deflect as half spaces do.
///
/// # Errors
/// [`BevelLoadError`].
pub fn load_bevel(
    (file, design): (&PairFile, &PairDesign),
    load: &LoadRequest,
    models: Option<[&ReducedGear; 2]>,
) -> Result<LoadedBevel, BevelLoadError> {
    let mut slices = slices(load, models)?;
    let is_free = models.is_none() && load.slices.is_none();
    loop {
        let found = load_in_slices((file, design), load, models, slices)?;
        let finer = (2 * slices).min(MOST_SLICES);
        if !is_free || finer == slices || !wants_more(&found.found, slices as f64 / finer as f64) {
            return Ok(found);
        }
        slices = finer;
    }
}

/// Slices of rigid gears at most where the file says nothing.
const MOST_SLICES: usize = 100;
/// Slices of the pair that carries most which are to be loaded at every position.
const LOADED_SLICES: usize = 8;

/// Whether some position has too few loaded slices for its load to be spread over them, and slices that are shorter by
/// a factor stay longer than every contact's half width, below which the law of half spaces is cut off.
fn wants_more(found: &[LoadedContact], shorter: f64) -> bool {
    let positions = found.iter().flat_map(|of| &of.positions);
    let few = positions.clone().any(|at| {
        let best = at.pair_forces_n().first().map(|(teeth, _)| *teeth);
        let loaded = at.patches.iter().filter(|p| Some(p.teeth) == best);
        loaded.count() < LOADED_SLICES
    });
    few && positions
        .flat_map(|at| &at.patches)
        .all(|p| p.half_width_m < shorter * p.length_m)
}

fn load_in_slices(
    (file, design): (&PairFile, &PairDesign),
    load: &LoadRequest,
    models: Option<[&ReducedGear; 2]>,
    slices: usize,
) -> Result<LoadedBevel, BevelLoadError> {
    let flanks = BevelSlices::new(&file.blank, design, slices)?;
    let pair = LoadedPair {
        blank: &file.blank,
        flanks: &flanks,
        pinion_flank: file.pinion_flank,
        error: file.tca.error,
        positions: load.positions,
    };
    let side = pair.side();
    let contact = match models {
        Some(models) => flanks.reduced_contact(side, models, LocalContact::Calibrated)?,
        None => flanks.surface_contact([load.material; 2]),
    };
    let found = pair.loaded(&contact, &load.torques_nm)?;
    Ok(LoadedBevel {
        side,
        slices,
        found,
        flanks,
    })
}

/// Slices along the face. A model tells its own apart, shorter ones not: their pressure beside edges would be too high.
fn slices(load: &LoadRequest, models: Option<[&ReducedGear; 2]>) -> Result<usize, BevelLoadError> {
    let Some(models) = models else {
        return Ok(load.slices.unwrap_or(SLICES));
    };
    let own = models[0].grid.slices.min(models[1].grid.slices);
    let most = own.max(3);
    let found = load.slices.unwrap_or(most);
    if found > most {
        return Err(BevelLoadError::Slices { found, most });
    }
    Ok(found)
}
