//! What the friction of a bearing depends on beside its loads.

/// What the friction of a bearing depends on beside its loads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// ν at the bearing's temperature; of a grease that of its base oil \[mm²/s\].
    pub viscosity_mm2_per_s: f64,
    /// f₀ of the viscous part, for a row.
    pub viscous_factor: f64,
    /// f₁ of the part by the load.
    pub load_factor: LoadFactor,
    /// Torque of all seals \[N·m\].
    pub seals_nm: f64,
}

/// f₁.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LoadFactor {
    /// A number.
    Stated(f64),
    /// z (P₀/C₀)^y, as balls have it.
    OfStaticLoad {
        /// z.
        factor: f64,
        /// y.
        power: f64,
    },
}
