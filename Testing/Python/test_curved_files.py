# SPDX-License-Identifier: BSD-3-Clause
"""Files of quadratic and Lagrange cells come back without loss: nodes, orders, types; by every format that has them."""

import struct
import subprocess
import sys
import warnings
from importlib.util import find_spec

import numpy as np
import tautline as tl
from checks import DATA, OUT, points, rejected, run_tests, shell, wording
from tautline._arrays import leaves
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid

FOLDER = OUT / "curved-files"
FOLDER.mkdir(exist_ok=True)
ORDERS = DATA / "orders.msh"
#: VTK's linear cells, and its quadratic ones.
LINES, LINEAR = (3, 21, 68), (5, 9, 10, 12, 13, 14)
QUADRATIC = (22, 23, 24, 25, 26, 27, 28, 29, 32)
MESHIO = find_spec("meshio") is not None


def grid_of(wanted) -> vtkUnstructuredGrid:
    """The cells of some types of the sample file, curved by a quadratic map that no symmetry leaves as it is."""
    mesh = tl.read(ORDERS, lower_cells=True)
    made = vtkUnstructuredGrid()
    made.SetPoints(mesh.GetPoints())
    for cell in range(mesh.GetNumberOfCells()):
        if mesh.GetCellType(cell) in wanted:
            made.InsertNextCell(mesh.GetCellType(cell), mesh.GetCell(cell).GetPointIds())
    x = np.array(vtk_to_numpy(made.GetPoints().GetData()))
    u = x - 2 * np.floor(x[:, :1] / 2) * [1, 0, 0]
    bent = x + 0.03 * np.stack([u[:, 1] * u[:, 2], u[:, 0] ** 2, u[:, 0] * u[:, 1] + u[:, 2] ** 2], axis=1)
    made.GetPoints().SetData(numpy_to_vtk(bent, deep=True))
    return made


def cells(mesh) -> list[tuple[int, list[list[float]]]]:
    """The type and the places of the nodes of each cell, whatever numbers these have."""
    x = points(mesh)
    return [(mesh.GetCellType(c), [x[mesh.GetCell(c).GetPointId(i)].tolist()
                                   for i in range(mesh.GetCell(c).GetNumberOfPoints())])
            for c in range(mesh.GetNumberOfCells())]  # fmt: skip


def check_same(found, expected, tolerance: float, name: str) -> None:
    mine, its = cells(found), cells(expected)
    assert [kind for kind, _ in mine] == [kind for kind, _ in its], (name, [k for k, _ in mine], [k for k, _ in its])
    for (kind, here), (_, there) in zip(mine, its):
        assert np.allclose(here, there, rtol=0, atol=tolerance), (name, kind)


def test_vtk_files():
    """Every type, orders that differ by axis, and the array HigherOrderDegrees."""
    grid = grid_of((*LINES, *LINEAR, *QUADRATIC, 69, 70, 71, 72, 73))
    assert grid.GetNumberOfCells() == 29
    first = grid.GetNumberOfPoints()
    for j in range(3):  # a quadrilateral of the orders 3 and 2
        for i in range(4):
            grid.GetPoints().InsertNextPoint(70 + i / 3, j / 2 + 0.05 * i * i, 0)
    nodes = [first + i for i in (0, 3, 11, 8, 1, 2, 7, 9, 10, 4, 5, 6)]
    grid.InsertNextCell(70, len(nodes), nodes)
    third = [c for c in range(29) if grid.GetCell(c).GetNumberOfPoints() in (4, 10, 16, 20, 64, 40)]
    rows = [[3 if c in third else 4] * 3 for c in range(29)] + [[3, 2, 0]]
    degrees = numpy_to_vtk(np.array(rows, float), deep=True)
    degrees.SetName("HigherOrderDegrees")
    grid.GetCellData().SetHigherOrderDegrees(degrees)
    quality = tl.quality(grid, "min_jacobian")
    for name in ("a.vtu", "a.vtk"):
        tl.write(grid, FOLDER / name)
        found = tl.read(FOLDER / name)
        check_same(found, grid, 0, name)
        orders = found.GetCellData().GetHigherOrderDegrees()
        assert orders is not None and orders.GetTuple3(29) == (3, 2, 0), name
        again = tl.quality(found, "min_jacobian")
        assert np.array_equal(again.values["min_jacobian"], quality.values["min_jacobian"]), name


