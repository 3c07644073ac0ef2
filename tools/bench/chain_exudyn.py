"""The chain of crates/dynamics/tests/problems/chain.rs in Exudyn: chain_exudyn.py LINKS STEPS. Prints milliseconds a step as JSON.

Links of 0.1 m and 0.1 kg on revolute joints with parallel axes, released level, steps of 1 ms: implicit generalized-alpha of index 3,
modified Newton, Exudyn's sparse solver, no output. The time is that of the whole run, its start included.
"""

import json
import sys
import time

import exudyn as exu
import numpy as np
from exudyn.utilities import InertiaCuboid, RigidBodyInertia

LINK = 0.1


def chain(links: int, steps: int) -> tuple[float, list[float]]:
    container = exu.SystemContainer()
    system = container.AddSystem()
    before = system.CreateGround()
    across = 0.1 * LINK * LINK / 12.0
    for link in range(links):
        inertia = RigidBodyInertia(mass=0.1, inertiaTensor=np.diag([1e-6, across, across]))
        body = system.CreateRigidBody(
            inertia=inertia, referencePosition=[(link + 0.5) * LINK, 0, 0], gravity=[0, -9.81, 0]
        )
        system.CreateRevoluteJoint(
            itemNumbers=[before, body], position=[link * LINK, 0, 0], axis=[0, 0, 1], useGlobalFrame=True
        )
        before = body
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = 1e-3 * steps
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.show.computationTime = False
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    begun = time.perf_counter()
    exu.SolveDynamic(system, settings)
    passed = time.perf_counter() - begun
    end = system.GetObjectOutputBody(before, exu.OutputVariableType.Position, localPosition=[0, 0, 0])
    return 1e3 * passed / steps, [float(x) for x in end]


def main() -> None:
    links, steps = int(sys.argv[1]), int(sys.argv[2])
    step_ms, end = chain(links, steps)
    figures = {"step_ms": step_ms, "last_body_m": end, "version": exu.config.Version()}
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
