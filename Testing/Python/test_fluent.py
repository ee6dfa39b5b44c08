# SPDX-License-Identifier: BSD-3-Clause
"""Meshes of Fluent: text and binary, polyhedra, zones, periodic zones, the plane; what is rejected, by name."""

import gzip
import struct
import warnings

import numpy as np
import tautline as tl
from checks import OUT, points, rejected, run_tests, shell, wording
from vtkmodules.util.numpy_support import vtk_to_numpy

FOLDER = OUT / "fluent"
FOLDER.mkdir(exist_ok=True)
INTERIOR, WALL, PERIODIC, SHADOW, INLET, FAN = 2, 3, 12, 8, 10, 14
MIXED, POLYGONS = 0, 5
#: VTK's types of cells.
LINE, TRIANGLE, POLYGON, QUADRILATERAL, TETRAHEDRON, HEXAHEDRON, POLYHEDRON = 3, 5, 7, 9, 10, 12, 42


def two_cubes():
    """Points, and faces by their zone: nodes, with the normal to the first cell, and the cells, all counted from 1.

    The cubes share a face. The first has one more edge at its top, in the middle, so that it is a polyhedron.
    """
    corners = [(x, y, z) for x in range(3) for y in range(2) for z in range(2)] + [(0.5, 0, 1), (0.5, 1, 1)]
    at = {corner: i + 1 for i, corner in enumerate(corners)}

    def face(*names: str) -> list[int]:
        return [at[tuple(int(digit) for digit in name)] for name in names]

    low, high = at[(0.5, 0, 1)], at[(0.5, 1, 1)]
    inside = face("100", "101", "111", "110")  # its normal is -x, to the first cell
    inlet = face("000", "010", "011", "001")
    walls = [
        ([*face("000", "100"), *face("110", "010")][::-1], 1, 0),
        ([*face("000", "001"), low, *face("101", "100")][::-1], 1, 0),
        ([*face("010", "110", "111"), high, *face("011")][::-1], 1, 0),
        ([*face("001", "011"), high, low][::-1], 1, 0),
        ([low, high, *face("111", "101")], 1, 0),
        (face("100", "110", "210", "200")[::-1], 2, 0),
        (face("100", "200", "201", "101"), 2, 0),
        (face("110", "111", "211", "210"), 2, 0),
        (face("101", "201", "211", "111"), 2, 0),
        (face("200", "210", "211", "201"), 2, 0),
    ]
    return corners, {3: [(inside, 1, 2)], 10: [(inlet, 1, 0)], 11: walls}


def outward(corners, zones):
    """The same with each face turned so that its normal points to its first cell, whose center is given."""
    centers = {1: np.array([0.5, 0.5, 0.5]), 2: np.array([1.5, 0.5, 0.5])}
    made = {}
    for zone, faces in zones.items():
        made[zone] = []
        for nodes, first, second in faces:
            at = np.array([corners[node - 1] for node in nodes], float)
            normal = sum(np.cross(a - at[0], b - at[0]) for a, b in zip(at[1:], at[2:]))
            inner = np.dot(normal, centers[first] - at.mean(axis=0)) > 0
            made[zone].append((nodes if inner else nodes[::-1], first, second))
    return corners, made


NAMES = {2: ("fluid", "air"), 3: ("interior", "inside"), 10: ("velocity-inlet", "inlet"), 11: ("wall", "sides")}
CODES = {3: INTERIOR, 10: INLET, 11: WALL}


def text(corners, zones, cells=2, names=NAMES, codes=CODES, extra="", dimension=3) -> str:
    """A file in text."""
    faces = sum(map(len, zones.values()))
    count = f"{len(corners):x}"
    lines = ['(0 "a comment with ) and \\" in it")', f"(2 {dimension})", f"(10 (0 1 {count} 0 {dimension}))",
             f"(12 (0 1 {cells:x} 0))", f"(13 (0 1 {faces:x} 0))", f"(10 (1 1 {count} 1 {dimension})("]  # fmt: skip
    lines += [" ".join(f"{value:.12g}" for value in corner[:dimension]) for corner in corners]
    lines += ["))", f"(12 (2 1 {cells:x} 1 7))"]
    first = 1
    for zone, rows in zones.items():
        kind = MIXED if dimension == 2 else POLYGONS
        lines.append(f"(13 ({zone:x} {first:x} {first + len(rows) - 1:x} {codes[zone]:x} {kind})(")
        lines += [" ".join(f"{value:x}" for value in (len(nodes), *nodes, *sides)) for nodes, *sides in rows]
        lines.append("))")
        first += len(rows)
    lines += [f"({45 if zone < 11 else 39} ({zone} {kind} {name})())" for zone, (kind, name) in names.items()]
    return "\n".join(lines) + "\n(37 ((a (1 2)) (b \"(\")))\n" + extra


