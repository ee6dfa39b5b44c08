# SPDX-License-Identifier: BSD-3-Clause
"""Makes the first inputs of the fuzzers, Corpus/TARGET/*: one small file of each kind.

Inputs that failed once are added beside them by hand. usage: make_corpus.py
"""

from __future__ import annotations

import gzip
import struct
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkBMPWriter, vtkJPEGWriter, vtkPNGWriter, vtkPNMWriter, vtkTIFFWriter

CORPUS = Path(__file__).parent / "Corpus"

NODE_3D = "5 3 1 1\n1 0 0 0 0.5 1\n2 1 0 0 0 1\n3 0 1 0 1 1\n4 0 0 1 2 0\n5 1 1 1 -1 2\n"
NODE_2D = "# plane\n4 2 0 1\n0 0 0 1\n1 1 0 1\n2 1 1 1\n3 0 1 1\n"
SQUARE = "4 2 0 0\n1 0 0\n2 3 0\n3 3 3\n4 0 3\n4 1\n1 1 2 1\n2 2 3 1\n3 3 4 1\n4 4 1 2\n"
TETGEN = {
    "tetrahedra": "@ele\n2 4 1\n1 1 2 3 4 7\n2 2 3 4 5 8\n@node\n" + NODE_3D
    + "@face\n1 1\n1 1 2 3 4\n@edge\n1 1\n1 1 2 3\n",
    "quadratic": "@ele\n1 6 0\n0 0 1 2 3 4 5\n@node\n6 2 0 0\n0 0 0\n1 2 0\n2 0 2\n3 1 1\n4 0 1\n5 1 0\n",
    "points": "@node\n" + NODE_2D,
    "poly": "@poly\n" + SQUARE + "1\n1 1 1\n1\n1 .5 .5 2 .1\n",
    "poly-nodes": "@poly\n0 2 0 1\n4 0\n0 0 1\n1 1 2\n2 2 3\n3 3 0\n0\n@node\n" + NODE_2D,
    "facets": "@poly\n" + NODE_3D + "2 1\n1 1 1\n3 1 2 3\n1 .2 .2 0\n2 0 3\n3 1 2 4\n2 3 4\n0\n0\n",
    "smesh": "@smesh\n" + NODE_3D + "2 1\n3 1 2 3 5\n4 1 2\n3 4 6\n0\n0\n",
}  # fmt: skip
MESH = (
    "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 0\n1 1 1 0\n"
    "Tetrahedra\n2\n1 2 3 4 5\n2 3 4 5 6\nTriangles\n1\n1 2 3 9\nEdges\n1\n1 2 3\nRidges 1 1\nCorners\n2\n1\n2\n"
    "RequiredVertices\n1\n3\nEnd\n"
)
PLANE = (
    "MeshVersionFormatted 1\nDimension 2\nVertices 4\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
    "Quadrilaterals 1\n1 2 3 4 0\nEnd\n"
)
SOL = "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n5\n3 1 2 3\n" + "1 2 3 4 5 6 7 8 9 10\n" * 5 + "End\n"


def meshb() -> bytes:
    """A tetrahedron and a triangle in a binary file of version 2."""
    content = struct.pack("<2i", 1, 2)
    points = b"".join(struct.pack("<3di", *row) for row in ((0, 0, 0, 1), (1, 0, 0, 2), (0, 1, 0, 3), (0, 0, 1, 4)))
    for code, data in (
        (3, struct.pack("<i", 3)),
        (4, struct.pack("<i", 4) + points),
        (8, struct.pack("<6i", 1, 1, 2, 3, 4, 5)),
        (6, struct.pack("<5i", 1, 1, 2, 3, 6)),
        (15, struct.pack("<2i", 1, 2)),
    ):
        content += struct.pack("<2i", code, len(content) + 8 + len(data)) + data
    return content + struct.pack("<2i", 54, 0)


