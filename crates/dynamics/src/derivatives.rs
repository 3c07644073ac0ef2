//! A value with its derivatives by time.

/// Value and first two derivatives by time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Derivatives {
    /// y
    pub value: f64,
    /// dy/dt
    pub rate: f64,
    /// d²y/dt²
    pub acceleration: f64,
}