def binary(corners, zones, order="<", double=True, cells=2) -> bytes:
    """The same in bytes."""
    kind = 3000 if double else 2000
    faces = sum(map(len, zones.values()))

    def section(number, head, body):
        index = kind + number
        return f"({index} ({head})(".encode() + body + f")\nEnd of Binary Section   {index})\n".encode()

    content = b'(0 "binary")\n(2 3)\n' + (f"(4 ({ord(order)} 0 0 1 2 4 4 4 8 4 4))\n").encode()
    content += f"(10 (0 1 {len(corners):x} 0 3))\n(12 (0 1 {cells:x} 0))\n(13 (0 1 {faces:x} 0))\n".encode()
    numbers = np.array(corners, float).astype(order + ("f8" if double else "f4"))
    content += section(10, f"1 1 {len(corners):x} 1 3", numbers.tobytes())
    content += section(12, f"2 1 {cells:x} 1 0", struct.pack(f"{order}{cells}i", *[7] * cells))
    content += section(99, "1 2", b")(unknown )\"")
    first = 1
    for zone, rows in zones.items():
        body = b"".join(struct.pack(f"{order}{len(nodes) + 3}i", len(nodes), *nodes, *sides) for nodes, *sides in rows)
        content += section(13, f"{zone:x} {first:x} {first + len(rows) - 1:x} {CODES[zone]:x} {MIXED}", body)
        first += len(rows)
    return content + "".join(f"(39 ({zone} {a} {b})())\n" for zone, (a, b) in NAMES.items()).encode()


def write(name: str, content):
    file = FOLDER / name
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return file


def strings(mesh, name: str) -> list[str]:
    array = mesh.GetFieldData().GetAbstractArray(name)
    return [array.GetValue(i) for i in range(array.GetNumberOfValues())]


def types(mesh) -> list[int]:
    return [mesh.GetCellType(i) for i in range(mesh.GetNumberOfCells())]


def check_cubes(mesh) -> None:
    """Both cells, the faces of two patches, the zones; the measures of finite volumes."""
    assert types(mesh) == [POLYHEDRON, HEXAHEDRON] + [QUADRILATERAL] * 2 + [POLYGON] * 2 + [QUADRILATERAL] * 7
    assert mesh.cell_data["Patch"].tolist() == [-1, -1, 0] + [1] * 10
    assert mesh.cell_data["Face"].tolist() == [-1, -1, *range(1, 12)]
    assert mesh.cell_data["CellZone"].tolist() == [0, 0] + [-1] * 11
    assert strings(mesh, "PatchNames") == ["inlet", "sides"] and strings(mesh, "CellZoneNames") == ["air"]
    assert strings(mesh, "PatchTypes") == ["velocity-inlet", "wall"]
    assert np.array_equal(points(mesh), np.array(outward(*two_cubes())[0], float))
    result = tl.quality(mesh, metrics=["pyramid_volume", "non_orthogonality"])
    assert result.inverted == 0
    assert np.allclose(result.mesh.cell_data["non_orthogonality"][:2], 0, atol=1e-5)
    assert (result.mesh.cell_data["pyramid_volume"][:2] > 0).all()


def test_text():
    """Polyhedra and zones; the normals of all faces are right, as the volumes of pyramids show."""
    content = text(*outward(*two_cubes()))
    for name in ("cubes.cas", "cubes.msh", "CUBES.CAS"):
        check_cubes(tl.read(write(name, content)))
    check_cubes(tl.read(write("crlf.cas", content.replace("\n", "\r\n"))))
    (FOLDER / "packed.cas.gz").write_bytes(gzip.compress(content.encode()))
    check_cubes(tl.read(FOLDER / "packed.cas.gz"))
    assert types(tl.read(FOLDER / "cubes.cas", lower_cells=False)) == [POLYHEDRON, HEXAHEDRON]
    assert "11 valid, 0 inverted" in shell("quality", FOLDER / "cubes.cas")
    assert tl.times(FOLDER / "cubes.cas") == []
    rejected(wording("has-no-time-steps"), tl.read, FOLDER / "cubes.cas", time=1)


