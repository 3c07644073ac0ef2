//! A row of rollers between two races.

use nalgebra::Vector3;

use crate::axial_plane::AxialPlane;
use crate::bent_race::BentRace;
use crate::element_load::ElementLoad;
use crate::element_place::ElementPlace;
use crate::error::BearingError;
use crate::line_contact::LineContact;
use crate::operation::Operation;
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;
use crate::roller_forces::Roller;

/// Outer races that bend, the number of the row and that of its first roller; none where they are round.
pub(crate) type BentRow<'a> = Option<(&'a mut BentRace, (usize, usize))>;

/// A lamina.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamina {
    /// Place along the roller's axis from its middle, positive towards the large end \[m\].
    pub place_m: f64,
    /// Length \[m\].
    pub length_m: f64,
    /// Distance of the roller's surface from its axis along the race's normal, the profile taken off \[m\].
    pub reach_m: f64,
}

/// A conical race: points p = (r, z) with n·p = h, n = (cos α, sin α) its normal away from the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Race {
    /// n, in the ring's axial plane.
    pub normal: (f64, f64),
    /// h \[m\].
    pub offset_m: f64,
    /// Contact with a roller.
    pub contact: LineContact,
}

/// The rib on the inner ring that a tapered roller's large end leans on: plane against sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rib {
    /// Centre of the sphere on the roller's axis, from the roller's middle \[m\].
    pub centre_m: f64,
    /// From the sphere's centre to the rib, in the ring's axial plane.
    pub normal: (f64, f64),
    /// n·p at which the sphere's centre just lets the end touch \[m\].
    pub offset_m: f64,
    /// k in Q = k δ^1.5 \[N/m^1.5\].
    pub stiffness_n_per_m15: f64,
}

/// A row of rollers.
#[derive(Debug, Clone, PartialEq)]
pub struct RollerRow {
    /// Number of rollers.
    pub rollers: usize,
    /// Angle of the first roller \[rad\].
    pub first_angle_rad: f64,
    /// d_m/2 \[m\].
    pub pitch_radius_m: f64,
    /// Mean diameter \[m\].
    pub diameter_m: f64,
    /// Place of the rollers' middles without load \[m\].
    pub middle_z_m: f64,
    /// Direction of the roller's axis towards its large end, (r, z).
    pub axis: (f64, f64),
    /// Laminae.
    pub laminae: Vec<Lamina>,
    /// Race of the inner ring, in its frame.
    pub inner: Race,
    /// Race of the outer ring.
    pub outer: Race,
    /// Rib; none for cylindrical rollers, which do not move along z.
    pub rib: Option<Rib>,
    /// Mass of a roller \[kg\].
    pub mass_kg: f64,
    /// Moments of inertia about its axis and across it \[kg·m²\].
    pub inertia_kg_m2: (f64, f64),
    /// Rollers that are not there, in rising order.
    pub missing: Vec<usize>,
}

impl RollerRow {
    /// Angle of a roller \[rad\].
    #[must_use]
    pub fn angle_rad(&self, roller: usize, operation: &Operation) -> f64 {
        operation.element_angle_rad(self.first_angle_rad, roller, self.rollers)
    }

    /// Speed of the cage and of a roller about its axis \[rad/s\], by pure rolling at the rollers' middle.
    fn speeds(&self, operation: &Operation) -> (f64, f64) {
        // Both contacts lie at the distance D/2 from the roller's axis, across it.
        let across = 0.5 * self.diameter_m * self.axis.1.abs();
        let (inner, outer) = (self.pitch_radius_m - across, self.pitch_radius_m + across);
        let (w_i, w_o) = (operation.inner_rad_per_s, operation.outer_rad_per_s);
        let orbit = (w_i * inner + w_o * outer) / (2.0 * self.pitch_radius_m);
        (orbit, (w_i - orbit) * inner / (0.5 * self.diameter_m))
    }

    /// Adds what the row does to the ring, and hands every roller's load to `each`. The search of each roller begins
    /// at its place, which it leaves where it ends.
    ///
    /// # Errors
    /// [`BearingError::NoRollerEquilibrium`].
    pub(crate) fn add(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut [ElementPlace],
        (ring, mut bent): (&mut RingLoad, BentRow<'_>),
        mut each: impl FnMut(ElementLoad),
        mut each_lamina: impl FnMut(f64, f64),
    ) -> Result<(), BearingError> {
        let (orbit, spin) = self.speeds(operation);
        for (number, start) in places.iter_mut().enumerate() {
            let angle = self.angle_rad(number, operation);
            if self.missing.contains(&number) {
                self.laminae.iter().for_each(|_| each_lamina(0.0, 0.0));
                each(ElementLoad::absent(angle));
                continue;
            }
            let (sine, cosine) = angle.sin_cos();
            let roller = Roller {
                row: self,
                pose,
                plane: AxialPlane {
                    e_r: Vector3::new(cosine, sine, 0.0),
                },
                number,
                orbit,
                spin,
                race_moved_m: &[],
            };
            let mut load = match &mut bent {
                None => roller.add(start, (ring, None), &mut each_lamina)?,
                Some((race, (row, first))) => {
                    let (race_moved_m, part) = race.of_roller(*row, *first + number);
                    let roller = Roller {
                        race_moved_m,
                        ..roller
                    };
                    roller.add(start, (ring, Some(part)), &mut each_lamina)?
                }
            };
            load.angle_rad = angle;
            each(load);
        }
        Ok(())
    }
}
