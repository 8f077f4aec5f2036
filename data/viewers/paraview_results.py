"""Shows the results of a run in ParaView: spheres by their radius, unbroken bonds as tubes, walls translucent.

    cd RESULTS && paraview --script=.../data/viewers/paraview_results.py
    pvbatch .../data/viewers/paraview_results.py RESULTS [PICTURE.png]

ParaView runs it without arguments: the results are those of the working directory, or of the environment variable
CRUMBLE_RESULTS. With a picture it saves the last frame. ParaView 5.10 or later.
"""

import glob
import os
import sys

from paraview.simple import (
    ColorBy,
    ExtractSurface,
    GetActiveViewOrCreate,
    GetAnimationScene,
    Glyph,
    Render,
    ResetCamera,
    SaveScreenshot,
    Show,
    Threshold,
    Tube,
    XMLPolyDataReader,
)


def files(folder, name):
    """The files of one kind, in the order of time."""
    return sorted(glob.glob(os.path.join(folder, "frames", name)))


def reader(names, label):
    """A series of files; each holds its time in the field TimeValue."""
    source = XMLPolyDataReader(registrationName=label, FileName=names)
    if "TimeArray" in source.ListProperties():
        source.TimeArray = "TimeValue"
    return source


def show_spheres(frames, view):
    # The glyph has the radius 0.5.
    spheres = Glyph(registrationName="particles", Input=frames, GlyphType="Sphere")
    spheres.OrientationArray = ["POINTS", "No orientation array"]
    spheres.ScaleArray = ["POINTS", "radius_m"]
    spheres.ScaleFactor = 2.0
    spheres.GlyphMode = "All Points"
    names = frames.PointData.keys()
    colour = "fragment_id" if "fragment_id" in names else "body"
    display = Show(spheres, view)
    ColorBy(display, ("POINTS", colour))
    return spheres, display


def show_bonds(frames, view):
    if "broken" not in frames.CellData.keys() or frames.GetDataInformation().GetNumberOfCells() == 0:
        return None
    intact = Threshold(registrationName="intact bonds", Input=frames, Scalars=["CELLS", "broken"])
    intact.LowerThreshold = 0.0
    intact.UpperThreshold = 0.0
    lines = ExtractSurface(registrationName="lines of bonds", Input=intact)
    low, high = frames.PointData["radius_m"].GetRange()
    tubes = Tube(registrationName="bonds", Input=lines, Radius=0.3 * low if low > 0 else 0.1 * high)
    ColorBy(Show(tubes, view), ("CELLS", "utilisation"))
    return tubes


def show_walls(folder, view):
    shown = []
    for label, pattern in [("walls", "walls_[0-9]*.vtp"), ("fixed walls", "walls_fixed.vtp")]:
        names = files(folder, pattern)
        if names:
            walls = reader(names, label)
            display = Show(walls, view)
            display.Opacity = 0.3
            shown.append(walls)
    return shown


def main(folder, picture=None):
    names = files(folder, "frame_[0-9]*.vtp")
    if not names:
        sys.exit(f"{folder}: no frames; name the folder of results of a run")
    view = GetActiveViewOrCreate("RenderView")
    frames = reader(names, "frames")
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    frames.UpdatePipeline()
    spheres, display = show_spheres(frames, view)
    tubes = show_bonds(frames, view)
    walls = show_walls(folder, view)
    scene.GoToLast()
    display.RescaleTransferFunctionToDataRange(False, True)
    # From the front, the right and above, z upwards.
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = [1, -2, 1]
    view.CameraViewUp = [0, 0, 1]
    ResetCamera(view)
    Render(view)
    if picture:
        SaveScreenshot(picture, view, ImageResolution=[960, 540])
        times = list(frames.TimestepValues)
        particles = frames.GetDataInformation().GetNumberOfPoints()
        print(f"frames {len(times)} last {times[-1]} particles {particles}")
        print(f"spheres {spheres.GetDataInformation().GetNumberOfPoints()}")
        print(f"tubes {tubes.GetDataInformation().GetNumberOfCells() if tubes else 0}")
        print(f"walls {sum(w.GetDataInformation().GetNumberOfCells() for w in walls)}")


arguments = sys.argv[1:]
main(*(arguments[:2] or [os.environ.get("CRUMBLE_RESULTS", ".")]))
