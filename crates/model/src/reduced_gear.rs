//! A gear body condensed to unit loads on its flanks: what the online side knows of the finite element model.

use std::borrow::Cow;

use gearmesh_geometry::Flank;

use crate::bevel_body::BevelBody;
use crate::bore_patterns::BorePatterns;
use crate::hub_patterns::HubPatterns;
use crate::modal_basis::ModalBasis;
use crate::near_field::NearField;
use crate::reduced_gear_error::ReducedGearError;
use crate::rigid_body::{ReferencePoint, RigidBody};
use crate::root_crack::RootCrack;
use crate::shaft_faces::ShaftFaces;
use crate::stored_gear::StoredGear;

/// The points of a flank at which unit loads act. Loads are numbered roll-major: load = roll station · `z_m.len()` +
/// axial station. Between the points a load is spread by hat functions in roll angle and z.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FlankGrid {
    /// Roll angles ξ = tan α of the stations, increasing from root to tip; radius r = r_b √(1 + ξ²). Of a bevel flank
    /// the share of the way up it, 0 to 1 ([`BevelBody`]).
    pub roll_angles_rad: Vec<f64>,
    /// Axial positions of the stations, increasing; zero at mid-face. Of a bevel flank places along the pitch cone.
    pub z_m: Vec<f64>,
    /// Slices across the face width that the grid was made for.
    pub slices: usize,
}

impl FlankGrid {
    /// Number of unit loads on one flank.
    pub fn len(&self) -> usize {
        self.roll_angles_rad.len() * self.z_m.len()
    }

    /// Whether the grid has no points; never true for a valid reduced gear.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of the unit load at a roll station and an axial station.
    pub fn load(&self, roll_station: usize, axial_station: usize) -> usize {
        roll_station * self.z_m.len() + axial_station
    }
}

/// What a strain gauge reads per unit load.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GaugeRows {
    /// Name by which results list it.
    pub name: String,
    /// Tooth it sits on.
    pub tooth: usize,
    /// Side of that tooth.
    pub side: Flank,
    /// Position and size in words.
    pub description: String,
    /// Estimated relative discretisation error of its strain under the loads that strain it most, zero where it was not
    /// estimated.
    pub error_estimate_relative: f64,
    /// Strain per newton (1/N), `[tooth][flank][load][component]`; components: inward normal, profile tangential
    /// towards the tip, axial +z. (K⁻¹g)ᵀN, method 2 of
    /// *Transmission Error and Strain Analysis of Lightweight Gears* (seed 004 in docs/sources.md).
    pub adjoint: Vec<f64>,
    /// Strain per newton (1/N), `[flank][load]`: gᵀW for normal loads on the gauge's own tooth. Method 1 is the normal
    /// component of `adjoint` less this on the own tooth.
    pub own_tooth: Vec<f64>,
}

impl GaugeRows {
    /// The estimated relative error of its strain; none where it was not estimated.
    pub fn error_estimate(&self) -> Option<f64> {
        (self.error_estimate_relative > 0.0).then_some(self.error_estimate_relative)
    }
}

/// Where a reduced gear comes from.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Provenance {
    /// Program that reduced the gear.
    pub program: String,
    /// Its version.
    pub version: String,
    /// When, UTC, ISO 8601; see [`crate::utc_now`].
    pub created_utc: String,
    /// Threads used; sums in parallel loops may differ in their last bits between thread counts.
    pub threads: usize,
    /// Finite element, for example `"hex8-incompatible"`.
    pub element: String,
    /// Nodes of the finite element model.
    pub nodes: usize,
    /// Elements of the model.
    pub elements: usize,
    /// Free degrees of freedom of the model.
    pub dofs: usize,
    /// Wall-clock time of each stage in seconds, in the order they ran.
    pub stage_seconds: Vec<(String, f64)>,
    /// What was done, as counts by name, for example `factorisations` and `right-hand sides`. Empty in files of
    /// programs that did not count.
    pub effort: Vec<(String, f64)>,
}

/// Errors of identities that hold exactly in exact arithmetic, relative, as measured during the reduction.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReductionChecks {
    /// ‖C_hub − C_hubᵀ‖ / ‖C_hub‖ (Betti's reciprocity).
    pub symmetry: f64,
    /// ‖ΨᵀKΨ − C_g‖ / ‖C_g‖.
    pub pattern_identity: f64,
    /// Further checks by name, for example the residual of the solution; and what is known of the mesh's error.
    pub further: Vec<(String, f64)>,
}

