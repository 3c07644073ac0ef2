//! A family of flanks that is no involute: two crowned cylinders on crossed axes, one on each gear.

use gearmesh_contact::{RelativeCurvature, SliceLayout, SurfaceCurvature};
use gearmesh_drivetrain::flank_contacts::{FlankContacts, Section, TeethLine, ToothContact};
use gearmesh_drivetrain::pose::{Pose, Vector6};
use gearmesh_drivetrain::slice_plane::Matrix6;
use gearmesh_drivetrain::{DrivetrainError, FlankKinematics, Tangent};
use gearmesh_geometry::Flank;
use nalgebra::{Matrix2, Vector2, Vector3};

use crate::mesh_common::moved;

/// A cylinder of this radius whose axis is bent to a circle: all points at one distance from C(s) = o + ρ (x cos s + y
/// sin s).
#[derive(Clone, Copy)]
pub struct CrownedCylinder {
    pub centre_m: Vector3<f64>,
    pub outwards: Vector3<f64>,
    pub along: Vector3<f64>,
    pub axis_radius_m: f64,
    pub radius_m: f64,
}

impl CrownedCylinder {
    /// C, C′ and C″ at s.
    fn axis(&self, s: f64) -> [Vector3<f64>; 3] {
        let (sin, cos) = s.sin_cos();
        let radial = self.axis_radius_m * (cos * self.outwards + sin * self.along);
        let tangent = self.axis_radius_m * (cos * self.along - sin * self.outwards);
        [self.centre_m + radial, tangent, -radial]
    }

    /// Curvature at the crown, first along the axis.
    fn curvature(&self) -> SurfaceCurvature {
        let along = 1.0 / (self.axis_radius_m + self.radius_m);
        SurfaceCurvature {
            principal_per_m: [along, 1.0 / self.radius_m],
            first: self.along,
        }
    }
}

/// Where the two axes are nearest to each other at a pose.
#[derive(Clone, Copy)]
struct Nearest {
    /// s on both.
    at: [f64; 2],
    /// From gear 1's cylinder to gear 2's.
    normal: Vector3<f64>,
    gap_m: f64,
    gradient: Vector6,
    /// Along the contact line's normal in the tangent plane, at the contact: unit friction on gear 2.
    sliding: Vector6,
}

pub struct CrownedCylinders {
    pub cylinders: [CrownedCylinder; 2],
    pub layout: SliceLayout,
    /// Least and largest relative curvature \[1/m\], those where the crowns touch.
    pub curvatures: [f64; 2],
    at: Option<(Pose, Nearest)>,
}

impl CrownedCylinders {
    /// Two cylinders that face each other with their crowns.
    pub fn new(cylinders: [CrownedCylinder; 2], layout: SliceLayout) -> Self {
        let surfaces = cylinders.map(|cylinder| cylinder.curvature());
        Self {
            cylinders,
            layout,
            curvatures: RelativeCurvature::new(cylinders[0].outwards, surfaces).principal_per_m,
            at: None,
        }
    }

    fn nearest(&self, pose: &Pose) -> Nearest {
        let [first, second] = &self.cylinders;
        let (u, q) = (pose.displacement_m, pose.rotation);
        let mut at = Vector2::zeros();
        for _ in 0..12 {
            let [c1, t1, b1] = first.axis(at[0]);
            let [c2, t2, b2] = second.axis(at[1]).map(|v| q * v);
            let apart = c1 - c2 - u;
            let slope = Vector2::new(apart.dot(&t1), -apart.dot(&t2));
            let mixed = -t1.dot(&t2);
            let own = [t1.dot(&t1) + apart.dot(&b1), t2.dot(&t2) - apart.dot(&b2)];
            let hessian = Matrix2::new(own[0], mixed, mixed, own[1]);
            at -= hessian.try_inverse().unwrap() * slope;
        }
        let [c1, t1, _] = first.axis(at[0]);
        let from_2 = q * second.axis(at[1])[0];
        let apart = u + from_2 - c1;
        let normal = apart.normalize();
        let stack = |f: Vector3<f64>, arm: Vector3<f64>| {
            let m = arm.cross(&f);
            Vector6::new(f[0], f[1], f[2], m[0], m[1], m[2])
        };
        let across = normal.cross(&t1).normalize();
        let contact = c1 + first.radius_m * normal - u;
        Nearest {
            at: [at[0], at[1]],
            normal,
            gap_m: apart.norm() - first.radius_m - second.radius_m,
            gradient: stack(normal, from_2),
            sliding: stack(across, contact),
        }
    }

