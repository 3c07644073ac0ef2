//! `kind = "node-to-surface"`: nodes of gear 1's flanks against patches of gear 2's, of bevel and of cylindrical gears.

use gearmesh_drivetrain::{
    BevelMesh, DrivetrainError, FlankKinematics, GearMesh, Impact, MeshKinematics, NodeSurfaces,
    PatchSize, PathEnds, PowerStiffness, ReferenceApproach, SlicePressure, ToothPairs,
};
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{Flank, InputError};
use gearmesh_specification::gear_tables::{MM, UM};
use gearmesh_specification::system::gear_mesh::PathWord;
use gearmesh_specification::system::mesh_model::{NodeSurfaceTable, NodeWeights};

use super::bevel_hybrid::BevelModels;
use super::bevel_mesh::SceneBevel;
use super::mesh_model::{SceneInvolutes, ends_of_flank};
use super::mesh_stiffness::{impact_law, stated_impact};
use super::scene_mesh::SceneMesh;

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

/// A mesh of nodes with what its channels need.
pub(super) struct NodeMesh {
    pub mesh: GearMesh,
    pub slice_width_m: f64,
    pub tooth_pairs: Option<ToothPairs>,
}

impl<F> SceneMesh<'_, F> {
    /// The mesh of all sides with one law; columns of the pairs of nodes that press with their areas, on flanks between
    /// these ends.
    fn of_nodes(
        &self,
        nodes: Result<NodeSurfaces, DrivetrainError>,
        law: Impact,
        sides: &[Flank],
        (face_widths_m, ends): ([f64; 2], [[f64; 2]; 2]),
    ) -> Result<NodeMesh, InputError> {
        let nodes = nodes.map_err(|e| self.model_keys.error("along_um", e))?;
        let (slice_width_m, area) = (nodes.layout().width_m(), nodes.reference_area_m2());
        self.refuse_pair_material()?;
        let pairs = self.table.tooth_pairs.as_ref().map(|_| {
            let problem = "needs weights = { kind = \"area\", ... }: nodes that all press with the whole law have no pressure; remove it";
            let area = area.ok_or_else(|| self.keys.error("tooth_pairs", problem))?;
            Ok(ToothPairs::Slices {
                pressure: SlicePressure::Area(area),
                face_widths_m,
                ends,
            })
        });
        let laws = sides.iter().map(|side| (*side, law));
        let first = |side, law| GearMesh::of_flanks(Box::new(nodes), side, law);
        Ok(NodeMesh {
            slice_width_m,
            tooth_pairs: pairs.transpose()?,
            mesh: self.of_sides(laws, first)?,
        })
    }
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
        let at = (widths_m, [[0.0, 1.0]; 2]);
        let mut made = self.of_nodes(nodes, stated.law, sides, at)?;
        let models = [0, 1].map(|gear: usize| models.map(|models| &*models[gear]));
        made.mesh = self.with_modes(made.mesh, models, modes)?;
        Ok(made)
    }
}

impl SceneInvolutes<'_, '_> {
    /// The mesh of involute flanks.
    pub(super) fn node_surfaces(
        &self,
        table: &NodeSurfaceTable,
        sides: &[Flank],
    ) -> Result<NodeMesh, InputError> {
        let errors = [
            ("errors_1", !self.teeth.errors_1.is_empty()),
            ("errors_2", !self.teeth.errors_2.is_empty()),
        ];
        let problem = "is not used by kind = \"node-to-surface\", whose teeth are all alike; remove it, or take \"impact\"";
        self.teeth_keys.refuse(&errors, problem)?;
        if self.teeth.path == PathWord::LineOfAction {
            let problem = "found \"line-of-action\"; nodes touch wherever they stand, remove it";
            return Err(self.teeth_keys.error("path", problem));
        }
        let mut gears = self.flanks.gears.iter();
        if let Some(ring) = gears.find(|gear| gear.definition.profile.internal) {
            let problem = format!(
                "found \"node-to-surface\" with {}, a ring with internal teeth, whose flanks have no digital surface; take \"impact\" or \"hybrid\"",
                ring.file.display()
            );
            return Err(self.model_keys.error("kind", problem));
        }
        let stated = stated(table, &self.model_keys)?;
        let removed = self.microgeometry()?;
        let widths_m = self
            .flanks
            .gears
            .map(|gear| gear.definition.tooth.face_width_m);
        let gears = [
            self.flanks.pair.gear_1.clone(),
            self.flanks.pair.gear_2.clone(),
        ];
        let none = [Vec::new(), Vec::new()];
        let distance_m = self.flanks.pair.centre_distance_m;
        let ends = PathEnds::Extended;
        let smooth = MeshKinematics::new(gears, none, distance_m, self.layout(1), ends);
        let nodes = NodeSurfaces::of_involutes(
            smooth.map_err(self.fault())?,
            (self.flanks.pair, widths_m, &removed),
            stated.size,
            SLICES,
            stated.reference,
        );
        let ends = [&self.flanks.pair.gear_1, &self.flanks.pair.gear_2].map(ends_of_flank);
        self.of_nodes(nodes, stated.law, sides, (widths_m, ends))
    }
}
