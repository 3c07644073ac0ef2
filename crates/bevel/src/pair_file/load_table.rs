//! `[load]`: torques under which the contact is analysed, and what deflects.

use gearmesh_geometry::given;
use std::path::PathBuf;

use gearmesh_geometry::InputError;
use gearmesh_geometry::gear_file::PoissonRatio;
use gearmesh_geometry::input::{Bounded, Count, End, InputDocument, Positive, TableKeys, Within};
use gearmesh_geometry::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Contact under load.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct LoadTable {
    /// Torques on the gear, one to 20 of them.
    pub torques_Nm: Vec<Bounded<DrivingTorque>>,
    /// Slices along the face. Where not given those of the coarser model, more are not allowed; without models 31, and
    /// up to 100 where a light load touches few of them.
    pub slices: Option<Count<3, 100>>,
    /// Positions over a pitch, 24 where not given.
    pub positions_per_pitch: Option<Count<4, 500>>,
    /// Reduced models (.h5) of pinion and gear, relative to this file. Where not given, the gears are rigid, and their
    /// surfaces deflect as half spaces do.
    pub models: Option<[PathBuf; 2]>,
    /// Coefficient of friction of the teeth, for the efficiency; none printed where not given.
    pub friction: Option<Bounded<Within<0, 1>>>,
    /// Without models: Young's modulus of both gears, 206 where not given (steel).
    pub young_GPa: Option<Bounded<Positive>>,
    /// Without models: Poisson's ratio of both gears, 0.3 where not given.
    pub poisson: Option<Bounded<PoissonRatio>>,
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

number_range!(
    /// Torques of a stated direction.
    pub DrivingTorque: End::Beyond(0.0), End::Open, "`pinion_flank` says which flank drives"
);

impl LoadTable {
    pub(super) fn request(&self, document: &InputDocument) -> Result<LoadRequest, InputError> {
        let keys = TableKeys::new(document, "load");
        let count = self.torques_Nm.len();
        if !(1..=20).contains(&count) {
            let problem = format!("found {count} torques, allowed are 1 to 20");
            return Err(keys.error("torques_Nm", problem));
        }
        if self.models.is_some() {
            let problem = "is not used with `models`, which have their own; remove it";
            keys.refuse(&given!(self; young_GPa, poisson), problem)?;
        }
        let young = self.young_GPa.map_or(206.0, f64::from);
        let poisson = self.poisson.map_or(0.3, f64::from);
        Ok(LoadRequest {
            torques_nm: self.torques_Nm.iter().map(|torque| **torque).collect(),
            slices: self.slices.map(Count::get),
            positions: self.positions_per_pitch.map_or(24, Count::get),
            friction: self.friction.map(f64::from),
            models: self.models.clone(),
            material: (young * 1e9, poisson),
        })
    }
}
