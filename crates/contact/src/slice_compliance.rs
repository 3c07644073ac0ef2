//! Compliance between slices on contact lines, from the compliance between unit loads on the flank grid.
//!
//! A slice force at roll angle ξ is a combination Φ of grid loads. Along the axis a slice covers three axial stations
//! with the shares ¼, ½, ¼: equal slice forces then make an exactly uniform line load. Along the profile the two
//! nearest stations share the force so that its first moment is kept; the outermost hats are halves, their centroid
//! lies a third of a spacing inside, and the shares are taken with respect to centroids. C = Φᵀ C_grid Φ as a whole.
//! The axial part of Φ does not depend on the position and is applied once, when the model is loaded.

use crate::local_contact::{LocalContact, effective_depth_m};
use gearmesh_model::{Flank, NearField, ReducedGear, ReducedGearError};

/// Slice compliance of one gear for loads on one hand of flank.
#[derive(Debug, Clone)]
pub struct SliceCompliance {
    teeth: usize,
    teeth_per_sector: usize,
    slices: usize,
    stations: usize,
    /// Roll angles of the hats' centroids.
    centroids_rad: Vec<f64>,
    opposite_distance_m: Vec<f64>,
    /// `[tooth in sector][response tooth][(station, slice) of load][(station, slice) of response]`.
    blocks: Vec<f64>,
    /// Of the flank in contact; only where the local contact is calibrated.
    near_field: Option<NearField>,
    base_radius_m: f64,
    young_pa: f64,
    poisson: f64,
    slice_width_m: f64,
    z_m: Vec<f64>,
}

/// A place between two roll stations: the lower one and the share of the upper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollPlace {
    /// Lower station.
    pub station: usize,
    /// Share of the station above it; may lie a little outside 0 to 1 beyond the outermost centroids.
    pub share: f64,
}

/// A slice on a tooth and the place of its contact along the profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedSlice {
    /// Tooth.
    pub tooth: usize,
    /// Slice.
    pub slice: usize,
    /// Place between the roll stations.
    pub place: RollPlace,
}

/// Which part of the compliance is taken from the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CompliancePart {
    /// C_g = C_hub − C_tooth: free of the mesh's near field, to be completed by a local term.
    Patterns,
    /// C_hub with the near field of the hats.
    Hub,
}

/// Shares of a slice's force on its three axial stations.
pub const AXIAL_SHARES: [f64; 3] = [0.25, 0.5, 0.25];

impl SliceCompliance {
    /// Condenses a reduced gear to its slices.
    ///
    /// # Errors
    /// [`ReducedGearError::FlankNotReduced`] when the model carries no loads on `flank`,
    /// [`ReducedGearError::NotCalibrated`] when `local` is calibrated and the model is not.
    pub fn new(
        gear: &ReducedGear,
        flank: Flank,
        local: LocalContact,
    ) -> Result<Self, ReducedGearError> {
        let flank_index = gear.flank_index(flank)?;
        let near_field = match local {
            LocalContact::Calibrated => Some(near_field_of(gear, flank_index)?),
            LocalContact::None | LocalContact::WeberBanaschek => None,
        };
        let grid = &gear.grid;
        let (stations, slices, loads) = (grid.roll_angles_rad.len(), grid.slices, grid.len());
        let size = stations * slices;
        let own = gear.teeth_per_sector();
        let mut blocks = Vec::with_capacity(own * gear.teeth * size * size);
        for tooth in 0..own {
            for other in 0..gear.teeth {
                let block = match local.part() {
                    CompliancePart::Patterns => gear.c_g_block(tooth, flank, other, flank),
                    CompliancePart::Hub => gear.c_hub_block(tooth, flank, other, flank).into(),
                };
                for a in 0..size {
                    for b in 0..size {
                        let mut sum = 0.0;
                        for (i, p) in AXIAL_SHARES.iter().enumerate() {
                            let l = grid.load(a / slices, 2 * (a % slices) + i);
                            for (j, q) in AXIAL_SHARES.iter().enumerate() {
                                let m = grid.load(b / slices, 2 * (b % slices) + j);
                                sum += p * q * block[l * loads + m];
                            }
                        }
                        blocks.push(sum);
                    }
                }
            }
        }
        Ok(Self {
            teeth: gear.teeth,
            teeth_per_sector: own,
            slices,
            stations,
            centroids_rad: centroids(&grid.roll_angles_rad),
            opposite_distance_m: gear.opposite_distances_m(flank).to_vec(),
            blocks,
            near_field,
            base_radius_m: gear.base_radius_m,
            young_pa: gear.young_pa,
            poisson: gear.poisson,
            slice_width_m: gear.face_width_m / slices as f64,
            z_m: (0..slices).map(|k| grid.z_m[2 * k + 1]).collect(),
        })
    }

    /// Number of slices.
    pub fn slices(&self) -> usize {
        self.slices
    }

    /// Number of teeth.
    pub fn teeth(&self) -> usize {
        self.teeth
    }

    /// Width of a slice \[m\].
    pub fn slice_width_m(&self) -> f64 {
        self.slice_width_m
    }

