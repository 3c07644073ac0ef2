"""Rings with a groove on a seat, axisymmetric by scikit-fem, beside the cylinders of crates/bearings/src/fit.rs.

Prints, for rings of ball bearings with shoulders of 0.17 to 0.25 ball diameters, the change of the groove's bottom by an interference over that of the
cylinder whose surface is the groove's bottom, and the same of the pressure. Run: python tools/reference/groove_ring.py
"""

import numpy as np
from skfem import BilinearForm, ElementQuad2, ElementVector, FacetBasis, LinearForm, MeshQuad, Basis, condense, solve
from skfem.helpers import ddot, sym_grad

YOUNG, POISSON = 206e9, 0.3
LAME = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON)
SHEAR = 0.5 * YOUNG / (1 + POISSON)
MM = 1e-3


@BilinearForm
def stiffness(u, v, w):
    r = w.x[0]
    eu, ev = sym_grad(u), sym_grad(v)
    hoop_u, hoop_v = u[0] / r, v[0] / r
    trace = (eu[0, 0] + eu[1, 1] + hoop_u) * (ev[0, 0] + ev[1, 1] + hoop_v)
    return (LAME * trace + 2 * SHEAR * (ddot(eu, ev) + hoop_u * hoop_v)) * r


@LinearForm
def pressure(v, w):
    return v[0] * w.x[0]


def under_pressure(ball, pitch, conformity, width, seat, side, shoulder, cells=(24, 120)):
    """Radial displacements of the groove's bottom and, mean over the width, of the seat by 1 Pa; and those of the cylinder."""
    bottom = 0.5 * (pitch - side * ball)
    radius = conformity * ball
    mesh = MeshQuad.init_tensor(np.linspace(0, 1, cells[0] + 1), np.linspace(-width / 2, width / 2, cells[1] + 1))
    share, z = mesh.p
    depth = radius - np.sqrt(np.maximum(radius**2 - z**2, 0))
    surface = bottom + side * np.minimum(np.where(np.abs(z) < radius, depth, np.inf), shoulder * ball)
    mesh = MeshQuad(np.vstack([seat / 2 + share * (surface - seat / 2), z]), mesh.t)
    basis = Basis(mesh, ElementVector(ElementQuad2()), intorder=4)
    on_seat = np.abs(mesh.p[0] - seat / 2) < 1e-9
    facets = mesh.facets_satisfying(lambda x: np.abs(x[0] - seat / 2) < 1e-9, boundaries_only=True)
    load = side * pressure.assemble(FacetBasis(mesh, ElementVector(ElementQuad2()), facets=facets, intorder=4))
    held = basis.nodal_dofs[1, np.argmin((mesh.p[0] - seat / 2) ** 2 + mesh.p[1] ** 2)]
    u = solve(*condense(stiffness.assemble(basis), load, D=np.array([held])))
    middle = np.argmin((mesh.p[0] - bottom) ** 2 + mesh.p[1] ** 2)
    found = u[basis.nodal_dofs[0, middle]], u[basis.nodal_dofs[0, on_seat]].mean()
    d, f = seat, 2 * bottom
    section = abs(f * f - d * d)
    cylinder = side * f * d * d / section / YOUNG, side * d / 2 / YOUNG * ((f * f + d * d) / section + side * POISSON)
    return found, cylinder


def held_by(seat, far, side, young):
    """Displacement of the seat's own surface by 1 Pa."""
    a, b = min(seat, far), max(seat, far)
    return seat / 2 / young * ((b * b + a * a) / (b * b - a * a) - side * POISSON)


RINGS = {
    "6205 inner": (7.938, 39.04, 0.52, 15.0, 25.0, 1),
    "6308 inner": (15.06, 65.0, 0.52, 23.0, 40.0, 1),
    "7010 inner": (8.731, 65.0, 0.52, 16.0, 50.0, 1),
    "6205 outer": (7.938, 39.04, 0.53, 15.0, 52.0, -1),
    "6308 outer": (15.06, 65.0, 0.53, 23.0, 90.0, -1),
}

if __name__ == "__main__":
    for name, (ball, pitch, conformity, width, seat, side) in RINGS.items():
        for shoulder in (0.17, 0.25):
            lengths = [MM * ball, MM * pitch, conformity, MM * width, MM * seat]
            (race, own), (race_c, own_c) = under_pressure(*lengths, side, shoulder)
            seats = [(0.0, YOUNG), (0.5, YOUNG)] if side > 0 else [(100.0, YOUNG), (1.3, YOUNG), (1.3, 70e9)]
            for far, young in seats:
                held = held_by(MM * seat, far * MM * seat, side, young)
                growth = (race / (abs(own) + held)) / (race_c / (abs(own_c) + held))
                pressed = (abs(own_c) + held) / (abs(own) + held)
                print(f"{name}, shoulder {shoulder} D, seat {far} d, {young / 1e9:.0f} GPa: raceway {100 * (growth - 1):+.1f} %, pressure {100 * (pressed - 1):+.1f} %")
