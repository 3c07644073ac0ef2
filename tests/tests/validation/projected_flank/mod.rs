//! Forces on single element faces beside forces on the flank grid (docs/theory/reduction.md, forces on single elements):
//! two ways to load the same finite elements and to read them.

mod on_gears;

use gearmesh_contact::{AxialSpread, LocalContact, ProfileHats, SliceCompliance};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Flank, GearDefinition};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::ReducedGear;
use gearmesh_reduction::flank_loads::{GridLoad, SparseVector};
use gearmesh_reduction::gauge_row::gauge_row;
use gearmesh_reduction::near_field::PlaneTooth;
use gearmesh_reduction::projected_flank::{ProjectedFlank, line_near_field};
use gearmesh_reduction::tooth_submodel::{Deformation, ToothSubmodel};
use gearmesh_reduction::{GearBody, ReductionOptions, Silent, reduce};

const SIDE: Flank = Flank::Right;

/// A gear both ways: reduced, and its factorised body.
struct BothWays {
    gear: GearDefinition,
    model: ReducedGear,
    body: GearBody,
}

/// Slices of tooth 0 at some roll angles, each uniform over its width, both ways: `[load][response]`, slices of the first
/// roll angle first.
struct Slices {
    count: usize,
    grid: Vec<f64>,
    projected: Vec<f64>,
}

impl BothWays {
    fn new(text: String) -> Self {
        let gear = GearDefinition::from_document(&InputDocument::new("gear.toml", text)).unwrap();
        let options = ReductionOptions {
            estimate_error: false,
        };
        let python = PythonEnvironment::find().unwrap();
        let (model, body) = reduce(&gear, &python, options, &Silent).unwrap();
        Self { gear, model, body }
    }

