"""Runs a case of the round robin with YADE, which executes this file: yade -n -x yade_case.py CASE-FOLDER OUTPUT.csv

Bonds of pins are those of JCFpm (Scholtes and Donze 2013), beams those of the cohesive contact with moments
(CohFrictPhys). Stiffnesses and strengths of the case replace those that YADE derives from materials.
"""

import csv
import json
import os
import sys

from yade import *  # noqa: F403: YADE's own names

FOLDER, OUTPUT = sys.argv[1:3]
ROWS = 500

with open(os.path.join(FOLDER, "case.json")) as file:
    CASE = json.load(file)
BOND = CASE["bonds"]
with open(os.path.join(FOLDER, "particles.csv"), newline="") as file:
    PARTICLES = [[float(x) for x in row] for row in list(csv.reader(file))[1:]]
with open(os.path.join(FOLDER, "bonds.csv"), newline="") as file:
    PAIRS = [(int(a), int(b)) for a, b in list(csv.reader(file))[1:]]
PINS = BOND["model"] == "pin"
STRENGTH = BOND["largest_force_n"] or 1e300


def material():
    if PINS:
        return JCFpmMat(young=1e9, poisson=0.5, frictionAngle=0, tensileStrength=1e30, cohesion=1e30, type=1, density=CASE["density_kg_m3"])
    return CohFrictMat(
        young=1e9, poisson=0.5, frictionAngle=0, isCohesive=True, normalCohesion=1e30, shearCohesion=1e30,
        momentRotationLaw=True, etaRoll=-1, etaTwist=-1, density=CASE["density_kg_m3"],
    )


def engines():
    if PINS:
        ways = [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1)]
        laws = [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM(label="law")]
        shapes = [Ig2_Sphere_Sphere_ScGeom(label="spheres"), Ig2_Wall_Sphere_ScGeom()]
    else:
        ways = [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True)]
        laws = [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True)]
        shapes = [Ig2_Sphere_Sphere_ScGeom6D(label="spheres")]
    return [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(aabbEnlargeFactor=1.001, label="boxes"), Bo1_Wall_Aabb()]),
        InteractionLoop(shapes, ways, laws),
        PyRunner(command="before_motion()", iterPeriod=1),
        NewtonIntegrator(damping=CASE["local_damping"], gravity=(0, 0, 0)),
    ]


def place():
    held, moved = set(CASE.get("held", [])), set(CASE.get("moved", []))
    of = material()
    O.materials.append(of)
    for n, (x, y, z, radius, mass, inertia) in enumerate(PARTICLES):
        body = sphere((x, y, z), radius, material=of)
        O.bodies.append(body)
        body.state.mass, body.state.inertia = mass, (inertia,) * 3
        body.state.vel = CASE.get("start_velocity_m_s", (0, 0, 0))
        if n in held | moved:
            body.dynamic = False
            body.state.vel = CASE["velocity_m_s"] if n in moved else (0, 0, 0)
    if "plate_z_m" in CASE:
        O.bodies.append(wall(CASE["plate_z_m"], axis=2, sense=1, material=of))


def join():
    """Makes the bonds, with the properties of the case."""
    spheres.interactionDetectionFactor = 1.001
    O.step()
    wanted = {tuple(sorted(pair)) for pair in PAIRS}
    for i in list(O.interactions):
        pair = tuple(sorted((i.id1, i.id2)))
        if pair not in wanted:
            raise SystemExit(f"{pair} touch, but have no bond")
        wanted.discard(pair)
        i.phys.kn, i.phys.ks = BOND["normal_n_m"], BOND["shear_n_m"]
        i.phys.normalForce = i.phys.shearForce = (0, 0, 0)
        if PINS:
            shears = BOND.get("breaks_by") == "shear"
            i.phys.FnMax, i.phys.FsMax = (1e300, STRENGTH) if shears else (STRENGTH, 1e300)
        else:
            i.phys.ktw, i.phys.kr = BOND["torsion_n_m_rad"], BOND["bending_n_m_rad"]
            i.phys.normalAdhesion = i.phys.shearAdhesion = 1e300
    if wanted:
        raise SystemExit(f"no interaction of {sorted(wanted)[:5]}")
    boxes.aabbEnlargeFactor = spheres.interactionDetectionFactor = 1.0


def broken():
    if PINS:
        return law.nbTensCracks + law.nbShearCracks
    count = 0
    for a, b in PAIRS:
        try:
            i = O.interactions[a, b]
            count += not i.isReal or i.phys.cohesionBroken
        except IndexError:
            count += 1
    return count


STATE = {"rows": [], "first_s": None}
AXIS = max(range(3), key=lambda k: abs((CASE.get("velocity_m_s") or CASE.get("force_n") or [0, 0, 1])[k]))


def before_motion():
    """Loads, contacts of the plate, and what is recorded: forces are those of this step."""
    if "plate_z_m" in CASE:
        plate = O.bodies[len(PARTICLES)]
        for i in plate.intrs():
            if i.isReal and i.phys.kn != CASE["contact_stiffness_n_m"]:
                i.phys.kn, i.phys.ks = CASE["contact_stiffness_n_m"], 0.0
    if "force_n" in CASE:
        part = min(1.0, O.time / CASE["ramp_s"])
        for n in CASE["loaded"]:
            O.forces.addF(n, Vector3(CASE["force_n"]) * part)
    every = 1 if PINS else 20
    if O.iter % every == 0 and STATE["first_s"] is None and broken():
        STATE["first_s"] = O.time
    if O.iter % max(1, round(CASE["end_time_s"] / O.dt / ROWS)) == 0:
        force = sum(O.forces.f(n)[AXIS] for n in CASE.get("held", []))
        tip = sum(O.bodies[n].state.pos[AXIS] - PARTICLES[n][AXIS] for n in CASE.get("loaded", []))
        STATE["rows"].append([O.time, abs(force), tip, broken()])


place()
O.dt = 1e-30
O.engines = engines()
join()
O.dt = CASE["time_step_s"]
O.run(round(CASE["end_time_s"] / O.dt), True)
rises = sum(O.bodies[n].state.vel[2] for n in range(len(PARTICLES))) / len(PARTICLES)
with open(OUTPUT, "w", newline="") as file:
    rows = csv.writer(file, lineterminator="\n")
    rows.writerow(["time_s", "force_n", "tip_m", "broken_bonds"])
    rows.writerows(STATE["rows"])
with open(OUTPUT + ".json", "w") as file:
    json.dump({"first_break_s": STATE["first_s"], "rises_m_s": rises}, file)
