//! A gear mesh: kinematics, a model for each side of the teeth, friction; force and tangents on the six relative
//! increments.
//!
//! ```text
//! load = Σ_i (F_i g_i + T_i k_i) + Σ_sections [Σ_gears (∂E*/∂ξ) ∂ξ + (∂E*/∂s) ∂s]     g = ∂gap, k: friction direction
//! ∂load = Σ_i (g_i − μ_i k_i) ∂F_iᵀ + Σ_i F_i ∂g_i + friction,   ∂F_i = −Σ_j (K_ij ∂gap_j + D_ij ∂(gap rate)_j)
//! ```
//!
//! Virtual work makes the load: it is a force on gear 2 and its reaction on gear 1 by construction. Left out of the
//! tangent: how the compliance and the microgeometry's slope change with the pose, of the order of deflection over the
//! pitch, 1e-3 of the stiffness.

use gearmesh_contact::FlankSlices;
use gearmesh_dynamics::{Iterate, Power};
use gearmesh_geometry::Flank;
use gearmesh_model::ReducedGear;

use crate::error::DrivetrainError;
use crate::flank_contacts::FlankContacts;
use crate::flank_kinematics::FlankKinematics;
use crate::flank_modes::{FlankModes, ModalMotion};
use crate::friction::Friction;
use crate::involute_mesh::InvoluteMesh;
use crate::mesh_kinematics::MeshKinematics;
pub use crate::mesh_load::{MeshEffort, MeshLoad};
use crate::modal_loads::ModalLoads;
use crate::models::teeth_model::{TeethLoads, TeethModel};
use crate::pose::{Pose, Vector6};
use crate::side_assembly::{Assembly, FlankFriction, Parts};

mod coupled_side;

struct Side {
    flank: Flank,
    model: Box<dyn TeethModel>,
    found: FlankContacts,
    loads: TeethLoads,
    /// Of each contact, zero where none was computed.
    friction: Vec<FlankFriction>,
    /// Load on gear 2 per unit force of each contact that carries, where tangents are asked for; zero of others.
    directions: Vec<Vector6>,
    /// How the gap rate of each contact changes with the pose, for the tangents of damping.
    rate_by_pose: Vec<Vector6>,
    modes: [Option<FlankModes>; 2],
}

/// A mesh of two gears.
pub struct GearMesh {
    kinematics: Box<dyn FlankKinematics>,
    sides: Vec<Side>,
    friction: Option<Friction>,
    modal: ModalLoads,
    load: MeshLoad,
    /// Whether the tangents of `load` are other than zero.
    has_tangents: bool,
    iterate: Iterate,
    effort: MeshEffort,
}

impl GearMesh {
    /// A mesh of involute gears with contact on the flanks of one side; add the other by [`GearMesh::with_side`].
    ///
    /// # Errors
    /// [`DrivetrainError::UnusedFlankErrors`] if the kinematics have flank errors that the model cannot feel.
    pub fn new(
        kinematics: MeshKinematics,
        flank: Flank,
        model: impl Into<Box<dyn TeethModel>>,
    ) -> Result<Self, DrivetrainError> {
        Self::of_flanks(Box::new(InvoluteMesh::new(kinematics)), flank, model)
    }

    /// A mesh of flanks of any family.
    ///
    /// # Errors
    /// As [`GearMesh::new`], and [`DrivetrainError::NoCommonGap`].
    pub fn of_flanks(
        kinematics: Box<dyn FlankKinematics>,
        flank: Flank,
        model: impl Into<Box<dyn TeethModel>>,
    ) -> Result<Self, DrivetrainError> {
        let mesh = Self {
            kinematics,
            sides: Vec::new(),
            friction: None,
            modal: ModalLoads::default(),
            load: MeshLoad::default(),
            has_tangents: false,
            iterate: Iterate::Single,
            effort: MeshEffort::default(),
        };
        mesh.with_side(flank, model)
    }

