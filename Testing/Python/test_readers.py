# SPDX-License-Identifier: BSD-3-Clause
"""test_readers.py PROGRAM: files of Debian's tetgen or gmsh are read, Tautline's by it; skipped if it is absent."""

import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import tautline
from checks import SKIPPED
from vtkmodules.vtkFiltersVerdict import vtkMeshQuality

DATA = Path(os.environ["TAUTLINE_DATA_DIR"])
OUTPUT = Path(os.environ["TAUTLINE_TEST_DIR"]) / f"interoperability-{sys.argv[1]}"
VOLUME = 1.0  # of cube.smesh and of part.msh


def read(kind, path, lower=False):
    reader = getattr(tautline, f"vtk{kind}Reader")()
    reader.SetFileName(str(path))
    reader.SetLowerCells(lower)
    reader.Update()
    assert reader.GetErrorText() == "", reader.GetErrorText()
    return reader.GetOutput()


def write(kind, mesh, path, **properties):
    writer = getattr(tautline, f"vtk{kind}Writer")()
    writer.SetFileName(str(path))
    writer.SetInputData(mesh)
    for name, value in properties.items():
        getattr(writer, "Set" + name)(value)
    assert writer.Write() == 1, writer.GetErrorText()


def volume(mesh):
    """Sum of the signed volumes of the linear tetrahedra."""
    quality = vtkMeshQuality()
    quality.SetTetQualityMeasureToVolume()
    quality.SetInputData(mesh)
    quality.Update()
    values = quality.GetOutput().GetCellData().GetArray("Quality")
    sizes = [values.GetValue(i) for i in range(values.GetNumberOfTuples()) if mesh.GetCellType(i) == 10]
    assert min(sizes) > 0, "reversed tetrahedra"
    return sum(sizes)


def run(*command):
    done = subprocess.run([str(word) for word in command], cwd=OUTPUT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


def test_tetgen():
    shutil.copy(DATA / "cube.smesh", OUTPUT / "cube.smesh")
    shutil.copy(DATA / "box.poly", OUTPUT / "box.poly")
    for options in ("-pq", "-pqz", "-pqnnfe", "-pqAa0.02", "-pqo2", "-pqo2nnf", "-pqNEF"):
        for old in OUTPUT.glob("cube.1.*"):
            old.unlink()
        if "o2" in options and subprocess.run(["tetgen", options, "cube.smesh"], cwd=OUTPUT, capture_output=True,
                                              check=False).returncode == -signal.SIGSEGV:  # fmt: skip
            print(f"left out: tetgen {options} crashes, as version 1.6 does")
            continue
        told = run("tetgen", options, "cube.smesh")
        if "N" in options:
            continue
        cells = int(re.search(r"Mesh tetrahedra: (\d+)", told).group(1))
        mesh = read("TetGen", OUTPUT / "cube.1.ele", lower=True)
        types = [mesh.GetCellType(i) for i in range(mesh.GetNumberOfCells())]
        assert types.count(24 if "o2" in options else 10) == cells, (options, cells)
        if "o2" not in options:
            assert abs(volume(mesh) - VOLUME) < 1e-9, (options, volume(mesh))
    # tetgen reads what Tautline writes: the surface, and a mesh to refine
    write("TetGen", read("TetGen", DATA / "cube.smesh"), OUTPUT / "ours.poly")
    run("tetgen", "-pq", "ours.poly")
    assert abs(volume(read("TetGen", OUTPUT / "ours.1.node")) - VOLUME) < 1e-9
    write("TetGen", read("TetGen", DATA / "cube.1.ele", lower=True), OUTPUT / "coarse.node")
    run("tetgen", "-rqa0.01", "coarse.node")
    fine = read("TetGen", OUTPUT / "coarse.1.ele")
    assert fine.GetNumberOfCells() > 171 and abs(volume(fine) - VOLUME) < 1e-9


def test_gmsh():
    ours = read("Gmsh", DATA / "part.msh", lower=True)
    for number, properties in enumerate(({}, {"Binary": True})):
        write("Gmsh", ours, OUTPUT / f"ours{number}.msh", **properties)
        for version in ("msh22", "msh41"):
            for binary in ((), ("-bin",)):
                run("gmsh", OUTPUT / f"ours{number}.msh", "-save", "-format", version, *binary, "-o", "theirs.msh")
                theirs = read("Gmsh", OUTPUT / "theirs.msh", lower=True)
                assert theirs.GetNumberOfPoints() == ours.GetNumberOfPoints()
                assert theirs.GetNumberOfCells() == ours.GetNumberOfCells()
                assert abs(volume(theirs) - VOLUME) < 1e-9
                first, second = (m.GetCellData().GetArray("Reference") for m in (ours, theirs))
                count = lambda a, tag: sum(a.GetValue(i) == tag for i in range(a.GetNumberOfTuples()))
                for tag in (5, 10, 20):
                    assert count(first, tag) == count(second, tag) > 0, (version, tag)
    run("gmsh", OUTPUT / "ours0.msh", "-save", "-format", "mesh", "-o", "theirs.mesh")
    assert read("Medit", OUTPUT / "theirs.mesh").GetNumberOfCells() == 243
    write("Gmsh", ours, OUTPUT / "ours.pos")
    told = run("gmsh", OUTPUT / "ours.pos", "-save", "-format", "msh22", "-o", "views.msh")
    assert "Error" not in told and "error" not in told, told
    zoo = read("Medit", DATA / "zoo.mesh")
    write("Gmsh", zoo, OUTPUT / "zoo.msh")
    run("gmsh", OUTPUT / "zoo.msh", "-save", "-format", "msh41", "-o", "zoo2.msh")
    assert read("Gmsh", OUTPUT / "zoo2.msh").GetNumberOfCells() == zoo.GetNumberOfCells()


OUTPUT.mkdir(parents=True, exist_ok=True)
program = sys.argv[1]
if not shutil.which(program):
    print(f"skipped: no {program} on this machine: apt-get install {program}")
    sys.exit(SKIPPED)
{"tetgen": test_tetgen, "gmsh": test_gmsh}[program]()
