//! Numbers that carry their derivatives by N variables.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dual<const N: usize> {
    pub value: f64,
    pub by: [f64; N],
}

impl<const N: usize> Dual<N> {
    pub fn constant(value: f64) -> Self {
        Self {
            value,
            by: [0.0; N],
        }
    }

    /// The variable with this number.
    pub fn variable(value: f64, number: usize) -> Self {
        let mut dual = Self::constant(value);
        dual.by[number] = 1.0;
        dual
    }

    /// A function of it, by its value and slope.
    pub fn map(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            by: self.by.map(|d| slope * d),
        }
    }

    pub fn powf(self, exponent: f64) -> Self {
        self.map(
            self.value.powf(exponent),
            exponent * self.value.powf(exponent - 1.0),
        )
    }

    pub fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.map(root, 0.5 / root)
    }

    pub fn abs(self) -> Self {
        self.map(self.value.abs(), 1.0_f64.copysign(self.value))
    }

    pub fn scaled(self, factor: f64) -> Self {
        self.map(factor * self.value, factor)
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            value: self.value + o.value,
            by: std::array::from_fn(|i| self.by[i] + o.by[i]),
        }
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.scaled(-1.0)
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + (-o)
    }
}

// The product rule adds.
#[allow(clippy::suspicious_arithmetic_impl)]
impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Self {
            value: self.value * o.value,
            by: std::array::from_fn(|i| self.by[i] * o.value + self.value * o.by[i]),
        }
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        self * o.map(1.0 / o.value, -1.0 / (o.value * o.value))
    }
}
