//! What deflects in a bevel mesh in slices: two reduced gears, or the surfaces of rigid ones.

use std::sync::Arc;

use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{ContactError, HalfSpaces, LocalContact, SliceCompliance};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;

use super::bevel_mesh::BevelMesh;
use super::sliced_mesh::BevelSlices;
use crate::error::DrivetrainError;
use crate::flank_kinematics::FlankKinematics;
use crate::models::hybrid::ReducedTeeth;

/// How far points of a model may lie off the flanks of the mesh \[m\].
const SAME_FLANK_M: f64 = 1e-6;

impl BevelSlices {
    /// The contact of two reduced gears on one side of the teeth.
    ///
    /// # Errors
    /// [`DrivetrainError::OtherBevel`] where a model is not that of its member of this pair,
    /// [`DrivetrainError::Contact`] where it has no loads on the side or no calibration that `local` needs.
    pub fn reduced_contact(
        &self,
        side: Flank,
        models: [&ReducedGear; 2],
        local: LocalContact,
    ) -> Result<SliceContact, DrivetrainError> {
        let layout = *self.layout();
        let flank = |gear: usize| {
            models[gear].flank_index(side).map_err(ContactError::from)?;
            self.pair().check_model(gear, models[gear])?;
            let made = SliceCompliance::of_bevel(models[gear], side, local, layout.slices);
            Ok::<_, DrivetrainError>(made.map_err(ContactError::from)?)
        };
        // Slices stand where they were laid on gear 1, and walk along the teeth of gear 2.
        let compliance = [flank(0)?, flank(1)?.walking_along(layout.face_widths_m[0])];
        let lines = self.capacity() / layout.slices;
        Ok(SliceContact::new(
            layout,
            compliance.map(Arc::new),
            local,
            lines,
        ))
    }

    /// The contact of rigid gears whose surfaces deflect: Young's modulus \[Pa\] and Poisson's ratio of both.
    #[must_use]
    pub fn surface_contact(&self, materials: [(f64, f64); 2]) -> SliceContact {
        let layout = *self.layout();
        let lines = self.capacity() / layout.slices;
        SliceContact::of_half_spaces(layout, HalfSpaces::new(materials), lines)
    }

    /// The teeth of one side; `nominal_force_n`: normal force of the nominal load, which sets the floor of the local
    /// law's logarithm.
    ///
    /// # Errors
    /// As [`Self::reduced_contact`] and [`ReducedTeeth::of_flanks`].
    pub fn reduced_teeth(
        &self,
        side: Flank,
        models: [&ReducedGear; 2],
        (local, nominal_force_n): (LocalContact, f64),
    ) -> Result<ReducedTeeth, DrivetrainError> {
        ReducedTeeth::of_flanks(self.reduced_contact(side, models, local)?, nominal_force_n)
    }
}

impl BevelMesh {
    /// Refuses a model that is not that of gear 0 or 1 of this pair.
    ///
    /// # Errors
    /// [`DrivetrainError::OtherBevel`].
    pub fn check_model(&self, gear: usize, model: &ReducedGear) -> Result<(), DrivetrainError> {
        let other = |problem: String| DrivetrainError::OtherBevel {
            gear: gear + 1,
            model: model.name.clone(),
            problem,
        };
        let Some(bevel) = &model.bevel else {
            return Err(other("it is a cylindrical gear".to_owned()));
        };
        if bevel.member.index() != gear {
            let problem = ["it is the pair's gear", "it is the pair's pinion"][gear];
            return Err(other(problem.to_owned()));
        }
        let teeth = self.teeth()[gear];
        if model.teeth != teeth {
            let problem = format!("it has {} teeth, the pair {teeth}", model.teeth);
            return Err(other(problem));
        }
        for side in model.flanks.iter().copied() {
            let farthest_m = self.off_flank_m((gear, side), model);
            if farthest_m > SAME_FLANK_M {
                let problem = format!(
                    "its {} flanks lie up to {:.4} mm off those of the pair: it was reduced from another pair file or other settings",
                    side.name(),
                    1e3 * farthest_m
                );
                return Err(other(problem));
            }
        }
        Ok(())
    }

    /// How far the points of a model lie off a flank at most \[m\].
    fn off_flank_m(&self, (gear, side): (usize, Flank), model: &ReducedGear) -> f64 {
        let (grid, mut farthest_m) = (&model.grid, 0.0f64);
        for (i, u) in grid.roll_angles_rad.iter().enumerate() {
            for (j, along_m) in grid.z_m.iter().enumerate() {
                let s = along_m / model.face_width_m + 0.5;
                let Some([point, _]) = model.bevel_point(side, grid.load(i, j)) else {
                    continue;
                };
                let own = self.flank_point_m(side, gear, [s, *u]);
                let off = own - nalgebra::Vector3::from(point);
                farthest_m = farthest_m.max(off.norm());
            }
        }
        farthest_m
    }
}