def test_gmsh():
    grid = grid_of((*LINES, *LINEAR, *QUADRATIC, 69, 70, 71, 72, 73))
    for binary in (False, True):
        tl.write(grid, FOLDER / "a.msh", binary=binary)
        check_same(tl.read(FOLDER / "a.msh", lower_cells=True), grid, 0, "a.msh")
        moved = tl.read(FOLDER / "a.msh", lower_cells=True)
        moved.GetPoints().SetPoint(300, 1.0, 2.0, 1 / 3)
        tl.write(moved, FOLDER / "b.msh", template=FOLDER / "a.msh")
        check_same(tl.read(FOLDER / "b.msh", lower_cells=True), moved, 0, "b.msh")


def test_solver_files():
    """Abaqus and MED by meshio, which has not all cells of these formats, and Nastran."""
    if not MESHIO:
        return
    kinds = {".inp": (24, 25, 26, 22, 23), ".bdf": (22, 23, 24, 25, 26, 27, 13), ".med": (24, 25, 26, 27)}
    for ending, wanted in kinds.items():
        if ending == ".med" and find_spec("h5py") is None:
            continue
        for kind in wanted:
            grid = grid_of((kind,))
            name = FOLDER / f"cell-{kind}{ending}"
            tl.write(grid, name)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                check_same(tl.read(name), grid, 1e-11, str(name))


def test_deck_numbers():
    """CalculiX reads twenty characters of a number: no coordinate of a deck is longer, in a new file or in a copy."""
    if not MESHIO:
        return
    grid = grid_of((24,))
    x = points(grid)
    x[grid.GetCell(0).GetPointId(3)] = (-1.2345678901234567e-16, 1 / 3, -2 / 3e5)
    grid.GetPoints().SetData(numpy_to_vtk(x, deep=True))
    tl.write(grid, FOLDER / "deck.inp")
    moved = tl.read(FOLDER / "deck.inp")
    moved.GetPoints().SetPoint(0, -7.910973071234567e-16, -1 / 7e4, 2 / 3)
    tl.write(moved, FOLDER / "moved.inp", template=FOLDER / "deck.inp")
    for name, expected in (("deck.inp", grid), ("moved.inp", moved)):
        rows = (FOLDER / name).read_text().split("*ELEMENT")[0].split("*NODE")[1].splitlines()[1:]
        assert max(len(word.strip()) for row in rows for word in row.split(",")) <= 20, name
        used = sorted({expected.GetCell(0).GetPointId(i) for i in range(10)})
        assert np.allclose(points(tl.read(FOLDER / name))[used], points(expected)[used], rtol=1e-12, atol=0), name


def test_exodus():
    """The cells of VTK's writer: tetrahedra; also as a copy with other coordinates."""
    from vtkmodules.vtkIOExodus import vtkExodusIIWriter

    grid = grid_of((24,))
    writer = vtkExodusIIWriter()
    writer.SetInputData(grid)
    writer.SetFileName(str(FOLDER / "cell.e"))
    writer.Write()
    found = tl.read(FOLDER / "cell.e")
    (leaf,) = leaves(found)
    check_same(leaf, grid, 0, "cell.e")
    leaf.GetPoints().SetPoint(4, 1.0, 2.0, 3.0)
    leaf.Modified()
    tl.write(found, FOLDER / "moved.e", template=FOLDER / "cell.e")
    (again,) = leaves(tl.read(FOLDER / "moved.e"))
    check_same(again, leaf, 0, "moved.e")


#: Where Exodus' elements have the nodes of VTK's cells. S. Sjaardema et al., "EXODUS II: A finite element data model"
#: (2006), section 4.8: in hexahedra and wedges, edges along the axis come before edges of the second face; in the
#: hexahedron of 27 nodes the center comes before the faces: bottom, top, left, right, front, back.
EXODUS = {
    24: ("TETRA10", list(range(10))), 22: ("TRI6", list(range(6))), 23: ("QUAD8", list(range(8))),
    28: ("QUAD9", list(range(9))), 25: ("HEX20", [*range(12), *range(16, 20), *range(12, 16)]),
    26: ("WEDGE15", [*range(9), *range(12, 15), *range(9, 12)]), 27: ("PYRAMID13", list(range(13))),
    29: ("HEX27", [*range(12), *range(16, 20), *range(12, 16), 26, 24, 25, 20, 21, 22, 23]),
}  # fmt: skip