impl ReductionChecks {
    /// Name among the further checks of the mesh's estimated relative error in the deflection of the loaded tooth
    /// without its near field, C_g, under a load over the whole width in the middle of the flank.
    pub const LOADED_TOOTH_ERROR: &str = "mesh error of the deflection, loaded tooth";
    /// The same of other teeth, C_hub: the largest at the next two on either side and the opposite one.
    pub const OTHER_TEETH_ERROR: &str = "mesh error of the deflection, other teeth";

    /// The same of a tooth while it and the next one carry the same load, as in contact.
    pub const BOTH_TEETH_ERROR: &str = "mesh error of the deflection, next tooth loaded, too";

    /// A further check by its name.
    pub fn further(&self, name: &str) -> Option<f64> {
        let found = self.further.iter().find(|(known, _)| known == name);
        found.map(|(_, value)| *value)
    }
}

/// A reduced gear body: linear compliance of all flanks, gauges, and where they come from.
///
/// With f = `flanks.len()` hands that carry loads, L = `grid.len()` loads a flank, z = `teeth` and N = `sectors`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReducedGear {
    /// Name of the gear.
    pub name: String,
    /// The gear file it was made from, and what that file says.
    pub input: StoredGear,
    /// Number of teeth z.
    pub teeth: usize,
    /// The body repeats N times around; a divisor of z.
    pub sectors: usize,
    /// Base circle radius r_b; of a bevel gear the lever of its first flank's normal at the mean point.
    pub base_radius_m: f64,
    /// Face width; of a bevel gear along the pitch cone.
    pub face_width_m: f64,
    /// Young's modulus.
    pub young_pa: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Load points, the same on every flank.
    pub grid: FlankGrid,
    /// Hands of flank that carry loads; the index into this list is the flank index of all arrays.
    pub flanks: Vec<Flank>,
    /// C_hub in m/N,
    /// `[load tooth in sector z/N][load flank f][response tooth z][response flank f][load L][response L]`: deflection
    /// along the inward normal at the response point for a unit force along the inward normal at the load point, hub
    /// held, no crack. Teeth of other sectors follow by rotation: use [`ReducedGear::c_hub_block`]. Empty where
    /// `hub_patterns` has it.
    pub c_hub: Vec<f64>,
    /// C_hub by patterns, of a large body that does not repeat.
    pub hub_patterns: Option<HubPatterns>,
    /// C_tooth in m/N, `[flank f][load L][response L]`: the same on the tooth-only submodel, equal for all teeth.
    pub c_tooth: Vec<f64>,
    /// `[flank f][roll station]`: distance along the normal to the opposite side of the tooth in metres, the h of the
    /// Weber-Banaschek local term.
    pub opposite_distance_m: Vec<f64>,
    /// Calibration of the near field; none in files older than version 2.
    pub near_field: Option<NearField>,
    /// Strain gauges.
    pub gauges: Vec<GaugeRows>,
    /// Mass and inertia; none where no density was given.
    pub rigid_body: Option<RigidBody>,
    /// The flanks under rigid motions; none where the bore is fixed.
    pub reference_point: Option<ReferencePoint>,
    /// Natural modes; none where none were asked for.
    pub modes: Option<ModalBasis>,
    /// The two end faces of a gear cut into a shaft that goes on at both, which are held in all other figures; none of
    /// other gears.
    pub shaft_faces: Option<ShaftFaces>,
    /// Motions of the bore, which is held in all other figures; none where they were not asked for.
    pub bore: Option<BorePatterns>,
    /// Crack in a tooth's root, whose compliance is not in `c_hub`; the gauges' rows have it. None where there is none.
    pub crack: Option<RootCrack>,
    /// What a bevel gear has besides; none of a cylindrical gear. Its `near_field` stands there, not in `near_field`.
    pub bevel: Option<BevelBody>,
    /// Where it comes from.
    pub provenance: Provenance,
    /// How well the reduction fulfilled its identities.
    pub checks: ReductionChecks,
}

impl ReducedGear {
    /// Width of a slice of the grid \[m\].
    pub fn slice_width_m(&self) -> f64 {
        self.face_width_m / self.grid.slices as f64
    }

    /// Teeth in one sector.
    pub fn teeth_per_sector(&self) -> usize {
        self.teeth / self.sectors
    }

