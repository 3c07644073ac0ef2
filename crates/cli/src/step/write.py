"""A gear as STEP by gmsh's OCC kernel. A description on standard input (JSON, millimetres), the file as argument; what the file's flanks are off
the exact ones on standard output (JSON).

The outline of a section is made of arcs (root, tip) and splines through exact points (fillets, flanks). A spur gear is that section extruded. Of a
helical one the sections of one tooth, turned along the helix, are skinned; its copies, the faces and the bore are sewn together.
"""

import json
import math
import os
import sys

import gmsh

# The kernel prints on standard output, which is for the answer.
answer = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
given = json.load(sys.stdin)
teeth, width, bore, twist = given["teeth"], given["width"], given["bore_radius"], given["twist_per_length"]
gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
occ = gmsh.model.occ


def turned(point, angle):
    s, c = math.sin(angle), math.cos(angle)
    return c * point[0] - s * point[1], s * point[0] + c * point[1]


def section(z, turn, count=teeth):
    """The outline at a height, that of so many teeth from tooth 0 on; closed where it is all. Tags of its curves."""
    centre = occ.addPoint(0.0, 0.0, z)
    curves, last, first = [], None, None

    def place(point, angle):
        return occ.addPoint(*turned(point, angle), z)

    for tooth in range(count):
        angle = turn + 2.0 * math.pi * tooth / teeth
        # From the middle of the tooth space over the right side, the tip, the left side.
        right = given["half_outline"]
        left = [
            {"kind": piece["kind"], "points": [[x, -y] for x, y in reversed(piece["points"])]}
            for piece in reversed(right)
        ]
        # Arcs of the root reach from one tooth to the next, arcs of the tip over the tooth: half of each is in either list.
        pieces = [p for p in right if p["kind"] != "tip"]
        tip = [p for p in right if p["kind"] == "tip"][0]["points"]
        pieces.append({"kind": "arc", "points": [tip[0], [tip[0][0], -tip[0][1]]]})
        pieces += [p for p in left if p["kind"] != "tip"]
        for piece in pieces:
            points = piece["points"]
            begin = last
            if begin is None:
                begin = place(points[0], angle)
                first = begin
            closes = tooth == count - 1 == teeth - 1 and piece is pieces[-1]
            end = first if closes else place(points[-1], angle)
            inner = [place(p, angle) for p in points[1:-1]]
            if piece["kind"] in ("arc", "root"):
                curves.append(occ.addCircleArc(begin, centre, end))
            elif inner:
                curves.append(occ.addSpline([begin, *inner, end]))
            else:
                curves.append(occ.addLine(begin, end))
            last = end
    return curves


if twist == 0.0:
    outline = occ.addCurveLoop(section(-0.5 * width, 0.0))
    faces = [outline]
    if bore > 0.0:
        faces.append(occ.addCurveLoop([occ.addCircle(0.0, 0.0, -0.5 * width, bore)]))
    body = [e for e in occ.extrude([(2, occ.addPlaneSurface(faces))], 0.0, 0.0, width) if e[0] == 3]
else:
    count = given["sections"]
    heights = [-0.5 * width + width * k / (count - 1) for k in range(count)]
    tooth = occ.addThruSections([occ.addWire(section(z, twist * z, 1)) for z in heights], makeSolid=False)
    tooth = [e for e in tooth if e[0] == 2]
    faces = list(tooth)
    for number in range(1, teeth):
        copy = occ.copy(tooth)
        occ.rotate(copy, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0 * math.pi * number / teeth)
        faces += copy
    for z in (heights[0], heights[-1]):
        loops = [occ.addCurveLoop(section(z, twist * z))]
        if bore > 0.0:
            loops.append(occ.addCurveLoop([occ.addCircle(0.0, 0.0, z, bore)]))
        faces.append((2, occ.addPlaneSurface(loops)))
    if bore > 0.0:
        circle = occ.addCircle(0.0, 0.0, heights[0], bore)
        faces += [e for e in occ.extrude([(1, circle)], 0.0, 0.0, width) if e[0] == 2]
    body = [(3, occ.addVolume([occ.addSurfaceLoop([tag for _, tag in faces], sewing=True)]))]
occ.synchronize()
if len(body) != 1:
    sys.exit(f"{len(body)} solids instead of one")
# The solid alone, without the faces and curves that it was made of.
gmsh.option.setNumber("Geometry.OCCExportOnlyVisible", 1)
gmsh.model.setVisibility(gmsh.model.getEntities(), 0)
gmsh.model.setVisibility(body, 1, True)
gmsh.write(sys.argv[1])

# What was written, against the exact flanks: the file itself is read again.
gmsh.clear()
shapes = occ.importShapes(sys.argv[1])
occ.synchronize()
faces = [tag for _, tag in gmsh.model.getEntities(2)]
off = []
for flank in given["flanks"]:
    middle = flank[len(flank) // 2]

    def distance(tag, point):
        near, _ = gmsh.model.getClosestPoint(2, tag, point)
        return math.dist(near, point)

    def touches(tag):
        low, high = gmsh.model.getBoundingBox(2, tag)[:3], gmsh.model.getBoundingBox(2, tag)[3:]
        return all(a - 1e-3 <= x <= b + 1e-3 for a, x, b in zip(low, middle, high))

    tag = min(filter(touches, faces), key=lambda tag: distance(tag, middle))
    off.append(max(distance(tag, point) for point in flank))
volume = sum(occ.getMass(*e) for e in gmsh.model.getEntities(3))
json.dump({"largest_error_mm": max(off), "faces": len(faces), "solids": len(gmsh.model.getEntities(3)), "volume_mm3": volume}, answer)
gmsh.finalize()