MEDIT = {
    "binary": b"@meshb\n" + meshb(),
    "tetrahedra": "@mesh\n" + MESH,
    "quadrilateral": "@mesh\n" + PLANE,
    "solution": "@sol\n" + SOL + "@mesh\n" + MESH,
    "scalar": "@mesh\n" + PLANE + "@sol\nMeshVersionFormatted 2\nDimension 2\nSolAtVertices 4\n1 1\n1\n2\n3\n4\nEnd\n",
}
GMSH_41 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 7 "plate"
$EndPhysicalNames
$Entities
0 0 1 0
1 0 0 0 1 1 0 1 7 0
$EndEntities
$Nodes
1 4 1 4
2 1 0 4
1
2
3
4
0 0 0
1 0 0
1 1 0
0 1 0
$EndNodes
$Elements
2 3 1 3
2 1 2 2
1 1 2 3
2 1 3 4
1 1 1 1
3 1 2
$EndElements
$NodeData
1
"t"
1
0.0
3
0
1
4
1 1
2 2
3 3
4 4
$EndNodeData
"""
GMSH_22 = """$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
9 0 0 1
$EndNodes
$Elements
2
1 4 2 5 6 1 2 3 9
2 2 2 7 8 1 2 3
$EndElements
$ElementData
1
"e"
1
0
3
0
1
1
1 2.5
$EndElementData
"""

OPTIONS = (
    b"-ksp_type gmres -pc_type ilu -ksp_rtol 1e-8",
    b"-pc_type gamg -mg_levels_ksp_type chebyshev -mg_levels_pc_type sor -mg_coarse_pc_type lu",
    b"-pc_type hypre -pc_hypre_type boomeramg -pc_hypre_boomeramg_strong_threshold 0.5",
    b"-pc_type asm -sub_pc_type icc -sub_pc_factor_levels 1",
    b"-ksp_view ascii:written.txt",
    b"-options_file /etc/passwd",
    b"-pc_type fieldsplit -fieldsplit_0_pc_type jacobi",
)


def gmsh_binary() -> bytes:
    """Version 2.2, binary: a triangle."""
    text = b"$MeshFormat\n2.2 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n$Nodes\n3\n"
    for number, (x, y) in enumerate([(0, 0), (1, 0), (0, 1)], 1):
        text += struct.pack("<iddd", number, x, y, 0)
    element = struct.pack("<iiiiiiiii", 2, 1, 2, 1, 4, 5, 1, 2, 3)
    return text + b"\n$EndNodes\n$Elements\n1\n" + element + b"\n$EndElements\n"


def gmsh_cubic() -> str:
    """Version 2.2: a triangle and a line of third order, a quadrilateral of fourth order, a pyramid of 14 nodes."""
    nodes = "".join(f"{n} {n % 5} {n % 7 * 0.5} {n % 3}\n" for n in range(1, 26))
    rows = [(21, 10), (26, 4), (37, 25), (14, 14)]
    elements = "".join(f"{i} {code} 2 1 1 {' '.join(map(str, range(1, count + 1)))}\n"
                       for i, (code, count) in enumerate(rows, 1))  # fmt: skip
    return (f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n25\n{nodes}$EndNodes\n$Elements\n{len(rows)}\n"
            f"{elements}$EndElements\n")  # fmt: skip


GMSH = {
    "text-41": GMSH_41,
    "cubic": gmsh_cubic(),
    "text-22": GMSH_22,
    "binary-22": gmsh_binary(),
    "freefem-2d": "3 1 3\n0 0 1\n1 0 1\n0 1 2\n1 2 3 0\n1 2 1\n2 3 2\n3 1 2\n",
    "freefem-3d": "4 1 1\n0 0 0 1\n1 0 0 1\n0 1 0 2\n0 0 1 2\n1 2 3 4 0\n1 2 3 1\n",
}
OFF = {
    "off": "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3 255 0 0\n",
    "coff": "COFF # colors\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 255 255\n3 0 1 2 0.5 0.5 0.5\n",
    "noff": "NOFF\n4 3 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n2 0 1\n1 3\n",
}
LIST = {
    "classes": "file,class\na.pgm,disc\n",
    "quoted": 'class_id, "file"\r\n"a, b", a.pgm\r\n\r\n',
    "missing": "file,label\na.pgm\n",
}


def image(components: int) -> vtkImageData:
    """4 x 3 pixels."""
    made = vtkImageData()
    made.SetDimensions(4, 3, 1)
    values = (np.arange(12 * components) * 37 % 256).astype(np.uint8).reshape(12, components)
    made.GetPointData().SetScalars(numpy_to_vtk(values, deep=True))
    return made


def write_images(folder: Path) -> None:
    for name, make, components in (
        ("grey.png", vtkPNGWriter, 1), ("alpha.png", vtkPNGWriter, 4), ("colour.jpg", vtkJPEGWriter, 3),
        ("grey.jpg", vtkJPEGWriter, 1), ("colour.tif", vtkTIFFWriter, 3), ("colour.bmp", vtkBMPWriter, 3),
        ("grey.pgm", vtkPNMWriter, 1), ("colour.ppm", vtkPNMWriter, 3),
    ):  # fmt: skip
        writer = make()
        writer.SetInputData(image(components))
        writer.SetFileName(str(folder / name))
        writer.Write()
    palette = b"".join(bytes([i, i, i, 0]) for i in range(256))
    header = struct.pack("<IHHI", 14 + 40 + 1024 + 8, 0, 0, 14 + 40 + 1024)
    header += struct.pack("<IiiHHIIiiII", 40, 3, -2, 1, 8, 0, 8, 0, 0, 256, 0)
    (folder / "palette.bmp").write_bytes(b"BM" + header + palette + bytes(range(8)))
    targa = struct.pack("<BBBHHBHHHHBB", 0, 0, 10, 0, 0, 0, 0, 0, 4000, 4000, 24, 0)
    (folder / "short.tga").write_bytes(targa + b"\xff\x01\x02\x03")


class Foam:
    """The files of a mesh of OpenFOAM: as text, or as bytes with labels of 32 and scalars of 64 bits."""

    def __init__(self, binary: bool = False) -> None:
        self.binary = binary

    def file(self, kind: str, content: bytes) -> bytes:
        form = "binary" if self.binary else "ascii"
        head = f'FoamFile\n{{\n version 2.0;\n format {form};\n arch "LSB;label=32;scalar=64";\n class {kind};\n}}\n'
        return head.encode() + content

    def rows(self, values: np.ndarray) -> bytes:
        count = f"{len(values)}\n(".encode()
        if self.binary:
            return count + values.astype("<f8" if values.dtype.kind == "f" else "<i4").tobytes() + b")\n"
        lines = (f"({' '.join(map(str, row))})" if values.ndim > 1 else str(row) for row in values.tolist())
        return count + "\n".join(lines).encode() + b"\n)\n"

    def labels(self, values: list[int]) -> bytes:
        return self.file("labelList", self.rows(np.array(values, int)) if values else b"0\n()\n")

    def files(
        self, points: list[tuple[float, ...]], faces: list[list[int]], owner: list[int], neighbour: list[int],
        boundary: str, prefix: str = "",
    ) -> bytes:  # fmt: skip
        if self.binary:
            starts = np.cumsum([0] + [len(face) for face in faces])
            lists = self.rows(starts) + self.rows(np.concatenate(faces))
            listed = self.file("faceCompactList", lists)
        else:
            rows = "\n".join(f"{len(face)}({' '.join(map(str, face))})" for face in faces)
            listed = self.file("faceList", f"{len(faces)}\n(\n{rows}\n)\n".encode())
        contents = {
            "points": self.file("vectorField", self.rows(np.array(points, float))), "faces": listed,
            "owner": self.labels(owner), "neighbour": self.labels(neighbour),
            "boundary": self.file("polyBoundaryMesh", boundary.encode()),
        }  # fmt: skip
        return self.set({prefix + name: content for name, content in contents.items()})

    @staticmethod
    def set(contents: dict[str, bytes]) -> bytes:
        return b"".join(f"@{name}\n".encode() + content for name, content in contents.items())


CUBES = [(float(x), float(y), float(z)) for z in range(3) for y in range(2) for x in range(2)]
SIDES = [[0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6]]
BOTTOM, MIDDLE, TOP = [0, 2, 3, 1], [4, 5, 7, 6], [8, 9, 11, 10]


def foam_cases() -> dict[str, bytes]:
    """Two cubes one above the other, as one mesh and on two processors; a cube one of whose faces is two triangles."""
    text, binary = Foam(), Foam(binary=True)
    faces = [MIDDLE, BOTTOM, TOP, *SIDES, *([point + 4 for point in side] for side in SIDES)]
    owner = [0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 1]
    patches = (
        "3 (\nlow { type cyclic; neighbourPatch high; nFaces 1; startFace 1; }\n"
        "high { type cyclic; neighbourPatch low; nFaces 1; startFace 2; } // opposite\n"
        "sides { type wall; inGroups 1(wall); nFaces 8; startFace 3; }\n)\n"
    )
    mesh = text.files(CUBES, faces, owner, [1], patches)
    cell_zones = "2 ( a { type cellZone; cellLabels List<label> 1(1); } b { type cellZone; cellLabels 0(); } )"
    face_zones = "1 ( f { type faceZone; faceLabels List<label> 2 (0 3); flipMap List<bool> 2{0}; } )"
    zones = {name: text.file("regIOobject", content.encode())
             for name, content in (("cellZones", cell_zones), ("faceZones", face_zones))}  # fmt: skip
    joined = addressed = b""
    for part, own in enumerate(([BOTTOM, *SIDES, MIDDLE], [MIDDLE, *SIDES, BOTTOM])):
        other, prefix = 1 - part, f"processor{part}/"
        cover = (
            f"2 ( outside {{ type patch; nFaces 5; startFace 0; }} procBoundary{part}to{other} {{ type processor; "
            f"nFaces 1; startFace 5; myProcNo {part}; neighbProcNo {other}; }} )\n"
        )
        joined += text.files(CUBES[4 * part : 4 * part + 8], own, [0] * 6, [], cover, prefix)
        lists = {
            "pointProcAddressing": list(range(4 * part, 4 * part + 8)), "cellProcAddressing": [part],
            "faceProcAddressing": [*range(2 + 5 * part, 7 + 5 * part), 1 - 2 * part],
            "boundaryProcAddressing": [0, -1],
        }  # fmt: skip
        addressed += text.set({prefix + name: text.labels(values) for name, values in lists.items()})
    packed = gzip.compress(mesh[mesh.index(b"FoamFile") : mesh.index(b"@faces")], mtime=0)
    all_faces = "1(all { type patch; nFaces 7; startFace 0; })"
    split = [BOTTOM, *SIDES, [4, 5, 7], [4, 7, 6]]
    return {
        "text": mesh + text.set(zones),
        "binary": binary.files(CUBES, faces, owner, [1], patches),
        "compressed": mesh[mesh.index(b"@faces") :] + b"@points.gz\n" + packed,
        "joined": joined,
        "addressed": joined + addressed,
        "polyhedron": text.files(CUBES[:8], split, [0] * 7, [], all_faces),
    }


def main() -> None:
    texts = {"foam": foam_cases(), "tetgen": TETGEN, "medit": MEDIT, "gmsh": GMSH, "off": OFF, "imagelist": LIST}
    for target, inputs in texts.items():
        (CORPUS / target).mkdir(parents=True, exist_ok=True)
        for name, content in inputs.items():
            data = content if isinstance(content, bytes) else content.encode()
            (CORPUS / target / name).write_bytes(data)
    (CORPUS / "image").mkdir(exist_ok=True)
    write_images(CORPUS / "image")

    random = np.random.default_rng(14)

    def noise(count: int, below: int = 256) -> bytes:
        return bytes(random.integers(0, below, count).astype(np.uint8))

    disc = bytes(int(80 < (i % 21 - 10) ** 2 + (i // 21 - 10) ** 2) for i in range(441))
    grey = np.float32(0.5).tobytes() + bytes([1]) + random.random(100, np.float32).tobytes()
    cells = ([10, 4, 0, 1, 2, 3, 5, 3, 1, 2, 3], [12, 8, *range(8), 9, 4, 0, 1, 2, 3, 0, 1, 5], [7, 3, 0, 9, 200])
    numbers = {
        "silhouette": [
            bytes([20, 20, 5, 0, 1, 0]) + disc,
            bytes([9, 9, 3, 2, 0]) + grey,
            bytes([30, 10, 12, 1, 1, 0]) + noise(341, 2),
        ],
        "quality": [bytes([kind, kind * 7, kind % 3, 1, 1, 1]) + noise(90) for kind in range(6)],
        "mesh": [bytes([8]) + noise(24, 40) + bytes(list_of_cells) for list_of_cells in cells],
        "move": [bytes([kind, kind % 2, 1]) + noise(80 + 200 * (kind % 2 == 0), 32) for kind in range(4)],
        "petscoptions": [b"\0" + text for text in OPTIONS] + [bytes([1]) + noise(30) for _ in range(6)],
    }
    more = np.random.default_rng(15)  # the inputs above stay
    numbers["reconnection"] = [bytes([kind]) + bytes(more.integers(0, 256, 600).astype(np.uint8)) for kind in range(6)]
    for target, inputs in numbers.items():
        (CORPUS / target).mkdir(parents=True, exist_ok=True)
        for number, data in enumerate(inputs):
            (CORPUS / target / str(number)).write_bytes(data)


if __name__ == "__main__":
    main()
