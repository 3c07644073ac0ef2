"""A bevel gear as STEP by gmsh's OCC kernel. A description on standard input (JSON, millimetres, the member's frame), the file as argument; what the
file's flanks and fillets are off the exact ones on standard output (JSON).

The outline of a tooth in each section from toe to heel is made of splines through exact points: bottom, fillet, flank, tip. The sections are skinned
piece by piece. Ends and body are ruled between the outline and rings about the axis. One tooth's faces are copied round the axis and sewn together.
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
teeth, sections, rings = given["teeth"], given["sections"], given["rings"]
# Rings that the bore is skinned over.
BORE_RINGS = 9
gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
occ = gmsh.model.occ


def outline(pieces):
    """Wire through the pieces of a tooth's outline, from the middle of a tooth space to the next."""
    curves, last = [], None
    for points in pieces:
        begin = occ.addPoint(*points[0]) if last is None else last
        last = occ.addPoint(*points[-1])
        inner = [occ.addPoint(*p) for p in points[1:-1]]
        curves.append(occ.addSpline([begin, *inner, last]) if inner else occ.addLine(begin, last))
    return occ.addWire(curves)


def azimuths(pieces):
    """Angles about the axis of the ends of the pieces, from the first to the last."""
    ends = [pieces[0][0]] + [points[-1] for points in pieces]
    return [math.atan2(y, x) for x, y, _ in ends]


def ring(angles, radius, z):
    """Wire of arcs at a radius and height between these angles."""
    centre = occ.addPoint(0.0, 0.0, z)
    around = [occ.addPoint(radius * math.cos(a), radius * math.sin(a), z) for a in angles]
    return occ.addWire([occ.addCircleArc(a, centre, b) for a, b in zip(around, around[1:])])


def skinned(wires, ruled):
    return [e for e in occ.addThruSections(wires, makeSolid=False, makeRuled=ruled) if e[0] == 2]


tooth = skinned([outline(pieces) for pieces in sections], False)
# From the outlines of toe and heel down to the bore: between each two a ruled surface.
turns = [azimuths(sections[0]), azimuths(sections[-1])]
for section, angles, circles in zip((sections[0], sections[-1]), turns, (rings["toe"], rings["heel"])):
    tooth += skinned([outline(section), ring(angles, *circles[0])], True)
    for inner, outer in zip(circles[1:], circles):
        tooth += skinned([ring(angles, *outer), ring(angles, *inner)], True)
# The bore turns with the tooth from toe to heel, so that its edges are those of the ends.
bore = []
for k in range(BORE_RINGS):
    share = k / (BORE_RINGS - 1)
    (radius, toe_z), (_, heel_z) = rings["toe"][-1], rings["heel"][-1]
    angles = [a + share * (b - a) for a, b in zip(*turns)]
    bore.append(ring(angles, radius, toe_z + share * (heel_z - toe_z)))
tooth += skinned(bore, False)
faces = list(tooth)
for number in range(1, teeth):
    copy = occ.copy(tooth)
    occ.rotate(copy, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0 * math.pi * number / teeth)
    faces += copy
body = [(3, occ.addVolume([occ.addSurfaceLoop([tag for _, tag in faces], sewing=True)]))]
occ.synchronize()
# The solid alone, without the faces and curves that it was made of.
gmsh.option.setNumber("Geometry.OCCExportOnlyVisible", 1)
gmsh.model.setVisibility(gmsh.model.getEntities(), 0)
gmsh.model.setVisibility(body, 1, True)
gmsh.write(sys.argv[1])

# What was written, against the exact surfaces: the file itself is read again.
gmsh.clear()
occ.importShapes(sys.argv[1])
occ.synchronize()
faces = [tag for _, tag in gmsh.model.getEntities(2)]
boxes = {tag: gmsh.model.getBoundingBox(2, tag) for tag in faces}


def near(tag, points):
    low, high = boxes[tag][:3], boxes[tag][3:]
    return any(all(a - 1e-3 <= x <= b + 1e-3 for a, x, b in zip(low, p, high)) for p in points)


def distance(tags, point):
    return min(math.dist(gmsh.model.getClosestPoint(2, tag, point)[0], point) for tag in tags)


off = {}
for name, points in given["checked"].items():
    candidates = [tag for tag in faces if near(tag, points)]
    off[name] = max(distance(candidates, point) for point in points)
solids = gmsh.model.getEntities(3)
volume = sum(occ.getMass(*e) for e in solids)
told = {"largest_error_mm": max(off.values()), "errors_mm": off, "faces": len(faces), "solids": len(solids), "volume_mm3": volume}
json.dump(told, answer)
gmsh.finalize()
if len(solids) != 1:
    sys.exit(f"{len(solids)} solids instead of one")