def exodus_file(name, kind: str, x, cells) -> None:
    """An Exodus file with one block, in the older form of netCDF; cells: nodes from 0, n x nodes."""
    def text(value: str) -> bytes:
        return struct.pack(">I", len(value)) + value.encode() + b"\0" * (-len(value) % 4)

    dimensions = {"time_step": 0, "num_dim": 3, "num_nodes": len(x), "num_elem": len(cells), "num_el_blk": 1,
                  "num_el_in_blk1": len(cells), "num_nod_per_el1": cells.shape[1]}  # fmt: skip
    order = list(dimensions)
    one = struct.pack(">i", 1)
    variables = [("eb_status", ["num_el_blk"], b"", 4, one), ("eb_prop1", ["num_el_blk"], b"\0\0\0\1" + text("name")
                  + struct.pack(">I", 2) + text("ID"), 4, one)]  # fmt: skip
    for axis, letter in enumerate("xyz"):
        variables.append((f"coord{letter}", ["num_nodes"], b"", 6, x[:, axis].astype(">f8").tobytes()))
    of_type = struct.pack(">I", 1) + text("elem_type") + struct.pack(">I", 2) + text(kind)
    numbers = (cells + 1).astype(">i4").tobytes()
    variables.append(("connect1", ["num_el_in_blk1", "num_nod_per_el1"], of_type, 4, numbers))
    variables.append(("time_whole", ["time_step"], b"", 6, b""))
    reals = [("api_version", 4.98), ("version", 4.98)]
    attributes = b"".join(text(key) + struct.pack(">IIf", 5, 1, value) for key, value in reals)
    for key, number in (("floating_point_word_size", 8), ("file_size", 1)):
        attributes += text(key) + struct.pack(">IIi", 4, 1, number)
    attributes += text("title") + struct.pack(
        ">I", 2) + text("made by a test")  # fmt: skip

    def header(begin: int) -> bytes:
        made = b"CDF\1" + struct.pack(">III", 0, 10, len(order))
        made += b"".join(text(key) + struct.pack(">I", dimensions[key]) for key in order)
        made += struct.pack(">II", 12, 5) + attributes + struct.pack(">II", 11, len(variables))
        for key, shape, more, code, content in variables:
            made += text(key) + struct.pack(f">{len(shape) + 1}I", len(shape), *(order.index(n) for n in shape))
            made += struct.pack(">I", 12) + more if more else struct.pack(">II", 0, 0)
            made += struct.pack(">III", code, len(content) or 8, begin)
            begin += len(content)
        return made

    name.write_bytes(header(len(header(0))) + b"".join(variable[-1] for variable in variables))


def test_exodus_orders():
    """The orders of nodes that the manual of Exodus has arrive in VTK's."""
    for kind, (title, order) in EXODUS.items():
        grid = grid_of((kind,))
        ids = np.array([grid.GetCell(0).GetPointId(i) for i in range(len(order))])
        exodus_file(FOLDER / "order.e", title, points(grid), ids[order][None])
        (found,) = leaves(tl.read(FOLDER / "order.e"))
        check_same(found, grid, 0, title)


GMSH = """
import gmsh, sys
order, name = int(sys.argv[1]), sys.argv[2]
gmsh.initialize()
gmsh.option.setNumber("General.Verbosity", 1)
gmsh.model.occ.addTorus(0, 0, 0, 1, 0.35)
gmsh.model.occ.synchronize()
for option, value in (("MeshSizeMax", 0.5), ("ElementOrder", order), ("HighOrderOptimize", 0)):
    gmsh.option.setNumber("Mesh." + option, value)
gmsh.model.mesh.generate(3)
gmsh.write(name)
kind = gmsh.model.mesh.getElementTypes(3)[0]
weights, places = gmsh.model.mesh.getIntegrationPoints(kind, "Gauss12")[::-1]
determinants = gmsh.model.mesh.getJacobians(kind, places)[1]
print(sum(d * weights[i % len(weights)] for i, d in enumerate(determinants)))
at = [k / 12 for k in range(13)]
grid = [x for r in at for s in at for t in at if r + s + t < 1 + 1e-9 for x in (r, s, t)]
d = gmsh.model.mesh.getJacobians(kind, grid)[1]
n = len(grid) // 3
print(sum(min(d[i : i + n]) <= 0 for i in range(0, len(d), n)))
"""


def test_against_gmsh():
    """Volume (Gmsh's rule has 11 digits) and invalid elements of curved meshes of orders 2 to 4, by Gmsh and here."""
    if find_spec("gmsh") is None:
        return
    for order in (2, 3, 4):
        name = FOLDER / f"torus{order}.msh"
        done = subprocess.run([sys.executable, "-c", GMSH, str(order), str(name)], capture_output=True, text=True)
        volume, invalid = done.stdout.split()[-2:]
        mesh = tl.read(name)
        found = tl.quality(mesh, "min_jacobian")
        assert found.inverted == int(invalid), (order, found.inverted, invalid)
        own = curved_volume(mesh)
        assert mesh.GetNumberOfCells() > 100 and abs(own - float(volume)) < 1e-9 * own, (order, own, volume)


