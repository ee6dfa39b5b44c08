#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""compare_cases.py CASES [--table FILE]: Element Quality on the meshes of make_cases.py against checkMesh.

For each case whose mesh is in constant/polyMesh: the largest difference of each field that checkMesh has written, and
the number of failed checks. Differences are relative for volumes and aspect ratios; others, of numbers of size 1, are
absolute, angles as their cosines. --table writes a Markdown table. The exit code is 1 if a mesh differs by more than
the limit, or in the verdict.

What is known to differ does not count: the weights of faces at patches of the AMI kind, whose neighbors checkMesh
interpolates. The limit grows with what rounding leaves: with the aspect ratio for the skewness, and with the distance
from the origin over the width of the smallest cell for all fields.
"""

import argparse
import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import tautline
from vtkmodules.util.numpy_support import vtk_to_numpy

#: The metric of each field, and whether differences are relative.
FIELDS = {
    "nonOrthoAngle": ("non_orthogonality", False),
    "skewness": ("face_skewness", False),
    "cellVolume": ("cell_volume", True),
    "cellVolumeRatio": ("volume_ratio", False),
    "cellDeterminant": ("cell_determinant", False),
    "aspectRatio": ("cell_aspect_ratio", True),
    "minTetVolume": ("center_tet_quality", False),
}
LIMIT = 1e-10
#: Patches whose faces have neighbors that checkMesh interpolates.
INTERPOLATED = re.compile(r"type\s+cyclic\w*A?C?MI;")
#: Above this aspect ratio, the rounding of the skewness grows with it.
SLENDER = 100
#: Beyond so many widths of a cell from the origin, the rounding of coordinates shows in the fields, at this rate.
FAR = 1e4
PER_WIDTH = 1e-12


@dataclass
class Comparison:
    """What was found of a case."""

    name: str
    cells: int = 0
    failed: int | None = None
    failed_by_checkmesh: int | None = None
    differences: dict[str, float] = field(default_factory=dict)
    limits: dict[str, float] = field(default_factory=dict)
    refused: str = ""

    @property
    def wrong(self) -> list[str]:
        """The fields that differ although nothing explains it."""
        return [name for name, value in self.differences.items() if not value <= self.limits[name]]

    @property
    def agrees(self) -> bool:
        return not self.refused and not self.wrong and self.failed == self.failed_by_checkmesh


def read_field(file: Path, cells: int) -> np.ndarray:
    """The values on the cells of a text file of OpenFOAM."""
    text = file.read_text()
    text = text[text.index("internalField") :]
    if uniform := re.match(r"internalField\s+uniform\s+([^;]+);", text):
        return np.full(cells, float(uniform[1]))
    listed = re.match(r"internalField\s+nonuniform\s+List<scalar>\s*\d+\s*([({])", text)
    assert listed is not None, file
    if listed[1] == "{":
        return np.full(cells, float(text[listed.end() : text.index("}", listed.end())]))
    return np.array(text[listed.end() : text.index(")", listed.end())].split(), float)


def verdict(log: Path) -> int:
    """The number of failed checks in the output of checkMesh."""
    found = re.findall(r"^(Mesh OK\.|Failed \d+ mesh checks\.)", log.read_text(), re.MULTILINE)[-1]
    return 0 if found == "Mesh OK." else int(found.split()[1])


def face_weights(faces, cells: int) -> np.ndarray:
    """Of each cell the least weight of its faces, as checkMesh writes it."""
    arrays = {name: vtk_to_numpy(faces.GetCellData().GetArray(name)) for name in ("Owner", "Neighbour", "OwnerWeight")}
    weights = np.full(cells, np.inf)
    np.minimum.at(weights, arrays["Owner"], arrays["OwnerWeight"])
    inner = arrays["Neighbour"] >= 0
    np.minimum.at(weights, arrays["Neighbour"][inner], arrays["OwnerWeight"][inner])
    return weights


def compare(case: Path) -> Comparison:
    """Measure a case, and compare it with the fields and the log of checkMesh."""
    found = Comparison(case.name, failed_by_checkmesh=verdict(case / "log.checkMesh"))
    file = case / f"{case.name}.foam"
    file.touch()
    try:
        mesh = tautline.read(str(file))
        result = tautline.quality(mesh, [metric for metric, _ in FIELDS.values()], face_output="all")
    except tautline.Error as error:
        found.refused = str(error)
        return found
    found.cells = cells = int((vtk_to_numpy(mesh.GetCellData().GetArray("Face")) < 0).sum())
    found.failed = result.failed_checks_of_all
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    volume = np.abs(result.values["cell_volume"][:cells])
    width = np.cbrt(volume[volume > 0].min()) if (volume > 0).any() else 1.0
    distance = np.abs(points).max() / width
    limit = LIMIT if distance < FAR else max(LIMIT, PER_WIDTH * distance)
    found.limits = dict.fromkeys((*FIELDS, "faceWeight"), limit)
    if INTERPOLATED.search((case / "constant/polyMesh/boundary").read_text()):
        found.limits["faceWeight"] = np.inf
    found.limits["skewness"] = limit * max(1.0, result.values["cell_aspect_ratio"][:cells].max() / SLENDER)
    for name, (metric, relative) in FIELDS.items():
        own, theirs = result.values[metric][:cells], read_field(case / "constant" / name, cells)
        if name == "nonOrthoAngle":
            own, theirs = (np.cos(np.radians(values)) for values in (own, theirs))
        scale = np.maximum(np.abs(theirs), 1e-300 if relative else 1.0)
        found.differences[name] = float((np.abs(own - theirs) / scale).max())
    theirs = read_field(case / "constant/faceWeight", cells)
    found.differences["faceWeight"] = float(np.abs(face_weights(result.faces, cells) - theirs).max())
    return found


def table(comparisons: list[Comparison]) -> str:
    """The table of agreement, in Markdown."""
    names = [*FIELDS, "faceWeight"]
    lines = ["| mesh | cells | failed | by checkMesh | " + " | ".join(names) + " |", "|---" * (4 + len(names)) + "|"]
    for found in comparisons:
        if found.refused:
            lines.append(f"| {found.name} | | refused | {found.failed_by_checkmesh} |" + " |" * len(names))
            continue
        values = " | ".join(f"{found.differences[name]:.0e}" for name in names)
        lines.append(f"| {found.name} | {found.cells} | {found.failed} | {found.failed_by_checkmesh} | {values} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", type=Path)
    parser.add_argument("--table", type=Path)
    arguments = parser.parse_args()
    cases = [file.parent for file in sorted(arguments.cases.glob("*/log.checkMesh"))]
    comparisons = [compare(case) for case in cases if (case / "constant/skewness").exists()]
    for found in comparisons:
        if found.refused:
            print(f"{found.name}: refused: {found.refused}")
        elif not found.agrees:
            print(f"{found.name}: {found.failed} failed checks, {found.failed_by_checkmesh} by checkMesh;", found.wrong)
    agreeing = sum(found.agrees for found in comparisons)
    print(f"{len(comparisons)} meshes, {agreeing} agree")
    if arguments.table:
        arguments.table.write_text(table(comparisons))
    return 0 if agreeing == len(comparisons) else 1


if __name__ == "__main__":
    sys.exit(main())
