//! Where the teeth of a loaded scene touch: lines, slices, and the contact that finds their forces.

use super::result::SceneResult;
use super::run::LoadedScene;
use super::scene_file::Scene;
use gearmesh_contact::{
    ContactError, ContactLine, ContactLines, ContactPatch, SliceLayout, StaticContact,
};
use gearmesh_geometry::InputError;
use gearmesh_model::ReducedGear;
use gearmesh_recovery::LoadedSlice;
use std::borrow::Cow;
use std::sync::Arc;

/// The slices of a scene over the overlap of the faces.
///
/// # Errors
/// [`InputError`] for faces side by side and for slices that the models do not resolve.
pub(crate) fn slice_layout(
    scene: &Scene,
    models: &[Arc<ReducedGear>; 2],
) -> Result<SliceLayout, InputError> {
    let models = [&*models[0], &*models[1]];
    SliceLayout::resolved(models, scene.axial_offset_m, scene.slices).map_err(|e| {
        let key = match e {
            ContactError::Slices { .. } => "mesh.model.slices",
            _ => "pair.axial_offset_mm",
        };
        scene.document.error(key, e)
    })
}

impl LoadedScene {
    /// Whether the contact lines of a result are those of this scene.
    #[must_use]
    pub fn has_lines_of(&self, result: &SceneResult) -> bool {
        let counts = result.angle_rad.iter().zip(&result.lines.pair_count);
        self.line_slots(&result.angle_rad) == result.lines.slots
            && counts
                .into_iter()
                .all(|(&angle, &count)| self.lines_at(angle).1.len() == count as usize)
    }

    /// Largest number of contact lines at once at these driver angles \[rad\]; gears beside their axes may stand closer
    /// together than the pair.
    pub(super) fn line_slots(&self, angles_rad: &[f64]) -> usize {
        let ideal = self.lines.most_pairs();
        if self.runout.is_none() {
            return ideal;
        }
        let counts = angles_rad.iter().map(|&angle| self.lines_at(angle).1.len());
        counts.fold(ideal, usize::max)
    }

    /// The patches that touch or may touch at a driver angle.
    pub fn patches_at(&self, driver_angle_rad: f64) -> Vec<ContactPatch> {
        let friction = self.scene.contact.friction;
        let (placed, lines) = self.lines_at(driver_angle_rad);
        let mut patches = Vec::new();
        for line in lines.iter().enumerate() {
            placed.push_patches(line, &self.layout, friction, &mut patches);
        }
        patches
    }

    /// The kinematics with the gears where they stand at a driver angle, and the contact lines there.
    pub(super) fn lines_at(
        &self,
        driver_angle_rad: f64,
    ) -> (Cow<'_, ContactLines>, Vec<ContactLine>) {
        let mut lines = Vec::new();
        let Some(runout) = &self.runout else {
            self.lines.at(driver_angle_rad, &mut lines);
            return (Cow::Borrowed(&self.lines), lines);
        };
        let placement = runout.at(&self.lines.pair, driver_angle_rad);
        let mut placed = self.lines.clone();
        placed.place(&placement);
        placed.at(driver_angle_rad + placement.ahead_rad, &mut lines);
        (Cow::Owned(placed), lines)
    }

    /// Patches with their forces `[line][slice]` as gear 1 or gear 2 carries them.
    pub fn loaded_slices<'a>(
        &'a self,
        gear: usize,
        patches: &'a [ContactPatch],
        forces_n: &'a [f64],
    ) -> impl Iterator<Item = LoadedSlice> + 'a {
        let count = self.layout.slices;
        patches.iter().map(move |patch| LoadedSlice {
            tooth: patch.teeth[gear - 1],
            slice: patch.slice,
            roll_rad: patch.places[gear - 1].u,
            components: patch.force_components(gear - 1),
            force_n: forces_n[patch.line * count + patch.slice],
        })
    }

    /// A contact problem of this scene.
    ///
    /// # Errors
    /// [`ContactError`] when the models do not fit each other.
    pub fn contact(&self) -> Result<StaticContact, ContactError> {
        let models = [&*self.models[0], &*self.models[1]];
        let (lines, options) = (self.lines.clone(), self.scene.contact);
        let key = format!(
            "{:?} {:?} {:?} {:?} {:?} {} {:?}",
            self.model_digests,
            self.scene.gears.each_ref().map(|gear| gear.slides),
            lines.pair.flank,
            options.local,
            self.layout,
            lines.most_pairs(),
            lines.extension.is_some(),
        );
        let slices = self.condensed.of(key, || {
            StaticContact::condensed(&lines, models, options.local, self.layout)
        })?;
        let contact = StaticContact::of_condensed(lines, slices, options.friction)
            .with_deviations(self.deviations.clone());
        Ok(match self.runout {
            None => contact,
            Some(runout) => contact.with_runout(runout),
        })
    }
}
