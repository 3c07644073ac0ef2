//! What a bearing is: sizes, materials, arrangement, in SI units.

pub(crate) mod friction_factors;
pub(crate) mod seats;

use crate::faults::Fault;
use friction_factors::Friction;
use seats::Fit;

/// A bearing.
#[derive(Debug, Clone, PartialEq)]
pub struct BearingDefinition {
    /// Name in prints.
    pub name: String,
    /// Balls or rollers, and their races.
    pub geometry: BearingGeometry,
    /// Material of balls or rollers.
    pub element_material: BearingMaterial,
    /// Material of the rings.
    pub ring_material: BearingMaterial,
    /// Rows side by side.
    pub arrangement: Arrangement,
    /// How rows are preloaded.
    pub preload: Preload,
    /// Angle of the first ball or roller \[rad\].
    pub first_angle_rad: f64,
    /// Load ratings that are stated; those that are not are computed.
    pub stated_ratings: StatedRatings,
    /// How its rings are seated and how warm it is; none: the clearance is the stated one.
    pub fit: Option<Fit>,
    /// What makes its friction torque; none: it is not computed.
    pub friction: Option<Friction>,
    /// What is wrong with it; empty for a sound bearing.
    pub faults: Vec<Fault>,
}

/// Linear elastic, isotropic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BearingMaterial {
    /// E \[Pa\].
    pub young_pa: f64,
    /// ν.
    pub poisson: f64,
    /// ρ \[kg/m³\].
    pub density_kg_per_m3: f64,
}

impl BearingMaterial {
    /// Bearing steel: 206 GPa, 0.3, 7850 kg/m³.
    pub const STEEL: Self = Self {
        young_pa: 206e9,
        poisson: 0.3,
        density_kg_per_m3: 7850.0,
    };

    pub(crate) fn elastic(&self) -> (f64, f64) {
        (self.young_pa, self.poisson)
    }
}

/// Balls or rollers.
#[derive(Debug, Clone, PartialEq)]
pub enum BearingGeometry {
    /// Ball bearings.
    Ball(BallGeometry),
    /// Cylindrical, tapered and spherical roller bearings.
    Roller(RollerGeometry),
}

impl BearingGeometry {
    /// Number of balls or rollers in a row.
    #[must_use]
    pub fn elements(&self) -> usize {
        match self {
            Self::Ball(g) => g.balls,
            Self::Roller(g) => g.rollers,
        }
    }
}

impl BearingGeometry {
    /// Whether it is a deep-groove, angular-contact, cylindrical or tapered roller bearing: those that fits, friction
    /// and faults are known of.
    #[must_use]
    pub fn is_classic(&self) -> bool {
        match self {
            Self::Ball(g) => matches!(
                g.kind,
                BallBearingKind::DeepGroove | BallBearingKind::AngularContact
            ),
            Self::Roller(g) => g.barrel.is_none(),
        }
    }
}

/// Which ball bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum BallBearingKind {
    /// Bears axial loads both ways; the grooves face each other.
    DeepGroove,
    /// Bears axial loads one way.
    AngularContact,
    /// Grooves of two arcs each, which a ball touches at four points; carries axial loads both ways.
    FourPoint {
        /// Play of the inner ring across the axis from one side to the other; negative: interference \[m\].
        clearance_m: f64,
    },
    /// Bears axial loads one way, between two washers: contact angle 90°.
    Thrust,
}

/// Balls and grooves.
#[derive(Debug, Clone, PartialEq)]
pub struct BallGeometry {
    /// Deep-groove or angular-contact.
    pub kind: BallBearingKind,
    /// Number of balls in a row.
    pub balls: usize,
    /// D \[m\].
    pub ball_diameter_m: f64,
    /// d_m \[m\].
    pub pitch_diameter_m: f64,
    /// f_i = r_i/D.
    pub inner_conformity: f64,
    /// f_o = r_o/D.
    pub outer_conformity: f64,
    /// α₀: that of a ball which just touches both grooves, the rings moved apart along the axis; of a four-point
    /// bearing that of a ball which just touches all four arcs \[rad\].
    pub free_angle_rad: f64,
    /// By how much the balls of a deep-groove bearing are too large for its rings, across the axis from one side to the
    /// other; 0 where there is play \[m\].
    pub interference_m: f64,
    /// Heights of the shoulders above the bottoms of the inner and outer groove; estimated where none are stated \[m\].
    pub stated_shoulder_heights_m: Option<[f64; 2]>,
}

impl BallGeometry {
    /// A = (f_i + f_o − 1) D, distance of the grooves' centres \[m\].
    #[must_use]
    pub fn groove_distance_m(&self) -> f64 {
        (self.inner_conformity + self.outer_conformity - 1.0) * self.ball_diameter_m
    }

    /// P_d = 2 A (1 − cos α₀), play of the inner ring across the axis from one side to the other; negative:
    /// interference \[m\].
    #[must_use]
    pub fn radial_clearance_m(&self) -> f64 {
        if let BallBearingKind::FourPoint { clearance_m } = self.kind {
            return clearance_m;
        }
        // 1 − cos α = 2 sin²(α/2) keeps the digits of a small clearance.
        4.0 * self.groove_distance_m() * (0.5 * self.free_angle_rad).sin().powi(2)
            - self.interference_m
    }

    /// 1 − P_d/(2A): the cosine of the free contact angle, above 1 with interference; of a four-point bearing cos α −
    /// P_d/(2A). With A it gives how far the circles of the grooves' centres stand from each other across the axis.
    #[must_use]
    pub fn groove_cosine(&self) -> f64 {
        if let BallBearingKind::FourPoint { clearance_m } = self.kind {
            return self.free_angle_rad.cos() - 0.5 * clearance_m / self.groove_distance_m();
        }
        self.free_angle_rad.cos() + 0.5 * self.interference_m / self.groove_distance_m()
    }

