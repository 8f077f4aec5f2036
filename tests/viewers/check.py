"""Checks that other programs open results as they are: VTK, OVITO and ParaView.

    pip install vtk ovito        (in a virtual environment)
    python tests/viewers/check.py DEM-RUN RESULTS

DEM-RUN: the program; RESULTS: the folder of a run with walls and fragments, such as that of
data/scenes/jaw-crusher.toml. ParaView is checked if pvbatch is installed. A module that is missing is named and left out;
the exit code is 1 if a check fails.
"""

import csv
import math
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree


def same(found, wanted, what):
    if found != wanted:
        sys.exit(f"FAILED: {what}: {found!r}, not {wanted!r}")


def close(found, wanted, share, what):
    if not math.isclose(found, wanted, rel_tol=share, abs_tol=1e-30):
        sys.exit(f"FAILED: {what}: {found!r}, not {wanted!r}")


def index(results):
    """The files of each time: [(time, {part: path})]."""
    times = {}
    for entry in ElementTree.parse(os.path.join(results, "frames.pvd")).iter("DataSet"):
        parts = times.setdefault(float(entry.get("timestep")), {})
        parts[int(entry.get("part"))] = os.path.join(results, entry.get("file"))
    return sorted(times.items())


def rows(results, name):
    with open(os.path.join(results, name), newline="") as file:
        return list(csv.DictReader(file))


def read_vtk(path):
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    same(reader.GetErrorCode(), 0, path)
    return reader.GetOutput()


def names(data):
    return {data.GetAbstractArray(n).GetName(): data.GetAbstractArray(n) for n in range(data.GetNumberOfArrays())}


def check_vtk(results):
    series = {float(row["time_s"]): row for row in rows(results, "series.csv")}
    triangles, forces = 0, 0
    for time, parts in index(results):
        frame = read_vtk(parts[0])
        fields = names(frame.GetFieldData())
        same(fields["TimeValue"].GetValue(0), time, "time of a frame")
        points, cells = names(frame.GetPointData()), names(frame.GetCellData())
        for array in points.values():
            same(array.GetNumberOfTuples(), frame.GetNumberOfPoints(), array.GetName())
        for array in cells.values():
            same(array.GetNumberOfTuples(), frame.GetNumberOfLines(), array.GetName())
        ids = points["particle_id"]
        same(len({ids.GetValue(i) for i in range(frame.GetNumberOfPoints())}), frame.GetNumberOfPoints(), "ids")
        bodies = points["body"]
        if frame.GetNumberOfPoints():
            assert bodies.GetRange()[1] < fields["body_names"].GetNumberOfValues()
        if 1 not in parts:
            continue
        walls = read_vtk(parts[1])
        fields, cells = names(walls.GetFieldData()), names(walls.GetCellData())
        same(fields["TimeValue"].GetValue(0), time, "time of walls")
        walls_of = [fields["wall_names"].GetValue(n) for n in range(fields["wall_names"].GetNumberOfValues())]
        same(walls.GetNumberOfPolys(), walls.GetNumberOfCells(), "cells of walls are polygons")
        triangles = max(triangles, walls.GetNumberOfPolys())
        for name in ["wall", "force_n", "velocity_m_s"]:
            same(cells[name].GetNumberOfTuples(), walls.GetNumberOfPolys(), name)
        row = series.get(time)
        for number, name in enumerate(walls_of):
            if row:
                for k, axis in enumerate("xyz"):
                    wanted = float(row[f"wall_{name}_force_{axis}_n"])
                    close(fields["wall_force_n"].GetComponent(number, k), wanted, 1e-15, f"force on {name}")
                    forces += wanted != 0.0
        for cell in range(walls.GetNumberOfPolys()):
            same(walls.GetCell(cell).GetNumberOfPoints(), 3, "corners of a triangle")
        if 2 in parts:
            triangles += read_vtk(parts[2]).GetNumberOfPolys()
    from vtkmodules.vtkCommonCore import vtkVersion

    print(f"VTK {vtkVersion.GetVTKVersion()}: {len(index(results))} frames, {triangles} triangles of walls, {forces} forces as in series.csv")