    fn last(&self) -> &(Pose, Nearest) {
        self.at.as_ref().unwrap()
    }

    /// How something changes with the increments of the last pose.
    fn change<const N: usize>(
        &self,
        of: impl Fn(&Nearest) -> nalgebra::SVector<f64, N>,
    ) -> [nalgebra::SVector<f64, N>; 6] {
        std::array::from_fn(|direction| {
            let h = 1e-6;
            let mut step = Vector6::zeros();
            step[direction] = h;
            let at = |step: &Vector6| of(&self.nearest(&moved(&self.last().0, step)));
            (at(&step) - at(&-step)) / (2.0 * h)
        })
    }
}

impl FlankKinematics for CrownedCylinders {
    fn layout(&self) -> &SliceLayout {
        &self.layout
    }

    fn capacity(&self) -> usize {
        self.layout.slices
    }

    fn pitch_m(&self) -> f64 {
        self.cylinders[0].radius_m
    }

    fn locate(&mut self, pose: &Pose) -> Result<(), DrivetrainError> {
        self.at = Some((*pose, self.nearest(pose)));
        Ok(())
    }

    fn contacts(&mut self, pose: &Pose, _side: Flank, found: &mut FlankContacts) {
        found.clear();
        let (_, nearest) = self.last();
        let slices = self.layout.slices;
        let places = self.change(|nearest| Vector2::from(nearest.at));
        let gradient_of = |gear: usize| Vector6::from_fn(|i, _| places[i][gear]);
        // The hats of the made-up bodies are those of roll angles about 1.
        let u = nearest.at.map(|s| 1.0 + s);
        found.lines.push(TeethLine {
            teeth: [0, 0],
            section: 0,
            ideal_gap_m: nearest.gap_m,
            contacts: (0, slices),
        });
        found.sections.push(Section {
            roll_rad: u,
            touching_roll_rad: u,
            roll_gradient: [gradient_of(0), gradient_of(1)],
            share: 1.0,
            share_gradient: Vector6::zeros(),
            stiffness: 1.0,
            length_m: self.layout.width_m(),
            radius_m: 1.0 / self.curvatures[1],
            radius_growth: [0.0; 2],
            length_growth: [0.0; 2],
            along_gradient: [Vector6::zeros(); 2],
            contacts: (0, slices),
        });
        for slice in 0..slices {
            let along_m = self.layout.reference.slice_centre_m(slice, slices);
            found.contacts.push(ToothContact {
                line: 0,
                slice,
                section: 0,
                heights_m: [along_m; 2],
                gap_m: nearest.gap_m + 0.5 * self.curvatures[0] * along_m * along_m,
                gap_rate_m_per_s: nearest.gradient.dot(&pose.rates()),
                gradient: nearest.gradient,
            });
        }
    }

    fn contacts_at(
        &self,
        pose: &Pose,
        side: Flank,
        found: &mut FlankContacts,
    ) -> Result<(), DrivetrainError> {
        let mut here = Self { at: None, ..*self };
        here.locate(pose)?;
        here.contacts(pose, side, found);
        Ok(())
    }

    fn gap_curvature(&self, _: &FlankContacts, _contact: usize, _side: Flank) -> Matrix6 {
        Matrix6::from_columns(&self.change(|nearest| nearest.gradient))
    }

    fn sliding(
        &self,
        _: &FlankContacts,
        _contact: usize,
        _side: Flank,
        derivatives: bool,
    ) -> [Option<Tangent>; 2] {
        let change = || Matrix6::from_columns(&self.change(|nearest| nearest.sliding));
        let tangent = Tangent {
            direction: self.last().1.sliding,
            change: derivatives.then(change),
        };
        [Some(tangent), None]
    }

    fn nearest_gap_m(&self, _side: Flank) -> Option<f64> {
        Some(self.last().1.gap_m)
    }

    fn is_apart(&self) -> bool {
        self.last().1.normal.norm() == 0.0
    }
}
