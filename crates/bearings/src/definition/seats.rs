//! How the rings of a bearing are seated and how warm everything is.

/// What holds a ring: the shaft under the inner or the housing round the outer one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seat {
    /// By how much the diameters of ring and seat overlap at 20 °C; negative: loose \[m\].
    pub interference_m: f64,
    /// The diameter that the ring does not touch: bore of the shaft, 0 where it is solid, or outside diameter of the
    /// housing \[m\].
    pub far_diameter_m: f64,
    /// E \[Pa\].
    pub young_pa: f64,
    /// ν.
    pub poisson: f64,
    /// Coefficient of thermal expansion \[1/K\].
    pub expansion_per_k: f64,
    /// Temperature above 20 °C \[K\].
    pub rise_k: f64,
}

/// How the rings are seated and how warm everything is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Bore of the bearing \[m\].
    pub bore_m: f64,
    /// Outside diameter of the bearing \[m\].
    pub outside_m: f64,
    /// Shaft; none: it does not press the inner ring.
    pub shaft: Option<Seat>,
    /// Housing; none: it does not press the outer ring.
    pub housing: Option<Seat>,
    /// Coefficient of thermal expansion of the rings \[1/K\].
    pub ring_expansion_per_k: f64,
    /// That of balls or rollers \[1/K\].
    pub element_expansion_per_k: f64,
    /// Temperature of the inner ring above 20 °C \[K\].
    pub inner_rise_k: f64,
    /// Temperature of the outer ring above 20 °C \[K\].
    pub outer_rise_k: f64,
    /// Temperature of balls or rollers above 20 °C \[K\].
    pub element_rise_k: f64,
}
