"""The cases of the round robin of bonded models: their particles, bonds and boundaries, as plain data.

    python tests/bonded-round-robin/cases.py

writes the folder `cases` anew. README.md describes the files.
"""

import csv
import json
import math
import os

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "cases")


def sphere(place, radius, density):
    """Position and radius, m, mass, kg, and moment of inertia, kg m2."""
    mass = density * 4 / 3 * math.pi * radius**3
    return [*place, radius, mass, 0.4 * mass * radius**2]


def pin(radius, young, ratio, strength):
    """Stiffnesses of a bond as thick as its two spheres, and its largest force; None: it does not break."""
    area = math.pi * radius**2
    normal = young * area / (2 * radius)
    return stiffnesses(normal, normal / ratio, 0.0, 0.0, strength and strength * area)


def beam(radius, young, poisson, strength):
    """The same of a beam by Timoshenko's theory (shear coefficient 0.9)."""
    length, area, inertia = 2 * radius, math.pi * radius**2, math.pi / 4 * radius**4
    shear_modulus = young / (2 * (1 + poisson))
    phi = 12 * young * inertia / (0.9 * shear_modulus * area * length**2)
    shear = 12 * young * inertia / (length**3 * (1 + phi))
    torsion, bending = shear_modulus * 2 * inertia / length, young * inertia / length
    return stiffnesses(young * area / length, shear, torsion, bending, strength and strength * area)


def stiffnesses(normal, shear, torsion, bending, force):
    names = ["normal_n_m", "shear_n_m", "torsion_n_m_rad", "bending_n_m_rad", "largest_force_n"]
    return dict(zip(names, [normal, shear, torsion, bending, force]))


def touching(places, radius):
    """Pairs of spheres that touch."""
    pairs = []
    for a, one in enumerate(places):
        for b in range(a + 1, len(places)):
            if math.dist(one, places[b]) < 2 * radius * (1 + 1e-6):
                pairs.append((a, b))
    return pairs


def layer(columns, rows, radius, keep):
    """A layer of spheres in a triangular lattice in the plane x, z, of which those with keep(x, z) are kept."""
    places = []
    for row in range(rows):
        for column in range(columns):
            x, z = radius * (2 * column + row % 2), radius * math.sqrt(3) * row
            if keep(x, z):
                places.append((x, 0.0, z))
    return places


def cantilever():
    """Case 1 of Chen et al. 2022."""
    places = [(0.4 * i, 0.0, 0.0) for i in range(11)]
    return {
        "bonds": {"model": "beam", "radius_m": 0.2, "young_modulus_pa": 200e9, "poisson_ratio": 0.3},
        "density_kg_m3": 7850,
        "places": places,
        "held": [0],
        "loaded": [10],
        "force_n": [0, -1e5, 0],
        "ramp_s": 0.5,
        "local_damping": 0.3,
        "time_step_s": 4e-5,
        "end_time_s": 3.0,
    }


PINS = {"model": "pin", "young_modulus_pa": 100e6, "stiffness_ratio": 2.0}


def weak(bonds, **boundary):
    """A bond of two spheres, the first of which is held."""
    return {
        "bonds": {**bonds, "radius_m": 5e-3, "strength_pa": 0.1e6},
        "density_kg_m3": 2500,
        "places": [(0.0, 0.0, 0.0), (0.01, 0.0, 0.0)],
        "held": [0],
        "local_damping": 0.0,
        "time_step_s": 5e-6,
        **boundary,
    }


def weak_pulled():
    return weak(PINS, moved=[1], velocity_m_s=[1e-4, 0, 0], end_time_s=0.15)


def weak_sheared():
    """Across the bond, both spheres without rotation: it breaks by its shear strength."""
    return weak({**PINS, "breaks_by": "shear"}, moved=[1], velocity_m_s=[0, 0, 1e-4], end_time_s=0.25)


def weak_bent():
    """By a force on the free sphere, across the bond, that rises until it breaks."""
    beams = {"model": "beam", "young_modulus_pa": 100e6, "poisson_ratio": 0.3}
    return weak(beams, loaded=[1], force_n=[0, 0, 4.0], ramp_s=1.0, local_damping=0.3, end_time_s=0.5)


