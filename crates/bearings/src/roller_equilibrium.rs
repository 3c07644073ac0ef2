//! The equilibrium of one roller under the forces of `roller_forces.rs`, and the load and stiffness of the roller and
//! of its row on both rings.

use nalgebra::{Matrix3, Matrix3x6, Matrix6x3, Vector2, Vector3};

use crate::axial_plane::AxialPlane;
use crate::bent_race::{BentAtRoller, BentRow, LaminaOnRace};
use crate::element_load::ElementLoad;
use crate::element_search::{ElementPlace, ElementSearch, NO_FORCE_N};
use crate::error::BearingError;
use crate::line_contact::LineContact;
use crate::operation::Operation;
use crate::ring_load::{RingLoad, by_ring};
use crate::ring_pose::RingPose;
use crate::roller_forces::{Roller, RollerState};
use crate::roller_row::{Lamina, RollerRow};

/// Share of its weight, which is left out, that a roller may have left over where the search does not end, as on one
/// that nothing but a slow turn throws between race and rib.
const LEFT_OVER: f64 = 1e-3;

/// Standard gravity \[m/s²\].
const GRAVITY_M_PER_S2: f64 = 9.80665;

/// Proximal steps of one roller before it is left where Newton's method leaves it.
const MOST_PROXIMAL_STEPS: usize = 30;

