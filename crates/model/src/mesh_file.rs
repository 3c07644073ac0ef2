//! The mesh file: nodes, elements by kind, node sets and fields as arrays of a [`DataTree`].

use std::collections::BTreeMap;
use std::path::Path;

use crate::data_tree::{DataArray, DataTree, FileFormat, Values};
use crate::file_error::FileError;
use crate::mesh_data::{Field, MeshData};
use gearmesh_elements::CellKind;

/// Name and version of the mesh file.
pub const MESH_FORMAT: FileFormat = FileFormat {
    name: "gearmesh mesh",
    version: 2,
};

/// Writes a mesh, atomically. Names of sets and fields must not contain `/`.
///
/// # Errors
/// [`FileError::Mesh`] for indices or lengths that do not fit together, otherwise as [`DataTree::write`].
pub fn write_mesh(path: &Path, mesh: &MeshData) -> Result<(), FileError> {
    checked(path, mesh)?;
    let names = mesh
        .point_sets
        .keys()
        .chain(mesh.point_fields.keys())
        .chain(mesh.cell_fields.keys());
    if let Some(name) = names.into_iter().find(|name| name.contains('/')) {
        return Err(FileError::InvalidName {
            path: path.to_owned(),
            item: "a node set or field",
            name: name.clone(),
            allowed: "it must not contain a slash",
        });
    }
    let mut tree = DataTree::default();
    let points = mesh.points.as_flattened().to_vec();
    let axes = [("node", mesh.points.len()), ("xyz", 3)];
    let points = DataArray::new(Values::F64(points), &axes, "m", "coordinates of the nodes");
    tree.put("points", points.in_frame("right-handed, z along the axis"));
    for (kind, nodes) in &mesh.cells {
        let axes = [
            ("element", nodes.len() / kind.node_count()),
            ("node", kind.node_count()),
        ];
        let meaning = "node indices of the elements, corners first";
        let array = DataArray::new(Values::U32(nodes.clone()), &axes, "1", meaning);
        tree.put(format!("cells/{}", kind.name()), array);
    }
    for (name, set) in &mesh.point_sets {
        let axes = [("member", set.len())];
        let array = DataArray::new(
            Values::U32(set.clone()),
            &axes,
            "1",
            "node indices of a set",
        );
        tree.put(format!("point_sets/{name}"), array);
    }
    for (name, field) in &mesh.point_fields {
        tree.put(format!("point_fields/{name}"), field_array("node", field));
    }
    for (name, field) in &mesh.cell_fields {
        tree.put(format!("cell_fields/{name}"), field_array("element", field));
    }
    tree.write(path, &MESH_FORMAT)
}

fn checked(path: &Path, mesh: &MeshData) -> Result<(), FileError> {
    mesh.validate().map_err(|source| FileError::Mesh {
        path: path.to_owned(),
        source,
    })
}

/// Reads a mesh and checks its indices.
///
/// # Errors
/// Every kind of [`FileError`] except those about reduced gears.
pub fn read_mesh(path: &Path) -> Result<MeshData, FileError> {
    let mut tree = DataTree::read(path, &MESH_FORMAT)?;
    let [nodes, _] = tree.shape(path, "points")?;
    let points = tree.take_f64(path, "points", &[nodes, 3])?;
    let mut cells = BTreeMap::new();
    let mut elements = 0;
    let kinds = tree.children("cells");
    if kinds.is_empty() {
        return Err(FileError::Missing {
            path: path.to_owned(),
            item: "cells".to_owned(),
        });
    }
    for name in kinds {
        let stored = format!("cells/{name}");
        let Some(kind) = CellKind::from_name(&name) else {
            return Err(FileError::InvalidName {
                path: path.to_owned(),
                item: "a kind of element",
                name,
                allowed: "hex8, hex20, tet10, wedge6, wedge15",
            });
        };
        let [count, _] = tree.shape(path, &stored)?;
        elements += count;
        let nodes = tree.take_u32(path, &stored, &[count, kind.node_count()])?;
        cells.insert(kind, nodes);
    }
    let mut point_sets = BTreeMap::new();
    for name in tree.children("point_sets") {
        let stored = format!("point_sets/{name}");
        let [members] = tree.shape(path, &stored)?;
        point_sets.insert(name, tree.take_u32(path, &stored, &[members])?);
    }
    let mesh = MeshData {
        points: points.as_chunks().0.to_vec(),
        cells,
        point_sets,
        point_fields: take_fields(&mut tree, path, "point_fields", nodes)?,
        cell_fields: take_fields(&mut tree, path, "cell_fields", elements)?,
    };
    checked(path, &mesh)?;
    Ok(mesh)
}