def notched_beam():
    """A beam with its ends held, pressed down in the middle above a notch half as deep as itself."""
    radius, columns, rows = 1e-3, 61, 13
    middle = radius * (columns - 1)
    notch = lambda x, z: abs(x - middle) < 1.01 * radius and z < radius * math.sqrt(3) * 6
    places = layer(columns, rows, radius, lambda x, z: not notch(x, z))
    ends = [n for n, (x, _, _) in enumerate(places) if x < 4 * radius or x > 2 * middle - 3 * radius]
    top = radius * math.sqrt(3) * (rows - 1)
    pressed = [n for n, (x, _, z) in enumerate(places) if z > top - 1e-6 and abs(x - middle) < 2.5 * radius]
    return {
        "bonds": {**PINS, "radius_m": radius, "strength_pa": 0.3e6},
        "density_kg_m3": 2500,
        "places": places,
        "held": ends,
        "moved": pressed,
        "velocity_m_s": [0, 0, -0.02],
        "local_damping": 0.3,
        "time_step_s": 1e-6,
        "end_time_s": 0.03,
    }


def disc():
    """A disc pressed between two rows of its spheres."""
    radius, count = 1e-3, 23
    centre = (radius * count, radius * math.sqrt(3) * 13)
    places = layer(count + 1, 27, radius, lambda x, z: math.dist((x, z), centre) < 22.6 * radius)
    low, high = min(z for _, _, z in places), max(z for _, _, z in places)
    near = lambda x: abs(x - centre[0]) < 4.5 * radius
    return {
        "bonds": {**PINS, "radius_m": radius, "strength_pa": 0.3e6},
        "density_kg_m3": 2500,
        "places": places,
        "held": [n for n, (x, _, z) in enumerate(places) if z < low + 1e-6 and near(x)],
        "moved": [n for n, (x, _, z) in enumerate(places) if z > high - 1e-6 and near(x)],
        "velocity_m_s": [0, 0, -0.02],
        "local_damping": 0.3,
        "time_step_s": 1e-6,
        "end_time_s": 0.03,
    }


def drop():
    """A block of a face-centred lattice falls on its edge onto a plate, which has a linear spring without damping."""
    radius, cells = 5e-3, (4, 3, 4)
    side = 2 * radius * math.sqrt(2)
    corners = [(0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5)]
    places = []
    for i in range(cells[0]):
        for j in range(cells[1]):
            for k in range(cells[2]):
                places += [tuple(side * (a + b) for a, b in zip((i, j, k), corner)) for corner in corners]
    angle = math.radians(35)
    turned = [(x * math.cos(angle) + z * math.sin(angle), y, -x * math.sin(angle) + z * math.cos(angle)) for x, y, z in places]
    low = min(z for _, _, z in turned)
    places = [(x, y, z - low + 1.01 * radius) for x, y, z in turned]
    return {
        "bonds": {**PINS, "young_modulus_pa": 10e9, "radius_m": radius, "strength_pa": 8e6},
        "density_kg_m3": 2500,
        "places": places,
        "start_velocity_m_s": [0, 0, -3.0],
        "plate_z_m": 0.0,
        "contact_stiffness_n_m": 1e8,
        "local_damping": 0.0,
        "time_step_s": 1e-7,
        "end_time_s": 4e-4,
    }


CASES = {
    "cantilever": cantilever,
    "weak-bond-pulled": weak_pulled,
    "weak-bond-sheared": weak_sheared,
    "weak-bond-bent": weak_bent,
    "notched-beam": notched_beam,
    "disc": disc,
    "drop": drop,
}


def numbers(values):
    return "[" + ", ".join(repr(float(x)) for x in values) + "]"


