"""A gear as STEP by gmsh's OCC kernel. A description on standard input (JSON, millimetres), the file as argument; what the file's flanks are off
the exact ones on standard output (JSON).

The outline of a section is made of arcs (root, tip) and splines through exact points (fillets, flanks). A spur gear is that section extruded. Of a
helical one the sections of one tooth, turned along the helix, are skinned; its copies, the faces and the bore are sewn together. Of a bevel gear plane
sections of a slot are skinned and cut out of the blank.
"""

import json
import math
import os
import sys

import gmsh
import numpy

# The kernel prints on standard output, which is for the answer.
answer = os.fdopen(os.dup(1), "w")
os.dup2(2, 1)
given = json.load(sys.stdin)
gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
occ = gmsh.model.occ
# Of the splines of a bevel gear.
DEGREE = 3


def turned(point, angle):
    s, c = math.sin(angle), math.cos(angle)
    return c * point[0] - s * point[1], s * point[0] + c * point[1]


def section(z, turn, count):
    """The outline of a cylindrical gear at a height, that of so many teeth from tooth 0 on; closed where it is all. Tags of its curves."""
    teeth = given["teeth"]
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


def cylindrical():
    """Solids of a cylindrical gear."""
    teeth, width, bore, twist = given["teeth"], given["width"], given["bore_radius"], given["twist_per_length"]
    if twist == 0.0:
        outline = occ.addCurveLoop(section(-0.5 * width, 0.0, teeth))
        faces = [outline]
        if bore > 0.0:
            faces.append(occ.addCurveLoop([occ.addCircle(0.0, 0.0, -0.5 * width, bore)]))
        return [e for e in occ.extrude([(2, occ.addPlaneSurface(faces))], 0.0, 0.0, width) if e[0] == 3]
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
            loops = [occ.addCurveLoop(section(z, twist * z, teeth))]
            if bore > 0.0:
                loops.append(occ.addCurveLoop([occ.addCircle(0.0, 0.0, z, bore)]))
            faces.append((2, occ.addPlaneSurface(loops)))
        if bore > 0.0:
            circle = occ.addCircle(0.0, 0.0, heights[0], bore)
            faces += [e for e in occ.extrude([(1, circle)], 0.0, 0.0, width) if e[0] == 2]
        return [(3, occ.addVolume([occ.addSurfaceLoop([tag for _, tag in faces], sewing=True)]))]


def basis(t, knots):
    """Values of all B-splines at a parameter (de Boor)."""
    last = t >= knots[-1]
    values = [1.0 if a <= t < b or (last and a < b == t) else 0.0 for a, b in zip(knots, knots[1:])]
    for degree in range(1, DEGREE + 1):
        for i in range(len(knots) - 1 - degree):
            up, down = knots[i + degree] - knots[i], knots[i + degree + 1] - knots[i + 1]
            rising = (t - knots[i]) / up * values[i] if up > 0.0 else 0.0
            values[i] = rising + ((knots[i + degree + 1] - t) / down * values[i + 1] if down > 0.0 else 0.0)
    return values[: len(knots) - DEGREE - 1]


class Splines:
    """Splines through lines of points, all with the same knots: lines with knots of their own would give a skin the knots of all of them."""

    def __init__(self, lines):
        lengths = numpy.linalg.norm(numpy.diff(numpy.array(lines), axis=1), axis=2)
        shares = numpy.mean(lengths / lengths.sum(axis=1, keepdims=True), axis=0)
        places = [0.0, *numpy.cumsum(shares)[:-1], 1.0]
        # Not a knot: the second and the last but one place.
        self.inner = places[2:-2]
        knots = [0.0] * (DEGREE + 1) + self.inner + [1.0] * (DEGREE + 1)
        self.inverse = numpy.linalg.inv([basis(t, knots) for t in places])

    def curve(self, points, first, last):
        control = self.inverse @ numpy.array(points)
        tags = [first, *[occ.addPoint(*p) for p in control[1:-1]], last]
        ends = [DEGREE + 1]
        return occ.addBSpline(tags, degree=DEGREE, knots=[0.0, *self.inner, 1.0], multiplicities=ends + [1] * len(self.inner) + ends)


def slot_sections(sections):
    """Wires of the sections of a slot: down one wall, over the bottom, the other wall, over the lid."""
    splines = [Splines([of["walls"][k] for of in sections]) for k in range(4)]
    wires = []
    for of in sections:
        walls = of["walls"]
        # Of each wall the top, where the fillet begins, and its lower end.
        corners = [[occ.addPoint(*p) for p in (walls[k][0], walls[k + 1][0], walls[k + 1][-1])] for k in (0, 2)]
        lid = occ.addPoint(*of["lid"])
        curves = []
        for k, (top, middle, low) in zip((0, 2), corners):
            curves += [splines[k].curve(walls[k], top, middle), splines[k + 1].curve(walls[k + 1], middle, low)]
        curves += [occ.addLine(corners[0][2], corners[1][2]), occ.addLine(corners[1][0], lid), occ.addLine(lid, corners[0][0])]
        left_flank, left_fillet, right_flank, right_fillet, bottom, right_lid, left_lid = curves
        wires.append(occ.addWire([left_flank, left_fillet, bottom, right_fillet, right_flank, right_lid, left_lid], checkClosed=True))
    return wires


def bevel():
    """Solids of a bevel gear: the blank, turned, less the slot as often as there are teeth."""
    corners = [occ.addPoint(radius, 0.0, z) for radius, z in given["meridian"]]
    lines = [occ.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1])]
    meridian = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    blank = [e for e in occ.revolve([(2, meridian)], 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0 * math.pi) if e[0] == 3]
    slots = [e for e in occ.addThruSections(slot_sections(given["slot"]), makeSolid=True, maxDegree=DEGREE) if e[0] == 3]
    first = list(slots)
    for number in range(1, given["teeth"]):
        copy = occ.copy(first)
        occ.rotate(copy, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0 * math.pi * number / given["teeth"])
        slots += copy
    return [e for e in occ.cut(blank, slots)[0] if e[0] == 3]


body = bevel() if "slot" in given else cylindrical()
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
