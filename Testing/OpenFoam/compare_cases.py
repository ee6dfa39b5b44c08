#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""compare_cases.py CASES... [--table FILE]: Element Quality on the meshes of make_cases.py against checkMesh.

Each mesh that checkMesh has written fields of is compared, by the largest difference of each field and by the number
of failed checks: the mesh in constant/polyMesh, the meshes of regions, and meshes in pieces (make_cases.py
--decompose).
Pieces are read by one process in two ways. With the addresses that decomposePar has written, they are the mesh before
the decomposition; the fields belong to this mesh, the number of failed checks to checkMesh -parallel.
Without these addresses, the pieces are joined along their processor patches, and the fields are those that the
processes of checkMesh -parallel have written. (Pieces on ranks would be one more member of Reading.)

Differences are relative for volumes and aspect ratios; others, of numbers of size 1, are absolute, angles as their
cosines. --table writes a page in Markdown. The exit code is 1 if a mesh differs by more than the limit, or in the
verdict.

What is known to differ does not count: the weights of faces at patches of the AMI kind, whose neighbors checkMesh
interpolates. The limit grows with what rounding leaves: with the slenderness of cells for the skewness, and with the
distance from the origin over the width of the smallest cell for all fields.
"""

import argparse
import json
import re
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
import tautline
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkVersion

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
#: Compared as well; the metric is for faces.
FACE_FIELD = "faceWeight"
NAMES = [*FIELDS, FACE_FIELD]
#: Stands for the number of failed checks where fields are named.
VERDICT_NAME = "verdict"
LIMIT = 1e-10
#: Patches whose faces have neighbors that checkMesh interpolates.
INTERPOLATED = {"cyclicAMI", "cyclicACMI", "cyclicPeriodicAMI"}
#: Above this slenderness, the rounding of the skewness grows with it.
SLENDER = 100
#: Beyond this many widths of a cell from the origin, the rounding of coordinates shows in the fields, at this rate.
FAR = 1e4
PER_WIDTH = 1e-12
VERDICT = re.compile(r"^(Mesh OK\.|Failed (\d+) mesh checks\.)", re.MULTILINE)
#: Why meshes are rejected, by the message.
REJECTIONS = {
    r"is open": "a cell has an edge that belongs to one or three of its faces, which no polyhedron has",
    r"more than once": "a face has a point twice",
}
#: Why there is no mesh to compare, by a part of the message of make_cases.py.
UNMADE = {
    "too many cells": "the mesh has more cells than the limit of make_cases.py",
    "took longer": "the mesh takes more time than the limit of make_cases.py",
    "binary": "the mesh is binary, and make_cases.py takes text",
    "": "the tutorial's programs end with an error before there is a mesh",
}
#: The head of the page.
HEAD = """# Comparison with checkMesh

*Element Quality* and OpenFOAM's checkMesh measure the same meshes: OpenFOAM's tutorials and small meshes with faults of
all kinds (`synthetic`). `Testing/OpenFoam/make_cases.py` makes each mesh as the scripts of its tutorial do, and runs
checkMesh on it (`-constant -allGeometry -allTopology -writeAllFields`, 17 digits). `Testing/OpenFoam/compare_cases.py`
reads and measures the mesh with Tautline, compares, and writes this page. To repair a mesh that fails, see [Failed 1
mesh checks](openfoam-mesh.md).

Programs: {versions}. The largest mesh has {largest} cells.

A mesh agrees if the number of failed checks is the same, and if all cells have the values that checkMesh has written,
up to {limit:g}. This limit grows with the rounding: with the distance from the origin where that is more than {far:g}
widths of the smallest cell ({rate:g} for each width), and, for the skewness, with the slenderness of cells beyond
{slender}. Differences of volumes and aspect ratios are relative; differences of angles are differences of their
cosines.

