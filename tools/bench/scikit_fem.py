"""The gear by scikit-fem and a direct solver: scikit_fem.py MESH.vtu LOADS {pardiso,superlu}. Prints JSON.

Plain trilinear hexahedra, which couple the same degrees of freedom as the project's default element. The factorisation
is one of a symmetric positive definite matrix with Pardiso, an unsymmetric one with SuperLU, which has no other.
"""

import json
import sys
import time

import numpy as np
import skfem
from gear_mesh import POISSON, YOUNG_PA, GearMesh
from skfem.io.meshio import HEX_MAPPING
from skfem.models.elasticity import lame_parameters, linear_elasticity

BLOCK = 64  # right-hand sides that are solved together, as in the project
SUPERLU_MOST_DOFS = 200_000  # its fill is several times Pardiso's and it uses one core
RESIDUAL_ALLOWED = 1e-9


def pardiso(stiffness):
    """Factorises; returns a function that solves for columns."""
    import pypardiso
    import scipy.sparse

    upper = scipy.sparse.triu(stiffness, format="csr")
    solver = pypardiso.PyPardisoSolver(mtype=2)
    solver._check_A(upper)  # sets the storage format
    solver.set_phase(12)
    solver._call_pardiso(upper, np.zeros((upper.shape[0], 1)))
    # Its public `solve` would compare the whole matrix with the factorised one, block after block.
    solver.set_phase(33)
    # By default it refines every solution twice, which takes three times as long; the residual is checked below
    # instead.
    solver.set_iparm(8, 0)
    return lambda columns: solver._call_pardiso(upper, columns)


def superlu(stiffness):
    """Factorises; returns a function that solves for columns."""
    import scipy.sparse.linalg

    count = stiffness.shape[0]
    if count > SUPERLU_MOST_DOFS:
        raise SystemExit(f"SuperLU is not tried with more than {SUPERLU_MOST_DOFS} degrees of freedom ({count} here)")
    options = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    return scipy.sparse.linalg.splu(stiffness.tocsc(), **options).solve


def main() -> None:
    path, load_count, solver = sys.argv[1], int(sys.argv[2]), {"pardiso": pardiso, "superlu": superlu}[sys.argv[3]]
    stages = []
    clock = time.perf_counter()

    def lap(stage: str) -> None:
        nonlocal clock
        now = time.perf_counter()
        stages.append({"stage": stage, "seconds": now - clock})
        clock = now

    gear = GearMesh(path)
    lap("reading")
    mesh = skfem.MeshHex1(gear.points.T, gear.hexahedra[:, HEX_MAPPING[:8]].T)
    # Order 3 is the 2 x 2 x 2 Gauss rule.
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementHex1()), intorder=3)
    whole = linear_elasticity(*lame_parameters(YOUNG_PA, POISSON)).assemble(basis)
    free = basis.complement_dofs(basis.nodal_dofs[:, gear.bore].ravel())
    stiffness = whole[free][:, free].tocsr()
    nodal_dofs = basis.nodal_dofs
    free_of = np.full(basis.N, -1)
    free_of[free] = np.arange(len(free))
    del whole, basis  # gigabytes that the factorisation has no use for
    lap("assembly")
    solve = solver(stiffness)
    lap("factor")
    rows = [free_of[nodal_dofs[axis, node]] for node, axis in gear.loads(load_count)]
    first = None
    for start in range(0, load_count, BLOCK):
        block = rows[start : start + BLOCK]
        columns = np.zeros((len(free), len(block)), order="F")
        columns[block, np.arange(len(block))] = 1.0
        solution = solve(columns)
        if first is None:
            first = solution[:, 0].copy()
    lap("solve")
    residual = stiffness @ first
    residual[rows[0]] -= 1.0
    worst = float(np.linalg.norm(residual))
    if not worst <= RESIDUAL_ALLOWED:
        raise SystemExit(f"the solution leaves {worst:.1e} of the unit load, allowed is {RESIDUAL_ALLOWED:.0e}")
    print(json.dumps({"dofs": len(free), "loads": load_count, "residual": worst, "stage_seconds": stages}))


if __name__ == "__main__":
    main()