    /// Axial centres of the slices \[m\].
    pub fn slice_centres_m(&self) -> &[f64] {
        &self.z_m
    }

    /// Young's modulus \[Pa\] and Poisson's ratio.
    pub fn material(&self) -> (f64, f64) {
        (self.young_pa, self.poisson)
    }

    /// Where a roll angle lies between the stations.
    pub fn place(&self, roll_rad: f64) -> RollPlace {
        roll_place(&self.centroids_rad, roll_rad)
    }

    /// Depth h \[m\] of the local logarithm at a roll angle: effective where the model is calibrated, else the distance
    /// to the opposite side.
    pub fn local_depth_m(&self, roll_rad: f64) -> f64 {
        let place = self.place(roll_rad);
        let Some(field) = &self.near_field else {
            return self.opposite_distance_m(place);
        };
        let n = self.stations;
        let shares = [
            (place.station, 1.0 - place.share),
            (place.station + 1, place.share),
        ];
        let mut mesh = 0.0;
        for (a, wa) in shares {
            for (b, wb) in shares {
                mesh += wa * wb * field.mesh_m2_per_n[a * n + b];
            }
        }
        effective_depth_m(
            field.contact_at(roll_rad, self.base_radius_m) - mesh,
            field.half_width_m,
            self.material(),
        )
    }

    /// Distance along the normal to the opposite side of the tooth at a roll place \[m\].
    pub fn opposite_distance_m(&self, place: RollPlace) -> f64 {
        let share = place.share.clamp(0.0, 1.0);
        (1.0 - share) * self.opposite_distance_m[place.station]
            + share * self.opposite_distance_m[place.station + 1]
    }

    /// Adds Φᵀ C Φ between the slices of two contact lines to `c`, a block of a matrix with `stride` columns that
    /// begins at `first`, times `factor`.
    pub fn add_block(
        &self,
        (tooth_a, place_a): (usize, RollPlace),
        (tooth_b, place_b): (usize, RollPlace),
        factor: f64,
        c: &mut [f64],
        first: usize,
        stride: usize,
    ) {
        let size = self.stations * self.slices;
        let tooth = tooth_a % self.teeth_per_sector;
        let response = (tooth_b + self.teeth - (tooth_a - tooth)) % self.teeth;
        let block = tooth * self.teeth + response;
        let table = &self.blocks[block * size * size..(block + 1) * size * size];
        let n = self.slices;
        for (sa, wa) in [
            (place_a.station, 1.0 - place_a.share),
            (place_a.station + 1, place_a.share),
        ] {
            for (sb, wb) in [
                (place_b.station, 1.0 - place_b.share),
                (place_b.station + 1, place_b.share),
            ] {
                let weight = factor * wa * wb;
                for i in 0..n {
                    let row = &table[(sa * n + i) * size + sb * n..][..n];
                    for (entry, value) in c[first + i * stride..][..n].iter_mut().zip(row) {
                        *entry += weight * value;
                    }
                }
            }
        }
    }

    /// Φ_aᵀ C Φ_b between two slices that each stand at their own place, as on slanted contact lines.
    pub fn between_slices(&self, a: PlacedSlice, b: PlacedSlice) -> f64 {
        let size = self.stations * self.slices;
        let tooth = a.tooth % self.teeth_per_sector;
        let response = (b.tooth + self.teeth - (a.tooth - tooth)) % self.teeth;
        let block = tooth * self.teeth + response;
        let table = &self.blocks[block * size * size..(block + 1) * size * size];
        let row = |station: usize| &table[(station * self.slices + a.slice) * size..][..size];
        let column = b.place.station * self.slices + b.slice;
        let response_of = |row: &[f64]| {
            (1.0 - b.place.share) * row[column] + b.place.share * row[column + self.slices]
        };
        (1.0 - a.place.share) * response_of(row(a.place.station))
            + a.place.share * response_of(row(a.place.station + 1))
    }
}

/// The calibration with W of one flank only.
fn near_field_of(gear: &ReducedGear, flank_index: usize) -> Result<NearField, ReducedGearError> {
    let mut field = gear.calibration()?.clone();
    let stations = gear.grid.roll_angles_rad.len();
    let size = stations * stations;
    field.mesh_m2_per_n = field.mesh_m2_per_n[flank_index * size..][..size].to_vec();
    Ok(field)
}

/// Centroids of the hats in roll angle.
pub fn centroids(stations: &[f64]) -> Vec<f64> {
    let last = stations.len() - 1;
    let mut centroids = stations.to_vec();
    centroids[0] += (stations[1] - stations[0]) / 3.0;
    centroids[last] -= (stations[last] - stations[last - 1]) / 3.0;
    centroids
}

/// Where a roll angle lies between hats' centroids.
pub fn roll_place(centroids_rad: &[f64], roll_rad: f64) -> RollPlace {
    let above = centroids_rad
        .partition_point(|xi| *xi <= roll_rad)
        .clamp(1, centroids_rad.len() - 1);
    let (low, high) = (centroids_rad[above - 1], centroids_rad[above]);
    RollPlace {
        station: above - 1,
        share: (roll_rad - low) / (high - low),
    }
}
