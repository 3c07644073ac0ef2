//! Where both members stand: nominal assembly and its errors.

use nalgebra::{Matrix3, Vector3};

use crate::blank::PairBlank;
use crate::cut_surface::SurfacePoint;

/// Errors of assembly; all zero for the pair as designed. Frame: docs/theory/bevel_gears.md, "Frames".
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AssemblyError {
    /// Offset V: the pinion is moved by it along +y of the fixed frame, that is along k₁ × (the way to the gear) \[m\].
    pub offset_m: f64,
    /// The pinion is moved by it along its axis, away from the apex \[m\].
    pub pinion_axial_m: f64,
    /// The gear is moved by it along its axis, away from the apex \[m\].
    pub gear_axial_m: f64,
    /// The shaft angle is larger by it \[rad\].
    pub shaft_angle_rad: f64,
}

impl AssemblyError {
    /// Both together.
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            offset_m: self.offset_m + other.offset_m,
            pinion_axial_m: self.pinion_axial_m + other.pinion_axial_m,
            gear_axial_m: self.gear_axial_m + other.gear_axial_m,
            shaft_angle_rad: self.shaft_angle_rad + other.shaft_angle_rad,
        }
    }

    /// A share of it.
    pub fn scaled(&self, share: f64) -> Self {
        Self {
            offset_m: share * self.offset_m,
            pinion_axial_m: share * self.pinion_axial_m,
            gear_axial_m: share * self.gear_axial_m,
            shaft_angle_rad: share * self.shaft_angle_rad,
        }
    }
}

/// Frame of a member at turn 0 in the fixed frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Columns: x, y, z of the member.
    pub axes: Matrix3<f64>,
    /// Its apex \[m\].
    pub apex_m: Vector3<f64>,
}

impl Placement {
    /// Axis from apex to heel.
    pub fn axis(&self) -> Vector3<f64> {
        self.axes.column(2).into()
    }

    /// A point of the member, turned by `turn` about its axis, in the fixed frame.
    pub fn placed(&self, p: &SurfacePoint, turn_rad: f64) -> SurfacePoint {
        let (s, c) = turn_rad.sin_cos();
        let turn = Matrix3::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
        let m = self.axes * turn;
        SurfacePoint {
            r: m * p.r + self.apex_m,
            dr: p.dr.map(|v| m * v),
            ddr: p.ddr.map(|v| m * v),
            n: m * p.n,
            dn: p.dn.map(|v| m * v),
            ..*p
        }
    }
}

/// Both members in the fixed frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assembly {
    /// Pinion and gear.
    pub members: [Placement; 2],
    /// z₁/z₂.
    pub ratio: f64,
}

impl Assembly {
    /// The pair with errors.
    pub fn new(blank: &PairBlank, error: &AssemblyError) -> Self {
        let gamma = blank.members[0].pitch_angle_rad;
        let gear_gamma = blank.members[1].pitch_angle_rad;
        let (sin, cos) = (blank.data.shaft_angle_rad + error.shaft_angle_rad).sin_cos();
        let nominal = blank.data.shaft_angle_rad.sin_cos();
        // The gear's frame at turn 0 points to the common generator of the pitch cones, then is tilted with its axis.
        let axis = Vector3::new(nominal.0, 0.0, nominal.1);
        let generator = Vector3::new(gamma.sin(), 0.0, gamma.cos());
        let x = (generator - axis * gear_gamma.cos()) / gear_gamma.sin();
        let y = axis.cross(&x);
        let (ts, tc) = error.shaft_angle_rad.sin_cos();
        let tilt = Matrix3::new(tc, 0.0, ts, 0.0, 1.0, 0.0, -ts, 0.0, tc);
        let pinion = Placement {
            axes: Matrix3::identity(),
            apex_m: Vector3::new(0.0, error.offset_m, error.pinion_axial_m),
        };
        let gear = Placement {
            axes: tilt * Matrix3::from_columns(&[x, y, axis]),
            apex_m: Vector3::new(sin, 0.0, cos) * error.gear_axial_m,
        };
        Self {
            members: [pinion, gear],
            ratio: blank.data.teeth[0] as f64 / blank.data.teeth[1] as f64,
        }
    }
}