Decomposed meshes are read by one process. With the addresses that decomposePar has written, they are the mesh before
the decomposition, and are compared with its fields and with the number of failed checks of checkMesh on as many
processes. Joined along processor patches, without these addresses, they are compared with the fields that the processes
have written.
"""
TABLE_HEAD = """
The name is the path of the tutorial, and the region. Under *read*, `pieces` are read with the addresses of
decomposePar, `joined` ones along processor patches. The columns are the number of cells, of failed checks by Tautline
and by checkMesh, and the largest difference of each field.
"""


class Reading(Enum):
    """How a mesh is read; the values appear in the table."""

    WHOLE = "whole"
    ADDRESSED = "pieces"
    JOINED = "joined"


#: Rows of the summary.
READINGS = {
    Reading.WHOLE: "in one piece",
    Reading.ADDRESSED: "in pieces, with the addresses of decomposePar",
    Reading.JOINED: "in pieces, joined along processor patches",
}


#: Why a field or the number of failed checks differs, by a line of checkMesh's output, in some ways of reading.
REASONS = (
    ("aspectRatio", r"Mesh has 0 geometric", set(Reading),
     "patches of type empty leave no direction, and checkMesh then writes -1"),
    (FACE_FIELD, r"Error in face pyramids", {Reading.JOINED},
     "some cells have their center beyond a face; the distances that checkMesh weights with have signs at processor "
     "patches, and none at internal faces, which these are when joined"),
    (VERDICT_NAME, r"not in upper triangular order", {Reading.JOINED},
     "joined pieces have their faces in upper triangular order, whatever order they had"),
)  # fmt: skip


@dataclass(frozen=True)
class Mesh:
    """A mesh of a case."""

    case: Path
    region: str = ""
    reading: Reading = Reading.WHOLE

    @property
    def log(self) -> Path:
        """The output of checkMesh."""
        stem = "log.checkMesh" if self.reading == Reading.WHOLE else "log.checkPieces"
        return self.case / (stem + (f".{self.region}" if self.region else ""))

    @property
    def pieces(self) -> list[Path]:
        """The folders of processes, in their order."""
        folders = [folder for folder in self.case.glob("processor*") if (self.within(folder) / "polyMesh").exists()]
        return sorted(folders, key=lambda folder: int(folder.name.removeprefix("processor")))

    def within(self, folder: Path) -> Path:
        """The folder of the mesh and its fields in a case or in a piece of it."""
        return folder / "constant" / self.region

    def fields(self) -> list[Path]:
        """The folders of fields that belong to this way of reading; their values come one after the other."""
        return [self.within(folder) for folder in (self.pieces if self.reading == Reading.JOINED else [self.case])]


@dataclass
class Comparison:
    """The results for a mesh."""

    name: str
    reading: Reading = Reading.WHOLE
    cells: int = 0
    failed: int | None = None
    failed_by_checkmesh: int | None = None
    differences: dict[str, float] = field(default_factory=dict)
    limits: dict[str, float] = field(default_factory=dict)
    rejected: str = ""
    reason: str = ""

    @property
    def wrong(self) -> list[str]:
        """The fields that differ by more than rounding, or the verdict."""
        fields = [name for name, value in self.differences.items() if not value <= self.limits[name]]
        return fields + [VERDICT_NAME] * (self.failed != self.failed_by_checkmesh)

    @property
    def agrees(self) -> bool:
        return not self.rejected and not self.wrong


def read_field(file: Path) -> np.ndarray:
    """The values on the cells of a text file of OpenFOAM; a single one if it is uniform."""
    text = file.read_text()
    text = text[text.index("internalField") :]
    if uniform := re.match(r"internalField\s+uniform\s+([^;]+);", text):
        return np.array([float(uniform[1])])
    listed = re.match(r"internalField\s+nonuniform\s+List<scalar>\s*(\d+)\s*([({])", text)
    if listed is None:  # an empty list
        return np.zeros(0)
    if listed[2] == "{":
        return np.full(int(listed[1]), float(text[listed.end() : text.index("}", listed.end())]))
    return np.array(text[listed.end() : text.index(")", listed.end())].split(), float)


def read_fields(mesh: Mesh, name: str, cells: int) -> np.ndarray:
    """The values of a field on all cells of a mesh."""
    parts = zip(mesh.fields(), cells_of_parts(mesh, cells), strict=True)
    return np.concatenate([np.broadcast_to(read_field(folder / name), count) for folder, count in parts])


def cells_of_parts(mesh: Mesh, cells: int) -> list[int]:
    """The numbers of cells in the folders of fields; decomposePar has recorded the numbers for pieces."""
    folders = mesh.fields()
    if len(folders) == 1:
        return [cells]
    noted = [re.search(r"nCells:\s*(\d+)", (folder / "polyMesh/owner").read_text()) for folder in folders]
    return [int(one[1]) for one in noted if one]


def verdict(log: Path) -> int | None:
    """The number of failed checks in the output of checkMesh, which may end before its verdict."""
    found = VERDICT.findall(log.read_text())
    return int(found[-1][1] or 0) if found else None


def read_mesh(mesh: Mesh) -> Any:
    """A mesh, read in its way. Pieces are joined where their addresses are missing."""
    if mesh.reading != Reading.JOINED:
        file = mesh.case / f"{mesh.case.name}.foam"
        file.touch()
        return tautline.read(str(file), region=mesh.region, decomposed=mesh.reading != Reading.WHOLE)
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder)
        for piece in mesh.pieces:
            target = mesh.within(case / piece.name) / "polyMesh"
            target.mkdir(parents=True)
            for file in (mesh.within(piece) / "polyMesh").iterdir():
                if not file.name.endswith("ProcAddressing"):
                    (target / file.name).symlink_to(file.resolve())
        file = case / "case.foam"
        file.touch()
        return tautline.read(str(file), region=mesh.region, decomposed=True)


def face_weights(faces, piece: np.ndarray) -> np.ndarray:
    """For each cell the smallest weight of its faces, as checkMesh writes it: for internal faces the owner's weight,
    for coupled faces the weight of the cell itself. Faces between pieces are coupled.
    """
    arrays = {name: vtk_to_numpy(faces.GetCellData().GetArray(name)) for name in ("Owner", "Neighbour", "OwnerWeight")}
    weights = np.full(len(piece), np.inf)
    np.minimum.at(weights, arrays["Owner"], arrays["OwnerWeight"])
    inner = arrays["Neighbour"] >= 0
    owner, neighbor, weight = (arrays[name][inner] for name in ("Owner", "Neighbour", "OwnerWeight"))
    np.minimum.at(weights, neighbor, np.where(piece[owner] == piece[neighbor], weight, 1 - weight))
    return weights


def slenderness(faces, volumes: np.ndarray) -> float:
    """The largest ratio, over the cells, of the longest face to the width across the largest face; a cube has 1."""
    offsets = vtk_to_numpy(faces.GetPolys().GetOffsetsArray())
    at = vtk_to_numpy(faces.GetPoints().GetData())[vtk_to_numpy(faces.GetPolys().GetConnectivityArray())]
    starts = offsets[:-1]
    following = np.arange(1, len(at) + 1)
    following[offsets[1:] - 1] = starts
    spokes = at - at[starts].repeat(np.diff(offsets), 0)
    areas = np.linalg.norm(np.add.reduceat(np.cross(spokes, at[following] - at), starts), axis=1) / 2
    spans = (np.maximum.reduceat(at, starts) - np.minimum.reduceat(at, starts)).max(axis=1)
    largest, longest = np.zeros((2, len(volumes)))
    for name in "Owner", "Neighbour":
        cells = vtk_to_numpy(faces.GetCellData().GetArray(name))
        inside = cells >= 0
        np.maximum.at(largest, cells[inside], areas[inside])
        np.maximum.at(longest, cells[inside], spans[inside])
    solid = volumes > 0
    return float((longest * largest / np.where(solid, volumes, 1.0))[solid].max(initial=1.0))


def limits_of(mesh: Mesh, points: np.ndarray, faces, volumes: np.ndarray) -> dict[str, float]:
    """The tolerances of the fields."""
    width = np.cbrt(volumes[volumes > 0].min()) if (volumes > 0).any() else 1.0
    distance = np.abs(points).max() / width
    limit = LIMIT if distance < FAR else max(LIMIT, PER_WIDTH * distance)
    limits = dict.fromkeys(NAMES, limit)
    limits["skewness"] = limit * max(1.0, slenderness(faces, volumes) / SLENDER)
    if patch_types(mesh) & INTERPOLATED:
        limits[FACE_FIELD] = np.inf
    return limits


def patch_types(mesh: Mesh) -> set[str]:
    """The types of the patches that have faces."""
    text = (mesh.within(mesh.case) / "polyMesh/boundary").read_text()
    found = re.findall(r"\btype\s+(\w+);[^}]*?\bnFaces\s+(\d+);", text)
    return {kind for kind, faces in found if int(faces)}


def explained(found: Comparison, log: str) -> str:
    """Why a mesh is rejected or differs, as far as it is known."""
    if found.rejected:
        known = [reason for message, reason in REJECTIONS.items() if re.search(message, found.rejected)]
        return known[0] if known else re.sub(r"\S*/(?=\w+:)", "", found.rejected)
    wrong = found.wrong
    known = [
        reason for name, line, readings, reason in REASONS
        if name in wrong and found.reading in readings and re.search(line, log)
    ]  # fmt: skip
    return "; ".join(known) if len(known) == len(wrong) else ""


def compare_mesh(mesh: Mesh, name: str) -> Comparison:
    """Measure a mesh, and compare it with the fields and the log of checkMesh."""
    found = Comparison(name, mesh.reading, failed_by_checkmesh=verdict(mesh.log))
    try:
        data = read_mesh(mesh)
        result = tautline.quality(data, [metric for metric, _ in FIELDS.values()], face_output="all")
    except tautline.Error as error:
        found.rejected = str(error)
        found.reason = explained(found, "")
        return found
    found.cells = cells = int((vtk_to_numpy(data.GetCellData().GetArray("Face")) < 0).sum())
    found.failed = result.failed_checks_of_all
    volumes = np.abs(result.values["cell_volume"][:cells])
    found.limits = limits_of(mesh, vtk_to_numpy(data.GetPoints().GetData()), result.faces, volumes)
    for name, (metric, relative) in FIELDS.items():
        own, theirs = result.values[metric][:cells], read_fields(mesh, name, cells)
        if name == "nonOrthoAngle":
            own, theirs = (np.cos(np.radians(values)) for values in (own, theirs))
        scale = np.maximum(np.abs(theirs), 1e-300 if relative else 1.0)
        found.differences[name] = float((np.abs(own - theirs) / scale).max())
    theirs = read_fields(mesh, FACE_FIELD, cells)
    counts = cells_of_parts(mesh, cells)
    own = face_weights(result.faces, np.arange(len(counts)).repeat(counts))
    found.differences[FACE_FIELD] = float(np.abs(own - theirs).max())
    found.reason = explained(found, mesh.log.read_text())
    return found


def compare(case: Path, region: str = "", reading: Reading = Reading.WHOLE) -> Comparison:
    """Measure a case, and compare it with the fields and the log of checkMesh."""
    return compare_mesh(Mesh(case, region, reading), case.name)


def meshes_of(case: Path) -> list[Mesh]:
    """The meshes of a case that checkMesh has written an output of, in all ways to read them."""
    found = []
    for stem, readings in [("checkMesh", [Reading.WHOLE]), ("checkPieces", [Reading.ADDRESSED, Reading.JOINED])]:
        for log in sorted(case.glob(f"log.{stem}*")):
            region = log.name.removeprefix(f"log.{stem}").removeprefix(".")
            if (case / "constant" / region / "polyMesh").exists():
                found += [Mesh(case, region, reading) for reading in readings]
    return found


@dataclass
class Cases:
    """The meshes of folders, each once, and their entries in the tables of make_cases.py."""

    meshes: dict[tuple[str, Reading], tuple[str, Mesh]] = field(default_factory=dict)  # by what they contain
    tutorials: set[str] = field(default_factory=set)
    same: set[str] = field(default_factory=set)  # tutorials with the mesh of another one
    others: dict[str, str] = field(default_factory=dict)  # what was not compared, with the reason

    def add(self, folder: Path) -> None:
        """Take the meshes of a folder that no folder before has."""
        table = folder / "results.json"
        rows = json.loads(table.read_text()) if table.exists() else []
        known = {(row["case"], row["region"]): row for row in rows if row.get("hash") and not row.get("same_as")}
        for case in sorted(path for path in folder.iterdir() if path.is_dir()):
            for mesh in meshes_of(case):
                row = known.get((case.name, mesh.region), {"tutorial": case.name})
                path = f"{row['tutorial']} {mesh.region}".strip()
                written = all((into / name).exists() for into in mesh.fields() for name in NAMES)
                if written and verdict(mesh.log) is not None:
                    self.meshes.setdefault((row.get("hash", path), mesh.reading), (path, mesh))
                else:
                    self.others[f"{path} {mesh.reading.value}"] = "checkMesh ends before it has written all fields"
        self.tutorials |= {row["tutorial"] for row in rows}
        self.same |= {row["tutorial"] for row in rows if row.get("same_as") and not row["region"]}
        for row in rows:
            if not row.get("hash"):
                self.others[row["tutorial"]] = next(text for found, text in UNMADE.items() if found in row["verdict"])


def number(value: float) -> str:
    """A difference, in the table."""
    return f"{value:.0e}" if value else "0"


def counted(comparisons: Iterable[Comparison], label: str) -> str:
    """A row of the summary."""
    of = list(comparisons)
    agree, rejected = sum(found.agrees for found in of), sum(bool(found.rejected) for found in of)
    cells = sum(found.cells for found in of)
    return f"| {label} | {len(of)} | {cells} | {agree} | {len(of) - agree - rejected} | {rejected} |"


def versions(cases: Cases) -> str:
    """The programs that have measured."""
    texts = [mesh.log.read_text() for _, mesh in cases.meshes.values()]
    builds = {found[0] for text in texts if (found := re.search(r"(?<=OPENFOAM=).*", text))}
    openfoam = ", ".join(build.replace("=", " ") for build in sorted(builds))
    return f"OpenFOAM {openfoam}; Tautline {tautline.__version__} with VTK {vtkVersion.GetVTKVersion()}"


def summary(cases: Cases, comparisons: list[Comparison]) -> list[str]:
    """How many meshes agree, and by how much."""
    lines = ["## Summary", "", "| meshes | compared | cells | agree | differ | rejected |", "|---" * 6 + "|"]
    for reading, label in READINGS.items():
        lines.append(counted((found for found in comparisons if found.reading == reading), label))
    lines += [counted(comparisons, "all"), ""]
    whole = [mesh for _, mesh in cases.meshes.values() if mesh.reading == Reading.WHOLE]
    regions = sum(bool(mesh.region) for mesh in whole)
    synthetic = {name for name in cases.tutorials if name.startswith("synthetic/")}
    lines.append(
        f"Tutorials: {len(cases.tutorials - synthetic)}; {len(cases.same)} of them have the same mesh as another one, "
        f"which is compared once. Synthetic cases: {len(synthetic)}. Regions, each a mesh: {regions}."
    )
    kinds = Counter(kind for mesh in whole for kind in patch_types(mesh))
    lines += ["", "Types of patches in the meshes in one piece, and the number of meshes that have them: "
              + ", ".join(f"{kind} {count}" for kind, count in kinds.most_common()) + ".", ""]  # fmt: skip
    lines += ["Not compared:", ""]
    lines += [f"- {reason}: {count}" for reason, count in Counter(cases.others.values()).most_common()]
    exact = [found for found in comparisons if found.agrees]
    lines += ["", "The largest difference in a mesh, over all meshes that agree:", ""]
    lines += ["| field of checkMesh | metric | difference | median | largest | of |", "|---" * 6 + "|"]
    for name in NAMES:
        metric, relative = FIELDS.get(name, ("OwnerWeight of the output Faces", False))
        of = [found for found in exact if found.limits[name] < np.inf]
        if of:
            worst = max(of, key=lambda found: found.differences[name])
            kind = "relative" if relative else "of cosines" if name == "nonOrthoAngle" else "absolute"
            middle = float(np.median([found.differences[name] for found in of]))
            values = f"{number(middle)} | {number(worst.differences[name])}"
            lines.append(f"| {name} | {metric} | {kind} | {values} | {worst.name} |")
    return lines


def disagreements(comparisons: list[Comparison]) -> list[str]:
    """Differences and rejections, by the reason."""
    lines = ["## What differs", ""]
    groups: dict[str, list[str]] = {}
    for found in comparisons:
        if found.agrees:
            continue
        if found.rejected:
            key, text = f"Rejected: {found.reason}", found.name
        else:
            key, text = f"Differs: {found.reason or 'not explained'}", found.name
            parts = [f"{name} by {number(found.differences[name])}" for name in found.wrong if name in NAMES]
            if VERDICT_NAME in found.wrong:
                parts.append(f"{found.failed} failed checks, {found.failed_by_checkmesh} by checkMesh")
            text += f" ({', '.join(parts)})"
        if found.reading != Reading.WHOLE:
            text += f", {READINGS[found.reading]}"
        groups.setdefault(key, []).append(text)
    for reason, names in sorted(groups.items()):
        lines += [f"- {reason}.", *(f"  - {name}" for name in names)]
    if not groups:
        lines.append("Nothing.")
    ami = sum(found.limits.get(FACE_FIELD) == np.inf for found in comparisons)
    text = f"Meshes with patches of the AMI types, whose {FACE_FIELD} is in the table, but does not count: {ami}."
    lines += ["", text]
    return lines


def page(cases: Cases, comparisons: list[Comparison]) -> str:
    """The page of the comparison, in Markdown."""
    largest = max((found.cells for found in comparisons), default=0)
    limits = {"limit": LIMIT, "far": FAR, "rate": PER_WIDTH, "slender": SLENDER}
    lines = [HEAD.format(versions=versions(cases), largest=largest, **limits)]
    lines += [*summary(cases, comparisons), "", *disagreements(comparisons), ""]
    lines += ["## Meshes", "", TABLE_HEAD.strip(), ""]
    lines += ["|mesh|read|cells|failed|checkMesh|" + "|".join(NAMES) + "|", "|---" * (5 + len(NAMES)) + "|"]
    for found in comparisons:
        start = f"|{found.name}|{found.reading.value if found.reading != Reading.WHOLE else ''}|"
        if found.rejected:
            lines.append(f"{start}|rejected|{found.failed_by_checkmesh}|" + "|" * len(NAMES))
            continue
        values = "|".join(number(found.differences[name]) for name in NAMES)
        lines.append(f"{start}{found.cells}|{found.failed}|{found.failed_by_checkmesh}|{values}|")
    return "\n".join(lines) + "\n"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", type=Path, nargs="+")
    parser.add_argument("--table", type=Path)
    arguments = parser.parse_args()
    cases = Cases()
    for folder in arguments.cases:
        cases.add(folder)
    order = list(Reading)
    named = sorted(cases.meshes.values(), key=lambda entry: (entry[0], order.index(entry[1].reading)))
    comparisons = [compare_mesh(mesh, name) for name, mesh in named]
    for found in comparisons:
        if found.rejected:
            print(f"{found.name} {found.reading.value}: rejected: {found.rejected}")
        elif not found.agrees:
            failed = f"{found.failed} failed checks, {found.failed_by_checkmesh} by checkMesh"
            print(f"{found.name} {found.reading.value}: {failed};", found.wrong)
    agreeing = sum(found.agrees for found in comparisons)
    print(f"{len(comparisons)} meshes, {agreeing} agree")
    if arguments.table:
        arguments.table.write_text(page(cases, comparisons))
    return 0 if agreeing == len(comparisons) else 1


if __name__ == "__main__":
    sys.exit(main())
