//! Checks that a reduced gear does not contradict itself.

use crate::modal_basis::ModalBasis;
use crate::near_field::NearField;
use crate::quantity_check::{
    check_array, check_calibration, check_error, check_finite, check_stations, in_range,
    out_of_range, positive, smallest,
};
use crate::reduced_gear::ReducedGear;
use crate::reduced_gear_error::ReducedGearError;

impl ReducedGear {
    /// Checks counts, ranges, lengths of all arrays and that every number is finite.
    ///
    /// # Errors
    /// [`ReducedGearError::OutOfRange`], [`ReducedGearError::WrongLength`], [`ReducedGearError::NotFinite`].
    pub fn validate(&self) -> Result<(), ReducedGearError> {
        self.check_counts()?;
        self.check_quantities()?;
        self.check_definition()?;
        let (teeth, flanks, loads) = (self.teeth, self.flanks.len(), self.grid.len());
        let own = self.teeth_per_sector();
        let expected = match &self.hub_patterns {
            None => own * flanks * teeth * flanks * loads * loads,
            Some(patterns) => {
                patterns.check([self.sectors, teeth, flanks * loads])?;
                0
            }
        };
        check_array(
            "c_hub",
            &self.c_hub,
            expected,
            "teeth/sectors * flanks * teeth * flanks * loads * loads",
        )?;
        check_array(
            "c_tooth",
            &self.c_tooth,
            flanks * loads * loads,
            "flanks * loads * loads",
        )?;
        let stations = self.grid.roll_angles_rad.len();
        check_array(
            "opposite_distance_m",
            &self.opposite_distance_m,
            flanks * stations,
            "flanks * roll stations",
        )?;
        in_range(
            "the smallest opposite_distance_m",
            smallest(&self.opposite_distance_m),
            |h| h > 0.0,
            "above 0 m",
        )?;
        if let Some(near_field) = &self.near_field {
            check_near_field(near_field, flanks * stations * stations)?;
        }
        self.check_gauges()?;
        self.check_dynamics()?;
        self.check_crack()?;
        let gauges = self.gauges.len();
        if let Some(faces) = &self.shaft_faces {
            let modes = self.modes.as_ref().map_or(0, ModalBasis::count);
            faces.check([teeth * flanks * loads, gauges, modes])?;
        }
        if let Some(bore) = &self.bore {
            bore.check(own * flanks * loads, gauges)?;
        }
        self.check_bevel()?;
        let times = self
            .provenance
            .stage_seconds
            .iter()
            .chain(&self.provenance.effort)
            .chain(&self.checks.further);
        for (name, value) in times {
            check_finite(name, *value)?;
        }
        check_finite("the symmetry check", self.checks.symmetry)?;
        let identity = self.checks.pattern_identity;
        check_finite("the pattern identity check", identity)
    }

    /// Names are unique, teeth there, rows as long as the loads.
    fn check_gauges(&self) -> Result<(), ReducedGearError> {
        let (teeth, flanks, loads) = (self.teeth, self.flanks.len(), self.grid.len());
        for (index, gauge) in self.gauges.iter().enumerate() {
            let name = &gauge.name;
            let of = |what: &str| format!("{what} of gauge \"{name}\"");
            if gauge.tooth >= teeth {
                let (what, allowed) = (of("the tooth"), "less than teeth");
                return Err(out_of_range(&what, gauge.tooth, allowed));
            }
            if self.gauges[..index].iter().any(|other| other.name == *name) || name.is_empty() {
                let (found, allowed) = (format!("\"{name}\""), "unique and not empty");
                return Err(out_of_range("a gauge name", found, allowed));
            }
            let item = of("error_estimate_relative");
            check_error(&item, gauge.error_estimate_relative)?;
            let (count, what) = (teeth * flanks * loads * 3, "teeth * flanks * loads * 3");
            check_array(&of("adjoint"), &gauge.adjoint, count, what)?;
            let (count, what) = (flanks * loads, "flanks * loads");
            check_array(&of("own_tooth"), &gauge.own_tooth, count, what)?;
        }
        Ok(())
    }

