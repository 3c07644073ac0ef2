//! `kind = "node-to-surface"`: nodes of gear 1's flanks against patches of gear 2's, of bevel and of cylindrical gears.

use gearmesh_drivetrain::{
    BevelMesh, FlankKinematics, GearMesh, Impact, MeshKinematics, NodeSurfaces, PatchSize,
    PathEnds, PowerStiffness, ReferenceApproach, SlicePressure, ToothPairs,
};
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{Flank, InputError};

use super::bevel_hybrid::BevelModels;
use super::bevel_mesh::SceneBevel;
use super::mesh_model::SceneMesh;
use super::mesh_stiffness::{impact_law, stated_impact};
use crate::system::tables::gear_mesh::PathWord;
use crate::system::tables::mesh_model::{NodeSurfaceTable, NodeWeights};
use crate::system::tables::{MM, UM};

/// Slices along the face, for columns and for modes.
const SLICES: usize = 15;

/// What a table states.
struct Stated {
    law: Impact,
    size: PatchSize,
    reference: Option<ReferenceApproach>,
}

fn stated(table: &NodeSurfaceTable, keys: &TableKeys<'_>) -> Result<Stated, InputError> {
    let of_law = table.law();
    let (k, exponent) = stated_impact(&of_law, keys)?;
    let law = impact_law(&of_law, keys, PowerStiffness::n_per_mm_e(k, exponent), 1)?;
    let reference = match &table.weights {
        NodeWeights::None {} => None,
        NodeWeights::Area { nominal_force_N } => {
            let approach_m = MM * (**nominal_force_N / k).powf(1.0 / exponent);
            Some(ReferenceApproach {
                approach_m,
                exponent,
            })
        }
    };
    Ok(Stated {
        law: law.on_modes(),
        size: PatchSize {
            along_m: UM * *table.along_um,
            up_m: UM * *table.up_um,
        },
        reference,
    })
}

/// The mesh of all sides with one law.
fn mesh_of(
    nodes: NodeSurfaces,
    law: Impact,
    sides: &[Flank],
    keys: &TableKeys<'_>,
) -> Result<GearMesh, InputError> {
    let fault = |error| keys.error("", error);
    let [first, others @ ..] = sides else {
        return Err(keys.error("teeth.flanks", "names no flanks"));
    };
    let mut mesh = GearMesh::of_flanks(Box::new(nodes), *first, law).map_err(fault)?;
    for side in others {
        mesh = mesh.with_side(*side, law).map_err(fault)?;
    }
    Ok(mesh)
}

/// Columns of the pairs of nodes that press with their areas.
fn tooth_pairs(
    reference_area_m2: Option<f64>,
    (face_widths_m, ends): ([f64; 2], [[f64; 2]; 2]),
    keys: &TableKeys<'_>,
) -> Result<ToothPairs, InputError> {
    let problem = "needs weights = { kind = \"area\", ... }: nodes that all press with the whole law have no pressure; remove it";
    let area = reference_area_m2.ok_or_else(|| keys.error("tooth_pairs", problem))?;
    Ok(ToothPairs::Slices {
        pressure: SlicePressure::Area(area),
        face_widths_m,
        ends,
    })
}

/// A mesh of nodes with what its channels need.
pub(super) struct NodeMesh {
    pub mesh: GearMesh,
    pub slice_width_m: f64,
    pub tooth_pairs: Option<ToothPairs>,
}

