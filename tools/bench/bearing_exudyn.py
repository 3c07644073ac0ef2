"""The bearing of crates/bearings/benches/moving_balls/beside.rs in Exudyn: bearing_exudyn.py START.json STEP_S SOLVER. Prints one line of JSON.

Exudyn's own bearing (exudyn.machines.CreateBallBearing: rigid balls, one ObjectContactSphereTorus a ball and race, balls on springs to the
cage) with the places and speeds of our start: contact K d^1.5 + c d', friction proportional to the slip up to a zone and constant above, a
shaft that moves across its axis and turns. Implicit generalized-alpha with the spectral radius 0.8. SOLVER is `full` or `modified` (Newton)
and `dense` or `sparse`, as in `modified-sparse`. The time is that of the whole run, its start included.
"""

import json
import sys
import time

import exudyn as exu
import numpy as np
from exudyn.machines import CreateBallBearing, GetBallBearingData
from exudyn.utilities import MarkerBodyRigid, RigidBodyInertia, SensorBody, SensorObject


def build(start: dict) -> tuple:
    """The system, sensors of the inner contacts and the sensor of the cage."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    radius, pitch, f = 0.5 * start["ball_m"], start["pitch_radius_m"], start["conformity"]
    shaft = system.CreateRigidBody(
        inertia=RigidBodyInertia(mass=start["shaft_kg"], inertiaTensor=np.diag(start["shaft_kg_m2"])),
        referencePosition=start["shaft_m"],
        initialAngularVelocity=[0, 0, start["shaft_rad_per_s"]],
    )
    ground = system.CreateGround()
    system.CreateGenericJoint(
        itemNumbers=[shaft, ground],
        position=start["shaft_m"],
        constrainedAxes=[0, 0, 1, 1, 1, 0],
        useGlobalFrame=True,
    )
    system.CreateForce(itemNumber=shaft, loadVector=[0, -start["radial_N"], 0])
    inner = system.AddMarker(MarkerBodyRigid(bodyNumber=shaft))
    outer = system.AddMarker(MarkerBodyRigid(bodyNumber=ground))
    count = len(start["balls"])
    data = GetBallBearingData(
        axis=[0, 0, 1],
        outsideDiameter=2 * (pitch + 2 * radius),
        boreDiameter=2 * (pitch - 2 * radius),
        width=4 * radius,
        nBalls=count,
        radiusBalls=radius,
        radiusCage=pitch,
        innerGrooveRadius=2 * f * radius,
        outerGrooveRadius=2 * f * radius,
        widthCage=start["cage_width_m"],
        heightCage=start["cage_height_m"],
    )
    data["innerGrooveTorusRadius"] += start["widened_m"]
    turns = 2 * np.pi * np.arange(count) / count
    data["ballPositions"] = [pitch * np.array([np.cos(turn), np.sin(turn), 0]) for turn in turns]
    outside, inside = pitch + 0.5 * start["cage_height_m"], pitch - 0.5 * start["cage_height_m"]
    volume = np.pi * (outside**2 - inside**2) * start["cage_width_m"]
    made = CreateBallBearing(
        system,
        data,
        inner,
        outer,
        densityBalls=start["density_kg_per_m3"],
        densityCage=start["cage_kg"] / volume,
        cageInitialAngularVelocity=[0, 0, start["cage_rad_per_s"]],
        springStiffnessCage=start["pocket_N_per_m"],
        contactParametersRingBalls={
            "contactStiffness": start["contact_N_per_m15"],
            "contactStiffnessExponent": 1.5,
            "contactDamping": start["damping_N_s_per_m"],
            "dynamicFriction": start["friction"],
            "frictionProportionalZone": start["zone_m_per_s"],
        },
    )
    # Bodies stand at the inner ring's marker; ours have their middle at the origin.
    bodies = list(zip(made["objectsBalls"], [ball["place_m"] for ball in start["balls"]]))
    for body, place in bodies + [(made["objectCage"], [0.0, 0.0, 0.0])]:
        node = system.GetObject(body)["nodeNumber"]
        reference = np.array(system.GetNode(node)["referenceCoordinates"])
        reference[:3] = place
        system.SetNodeParameter(node, "referenceCoordinates", reference.tolist())
    for body, ball in zip(made["objectsBalls"], start["balls"]):
        node = system.GetObject(body)["nodeNumber"]
        # Rates of Euler parameters of a body that stands in the world's axes: half the spin.
        rates = [*ball["velocity_m_per_s"], 0.0, *(0.5 * np.array(ball["spin_rad_per_s"]))]
        system.SetNodeParameter(node, "initialVelocities", [float(rate) for rate in rates])
    # The contacts are told that all balls carry.
    for contact in made["innerRingBallContacts"] + made["outerRingBallContacts"]:
        node = system.GetObject(contact)["nodeNumber"]
        system.SetNodeParameter(node, "initialCoordinates", [-1e-6, 0, 0, 0])
    loads = [
        system.AddSensor(
            SensorObject(objectNumber=contact, storeInternal=True, outputVariableType=exu.OutputVariableType.Force)
        )
        for contact in made["innerRingBallContacts"]
    ]
    cage = system.AddSensor(
        SensorBody(
            bodyNumber=made["objectCage"],
            storeInternal=True,
            outputVariableType=exu.OutputVariableType.AngularVelocity,
        )
    )
    system.Assemble()
    return system, loads, cage


def main() -> None:
    with open(sys.argv[1]) as file:
        start = json.load(file)
    step, (newton, linear) = float(sys.argv[2]), sys.argv[3].split("-")
    system, loads, cage = build(start)
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(start["end_s"] / step)
    settings.timeIntegration.endTime = start["end_s"]
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    settings.timeIntegration.newton.useModifiedNewton = newton == "modified"
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.adaptiveStep = False
    settings.timeIntegration.discontinuous.maxIterations = 8
    settings.timeIntegration.discontinuous.ignoreMaxIterations = True
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = start["interval_s"]
    settings.show.computationTime = False
    if linear == "sparse":
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    begun = time.perf_counter()
    processor = time.process_time()
    exu.SolveDynamic(system, settings)
    figures = {
        "step_s": step,
        "steps": settings.timeIntegration.numberOfSteps,
        "wall_s": time.perf_counter() - begun,
        "cpu_s": time.process_time() - processor,
        "version": exu.config.Version(),
    }
    # The first record is the start; ours begin an interval later.
    forces = [np.array(system.GetSensorStoredData(load))[1:, 1:4] for load in loads]
    figures["inner_N"] = np.linalg.norm(np.array(forces), axis=2).T.tolist()
    figures["cage_rad_per_s"] = np.array(system.GetSensorStoredData(cage))[1:, 3].tolist()
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
