"""Mesh one sector of a body of revolution with openings in quadratic tetrahedra with gmsh.

Reads the problem as JSON on standard input (lengths in mm), writes the mesh on standard output. The contour is revolved by the
OpenCASCADE kernel, openings are cut out. On the ring, where the teeth stand, the triangulation is given: a regular grid, every
rectangle cut from its lower clockwise to its upper counter-clockwise corner. The two sides of the sector get the same
triangles, and the pairs of their nodes are passed on. Nodes in the middle of edges lie on the true surface.
"""

import json
import math
import sys

import gmsh
import numpy as np

SAME_MM = 1e-6


def give_up(problem, message):
    """No mesh can be made: told apart from a program that fails by the exit code."""
    print(f"{problem['name']}: {message}", file=sys.stderr)
    sys.exit(3)


def polar(x, y):
    return math.hypot(x, y), math.atan2(y, x)


def loop(occ, points, edges, place):
    """A closed loop of lines (two point numbers) and arcs (from, centre, to)."""
    tags = [occ.addPoint(*place(point)) for point in points]
    curves = [
        occ.addLine(tags[e[0]], tags[e[1]]) if len(e) == 2 else occ.addCircleArc(*(tags[k] for k in e)) for e in edges
    ]
    return occ.addCurveLoop(curves)


def build(problem):
    """The sector's volumes."""
    occ = gmsh.model.occ
    start, angle, pieces = problem["start"], problem["angle"], problem["pieces"]
    cos, sin = math.cos(start), math.sin(start)
    contour = problem["contour"]
    face = occ.addPlaneSurface(
        [loop(occ, contour["points"], contour["edges"], lambda p: (p[0] * cos, p[0] * sin, p[1]))]
    )
    volumes = []
    for _ in range(pieces):
        swept = occ.revolve([(2, face)], 0, 0, 0, 0, 0, 1, angle / pieces)
        face = swept[0][1]
        volumes += [entity for entity in swept if entity[0] == 3]
    low = min(p[1] for p in contour["points"]) - 1.0
    height = max(p[1] for p in contour["points"]) + 1.0 - low
    tools = []
    for opening in problem["openings"]:
        outline = loop(occ, opening["points"], opening["edges"], lambda p: (p[0], p[1], low))
        swept = occ.extrude([(2, occ.addPlaneSurface([outline]))], 0, 0, height)
        tools += [entity for entity in swept if entity[0] == 3]
    if tools:
        volumes, _ = occ.cut(volumes, tools)
    if len(volumes) > 1:
        occ.fragment(volumes, [])
    occ.synchronize()
    # Faces and arcs from which something was made.
    gmsh.model.occ.remove([e for e in gmsh.model.occ.getEntities(2) if not gmsh.model.getAdjacencies(*e)[0].size], recursive=True)
    occ.synchronize()


def middle(tag):
    """A point of a surface and its normal; for surfaces whose parameters' middle tells which they are."""
    low, high = gmsh.model.getParametrizationBounds(2, tag)
    at = [0.5 * (a + b) for a, b in zip(low, high)]
    return gmsh.model.getValue(2, tag, at), gmsh.model.getNormal(tag, at)


def classify(problem):
    """Ring patches, and the sector's plane sides at its smaller and its larger angle."""
    start, angle = problem["start"], problem["angle"]
    ring, sides = [], ([], [])
    for _, tag in gmsh.model.getEntities(2):
        (x, y, _), normal = middle(tag)
        radius, _ = polar(x, y)
        kind = gmsh.model.getType(2, tag)
        if kind == "Cylinder" and abs(radius - problem["ring_radius"]) < SAME_MM:
            ring.append(tag)
        if kind != "Plane" or problem["closed"]:
            continue
        for side, at in zip(sides, (start, start + angle)):
            across = (-math.sin(at), math.cos(at))
            turned = abs(normal[0] * across[0] + normal[1] * across[1])
            if turned > 1 - 1e-9 and abs(x * across[0] + y * across[1]) < SAME_MM and x * across[1] - y * across[0] > 0:
                side.append(tag)
    return ring, sides