    /// The gear's definition, where it is known, is that of this body and holds quantities that there can be.
    fn check_definition(&self) -> Result<(), ReducedGearError> {
        let Some(gear) = self.input.definition() else {
            return Ok(());
        };
        if gear.tooth.teeth != self.teeth {
            let found = gear.tooth.teeth;
            return Err(out_of_range("definition.tooth.teeth", found, "gear.teeth"));
        }
        let (tooth, material) = (&gear.tooth, &gear.material);
        for (item, value) in [
            ("definition.tooth.module", tooth.module_m),
            ("definition.tooth.face_width", tooth.face_width_m),
            ("definition.blank.edge_radius", gear.blank.edge_radius_m()),
            ("definition.material.young", material.young_pa),
            (
                "definition.material.density",
                material.density_kg_per_m3.unwrap_or(1.0),
            ),
        ] {
            in_range(item, value, positive, "above 0")?;
        }
        let poisson = |value: f64| (0.0..0.5).contains(&value);
        let (item, value) = ("definition.material.poisson", material.poisson);
        in_range(item, value, poisson, "at least 0, less than 0.5")?;
        for flanks in [&gear.microgeometry.right, &gear.microgeometry.left] {
            check_finite("definition.microgeometry", flanks.most_added_m())?;
        }
        Ok(())
    }

    fn check_crack(&self) -> Result<(), ReducedGearError> {
        let Some(crack) = &self.crack else {
            return Ok(());
        };
        if crack.tooth >= self.teeth {
            return Err(out_of_range("crack.tooth", crack.tooth, "less than teeth"));
        }
        self.flank_index(crack.side)?;
        in_range("crack.depth_m", crack.depth_m, positive, "above 0 m")?;
        let mouth_m = crack.mouth_radius_m;
        in_range("crack.mouth_radius_m", mouth_m, positive, "above 0 m")?;
        check_finite("crack.angle_rad", crack.angle_rad)?;
        check_error("crack.left_out", crack.left_out)?;
        let (teeth, loads) = (self.teeth, self.grid.len());
        let rows = crack.count(teeth, loads).max(1);
        check_array(
            "crack.rows",
            &crack.rows,
            rows * teeth * loads,
            "rows * teeth * loads, at least one row",
        )
    }

    fn check_dynamics(&self) -> Result<(), ReducedGearError> {
        let loads = self.teeth * self.flanks.len() * self.grid.len() * 3;
        if let Some(body) = &self.rigid_body {
            in_range("rigid_body.mass_kg", body.mass_kg, positive, "above 0 kg")?;
            let places = [body.reference_m, body.centre_m].concat();
            check_array("rigid_body.centre_m", &places, 6, "3 + 3")?;
            let inertia = body.inertia_kg_m2.as_flattened();
            check_array("rigid_body.inertia_kg_m2", inertia, 9, "3 * 3")?;
        }
        if let Some(point) = &self.reference_point {
            check_array("reference_point.place_m", &point.place_m, 3, "3")?;
            check_array(
                "reference_point.flank",
                &point.flank,
                6 * loads,
                "teeth * flanks * loads * 3 * 6",
            )?;
        }
        let Some(basis) = &self.modes else {
            return Ok(());
        };
        let modes = basis.count();
        if modes == 0 || basis.nodal_diameters.len() != modes {
            return Err(out_of_range(
                "the number of modes",
                format!("{modes} and {}", basis.nodal_diameters.len()),
                "at least 1, the same in all arrays",
            ));
        }
        check_array("modes.omega_squared", &basis.omega_squared, modes, "modes")?;
        in_range(
            "the smallest of modes.omega_squared",
            smallest(&basis.omega_squared),
            positive,
            "above 0",
        )?;
        in_range(
            "modes.complete_to_hz",
            basis.complete_to_hz,
            positive,
            "above 0 Hz",
        )?;
        check_array(
            "modes.flank",
            &basis.flank,
            modes * loads,
            "modes * teeth * flanks * loads * 3",
        )?;
        check_array(
            "modes.gauges",
            &basis.gauges,
            modes * self.gauges.len(),
            "modes * gauges",
        )?;
        check_array("modes.coupling", &basis.coupling, modes * 6, "modes * 6")
    }

