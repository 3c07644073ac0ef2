"""Stiffness, mass, displacements, strains and natural modes against scikit-fem and against one element written out in NumPy.

The other side shares no code with the Rust one: scikit-fem assembles the plain brick and the twenty-node brick, the
NumPy functions of `incompatible_brick.py` the brick with incompatible modes. All sides use the same Gauss rule, 2x2x2
points with eight nodes and 3x3x3 with twenty, so what is left is rounding: 1e-16 an operation, times the condition
number of K (1.7e3 with eight nodes) in a displacement. 1e-10 stands above both.
"""

import numpy as np
import pytest

import gearmesh
from distorted_bodies import POISSON, YOUNG_PA, Body, QuadraticBody, TetrahedralBody
from incompatible_brick import incompatible_stiffness, incompatible_strain
from scikit_fem_elements import ScikitFem, ScikitFem20, ScikitFemTet

TOLERANCE = 1e-10


@pytest.fixture(scope="module")
def body(tmp_path_factory):
    return Body(tmp_path_factory.mktemp("skfem") / "block.h5")


@pytest.fixture(scope="module")
def quadratic_body(tmp_path_factory):
    return QuadraticBody(tmp_path_factory.mktemp("skfem20") / "block.h5")


def entrywise(found, expected):
    """Largest difference of two matrices relative to the largest entry."""
    return abs(found - expected).max() / abs(expected).max()


def in_norm(found, expected):
    """Norm of the difference relative to the norm."""
    return np.linalg.norm(found - expected) / np.linalg.norm(expected)


def test_tet10_stiffness_and_displacement_are_those_of_scikit_fem(tmp_path):
    body = TetrahedralBody(tmp_path / "block.h5")
    fem = ScikitFemTet(body)
    assert len(body.tets) == 360
    assert entrywise(body.stiffness("tet10"), fem.stiffness()) < TOLERANCE
    assert in_norm(body.solve("tet10"), body.displacement_by_scipy(fem.stiffness())) < TOLERANCE


def test_hex8_stiffness_is_that_of_scikit_fem(body):
    assert entrywise(body.stiffness("hex8"), ScikitFem(body).stiffness()) < TOLERANCE


def test_hex8_displacement_is_that_of_scikit_fem(body):
    displacement = body.solve("hex8")
    assert in_norm(displacement, body.displacement_by_scipy(ScikitFem(body).stiffness())) < TOLERANCE
    assert not displacement[body.held].any()


def test_hex8_strain_at_the_centres_is_that_of_scikit_fem(body):
    fem = ScikitFem(body)
    displacement = body.displacement_by_scipy(fem.stiffness())
    expected = fem.centre_strain(displacement)
    assert expected.shape == (len(body.hexes), 6)
    assert in_norm(body.strain("hex8", displacement), expected) < TOLERANCE
    # The whole chain: our displacement, our strain.
    assert in_norm(body.strain("hex8", body.solve("hex8")), expected) < TOLERANCE


def test_incompatible_stiffness_is_that_of_taylor_beresford_wilson(body):
    k = body.stiffness("hex8-incompatible")
    assert entrywise(k, incompatible_stiffness(body)) < TOLERANCE
    # The two elements are far apart: a mix-up could not pass.
    assert entrywise(k, body.stiffness("hex8")) > 1e-2


def test_incompatible_displacement_is_that_of_taylor_beresford_wilson(body):
    expected = body.displacement_by_scipy(incompatible_stiffness(body))
    assert in_norm(body.solve("hex8-incompatible"), expected) < TOLERANCE
    assert in_norm(body.solve("hex8"), expected) > 1e-2


@pytest.mark.parametrize("natural", [(0.0, 0.0, 0.0), (0.3, -0.8, 0.5), (1.0, -1.0, 1.0)])
def test_incompatible_strain_is_that_of_taylor_beresford_wilson(body, natural):
    displacement = body.solve("hex8-incompatible")
    expected = incompatible_strain(body, displacement, natural)
    assert in_norm(body.strain("hex8-incompatible", displacement, natural), expected) < TOLERANCE


def test_hex20_stiffness_is_that_of_scikit_fem(quadratic_body):
    body = quadratic_body
    assert body.points.shape[0] == 119 + 1 + 286 and len(body.hexes) == 60
    assert entrywise(body.stiffness("hex20"), ScikitFem20(body).stiffness()) < TOLERANCE


def test_hex20_displacement_is_that_of_scikit_fem(quadratic_body):
    body = quadratic_body
    displacement = body.solve("hex20")
    assert in_norm(displacement, body.displacement_by_scipy(ScikitFem20(body).stiffness())) < TOLERANCE
    assert not displacement[body.held].any()


