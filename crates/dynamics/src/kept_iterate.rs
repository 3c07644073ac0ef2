//! An iterate of a step and its correction, to which shorter trials come back.

/// State of the scheme at the iterate, and the whole correction there.
pub(crate) struct KeptIterate {
    pub increment: Vec<f64>,
    pub velocity: Vec<f64>,
    pub acceleration: Vec<f64>,
    pub lambda: Vec<f64>,
    pub delta: Vec<f64>,
    pub mu: Vec<f64>,
}

impl KeptIterate {
    /// For so many degrees of freedom and joint equations.
    pub(crate) fn new(n: usize, m: usize) -> Self {
        Self {
            increment: vec![0.0; n],
            velocity: vec![0.0; n],
            acceleration: vec![0.0; n],
            lambda: vec![0.0; m],
            delta: vec![0.0; n],
            mu: vec![0.0; m],
        }
    }
}