def curved_volume(mesh) -> float:
    """By VTK's own shape functions and the points of a fine rule of Gauss, collapsed onto the tetrahedron."""
    at, weight = np.polynomial.legendre.leggauss(8)
    at, weight = (at + 1) / 2, weight / 2
    total, x = 0.0, points(mesh)
    ids = np.array([[mesh.GetCell(c).GetPointId(i) for i in range(mesh.GetCell(c).GetNumberOfPoints())]
                    for c in range(mesh.GetNumberOfCells())])  # fmt: skip
    cell, nodes = mesh.GetCell(0), ids.shape[1]
    for i, u in enumerate(at):
        for j, v in enumerate(at):
            for k, w in enumerate(at):
                place = (u, v * (1 - u), w * (1 - u) * (1 - v))
                slopes = [0.0] * (3 * nodes)
                cell.InterpolateDerivs(place, slopes)
                jacobian = np.einsum("cnx,dn->cxd", x[ids], np.reshape(slopes, (3, nodes)))
                share = weight[i] * weight[j] * weight[k] * (1 - u) ** 2 * (1 - v)
                total += share * np.linalg.det(jacobian).sum()
    return total


def test_mfem():
    """Written for MFEM and read back; as a copy of a file with nodes, unchanged and moved; by the shell."""
    pipe = tl.read(DATA / "pipe.mesh", lower_cells=True)
    for space in ("H1", "L2"):
        tl.write(pipe, FOLDER / "pipe.mesh", mfem=space)
        text = (FOLDER / "pipe.mesh").read_text()
        assert text.startswith("MFEM mesh v1.0") and f"FiniteElementCollection: {space}_" in text
        check_same(tl.read(FOLDER / "pipe.mesh", lower_cells=True), pipe, 1e-14, space)
    quadratic = grid_of((24, 25, 26, 29, 32))
    tl.write(quadratic, FOLDER / "quadratic.mesh", mfem="H1")
    found = tl.read(FOLDER / "quadratic.mesh")
    full = {24: 24, 25: 29, 26: 32, 29: 29, 32: 32}
    kinds = [quadratic.GetCellType(c) for c in range(quadratic.GetNumberOfCells())]
    assert [found.GetCellType(c) for c in range(found.GetNumberOfCells())] == [full[kind] for kind in kinds]
    least = [tl.quality(mesh, "min_jacobian").values["min_jacobian"] for mesh in (quadratic, found)]
    assert np.allclose(*least, rtol=0, atol=1e-7), "incomplete cells keep their shapes"

    tl.write(pipe, FOLDER / "copy.mesh", template=DATA / "pipe.mesh")
    assert (FOLDER / "copy.mesh").read_bytes() == (DATA / "pipe.mesh").read_bytes()
    x = points(pipe)
    x[:, 2] += 0.01 * x[:, 0] ** 2
    pipe.GetPoints().SetData(numpy_to_vtk(x, deep=True))
    tl.write(pipe, FOLDER / "copy.mesh", template=DATA / "pipe.mesh")
    check_same(tl.read(FOLDER / "copy.mesh", lower_cells=True), pipe, 1e-14, "copy.mesh")
    heads = [path.read_text().split("Ordering")[0] for path in (FOLDER / "copy.mesh", DATA / "pipe.mesh")]
    assert heads[0] == heads[1]
    shell("convert", ORDERS, FOLDER / "shell.mesh", "--mfem", "L2", code=1)  # pyramids
    shell("convert", DATA / "pipe.mesh", FOLDER / "shell.mesh", "--mfem", "L2")
    assert "L2_T1_3D_P3" in (FOLDER / "shell.mesh").read_text()
    rejected(wording("has-other-cells"), tl.write, quadratic, FOLDER / "no.mesh", template=DATA / "pipe.mesh")


def test_rejected():
    grid = vtkUnstructuredGrid()
    grid.SetPoints(grid_of((9,)).GetPoints())
    grid.InsertNextCell(70, 6, [0, 1, 2, 3, 4, 5])
    rejected(wording("gmsh-orders-1-to-4"), tl.write, grid, FOLDER / "c.msh")


run_tests(globals())
