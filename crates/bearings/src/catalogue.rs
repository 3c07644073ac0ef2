//! Catalogue lines: boundary dimensions of a bearing, and what is known of its inside.

/// Type of a bearing in a catalogue.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize, serde::Serialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum CatalogueType {
    /// Deep-groove ball bearing.
    DeepGroove,
    /// Angular-contact ball bearing.
    AngularContact,
    /// Angular-contact ball bearing with two rows in one pair of rings.
    AngularContactDoubleRow,
    /// Four-point contact ball bearing.
    FourPoint,
    /// Thrust ball bearing, one way; its width is its height.
    ThrustBall,
    /// Cylindrical roller bearing.
    CylindricalRoller,
    /// Tapered roller bearing; its width is that of the assembled bearing (T).
    TaperedRoller,
    /// Spherical roller bearing.
    SphericalRoller,
}

/// Usual designs of today: assumptions, with the scatters beside them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct UsualShares {
    /// D/(D_a − d), and its scatter.
    pub diameter: (f64, f64),
    /// L/B, and its scatter.
    pub length: (f64, f64),
    /// Elements over the most that go in.
    pub number: f64,
}

impl CatalogueType {
    /// The word of the file.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::DeepGroove => "deep-groove",
            Self::AngularContact => "angular-contact",
            Self::AngularContactDoubleRow => "angular-contact-double-row",
            Self::FourPoint => "four-point",
            Self::ThrustBall => "thrust-ball",
            Self::CylindricalRoller => "cylindrical-roller",
            Self::TaperedRoller => "tapered-roller",
            Self::SphericalRoller => "spherical-roller",
        }
    }

    /// Whether it has rollers.
    #[must_use]
    pub fn has_rollers(self) -> bool {
        matches!(
            self,
            Self::CylindricalRoller | Self::TaperedRoller | Self::SphericalRoller
        )
    }

    /// Rows within one pair of rings.
    #[must_use]
    pub fn rows(self) -> usize {
        match self {
            Self::AngularContactDoubleRow | Self::SphericalRoller => 2,
            _ => 1,
        }
    }

    /// Contact angles that it is made with \[deg\]; none where it has no angle of its own.
    #[must_use]
    pub fn angles_deg(self) -> Option<[f64; 2]> {
        match self {
            Self::DeepGroove | Self::ThrustBall | Self::CylindricalRoller => None,
            Self::AngularContact | Self::AngularContactDoubleRow | Self::FourPoint => {
                Some([1.0, 60.0])
            }
            Self::TaperedRoller => Some([5.0, 45.0]),
            Self::SphericalRoller => Some([3.0, 45.0]),
        }
    }

    /// Sizes and number of the elements that it usually has.
    pub(crate) fn usual(self) -> UsualShares {
        let (diameter, length, number) = match self {
            Self::DeepGroove => ((0.3, 0.08), (1.0, 1.0), 0.97),
            Self::AngularContact | Self::AngularContactDoubleRow | Self::FourPoint => {
                ((0.3, 0.08), (1.0, 1.0), 0.88)
            }
            Self::ThrustBall => ((0.36, 0.12), (1.0, 1.0), 0.93),
            Self::CylindricalRoller => ((0.275, 0.08), (0.64, 0.12), 0.93),
            Self::TaperedRoller => ((0.24, 0.1), (0.62, 0.15), 0.92),
            Self::SphericalRoller => ((0.25, 0.1), (0.36, 0.1), 0.92),
        };
        UsualShares {
            diameter,
            length,
            number,
        }
    }
}

/// What is known of the inside; the estimator keeps it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KnownInside {
    /// Z of a row.
    pub elements: Option<usize>,
    /// D of balls or rollers \[m\].
    pub diameter_m: Option<f64>,
    /// Length of rollers \[m\].
    pub length_m: Option<f64>,
    /// d_m \[m\].
    pub pitch_m: Option<f64>,
}

/// One line of a catalogue.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CatalogueLine {
    /// Type.
    pub kind: CatalogueType,
    /// d \[m\].
    pub bore_m: f64,
    /// D_a \[m\].
    pub outside_m: f64,
    /// B, of tapered bearings T \[m\].
    pub width_m: f64,
    /// C of one bearing \[N\], where it is known.
    pub dynamic_n: Option<f64>,
    /// C₀ of one bearing \[N\], where it is known.
    pub static_n: Option<f64>,
    /// α \[rad\].
    pub contact_angle_rad: f64,
    /// What is known of the inside.
    pub known: KnownInside,
}

impl CatalogueLine {
    /// d_m: as stated, else (d + D_a)/2, an assumption \[m\].
    #[must_use]
    pub fn pitch_m(&self) -> f64 {
        self.known
            .pitch_m
            .unwrap_or(0.5 * (self.bore_m + self.outside_m))
    }

    /// D_a − d \[m\].
    #[must_use]
    pub fn section_m(&self) -> f64 {
        self.outside_m - self.bore_m
    }
}