def prescribe(problem, ring, sides, arrangement):
    """The ring's grid, equal sides, element sizes."""
    mesh = gmsh.model.mesh
    for tag in ring:
        for _, curve in gmsh.model.getBoundary([(2, tag)], oriented=False):
            (_, _, low), (_, _, high) = (
                gmsh.model.getValue(0, point, []) for _, point in gmsh.model.getBoundary([(1, abs(curve))], oriented=False)
            )
            along_axis = abs(high - low) > SAME_MM
            mesh.setTransfiniteCurve(abs(curve), 1 + (problem["ring_layers"] if along_axis else problem["ring_arcs"]))
        mesh.setTransfiniteSurface(tag, arrangement)
    angle = problem["angle"]
    cos, sin = math.cos(angle), math.sin(angle)
    turn = [cos, -sin, 0, 0, sin, cos, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    centre = lambda tag: np.array(gmsh.model.occ.getCenterOfMass(2, tag))
    for left in sides[1]:
        back = np.array(turn).reshape(4, 4)[:3, :3].T @ centre(left)
        right = min(sides[0], key=lambda tag: np.linalg.norm(centre(tag) - back))
        mesh.setPeriodic(2, [left], [right], turn)
    sized = [(p[0], p[1], p[2]) for p in problem["contour"]["points"] if p[2] > 0]
    for _, point in gmsh.model.getEntities(0):
        x, y, z = gmsh.model.getValue(0, point, [])
        radius, _ = polar(x, y)
        near = [size for r, height, size in sized if math.hypot(r - radius, height - z) < 1e-4]
        near += [
            size
            for opening in problem["openings"]
            for a, b, size in opening["points"]
            if size > 0 and math.hypot(a - x, b - y) < 1e-4
        ]
        mesh.setSize([(0, point)], min(near, default=problem["largest"]))


def ring_is_cut_as_told(ring):
    """Whether the diagonal of the ring's rectangles rises counter-clockwise."""
    rising = None
    for tag in ring:
        _, _, connectivity = gmsh.model.mesh.getElements(2, tag)
        tags, xyz, _ = gmsh.model.mesh.getNodes(2, tag, includeBoundary=True)
        at = {int(t): xyz[3 * k : 3 * k + 3] for k, t in enumerate(tags)}
        for a, b, c in np.array(connectivity[0], dtype=int).reshape(-1, 3):
            for u, v in ((a, b), (b, c), (c, a)):
                (x0, y0, z0), (x1, y1, z1) = at[u], at[v]
                ahead = x0 * y1 - x1 * y0
                # Only a diagonal goes both up and round.
                if abs(z1 - z0) > SAME_MM and abs(ahead) > SAME_MM * math.hypot(x0, y0):
                    now = (z1 - z0) * ahead > 0
                    if rising is None:
                        rising = now
                    elif rising != now:
                        sys.exit("the ring's triangles are not cut alike")
    return bool(rising)


def generate(problem, arrangement):
    gmsh.clear()
    build(problem)
    ring, sides = classify(problem)
    if not ring or (not problem["closed"] and (not sides[0] or len(sides[0]) != len(sides[1]))):
        give_up(problem, f"the surfaces were not found: {len(ring)} on the ring, {len(sides[0])} and {len(sides[1])} at the sides")
    prescribe(problem, ring, sides, arrangement)
    gmsh.model.mesh.generate(2)
    if not ring_is_cut_as_told(ring):
        return None
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.optimize("Netgen")
    gmsh.model.mesh.setOrder(2)
    return sides


def main():
    problem = json.load(sys.stdin)
    gmsh.initialize(interruptible=False)
    option = gmsh.option.setNumber
    option("General.Terminal", 0)
    option("General.NumThreads", 1)
    option("Mesh.Algorithm", 6)
    option("Mesh.Algorithm3D", 1)
    option("Mesh.MeshSizeMax", problem["largest"])
    option("Mesh.MeshSizeFromCurvature", problem["elements_per_turn"])
    option("Mesh.MeshSizeExtendFromBoundary", 1)
    option("Mesh.HighOrderOptimize", 0)
    try:
        sides = generate(problem, "Left") or generate(problem, "Right")
    except Exception as error:  # gmsh raises plain Exception
        give_up(problem, error)
    if sides is None:
        give_up(problem, "the ring was not cut as told")
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    kinds, _, connectivity = gmsh.model.mesh.getElements(3)
    if list(kinds) != [11] and set(kinds) != {11}:
        sys.exit(f"{problem['name']}: elements of kinds {list(kinds)} instead of ten-node tetrahedra")
    elements = np.concatenate(connectivity).astype(np.int64).reshape(-1, 10)
    # gmsh has the edges 2-3 and 1-3 in the other order.
    elements = elements[:, [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]]
    used = np.unique(elements)
    number = np.full(int(max(tags)) + 1, -1)
    number[used] = np.arange(used.size)
    points = np.zeros((int(max(tags)) + 1, 3))
    points[tags.astype(np.int64)] = coordinates.reshape(-1, 3)
    pairs = set()
    for left in sides[1]:
        _, slaves, masters, _ = gmsh.model.mesh.getPeriodicNodes(2, left, True)
        pairs |= {(int(number[int(a)]), int(number[int(b)])) for a, b in zip(slaves, masters)}
    gmsh.finalize()
    json.dump(
        {
            "nodes": points[used].tolist(),
            "elements": number[elements].tolist(),
            "left_right": sorted(pairs),
        },
        sys.stdout,
    )


main()
