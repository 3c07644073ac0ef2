"""Mesh plane regions in quads with gmsh. Reads problems as JSON on standard input, writes meshes on standard output.

All boundary nodes are given, so neighbouring regions and the two edges of a repeating sector match by construction.
Structured regions are transfinite, every boundary piece a line with one element. Free regions are paved at twice the
size and then split, which leaves quads only: there a line spans two boundary pieces, and its middle node is the given
one. The next algorithm is tried while a quad is poor; the best mesh is taken.
"""

import json
import sys

import gmsh

# Free regions: 2D algorithm (frontal for quads, Delaunay, frontal), how it is made all quads (blossom's full-quad
# recombination, or splitting whatever it leaves, triangles too), and a factor on the element size inside.
FREE_ATTEMPTS = [
    (8, "full", 1.0),
    (5, "full", 1.0),
    (6, "full", 1.0),
    (8, "full", 0.6),
    (5, "full", 0.6),
    (8, "full", 0.4),
    (5, "full", 0.4),
    (8, "split", 1.0),
    (6, "split", 0.6),
]
# Smallest scaled Jacobian at which no further algorithm is tried.
GOOD = 0.4


def mesh(problem, algorithm, recombination, factor):
    gmsh.clear()
    gmsh.option.setNumber("Mesh.Algorithm", algorithm)
    free = [not surface["corners"] for surface in problem["surfaces"]]
    split = all(free) and recombination == "split"
    gmsh.option.setNumber("Mesh.RecombinationAlgorithm", 1 if split else 3 if all(free) else 0)
    gmsh.option.setNumber("Mesh.SubdivisionAlgorithm", 1 if split else 0)
    gmsh.option.setNumber("Mesh.RecombineAll", 1)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
    gmsh.option.setNumber("Mesh.Smoothing", 10)
    # Splitting halves the elements, so their size before it is twice the wanted one.
    gmsh.option.setNumber("Mesh.MeshSizeMax", problem["largest"] * factor * (2 if split else 1))
    gmsh.option.setNumber("Mesh.MeshSizeFactor", factor * (2 if split else 1))
    geo = gmsh.model.geo
    points = problem["points"]
    step = 2 if all(free) else 1
    ends = sorted({p for s in problem["surfaces"] for loop in s["loops"] for p in loop[::step]})
    for index in ends:
        x, y, size = points[index]
        geo.addPoint(x, y, 0.0, size, index + 1)
    lines, middle = {}, {}

    def line(part):
        a, b = part[0], part[-1]
        if (b, a) in lines:
            return -lines[(b, a)]
        if (a, b) not in lines:
            lines[(a, b)] = geo.addLine(a + 1, b + 1)
            middle[lines[(a, b)]] = part[1:-1]
        return lines[(a, b)]

    for tag, surface in enumerate(problem["surfaces"], start=1):
        loops = []
        for loop in surface["loops"]:
            if len(loop) % step:
                sys.exit(f"{problem['name']}: a loop of {len(loop)} points cannot bound quads only")
            closed = loop + loop[:1]
            loops.append(geo.addCurveLoop([line(closed[k : k + step + 1]) for k in range(0, len(loop), step)]))
        geo.addPlaneSurface(loops, tag)
    geo.synchronize()
    for tag in lines.values():
        gmsh.model.mesh.setTransfiniteCurve(tag, 2 if split else step + 1)
    for tag, surface in enumerate(problem["surfaces"], start=1):
        if surface["corners"]:
            gmsh.model.mesh.setTransfiniteSurface(tag, "Left", [c + 1 for c in surface["corners"]])
            gmsh.model.mesh.setRecombine(2, tag)
    gmsh.model.mesh.generate(2)
    number = {}
    for index in ends:
        tags, _, _ = gmsh.model.mesh.getNodes(0, index + 1)
        number[int(tags[0])] = index
    for tag, inner in middle.items():
        for node, index in zip(gmsh.model.mesh.getNodes(1, tag)[0], inner):
            number[int(node)] = index
            gmsh.model.mesh.setNode(int(node), [points[index][0], points[index][1], 0.0], [])
    if all(free):
        for method in ("Relocate2D", "Laplace2D"):
            gmsh.model.mesh.optimize(method, niter=5)
    nodes = []
    quads, owners = [], []
    for tag in range(1, len(problem["surfaces"]) + 1):
        tags, coordinates, _ = gmsh.model.mesh.getNodes(2, tag)
        for k, node in enumerate(tags):
            number[int(node)] = len(points) + len(nodes)
            nodes.append([coordinates[3 * k], coordinates[3 * k + 1]])
    for tag in range(1, len(problem["surfaces"]) + 1):
        types, _, connectivity = gmsh.model.mesh.getElements(2, tag)
        for kind, flat in zip(types, connectivity):
            if kind != 3:
                return None, 0.0
            for k in range(0, len(flat), 4):
                quads.append([number[int(n)] for n in flat[k : k + 4]])
                owners.append(tag - 1)
    _, elements, _ = gmsh.model.mesh.getElements(2)
    quality = min(min(gmsh.model.mesh.getElementQualities(tags, "minSJ")) for tags in elements)
    return {"nodes": nodes, "quads": quads, "owners": owners}, quality


def main():
    problems = json.load(sys.stdin)
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    results = []
    for problem in problems:
        result, best, last = None, -1.0, "triangles were left"
        for attempt in FREE_ATTEMPTS:
            try:
                found, quality = mesh(problem, *attempt)
            except Exception as error:  # gmsh raises plain Exception
                last = str(error)
                continue
            if found is not None and quality > best:
                result, best = found, quality
            if best >= GOOD:
                break
        if result is None:
            sys.exit(f"{problem['name']}: no quad mesh with any of {len(FREE_ATTEMPTS)} algorithms: {last}")
        results.append(result)
    gmsh.finalize()
    json.dump(results, sys.stdout)


main()
