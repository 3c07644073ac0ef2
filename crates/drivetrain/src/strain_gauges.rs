//! Root strain while a run goes on: gauges of a gear read the slice forces of its mesh, and its modes.
//!
//! ```text
//! ε = gᵀΦ (η − Ω⁻² Σ s T) + Σ (row − gᵀΦ Ω⁻² φ) F + Σ row_t T          rows of method 1 or 2; without modes the rows alone
//! ```
//!
//! T is friction towards the tip; method 1 has no row_t. One multiplication a gauge, slice and share: no field, no
//! allocation. Forces that reach the gear through another mesh or a joint are not in it: strain is linear, so that the
//! readings of all meshes of a gear add up, gᵀΦη counted once ([`ModalPart`]). So is γ̂q, what rollers that bend the
//! gear's bore by q strain it ([`StrainGauges::feel_bore`]). What the modes read of the mesh's forces at rest is taken
//! out, for the rows hold it already.

use gearmesh_geometry::Flank;
use gearmesh_model::{GaugeRows, RadialMotions, ReducedGear};
use gearmesh_recovery::{GaugeArray, LoadedSlice, Strain};

use crate::error::DrivetrainError;
use crate::flank_modes::dot;
use crate::gear_mesh::GearMesh;

/// Whether a mesh's gauges read the vibration of their gear and the bending of its bore, too.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ModalPart {
    /// gᵀΦ η and γ̂ q are read: the gear's only mesh, or the first of them. The default.
    #[default]
    Included,
    /// They are read with another mesh of the same gear.
    ElsewhereIncluded,
}

/// Gauges of one gear of a mesh.
#[derive(Debug, Clone)]
pub struct StrainGauges {
    /// 0 or 1.
    gear: usize,
    names: Vec<String>,
    sides: Vec<(Flank, GaugeArray)>,
    /// gᵀΦ, `[gauge][mode]`; empty without modes.
    modal: Vec<f64>,
    modal_part: ModalPart,
    /// γ̂, `[gauge][motion]`; empty where no rollers bend the bore.
    bore: Vec<f64>,
    /// q of the bore \[m\].
    motions_m: Vec<f64>,
    /// ω² of each mode \[rad²/s²\].
    omega_squared: Vec<f64>,
    /// What is read by gᵀΦ: η less what friction makes of it at rest.
    coordinates: Vec<f64>,
    strain: Vec<Strain>,
}

impl StrainGauges {
    /// Gauges of gear 1 or 2 of a mesh, by their names in the gear's model. Set the mesh's modes before.
    ///
    /// # Errors
    /// [`DrivetrainError::Gauge`] for an unknown name, [`DrivetrainError::Model`] if the model has no loads on a side
    /// of the mesh.
    ///
    /// # Panics
    /// If `gear` is neither 1 nor 2.
    pub fn new(
        mesh: &GearMesh,
        gear: usize,
        model: &ReducedGear,
        names: &[&str],
        modal_part: ModalPart,
    ) -> Result<Self, DrivetrainError> {
        assert!(gear == 1 || gear == 2, "gear {gear} of 1 and 2");
        let modes = mesh.modal_loads().counts()[gear - 1];
        let (mut rows, mut modal) = (Vec::new(), Vec::new());
        let mut omega_squared = Vec::new();
        if modes > 0 {
            omega_squared.extend(&model.modal_basis()?.omega_squared[..modes]);
        }
        for name in names {
            let Some(number) = model.gauges.iter().position(|gauge| gauge.name == *name) else {
                let known: Vec<&str> = model.gauges.iter().map(|g| g.name.as_str()).collect();
                return Err(DrivetrainError::Gauge {
                    gear: model.name.clone(),
                    name: (*name).to_owned(),
                    known: if known.is_empty() {
                        "none".to_owned()
                    } else {
                        known.join(", ")
                    },
                });
            };
            rows.push(residual_rows(model, number, modes)?);
            if modes > 0 {
                let basis = model.modal_basis()?;
                let gauges = model.gauges.len();
                modal.extend((0..modes).map(|mode| basis.gauges[mode * gauges + number]));
            }
        }
        let layout = mesh.kinematics().layout();
        let spread = match &model.bevel {
            Some(_) => gearmesh_contact::bevel_slices::spread_from_heel(
                model,
                layout.face_widths_m[0],
                layout.slices,
            ),
            None => layout.spread(gear, model),
        };
        let mut sides = Vec::new();
        for side in mesh.flanks() {
            let flank = mesh.kinematics().side_of(gear - 1, side);
            let array = GaugeArray::new(model, &rows, flank, &spread)?;
            sides.push((side, array));
        }
        Ok(Self {
            gear: gear - 1,
            names: names.iter().map(|name| (*name).to_owned()).collect(),
            sides,
            modal,
            modal_part,
            bore: Vec::new(),
            motions_m: Vec::new(),
            omega_squared,
            coordinates: vec![0.0; modes],
            strain: vec![Strain::default(); names.len()],
        })
    }

