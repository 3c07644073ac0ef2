//! Settings of the machine that cuts one flank. Frame of the machine: docs/theory/bevel_gears.md, "Frames".

use crate::hand::Hand;

/// Settings for one flank of one member: a face mill without tilt on a cradle, the work turning with it or held
/// (formate).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineSettings {
    /// Tool.
    pub tool: Tool,
    /// Machine root angle γ_m between the work's axis and the machine plane \[rad\].
    pub root_angle_rad: f64,
    /// Sliding base X_B: the work is moved by it along the cradle axis, away from the cradle \[m\].
    pub sliding_base_m: f64,
    /// Offset E_m: the work is moved by it along +y of the machine \[m\].
    pub offset_m: f64,
    /// Machine centre to back X_D: the work is moved by it along its own axis towards its heel \[m\].
    pub work_offset_m: f64,
    /// How the work turns with the cradle; none for a formate member.
    pub roll: Option<Roll>,
}

/// What cuts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tool {
    /// Straight blades on a circle.
    FaceMill(FaceMill),
    /// A flat tool through the machine centre: straight bevel gears.
    Plane {
        /// Blade angle α_b \[rad\].
        blade_angle_rad: f64,
        /// How far below the machine plane, seen from the machine centre, the tool ends \[rad\].
        end_angle_rad: f64,
        /// Hand by which the sides of the tooth have their names.
        hand: Hand,
    },
}

/// A face mill's edge and its place on the cradle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceMill {
    /// Radius of the blade's point, where its straight side would meet the machine plane \[m\].
    pub point_radius_m: f64,
    /// Blade angle α_b ≥ 0 of the side that cuts \[rad\].
    pub blade_angle_rad: f64,
    /// Radius of the blade's edge, which cuts the fillet \[m\].
    pub edge_radius_m: f64,
    /// Radial distance S of the cutter's centre from the cradle's axis \[m\].
    pub radial_m: f64,
    /// Cradle angle q of the cutter's centre at cradle turn 0, from +x of the machine; positive for a right hand
    /// \[rad\].
    pub cradle_angle_rad: f64,
}

/// Turn of the work ψ = m (φ − c₂φ² − c₃φ³ − c₄φ⁴) over that of the cradle φ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roll {
    /// Ratio of roll m, work over cradle.
    pub ratio: f64,
    /// Modified roll c₂, c₃, c₄.
    pub modified: [f64; 3],
}

impl Roll {
    /// Constant ratio.
    pub fn constant(ratio: f64) -> Self {
        Self {
            ratio,
            modified: [0.0; 3],
        }
    }

    /// ψ, ψ′, ψ″, ψ‴ at φ.
    pub fn at(&self, phi: f64) -> [f64; 4] {
        let [c2, c3, c4] = self.modified;
        [
            self.ratio * (phi - phi * phi * (c2 + phi * (c3 + phi * c4))),
            self.ratio * (1.0 - phi * (2.0 * c2 + phi * (3.0 * c3 + phi * 4.0 * c4))),
            -self.ratio * (2.0 * c2 + phi * (6.0 * c3 + phi * 12.0 * c4)),
            -self.ratio * (6.0 * c3 + phi * 24.0 * c4),
        ]
    }
}

impl MachineSettings {
    /// The face mill, where the tool is one.
    pub fn face_mill(&self) -> Option<&FaceMill> {
        match &self.tool {
            Tool::FaceMill(mill) => Some(mill),
            Tool::Plane { .. } => None,
        }
    }

    /// Blade angle \[rad\].
    pub fn blade_angle_rad(&self) -> f64 {
        match self.tool {
            Tool::FaceMill(mill) => mill.blade_angle_rad,
            Tool::Plane {
                blade_angle_rad, ..
            } => blade_angle_rad,
        }
    }

    /// Those of the mirror image: the other hand.
    pub fn mirrored(&self) -> Self {
        let mut other = *self;
        other.offset_m = -self.offset_m;
        match &mut other.tool {
            Tool::FaceMill(mill) => mill.cradle_angle_rad = -mill.cradle_angle_rad,
            Tool::Plane { hand, .. } => *hand = hand.mate(),
        }
        // ψ(φ) of the mirror image is −ψ(−φ): even terms change their sign.
        if let Some(roll) = &mut other.roll {
            roll.modified[0] = -roll.modified[0];
            roll.modified[2] = -roll.modified[2];
        }
        other
    }
}
