"""Mesh plane regions in quads with gmsh. Reads problems as JSON on standard input, writes meshes on standard output.

All boundary nodes are given, so neighbouring regions and the two edges of a repeating sector match by construction.
Structured regions are transfinite, every boundary piece a line with one element. Free regions are paved at twice the
size and then split, which leaves quads only: there a line spans two boundary pieces, and its middle node is the given
one. Of each region the best mesh is taken; smaller elements are tried where it still has a poor quad.
"""

import json
import os
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
# So many are made in any case and the best is taken: layers along the axis take off from the quality in the plane.
ALWAYS = 3
# Smallest scaled Jacobian at which no further algorithm is tried, and below which smaller elements than were asked for
# are: they are up to six times as many.
GOOD = 0.4
TOLERABLE = 0.3


def mesh(problem, tags, algorithm, recombination, factor):
    """Mesh some of the problem's regions (tags from 1). The mesh of each: inner nodes, quads, quality; None where triangles are left."""
    gmsh.clear()
    gmsh.option.setNumber("Mesh.Algorithm", algorithm)
    surfaces = {tag: problem["surfaces"][tag - 1] for tag in tags}
    free = [not surface["corners"] for surface in surfaces.values()]
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
    ends = sorted({p for s in surfaces.values() for loop in s["loops"] for p in loop[::step]})
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

    for tag, surface in surfaces.items():
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
    for tag, surface in surfaces.items():
        if surface["corners"]:
            gmsh.model.mesh.setTransfiniteSurface(tag, "Left", [c + 1 for c in surface["corners"]])
            gmsh.model.mesh.setRecombine(2, tag)
    gmsh.model.mesh.generate(2)
    number = {}
    for index in ends:
        tags, _, _ = gmsh.model.mesh.getNodes(0, index + 1)
        number[int(tags[0])] = ("point", index)
    for tag, inner in middle.items():
        for node, index in zip(gmsh.model.mesh.getNodes(1, tag)[0], inner):
            number[int(node)] = ("point", index)
            gmsh.model.mesh.setNode(int(node), [points[index][0], points[index][1], 0.0], [])
    if all(free):
        for method in ("Relocate2D", "Laplace2D"):
            gmsh.model.mesh.optimize(method, niter=5)
    found = {}
    for tag in surfaces:
        tags, coordinates, _ = gmsh.model.mesh.getNodes(2, tag)
        nodes = []
        for k, node in enumerate(tags):
            number[int(node)] = ("inner", len(nodes))
            nodes.append([coordinates[3 * k], coordinates[3 * k + 1]])
        kinds, elements, connectivity = gmsh.model.mesh.getElements(2, tag)
        if list(kinds) != [3]:
            found[tag] = None
            continue
        flat = [number[int(n)] for n in connectivity[0]]
        quads = [flat[k : k + 4] for k in range(0, len(flat), 4)]
        quality = min(gmsh.model.mesh.getElementQualities(elements[0], "minSJ"))
        found[tag] = (nodes, quads, quality)
    return found


def best_mesh(problem):
    """Of each region the best of the attempts. All nodes on their edges are given, so regions need not be of one attempt."""
    given = {tag: surface["quads"] for tag, surface in enumerate(problem["surfaces"], 1) if surface["quads"]}
    best = {tag: ([], [[("point", n) for n in quad] for quad in quads], 1.0) for tag, quads in given.items()}
    last = "triangles were left"
    poor = [tag for tag in range(1, len(problem["surfaces"]) + 1) if tag not in given]
    for number, attempt in enumerate(FREE_ATTEMPTS):
        wanted = GOOD if attempt[2] == 1.0 else TOLERABLE
        if number >= ALWAYS:
            poor = [tag for tag in poor if tag not in best or best[tag][2] < wanted]
        if not poor:
            continue
        try:
            found = mesh(problem, poor, *attempt)
        except Exception as error:  # gmsh raises plain Exception
            last = str(error)
            continue
        for tag, region in found.items():
            if region is not None and (tag not in best or region[2] > best[tag][2]):
                best[tag] = region
    if len(best) < len(problem["surfaces"]):
        # Told apart from a program that fails by the exit code.
        print(f"{problem['name']}: no quad mesh with any of {len(FREE_ATTEMPTS)} algorithms: {last}", file=sys.stderr)
        sys.exit(3)
    nodes, quads, owners = [], [], []
    for tag, (inner, region, _) in sorted(best.items()):
        first = len(problem["points"]) + len(nodes)
        nodes += inner
        quads += [[index if kind == "point" else first + index for kind, index in quad] for quad in region]
        owners += [tag - 1] * len(region)
    return {"nodes": nodes, "quads": quads, "owners": owners}


def main():
    problems = json.load(sys.stdin)
    # Blossom prints warnings on standard output, which is for the answer.
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    results = [best_mesh(problem) for problem in problems]
    gmsh.finalize()
    with answer:
        json.dump(results, answer)


main()
