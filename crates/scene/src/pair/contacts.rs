//! Where the teeth of a loaded scene touch: lines, slices, and the contact that finds their forces.

use super::result::SceneResult;
use super::run::LoadedScene;
use gearmesh_contact::{ContactError, ContactLine, ContactLines, ContactSlice, StaticContact};
use gearmesh_recovery::LoadedSlice;
use std::borrow::Cow;

impl LoadedScene {
    /// Whether the contact lines of a result are those of this scene.
    #[must_use]
    pub fn has_lines_of(&self, result: &SceneResult) -> bool {
        let counts = result.angle_rad.iter().zip(&result.pair_count);
        self.line_slots(&result.angle_rad) == result.slots
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

    /// The slices that touch or may touch at a driver angle.
    pub fn slices_at(&self, driver_angle_rad: f64) -> Vec<ContactSlice> {
        let (centres, width) = (self.layout.centres_m(), self.layout.width_m());
        let (placed, lines) = self.lines_at(driver_angle_rad);
        let mut slices = Vec::new();
        for line in lines.iter().enumerate() {
            placed.push_slices(line, &centres, width, &mut slices);
        }
        slices
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

    /// Slices with their forces `[line][slice]` as gear 1 or gear 2 bears them.
    pub fn loaded_slices<'a>(
        &'a self,
        gear: usize,
        slices: &'a [ContactSlice],
        forces_n: &'a [f64],
    ) -> impl Iterator<Item = LoadedSlice> + 'a {
        let count = self.layout.slices;
        slices.iter().map(move |slice| {
            let line = &slice.section;
            let (tooth, roll_rad) = if gear == 1 {
                (line.tooth_1, line.roll_1_rad)
            } else {
                (line.tooth_2, line.roll_2_rad)
            };
            let friction = self.scene.contact.friction;
            let ratio = friction.map_or(0.0, |f| f.ratio(line.path_m));
            LoadedSlice {
                tooth,
                slice: slice.slice,
                roll_rad,
                components: line.force_components(gear - 1, ratio),
                force_n: forces_n[slice.line * count + slice.slice],
            }
        })
    }

    /// A contact problem of this scene.
    ///
    /// # Errors
    /// [`ContactError`] when the models do not fit each other.
    pub fn contact(&self) -> Result<StaticContact, ContactError> {
        let contact = StaticContact::new(
            self.lines.clone(),
            &self.models[0],
            &self.models[1],
            self.scene.contact,
        )?
        .with_deviations(self.deviations.clone());
        Ok(match self.runout {
            None => contact,
            Some(runout) => contact.with_runout(runout),
        })
    }
}