    fn check_counts(&self) -> Result<(), ReducedGearError> {
        if self.teeth == 0 || u32::try_from(self.teeth).is_err() {
            return Err(out_of_range("teeth", self.teeth, "at least 1"));
        }
        if self.sectors == 0 || !self.teeth.is_multiple_of(self.sectors) {
            return Err(out_of_range("sectors", self.sectors, "a divisor of teeth"));
        }
        let twice = self.flanks.len() == 2 && self.flanks[0] == self.flanks[1];
        if self.flanks.is_empty() || self.flanks.len() > 2 || twice {
            return Err(out_of_range(
                "flanks",
                format!("{:?}", self.flanks),
                "one hand or both, each once",
            ));
        }
        // The grid has stations at the edges and in the middle of the slices that the gear was reduced with.
        if !(1..=self.grid.z_m.len()).contains(&self.grid.slices) {
            let (found, allowed) = (self.grid.slices, "1 to the number of axial stations");
            return Err(out_of_range("slices", found, allowed));
        }
        Ok(())
    }

    fn check_quantities(&self) -> Result<(), ReducedGearError> {
        in_range("base_radius_m", self.base_radius_m, positive, "above 0 m")?;
        in_range("face_width_m", self.face_width_m, positive, "above 0 m")?;
        in_range("young_pa", self.young_pa, positive, "above 0 Pa")?;
        in_range(
            "poisson",
            self.poisson,
            |nu| nu > -1.0 && nu < 0.5,
            "between -1 and 0.5",
        )?;
        check_stations("grid.roll_angles_rad", &self.grid.roll_angles_rad)?;
        check_stations("grid.z_m", &self.grid.z_m)?;
        in_range(
            "the first of grid.roll_angles_rad",
            self.grid.roll_angles_rad[0],
            |xi| xi >= 0.0,
            "at least 0 rad",
        )?;
        // A nanometre of rounding is allowed at the edges of the face.
        let half_width = 0.5 * self.face_width_m + 1e-9;
        let inside = |z: f64| z.abs() <= half_width;
        in_range(
            "the first of grid.z_m",
            self.grid.z_m[0],
            inside,
            "on the face width",
        )?;
        in_range(
            "the last of grid.z_m",
            self.grid.z_m[self.grid.z_m.len() - 1],
            inside,
            "on the face width",
        )
    }
}

