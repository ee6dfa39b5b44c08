# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of PyVista have Tautline's functions as methods; skipped where PyVista cannot be imported."""

import subprocess
import sys

try:
    import pyvista  # before tautline, which then gives its classes the methods
except ImportError:
    pyvista = None

from checks import DATA, SKIPPED, run_tests

if pyvista is None:
    print("skipped: no PyVista for this VTK (Debian 13: apt-get install python3-pyvista)")
    sys.exit(SKIPPED)

TANGLED = DATA / "bracket-tangled.vtu"


def test_methods():
    mesh = pyvista.read(TANGLED)
    result = mesh.tautline.untangle()
    assert (result.inverted_before, result.inverted) == (41, 0)
    assert isinstance(result.mesh, pyvista.UnstructuredGrid) and result.mesh.n_cells == 8140
    assert result.mesh.tautline.quality(["rr"]).inverted == 0 and "rr" in mesh.tautline.quality("rr").mesh.cell_data
    assert "quality" in dir(mesh.tautline) and "untangle" in mesh.tautline.untangle.__name__
    try:
        mesh.tautline.entangle
        raise AssertionError("there is no such method")
    except AttributeError as error:
        assert "untangle" in str(error), error


def test_surface():
    result = pyvista.Sphere().tautline.perturb(fraction=0.2, seed=1)
    assert isinstance(result.mesh, pyvista.PolyData) and result.mesh.n_cells == pyvista.Sphere().n_cells


def test_other_order():
    """Imported after Tautline, PyVista needs tautline.pyvista."""
    script = f"import tautline, pyvista; m = pyvista.read({str(TANGLED)!r}); assert not hasattr(m, 'tautline')\n"
    script += "import tautline.pyvista; assert m.tautline.quality().inverted == 41"
    subprocess.run([sys.executable, "-c", script], check=True)


run_tests(globals())
