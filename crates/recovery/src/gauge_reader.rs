//! Gauges of one gear, ready to be read for any forces on contact lines.

use gearmesh_contact::{AxialSpread, ProfileHats, ProfilePlace};
use gearmesh_model::{Flank, GaugeRows, ReducedGear, ReducedGearError};

/// Force on one slice of this gear.
#[derive(Debug, Clone, Copy)]
pub struct LoadedSlice {
    /// Tooth of this gear.
    pub tooth: usize,
    /// Slice of the contact zone, as spread over this gear.
    pub slice: usize,
    /// Roll angle on this gear \[rad\].
    pub roll_rad: f64,
    /// Components along this flank's inward normal and towards the tip, over the force: (1, 0) on a flank without
    /// friction, see [`gearmesh_contact::ContactPatch::force_components`].
    pub components: [f64; 2],
    /// Normal force of the contact \[N\].
    pub force_n: f64,
}

/// Strain by both methods, dimensionless, positive in tension.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Strain {
    /// Patterns and participation factors; force components along the flanks' normals only.
    pub method_1: f64,
    /// True loads on the finite element model; friction included.
    pub method_2: f64,
}

/// Several gauges of one gear for loads on one hand of flank, read together: strain per newton on a slice at a roll
/// station.
#[derive(Debug, Clone)]
pub struct GaugeArray {
    count: usize,
    slices: usize,
    stations: usize,
    hats: ProfileHats,
    /// `[tooth][station][slice][gauge]` of (method 1 normal, method 2 normal, method 2 tangential).
    rows: Vec<[f64; 3]>,
}

impl GaugeArray {
    /// Condenses gauges of a model for loads on one hand of flank; `spread`: where the slices' forces sit on this gear.
    ///
    /// # Errors
    /// [`ReducedGearError::FlankNotReduced`] when the model carries no loads there.
    pub fn new<'a>(
        model: &ReducedGear,
        gauges: impl IntoIterator<Item = &'a GaugeRows>,
        flank: Flank,
        spread: &AxialSpread,
    ) -> Result<Self, ReducedGearError> {
        let f = model.flank_index(flank)?;
        let gauges: Vec<&GaugeRows> = gauges.into_iter().collect();
        let grid = &model.grid;
        let (stations, slices) = (grid.roll_angles_rad.len(), spread.slices());
        let loads = grid.len();
        let mut rows = Vec::with_capacity(model.teeth * stations * slices * gauges.len());
        let row = |gauge: &GaugeRows, tooth: usize, station: usize, slice: usize| {
            let mut row = [0.0; 3];
            for &(axial, share) in spread.shares(slice) {
                let load = grid.load(station, axial);
                let at = 3 * ((tooth * model.flanks.len() + f) * loads + load);
                let (normal, tangential) = (gauge.adjoint[at], gauge.adjoint[at + 1]);
                let local = if tooth == gauge.tooth {
                    gauge.own_tooth[f * loads + load]
                } else {
                    0.0
                };
                row[0] += share * (normal - local);
                row[1] += share * normal;
                row[2] += share * tangential;
            }
            row
        };
        for tooth in 0..model.teeth {
            for station in 0..stations {
                for slice in 0..slices {
                    let of = |gauge: &&GaugeRows| row(gauge, tooth, station, slice);
                    rows.extend(gauges.iter().map(of));
                }
            }
        }
        Ok(Self {
            count: gauges.len(),
            slices,
            stations,
            hats: gearmesh_contact::bevel_slices::profile_hats(model, flank)?,
            rows,
        })
    }

    /// Number of gauges.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Where a roll angle lies between the stations; slices of one contact line share it.
    #[must_use]
    pub fn place(&self, roll_rad: f64) -> ProfilePlace {
        self.hats.place(roll_rad)
    }

    /// Adds the strain under the force on one slice at a place; one entry a gauge. No allocation.
    pub fn add(&self, loaded: &LoadedSlice, place: &ProfilePlace, strain: &mut [Strain]) {
        let [normal, tangential] = loaded.components;
        for (station, weight) in place.shares() {
            let first = (loaded.tooth * self.stations + station) * self.slices + loaded.slice;
            let rows = &self.rows[first * self.count..][..self.count];
            let force = weight * loaded.force_n;
            for (strain, row) in strain.iter_mut().zip(rows) {
                strain.method_1 += force * normal * row[0];
                strain.method_2 += force * (normal * row[1] + tangential * row[2]);
            }
        }
    }
}

