//! `microgeometry.topography`: a table over the flank, in the file itself or in one of its own.

use super::{MM, UM};
use crate::given;
use crate::input::{Bounded, InputError, NumberTable, TableKeys, Within};
use crate::involute;
use crate::microgeometry::Topography;
use crate::tooth::ToothGeometry;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A grid of points over the profile and the axis; bilinear between them, held beyond the borders.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TopographyTable {
    /// File with the columns roll_deg or diameter_mm, z_mm and removed_um, a row for each point of the grid, in any
    /// order; instead of the keys below. Not in gear files, which models keep without other files.
    pub file: Option<PathBuf>,
    /// Places along the profile, increasing: roll angles.
    pub roll_deg: Option<Vec<f64>>,
    /// Places along the profile, increasing: diameters, instead of roll angles.
    pub diameter_mm: Option<Vec<f64>>,
    /// Places along the axis from mid-face, increasing.
    pub z_mm: Option<Vec<f64>>,
    /// Material removed: a list for each place along the profile, with a number for each place along the axis.
    pub removed_um: Option<Vec<Vec<Amount>>>,
}

/// Largest amount in micrometres.
const LARGEST_UM: i32 = 1000;

/// What is removed from a flank, or added where it is negative, in micrometres.
pub type Amount = Bounded<Within<{ -LARGEST_UM }, LARGEST_UM>>;

impl TopographyTable {
    pub(super) fn check(
        &self,
        keys: &TableKeys<'_>,
        profile: &ToothGeometry,
        folder: Option<&Path>,
    ) -> Result<Topography, InputError> {
        let Some(file) = &self.file else {
            return self.stated(keys, profile);
        };
        keys.refuse(
            &given!(self; roll_deg, diameter_mm, z_mm, removed_um),
            "is given together with `file`; remove one of the two",
        )?;
        let Some(folder) = folder else {
            let problem = "a gear file cannot name another file: its model keeps the gear file alone. Write the table here, with \
                           roll_deg or diameter_mm, z_mm and removed_um, or name the file in the scene";
            return Err(keys.error("file", problem));
        };
        from_file(&folder.join(file), profile)
    }

    fn stated(
        &self,
        keys: &TableKeys<'_>,
        profile: &ToothGeometry,
    ) -> Result<Topography, InputError> {
        let needed_by = "a topography without `file`";
        let (key, rolls) = match (&self.roll_deg, &self.diameter_mm) {
            (Some(_), Some(_)) => {
                let problem = "is given together with roll_deg; remove one of the two";
                return Err(keys.error("diameter_mm", problem));
            }
            (None, Some(diameters)) => {
                let mut rolls = Vec::with_capacity(diameters.len());
                for (i, &diameter) in diameters.iter().enumerate() {
                    let (ok, allowed) = above_base_circle(diameter, profile);
                    keys.require(&format!("diameter_mm.{i}"), diameter, ok, &allowed)?;
                    rolls.push(roll_rad(diameter, profile));
                }
                ("diameter_mm", rolls)
            }
            (angles, None) => {
                let angles = keys.needed("roll_deg", angles.as_ref(), needed_by)?;
                ("roll_deg", angles.iter().map(|a| a.to_radians()).collect())
            }
        };
        let heights = keys.needed("z_mm", self.z_mm.as_ref(), needed_by)?;
        let rows = keys.needed("removed_um", self.removed_um.as_ref(), needed_by)?;
        for (key, places) in [(key, &rolls), ("z_mm", heights)] {
            if places.is_empty() || places.windows(2).any(|pair| pair[1] <= pair[0]) {
                return Err(keys.error(
                    key,
                    "allowed are one number or more, each larger than the one before",
                ));
            }
        }
        if rows.len() != rolls.len() {
            let problem = format!(
                "found {} lists, allowed are {}: one for each of {key}",
                rows.len(),
                rolls.len()
            );
            return Err(keys.error("removed_um", problem));
        }
        for (i, row) in rows.iter().enumerate() {
            if row.len() != heights.len() {
                let problem = format!(
                    "found {} numbers, allowed are {}: one for each of z_mm",
                    row.len(),
                    heights.len()
                );
                return Err(keys.error(&format!("removed_um.{i}"), problem));
            }
        }
        let heights = heights.iter().map(|z| MM * z).collect();
        let removed = rows.iter().flatten().map(|&value| UM * value).collect();
        Topography::new(rolls, heights, removed).map_err(|e| keys.error("", e))
    }
}

/// The grid of a file whose rows are its points.
fn from_file(path: &Path, profile: &ToothGeometry) -> Result<Topography, InputError> {
    let along = NumberTable::head_among(path, ["roll_deg", "diameter_mm"])?;
    let table = NumberTable::read(path, &[along, "z_mm", "removed_um"])?;
    let columns = [0, 1, 2].map(|number| table.column(number));
    let [places, heights] = [columns[0], columns[1]].map(distinct);
    let mut rolls = Vec::with_capacity(places.len());
    for &place in &places {
        if along == "roll_deg" {
            rolls.push(place.to_radians());
            continue;
        }
        let (ok, allowed) = above_base_circle(place, profile);
        if !ok {
            return Err(table.error(format!("{along}: found {place}, allowed is {allowed}")));
        }
        rolls.push(roll_rad(place, profile));
    }
    let mut removed = vec![None; places.len() * heights.len()];
    for ((place, z), value) in columns[0].iter().zip(columns[1]).zip(columns[2]) {
        if value.abs() > f64::from(LARGEST_UM) {
            return Err(table.error(format!(
                "removed_um: found {value}, allowed is -{LARGEST_UM} to {LARGEST_UM}"
            )));
        }
        let row = places.partition_point(|other| other < place);
        let entry = &mut removed[row * heights.len() + heights.partition_point(|other| other < z)];
        if entry.replace(UM * value).is_some() {
            return Err(table.error(format!(
                "the point at {along} {place}, z_mm {z} is there twice"
            )));
        }
    }
    let mut values = Vec::with_capacity(removed.len());
    for (k, value) in removed.into_iter().enumerate() {
        let (place, z) = (places[k / heights.len()], heights[k % heights.len()]);
        values.push(value.ok_or_else(|| {
            table.error(format!(
                "the point at {along} {place}, z_mm {z} is missing; the table needs every place along the profile with every \
                 place along the axis"
            ))
        })?);
    }
    let heights = heights.iter().map(|z| MM * z).collect();
    Topography::new(rolls, heights, values).map_err(|e| table.error(e))
}

/// The values of a column, each once, increasing.
fn distinct(column: &[f64]) -> Vec<f64> {
    let mut values = column.to_vec();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

fn above_base_circle(diameter_mm: f64, profile: &ToothGeometry) -> (bool, String) {
    let base_mm = 2.0 * profile.base_radius_m / MM;
    let allowed = format!("{base_mm:.3}, the base diameter, or more");
    (diameter_mm >= base_mm, allowed)
}

fn roll_rad(diameter_mm: f64, profile: &ToothGeometry) -> f64 {
    involute::roll_angle_rad(0.5 * diameter_mm * MM, profile.base_radius_m)
}
