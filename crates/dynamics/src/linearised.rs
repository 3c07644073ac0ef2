//! The sparse matrices of small motions about a state, for whoever takes them further.

use sprs::CsMatView;

use crate::eigen::about;
use crate::equations::Equations;
use crate::error::DynamicsError;
use crate::state::State;
use crate::system::System;

/// M̂ ÿ + Ĉ ẏ + K̂ y + B̂ᵀδλ = 0, B̂ y = 0, about one state.
///
/// y has the degrees of freedom of [`crate::NaturalMode::shape`]: places and rotations along world axes of each body,
/// then modal coordinates. SI units. The matrices are views by compressed columns or rows; zeros of the pattern are
/// stored.
pub struct Linearised(Equations);

impl Linearised {
    /// The equations about a state, gyroscopic terms in Ĉ.
    ///
    /// # Errors
    /// [`DynamicsError::Singular`] or the error of an element.
    ///
    /// # Example
    /// A disc of 0.02 kg m² on a torsion spring of 800 N m/rad: K̂ and M̂ about z have the natural frequency √(k/J).
    ///
    /// ```
    /// use gearmesh_dynamics::elements::TorsionSpring;
    /// use gearmesh_dynamics::{Body, Joint, JointKind, Linearised, Marker, MarkerPair, System};
    ///
    /// let mut builder = System::builder();
    /// let disc = builder.body(Body::rigid("disc", 1.0, [0.02; 3]))?;
    /// let pair = MarkerPair { a: Marker::ground([0.0; 3]), b: Marker::at(disc, [0.0; 3]) };
    /// builder.joint(Joint::new("axle", JointKind::Revolute, pair.a, pair.b)?);
    /// builder.element(TorsionSpring::new(800.0, 0.0).between("spring", pair)?);
    /// let mut system = builder.build()?;
    /// let start = system.start().clone();
    ///
    /// let small = Linearised::about(&mut system, &start)?;
    /// assert_eq!(small.stiffness().get(5, 5), Some(&800.0));
    /// assert_eq!(small.mass().get(5, 5), Some(&0.02));
    /// assert_eq!(small.constraints().shape(), (5, 6));
    /// let turn = sprs::CsVec::new(6, vec![5], vec![1.0]);
    /// let held = &small.constraints() * &turn;
    /// assert!(held.iter().all(|(_, rate)| *rate == 0.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn about(system: &mut System, state: &State) -> Result<Self, DynamicsError> {
        Ok(Self(about(system, state)?))
    }

    /// M̂ (degrees of freedom × degrees of freedom; kg, kg m², symmetric).
    #[must_use]
    pub fn mass(&self) -> CsMatView<'_, f64> {
        self.0.mass.view()
    }

    /// Ĉ (N s/m, N m s/rad).
    #[must_use]
    pub fn damping(&self) -> CsMatView<'_, f64> {
        self.0.damping.view()
    }

    /// K̂ (N/m, N m/rad); not symmetric where forces follow the motion.
    #[must_use]
    pub fn stiffness(&self) -> CsMatView<'_, f64> {
        self.0.stiffness.view()
    }

    /// B̂ (joint equations × degrees of freedom), redundant equations included.
    #[must_use]
    pub fn constraints(&self) -> CsMatView<'_, f64> {
        self.0.gradient.view().transpose_into()
    }
}
