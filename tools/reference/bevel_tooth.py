"""Deflection of a spiral bevel tooth under patch loads: `reference/bevel_tooth/compliance.csv`.

The gear of fe_models/bevel_20_20.toml with a bore of 34 mm, held there. Of it the points of the tooth's surface are taken (`surface.csv`, written by the ignored test of
crates/mesh/tests/verification/bevel_gears.rs) and the drawing of the blank; all else is done anew: gmsh's triangles in one section, moved from section to section by Laplace's equation,
split into ten-node tetrahedra with straight edges, scikit-fem's stiffness, conjugate gradients.

The whole ring is solved with coarse tetrahedra. What finer ones change is found on the loaded tooth and one on either side, where body and neighbours are cut off, and added:
deflection = ring, coarse + (three teeth, fine - three teeth, coarse).

    python bevel_tooth.py solve SURFACE.csv --every 6 --thin 6 --size 2.4 --sectors 20 -o ring.csv
    python bevel_tooth.py solve SURFACE.csv --every 6 --thin 6 --size 2.4 --sectors 3 -o coarse.csv
    python bevel_tooth.py solve SURFACE.csv --every 2 --thin 3 --size 1.0 --sectors 3 -o fine.csv
    python bevel_tooth.py combine ring.csv coarse.csv fine.csv -o ../../reference/bevel_tooth/compliance.csv

Loads are those of the flank grid with five stations up the flank and five along it: density h_i(u) h_j(s)/g(s) per area, g the flank's area per unit of s, along the normal, 1 N in
all. A row is the deflection, weighted as the second load, under the first.
"""

import argparse
import math

import gmsh
import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as sla
import skfem
from skfem.models.elasticity import lame_parameters, linear_elasticity

YOUNG_PA, POISSON = 206e9, 0.3
TEETH, MODULE_M, FACE_M, PITCH = 20, 3.5e-3, 15e-3, math.pi / 4
BORE_M = 17e-3
OUTER_CONE = 0.5 * MODULE_M * TEETH / math.sin(PITCH)
INNER_CONE = OUTER_CONE - FACE_M
# Equal members: addendum 0.85 m, dedendum the rest of the whole depth 1.888 m; standard taper.
DEDENDUM = (1.888 - 0.85) * MODULE_M
RIM_M = 1.888 * MODULE_M
STATIONS = np.linspace(0.0, 1.0, 5)
PAIRS = [((2, 2), (2, 2)), ((2, 2), (3, 1)), ((2, 2), (1, 3)), ((3, 1), (3, 1)), ((3, 1), (3, 3)), ((3, 1), (1, 2))]


def cone(s):
    return INNER_CONE + FACE_M * s


def dedendum(s):
    return DEDENDUM * cone(s) / OUTER_CONE


def meridian(s, y):
    """Radius and z of a height above the pitch cone; below the rim along the straight lines to the bore."""
    at = lambda length, h: np.array([length * np.sin(PITCH) + h * np.cos(PITCH), length * np.cos(PITCH) - h * np.sin(PITCH)])
    bottom = -dedendum(s) - RIM_M
    if y >= bottom - 1e-12:
        return at(cone(s), y)
    share = (bottom - y) / depth_below()
    ends = []
    for end in (0.0, 1.0):
        rim = at(cone(end), -dedendum(end) - RIM_M)
        ends.append(rim + share * (np.array([BORE_M, rim[1]]) - rim))
    return ends[0] + s * (ends[1] - ends[0])


def depth_below():
    """What the body below the rim counts as height in the plane of the triangles."""
    return 4e-3


def read(path, every, thin):
    rows = np.genfromtxt(path, delimiter=",", comments="#", skip_header=2)
    sections = np.unique(rows[:, 0]).astype(int)[::every]
    lines = {}
    for section in sections:
        for side in (0, 1):
            line = rows[(rows[:, 0] == section) & (rows[:, 1] == side)][:, 2:]
            # Fewer points on fillet and flank, whose 48 pieces stand last; the tip is kept.
            foot = len(line) - 1 - 48
            lines[section, side] = line[list(range(foot)) + list(range(foot, len(line), thin))]
    return sections, lines


