//! Numbers that carry their first and second derivatives by two parameters: exact differentiation of the surface equations.

use std::ops::{Add, Mul, Neg, Sub};

use nalgebra::Vector3;

/// A value with its derivatives by the parameters a and b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    /// Value.
    pub v: f64,
    /// ∂/∂a, ∂/∂b.
    pub d: [f64; 2],
    /// ∂²/∂a², ∂²/∂a∂b, ∂²/∂b².
    pub dd: [f64; 3],
}

impl Jet {
    /// A constant.
    pub const fn constant(v: f64) -> Self {
        Self {
            v,
            d: [0.0; 2],
            dd: [0.0; 3],
        }
    }

    /// The parameter itself, 0 for a and 1 for b.
    pub fn parameter(v: f64, which: usize) -> Self {
        let mut jet = Self::constant(v);
        jet.d[which] = 1.0;
        jet
    }

    /// f of this, with f, f′ and f″ at the value: the chain rule.
    pub fn chain(self, f: [f64; 3]) -> Self {
        let [a, b] = self.d;
        let [aa, ab, bb] = self.dd;
        Self {
            v: f[0],
            d: [f[1] * a, f[1] * b],
            dd: [
                f[1] * aa + f[2] * a * a,
                f[1] * ab + f[2] * a * b,
                f[1] * bb + f[2] * b * b,
            ],
        }
    }

    /// Sine and cosine.
    pub fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.v.sin_cos();
        (self.chain([s, c, -s]), self.chain([c, -s, -c]))
    }

    /// Square root.
    pub fn sqrt(self) -> Self {
        let root = self.v.sqrt();
        self.chain([root, 0.5 / root, -0.25 / (root * self.v)])
    }

    /// 1/x.
    pub fn reciprocal(self) -> Self {
        let r = 1.0 / self.v;
        self.chain([r, -r * r, 2.0 * r * r * r])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            v: self.v + o.v,
            d: std::array::from_fn(|i| self.d[i] + o.d[i]),
            dd: std::array::from_fn(|i| self.dd[i] + o.dd[i]),
        }
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        self * -1.0
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul<f64> for Jet {
    type Output = Self;
    fn mul(self, k: f64) -> Self {
        Self {
            v: k * self.v,
            d: self.d.map(|x| k * x),
            dd: self.dd.map(|x| k * x),
        }
    }
}

impl Add<f64> for Jet {
    type Output = Self;
    fn add(self, k: f64) -> Self {
        Self {
            v: self.v + k,
            ..self
        }
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let [a, b] = self.d;
        let [oa, ob] = o.d;
        Self {
            v: self.v * o.v,
            d: [a * o.v + self.v * oa, b * o.v + self.v * ob],
            dd: [
                self.dd[0] * o.v + 2.0 * a * oa + self.v * o.dd[0],
                self.dd[1] * o.v + a * ob + b * oa + self.v * o.dd[1],
                self.dd[2] * o.v + 2.0 * b * ob + self.v * o.dd[2],
            ],
        }
    }
}

/// A vector of jets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JetVector(pub [Jet; 3]);

impl JetVector {
    /// A constant vector.
    pub fn constant(v: [f64; 3]) -> Self {
        Self(v.map(Jet::constant))
    }

    /// Scalar product.
    pub fn dot(self, o: Self) -> Jet {
        self.0[0] * o.0[0] + self.0[1] * o.0[1] + self.0[2] * o.0[2]
    }

    /// Vector product.
    pub fn cross(self, o: Self) -> Self {
        let ([x, y, z], [a, b, c]) = (self.0, o.0);
        Self([y * c - z * b, z * a - x * c, x * b - y * a])
    }

    /// Times a jet.
    pub fn times(self, k: Jet) -> Self {
        Self(self.0.map(|x| x * k))
    }

    /// Value.
    pub fn value(&self) -> Vector3<f64> {
        Vector3::from(self.0.map(|x| x.v))
    }

    /// First derivatives.
    pub fn first(&self) -> [Vector3<f64>; 2] {
        std::array::from_fn(|i| Vector3::from(self.0.map(|x| x.d[i])))
    }

    /// Second derivatives.
    pub fn second(&self) -> [Vector3<f64>; 3] {
        std::array::from_fn(|i| Vector3::from(self.0.map(|x| x.dd[i])))
    }

    /// Turned about the third axis by an angle with this sine and cosine.
    pub fn turned(self, (sin, cos): (Jet, Jet)) -> Self {
        let [x, y, z] = self.0;
        Self([x * cos - y * sin, x * sin + y * cos, z])
    }
}

impl Add for JetVector {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + o.0[i]))
    }
}

impl Sub for JetVector {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - o.0[i]))
    }
}