    /// Diameters of the grooves' bottoms, inner and outer \[m\].
    #[must_use]
    pub fn raceway_diameters_m(&self) -> (f64, f64) {
        let (d, cosine) = (self.ball_diameter_m, self.groove_cosine());
        let at = |conformity: f64| 2.0 * conformity * d - (2.0 * conformity - 1.0) * d * cosine;
        (
            self.pitch_diameter_m - at(self.inner_conformity),
            self.pitch_diameter_m + at(self.outer_conformity),
        )
    }
}

/// Rollers and races.
#[derive(Debug, Clone, PartialEq)]
pub struct RollerGeometry {
    /// Number of rollers in a row.
    pub rollers: usize,
    /// Diameter in the middle \[m\].
    pub diameter_m: f64,
    /// Length that carries \[m\].
    pub length_m: f64,
    /// Diameter of the circle of the rollers' middles \[m\].
    pub pitch_diameter_m: f64,
    /// Play of the inner ring across the axis from one side to the other, negative: interference; of tapered bearings 0
    /// \[m\].
    pub radial_clearance_m: f64,
    /// Taper and rib; none for other rollers.
    pub taper: Option<Taper>,
    /// Curved profiles of barrels; none for other rollers.
    pub barrel: Option<BarrelShape>,
    /// End profile.
    pub profile: RollerProfile,
    /// Number of laminae.
    pub laminae: usize,
}

/// What makes a spherical roller bearing: barrels in the groove of the inner ring and the sphere of the outer one,
/// whose radius follows from pitch diameter, roller and contact angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BarrelShape {
    /// α \[rad\].
    pub contact_angle_rad: f64,
    /// Radius of the roller's profile \[m\].
    pub profile_radius_m: f64,
    /// Radius of the inner groove's profile \[m\].
    pub groove_radius_m: f64,
}

impl BarrelShape {
    /// d_m/(2 cos α) + D/2: the sphere inside the outer ring, without play \[m\].
    #[must_use]
    pub fn sphere_radius_m(contact_angle_rad: f64, pitch_m: f64, diameter_m: f64) -> f64 {
        0.5 * pitch_m / contact_angle_rad.cos() + 0.5 * diameter_m
    }
}

/// What makes a tapered bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Taper {
    /// Angle of the outer race against the axis \[rad\].
    pub contact_angle_rad: f64,
    /// Radius of the sphere at the large end over its largest value, the distance to the apex.
    pub end_radius_ratio: f64,
    /// Height of the contact with the rib above the inner race's edge \[m\].
    pub rib_height_m: f64,
}

/// Material taken off a roller along its length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RollerProfile {
    /// None.
    Straight,
    /// s ln(1/(1 − (2x/L)²)) with s \[m\].
    Logarithmic {
        /// s \[m\].
        scale_m: f64,
    },
    /// x²/(2R) with the radius R \[m\].
    Crowned {
        /// R \[m\].
        radius_m: f64,
    },
}

impl RollerProfile {
    /// Depth at x from the middle of a roller of the length L \[m\].
    #[must_use]
    pub fn depth_m(&self, x_m: f64, length_m: f64) -> f64 {
        match *self {
            Self::Straight => 0.0,
            Self::Logarithmic { scale_m } => -scale_m * (-(2.0 * x_m / length_m).powi(2)).ln_1p(),
            Self::Crowned { radius_m } => 0.5 * x_m * x_m / radius_m,
        }
    }
}

/// Rows of a bearing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Arrangement {
    /// One row; carries axial loads on the inner ring along +z where it carries them one way only.
    Single,
    /// Two rows, back to back: their load lines meet the axis far apart.
    O {
        /// Distance of the rows \[m\].
        distance_m: f64,
    },
    /// Two rows, face to face: their load lines meet the axis close to each other.
    X {
        /// Distance of the rows \[m\].
        distance_m: f64,
    },
    /// Two rows alike.
    Tandem {
        /// Distance of the rows \[m\].
        distance_m: f64,
    },
}

impl Arrangement {
    /// Whether its rows carry axial loads each one way.
    pub(crate) fn is_opposed(&self) -> bool {
        matches!(self, Self::O { .. } | Self::X { .. })
    }

    /// Place of each row along the axis and the sense of the axial force that its inner ring carries.
    #[must_use]
    pub fn rows(&self) -> Vec<(f64, f64)> {
        match *self {
            Self::Single => vec![(0.0, 1.0)],
            Self::O { distance_m } => vec![(-0.5 * distance_m, 1.0), (0.5 * distance_m, -1.0)],
            Self::X { distance_m } => vec![(-0.5 * distance_m, -1.0), (0.5 * distance_m, 1.0)],
            Self::Tandem { distance_m } => vec![(-0.5 * distance_m, 1.0), (0.5 * distance_m, 1.0)],
        }
    }
}

/// How far the inner ring of each row is pressed in along the axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Preload {
    /// Balls or rollers just touch.
    #[default]
    None,
    /// So far \[m\]; negative leaves play.
    Displacement(f64),
    /// So far that each row carries this axial force at rest \[N\].
    Force(f64),
}

/// Ratings as a catalogue states them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StatedRatings {
    /// C of the whole bearing \[N\].
    pub dynamic_n: Option<f64>,
    /// C₀ of the whole bearing \[N\].
    pub static_n: Option<f64>,
    /// C_u of the whole bearing \[N\].
    pub fatigue_n: Option<f64>,
}
