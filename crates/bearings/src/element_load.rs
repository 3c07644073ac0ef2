//! Load on one ball or roller.

/// What a ball or roller carries and does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ElementLoad {
    /// Place round the axis, from x towards y \[rad\].
    pub angle_rad: f64,
    /// Normal load at the inner race \[N\]; of a roller the sum over its laminae.
    pub inner_load_n: f64,
    /// Normal load at the outer race \[N\].
    pub outer_load_n: f64,
    /// Contact angle at the inner race, positive where the inner ring pushes the element along +z \[rad\].
    pub inner_contact_angle_rad: f64,
    /// Contact angle at the outer race, positive alike \[rad\].
    pub outer_contact_angle_rad: f64,
    /// Displacement of the element's centre away from the axis \[m\].
    pub radial_m: f64,
    /// Displacement along z \[m\].
    pub axial_m: f64,
    /// Tilt of a roller in its axial plane \[rad\].
    pub tilt_rad: f64,
    /// Force of a tapered roller on the rib \[N\].
    pub rib_load_n: f64,
    /// Largest lamina's line load at the inner race \[N/m\].
    pub inner_line_load_n_per_m: f64,
    /// Largest lamina's line load at the outer race \[N/m\].
    pub outer_line_load_n_per_m: f64,
    /// Centrifugal force \[N\].
    pub centrifugal_n: f64,
    /// Gyroscopic moment \[N·m\].
    pub gyroscopic_nm: f64,
    /// Speed of the element's centre about the bearing's axis \[rad/s\].
    pub orbit_rad_per_s: f64,
    /// Speed about its own axis, seen from the cage \[rad/s\].
    pub spin_rad_per_s: f64,
    /// Whether a ball rolls without spin on the inner race; otherwise on the outer one.
    pub controlled_by_inner: bool,
    /// Whether a ball of an angular-contact bearing at speed lies beyond the end of the inner groove: on the edge
    /// there, or off it, with its centrifugal force on the outer ring alone.
    pub beyond_inner_groove: bool,
    /// Of a four-point contact bearing: the contacts on the side that carries less.
    pub other_side: Option<OtherSide>,
}

impl ElementLoad {
    /// Whether a ball lies beyond the end of the inner groove and does not touch its edge.
    #[must_use]
    pub fn has_dropped(&self) -> bool {
        self.beyond_inner_groove && self.inner_load_n == 0.0
    }

    /// Loads at the inner and outer race where contact angles are positive (or zero), or negative \[N\].
    pub(crate) fn on_track(&self, positive: bool) -> (f64, f64) {
        if self.other_side.is_none() {
            // One track, whichever its angle.
            return if positive {
                (self.inner_load_n, self.outer_load_n)
            } else {
                (0.0, 0.0)
            };
        }
        let other = self.other_side.unwrap_or_default();
        if (self.inner_contact_angle_rad >= 0.0) == positive {
            (self.inner_load_n, self.outer_load_n)
        } else {
            (other.inner_load_n, other.outer_load_n)
        }
    }
}

/// The second pair of contacts of a ball with four.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct OtherSide {
    /// Normal load at the inner race \[N\].
    pub inner_load_n: f64,
    /// Normal load at the outer race \[N\].
    pub outer_load_n: f64,
    /// Contact angle at the inner race \[rad\].
    pub inner_contact_angle_rad: f64,
    /// Contact angle at the outer race \[rad\].
    pub outer_contact_angle_rad: f64,
}

impl ElementLoad {
    /// Of an element that is not there: its place, and nothing else.
    #[must_use]
    pub fn absent(angle_rad: f64) -> Self {
        Self {
            angle_rad,
            ..Self::default()
        }
    }
}