def test_hex20_strain_at_the_centres_is_that_of_scikit_fem(quadratic_body):
    body = quadratic_body
    fem = ScikitFem20(body)
    displacement = body.displacement_by_scipy(fem.stiffness())
    assert in_norm(body.strain("hex20", displacement), fem.centre_strain(displacement)) < TOLERANCE
    assert in_norm(body.strain("hex20", body.solve("hex20")), fem.centre_strain(displacement)) < TOLERANCE


def test_a_mesh_of_twenty_nodes_comes_back(quadratic_body):
    read = gearmesh.read_mesh(quadratic_body.path)
    assert np.array_equal(read["cells"]["hex20"], quadratic_body.hexes)


def test_an_element_takes_its_own_number_of_nodes(body, quadratic_body):
    with pytest.raises(ValueError, match="the elements hex8; hex20 is not among them"):
        body.stiffness("hex20")
    with pytest.raises(ValueError, match="the elements hex20; hex8 is not among them"):
        quadratic_body.stiffness("hex8")


@pytest.mark.parametrize("element", ["hex8", "hex20"])
def test_mass_and_natural_modes_are_those_of_scikit_fem(body, quadratic_body, element):
    body, fem_of = (body, ScikitFem) if element == "hex8" else (quadratic_body, ScikitFem20)
    fem, count = fem_of(body), 12
    m = fem.mass()
    assert entrywise(body.mass(element), m) < TOLERANCE
    expected, expected_shapes = body.modes_by_scipy(fem.stiffness(), m, count)
    frequencies, shapes, residuals = body.natural_modes(element, count)
    assert np.abs(frequencies / expected - 1.0).max() < 1e-8
    # The search stops at 1e-10 in the mass norm; the residual weighs what is left with the square of its frequency.
    assert residuals.max() < 1e-8
    assert not shapes[:, body.held].any()
    # Modal mass 1, and the same shapes but for the sign.
    overlap = shapes.reshape(count, -1) @ (m @ expected_shapes.T)
    assert np.abs(np.abs(overlap) - np.eye(count)).max() < 1e-6


def test_incompatible_modes_carry_no_mass(body):
    assert entrywise(body.mass("hex8-incompatible"), body.mass("hex8")) == 0.0
    # Softer with the same mass: every frequency is lower.
    assert (body.natural_modes("hex8-incompatible", 6)[0] < body.natural_modes("hex8", 6)[0]).all()


def test_the_default_element_has_incompatible_modes(body):
    data = gearmesh.stiffness(body.path, YOUNG_PA, POISSON)[0]
    assert np.array_equal(data, gearmesh.stiffness(body.path, YOUNG_PA, POISSON, "hex8-incompatible")[0])


def test_forces_in_any_memory_order(body):
    expected = body.solve("hex8")
    found = gearmesh.solve(body.path, YOUNG_PA, POISSON, "hex8", body.held.tolist(), np.asfortranarray(body.force))
    assert in_norm(found, expected) < TOLERANCE


def test_unknown_element_is_refused(body):
    with pytest.raises(ValueError, match='"hex9".*"hex8", "hex8-incompatible", "hex20"'):
        gearmesh.stiffness(body.path, YOUNG_PA, POISSON, "hex9")
    with pytest.raises(ValueError, match='"hex9".*"hex8", "hex8-incompatible", "hex20"'):
        gearmesh.solve(body.path, YOUNG_PA, POISSON, "hex9", body.held, body.force)
    with pytest.raises(ValueError, match='"hex9".*"hex8", "hex8-incompatible", "hex20"'):
        gearmesh.strain(body.path, YOUNG_PA, POISSON, "hex9", body.force)


def test_wrong_input_is_refused(body, tmp_path):
    solve = lambda held, force: gearmesh.solve(body.path, YOUNG_PA, POISSON, "hex8", held, force)
    with pytest.raises(FileNotFoundError):
        gearmesh.stiffness(tmp_path / "none.h5", YOUNG_PA, POISSON)
    with pytest.raises(ValueError, match="Poisson's ratio is 0.5"):
        gearmesh.stiffness(body.path, YOUNG_PA, 0.5)
    with pytest.raises(ValueError, match="not held against all six rigid motions"):
        solve([], body.force)
    for node in (-1, len(body.points), 2**62):
        with pytest.raises(ValueError, match=f"node {node} is to be held; the mesh has the nodes 0 to 119"):
            solve([node], body.force)
    with pytest.raises(ValueError, match=r"force has the shape \[119, 3\]; the mesh needs \[120, 3\]"):
        solve(body.held, body.force[1:])
    with pytest.raises(ValueError, match="force of node 7 is NaN"):
        force = body.force.copy()
        force[7, 2] = np.nan
        solve(body.held, force)
    with pytest.raises(ValueError, match="density is 0"):
        gearmesh.mass(body.path, 0.0)
    with pytest.raises(ValueError, match="0 natural modes were asked for; the model has 300 unknowns"):
        body.natural_modes("hex8", 0)
    with pytest.raises(ValueError, match="from -1 to 1"):
        body.strain("hex8", body.force, (0.0, 1.1, 0.0))