def scene(name, case):
    """The scene of dem-run."""
    bond, radius = case["bonds"], case["bonds"]["radius_m"]
    lines = [f"# Case {name} of tests/bonded-round-robin, written by cases.py.", "version = 1", "", "[run]"]
    lines += [f"end_time = {case['end_time_s']!r}", f"time_step = {case['time_step_s']!r}", f"local_damping = {case['local_damping']!r}"]
    lines += ["", "[materials.grain]", f"density = {case['density_kg_m3']}", "young_modulus = 1e9"]
    lines += ["", "[bonds.grain]", f"young_modulus = {bond['young_modulus_pa']!r}"]
    if bond["model"] == "pin":
        lines += ['model = "pin"', f"stiffness_ratio = {bond['stiffness_ratio']}", "poisson_ratio = 0.0"]
    else:
        lines += ['model = "timoshenko"', f"poisson_ratio = {bond['poisson_ratio']}"]
    if "strength_pa" in bond:
        key = "shear_strength" if bond.get("breaks_by") == "shear" else "tensile_strength"
        lines.append(f"failure = {{ {key} = {bond['strength_pa']!r} }}")
    rows = ",\n".join(f"    {numbers([*place, radius])}" for place in case["places"])
    pairs = ", ".join(f"[{a}, {b}]" for a, b in touching(case["places"], radius))
    lines += ["", "[bodies.body]", 'material = "grain"', 'bonds = "grain"', f"particles = [\n{rows},\n]", f"bond_list = [{pairs}]"]
    if "start_velocity_m_s" in case:
        lines.append(f"velocity = {numbers(case['start_velocity_m_s'])}")
    for group in ["held", "moved", "loaded"]:
        if group in case:
            lines += ["", f"[groups.{group}]", f"particles = {case[group]}"]
    if "held" in case:
        lines += ["", "[supports.held]", 'group = "held"', "fixed = true"]
    frames = case["end_time_s"]
    if "moved" in case:
        x, y, z = case["velocity_m_s"]
        axis = "xyz"[max(range(3), key=lambda k: abs(case["velocity_m_s"][k]))]
        lines += ["", "[supports.moved]", 'group = "moved"', f"velocity = {{ x = {x!r}, y = {y!r}, z = {z!r}, rx = 0, ry = 0, rz = 0 }}"]
        lines += ["", "[measures.force]", 'of = "held"', f'quantity = "reaction_{axis}"']
    if "loaded" in case:
        axis = "xyz"[max(range(3), key=lambda k: abs(case["force_n"][k]))]
        lines += ["", "[loads.tip]", 'group = "loaded"', f"force = {numbers(case['force_n'])}", f"ramp = {case['ramp_s']!r}"]
        lines += ["", "[measures.tip]", 'of = "loaded"', f'quantity = "displacement_{axis}"']
    if "plate_z_m" in case:
        law = f'{{ law = "linear", normal_stiffness = {case["contact_stiffness_n_m"]!r}, restitution = 1, friction = 0 }}'
        lines += ["", "[materials.plate]", "rigid = true", "", "[contacts]", f"grain-grain = {law}", f"grain-plate = {law}"]
        lines += ["", "[measures.rebound]", 'of = "body"', 'quantity = "velocity_z"']
        lines += ["", "[walls.plate]", f"plane = {{ point = [0, 0, {case['plate_z_m']!r}], normal = [0, 0, 1] }}", 'material = "plate"']
    lines += ["", "[output]", f"series = {case['end_time_s'] / 500!r}", f"frames = {frames!r}"]
    return "\n".join(lines) + "\n"


def properties(bond):
    """The properties of each bond, all alike."""
    strength = bond.get("strength_pa")
    if bond["model"] == "pin":
        return pin(bond["radius_m"], bond["young_modulus_pa"], bond["stiffness_ratio"], strength)
    return beam(bond["radius_m"], bond["young_modulus_pa"], bond["poisson_ratio"], strength)


def write(name, case):
    folder = os.path.join(FOLDER, name)
    os.makedirs(folder, exist_ok=True)
    radius = case["bonds"]["radius_m"]
    with open(os.path.join(folder, "particles.csv"), "w", newline="\n") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["x_m", "y_m", "z_m", "radius_m", "mass_kg", "inertia_kg_m2"])
        rows.writerows(sphere(place, radius, case["density_kg_m3"]) for place in case["places"])
    with open(os.path.join(folder, "bonds.csv"), "w", newline="\n") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["particle_a", "particle_b"])
        rows.writerows(touching(case["places"], radius))
    stored = {key: value for key, value in case.items() if key != "places"}
    stored["bonds"] = case["bonds"] | properties(case["bonds"])
    with open(os.path.join(folder, "case.json"), "w", newline="\n") as file:
        json.dump(stored, file, indent=1)
        file.write("\n")
    with open(os.path.join(folder, "scene.toml"), "w", newline="\n") as file:
        file.write(scene(name, case))


def main():
    for name, case in CASES.items():
        write(name, case())


if __name__ == "__main__":
    main()
