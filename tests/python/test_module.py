"""The gearmesh Python module: mesh exchange through meshio and reduced gears as NumPy arrays."""

import shutil
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest

import gearmesh

# meshio reads and writes fifteen-node wedges but lacks their dimension; the module adds it for itself in the same way.
meshio._mesh.topological_dimension.setdefault("wedge15", 3)


def block(shape=(3, 2, 2), lengths=(0.03, 0.0217, 1.0 / 70.0)):
    """A skewed brick of hexahedra with irrational coordinates: points, hexes."""
    nx, ny, nz = shape
    x, y, z = (np.linspace(0.0, 1.0, n + 1) ** 1.1 * length for n, length in zip(shape, lengths))
    points = np.array([[a + 0.2 * b, b, c + 0.1 * a] for c in z for b in y for a in x])
    index = lambda i, j, k: i + (nx + 1) * (j + (ny + 1) * k)
    hexes = [
        [index(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        for k in range(nz) for j in range(ny) for i in range(nx)
    ]
    return points, np.array(hexes)


@pytest.fixture
def mesh_file(tmp_path):
    points, hexes = block()
    path = tmp_path / "block.h5"
    sets = {"bore": np.flatnonzero(points[:, 2] == points[:, 2].min()), "last": [len(points) - 1]}
    fields = {"displacement": np.sin(points) * 1e-6, "temperature": points[:, :1] * 1e3}
    gearmesh.write_mesh(path, points, {"hex8": hexes}, point_sets=sets, point_fields=fields)
    return path


def test_write_and_read_mesh(mesh_file):
    points, hexes = block()
    mesh = gearmesh.read_mesh(mesh_file)
    assert np.array_equal(mesh["points"], points)
    assert np.array_equal(mesh["cells"]["hex8"], hexes)
    assert mesh["point_sets"]["last"].tolist() == [len(points) - 1]
    assert np.array_equal(mesh["point_fields"]["displacement"], np.sin(points) * 1e-6)


# Relative to the size of the body. Nastran's fields have 16 columns, CalculiX reads 20 of a number; the others write
# doubles whole.
@pytest.mark.parametrize(
    ("extension", "tolerance", "left_out"),
    [
        (".vtu", 0.0, set()),
        (".vtk", 0.0, set()),
        (".msh", 0.0, set()),
        (".inp", 1e-13, {"displacement", "temperature"}),
        (".bdf", 1e-10, {"displacement", "temperature"}),
        (".nas", 1e-10, {"displacement", "temperature"}),
    ],
)
def test_roundtrip_through_format(mesh_file, tmp_path, extension, tolerance, left_out):
    out = tmp_path / f"out{extension}"
    assert set(gearmesh.export_mesh(mesh_file, out)) == left_out
    back_file = tmp_path / "back.h5"
    gearmesh.import_mesh(out, back_file)
    mesh, back = gearmesh.read_mesh(mesh_file), gearmesh.read_mesh(back_file)
    assert np.array_equal(back["cells"]["hex8"], mesh["cells"]["hex8"])
    assert np.abs(back["points"] - mesh["points"]).max() <= tolerance * np.abs(mesh["points"]).max()
    # Nastran's sets are looked at in test_exports.py; meshio does not read them.
    for name in set() if extension in (".bdf", ".nas") else set(mesh["point_sets"]) - left_out:
        assert np.array_equal(back["point_sets"][name], mesh["point_sets"][name]), name
    for name in set(mesh["point_fields"]) - left_out:
        assert np.array_equal(back["point_fields"][name], mesh["point_fields"][name]), name
    # Another program reads the same.
    direct = meshio.gmsh.read(out) if extension == ".msh" else meshio.read(out)
    assert [(block.type, len(block.data)) for block in direct.cells] == [("hexahedron", 12)]
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted(["block.h5", "back.h5", out.name])


def test_an_xdmf_file_stands_alone(mesh_file, tmp_path):
    """Not with its numbers in out.h5, which may be a model's name and stays behind when the page is moved."""
    (tmp_path / "out.h5").write_text("a model")
    assert gearmesh.export_mesh(mesh_file, tmp_path / "out.xdmf") == []
    assert (tmp_path / "out.h5").read_text() == "a model"
    (tmp_path / "moved").mkdir()
    (tmp_path / "out.xdmf").rename(tmp_path / "moved/other.xdmf")
    gearmesh.import_mesh(tmp_path / "moved/other.xdmf", tmp_path / "back.h5")
    assert np.array_equal(gearmesh.read_mesh(tmp_path / "back.h5")["points"], block()[0])


def test_millimetres(mesh_file, tmp_path):
    out = tmp_path / "out.vtu"
    gearmesh.export_mesh(mesh_file, out, length_unit="mm")
    points = block()[0]
    assert np.allclose(meshio.read(out).points, points * 1e3, rtol=1e-15)
    gearmesh.import_mesh(out, tmp_path / "back.h5", length_unit="mm")
    assert np.allclose(gearmesh.read_mesh(tmp_path / "back.h5")["points"], points, rtol=1e-15, atol=1e-18)
    with pytest.raises(ValueError, match='"inch".*"m" and "mm"'):
        gearmesh.export_mesh(mesh_file, out, length_unit="inch")


def test_unknown_extension_lists_the_known(mesh_file, tmp_path):
    with pytest.raises(ValueError, match=r"\.bdf.*\.inp.*\.vtu"):
        gearmesh.export_mesh(mesh_file, tmp_path / "out.docx")
    with pytest.raises(ValueError, match=r"\.bdf.*\.inp.*\.vtu"):
        gearmesh.import_mesh(mesh_file, tmp_path / "out.h5")


def test_format_without_hexahedra_is_refused_and_leaves_nothing(mesh_file, tmp_path):
    for extension in (".stl", ".ply", ".obj"):
        with pytest.raises(ValueError, match="out" + extension):
            gearmesh.export_mesh(mesh_file, tmp_path / f"out{extension}")
    assert [p.name for p in tmp_path.iterdir()] == ["block.h5"]


def test_missing_files_and_folders(mesh_file, tmp_path):
    with pytest.raises(FileNotFoundError, match="none.vtu"):
        gearmesh.import_mesh(tmp_path / "none.vtu", tmp_path / "out.h5")
    with pytest.raises(FileNotFoundError, match="none.h5"):
        gearmesh.export_mesh(tmp_path / "none.h5", tmp_path / "out.vtu")
    with pytest.raises(OSError, match="none/out.vtu"):
        gearmesh.export_mesh(mesh_file, tmp_path / "none/out.vtu")


def test_damaged_files(mesh_file, tmp_path):
    whole = mesh_file.read_bytes()
    mesh_file.write_bytes(whole[:-100])
    with pytest.raises(ValueError, match="block.h5 is truncated"):
        gearmesh.read_mesh(mesh_file)
    (tmp_path / "broken.vtu").write_text("<VTKFile><nothing/>")
    with pytest.raises(ValueError, match="broken.vtu"):
        gearmesh.import_mesh(tmp_path / "broken.vtu", tmp_path / "out.h5")
    assert not (tmp_path / "out.h5").exists()


def test_an_edit_by_another_program_is_noticed(mesh_file):
    with h5py.File(mesh_file, "r+") as file:
        file["points"][0, 0] += 1e-9
    with pytest.raises(ValueError, match="altered"):
        gearmesh.read_mesh(mesh_file)


def test_import_checks_the_elements(tmp_path):
    points, hexes = block()
    mirrored = points * [1, 1, -1]
    cases = {
        "Jacobian": [("hexahedron", hexes)],
        "2 tetra cells; linear tetrahedra are far too stiff.*tetra10": [
            ("hexahedron", hexes), ("tetra", hexes[:2, [0, 1, 3, 4]])
        ],
        "1 pyramid cells; allowed are": [("pyramid", hexes[:1, [0, 1, 2, 3, 4]])],
        "both hex8 and tet10 elements": [("hexahedron", hexes), ("tetra10", hexes[:1, [0, 1, 3, 4, 5, 6, 7, 2, 2, 2]])],
        "no volume elements": [("quad", hexes[:, :4])],
    }
    for message, cells in cases.items():
        meshio.Mesh(mirrored if message == "Jacobian" else points, cells).write(tmp_path / "in.vtu")
        with pytest.raises(ValueError, match=message):
            gearmesh.import_mesh(tmp_path / "in.vtu", tmp_path / "out.h5")
    assert not (tmp_path / "out.h5").exists()


def test_import_joins_blocks_and_says_what_it_left_out(tmp_path):
    points, hexes = block()
    cells = [("hexahedron", hexes[:5]), ("quad", hexes[:3, :4]), ("hexahedron", hexes[5:])]
    energy = [np.arange(5.0), np.zeros(3), np.arange(5.0, 12.0)]
    meshio.Mesh(points, cells, cell_data={"energy": energy}).write(tmp_path / "in.vtu")
    assert gearmesh.import_mesh(tmp_path / "in.vtu", tmp_path / "out.h5") == ["3 quad cells"]
    mesh = gearmesh.read_mesh(tmp_path / "out.h5")
    assert np.array_equal(mesh["cells"]["hex8"], hexes)
    assert np.array_equal(mesh["cell_fields"]["energy"][:, 0], np.arange(12.0))


def mixed(quadratic):
    """Two hexahedra, the second cut in two wedges, by meshio's names; a node of no element in front."""
    points, hexes = block((2, 1, 1))
    cells = {"hex": hexes[:1], "wedge": hexes[1][[[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]]]}
    if quadratic:
        edges = {
            "hex": [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]],
            "wedge": [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
        }
        of = {kind: np.sort(cells[kind][:, ends], axis=-1) for kind, ends in edges.items()}
        every = np.unique(np.vstack([ends.reshape(-1, 2) for ends in of.values()]), axis=0)
        number = {tuple(edge): len(points) + k for k, edge in enumerate(every.tolist())}
        for kind, ends in of.items():
            middles = np.array([[number[tuple(edge)] for edge in element] for element in ends.tolist()])
            cells[kind] = np.hstack([cells[kind], middles])
        points = np.vstack([points, points[every].mean(axis=1)])
    points = np.vstack([[[9.0, 9.0, 9.0]], points])
    names = ("hexahedron20", "wedge15") if quadratic else ("hexahedron", "wedge")
    return points, [(name, cells[kind] + 1) for name, kind in zip(names, ("hex", "wedge"))]


# meshio writes no gmsh file of several kinds of elements.
@pytest.mark.parametrize("extension", [".vtu", ".vtk", ".inp"])
@pytest.mark.parametrize("quadratic", [False, True])
def test_hexahedra_and_wedges_go_through_formats(tmp_path, extension, quadratic):
    points, cells = mixed(quadratic)
    source = tmp_path / "in.vtu"
    meshio.Mesh(points, cells).write(source)
    assert gearmesh.import_mesh(source, tmp_path / "in.h5") == ["1 nodes of no volume element"]
    mesh = gearmesh.read_mesh(tmp_path / "in.h5")
    kinds = ["hex20", "wedge15"] if quadratic else ["hex8", "wedge6"]
    assert list(mesh["cells"]) == kinds
    for kind, (_, expected) in zip(kinds, cells):
        assert np.array_equal(mesh["cells"][kind], expected - 1)
    gearmesh.export_mesh(tmp_path / "in.h5", tmp_path / f"out{extension}")
    gearmesh.import_mesh(tmp_path / f"out{extension}", tmp_path / "back.h5")
    back = gearmesh.read_mesh(tmp_path / "back.h5")
    assert np.allclose(back["points"], mesh["points"], rtol=1e-13, atol=0.0)
    for kind in kinds:
        assert np.array_equal(back["cells"][kind], mesh["cells"][kind])
    # Wedges numbered as VTK's own program does it, the lower triangle the other way round.
    turn = [3, 4, 5, 0, 1, 2] + ([9, 10, 11, 6, 7, 8, 12, 13, 14] if quadratic else [])
    meshio.Mesh(points, [cells[0], (cells[1][0], cells[1][1][:, turn])]).write(source)
    gearmesh.import_mesh(source, tmp_path / "turned.h5")
    assert np.array_equal(gearmesh.read_mesh(tmp_path / "turned.h5")["cells"][kinds[1]], mesh["cells"][kinds[1]])


def test_sets_of_elements_become_sets_of_nodes(tmp_path):
    points, hexes = block()
    faces = hexes[:6, :4]  # below the first layer
    bottom = np.unique(faces)
    cells = [("hexahedron", hexes), ("quad", faces)]
    # gmsh 2.2: numbers of physical groups; their names in field_data.
    groups = [np.full(len(hexes), 1), np.full(len(faces), 2)]
    tags = {"gmsh:physical": groups, "gmsh:geometrical": groups}
    names = {"body": np.array([1, 3]), "bore": np.array([2, 2])}
    meshio.gmsh.write(tmp_path / "in.msh", meshio.Mesh(points, cells, cell_data=tags, field_data=names), "2.2", True)
    gearmesh.import_mesh(tmp_path / "in.msh", tmp_path / "out.h5")
    sets = gearmesh.read_mesh(tmp_path / "out.h5")["point_sets"]
    assert sets["bore"].tolist() == bottom.tolist()
    assert sets["body"].tolist() == list(range(len(points)))
    # Abaqus: *ELSET and *NSET.
    lines = ["*NODE"] + [f"{n + 1}, " + ", ".join(map(repr, map(float, p))) for n, p in enumerate(points)]
    lines += ["*ELEMENT, TYPE=C3D8"] + [f"{e + 1}, " + ", ".join(str(n + 1) for n in h) for e, h in enumerate(hexes)]
    lines += ["*ELSET, ELSET=two", "1, 2", "*NSET, NSET=three", "1, 2, 3"]
    (tmp_path / "in.inp").write_text("\n".join(lines) + "\n")
    gearmesh.import_mesh(tmp_path / "in.inp", tmp_path / "out.h5")
    sets = gearmesh.read_mesh(tmp_path / "out.h5")["point_sets"]
    assert sets["two"].tolist() == np.unique(hexes[:2]).tolist()
    assert sets["three"].tolist() == [0, 1, 2]


def test_write_mesh_refuses_nonsense(tmp_path):
    points, hexes = block()
    path = tmp_path / "bad.h5"
    for message, arguments in {
        "three are needed": (points[:, :2], hexes),
        "hex8 elements have 4 nodes; 8 are needed": (points, hexes[:, :4]),
        "indices start at 0": (points, hexes - 1),
        "refers to node": (points, hexes + 100),
        "finite": (np.where(points == points.max(), np.nan, points), hexes),
    }.items():
        with pytest.raises(ValueError, match=message):
            gearmesh.write_mesh(path, arguments[0], {"hex8": arguments[1]})
    with pytest.raises(ValueError, match='"brick"; allowed are hex8, hex20, tet10, wedge6, wedge15'):
        gearmesh.write_mesh(path, points, {"brick": hexes})
    assert not path.exists()


@pytest.fixture(scope="module")
def reduced(tmp_path_factory):
    path = tmp_path_factory.mktemp("reduced") / "gear.h5"
    mesh = dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, axial_mm=5.0)
    gauge = dict(name="root", tooth=0, side="right", length_mm=1.0, width_mm=5.0)
    numbers = dict(reduction=dict(slices=3, roll_stations=4, flanks=["right", "left"]), mesh=mesh, gauge=[gauge])
    gear = gearmesh.Gear("g", teeth=23, module_mm=3, face_width_mm=20, bore_diameter_mm=25, material=gearmesh.STEEL, **numbers)
    gear.reduce(path, error_estimate=False, progress=False)
    return path


@pytest.fixture
def reduced_file(reduced, tmp_path):
    return Path(shutil.copy(reduced, tmp_path))


def test_read_reduced_agrees_with_h5py(reduced_file):
    gear = gearmesh.read_reduced(reduced_file)
    with h5py.File(reduced_file) as file:
        assert file.attrs["format"] == "gearmesh reduced gear"
        assert file.attrs["software"] == "gearmesh"
        c_hub = file["compliance/c_hub"]
        assert np.array_equal(gear["c_hub"], c_hub[...])
        assert c_hub.attrs["unit"] == "m/N" and c_hub.attrs["unitSI"] == 1.0
        assert len(c_hub.attrs["axisLabels"]) == c_hub.ndim
        assert np.array_equal(gear["c_tooth"], file["compliance/c_tooth"][...])
        assert np.array_equal(gear["roll_angles_rad"], file["grid/roll_angles"][...])
        assert gear["teeth"] == file["gear/teeth"][()]
        assert gear["input_toml"] == file["gear/input_toml"].asstr()[()]
        for index, gauge in enumerate(gear["gauges"]):
            group = file[f"gauges/{index}"]
            assert gauge["name"] == group["name"].asstr()[()]
            assert np.array_equal(gauge["adjoint"], group["adjoint"][...])
            assert np.array_equal(gauge["own_tooth"], group["own_tooth"][...])
        # Every number says what it is.
        arrays = []
        file.visititems(lambda name, item: arrays.append(item) if isinstance(item, h5py.Dataset) else None)
        for array in arrays:
            if array.dtype.kind in "fu":
                assert {"unit", "unitSI", "description", "frame"} <= set(array.attrs), array.name
        stages = gear["provenance"]["stage_seconds"]
        stored = file["provenance/stage"]
        assert stages == [(stored[f"{k}/name"].asstr()[()], stored[f"{k}/value"][()]) for k in range(len(stored))]
        checks = {check["name"].asstr()[()]: check["value"][()] for check in file["checks"].values()}
        assert gear["checks"] == checks and len(checks) > 1
    # One tooth that represents all, its flanks, teeth, their flanks; four stations by three slices, each with a point at its
    # ends and one in its middle.
    assert gear["c_hub"].shape == (1, 2, 23, 2, 28, 28)
    assert gear["flanks"] == ["right", "left"]
    assert stages[0][0] == "mesh" and all(seconds >= 0.0 for _, seconds in stages)


def test_read_reduced_errors(reduced_file, mesh_file, tmp_path):
    with pytest.raises(ValueError, match="gearmesh mesh"):
        gearmesh.read_reduced(mesh_file)
    with pytest.raises(FileNotFoundError) as raised:
        gearmesh.read_reduced(tmp_path / "none.h5")
    assert "none.h5" in str(raised.value)
    content = bytearray(reduced_file.read_bytes())
    content[len(content) // 2] ^= 1
    Path(reduced_file).write_bytes(content)
    with pytest.raises(ValueError, match="altered or damaged"):
        gearmesh.read_reduced(reduced_file)


def test_devices_are_not_replaced():
    points, hexes = block()
    with pytest.raises(ValueError, match="not a regular file"):
        gearmesh.write_mesh("/dev/null", points, {"hex8": hexes})
    assert Path("/dev/null").is_char_device()
