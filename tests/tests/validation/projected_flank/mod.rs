//! Forces on single element faces beside forces on the flank grid (docs/theory/projection.md): two ways to load the
//! same finite elements and to read them.

mod over_a_mesh_cycle;
mod slices;

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

/// The slices of lines at some roll angles on tooth 0, projected, and what they deflect each other by \[m/N\].
struct ProjectedLines<'a> {
    both: &'a BothWays,
    rolls_rad: Vec<f64>,
    /// Slices of the first roll angle first.
    loads: Vec<GridLoad>,
    /// `[load][tooth · loads + response]`.
    hub: Vec<Vec<f64>>,
    /// Of the tooth-only submodel, `[response · loads + load]`.
    tooth_only: Vec<f64>,
}

/// Compliance of the slices at some roll angles both ways, `[load][response]`.
struct Compared {
    slices: usize,
    grid: Vec<f64>,
    projected: Vec<f64>,
}

/// Differences of the flank grid from the projection at one roll angle.
#[derive(Debug, Clone, Copy, Default)]
struct Differences {
    /// Equal forces on all slices: mean deflection.
    mean: f64,
    /// The same: the slice that is off most.
    slice: f64,
    /// One slice loaded: that slice, over its deflection, where it is off most.
    own: f64,
    /// The same: all others, over the deflection of the loaded one.
    others: f64,
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

    fn flank(&self, tooth: usize) -> ProjectedFlank<'_> {
        let nodes = self.body.model.nodes();
        ProjectedFlank::new(&self.gear, &self.body.mesh, nodes, (tooth, SIDE))
    }

    fn hats(&self) -> ProfileHats {
        ProfileHats::of_involute(&self.model.grid.roll_angles_rad)
    }

    /// Ends of the flank, and between the centroids of the outermost hats at places on centroids and in the middle
    /// between two: at both ends of that range and in its middle.
    fn places_rad(&self) -> ([f64; 2], Vec<f64>) {
        let stations = &self.model.grid.roll_angles_rad;
        let (hats, n) = (self.hats(), stations.len());
        let c = hats.centroids();
        let middle = |i: usize| 0.5 * (c[i] + c[i + 1]);
        let inside = [
            c[0],
            middle(0),
            c[n / 2],
            middle(n / 2),
            middle(n - 2),
            c[n - 1],
        ];
        ([stations[0], stations[n - 1]], inside.to_vec())
    }

    fn lines(&self, rolls_rad: Vec<f64>) -> ProjectedLines<'_> {
        let flank = self.flank(0);
        let of_lines = rolls_rad
            .iter()
            .map(|&roll| flank.slices(&self.model.grid, roll).unwrap());
        let loads: Vec<GridLoad> = of_lines.flatten().collect();
        let rows: Vec<&SparseVector> = loads.iter().map(|load| &load.normal).collect();
        let hub = self.body.readings(&rows, &rows, &Silent);
        let (model, mesh) = (&self.body.model, &self.body.mesh);
        let submodel = ToothSubmodel::new(model, mesh, SIDE, &loads, Deformation::Spatial).unwrap();
        ProjectedLines {
            both: self,
            rolls_rad,
            tooth_only: submodel.products(&rows),
            hub,
            loads,
        }
    }

    /// By the flank grid between tooth 0 and another.
    fn by_grid(&self, local: LocalContact, rolls_rad: &[f64], tooth: usize) -> Vec<f64> {
        let compliance = SliceCompliance::new(&self.model, SIDE, local).unwrap();
        let n = compliance.slices();
        let count = rolls_rad.len() * n;
        let on = |tooth: usize| {
            rolls_rad
                .iter()
                .map(|&roll| compliance.on_tooth(tooth, roll))
                .collect::<Vec<_>>()
        };
        let (loaded, read) = (on(0), on(tooth));
        let between = |a: usize, b: usize| {
            let slices = [a % n, b % n];
            compliance
                .between(&loaded[a / n], &read[b / n])
                .value(slices)
        };
        (0..count * count)
            .map(|k| between(k / count, k % count))
            .collect()
    }

    /// What a gauge reads of a newton on each slice of tooth 0 by the flank grid, along the normal and towards the tip.
    fn gauge_by_grid(&self, number: usize, rolls_rad: &[f64]) -> Vec<[f64; 2]> {
        let (gauge, grid) = (&self.model.gauges[number], &self.model.grid);
        let (hats, spread) = (self.hats(), AxialSpread::own(&self.model));
        let slices = rolls_rad
            .iter()
            .flat_map(|&roll| (0..grid.slices).map(move |slice| (roll, slice)));
        let read = slices.map(|(roll, slice)| {
            let mut sum = [0.0; 2];
            for (station, a) in hats.place(roll).shares() {
                for &(axial, b) in spread.shares(slice) {
                    let at = 3 * grid.load(station, axial);
                    sum[0] += a * b * gauge.adjoint[at];
                    sum[1] += a * b * gauge.adjoint[at + 1];
                }
            }
            sum
        });
        read.collect()
    }

    /// The same of any loads by projection: one solution for the gauge.
    fn gauge_of(&self, number: usize, loads: &[GridLoad]) -> Vec<[f64; 2]> {
        let gauge = &self.gear.gauges[number];
        let row = gauge_row(
            &self.gear,
            &self.body.mesh,
            &self.body.model,
            gauge,
            gauge.tooth,
        )
        .unwrap();
        let both = loads
            .iter()
            .flat_map(|load| [&load.normal, &load.tangential]);
        let vectors: Vec<&SparseVector> = both.collect();
        let read = self.body.readings(&[&row], &vectors, &Silent).remove(0);
        read[..vectors.len()]
            .chunks_exact(2)
            .map(|two| [two[0], two[1]])
            .collect()
    }
}

