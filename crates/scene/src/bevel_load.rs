//! A bevel pair under the torques of its `[load]`: its slices, and what gives way. For `gearmesh tca` and for studies.

use gearmesh_bevel::pair_file::LoadRequest;
use gearmesh_bevel::{PairDesign, PairFile};
use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::{BevelSlices, DrivetrainError, LoadedContact, LoadedPair};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;

/// Slices of rigid gears where the file says nothing.
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

/// Loads a pair with its reduced members, or as rigid gears whose surfaces give way as half spaces do.
///
/// # Errors
/// [`BevelLoadError`].
pub fn load_bevel(
    (file, design): (&PairFile, &PairDesign),
    load: &LoadRequest,
    models: Option<[&ReducedGear; 2]>,
) -> Result<LoadedBevel, BevelLoadError> {
    let slices = slices(load, models)?;
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
