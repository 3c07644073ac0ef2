"""Every format that `gearmesh mesh` writes, read by another program: gmsh, CalculiX and VTK where they read it, meshio in any case.

What is compared is the volume: it is wrong as soon as a node, the order of an element's nodes or the unit is.
"""

import shutil
import subprocess

import gmsh
import meshio
import numpy as np
import pytest

import gearmesh

# (a, b, c): edges and skew; determinant of the map from the unit cube.
MAP = np.array([[0.03, 0.004, 0.0], [0.0, 0.021, 0.003], [0.005, 0.0, 1.0 / 70.0]])
# About the origin: negative coordinates are longer in a text file.
CENTRE = np.array([0.4, 0.6, 0.55])
VOLUME_M3 = abs(np.linalg.det(MAP))
EDGES = {
    "hex20": [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]],
    "tet10": [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]],
}
# A cube in six tetrahedra along its diagonal 0-6.
TETRAHEDRA = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
KINDS = {"hex8": ("hexahedron", "C3D8"), "hex20": ("hexahedron20", "C3D20"), "tet10": ("tetra10", "C3D10")}
FORMATS = [".bdf", ".inp", ".msh", ".nas", ".vtk", ".vtu", ".xdmf", ".xmf"]


def brick(kind):
    """A skewed brick of 3 x 2 x 2 cells: points, elements."""
    nx, ny, nz = 3, 2, 2
    index = lambda i, j, k: i + (nx + 1) * (j + (ny + 1) * k)
    points = [[i / nx, j / ny, k / nz] for k in range(nz + 1) for j in range(ny + 1) for i in range(nx + 1)]
    cells = np.array([
        [index(i + a, j + b, k + c) for c in (0, 1) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
        for k in range(nz) for j in range(ny) for i in range(nx)
    ])
    if kind == "tet10":
        cells = cells[:, TETRAHEDRA].reshape(-1, 4)
    points = np.array(points)
    if kind in EDGES:
        ends = np.sort(cells[:, EDGES[kind]], axis=-1)
        every, place = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
        cells = np.hstack([cells, len(points) + place.reshape(len(cells), -1)])
        points = np.vstack([points, points[every].mean(axis=1)])
    return (points - CENTRE) @ MAP.T, cells


@pytest.fixture(params=KINDS)
def body(request, tmp_path):
    points, cells = brick(request.param)
    sets = {"bore": np.flatnonzero(points[:, 2] <= np.quantile(points[:, 2], 0.2)), "tooth0_right_flank": [0, len(points) - 1]}
    gearmesh.write_mesh(tmp_path / "body.h5", points, {request.param: cells}, point_sets=sets)
    return tmp_path / "body.h5", request.param, points, cells


def gmsh_volume(path):
    """Sum of the volumes of all elements that gmsh finds, and how many there are."""
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        _, tags, _ = gmsh.model.mesh.getElements(3)
        return sum(gmsh.model.mesh.getElementQualities(block, "volume").sum() for block in tags), sum(map(len, tags))
    finally:
        gmsh.finalize()


@pytest.mark.parametrize("extension", [".bdf", ".msh", ".nas"])
def test_gmsh_reads_it(body, tmp_path, extension):
    file, _, _, cells = body
    out = tmp_path / f"out{extension}"
    gearmesh.export_mesh(file, out)
    volume, count = gmsh_volume(out)
    assert count == len(cells)
    assert volume == pytest.approx(VOLUME_M3, rel=1e-8)


@pytest.mark.parametrize("unit", ["m", "mm"])
@pytest.mark.parametrize("extension", FORMATS)
def test_meshio_reads_it(body, tmp_path, extension, unit):
    file, kind, points, cells = body
    out = tmp_path / f"out{extension}"
    gearmesh.export_mesh(file, out, length_unit=unit)
    mesh = meshio.gmsh.read(out) if extension == ".msh" else meshio.read(out)
    assert [(block.type, len(block.data)) for block in mesh.cells] == [(KINDS[kind][0], len(cells))]
    expected = points * {"m": 1.0, "mm": 1e3}[unit]
    assert np.abs(mesh.points - expected).max() <= 1e-10 * np.abs(expected).max()
    assert np.array_equal(mesh.cells[0].data, cells)
    # Nothing beside it, so that it can be moved.
    assert sorted(path.name for path in tmp_path.iterdir()) == ["body.h5", out.name]


def test_nodes_of_a_nastran_set(body, tmp_path):
    """SET1, which neither meshio nor gmsh reads: eight columns a field, `+` where a card goes on."""
    file, _, points, _ = body
    gearmesh.export_mesh(file, tmp_path / "out.bdf")
    lines = (tmp_path / "out.bdf").read_text().splitlines()
    assert max(map(len, lines)) <= 80
    for name in ("bore", "tooth0_right_flank"):
        [first] = [k for k, line in enumerate(lines) if line.startswith("$ set") and line.endswith(f": {name}")]
        fields, k = [], first + 1
        while lines[k].startswith(("SET1" if k == first + 1 else "+")):
            fields += [lines[k][at:at + 8].strip() for at in range(8, min(len(lines[k]), 72), 8)]
            k += 1
        nodes = [int(field) - 1 for field in fields[1:] if field]
        assert nodes == gearmesh.read_mesh(file)["point_sets"][name].tolist()


@pytest.mark.skipif(shutil.which("ccx") is None, reason="CalculiX is not installed")
@pytest.mark.parametrize("incompatible", [False, True])
def test_calculix_computes_with_it(body, tmp_path, incompatible):
    """A bar under its own stretch: every node moves as an affine map says, and CalculiX finds volume and stress."""
    file, kind, points, cells = body
    gearmesh.export_mesh(file, tmp_path / "body.inp", incompatible_modes=incompatible)
    element = "C3D8I" if incompatible and kind == "hex8" else KINDS[kind][1]
    assert f"*ELEMENT, TYPE={element}, ELSET=body" in (tmp_path / "body.inp").read_text()
    young, poisson, strain = 2.0e11, 0.3, 1e-4
    free = "\n".join(f"{n + 1}, 1, 1, {strain * points[n, 0]:.12e}" for n in range(len(points)))
    (tmp_path / "deck.inp").write_text(
        f"*INCLUDE, INPUT=body.inp\n*MATERIAL, NAME=steel\n*ELASTIC\n{young}, {poisson}\n"
        "*SOLID SECTION, ELSET=body, MATERIAL=steel\n*BOUNDARY\nbore, 2, 3\n*STEP\n*STATIC\n*BOUNDARY\n"
        f"{free}\n" + "\n".join(f"{n + 1}, 2, 3" for n in range(len(points))) + "\n"
        "*EL PRINT, ELSET=body, TOTALS=ONLY\nEVOL\n*EL PRINT, ELSET=body\nS\n*END STEP\n"
    )
    run = subprocess.run(["ccx", "deck"], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout
    volume, stress = (tmp_path / "deck.dat").read_text().split(" stresses ")
    assert float(volume.split()[-1]) == pytest.approx(VOLUME_M3, rel=1e-6)
    rows = np.array([line.split() for line in stress.splitlines()[1:] if line.strip()], float)
    # All strain along x: λ + 2 G, and λ across.
    lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    assert rows[:, 2] == pytest.approx((lame + young / (1 + poisson)) * strain, rel=1e-5)
    assert rows[:, 3] == pytest.approx(lame * strain, rel=1e-5)


@pytest.mark.parametrize("extension", [".vtk", ".vtu", ".xdmf"])
def test_vtk_reads_it(body, tmp_path, extension):
    """Where VTK is installed; it is not among the project's packages."""
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import vtk_to_numpy
    file, _, points, cells = body
    out = tmp_path / f"out{extension}"
    gearmesh.export_mesh(file, out)
    readers = {".vtk": vtk.vtkUnstructuredGridReader, ".vtu": vtk.vtkXMLUnstructuredGridReader, ".xdmf": vtk.vtkXdmfReader}
    reader = readers[extension]()
    reader.SetFileName(str(out))
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    assert grid.GetNumberOfCells() == len(cells)
    assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), points)
    sizes = vtk.vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    volumes = vtk_to_numpy(sizes.GetOutput().GetCellData().GetArray("Volume"))
    assert abs(volumes.sum()) == pytest.approx(VOLUME_M3, rel=1e-8)
    assert grid.GetPointData().GetArray("set:bore") is not None


def test_other_formats_are_refused_with_those_that_are_written(tmp_path):
    points, cells = brick("hex8")
    gearmesh.write_mesh(tmp_path / "body.h5", points, {"hex8": cells})
    for extension in (".cgns", ".med", ".ugrid", ".stl", ".e", ".mesch"):
        with pytest.raises(ValueError, match=r"allowed are \.bdf \.inp \.msh \.nas \.vtk \.vtu \.xdmf \.xmf$"):
            gearmesh.export_mesh(tmp_path / "body.h5", tmp_path / f"out{extension}")
    assert [path.name for path in tmp_path.iterdir()] == ["body.h5"]