fn check_near_field(near_field: &NearField, expected: usize) -> Result<(), ReducedGearError> {
    let (half_width_m, element_m) = (near_field.half_width_m, near_field.element_m);
    check_calibration("near_field", [half_width_m, element_m, near_field.residual])?;
    check_stations("near_field.roll_angles_rad", &near_field.roll_angles_rad)?;
    check_array(
        "near_field.contact_m2_per_n",
        &near_field.contact_m2_per_n,
        near_field.roll_angles_rad.len(),
        "near-field places",
    )?;
    check_array(
        "near_field.mesh_m2_per_n",
        &near_field.mesh_m2_per_n,
        expected,
        "flanks * roll stations * roll stations",
    )
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::made_up_models::{small_crack, small_reduced_gear};
    use crate::root_crack::RootCrack;
    use gearmesh_geometry::Flank;

    fn near_field(gear: &mut ReducedGear) -> &mut NearField {
        gear.near_field.as_mut().unwrap()
    }

    fn modes(gear: &mut ReducedGear) -> &mut ModalBasis {
        gear.modes.as_mut().unwrap()
    }

    #[test]
    fn every_wrong_figure_of_a_crack_is_found() {
        let mut gear = small_reduced_gear();
        gear.crack = Some(small_crack());
        gear.validate().unwrap();
        type Change = fn(&mut RootCrack);
        let spoil: [(&str, Change); 7] = [
            ("crack.tooth", |c| c.tooth = 6),
            ("crack.depth_m", |c| c.depth_m = 0.0),
            ("crack.mouth_radius_m", |c| c.mouth_radius_m = f64::NAN),
            ("crack.angle_rad", |c| c.angle_rad = f64::INFINITY),
            ("crack.left_out", |c| c.left_out = -1.0),
            ("crack.rows", |c| c.rows.truncate(17)),
            ("crack.rows", |c| c.rows.clear()),
        ];
        for (item, change) in spoil {
            let mut wrong = gear.clone();
            change(wrong.crack.as_mut().unwrap());
            let message = wrong.validate().unwrap_err().to_string();
            assert!(message.contains(item), "{item}: {message}");
        }
        gear.flanks = vec![Flank::Left];
        assert!(gear.check_crack().is_err());
    }

    #[test]
    fn every_wrong_figure_is_found() {
        let gear = small_reduced_gear();
        gear.validate().unwrap();
        type Change = fn(&mut ReducedGear);
        let spoil: [(&str, Change); 29] = [
            ("teeth", |g| g.teeth = 0),
            ("sectors", |g| g.sectors = 4),
            ("flanks", |g| g.flanks = vec![Flank::Left, Flank::Left]),
            ("slices", |g| g.grid.slices = 0),
            ("base_radius_m", |g| g.base_radius_m = -1.0),
            ("young_pa", |g| g.young_pa = f64::INFINITY),
            ("poisson", |g| g.poisson = 0.5),
            ("grid.roll_angles_rad", |g| g.grid.roll_angles_rad[1] = 0.0),
            ("grid.z_m", |g| g.grid.z_m[0] = -1.0),
            ("c_hub", |g| g.c_hub.truncate(7)),
            ("c_hub", |g| g.c_hub[7] = f64::NAN),
            ("c_tooth", |g| g.c_tooth[0] = f64::INFINITY),
            ("opposite_distance_m", |g| g.opposite_distance_m[0] = 0.0),
            ("near_field.half_width_m", |g| {
                near_field(g).half_width_m = 0.0
            }),
            ("near_field.roll_angles_rad", |g| {
                near_field(g).roll_angles_rad[1] = 0.0
            }),
            ("near_field.contact_m2_per_n", |g| {
                near_field(g).contact_m2_per_n[2] = f64::NAN
            }),
            ("near_field.mesh_m2_per_n", |g| {
                near_field(g).mesh_m2_per_n.truncate(9)
            }),
            ("tooth of gauge", |g| g.gauges[0].tooth = 6),
            ("gauge name", |g| {
                g.gauges[1].name = g.gauges[0].name.clone()
            }),
            ("adjoint of gauge \"root\"", |g| {
                g.gauges[0].adjoint[0] = f64::NAN
            }),
            ("rigid_body.mass_kg", |g| {
                g.rigid_body.as_mut().unwrap().mass_kg = 0.0
            }),
            ("rigid_body.inertia_kg_m2", |g| {
                g.rigid_body.as_mut().unwrap().inertia_kg_m2[1][1] = f64::NAN
            }),
            ("reference_point.flank", |g| {
                g.reference_point.as_mut().unwrap().flank.truncate(5)
            }),
            ("number of modes", |g| modes(g).nodal_diameters.truncate(1)),
            ("modes.omega_squared", |g| modes(g).omega_squared[0] = 0.0),
            ("modes.complete_to_hz", |g| modes(g).complete_to_hz = -1.0),
            ("modes.flank", |g| modes(g).flank[4] = f64::NAN),
            ("modes.gauges", |g| modes(g).gauges.truncate(3)),
            ("modes.coupling", |g| modes(g).coupling.truncate(11)),
        ];
        for (item, change) in spoil {
            let mut spoiled = gear.clone();
            change(&mut spoiled);
            let message = spoiled.validate().unwrap_err().to_string();
            assert!(message.contains(item), "{item}: {message}");
        }
    }
}
