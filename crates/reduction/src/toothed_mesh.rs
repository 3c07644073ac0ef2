//! What loads, gauges and the tooth-only submodel ask of a mesh, wherever it comes from.

use gearmesh_geometry::Flank;
use gearmesh_mesh::{BevelMesh, GearMesh, OutlineFace};

/// A mesh with teeth that can be cut off.
pub trait ToothParts {
    /// Elements of the tooth-only submodel: the tooth above the cut.
    fn tooth_elements(&self, tooth: usize) -> Vec<u32>;

    /// Nodes that hold the tooth-only submodel for loads on `loaded`: the cut and the opposite side of the tooth above
    /// it.
    fn tooth_supports(&self, tooth: usize, loaded: Flank) -> Vec<u32>;
}

/// A mesh with cylindrical teeth.
pub trait ToothedMesh: ToothParts {
    /// Faces of one side of a tooth between two arc lengths \[m\] from the centre of that side's tooth space, including
    /// those that are partly outside.
    fn outline_faces(&self, tooth: usize, side: Flank, arc_m: [f64; 2]) -> Vec<OutlineFace>;

    /// Turn of the teeth per metre of z \[rad/m\], positive for a right hand.
    fn twist_rad_per_m(&self) -> f64;
}

impl ToothedMesh for GearMesh {
    fn outline_faces(&self, tooth: usize, side: Flank, arc_m: [f64; 2]) -> Vec<OutlineFace> {
        Self::outline_faces(self, tooth, side, arc_m)
    }

    fn twist_rad_per_m(&self) -> f64 {
        self.twist.teeth_rad_per_m
    }
}

impl ToothParts for GearMesh {
    fn tooth_elements(&self, tooth: usize) -> Vec<u32> {
        Self::tooth_elements(self, tooth)
    }

    fn tooth_supports(&self, tooth: usize, loaded: Flank) -> Vec<u32> {
        Self::tooth_supports(self, tooth, loaded)
    }
}

impl ToothParts for BevelMesh {
    fn tooth_elements(&self, tooth: usize) -> Vec<u32> {
        Self::tooth_elements(self, tooth)
    }

    fn tooth_supports(&self, tooth: usize, loaded: Flank) -> Vec<u32> {
        Self::tooth_supports(self, tooth, loaded)
    }
}