    /// Adds contact on the flanks of another side: with both, backlash is what the tooth thickness leaves. A side that
    /// is there already is replaced.
    ///
    /// # Errors
    /// As [`GearMesh::new`], and [`DrivetrainError::SideAfterModes`].
    pub fn with_side(
        mut self,
        flank: Flank,
        model: impl Into<Box<dyn TeethModel>>,
    ) -> Result<Self, DrivetrainError> {
        if self.modal.count() > 0 {
            return Err(DrivetrainError::SideAfterModes);
        }
        let model = model.into();
        if !model.resolves_teeth() && self.kinematics.has_errors() {
            return Err(DrivetrainError::UnusedFlankErrors);
        }
        if !model.resolves_teeth() {
            self.kinematics.share_one_gap()?;
        }
        let capacity = self.kinematics.capacity();
        self.sides.retain(|side| side.flank != flank);
        self.sides.push(Side {
            flank,
            model,
            found: FlankContacts::with_capacity(capacity),
            loads: TeethLoads::with_capacity(capacity),
            friction: Vec::with_capacity(capacity),
            directions: Vec::with_capacity(capacity),
            rate_by_pose: Vec::with_capacity(capacity),
            modes: [None, None],
        });
        Ok(self)
    }

    /// Lets gear 1 or 2 vibrate in the lowest `count` modes of its model: the mesh then needs their coordinates
    /// ([`GearMesh::evaluate_modal`]) and pushes on them ([`GearMesh::modal_loads`]). Add all sides of the teeth
    /// before.
    ///
    /// # Errors
    /// [`DrivetrainError::ModesWithoutReducedTeeth`] if a side's model is not `hybrid`, or as [`FlankModes::new`].
    ///
    /// # Panics
    /// If `gear` is neither 1 nor 2.
    pub fn with_modes(
        mut self,
        gear: usize,
        model: &ReducedGear,
        count: usize,
    ) -> Result<Self, DrivetrainError> {
        assert!(gear == 1 || gear == 2, "gear {gear} of 1 and 2");
        let capacity = self.kinematics.capacity();
        for side in &mut self.sides {
            if !side.model.takes_modes() {
                return Err(DrivetrainError::ModesWithoutReducedTeeth { gear });
            }
            let flank = self.kinematics.side_of(gear - 1, side.flank);
            let slices = FlankSlices::new(self.kinematics.layout(), gear, model, flank)?;
            let modes = FlankModes::new(model, flank, count, slices)?;
            side.found.modal[gear - 1] = modes.rows_with_capacity(capacity);
            side.modes[gear - 1] = Some(modes);
        }
        let mut counts = self.modal.counts();
        counts[gear - 1] = count;
        self.modal = ModalLoads::new(counts);
        Ok(self)
    }

    /// Adds friction.
    #[must_use]
    pub fn with_friction(mut self, friction: Friction) -> Self {
        self.friction = Some(friction);
        self
    }

    /// Whether its teeth rub.
    #[must_use]
    pub fn rubs(&self) -> bool {
        self.friction.is_some()
    }

    /// Kinematics.
    #[must_use]
    pub fn kinematics(&self) -> &dyn FlankKinematics {
        &*self.kinematics
    }

    /// What was computed so far.
    #[must_use]
    pub fn effort(&self) -> MeshEffort {
        self.effort
    }

    /// Teeth facing each other at the last pose, and their normal forces \[N\]; none if that side is not modelled.
    #[must_use]
    pub fn side(&self, flank: Flank) -> Option<(&FlankContacts, &[f64])> {
        let side = self.sides.iter().find(|side| side.flank == flank)?;
        Some((&side.found, &side.loads.normal_n))
    }

    /// The sides that are modelled.
    pub fn flanks(&self) -> impl Iterator<Item = Flank> {
        self.sides.iter().map(|side| side.flank)
    }

    /// Transmission error along the transverse line of action \[m\] of the last pose: the gap that ideal flanks would
    /// have on the side that touches, or that is nearer where none does. Zero at first touch, negative under load, on
    /// right and left flanks alike; at the nominal centre distance and without axial displacement r_b2 θ₂ − r_b1 θ₁.
    /// None where no teeth face each other.
    #[must_use]
    pub fn transmission_error_m(&self) -> Option<f64> {
        let gaps = self
            .sides
            .iter()
            .filter_map(|side| side.found.ideal_gap_m());
        gaps.min_by(f64::total_cmp)
    }