def test_binary():
    for order in "<>":
        for double in (True, False):
            check_cubes(tl.read(write("binary.cas", binary(*outward(*two_cubes()), order, double))))


def test_sides():
    """The cells of a face in the other order, with its nodes in the other sense, are the same mesh."""
    corners, zones = outward(*two_cubes())
    zones = {zone: [(nodes[::-1], second, first) for nodes, first, second in rows] for zone, rows in zones.items()}
    check_cubes(tl.read(write("sides.cas", text(corners, zones))))
    # a zone of internal faces that is not interior, such as a fan, is a zone of faces
    corners, zones = outward(*two_cubes())
    mesh = tl.read(write("fan.cas", text(corners, zones, codes={**CODES, 3: FAN})))
    assert strings(mesh, "FaceZoneNames") == ["inside"]
    assert mesh.GetFieldData().GetArray("FaceZone inside").GetValue(0) == 0
    # without names, the code of the zone is its type
    mesh = tl.read(write("plain.cas", text(corners, zones, names={})))
    assert strings(mesh, "PatchNames") == ["zone 10", "zone 11"]
    assert strings(mesh, "PatchTypes") == ["velocity-inlet", "wall"]


def test_periodic():
    """The faces of two periodic zones correspond by their order, whatever the order in the file is."""
    corners, zones = outward(*two_cubes())
    walls = zones.pop(11)
    y = [np.mean([corners[node - 1][1] for node in nodes]) for nodes, *_ in walls]
    low, high = ([row for row, at in zip(walls, y) if at == side] for side in (0, 1))
    zones |= {11: [row for row, at in zip(walls, y) if 0 < at < 1], 12: low, 13: high[::-1]}
    codes = {**CODES, 12: PERIODIC, 13: SHADOW}
    names = {**NAMES, 12: ("periodic", "front"), 13: ("shadow", "back")}
    first = sum(len(zones[zone]) for zone in (3, 10, 11)) + 1
    pairs = f"(18 (1 2 c d)(\n{first:x} {first + 3:x}\n{first + 1:x} {first + 2:x}))\n"
    mesh = tl.read(write("periodic.cas", text(corners, zones, names=names, codes=codes, extra=pairs)))
    assert strings(mesh, "PatchTypes") == ["velocity-inlet", "wall", "cyclic", "cyclic"]
    field = mesh.GetFieldData().GetArray("NeighbourPatch")
    assert [field.GetValue(i) for i in range(4)] == [-1, -1, 3, 2]
    x = [[mesh.GetCell(i).GetBounds()[0] for i in np.flatnonzero(mesh.cell_data["Patch"] == k)] for k in (2, 3)]
    assert x[0] == x[1] == [0, 1], x
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        lacking = pairs.replace("(1 2 c", "(1 1 c").replace(f"\n{first + 1:x} {first + 2:x}", "")
        mesh = tl.read(write("periodic.cas", text(corners, zones, names=names, codes=codes, extra=lacking)))
    assert len(told) == 1 and "front" in str(told[0].message)
    assert strings(mesh, "PatchTypes")[2:] == ["periodic", "shadow"]


def test_plane():
    """In two dimensions: triangles and quadrilaterals, counter-clockwise, and lines with patches."""
    corners = [(0, 0), (1, 0), (1, 1), (0, 1), (2, 0), (2, 1), (0.5, 2), (3, 0.5)]
    zones = {3: [([2, 3], 1, 2), ([3, 4], 1, 3), ([5, 6], 2, 4)],
             10: [([4, 1], 1, 0), ([1, 2], 1, 0)],
             11: [([2, 5], 2, 0), ([6, 3], 2, 0), ([3, 7], 3, 0), ([7, 4], 3, 0), ([5, 8], 4, 0),
                  ([8, 6], 4, 0)]}  # fmt: skip
    for turned in (False, True):
        step = -1 if turned else 1
        rows = {zone: [(nodes[::step], *sides) for nodes, *sides in faces] for zone, faces in zones.items()}
        mesh = tl.read(write("plane.msh", text(corners, rows, cells=4, dimension=2)))
        assert types(mesh) == [QUADRILATERAL, QUADRILATERAL, TRIANGLE, TRIANGLE] + [LINE] * 8
        assert mesh.cell_data["Patch"].tolist() == [-1] * 4 + [0] * 2 + [1] * 6
        assert tl.quality(tl.read(FOLDER / "plane.msh", lower_cells=False)).inverted == 0
    rows[11][0] = ([2, 5, 6], 2, 0)
    rejected("is 3,", tl.read, write("solid.msh", text(corners, rows, cells=4, dimension=2)))