def plane(points):
    """(azimuth, height) of points."""
    radius = np.hypot(points[:, 0], points[:, 1])
    height = -points[:, 2] * math.sin(PITCH) + radius * math.cos(PITCH)
    return np.column_stack([np.arctan2(points[:, 1], points[:, 0]), height])


def boundary(right, left, s, size):
    """Corner loop of the sector in the plane (x along the pitch circle, y height): nodes, and what each piece is."""
    scale = cone(s) * math.sin(PITCH)
    r, l = plane(right[:, 2:]), plane(left[:, 2:])
    middle = 0.5 * (r[0, 0] + l[0, 0])
    to_plane = lambda p: np.column_stack([scale * (p[:, 0] - middle), p[:, 1]])
    r, l = to_plane(r), to_plane(l)
    bottom = -dedendum(s) - RIM_M
    n_side = max(4, round(6.0 / size))
    n_low = max(2, round(3.0 / size))
    half = r[0, 0]
    upper = np.linspace(r[0, 1], bottom, n_side + 1)[1:]
    lower = np.linspace(bottom, bottom - depth_below(), n_low + 1)[1:]
    ys = np.concatenate([upper, lower])
    n_bore = max(4, round(5.0 / size))
    tip = np.linspace(r[-1], l[-1], max(4, round(4.0 / size)) + 1)[1:-1]
    bore = np.linspace(half, -half, n_bore + 1)[1:-1]
    loop = [r, tip, l[::-1], np.column_stack([np.full(len(ys), -half), ys]), np.column_stack([-bore, np.full(len(bore), ys[-1])]),
            np.column_stack([np.full(len(ys), half), ys])[::-1]]
    return np.concatenate(loop), [len(part) for part in loop], (scale, middle, n_side)


def triangles(loop):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    points = [gmsh.model.geo.addPoint(x * 1e3, y * 1e3, 0.0) for x, y in loop]
    lines = [gmsh.model.geo.addLine(a, b) for a, b in zip(points, points[1:] + points[:1])]
    for line in lines:
        gmsh.model.geo.mesh.setTransfiniteCurve(line, 2)
    gmsh.model.geo.addPlaneSurface([gmsh.model.geo.addCurveLoop(lines)])
    gmsh.model.geo.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
    gmsh.option.setNumber("Mesh.Algorithm", 5)
    gmsh.model.mesh.generate(2)
    tags, xyz, _ = gmsh.model.mesh.getNodes()
    xyz = xyz.reshape(-1, 3)[:, :2] * 1e-3
    order = np.full(tags.max() + 1, -1, dtype=int)
    order[tags] = np.arange(len(tags))
    cells = order[gmsh.model.mesh.getElementsByType(2)[1].astype(int)].reshape(-1, 3)
    gmsh.finalize()
    # The loop first, in its order.
    own = np.array([np.argmin(np.hypot(*(xyz - p).T)) for p in loop])
    assert len(set(own)) == len(loop)
    rest = np.setdiff1d(np.arange(len(xyz)), own)
    new = np.empty(len(xyz), dtype=int)
    new[np.concatenate([own, rest])] = np.arange(len(xyz))
    return xyz[np.concatenate([own, rest])], new[cells]


def moved(xy, cells, loops):
    """The nodes with the loop at other places, the inside by Laplace's equation."""
    basis = skfem.Basis(skfem.MeshTri(xy.T.copy(), cells.T.copy()), skfem.ElementTriP1())
    laplace = skfem.models.poisson.laplace.assemble(basis).tocsc()
    n = len(loops[0])
    inner = np.arange(n, len(xy))
    solve = sla.splu(laplace[inner][:, inner])
    places = []
    for loop in loops:
        step = np.zeros_like(xy)
        step[:n] = loop - xy[:n]
        step[inner] = solve.solve(-(laplace[inner][:, :n] @ step[:n]))
        places.append(xy + step)
    return places


def table(path):
    with open(path) as file:
        lines = [line for line in file if line[0] in "01"]
    return {tuple(int(v) for v in line.split(",")[:5]): float(line.split(",")[5]) for line in lines}


