# SPDX-License-Identifier: BSD-3-Clause
"""The functions read and write: formats, options, errors."""

import sys
from pathlib import Path

import tautline as tl
from checks import DATA, OUT, rejected, run_tests, wording

OUTPUT = OUT / f"io-{Path(sys.executable).name}"  # python3 and pvpython may run at the same time
PLATE = DATA / "plate.vtu"
OUTPUT.mkdir(parents=True, exist_ok=True)


def test_vtk():
    mesh = tl.perturb(PLATE).mesh
    for name in ("plate.vtu", "plate.vtk"):
        file = OUTPUT / name
        assert tl.write(mesh, file) == [str(file)]
        assert (tl.quality(file).values["imr"] == tl.quality(mesh).values["imr"]).all()
    image = tl.metric_field(dimensions=(4, 5, 1)).mesh
    tl.write(image, OUTPUT / "field.vti")
    assert tl.read(OUTPUT / "field.vti").GetDimensions() == (4, 5, 1)
    rejected(wording("vtp-cannot-hold-a-vtkunstructuredgrid-vtk-vtu"), tl.write, mesh, OUTPUT / "plate.vtp")
    rejected(wording("no-writer-for-obj"), tl.write, mesh, OUTPUT / "plate.obj")
    rejected(wording("cannot-be-written"), tl.write, mesh, OUTPUT / "no-such-directory" / "plate.vtu")
    rejected(wording("there-is-no-such-file"), tl.read, OUTPUT / "absent.vtu")
    rejected(".xyz", tl.read, "mesh.xyz")
    broken = OUTPUT / "broken.vtu"
    broken.write_text("<VTKFile type='UnstructuredGrid'><oops>")
    rejected(wording("error-parsing"), tl.read, broken)
    rejected(wording("has-no-options-not-binary"), tl.write, mesh, OUTPUT / "plate.vtu", binary=True)


def test_mesh_generators():
    cube = tl.read(DATA / "cube.1.node")
    assert cube.GetNumberOfCells() == 171
    everything = tl.read(DATA / "cube.1.node", lower_cells=True)
    assert everything.GetNumberOfCells() > 171 + 132

    # every ending that can be written comes back with as many points and cells
    surface = tl.read(DATA / "house.off")
    for ending in (".node", ".mesh", ".msh"):
        files = tl.write(cube, OUTPUT / f"cube{ending}")
        assert files and all(Path(file).is_file() for file in files), files
        again = tl.read(OUTPUT / f"cube{ending}")
        assert (again.GetNumberOfPoints(), again.GetNumberOfCells()) == (73, 171), ending
    for ending in (".off", ".smesh"):
        tl.write(surface, OUTPUT / f"house{ending}")
        assert tl.read(OUTPUT / f"house{ending}").GetNumberOfCells() == 7, ending
    text, binary = (OUTPUT / name for name in ("text.msh", "binary.msh"))
    tl.write(cube, text)
    tl.write(cube, binary, binary=True)
    assert b"4.1 0 8" in text.read_bytes() and b"4.1 1 8" in binary.read_bytes()

    assert tl.read(binary).GetNumberOfCells() == 171
    assert tl.read(DATA / "cube.1.ele", lower_cells=True).GetNumberOfCells() > 171

    (OUTPUT / "broken.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    rejected(wording("broken-off-6-vertex-is-7-from"), tl.read, OUTPUT / "broken.off")
    rejected(wording("there-is-no-such-file"), tl.read, OUTPUT / "none.msh")
    rejected(wording("no-reader-for-docx"), tl.read, "thesis.docx")
    rejected(wording("no-writer-for-docx"), tl.write, cube, "thesis.docx")
    rejected("171 tetrahedra", tl.write, cube, OUTPUT / "cube.poly")
    rejected("tetrahedra", tl.write, cube, OUTPUT / "cube.off")
    rejected(wording("cannot-be-written"), tl.write, cube, OUTPUT / "no" / "such" / "folder.mesh")
    rejected(wording("not-int"), tl.write, 7, OUTPUT / "seven.mesh")
    rejected(wording("always-text"), tl.write, cube, OUTPUT / "cube.mesh", binary=True)


run_tests(globals())