    /// Index of a hand in `flanks` and in all arrays.
    ///
    /// # Errors
    /// [`ReducedGearError::FlankNotReduced`] if that hand carries no loads.
    pub fn flank_index(&self, flank: Flank) -> Result<usize, ReducedGearError> {
        self.flanks
            .iter()
            .position(|&reduced| reduced == flank)
            .ok_or_else(|| ReducedGearError::FlankNotReduced {
                gear: self.name.clone(),
                missing: flank,
            })
    }

    /// C_hub between two flanks in m/N, `[load L][response L]`. Any two teeth; a load on tooth s·z/N + r acts as one
    /// on tooth r with all teeth renumbered by s sectors. Allocates only where it is kept by patterns, 4·10⁶
    /// operations a block.
    ///
    /// # Panics
    /// If a tooth does not exist or a hand carries no loads (ask [`ReducedGear::flank_index`] once beforehand).
    pub fn c_hub_block(
        &self,
        load_tooth: usize,
        load_flank: Flank,
        response_tooth: usize,
        response_flank: Flank,
    ) -> Cow<'_, [f64]> {
        let (load_flank, response_flank) =
            (self.carrying(load_flank), self.carrying(response_flank));
        let teeth = self.teeth;
        assert!(
            load_tooth < teeth && response_tooth < teeth,
            "teeth {load_tooth}, {response_tooth} of {teeth}"
        );
        if let Some(patterns) = &self.hub_patterns {
            let loads = self.grid.len();
            let first = [load_flank, response_flank].map(|flank| flank * loads);
            return Cow::Owned(patterns.block([load_tooth, response_tooth], first, [loads; 2]));
        }
        let tooth_in_sector = load_tooth % self.teeth_per_sector();
        let response = (response_tooth + teeth - (load_tooth - tooth_in_sector)) % teeth;
        let flanks = self.flanks.len();
        let block =
            ((tooth_in_sector * flanks + load_flank) * teeth + response) * flanks + response_flank;
        let size = self.grid.len() * self.grid.len();
        Cow::Borrowed(&self.c_hub[block * size..(block + 1) * size])
    }

    /// C_hub in full, as `c_hub` where it is not kept by patterns.
    pub fn c_hub_in_full(&self) -> Cow<'_, [f64]> {
        if self.hub_patterns.is_none() {
            return Cow::Borrowed(&self.c_hub);
        }
        let mut full = Vec::new();
        for load in 0..self.teeth_per_sector() {
            for &load_flank in &self.flanks {
                for response in 0..self.teeth {
                    for &response_flank in &self.flanks {
                        let block = self.c_hub_block(load, load_flank, response, response_flank);
                        full.extend_from_slice(&block);
                    }
                }
            }
        }
        Cow::Owned(full)
    }

    /// C_hub of one hand of flank by patterns, less C_tooth of the loads' own tooth where that is wanted; none where
    /// it is kept in full.
    ///
    /// # Panics
    /// If the hand carries no loads.
    pub fn flank_patterns(&self, flank: Flank, less_tooth: bool) -> Option<HubPatterns> {
        let patterns = self.hub_patterns.as_ref()?;
        let (loads, from) = (self.grid.len(), self.carrying(flank) * self.grid.len());
        let of_flank: Vec<Vec<(usize, f64)>> =
            (0..loads).map(|load| vec![(from + load, 1.0)]).collect();
        let mut of_flank = patterns.combined(&of_flank);
        if less_tooth {
            let tooth = self.c_tooth_block(flank).iter();
            for (own, tooth) in of_flank.own_tooth.iter_mut().zip(tooth) {
                *own -= tooth;
            }
        }
        Some(of_flank)
    }

    /// C_tooth of a hand of flank in m/N, `[load L][response L]`.
    ///
    /// # Panics
    /// If the hand carries no loads.
    pub fn c_tooth_block(&self, flank: Flank) -> &[f64] {
        let flank = self.carrying(flank);
        let size = self.grid.len() * self.grid.len();
        &self.c_tooth[flank * size..(flank + 1) * size]
    }

    /// C_g between two flanks in m/N, `[load L][response L]`: C_hub − C_tooth on the own tooth and own flank, C_hub
    /// elsewhere. Allocates only where it subtracts.
    ///
    /// # Panics
    /// As [`ReducedGear::c_hub_block`].
    pub fn c_g_block(
        &self,
        load_tooth: usize,
        load_flank: Flank,
        response_tooth: usize,
        response_flank: Flank,
    ) -> Cow<'_, [f64]> {
        let hub = self.c_hub_block(load_tooth, load_flank, response_tooth, response_flank);
        if load_tooth != response_tooth || load_flank != response_flank {
            return hub;
        }
        let tooth = self.c_tooth_block(load_flank);
        Cow::Owned(
            hub.iter()
                .zip(tooth)
                .map(|(hub, tooth)| hub - tooth)
                .collect(),
        )
    }

    /// Distance along the normal to the opposite side of the tooth, one value a roll station, in metres.
    ///
    /// # Panics
    /// If the hand carries no loads.
    pub fn opposite_distances_m(&self, flank: Flank) -> &[f64] {
        let flank = self.carrying(flank);
        let stations = self.grid.roll_angles_rad.len();
        &self.opposite_distance_m[flank * stations..(flank + 1) * stations]
    }

    /// Whether it is a ring with internal teeth.
    #[must_use]
    pub fn is_ring(&self) -> bool {
        (self.input.definition()).is_some_and(|gear| gear.profile.internal)
    }

    /// Base radius with the sign of ISO 21771 \[m\]: negative of a ring.
    #[must_use]
    pub fn signed_base_radius_m(&self) -> f64 {
        match self.is_ring() {
            true => -self.base_radius_m,
            false => self.base_radius_m,
        }
    }

    pub(crate) fn carrying(&self, flank: Flank) -> usize {
        let index = self.flanks.iter().position(|&reduced| reduced == flank);
        assert!(
            index.is_some(),
            "gear \"{}\" was not reduced for loads on its {flank} flanks",
            self.name
        );
        index.unwrap_or_default()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::made_up_models::small_reduced_gear;

    /// Entry of the full matrix by its definition in [`small_reduced_gear`], without the storage scheme.
    fn entry(
        gear: &ReducedGear,
        load: (usize, Flank),
        response: (usize, Flank),
        l: usize,
        m: usize,
    ) -> f64 {
        gear.c_hub_block(load.0, load.1, response.0, response.1)[l * gear.grid.len() + m]
    }

    #[test]
    fn blocks_rotate_by_whole_sectors() {
        let gear = small_reduced_gear();
        let step = gear.teeth_per_sector();
        let (right, left) = (Flank::Right, Flank::Left);
        for load in 0..gear.teeth {
            for response in 0..gear.teeth {
                let turned = ((load + step) % gear.teeth, (response + step) % gear.teeth);
                assert_eq!(
                    gear.c_hub_block(load, right, response, left),
                    gear.c_hub_block(turned.0, right, turned.1, left)
                );
            }
        }
        // Not by single teeth: the two teeth of a sector differ.
        assert_ne!(
            gear.c_hub_block(0, right, 0, right),
            gear.c_hub_block(1, right, 1, right)
        );
    }

    #[test]
    fn full_matrix_is_symmetric() {
        let gear = small_reduced_gear();
        for (a, fa, b, fb) in [
            (0, Flank::Right, 3, Flank::Left),
            (5, Flank::Left, 2, Flank::Left),
            (1, Flank::Right, 4, Flank::Right),
        ] {
            for (l, m) in [(0, 0), (0, 5), (3, 1)] {
                let there = entry(&gear, (a, fa), (b, fb), l, m);
                let back = entry(&gear, (b, fb), (a, fa), m, l);
                assert!(
                    (there - back).abs() <= 1e-15 * there.abs(),
                    "{there} {back}"
                );
            }
        }
    }

    #[test]
    fn c_g_subtracts_the_tooth_on_own_tooth_and_flank_only() {
        let gear = small_reduced_gear();
        let own = gear.c_g_block(4, Flank::Left, 4, Flank::Left);
        let hub = gear.c_hub_block(4, Flank::Left, 4, Flank::Left);
        let tooth = gear.c_tooth_block(Flank::Left);
        assert!((0..own.len()).all(|i| own[i] == hub[i] - tooth[i]) && tooth[0] > 0.0);
        assert!(matches!(
            gear.c_g_block(4, Flank::Left, 4, Flank::Right),
            Cow::Borrowed(_)
        ));
        assert!(matches!(
            gear.c_g_block(4, Flank::Left, 3, Flank::Left),
            Cow::Borrowed(_)
        ));
    }

    #[test]
    fn a_hand_without_loads_is_an_error() {
        let mut gear = small_reduced_gear();
        gear.flanks = vec![Flank::Right];
        let message = gear.flank_index(Flank::Left).unwrap_err().to_string();
        assert!(message.contains("left flanks"), "{message}");
    }
}
