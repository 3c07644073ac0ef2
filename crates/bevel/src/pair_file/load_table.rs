//! `[load]`: torques under which the contact is analysed, and what gives way.

use std::path::PathBuf;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use schemars::JsonSchema;
use serde::Deserialize;

/// Contact under load.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub(super) struct LoadTable {
    /// Torques on the gear, one to 20 of them.
    torques_Nm: Vec<f64>,
    /// Slices along the face. Where not given those of the coarser model, more are not allowed; without models 31, and
    /// up to 100 where a light load touches few of them.
    slices: Option<usize>,
    /// Positions over a pitch, 24 where not given.
    positions_per_pitch: Option<usize>,
    /// Reduced models (.h5) of pinion and gear, relative to this file. Where not given, the gears are rigid, and their surfaces
    /// give way as half spaces do.
    models: Option<[PathBuf; 2]>,
    /// Coefficient of friction of the teeth, for the efficiency; none printed where not given.
    friction: Option<f64>,
    /// Without models: Young's modulus of both gears, 206 where not given (steel).
    young_GPa: Option<f64>,
    /// Without models: Poisson's ratio of both gears, 0.3 where not given.
    poisson: Option<f64>,
}

/// What a loaded contact analysis is asked.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadRequest {
    /// Torques on the gear \[N·m\].
    pub torques_nm: Vec<f64>,
    /// Slices along the face, where stated.
    pub slices: Option<usize>,
    /// Positions over a pitch.
    pub positions: usize,
    /// Coefficient of friction of the teeth, where stated.
    pub friction: Option<f64>,
    /// Reduced models of pinion and gear, relative to the pair file; rigid gears without.
    pub models: Option<[PathBuf; 2]>,
    /// Young's modulus \[Pa\] and Poisson's ratio of rigid gears' surfaces.
    pub material: (f64, f64),
}

impl LoadTable {
    pub(super) fn request(&self, document: &InputDocument) -> Result<LoadRequest, InputError> {
        let keys = TableKeys::new(document, "load");
        let count = self.torques_Nm.len();
        if !(1..=20).contains(&count) {
            let problem = format!("found {count} torques, allowed are 1 to 20");
            return Err(keys.error("torques_Nm", problem));
        }
        for (i, torque) in self.torques_Nm.iter().enumerate() {
            let ok = *torque > 0.0 && torque.is_finite();
            let key = format!("torques_Nm.{i}");
            keys.require(
                &key,
                *torque,
                ok,
                "more than 0; `pinion_flank` says which flank drives",
            )?;
        }
        if let Some(slices) = self.slices {
            let ok = (3..=100).contains(&slices);
            keys.require("slices", slices as f64, ok, "3 to 100")?;
        }
        let positions = self.positions_per_pitch.unwrap_or(24);
        let ok = (4..=500).contains(&positions);
        keys.require("positions_per_pitch", positions as f64, ok, "4 to 500")?;
        if let Some(friction) = self.friction {
            let ok = (0.0..=1.0).contains(&friction);
            keys.require("friction", friction, ok, "0 to 1")?;
        }
        if self.models.is_some() {
            let given = [("young_GPa", self.young_GPa), ("poisson", self.poisson)];
            if let Some((key, _)) = given.into_iter().find(|(_, value)| value.is_some()) {
                return Err(keys.error(
                    key,
                    "is not used with `models`, which have their own; remove it",
                ));
            }
        }
        let (young, poisson) = (self.young_GPa.unwrap_or(206.0), self.poisson.unwrap_or(0.3));
        let ok = young > 0.0 && young.is_finite();
        keys.require("young_GPa", young, ok, "more than 0")?;
        let ok = (0.0..0.5).contains(&poisson);
        keys.require("poisson", poisson, ok, "0 up to, not including, 0.5")?;
        Ok(LoadRequest {
            torques_nm: self.torques_Nm.clone(),
            slices: self.slices,
            positions,
            friction: self.friction,
            models: self.models.clone(),
            material: (young * 1e9, poisson),
        })
    }
}