impl Roller<'_> {
    /// Equilibrium, then load and tangent.
    pub fn add(
        &self,
        found: &mut ElementPlace,
        (ring, bent): (&mut RingLoad, Option<BentAtRoller<'_>>),
        each_lamina: &mut impl FnMut(f64, f64),
    ) -> Result<ElementLoad, BearingError> {
        let (place, state) = self.equilibrium(found.take())?;
        if state.balance.scale > NO_FORCE_N {
            *found = Some(place);
        }
        self.add_to_rings(&place, &state, ring, bent);
        Ok(self.report(&place, &state, each_lamina))
    }

    /// Where a cylindrical roller lies on the outer race under its centrifugal force, all of its length taken to carry;
    /// where nothing throws it, far inside. Between the races nothing tells a search which way to go.
    fn thrown_out_m(&self) -> f64 {
        let row = self.row;
        let thrown_n = row.mass_kg * row.pitch_radius_m * self.orbit * self.orbit;
        if thrown_n <= NO_FORCE_N {
            return 0.0;
        }
        let reach = |most: f64, lamina: &Lamina| most.max(lamina.reach_m);
        let reach_m = row.laminae.iter().fold(0.0, reach);
        let length_m: f64 = row.laminae.iter().map(|lamina| lamina.length_m).sum();
        let depth_m = (thrown_n / (row.outer.contact.stiffness * length_m)).powf(0.9);
        row.outer.offset_m - reach_m + depth_m
    }

    /// Halfway between the races, or thrown out.
    fn start(&self) -> Vector3<f64> {
        let row = self.row;
        let tilt = 0.5 * self.plane.e_r.dot(&self.pose.axis).asin();
        let middle = (row.pitch_radius_m, row.middle_z_m);
        let turned = self.plane.nearest(self.pose, middle);
        let shift = (turned - Vector2::new(middle.0, middle.1)) * 0.5;
        if row.rib.is_none() {
            let halfway_m = row.pitch_radius_m + shift[0];
            let thrown_m = self.thrown_out_m();
            if halfway_m < thrown_m {
                Vector3::new(thrown_m, row.middle_z_m, 0.0)
            } else {
                Vector3::new(halfway_m, row.middle_z_m, tilt)
            }
        } else {
            // With the ring along its rib, halfway between the races across the roller's axis.
            let (_, across) = self.axes(0.0);
            let place = across * (2.0 * across.dot(&shift)) * 0.5;
            let along = Vector2::new(row.axis.0, row.axis.1);
            let place = place + along * (2.0 * along.dot(&shift));
            Vector3::new(
                row.pitch_radius_m + place[0],
                row.middle_z_m + place[1],
                tilt,
            )
        }
    }

    /// A quarter of a roller's length \[m\], by which moments count as forces.
    fn arm_m(&self) -> f64 {
        0.25 * self.row.laminae.len() as f64 * self.row.laminae[0].length_m
    }

    /// Newton's method. Where it stops with forces left over, as on a tapered roller that is thrown about between race
    /// and rib, proximal steps follow: each ends where the roller would rest if a spring held it to its place before;
    /// springs are softened from step to step.
    fn equilibrium(
        &self,
        start: ElementPlace,
    ) -> Result<(Vector3<f64>, RollerState), BearingError> {
        let begin = start.unwrap_or_else(|| self.start());
        let first = self.newton(begin, None);
        let unbalanced = |state: &RollerState| {
            let size = state.balance.residual.norm();
            size > 1e-6 * state.balance.scale && state.balance.scale > NO_FORCE_N
        };
        match &first {
            Ok((_, state)) if !unbalanced(state) => return first,
            _ => {}
        }
        let mut place = begin;
        let mut spring = self.state(&begin).balance.scale / 1e-6;
        for _ in 0..MOST_PROXIMAL_STEPS {
            let Ok((next, _)) = self.newton(place, Some((place, spring))) else {
                break;
            };
            place = next;
            spring *= 0.5;
            match self.newton(place, None) {
                Ok((place, state)) if !unbalanced(&state) => return Ok((place, state)),
                _ => {}
            }
        }
        first
    }

    /// Newton's method. With a spring to a place (N/m; about the circumferential direction by the square of
    /// [`Self::arm_m`]), if one is given.
    fn newton(
        &self,
        start: Vector3<f64>,
        spring: Option<(Vector3<f64>, f64)>,
    ) -> Result<(Vector3<f64>, RollerState), BearingError> {
        let arms = Vector3::new(1.0, 1.0, self.arm_m());
        let search = ElementSearch {
            arms,
            longest_step_m: 50e-6,
            rounding_m: 4e-16 * self.row.pitch_radius_m,
        };
        let found = search.run(start, |place| {
            let mut state = self.state(place);
            if let Some((at, stiffness)) = spring {
                let springs = arms.component_mul(&arms) * stiffness;
                state.balance.residual -= springs.component_mul(&(place - at));
                state.balance.tangent += Matrix3::from_diagonal(&springs);
            }
            state
        });
        found.or_else(|given_up| {
            if given_up.left_n <= LEFT_OVER * self.row.mass_kg * GRAVITY_M_PER_S2 {
                return Ok((given_up.place, given_up.state));
            }
            Err(self.no_equilibrium(given_up.left_n))
        })
    }

    fn no_equilibrium(&self, unbalanced_n: f64) -> BearingError {
        BearingError::NoRollerEquilibrium {
            roller: self.number + 1,
            angle_deg: self.plane.degrees(),
            unbalanced_n,
        }
    }

    fn add_to_rings(
        &self,
        place: &Vector3<f64>,
        state: &RollerState,
        ring: &mut RingLoad,
        bent: Option<BentAtRoller<'_>>,
    ) {
        if state.balance.scale <= NO_FORCE_N {
            return;
        }
        let mut tangent = state.balance.tangent;
        let stiffest = tangent[(0, 0)];
        for place in 0..3 {
            if tangent[(place, place)] == 0.0 {
                tangent[(place, place)] = stiffest;
            }
        }
        let mut ring_by_place = Matrix6x3::zeros();
        if state.inner_load + state.rib_load > 0.0 {
            ring_by_place = self.add_to_ring(place, &tangent, ring);
        }
        if let Some(mut bent) = bent {
            self.add_to_race(place, state, &mut bent);
            bent.follow(&tangent, &ring_by_place);
        }
    }

    /// Adds the force of the roller on an outer race that bends, and how it changes as the race moves.
    fn add_to_race(&self, place: &Vector3<f64>, state: &RollerState, bent: &mut BentAtRoller<'_>) {
        let row = self.row;
        let (_, across) = self.axes(place[2]);
        let (c, s) = row.outer.normal;
        let mut inner_j = 0.0;
        self.inner_points(place, |_, load, lamina| {
            if let Some(number) = lamina.filter(|_| load > 0.0) {
                let length_m = row.laminae[number].length_m;
                let approach_m = row.inner.contact.approach_m(load / length_m);
                inner_j += length_m * LineContact::energy(load / length_m, approach_m);
            }
        });
        let mut outer_j = 0.0;
        for (number, lamina) in row.laminae.iter().enumerate() {
            let [load_n, slope, energy_j] = self.outer_load(place, (number, lamina));
            if load_n > 0.0 {
                outer_j += energy_j;
                let by_tilt = (across * lamina.place_m).dot(&Vector2::new(c, s));
                bent.add_lamina(&LaminaOnRace {
                    number,
                    load_n,
                    slope,
                    by_place: Vector3::new(c, 0.0, by_tilt),
                });
            }
        }
        let centrifugal_n = row.mass_kg * row.pitch_radius_m * self.orbit * self.orbit;
        let thrown_j = centrifugal_n * (place[0] - row.pitch_radius_m);
        *bent.stored_j += inner_j + outer_j - thrown_j + self.gyroscopic_nm() * place[2];
        assert!(state.rib_load == 0.0);
    }

    /// Returns how force and moment on the ring change with the roller's place.
    fn add_to_ring(
        &self,
        place: &Vector3<f64>,
        tangent: &Matrix3<f64>,
        ring: &mut RingLoad,
    ) -> Matrix6x3<f64> {
        // ∂(force on the roller)/∂ring, and ∂(load on the ring)/∂place.
        let mut roller_by_ring = Matrix3x6::zeros();
        let mut force_by_place = Matrix3::zeros();
        let mut moment_by_place = Matrix3::zeros();
        self.inner_points(place, |point, load, _| {
            if load == 0.0 {
                return;
            }
            ring.add_at_fixed_point(&point.w, &point.force, &point.by_point);
            let (_, force_by_ring) = by_ring(&point.w, &point.force, &point.by_point);
            let plane = self.plane.vectors();
            let tilt = plane * point.by_tilt;
            let moves = Matrix3::from_columns(&[self.plane.e_r, Vector3::z(), tilt]);
            // Force on the roller is minus that on the ring; as a moment by the way its point goes with φ.
            roller_by_ring -= moves.tr_mul(&force_by_ring);
            let by_place = point.by_point * moves;
            force_by_place += by_place;
            moment_by_place +=
                point.w.cross_matrix() * by_place - point.force.cross_matrix() * moves;
        });
        if self.row.rib.is_none() {
            roller_by_ring.set_row(1, &nalgebra::RowVector6::zeros());
        }
        let mut by_place = Matrix6x3::zeros();
        by_place.fixed_rows_mut::<3>(0).copy_from(&force_by_place);
        by_place.fixed_rows_mut::<3>(3).copy_from(&moment_by_place);
        let Some(follows) = tangent.lu().solve(&roller_by_ring) else {
            return by_place;
        };
        let mut block = ring.tangent.fixed_view_mut::<3, 6>(0, 0);
        block += force_by_place * follows;
        let mut block = ring.tangent.fixed_view_mut::<3, 6>(3, 0);
        block += moment_by_place * follows;
        by_place
    }

    fn report(
        &self,
        place: &Vector3<f64>,
        state: &RollerState,
        each_lamina: &mut impl FnMut(f64, f64),
    ) -> ElementLoad {
        let row = self.row;
        let mut largest = [0.0_f64; 2];
        self.inner_points(place, |_, inner, lamina| {
            let Some(number) = lamina else {
                return;
            };
            let lamina = &row.laminae[number];
            let [outer, ..] = self.outer_load(place, (number, lamina));
            each_lamina(inner, outer);
            for (most, load) in largest.iter_mut().zip([inner, outer]) {
                *most = most.max(load / lamina.length_m);
            }
        });
        ElementLoad {
            inner_load_n: state.inner_load,
            outer_load_n: state.outer_load,
            inner_contact_angle_rad: row.inner.normal.1.atan2(row.inner.normal.0),
            outer_contact_angle_rad: row.outer.normal.1.atan2(row.outer.normal.0),
            radial_m: place[0] - row.pitch_radius_m,
            axial_m: place[1] - row.middle_z_m,
            tilt_rad: place[2],
            rib_load_n: state.rib_load,
            inner_line_load_n_per_m: largest[0],
            outer_line_load_n_per_m: largest[1],
            centrifugal_n: row.mass_kg * row.pitch_radius_m * self.orbit * self.orbit,
            gyroscopic_nm: self.gyroscopic_nm(),
            orbit_rad_per_s: self.orbit,
            spin_rad_per_s: self.spin,
            ..ElementLoad::default()
        }
    }
}

impl RollerRow {
    /// Speed of the cage and of a roller about its axis \[rad/s\], by pure rolling at the rollers' middle.
    fn speeds(&self, operation: &Operation) -> (f64, f64) {
        // Both contacts lie at the distance D/2 from the roller's axis, across it.
        let across = 0.5 * self.diameter_m * self.axis.1.abs();
        let (inner, outer) = (self.pitch_radius_m - across, self.pitch_radius_m + across);
        let (w_i, w_o) = (operation.inner_rad_per_s, operation.outer_rad_per_s);
        let orbit = (w_i * inner + w_o * outer) / (2.0 * self.pitch_radius_m);
        (orbit, (w_i - orbit) * inner / (0.5 * self.diameter_m))
    }

    /// Adds the row's load and stiffness to the ring's, and hands the load of every roller to `each`. The search for a
    /// roller begins at its place, and writes there where it ends.
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