impl SceneBevel<'_> {
    /// The mesh of bevel flanks; `modes`: those of the members' bodies.
    pub(super) fn node_surfaces(
        &self,
        flanks: BevelMesh,
        (table, models, modes): (&NodeSurfaceTable, Option<&BevelModels>, [usize; 2]),
        sides: &[Flank],
    ) -> Result<NodeMesh, InputError> {
        let stated = stated(table, &self.model_keys)?;
        let widths_m = flanks.face_widths_m();
        let own = models.map(|models| models[0].grid.slices.min(models[1].grid.slices));
        let slices = own.unwrap_or(SLICES);
        let nodes = NodeSurfaces::of_bevel(flanks, stated.size, slices, stated.reference);
        let nodes = nodes.map_err(|e| self.model_keys.error("along_um", e))?;
        let slice_width_m = nodes.layout().width_m();
        let area = nodes.reference_area_m2();
        let pairs = self.table.tooth_pairs.as_ref().map(|table| {
            super::mesh_model::refuse_material(table, &self.keys)?;
            tooth_pairs(area, (widths_m, [[0.0, 1.0]; 2]), &self.keys)
        });
        let mut mesh = mesh_of(nodes, stated.law, sides, &self.keys)?;
        for (gear, count) in modes.into_iter().enumerate() {
            if let (Some(models), true) = (models, count > 0) {
                let vibrating = mesh.with_modes(gear + 1, &models[gear], count);
                mesh = vibrating.map_err(|e| self.keys.error("", e))?;
            }
        }
        Ok(NodeMesh {
            mesh: self.with_friction(mesh)?,
            slice_width_m,
            tooth_pairs: pairs.transpose()?,
        })
    }
}

impl SceneMesh<'_, '_> {
    /// The mesh of involute flanks.
    pub(super) fn node_surfaces(
        &self,
        table: &NodeSurfaceTable,
        sides: &[Flank],
    ) -> Result<NodeMesh, InputError> {
        for (key, is_stated) in [
            ("errors_1", !self.teeth.errors_1.is_empty()),
            ("errors_2", !self.teeth.errors_2.is_empty()),
        ] {
            if is_stated {
                let problem = "is not used by kind = \"node-to-surface\", whose teeth are all alike; remove it, or take \"impact\"";
                return Err(self.teeth_keys.error(key, problem));
            }
        }
        if self.teeth.path == PathWord::LineOfAction {
            let problem = "found \"line-of-action\"; nodes touch wherever they stand, remove it";
            return Err(self.teeth_keys.error("path", problem));
        }
        if let Some(ring) = self
            .gears
            .iter()
            .find(|gear| gear.definition.profile.internal)
        {
            let problem = format!(
                "found \"node-to-surface\" with {}, a ring with internal teeth, whose flanks have no digital surface; take \"impact\" or \"hybrid\"",
                ring.file.display()
            );
            return Err(self.model_keys.error("kind", problem));
        }
        let stated = stated(table, &self.model_keys)?;
        let removed = self.microgeometry()?;
        let widths_m = self.gears.map(|gear| gear.definition.tooth.face_width_m);
        let gears = [self.pair.gear_1.clone(), self.pair.gear_2.clone()];
        let none = [Vec::new(), Vec::new()];
        let distance_m = self.pair.centre_distance_m;
        let ends = PathEnds::Extended;
        let smooth = MeshKinematics::new(gears, none, distance_m, self.layout(1), ends);
        let nodes = NodeSurfaces::of_involutes(
            smooth.map_err(self.fault())?,
            (self.pair, widths_m, &removed),
            stated.size,
            SLICES,
            stated.reference,
        );
        let nodes = nodes.map_err(|e| self.model_keys.error("along_um", e))?;
        let slice_width_m = nodes.layout().width_m();
        let area = nodes.reference_area_m2();
        let pairs = self.table.tooth_pairs.as_ref().map(|table| {
            super::mesh_model::refuse_material(table, &self.keys)?;
            let ends = [&self.pair.gear_1, &self.pair.gear_2]
                .map(|gear| [gear.form_roll_rad, gear.flank_end_roll_rad]);
            tooth_pairs(area, (widths_m, ends), &self.keys)
        });
        let mesh = mesh_of(nodes, stated.law, sides, &self.keys)?;
        Ok(NodeMesh {
            mesh: self.with_friction(mesh)?,
            slice_width_m,
            tooth_pairs: pairs.transpose()?,
        })
    }
}