    /// Gear 1 or 2.
    #[must_use]
    pub fn gear(&self) -> usize {
        self.gear + 1
    }

    /// Names of the gauges.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Lets the gauges read what motions of the bore strain, where this mesh is the one that reads it.
    ///
    /// # Panics
    /// If the motions are not those of the gauges' model.
    pub fn on_bore(&mut self, model: &ReducedGear, motions: &RadialMotions) {
        if self.modal_part == ModalPart::ElsewhereIncluded {
            return;
        }
        let count = motions.count();
        self.motions_m = vec![0.0; count];
        self.bore.clear();
        for name in &self.names {
            let number = model.gauges.iter().position(|gauge| gauge.name == *name);
            let first = number.map_or(motions.gauges.len(), |number| number * count);
            self.bore.extend(&motions.gauges[first..][..count]);
        }
    }

    /// Takes the motions of the bore \[m\].
    pub fn feel_bore(&mut self, motions_m: &[f64]) {
        if !self.motions_m.is_empty() {
            self.motions_m.copy_from_slice(motions_m);
        }
    }

    /// Strain at the last pose of the mesh, one entry a gauge; `coordinates`: η of the gear's body, empty without
    /// modes.
    pub fn read(&mut self, mesh: &GearMesh, coordinates: &[f64]) -> &[Strain] {
        self.strain.fill(Strain::default());
        for (side, gauges) in &self.sides {
            let Some((found, forces)) = mesh.side(*side) else {
                continue;
            };
            let friction = mesh.friction(*side);
            for section in &found.sections {
                let (first, count) = section.contacts;
                if forces[first..first + count].iter().all(|f| *f <= 0.0) {
                    continue;
                }
                let roll_rad = section.touching_roll_rad[self.gear];
                let place = gauges.place(roll_rad);
                for number in first..first + count {
                    let contact = &found.contacts[number];
                    let loaded = LoadedSlice {
                        tooth: found.lines[contact.line].teeth[self.gear],
                        slice: contact.slice,
                        roll_rad,
                        components: [1.0, friction[number].towards_tips[self.gear]],
                        force_n: forces[number],
                    };
                    if loaded.force_n > 0.0 {
                        gauges.add(&loaded, &place, &mut self.strain);
                    }
                }
            }
        }
        let motions = self.motions_m.len().max(1);
        for (strain, row) in self.strain.iter_mut().zip(self.bore.chunks_exact(motions)) {
            let bending = dot(row, &self.motions_m);
            strain.method_1 += bending;
            strain.method_2 += bending;
        }
        let modes = self.omega_squared.len();
        if modes > 0 {
            self.coordinates.fill(0.0);
            if self.modal_part == ModalPart::Included {
                let read = self.coordinates.iter_mut().zip(coordinates);
                read.for_each(|(place, eta)| *place = *eta);
            }
            self.take_friction_at_rest_out(mesh);
            for (strain, row) in self.strain.iter_mut().zip(self.modal.chunks_exact(modes)) {
                let vibration = dot(row, &self.coordinates);
                strain.method_1 += vibration;
                strain.method_2 += vibration;
            }
        }
        &self.strain
    }

    /// η − Ω⁻² Σ s T: the tangential rows are whole, and method 1 reads no friction at rest.
    fn take_friction_at_rest_out(&mut self, mesh: &GearMesh) {
        for (side, _) in &self.sides {
            let Some((found, forces)) = mesh.side(*side) else {
                continue;
            };
            let rows = &found.modal[self.gear];
            for (contact, (force_n, friction)) in
                forces.iter().zip(mesh.friction(*side)).enumerate()
            {
                for (tangent, share) in friction.shares.into_iter().enumerate() {
                    let of_modes = rows
                        .sliding(contact, tangent)
                        .iter()
                        .zip(&self.omega_squared);
                    for (eta, (sliding, omega_squared)) in self.coordinates.iter_mut().zip(of_modes)
                    {
                        *eta -= share * force_n * sliding / omega_squared;
                    }
                }
            }
        }
    }
}

/// A gauge's rows less what the lowest `modes` modes read of normal forces at rest.
fn residual_rows(
    model: &ReducedGear,
    gauge: usize,
    modes: usize,
) -> Result<GaugeRows, DrivetrainError> {
    let mut rows = model.gauges[gauge].clone();
    if modes == 0 {
        return Ok(rows);
    }
    let basis = model.modal_basis()?;
    let shapes = basis.flank.chunks_exact(rows.adjoint.len());
    for (mode, shape) in shapes.take(modes).enumerate() {
        let share = basis.gauges[mode * model.gauges.len() + gauge] / basis.omega_squared[mode];
        for (row, shape) in rows.adjoint.iter_mut().zip(shape).step_by(3) {
            *row -= share * shape;
        }
    }
    Ok(rows)
}
