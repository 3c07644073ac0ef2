"""Gear mesh stiffness: reduce a gear once, then contact positions in microseconds.

    import gearmesh as gm

    pinion = gm.Gear("pinion", teeth=23, module_mm=3, face_width_mm=20, bore_diameter_mm=25, material=gm.STEEL)
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40)
    pair = gm.Pair(pinion.reduce(), wheel.reduce(), centre_distance_mm=94.6, torques_Nm=[50, 100, 200])
    result = pair.run()
    result.plot("te_m")

Names carry units: keywords those of the files (module_mm, torques_Nm), arrays SI (te_m, pressure_Pa).
docs/python.md is the guide.
"""

from ._native import (
    InputError,
    WorkError,
    __version__,
    export_mesh,
    import_mesh,
    mass,
    natural_modes,
    read_mesh,
    read_reduced,
    schema,
    solve,
    stiffness,
    strain,
    write_mesh,
)
from .bearing import Bearing
from .bevel import BevelPair
from .commands import (
    Record,
    accuracy,
    check,
    compliance,
    demo,
    doctor,
    import_rexs,
    init,
    mesh,
    natural_frequencies,
)
from .gear import STEEL, Gear
from .optimise import Optimum, optimise
from .program import program
from .reduced import ReducedGear, reduce
from .result import Result, compare
from .scene import Pair, Scene, run
from .studio import Studio, studio
from .study import Study, StudyResult, study

__all__ = [
    "Bearing",
    "BevelPair",
    "Gear",
    "InputError",
    "Optimum",
    "Pair",
    "Record",
    "ReducedGear",
    "Result",
    "STEEL",
    "Scene",
    "Studio",
    "Study",
    "StudyResult",
    "WorkError",
    "accuracy",
    "check",
    "compare",
    "compliance",
    "demo",
    "doctor",
    "export_mesh",
    "import_mesh",
    "import_rexs",
    "init",
    "mass",
    "mesh",
    "natural_frequencies",
    "natural_modes",
    "optimise",
    "program",
    "read_mesh",
    "read_reduced",
    "reduce",
    "run",
    "schema",
    "solve",
    "stiffness",
    "strain",
    "studio",
    "study",
    "write_mesh",
]