    /// The transmission error where gears stand beside the axes about which their bodies turn: that of ideal flanks on
    /// these axes, of the side that touches at the last pose, so that runout and wobble are in it as in the turns of
    /// the bodies. `gears` is the last pose, `axes` the pose of the axes at the same moment, `found` memory for the
    /// flanks there.
    ///
    /// # Errors
    /// [`DrivetrainError`] if the axes stand so that the flanks in contact are not known.
    pub fn transmission_error_on_axes_m(
        &mut self,
        gears: &Pose,
        axes: &Pose,
        found: &mut FlankContacts,
    ) -> Result<Option<f64>, DrivetrainError> {
        let gap_m = |side: &Side| {
            let touching = side.found.ideal_gap_m();
            touching.or_else(|| self.kinematics.nearest_gap_m(side.flank))
        };
        let told = (self.sides.iter()).filter_map(|side| Some((side.flank, gap_m(side)?)));
        let Some((side, _)) = told.min_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Ok(None);
        };
        self.kinematics.contacts_at(axes, side, found)?;
        if let Some(line) = found.lines.first() {
            return Ok(Some(line.ideal_gap_m));
        }
        self.kinematics.locate(axes)?;
        let nearest = self.kinematics.nearest_gap_m(side);
        self.kinematics.locate(gears)?;
        Ok(nearest)
    }

    /// Friction of each contact of a side at the last pose; zero without.
    #[must_use]
    pub fn friction(&self, flank: Flank) -> &[FlankFriction] {
        let side = self.sides.iter().find(|side| side.flank == flank);
        side.map_or(&[], |side| &side.friction)
    }

    /// Forces on the modes at the last pose.
    #[must_use]
    pub fn modal_loads(&self) -> &ModalLoads {
        &self.modal
    }

    /// Says how the poses of the next evaluations stand to each other.
    pub fn expect(&mut self, iterate: Iterate) {
        self.iterate = iterate;
        for side in &mut self.sides {
            side.model.expect(iterate);
        }
    }

    /// Takes the forces of the last pose as the start of the next solutions; see [`TeethModel::remember`].
    pub fn remember(&mut self) {
        for side in &mut self.sides {
            side.model.remember();
        }
    }

    /// Appends what is remembered.
    pub fn save(&self, out: &mut Vec<f64>) {
        for side in &self.sides {
            side.model.save(out);
        }
    }

    /// Takes what [`GearMesh::save`] wrote.
    pub fn restore(&mut self, numbers: &[f64]) {
        let mut rest = numbers;
        for side in &mut self.sides {
            let mut own = Vec::new();
            side.model.save(&mut own);
            let (own, after) = rest.split_at(own.len());
            side.model.restore(own);
            rest = after;
        }
    }

    /// Load at a pose, with tangents where `tangents`; gears with modes at their undeformed shape.
    ///
    /// # Errors
    /// [`DrivetrainError`] of the kinematics or the model.
    pub fn evaluate(&mut self, pose: &Pose, tangents: bool) -> Result<MeshLoad, DrivetrainError> {
        self.evaluate_modal(pose, &ModalMotion::default(), tangents)
    }

    /// Load at the last pose.
    #[must_use]
    pub fn load(&self) -> &MeshLoad {
        &self.load
    }

    /// Load at a pose and a vibration of the gears.
    ///
    /// # Errors
    /// [`DrivetrainError`] of the kinematics or the model.
    pub fn evaluate_modal(
        &mut self,
        pose: &Pose,
        modal: &ModalMotion<'_>,
        tangents: bool,
    ) -> Result<MeshLoad, DrivetrainError> {
        self.update(pose, modal, tangents)?;
        Ok(self.load)
    }

    /// The same, into [`GearMesh::load`].
    ///
    /// # Errors
    /// [`DrivetrainError`] of the kinematics or the model.
    pub fn update(
        &mut self,
        pose: &Pose,
        modal: &ModalMotion<'_>,
        tangents: bool,
    ) -> Result<(), DrivetrainError> {
        self.find(pose, modal, tangents)?;
        self.settle(pose, modal, tangents)
    }

    /// First half of [`Self::update`]: the flanks that face each other.
    ///
    /// # Errors
    /// [`DrivetrainError`] of the kinematics.
    pub(crate) fn find(
        &mut self,
        pose: &Pose,
        modal: &ModalMotion<'_>,
        tangents: bool,
    ) -> Result<(), DrivetrainError> {
        if tangents || self.has_tangents {
            self.load = MeshLoad::default();
        }
        self.has_tangents = tangents;
        let result = &mut self.load;
        result.load = Vector6::zeros();
        result.power = Power::default();
        result.friction_w = 0.0;
        self.effort.poses += 1;
        self.modal.begin(tangents);
        self.kinematics.locate(pose)?;
        for number in 0..self.sides.len() {
            self.find_side(number, pose, modal, 0.0);
        }
        Ok(())
    }

    /// The flanks of a side that face each other; none where all stand open by more than `reach_m`, nor where they
    /// cannot touch by themselves and no reach is given.
    fn find_side(&mut self, number: usize, pose: &Pose, modal: &ModalMotion<'_>, reach_m: f64) {
        let side = &mut self.sides[number];
        let rigid = side.modes.iter().all(Option::is_none);
        let open_gap_m = rigid.then(|| self.kinematics.open_gap_m(side.flank));
        let out_of_reach =
            |gap_m: &f64| reach_m == 0.0 || *gap_m > reach_m + self.kinematics.most_added_m();
        if let Some(gap_m) = open_gap_m.flatten().filter(out_of_reach) {
            side.found.clear();
            side.found.open_gap_m = Some(gap_m);
            return;
        }
        let bent_m = |(gear, modes): (usize, &Option<FlankModes>)| {
            let of_gear = modes.as_ref();
            of_gear.map_or(0.0, |modes| modes.most_bent_m(modal.coordinates[gear]))
        };
        side.found.bent_m = side.modes.iter().enumerate().map(bent_m).sum();
        match self.iterate {
            Iterate::Correction => {
                (self.kinematics).contacts_nearby(pose, side.flank, &mut side.found);
            }
            _ => (self.kinematics).contacts(pose, side.flank, &mut side.found),
        }
        for (gear, modes) in side.modes.iter().enumerate() {
            let Some(modes) = modes else { continue };
            modes.bend(gear, modal, &pose.rates(), &mut side.found);
            if self.friction.is_some() {
                let tangents = |contact: usize| {
                    let own = self.kinematics.tangents_on_flanks(contact, side.flank);
                    own.map(|own| own[gear])
                };
                modes.lay_sliding(
                    (gear, self.kinematics.hand(side.flank)),
                    tangents,
                    &mut side.found,
                );
            }
        }
    }

    /// Second half of [`Self::update`]: forces of the flanks that were found.
    ///
    /// # Errors
    /// [`DrivetrainError`] of the model.
    pub(crate) fn settle(
        &mut self,
        pose: &Pose,
        modal: &ModalMotion<'_>,
        tangents: bool,
    ) -> Result<(), DrivetrainError> {
        let rates = pose.rates();
        let result = &mut self.load;
        for side in &mut self.sides {
            let (contacts, sections) = (side.found.contacts.len(), side.found.sections.len());
            side.loads.single = side.model.acts_singly();
            side.loads.begin(contacts, sections);
            side.friction.clear();
            side.friction.resize(contacts, FlankFriction::default());
            side.directions.clear();
            side.directions.resize(contacts, Vector6::zeros());
            if contacts == 0 {
                continue;
            }
            self.effort.models += 1;
            (side.model).evaluate(&side.found, tangents, &mut side.loads)?;
            result.power.stored_j += side.loads.stored_j;
            result.power.dissipated_w += side.loads.dissipated_w;
            side.rate_by_pose.clear();
            if tangents {
                // Once for each contact: all others may feel its gap rate.
                let (found, damping) = (&side.found, &side.loads.damping_n_s_per_m);
                let rows = if side.loads.single {
                    damping.len()
                } else {
                    contacts
                };
                side.rate_by_pose.extend((0..contacts).map(|contact| {
                    let column = damping[contact..].iter().step_by(rows);
                    let is_felt = column.into_iter().any(|d| *d != 0.0);
                    let curvature = || self.kinematics.gap_curvature(found, contact, side.flank);
                    is_felt
                        .then(curvature)
                        .map_or_else(Vector6::zeros, |c| c.tr_mul(&rates))
                }));
            }
            let assembly = Assembly {
                rates,
                rate_by_pose: &side.rate_by_pose,
                found: &side.found,
                loads: &side.loads,
                flank: side.flank,
                kinematics: &*self.kinematics,
                friction: self.friction,
                modal_rates: modal.rates,
            };
            let parts = Parts {
                result: &mut *result,
                modal: &mut self.modal,
                friction: &mut side.friction,
                directions: &mut side.directions,
                effort: &mut self.effort,
            };
            assembly.add(parts, tangents);
        }
        Ok(())
    }
}
