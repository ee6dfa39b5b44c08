# SPDX-License-Identifier: BSD-3-Clause
"""Certificates of valid elements: bounds by the kernel, their check by other means, tampering, the shell."""

import json
import warnings

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, wording
from tautline._certificate import FORMAT, REFUTED
from tautline._determinants import above, coefficients, derivatives, domain_of
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

FOLDER = OUT / "certificate"
FOLDER.mkdir(exist_ok=True)
ORDERS = DATA / "orders.msh"


def cells_of(kinds, bend=0.0, seed=1) -> vtkUnstructuredGrid:
    """The cells of some types of the sample file with one element of each type, with nodes moved at random."""
    mesh = tl.read(ORDERS, lower_cells=True)
    made = vtkUnstructuredGrid()
    for cell in range(mesh.GetNumberOfCells()):
        if mesh.GetCellType(cell) in kinds:
            made.InsertNextCell(mesh.GetCellType(cell), mesh.GetCell(cell).GetPointIds())
    x = np.array(vtk_to_numpy(mesh.GetPoints().GetData()))
    x += bend * np.random.default_rng(seed).uniform(-1, 1, x.shape)
    made.SetPoints(mesh.GetPoints())
    made.GetPoints().SetData(numpy_to_vtk(x, deep=True))
    return made


#: Types and how far their nodes may move, so that some are valid and some are not.
BENDS = {(10, 12, 13, 14): 0.35, (24, 25, 26, 27, 29, 32): 0.13, (71,): 0.05, (72, 73): 0.05}


def test_bounds():
    """Bounds are below the determinants at many points, and near the smallest of them; verdicts follow from them."""
    for kinds, bend in BENDS.items():
        verdicts = set()
        for seed in range(12):
            mesh = cells_of(kinds, bend, seed)
            made = tl.certificate(mesh)
            assert made["cells"] == len(made["elements"]) == mesh.GetNumberOfCells() > 0
            result = tl.quality(mesh, "min_jacobian")
            for cell, (verdict, bound) in enumerate(made["elements"]):
                verdicts.add(verdict)
                least = result.values["min_jacobian"][cell]
                assert (verdict == "valid") == (bound > 0) == (result.validity[cell] == 1), (kinds, seed, cell)
                assert bound <= least + 1e-12 and least - bound < 1e-4, (kinds, seed, cell, bound, least)
            assert made["valid"] == sum(verdict == "valid" for verdict, _ in made["elements"])
        assert {"valid", "invalid"} <= verdicts, (kinds, verdicts)


def test_verified():
    """The check by VTK's shape functions agrees, for all types, and refutes bounds that are too high."""
    for kinds, bend in BENDS.items():
        for seed in (1, 2):
            mesh = cells_of(kinds, bend, seed)
            made = tl.certificate(mesh)
            found = tl.verify_certificate(mesh, made)
            assert found and found.holds and found.valid == made["valid"], (kinds, seed, found.problems)
            for cell, (_, bound) in enumerate(made["elements"]):
                forged = json.loads(json.dumps(made))
                forged["elements"][cell] = ["valid", max(2 * bound, 1e-3 if bound <= 0 else 0)]
                found = tl.verify_certificate(mesh, forged)
                assert not found and f"({cell})" in " ".join(found.problems), (kinds, seed, cell, bound)


def test_planes_and_surfaces():
    plane = (5, 9, 22, 23, 28, 69, 70)
    flat = cells_of(plane)
    for mesh, flip in ((flat, 1), (flat, -1)):
        x = points(mesh)
        x[:, 2] = 0
        x[:, 1] *= flip
        mesh.GetPoints().SetData(numpy_to_vtk(x, deep=True))
        made = tl.certificate(mesh)
        assert made["valid"] == made["cells"] == 9 and tl.verify_certificate(mesh, made), made
    surface = cells_of(plane, 0.03)
    made = tl.certificate(surface)
    found = tl.verify_certificate(surface, made)
    assert found and 0 < made["valid"] <= 9, found.problems


def test_sample():
    """A polynomial of one cell by hand: of the triangle with a middle node at (c, c), the least value is 4 c - 1."""
    for c in (0.24, 0.26, 0.4):
        mesh = vtkUnstructuredGrid()
        places = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0.5, 0, 0), (c, c, 0), (0, 0.5, 0)]
        mesh.SetPoints(tl.from_arrays(np.array(places, float), np.array([(0, 1, 2)])).GetPoints())
        mesh.InsertNextCell(22, 6, list(range(6)))
        domain = domain_of(22, 6, (0, 0, 0))
        found = coefficients(domain, derivatives(mesh, 0, domain), points(mesh)[None])[..., 2]
        least = 4 * c - 1
        assert above(domain, found, np.array([least - 1e-9])) and not above(domain, found, np.array([least + 1e-9]))
        assert abs(tl.certificate(mesh)["elements"][0][1] - least) < 1e-7


def test_turned_wedges():
    """Curved wedges in the order of nodes that fewer programs have are also valid, and announced."""
    for kind in (26, 32, 73):
        for turned in (False, True):
            mesh = cells_of((kind,))
            x = np.array(points(mesh))
            x[:, 2] *= -1 if turned else 1
            mesh.GetPoints().SetData(numpy_to_vtk(x, deep=True))
            result = tl.quality(mesh, "min_jacobian")
            assert (result.validity == 1).all() and (result.values["min_jacobian"] > 0.5).all(), (kind, turned)
            assert (wording("curved-wedges-list-their-nodes") in result.notice) == turned, (kind, turned, result.notice)
            assert tl.verify_certificate(mesh, tl.certificate(mesh)), (kind, turned)


def test_tampering():
    mesh = cells_of((24, 25), 0.02)
    made = tl.certificate(mesh, FOLDER / "part.json")
    assert json.loads((FOLDER / "part.json").read_text()) == made and made["format"] == FORMAT
    assert tl.verify_certificate(mesh, FOLDER / "part.json")
    mesh.GetPoints().SetPoint(mesh.GetCell(0).GetPointId(4), 0.5, 0.25, 0.125)
    assert not tl.verify_certificate(mesh, FOLDER / "part.json")
    (FOLDER / "other.json").write_text("{}")
    rejected(wording("is-no-certificate-of-this-version"), tl.verify_certificate, mesh, FOLDER / "other.json")
    (FOLDER / "other.json").write_text("[1, 2")
    rejected(wording("is-no-json"), tl.verify_certificate, mesh, FOLDER / "other.json")
    rejected(wording("has-no-list-of-elements"), tl.verify_certificate, mesh, dict(made, elements=[1]))


def test_shell():
    mesh = cells_of((24,), 0.0)
    tl.write(mesh, FOLDER / "part.vtu")
    file, proof = str(FOLDER / "part.vtu"), str(FOLDER / "shell.json")
    shell("quality", file, "--certificate", proof)
    assert json.loads((FOLDER / "shell.json").read_text())["valid"] == 1
    assert json.loads(shell("quality", file, "--verify", proof, "--json"))["certificate"]["holds"] is True
    mesh.GetPoints().SetPoint(mesh.GetCell(0).GetPointId(9), 9, 9, 9)
    tl.write(mesh, FOLDER / "other.vtu")
    shell("quality", FOLDER / "other.vtu", "--verify", proof, code=REFUTED)


run_tests(globals())