impl ProjectedLines<'_> {
    /// Without the near field: the tooth-only submodel's deflection is taken off on the loaded tooth, of hats and of
    /// lines.
    fn without_near_field(&self, tooth: usize) -> Compared {
        let count = self.loads.len();
        let entry = |load: usize, response: usize| {
            let whole = self.hub[load][tooth * count + response];
            whole
                - if tooth == 0 {
                    self.tooth_only[response * count + load]
                } else {
                    0.0
                }
        };
        Compared {
            slices: self.both.model.grid.slices,
            grid: self
                .both
                .by_grid(LocalContact::WeberBanaschek, &self.rolls_rad, tooth),
            projected: (0..count * count)
                .map(|k| entry(k / count, k % count))
                .collect(),
        }
    }

    /// On the loaded tooth with the near field of a Hertz pressure of half width a₀ in place of that of hats and of
    /// lines.
    fn calibrated(&self) -> Compared {
        let both = self.both;
        let field = both.model.near_field.as_ref().unwrap();
        let curve = field.contact_curve(both.model.signed_base_radius_m());
        let (body, grid) = (&both.body, &both.model.grid);
        let plane = PlaneTooth::new(&both.gear, &body.mesh, &body.model, grid).unwrap();
        let lines = line_near_field(&both.gear, &plane, SIDE, &self.rolls_rad).unwrap();
        let (hats, stations) = (both.hats(), grid.roll_angles_rad.len());
        let (count, n, width) = (self.loads.len(), grid.slices, both.model.slice_width_m());
        let mut compared = Compared {
            slices: n,
            grid: both.by_grid(LocalContact::Calibrated, &self.rolls_rad, 0),
            projected: (0..count * count)
                .map(|k| self.hub[k / count][k % count])
                .collect(),
        };
        for k in 0..count {
            let roll = self.rolls_rad[k / n];
            let place = hats.place(roll);
            let of_hats: f64 = (place.shares())
                .flat_map(|(i, a)| place.shares().map(move |(j, b)| (i * stations + j, a * b)))
                .map(|(at, share)| share * field.mesh_m2_per_n[at])
                .sum();
            let contact = curve.at(roll).0;
            compared.grid[k * count + k] += (contact - of_hats) / width;
            compared.projected[k * count + k] += (contact - lines[k / n]) / width;
        }
        compared
    }
}

impl Compared {
    /// At the roll angle of a number.
    fn differences(&self, roll: usize) -> Differences {
        let n = self.slices;
        let all = self.grid.len().isqrt();
        let at = |c: &[f64], i: usize, j: usize| c[(roll * n + i) * all + roll * n + j];
        let sum = |c: &[f64], j: usize| (0..n).map(|i| at(c, i, j)).sum::<f64>();
        let mean = |c: &[f64]| (0..n).map(|j| sum(c, j)).sum::<f64>();
        let (grid, projected) = (&self.grid, &self.projected);
        let mut found = Differences {
            mean: mean(grid) / mean(projected) - 1.0,
            ..Differences::default()
        };
        for j in 0..n {
            found.slice = larger(found.slice, sum(grid, j) / sum(projected, j) - 1.0);
            for i in 0..n {
                let off = (at(grid, i, j) - at(projected, i, j)) / at(projected, i, i);
                let of = if i == j {
                    &mut found.own
                } else {
                    &mut found.others
                };
                *of = larger(*of, off);
            }
        }
        found
    }
}

/// The one that is larger by its amount.
fn larger(a: f64, b: f64) -> f64 {
    if b.abs() > a.abs() { b } else { a }
}