/// One gauge with its name.
#[derive(Debug, Clone)]
pub struct GaugeReader {
    /// Name of the gauge.
    pub name: String,
    array: GaugeArray,
}

impl GaugeReader {
    /// Condenses a gauge of a model for loads on one hand of flank.
    ///
    /// # Errors
    /// [`ReducedGearError::FlankNotReduced`] when the model carries no loads there.
    pub fn new(
        model: &ReducedGear,
        gauge: &GaugeRows,
        flank: Flank,
        spread: &AxialSpread,
    ) -> Result<Self, ReducedGearError> {
        Ok(Self {
            name: gauge.name.clone(),
            array: GaugeArray::new(model, [gauge], flank, spread)?,
        })
    }

    /// Strain under the forces on all slices: a few dozen multiplications.
    pub fn read(&self, slices: impl IntoIterator<Item = LoadedSlice>) -> Strain {
        let mut strain = [Strain::default()];
        for loaded in slices.into_iter().filter(|s| s.force_n != 0.0) {
            let place = self.array.place(loaded.roll_rad);
            self.array.add(&loaded, &place, &mut strain);
        }
        strain[0]
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::made_up_models::small_reduced_gear;
    use gearmesh_contact::placed_slice::axial_shares;

    #[test]
    fn without_friction_the_methods_differ_by_the_submodels_strain() {
        let model = small_reduced_gear();
        let gauge = &model.gauges[0];
        let reader =
            GaugeReader::new(&model, gauge, Flank::Right, &AxialSpread::own(&model)).unwrap();
        let forces: Vec<f64> = (0..model.grid.slices)
            .map(|k| 100.0 + 30.0 * k as f64)
            .collect();
        let roll_rad = 0.37;
        let place = ProfileHats::of_involute(&model.grid.roll_angles_rad).place(roll_rad);
        let loaded = |tooth: usize, components: [f64; 2]| {
            forces
                .iter()
                .enumerate()
                .map(move |(slice, &force_n)| LoadedSlice {
                    tooth,
                    slice,
                    roll_rad,
                    components,
                    force_n,
                })
        };
        let strain = reader.read(loaded(gauge.tooth, [1.0, 0.0]));
        let expected: f64 = forces
            .iter()
            .enumerate()
            .flat_map(|(slice, f)| {
                axial_shares(slice, forces.len()).map(move |(axial, share)| (axial, f * share))
            })
            .flat_map(|(axial, f)| {
                place
                    .shares()
                    .map(move |(station, share)| (station, axial, f * share))
            })
            .map(|(station, axial, f)| f * gauge.own_tooth[model.grid.load(station, axial)])
            .sum();
        let scale = strain.method_2.abs().max(expected.abs());
        assert!((strain.method_2 - strain.method_1 - expected).abs() < 1e-14 * scale);
        assert!(expected != 0.0);

        let elsewhere = (gauge.tooth + 2) % model.teeth;
        let far = reader.read(loaded(elsewhere, [1.0, 0.0]));
        assert_eq!(far.method_1, far.method_2);
        let rubbed = reader.read(loaded(gauge.tooth, [1.0, 0.3]));
        assert_eq!(
            rubbed.method_1, strain.method_1,
            "method 1 knows no friction"
        );
        // The whole model under the same forces, normal and tangential.
        let row = |load: usize| {
            let at = 3 * (gauge.tooth * model.flanks.len() * model.grid.len() + load);
            [gauge.adjoint[at], gauge.adjoint[at + 1]]
        };
        let spread = AxialSpread::own(&model);
        let loads = crate::grid_forces(&model.grid, &spread, loaded(gauge.tooth, [1.0, 0.3]));
        let (mut whole, mut tangential) = (0.0, 0.0);
        for load in &loads {
            let [normal, along] = row(load.load);
            whole += load.normal_n * normal + load.tangential_n * along;
            tangential += load.tangential_n * along;
            assert!((load.tangential_n - 0.3 * load.normal_n).abs() < 1e-12);
        }
        assert!((rubbed.method_2 - whole).abs() < 1e-13 * scale);
        assert!((rubbed.method_2 - strain.method_2 - tangential).abs() < 1e-13 * scale);
        assert!(tangential.abs() > 1e-6 * scale);
    }
}
