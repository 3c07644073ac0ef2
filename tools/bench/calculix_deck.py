"""A CalculiX deck with one static step and one load: calculix_deck.py MESH.vtu OUT.inp ELEMENT.

The element is C3D8I, CalculiX's hexahedron with incompatible modes, the kind of the project's default element, or C3D8,
which has no unknowns but the nodes'. Units m, N, Pa.
"""

import sys

import numpy as np
from gear_mesh import POISSON, YOUNG_PA, GearMesh


def main() -> None:
    gear = GearMesh(sys.argv[1])
    [(node, axis)] = gear.loads(1)
    with open(sys.argv[2], "w") as deck:
        deck.write("*NODE, NSET=ALL\n")
        numbers = np.arange(1, len(gear.points) + 1)
        np.savetxt(deck, np.column_stack([numbers, gear.points]), fmt="%d, %.12e, %.12e, %.12e")
        deck.write(f"*ELEMENT, TYPE={sys.argv[3]}, ELSET=BODY\n")
        numbers = np.arange(1, len(gear.hexahedra) + 1)
        np.savetxt(deck, np.column_stack([numbers, gear.hexahedra + 1]), fmt="%d", delimiter=", ")
        deck.write("*NSET, NSET=BORE\n")
        np.savetxt(deck, gear.bore + 1, fmt="%d")
        deck.write(f"*NSET, NSET=LOADED\n{node + 1}\n")
        deck.write(f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{YOUNG_PA:.6e}, {POISSON}\n")
        deck.write("*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL\n*BOUNDARY\nBORE, 1, 3\n")
        deck.write(f"*STEP\n*STATIC\n*CLOAD\n{node + 1}, {axis + 1}, 1.0\n")
        deck.write("*NODE PRINT, NSET=LOADED\nU\n*END STEP\n")


if __name__ == "__main__":
    main()