def write(path, notes, rows):
    with open(path, "w") as out:
        for note in notes:
            out.write(f"# {note}\n")
        out.write("# flank 0 right, 1 left; stations up the flank and along it of load and response\n")
        out.write("flank,load_u,load_v,response_u,response_v,deflection_m_per_N\n")
        for row in rows:
            out.write(",".join(str(v) for v in row[:5]) + f",{row[5]:.6e}\n")


def combine(options):
    """Rows that all three tables have: the ring, and what finer elements change on three teeth."""
    ring, coarse, fine = (table(path) for path in options.tables)
    heads = []
    for path in options.tables:
        with open(path) as file:
            heads.append(file.readline()[2:].strip())
    rows = [(*key, ring[key] + fine[key] - coarse[key]) for key in ring if key in coarse and key in fine]
    write(options.output, [f"ring + (three teeth, fine - coarse): {'; '.join(heads)}"], rows)


def main():
    whole = argparse.ArgumentParser()
    commands = whole.add_subparsers(required=True)
    combining = commands.add_parser("combine")
    combining.add_argument("tables", nargs=3)
    combining.add_argument("-o", "--output", required=True)
    combining.set_defaults(run=combine)
    solving = commands.add_parser("solve")
    solving.set_defaults(run=solve_gear)
    solving.add_argument("surface")
    solving.add_argument("-o", "--output", required=True)
    solving.add_argument("--every", type=int, default=6)
    solving.add_argument("--thin", type=int, default=6)
    solving.add_argument("--size", type=float, default=2.4)
    solving.add_argument("--sectors", type=int, default=TEETH)
    options = whole.parse_args()
    options.run(options)