def test_pieces():
    """Each of several processes has its part of the cells, and faces between the parts as patches of processors."""
    for name, count in (("cubes.cas", 2), ("plane.msh", 4)):
        found = []
        for piece in range(2):
            reader = tl.vtkFluentMeshReader()
            reader.SetFileName(str(FOLDER / name))
            reader.UpdatePiece(piece, 2, 0)
            part = reader.GetOutput()
            patch = vtk_to_numpy(part.GetCellData().GetArray("Patch"))
            found += vtk_to_numpy(part.GetCellData().GetGlobalIds())[patch < 0].tolist()
            assert "processor" in strings(part, "PatchTypes")
        assert sorted(found) == list(range(count)), found


def test_rejected():
    """Unsupported contents are an error that names them; nothing is read in part."""
    corners, zones = outward(*two_cubes())
    good = text(corners, zones)
    for extra in ("(59 (1 1 3 3)(2 4 5))", "(58 (1 1 2 2)(1 2))", "(3058 (1 1 2 2)(xx)\nEnd of Binary Section   3058)"):
        rejected("convert-hanging-nodes", tl.read, write("tree.cas", good + extra))
    rejected("convert-hanging-nodes", tl.read, write("tree.cas", good.replace("(12 (2 1 2 1 7)", "(12 (2 1 2 20 7)")))
    rejected(wording("fluent-mesh-interfaces"), tl.read, write("interface.cas", good + "(61 (1 1)(2 3))"))
    surface = {zone: [(nodes, 0, 0) for nodes, *_ in rows] for zone, rows in zones.items()}
    rejected("surface", tl.read, write("surface.msh", text(corners, surface, cells=0)))
    rejected("cff-files", tl.read, write("new.cas.h5", b"\x89HDF"))
    open_ = {**zones, 11: zones[11][1:]}
    rejected(wording("fluent-cell-0-is-open"), tl.read, write("open.cas", text(corners, open_)))
    rejected("declares", tl.read, write("more.cas", good.replace("(13 (0 1 c 0))", "(13 (0 1 d 0))")))
    rejected("more.cas:", tl.read, write("more.cas", good.replace("(2 3)\n", "", 1)))
    rejected("twice", tl.read, write("twice.cas", good.replace("\n4 ", "\n4 1 1 1 1 1 0\n4 ", 1)))
    # a file that ends too early
    for content in (good.encode(), binary(corners, zones)):
        end = content.rindex(b"(39 (11") if b"(3013" in content else content.rindex(b"(13 (b") + 40
        for size in range(8, end, 7):
            rejected("cut.cas", tl.read, write("cut.cas", content[:size]))


def test_templates():
    """The points of a file do not come back: a .msh becomes one of Gmsh, a template is rejected."""
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [([1, 2, 3], 1, 0), ([1, 4, 2], 1, 0), ([2, 4, 3], 1, 0), ([1, 3, 4], 1, 0)]
    file = write("one.msh", text(corners, {11: faces}, cells=1))
    assert types(tl.read(file)) == [TETRAHEDRON] + [TRIANGLE] * 4
    assert tl.quality(file).inverted == 0
    target = FOLDER / "of-gmsh.msh"
    tl.write(tl.perturb(file), target)
    assert target.read_text().startswith("$MeshFormat")
    rejected("one.msh", tl.write, tl.read(file), target, template=file)
    rejected(".cas", tl.write, tl.read(file), FOLDER / "out.cas")


def test_results_beside():
    """A .dat beside a case is not read: a warning reports it."""
    file = write("with.cas", text(*outward(*two_cubes())))
    write("with.dat", "(0 \"results\")")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        check_cubes(tl.read(file))
    assert len(told) == 1 and "with.dat" in str(told[0].message), [str(one.message) for one in told]


if __name__ == "__main__":
    run_tests(globals())