fn field_array(row: &str, field: &Field) -> DataArray {
    let axes = [
        (row, field.values.len() / field.components),
        ("component", field.components),
    ];
    DataArray::new(
        Values::F64(field.values.clone()),
        &axes,
        &field.unit,
        "a field",
    )
}

fn take_fields(
    tree: &mut DataTree,
    path: &Path,
    group: &str,
    rows: usize,
) -> Result<BTreeMap<String, Field>, FileError> {
    let mut fields = BTreeMap::new();
    for name in tree.children(group) {
        let stored = format!("{group}/{name}");
        let [_, components] = tree.shape(path, &stored)?;
        let unit = tree
            .arrays
            .get(&stored)
            .map(|array| array.unit.clone())
            .unwrap_or_default();
        let values = tree.take_f64(path, &stored, &[rows, components])?;
        fields.insert(
            name,
            Field {
                components,
                values,
                unit,
            },
        );
    }
    Ok(fields)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::made_up_models::block_mesh;

    #[test]
    fn roundtrip_keeps_everything() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("block.h5");
        let mut mesh = block_mesh();
        mesh.point_sets
            .insert("empty set, with a comma".to_owned(), vec![]);
        mesh.cell_fields.insert(
            "energy".to_owned(),
            Field {
                components: 1,
                values: vec![0.5, -1e-300],
                unit: "J".to_owned(),
            },
        );
        write_mesh(&path, &mesh).unwrap();
        assert_eq!(read_mesh(&path).unwrap(), mesh);

        // Every kind of element comes back as it went.
        mesh.cells = CellKind::ALL
            .map(|kind| {
                (
                    kind,
                    (0..2 * kind.node_count() as u32).map(|n| n % 12).collect(),
                )
            })
            .into();
        mesh.cell_fields.clear();
        write_mesh(&path, &mesh).unwrap();
        assert_eq!(read_mesh(&path).unwrap(), mesh);
    }

    #[test]
    fn names_with_slashes_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("block.h5");
        let mut mesh = block_mesh();
        mesh.point_sets.insert("bore/left".to_owned(), vec![0]);
        assert!(matches!(
            write_mesh(&path, &mesh),
            Err(FileError::InvalidName { .. })
        ));
        assert!(!path.exists());
    }

    #[test]
    fn a_file_of_another_kind_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("block.h5");
        write_mesh(&path, &block_mesh()).unwrap();
        let message = crate::read_reduced_gear(&path).unwrap_err().to_string();
        assert!(
            message.contains("gearmesh mesh") && message.contains("gearmesh reduced gear"),
            "{message}"
        );
    }

    /// Sizes that fit the format but not each other: a well-sealed file from a faulty program.
    #[test]
    fn inconsistent_arrays_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("block.h5");
        let mut tree = DataTree::default();
        let points = DataArray::new(
            Values::F64(vec![0.0; 6]),
            &[("node", 2), ("xyz", 3)],
            "m",
            "two nodes",
        );
        tree.put("points", points);
        tree.write(&path, &MESH_FORMAT).unwrap();
        assert!(matches!(read_mesh(&path), Err(FileError::Missing { .. })));
        tree.put(
            "cells/hex8",
            DataArray::new(
                Values::U32(vec![1; 4]),
                &[("element", 1), ("corner", 4)],
                "1",
                "a quad",
            ),
        );
        tree.write(&path, &MESH_FORMAT).unwrap();
        assert!(matches!(
            read_mesh(&path),
            Err(FileError::WrongShape { .. })
        ));
        tree.put(
            "cells/hex8",
            DataArray::new(
                Values::F64(vec![1.0; 8]),
                &[("element", 1), ("corner", 8)],
                "1",
                "floats",
            ),
        );
        tree.write(&path, &MESH_FORMAT).unwrap();
        assert!(matches!(read_mesh(&path), Err(FileError::WrongType { .. })));
        tree.put(
            "cells/hex8",
            DataArray::new(
                Values::U32(vec![2; 8]),
                &[("element", 1), ("corner", 8)],
                "1",
                "outside",
            ),
        );
        tree.write(&path, &MESH_FORMAT).unwrap();
        assert!(matches!(read_mesh(&path), Err(FileError::Mesh { .. })));
    }
}
