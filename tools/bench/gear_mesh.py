"""The mesh that `gearmesh mesh -o X.vtu` writes, as arrays, with the bore and the loads that all comparisons use."""

import meshio
import numpy as np

YOUNG_PA, POISSON = 210e9, 0.3


class GearMesh:
    """Points [m], hexahedra in VTK's order, nodes of the held bore, nodes of all flanks in the order of the teeth."""

    def __init__(self, path: str):
        mesh = meshio.read(path)
        self.points = mesh.points
        self.hexahedra = mesh.cells_dict["hexahedron"]
        self.bore = np.flatnonzero(mesh.point_data["set:bore"])
        names = [name for name in mesh.point_data if name.endswith("_flank")]
        names.sort(key=lambda name: (int(name.removeprefix("set:tooth").split("_")[0]), name))
        self.flank_nodes = np.concatenate([np.flatnonzero(mesh.point_data[name]) for name in names])

    def loads(self, count: int) -> list[tuple[int, int]]:
        """Node and axis of `count` unit loads: in x and in y at one flank node after the other."""
        loads = [(int(node), axis) for node in self.flank_nodes for axis in (0, 1)]
        if len(loads) < count:
            raise SystemExit(f"the flanks have nodes for {len(loads)} loads only, {count} are wanted")
        return loads[:count]