def solve_gear(options):
    sections, lines = read(options.surface, options.every, options.thin)
    loops, frames = [], []
    for section in sections:
        right, left = lines[section, 0], lines[section, 1]
        loop, counts, frame = boundary(right, left, right[0, 0], options.size)
        loops.append(loop)
        frames.append((right[0, 0], *frame))
    middle = len(sections) // 2
    xy, cells = triangles(loops[middle])
    places = moved(xy, cells, loops)
    cross = lambda p, q: p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
    area = lambda p: cross(p[cells[:, 1]] - p[cells[:, 0]], p[cells[:, 2]] - p[cells[:, 0]])
    assert min((area(p) * np.sign(area(xy))).min() for p in places) > 0.0, "triangles turned inside out"

    # Nodes of all sectors and sections; the left side of one sector is the right side of the next.
    n2, levels = len(xy), len(sections)
    n_right, n_tip, n_left, n_leftside, n_bore, n_rightside = counts
    first = np.cumsum([0] + counts)
    right_side = np.concatenate([[0], np.arange(first[5], first[6])[::-1]])
    left_side = np.concatenate([[first[2] + n_left - 1], np.arange(first[3], first[4])])
    # Both run downwards; the loop's left side has the sign turned, so that sides match.
    assert len(right_side) == len(left_side)
    k = options.sectors
    number = np.full((k, n2), -1)
    count = 0
    for sector in range(k):
        if sector:
            number[sector, right_side] = number[sector - 1, left_side]
        if sector == TEETH - 1:
            number[sector, left_side] = number[0, right_side]
        free = number[sector] < 0
        number[sector, free] = count + np.arange(free.sum())
        count += free.sum()
    points = np.zeros((levels, count, 3))
    for level, (p, (s, scale, centre, _)) in enumerate(zip(places, frames)):
        rz = np.array([meridian(s, y) for y in p[:, 1]])
        for sector in range(k):
            angle = centre + p[:, 0] / scale + 2 * math.pi / TEETH * (sector - k // 2)
            points[level, number[sector]] = np.column_stack([rz[:, 0] * np.cos(angle), rz[:, 0] * np.sin(angle), rz[:, 1]])
    tri = np.sort(np.concatenate([number[sector][cells] for sector in range(k)]), axis=1)
    a, b, c = tri.T
    tets = []
    for level in range(levels - 1):
        low, high = level * count, (level + 1) * count
        tets += [np.column_stack(t) for t in ((a + low, b + low, c + low, c + high), (a + low, b + low, b + high, c + high),
                                              (a + low, a + high, b + high, c + high))]
    tets = np.concatenate(tets)
    nodes = points.reshape(-1, 3)
    edge = nodes[tets[:, 1:]] - nodes[tets[:, :1]]
    turned = np.linalg.det(edge) < 0
    tets[turned] = tets[turned][:, [0, 2, 1, 3]]
    mesh = skfem.MeshTet(nodes.T.copy(), tets.T.copy())
    print(f"{mesh.nelements} tetrahedra, smallest volume {np.abs(np.linalg.det(edge)).min() / 6:.2e} m3", flush=True)

    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()), intorder=2)
    elasticity = linear_elasticity(*lame_parameters(YOUNG_PA, POISSON))
    parts = np.array_split(np.arange(mesh.nelements), mesh.nelements // 4000 + 1)
    stiffness = sum(elasticity.assemble(skfem.Basis(mesh, skfem.ElementVector(skfem.ElementTetP2()), elements=part, intorder=2)) for part in parts).tocsr()

    # Held: the bore.
    loop_bore = np.concatenate([[first[4] - 1], np.arange(first[4], first[5]), [first[5]]])
    bore2 = np.unique(number[:, loop_bore])
    bore = np.concatenate([bore2 + level * count for level in range(levels)])
    on_bore = np.zeros(len(nodes), bool)
    on_bore[bore] = True
    held_edges = np.flatnonzero(on_bore[mesh.edges].all(axis=0))
    held = np.concatenate([basis.nodal_dofs[:, bore].ravel(), basis.edge_dofs[:, held_edges].ravel()])
    free = np.setdiff1d(np.arange(basis.N), held)
    print(f"{len(free)} degrees of freedom", flush=True)

    results = []
    loads = {}
    edge_of = {tuple(e): i for i, e in enumerate(np.sort(mesh.edges.T, axis=1).tolist())}
    # Azimuth of the tooth's middle along the face, from the tips of both sides.
    tips = [[lines[section, side][-1] for side in (0, 1)] for section in sections]
    azimuths = [0.5 * sum(math.atan2(end[3], end[2]) for end in pair) for pair in tips]
    middle_of = lambda at: np.interp(at, [pair[0][0] for pair in tips], azimuths)
    for side in (0, 1):
        line = np.arange(n_right) if side == 0 else np.arange(first[2], first[3])[::-1]
        outline = number[k // 2][line]
        u = np.array([lines[section, side][:, 1] for section in sections])
        s = np.array([lines[section, side][0, 0] for section in sections])
        for wanted in sorted({station for pair in PAIRS for station in pair}):
            loads[side, wanted] = load_vector(basis, edge_of, middle_of, nodes, outline, count, u, s, wanted)
    keep = stiffness[free][:, free]
    corner = np.isin(free, basis.nodal_dofs.ravel())
    solve = preconditioned(mesh, basis, keep, free, corner)
    fields = {}
    for key in sorted({(side, pair[0]) for side in (0, 1) for pair in PAIRS}):
        fields[key] = np.zeros(basis.N)
        fields[key][free] = solve(loads[key][free])
    for side in (0, 1):
        for load, response in PAIRS:
            value = loads[side, response] @ fields[side, load]
            results.append((side, *load, *response, value))
            print(results[-1], flush=True)
    note = f"tools/reference/bevel_tooth.py: {mesh.nelements} ten-node tetrahedra, {len(free)} degrees of freedom, {k} sectors, scikit-fem {skfem.__version__}"
    write(options.output, [note], results)


def hat(x, k):
    step = STATIONS[1] - STATIONS[0]
    return np.clip(1.0 - np.abs(x - STATIONS[k]) / step, 0.0, None) * (x >= -1e-9) * (x <= 1.0 + 1e-9)


def load_vector(basis, edge_of, middle, nodes, outline, count, u, s, station):
    """Consistent loads of density h_i(u) h_j(s)/g(s) along the inward normal, one newton in all."""
    levels = len(s)
    grid = np.array([outline + level * count for level in range(levels)])
    x = nodes[grid]
    facets, shares = [], []
    for level in range(levels - 1):
        for m in range(len(outline) - 1):
            p, q = sorted((m, m + 1), key=lambda i: outline[i])
            quad = [(level, p), (level, q), (level + 1, p), (level + 1, q)]
            facets += [(quad[0], quad[1], quad[3]), (quad[0], quad[2], quad[3])]
    # Area of the flank per unit of s, strip by strip.
    strip = np.zeros(levels - 1)
    for triple in facets:
        p = np.array([x[i] for i in triple])
        us = np.array([u[i] for i in triple])
        if us.mean() > 0.0:
            strip[min(i[0] for i in triple)] += 0.5 * np.linalg.norm(np.cross(p[1] - p[0], p[2] - p[0]))
    g = lambda at: np.interp(at, 0.5 * (s[1:] + s[:-1]), strip / np.diff(s))
    rule, weights = skfem.quadrature.get_quadrature(skfem.refdom.RefTri, 8)
    bary = np.array([1 - rule[0] - rule[1], rule[0], rule[1]])
    vector, total = np.zeros(basis.N), 0.0
    for triple in facets:
        p = np.array([x[i] for i in triple])
        us, ss = np.array([u[i] for i in triple]), np.array([s[i[0]] for i in triple])
        if us.max() <= 0.0 or hat(np.linspace(us.min(), us.max(), 9), station[0]).max() == 0.0:
            continue
        n = np.cross(p[1] - p[0], p[2] - p[0])
        size = np.linalg.norm(n)
        at_u, at_s = us @ bary, ss @ bary
        density = hat(at_u, station[0]) * hat(at_s, station[1]) / g(at_s) * weights * size
        if density.max() == 0.0:
            continue
        n = n / size
        # Towards the tooth's middle, across the radius.
        radial = p.mean(axis=0) * [1, 1, 0]
        around = np.cross([0, 0, 1.0], radial / np.linalg.norm(radial))
        own = np.arctan2(p.mean(axis=0)[1], p.mean(axis=0)[0])
        n = n * np.sign(n @ around) * np.sign(middle(at_s.mean()) - own)
        total += density.sum()
        ids = [grid[i] for i in triple]
        for a in range(3):
            vector[basis.nodal_dofs[:, ids[a]]] += (density * bary[a] * (2 * bary[a] - 1)).sum() * n
            b = (a + 1) % 3
            edge = edge_of[tuple(sorted((ids[a], ids[b])))]
            vector[basis.edge_dofs[:, edge]] += (density * 4 * bary[a] * bary[b]).sum() * n
    return vector / total


def preconditioned(mesh, basis, k, free, corner):
    """Conjugate gradients; the linear elements' stiffness is factorised, all else by its diagonal."""
    edges = mesh.edges
    rows, cols = [], []
    for axis in range(3):
        rows.append(basis.nodal_dofs[axis]); cols.append(3 * np.arange(mesh.nvertices) + axis)
        for end in (0, 1):
            rows.append(basis.edge_dofs[axis]); cols.append(3 * edges[end] + axis)
    values = np.concatenate([np.full(len(r), 1.0 if i % 3 == 0 else 0.5) for i, r in enumerate(rows)])
    prolong = sp.csr_matrix((values, (np.concatenate(rows), np.concatenate(cols))), shape=(basis.N, 3 * mesh.nvertices))[free]
    used = np.flatnonzero(np.isin(np.arange(3 * mesh.nvertices), prolong[np.flatnonzero(corner)].indices))
    prolong = prolong[:, used].tocsr()
    coarse = sla.splu((prolong.T @ k @ prolong).tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=dict(SymmetricMode=True))
    diagonal = k.diagonal()
    apply = sla.LinearOperator(k.shape, matvec=lambda r: r / diagonal + prolong @ coarse.solve(prolong.T @ r))

    def solve(f):
        steps = [0]
        found, info = sla.cg(k, f, rtol=1e-6, maxiter=3000, M=apply, callback=lambda _: steps.__setitem__(0, steps[0] + 1))
        assert info == 0
        print(f"{steps[0]} steps", flush=True)
        return found

    return solve


if __name__ == "__main__":
    main()