def check_ovito(program, results, folder):
    import ovito
    from ovito.io import import_file
    from ovito.modifiers import LoadTrajectoryModifier

    dump, bonds = os.path.join(folder, "frames.dump"), os.path.join(folder, "bonds.dump")
    export = [program, "export", results, "--to", "lammps-dump", "-o", dump, "--bonds", bonds, "-q"]
    subprocess.run([*export, "--walls", os.path.join(folder, "walls")], check=True)
    pipeline = import_file(dump)
    times = index(results)
    same(pipeline.num_frames, len(times), "number of frames")
    for number, (time, parts) in enumerate(times):
        frame = read_vtk(parts[0])
        data = pipeline.compute(number)
        same(data.particles.count, frame.GetNumberOfPoints(), "number of particles")
        close(data.attributes["Time"], time, 1e-15, "time")
        radii = names(frame.GetPointData())["radius_m"]
        place = {int(i): n for n, i in enumerate(data.particles.identifiers)}
        ids = names(frame.GetPointData())["particle_id"]
        for i in range(0, frame.GetNumberOfPoints(), max(1, frame.GetNumberOfPoints() // 500)):
            n = place[int(ids.GetValue(i)) + 1]
            close(data.particles["Radius"][n], radii.GetValue(i), 1e-6, "radius")
            for k in range(3):
                close(data.particles.positions[n][k], frame.GetPoint(i)[k], 1e-6, "position")
            kind = data.particles.particle_types.type_by_id(int(data.particles.particle_types[n])).name
            bodies = names(frame.GetFieldData())["body_names"]
            same(kind, bodies.GetValue(int(names(frame.GetPointData())["body"].GetValue(i))), "name of a type")
    # Bonds: the dump of local data as a trajectory of bonds. The first column is not used.
    modifier = LoadTrajectoryModifier()
    columns = ["", "Bond Type", "Particle Identifiers.1", "Particle Identifiers.2", "Width"]
    modifier.source.load(bonds, columns=columns)
    pipeline.modifiers.append(modifier)
    number, (_, parts) = len(times) - 1, times[-1]
    frame = read_vtk(parts[0])
    broken = names(frame.GetCellData()).get("broken")
    intact = sum(broken.GetValue(i) == 0 for i in range(frame.GetNumberOfLines())) if broken else 0
    data = pipeline.compute(number)
    same(data.particles.bonds.count if data.particles.bonds else 0, intact, "number of bonds")
    if intact:
        unbroken = [i for i in range(frame.GetNumberOfLines()) if broken.GetValue(i) == 0]
        ids, radii = names(frame.GetPointData())["particle_id"], names(frame.GetCellData())["bond_radius_m"]
        for n, i in enumerate(unbroken):
            ends = [frame.GetCell(i).GetPointId(end) for end in (0, 1)]
            wanted = [int(ids.GetValue(end)) + 1 for end in ends]
            found = [int(data.particles.identifiers[end]) for end in data.particles.bonds.topology[n]]
            same(sorted(found), sorted(wanted), "ends of a bond")
            close(data.particles.bonds["Width"][n], 2 * radii.GetValue(i), 1e-6, "width of a bond")
    walls = import_file(os.path.join(folder, "walls", "walls_*.stl"))
    mesh = walls.compute(walls.num_frames - 1).objects[-1]
    files = [path for part, path in parts.items() if part > 0]
    same(mesh.face_count, sum(read_vtk(path).GetNumberOfPolys() for path in files), "triangles of walls")
    version = ".".join(map(str, ovito.version))
    print(f"OVITO {version}: {pipeline.num_frames} frames, {data.particles.count} particles and {intact} bonds at the end")


def check_paraview(results, folder):
    picture = os.path.join(folder, "picture.png")
    script = os.path.join(os.path.dirname(__file__), "../../data/viewers/paraview_results.py")
    # Without a screen, ParaView draws into a virtual one.
    screen = ["xvfb-run", "-a"] if "DISPLAY" not in os.environ and shutil.which("xvfb-run") else []
    command = [*screen, "pvbatch", script, results, picture]
    said = subprocess.run(command, capture_output=True, text=True)
    if said.returncode != 0:
        sys.exit(f"FAILED: ParaView: {said.stdout}{said.stderr}")
    found = dict(line.split(" ", 1) for line in said.stdout.splitlines() if " " in line)
    times = index(results)
    frame = read_vtk(times[-1][1][0])
    wanted = f"{len(times)} last {times[-1][0]} particles {frame.GetNumberOfPoints()}"
    same(found["frames"], wanted, "frames in ParaView")
    same(os.path.exists(picture), True, "picture")
    walls = [read_vtk(path).GetNumberOfPolys() for part, path in times[-1][1].items() if part > 0]
    same(int(found["walls"]), sum(walls), "triangles of walls in ParaView")
    print(f"ParaView: frames {found['frames']}, {found['tubes']} cells of tubes, {found['walls']} triangles of walls")


def main():
    program, results = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        try:
            check_vtk(results)
        except ModuleNotFoundError as missing:
            sys.exit(f"needs the module {missing.name}: pip install vtk")
        try:
            check_ovito(program, results, folder)
        except ModuleNotFoundError as missing:
            print(f"OVITO: left out, no module {missing.name}")
        if shutil.which("pvbatch"):
            check_paraview(results, folder)
        else:
            print("ParaView: left out, no pvbatch")


main()