    fn flank(&self) -> ProjectedFlank<'_> {
        ProjectedFlank::new(
            &self.gear,
            &self.body.mesh,
            self.body.model.nodes(),
            (0, SIDE),
        )
    }

    /// Ends of the slices along the axis \[m\].
    fn stretches(&self) -> Vec<[f64; 2]> {
        let width = self.model.slice_width_m();
        let at = |k: usize| width * k as f64 - 0.5 * self.model.face_width_m;
        (0..self.model.grid.slices)
            .map(|k| [at(k), at(k + 1)])
            .collect()
    }

    fn lines(&self, rolls: &[f64]) -> Vec<GridLoad> {
        let flank = self.flank();
        let stretches = self.stretches();
        let all = rolls
            .iter()
            .flat_map(|&roll| stretches.iter().map(move |&z| (roll, z)));
        all.map(|(roll, z)| flank.line(z, |_| roll).unwrap())
            .collect()
    }

    /// The seed's own: one point in the middle of each slice.
    fn points(&self, rolls: &[f64]) -> Vec<GridLoad> {
        let flank = self.flank();
        let stretches = self.stretches();
        let all = rolls
            .iter()
            .flat_map(|&roll| stretches.iter().map(move |z| (roll, 0.5 * (z[0] + z[1]))));
        all.map(|(roll, z)| flank.point(roll, z).unwrap()).collect()
    }

    fn hats(&self) -> ProfileHats {
        ProfileHats::of_involute(&self.model.grid.roll_angles_rad)
    }

    /// Whole compliance and, on the same tooth, that of the tooth-only submodel.
    fn of_loads(&self, loads: &[GridLoad]) -> (Vec<Vec<f64>>, Vec<f64>) {
        let rows: Vec<&SparseVector> = loads.iter().map(|load| &load.normal).collect();
        let hub = self.body.readings(&rows, &rows, &Silent);
        let (model, mesh) = (&self.body.model, &self.body.mesh);
        let submodel = ToothSubmodel::new(model, mesh, SIDE, loads, Deformation::Spatial).unwrap();
        (hub, submodel.products(&rows))
    }

    fn by_grid(&self, local: LocalContact, rolls: &[f64], tooth: usize) -> Vec<f64> {
        let compliance = SliceCompliance::new(&self.model, SIDE, local).unwrap();
        let n = compliance.slices();
        let count = rolls.len() * n;
        let places: Vec<_> = rolls
            .iter()
            .map(|&roll| compliance.on_tooth(0, roll))
            .collect();
        let others: Vec<_> = rolls
            .iter()
            .map(|&roll| compliance.on_tooth(tooth, roll))
            .collect();
        (0..count * count)
            .map(|k| {
                let (a, b) = (k / count, k % count);
                compliance
                    .between(&places[a / n], &others[b / n])
                    .value([a % n, b % n])
            })
            .collect()
    }

    /// Without the near field: the tooth-only submodel's deflection taken off on both sides.
    fn global(&self, loads: &[GridLoad], rolls: &[f64], tooth: usize) -> Slices {
        let (hub, own) = self.of_loads(loads);
        let count = loads.len();
        let projected = (0..count * count).map(|k| {
            let (load, response) = (k / count, k % count);
            let local = if tooth == 0 {
                own[response * count + load]
            } else {
                0.0
            };
            hub[load][tooth * count + response] - local
        });
        Slices {
            count: self.model.grid.slices,
            grid: self.by_grid(LocalContact::WeberBanaschek, rolls, tooth),
            projected: projected.collect(),
        }
    }

    /// With the near field of a Hertz pressure in place of that of hats and of lines; without what does not depend on
    /// either: C_hub − w/b of a slice with itself.
    fn calibrated(&self, loads: &[GridLoad], rolls: &[f64]) -> Slices {
        let (hub, _) = self.of_loads(loads);
        let plane = PlaneTooth::new(
            &self.gear,
            &self.body.mesh,
            &self.body.model,
            &self.model.grid,
        )
        .unwrap();
        let lines = line_near_field(&self.gear, &plane, SIDE, rolls).unwrap();
        let (hats, field) = (self.hats(), self.model.near_field.as_ref().unwrap());
        let stations = self.model.grid.roll_angles_rad.len();
        let of_hats: Vec<f64> = rolls
            .iter()
            .map(|&roll| {
                let place = hats.place(roll);
                place
                    .shares()
                    .flat_map(|(i, a)| place.shares().map(move |(j, b)| (i, j, a * b)))
                    .map(|(i, j, share)| share * field.mesh_m2_per_n[i * stations + j])
                    .sum()
            })
            .collect();
        let count = loads.len();
        let n = self.model.grid.slices;
        let width = self.model.slice_width_m();
        let mut grid = self.by_grid(LocalContact::Calibrated, rolls, 0);
        let mut projected: Vec<f64> = (0..count * count)
            .map(|k| hub[k / count][k % count])
            .collect();
        for k in 0..count {
            // c₀ makes both those of the true contact.
            let c0 = field.contact_at(rolls[k / n], self.model.signed_base_radius_m());
            grid[k * count + k] += (c0 - of_hats[k / n]) / width;
            projected[k * count + k] += (c0 - lines[k / n]) / width;
        }
        Slices {
            count: n,
            grid,
            projected,
        }
    }

    /// What a gauge reads of loads on a tooth, both ways: (grid, projected) of each load, normal and towards the tip.
    fn gauge(
        &self,
        number: usize,
        loads: &[GridLoad],
        rolls: &[f64],
        tooth: usize,
    ) -> Vec<[[f64; 2]; 2]> {
        let definition = &self.gear.gauges[number];
        let row = gauge_row(
            &self.gear,
            &self.body.mesh,
            &self.body.model,
            definition,
            definition.tooth,
        )
        .unwrap();
        let vectors: Vec<&SparseVector> = loads
            .iter()
            .flat_map(|l| [&l.normal, &l.tangential])
            .collect();
        let read = self.body.readings(&[&row], &vectors, &Silent).remove(0);
        let gauge = &self.model.gauges[number];
        let (hats, spread) = (self.hats(), AxialSpread::own(&self.model));
        let grid = &self.model.grid;
        let flanks = self.model.flanks.len();
        (0..loads.len())
            .map(|k| {
                let (roll, slice) = (rolls[k / grid.slices], k % grid.slices);
                let mut by_grid = [0.0; 2];
                for (station, a) in hats.place(roll).shares() {
                    for &(axial, b) in spread.shares(slice) {
                        let at = 3 * (tooth * flanks * grid.len() + grid.load(station, axial));
                        by_grid[0] += a * b * gauge.adjoint[at];
                        by_grid[1] += a * b * gauge.adjoint[at + 1];
                    }
                }
                let at = 2 * (tooth * loads.len() + k);
                [[by_grid[0], read[at]], [by_grid[1], read[at + 1]]]
            })
            .collect()
    }
}

impl Slices {
    /// Of each roll angle with itself: largest difference of the deflection under equal forces on all slices, of each
    /// slice and in the mean; with one slice loaded of that slice and of the others; all over the deflection of the slice
    /// that is loaded, or of all.
    fn differences(&self) -> Vec<[f64; 4]> {
        let n = self.count;
        let all = self.grid.len().isqrt();
        let rolls = all / n;
        (0..rolls)
            .map(|r| {
                let at = |c: &[f64], i: usize, j: usize| c[(r * n + i) * all + r * n + j];
                let sum = |c: &[f64], j: usize| (0..n).map(|i| at(c, i, j)).sum::<f64>();
                let (g, p) = (&self.grid, &self.projected);
                let mut worst = [0.0_f64; 4];
                let mean = |c: &[f64]| (0..n).map(|j| sum(c, j)).sum::<f64>();
                worst[0] = mean(g) / mean(p) - 1.0;
                for j in 0..n {
                    let off = sum(g, j) / sum(p, j) - 1.0;
                    if off.abs() > worst[1].abs() {
                        worst[1] = off;
                    }
                    for i in 0..n {
                        let off = (at(g, i, j) - at(p, i, j)) / at(p, i, i);
                        let slot = if i == j { 2 } else { 3 };
                        if off.abs() > worst[slot].abs() {
                            worst[slot] = off;
                        }
                    }
                }
                worst
            })
            .collect()
    }
}
