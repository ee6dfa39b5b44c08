#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""make_cases.py [options] [TUTORIAL...]: meshes of OpenFOAM's tutorials, and the verdicts of checkMesh.

Every tutorial (all with a blockMeshDict by default) is meshed the way its own scripts do it: they run in a copy of the
tutorials, with a PATH that has nothing but the tools for meshes and files, and end where the first solver would start.
Each mesh that comes out, told apart by its points, faces, and patches, is checked by

    checkMesh -constant -allGeometry -allTopology -writeAllFields

and kept as a case in the folder of the results: constant/polyMesh, the fields of checkMesh in constant (ASCII, 17
digits), and its output in log.checkMesh. A table of all is written as results.json and results.csv. Meshes that are in
the table already are not run again. --synthetic makes meshes of its own as well, with faults that no tutorial has.

A mesh of a region is checked with -region, and its fields are in constant/REGION, its output in log.checkMesh.REGION.

With --decompose N, each case that is kept is also divided into N pieces by decomposePar (hierarchical, with more parts
where the mesh is long), and checked by checkMesh -parallel on N processes. The pieces, and what each process writes of
its own, are in processor0, processor1, ... of the case, the output in log.checkPieces, or for a region in
log.checkPieces.REGION. A mesh with fewer than N cells is not divided. DECOMPOSED lists tutorials of many kinds, which
--decompose takes if none is named.

The tutorials are looked for in the folder of FOAM_TUTORIALS, the settings of OpenFOAM in the folder of WM_PROJECT_DIR,
and its programs in PATH. One program runs at a time.
"""

import argparse
import csv
import gzip
import hashlib
import itertools
import json
import math
import os
import random
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

#: Programs of OpenFOAM that make or change a mesh, or what such programs read.
MESHERS = """
    ansysToFoam attachMesh autoPatch autoRefineMesh blockMesh cfx4ToFoam collapseEdges combinePatchFaces
    createBaffles createBoxTurb createPatch datToFoam extrude2DMesh extrudeMesh extrudeToRegionMesh flattenMesh
    fluent3DMeshToFoam fluentMeshToFoam foamDictionary foamyHexMesh foamyHexMeshBackgroundMesh foamyQuadMesh
    gmshToFoam insideCells kivaToFoam mergeMeshes mergeOrSplitBaffles mirrorMesh modifyMesh PDRblockMesh
    plot3dToFoam polyDualMesh refineHexMesh refinementLevel refineMesh refineWallLayer removeFaces renumberMesh
    rotateMesh selectCells setSet setsToZones singleCellMesh snappyHexMesh snappyRefineMesh splitCells splitMesh
    splitMeshRegions star4ToFoam stitchMesh subsetMesh surfaceAdd surfaceAutoPatch surfaceBooleanFeatures
    surfaceCheck surfaceClean surfaceCoarsen surfaceConvert surfaceFeatureConvert surfaceFeatureExtract
    surfaceGenerateBoundingBox surfaceInertia surfaceMeshConvert surfaceMeshExtract surfaceOrient
    surfaceSplitByPatch surfaceSubset surfaceTransformPoints tetgenToFoam topoSet transformPoints zipUpMesh
""".split()
#: Programs of OpenFOAM that a script may call before it is done with the mesh. They are left out.
PASSED = """
    changeDictionary checkMesh createExternalCoupledPatchGeometry createZeroDirectory decomposePar foamFormatConvert
    foamListTimes foamToEnsight foamToVTK makeFaMesh mapFields paraFoam patchSummary postProcess reconstructPar
    reconstructParMesh redistributePar setAlphaField setExprFields setFields surfaceRedistributePar topoSetSource
""".split()
#: Programs for files that the scripts call.
FILES = """
    awk basename bc cat chmod cp cut date diff dirname echo egrep env expr find grep gunzip gzip head id ln ls m4
    mkdir mktemp mv paste perl printf pwd readlink rm rmdir sed seq sh bash sleep sort tail tar tee test touch tr
    true false uname uniq wc which xargs
""".split()
#: Stands in for RunFunctions and CleanFunctions of OpenFOAM. The output of a solver is the end of a script.
FUNCTIONS = r"""
isTest() { return 1; }
notTest() { return 0; }
isTrue() { case "$1" in t|true|y|yes|on) return 0;; esac; return 1; }
isParallel() { return 1; }
canCompile() { return 1; }
hasWebServer() { return 1; }
getNumberOfProcessors() { echo 1; }
getNumberOfPatchFaces() { sed -ne "/^ *$1\$/,/}/s/.*nFaces *\([0-9]*\) *;.*/\1/p" constant/polyMesh/boundary; }
getApplication() { echo aSolver; }
restore0Dir() { [ ! -d 0.orig ] || { rm -rf 0; cp -r 0.orig 0; }; }
cloneCase() { mkdir -p "$2"; cp -r "$1"/0* "$1"/system "$1"/constant "$2"/ 2>/dev/null || true; }
cloneMesh() { mkdir -p "$2"/constant; cp -r "$1"/constant/polyMesh "$2"/constant/; }
linkMesh() { cloneMesh "$@"; }
cloneParallelCase() { :; }
compileApplication() { :; }
foamRunTutorials() { exit 0; }
foamCleanTutorials() { :; }
runOne()
{
    name=${1##*/}
    case "$1" in
    */*) "$@" > "log.$name$suffix" 2>&1; return;;
    esac
    case " $MESHERS " in *" $name "*) "$@" > "log.$name$suffix" 2>&1; return;; esac
    case " $PASSED " in *" $name "*) return 0;; esac
    exit 0
}
runApplication()
{
    suffix=
    while [ $# -gt 0 ]
    do
        case "$1" in
        -a|-append|-o|-overwrite) shift;;
        -s|-suffix) suffix=".$2"; shift 2;;
        -np|-n|-decomposeParDict) shift 2;;
        *) break;;
        esac
    done
    runOne "$@"
}
runParallel() { runApplication "$@"; }
cleanCase() { :; }
cleanCase0() { :; }
cleanAuxiliary() { :; }
cleanDynamicCode() { :; }
cleanFaMesh() { :; }
cleanPolyMesh() { :; }
cleanPostProcessing() { :; }
cleanSamples() { :; }
cleanSnappyFiles() { :; }
cleanTimeDirectories() { :; }
cleanUcomponents() { :; }
removeCase() { :; }
"""
WRAPPER = r"""#!/bin/sh
{program} "$@"
status=$?
printf '%s\t%s\n' "{name}${{*:+ $*}}" "$status" >> "$MESHING_LOG"
exit $status
"""
CHECK = ["checkMesh", "-constant", "-allGeometry", "-allTopology"]
FIELDS = """
    nonOrthoAngle faceWeight skewness cellDeterminant aspectRatio cellShapes cellVolume cellVolumeRatio minTetVolume
    cellRegion
""".split()
#: Scripts of a tutorial that make its mesh, the best first.
SCRIPTS = ["Allrun", "Allrun.pre", "Allrun-pre", "Allmesh", "Allrun.mesh", "Allrun-serial"]
#: Category and solver: a script there is for several tutorials.
SHARED_DEPTH = 2
HEAD = """FoamFile
{{
    version 2.0;
    format ascii;
    class {kind};
    location "{location}";
    object {name};
}}
"""
SCHEMES = """
ddtSchemes { default steadyState; }
gradSchemes { default Gauss linear; }
divSchemes { default none; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""
#: Settings after the tutorial's own in its controlDict, which override them.
SETTINGS = """
writeFormat ascii;
writePrecision 17;
writeCompression off;
timePrecision 12;
"""
#: How decomposePar divides a mesh; its own partitioner needs no library that may be missing.
DECOMPOSITION = """
numberOfSubdomains {pieces};
method hierarchical;
coeffs {{ n ({parts}); }}
"""
#: Open MPI starts no processes of root, nor more than there are cores, unless told so.
PARALLEL = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
#: Planes, a wedge, a line, periodic in three directions and about an axis, with baffles, sliding interfaces,
#: polyhedra of snappyHexMesh, stitched sides, curved blocks, and regions.
DECOMPOSED = """
    incompressible/icoFoam/cavity/cavity combustion/reactingFoam/RAS/SandiaD_LTS financial/financialFoam/europeanCall
    DNS/dnsFoam/boxTurb16 incompressible/simpleFoam/pipeCyclic multiphase/interIsoFoam/discInConstantFlowCyclicBCs
    multiphase/interFoam/RAS/damBreakPorousBaffle heatTransfer/buoyantSimpleFoam/circuitBoardCooling
    incompressible/pimpleFoam/laminar/mixerVesselAMI2D incompressible/pimpleFoam/RAS/oscillatingInletACMI2D
    mesh/snappyHexMesh/flange mesh/snappyHexMesh/opposite_walls mesh/stitchMesh/simple-cube1 mesh/blockMesh/sphere7
    IO/fileHandler heatTransfer/chtMultiRegionFoam/snappyMultiRegionHeater
    heatTransfer/chtMultiRegionFoam/reverseBurner
""".split()
CONTROL = """
application checkMesh;
startFrom startTime;
startTime 0;
stopAt endTime;
endTime 1;
deltaT 1;
writeControl timeStep;
writeInterval 1;
"""

Point = tuple[float, float, float]
Face = tuple[int, ...]


class TooLong(Exception):
    """A program ran longer than it may."""


def run(command: Sequence[str], folder: Path, environment: dict[str, str], seconds: float, log: Path) -> int:
    """Exit status of a command, its output in a file. All that it started ends with it, and after a time."""
    limits = [(resource.RLIMIT_AS, int(environment["MAKE_CASES_MEMORY"])),
              (resource.RLIMIT_FSIZE, int(environment["MAKE_CASES_FILE"])), (resource.RLIMIT_CORE, 0)]  # fmt: skip

    def limit() -> None:
        for kind, most in limits:
            resource.setrlimit(kind, (most, most))

    environment = {**environment, "PWD": str(folder)}
    with log.open("wb") as output:
        process = subprocess.Popen(
            command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
            start_new_session=True, preexec_fn=limit,
        )  # fmt: skip
        try:
            return process.wait(seconds)
        except subprocess.TimeoutExpired:
            raise TooLong(f"{command[0]} took longer than {seconds:.0f} s") from None
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
            process.wait()


def without_comments(text: str) -> str:
    """A dictionary of OpenFOAM without comments."""
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.S)


def without_entry(text: str, name: str) -> str:
    """A dictionary without the sub-dictionaries or lists of a name at its top level."""
    while found := re.search(rf"^{name}\s*(\{{|\()", text, flags=re.M):
        depth, end = 0, found.end() - 1
        for end in range(found.end() - 1, len(text)):
            depth += {"{": 1, "(": 1, "}": -1, ")": -1}.get(text[end], 0)
            if depth == 0:
                break
        text = text[: found.start()] + text[end + 1 :].lstrip(" \t\n;")
    return text


def set_format(case: Path) -> None:
    """Makes all that runs in a case write ASCII with all digits, and no function object run in it."""
    file = case / "system/controlDict"
    text = without_comments(file.read_text(errors="replace"))
    for name in "functions", "libs":
        text = without_entry(text, name)
    file.write_text(text + SETTINGS)
    for name in "fvSchemes", "fvSolution":
        if not (case / "system" / name).exists():
            head = HEAD.format(kind="dictionary", location="system", name=name)
            (case / "system" / name).write_text(head + (SCHEMES if name == "fvSchemes" else ""))


def foam_list(file: Path) -> bytes:
    """The contents of a file of a mesh, without its header."""
    text = re.sub(rb"//[^\n]*|/\*.*?\*/", b"", file.read_bytes(), flags=re.S)
    return re.sub(rb"^\s*FoamFile\s*\{.*?\}", b"", text, count=1, flags=re.S)


def number_of_cells(mesh: Path) -> int:
    """Cells of a mesh: one more than the largest owner or neighbor."""
    numbers: list[int] = []
    for name in "owner", "neighbour":
        numbers += map(int, re.findall(rb"\d+", foam_list(mesh / name))[1:])
    return max(numbers, default=-1) + 1


def patches(mesh: Path) -> list[tuple[str, str, int]]:
    """Name, type, and number of faces of the patches of a mesh."""
    text = foam_list(mesh / "boundary").decode(errors="replace")
    found = re.findall(r"(\S+)\s*\{([^{}]*)\}", text)
    result = []
    for name, entries in found:
        kind, faces = re.search(r"\btype\s+(\w+)", entries), re.search(r"\bnFaces\s+(\d+)", entries)
        if kind and faces:
            result.append((name, kind[1], int(faces[1])))
    return result


def fingerprint(mesh: Path) -> str:
    """Same for meshes with the same points, faces, and kinds of patches."""
    digest = hashlib.sha256()
    for name in "points", "faces", "owner", "neighbour":
        digest.update(b" ".join(foam_list(mesh / name).split()))
    digest.update(repr([(kind, faces) for _, kind, faces in patches(mesh)]).encode())
    return digest.hexdigest()


def estimated_cells(dictionary: Path) -> int:
    """Cells that blockMesh would make, as far as the numbers are written in its dictionary."""
    if not dictionary.exists():
        return 0
    text = without_comments(dictionary.read_text(errors="replace"))
    blocks = re.findall(r"\bhex\s*\([^()]*\)\s*\w*\s*\(\s*(\d+)\s+(\d+)\s+(\d+)\s*\)", text)
    return sum(math.prod(map(int, block)) for block in blocks)


def parts(mesh: Path, pieces: int) -> list[int]:
    """Numbers whose product is a number of pieces, for the directions of a mesh: the longest part is divided first."""
    axes = list(zip(*(map(float, point.split()) for point in re.findall(rb"\(([^()]+)\)", foam_list(mesh / "points")))))
    lengths = [max(axis) - min(axis) for axis in axes]
    factors, divisor = [], 2
    while pieces > 1:
        while pieces % divisor == 0:
            factors.append(divisor)
            pieces //= divisor
        divisor += 1
    result = [1, 1, 1]
    for factor in reversed(factors):
        axis = max(range(3), key=lambda i: lengths[i] / result[i])
        result[axis] *= factor
    return result


class Tutorials:
    """A copy of the tutorials, and the tools that their scripts may use."""

    def __init__(self, source: Path, project: Path, work: Path, arguments: argparse.Namespace) -> None:
        self.folder, self.arguments = work / "tutorials", arguments
        if not self.folder.exists():
            part = work / "tutorials.part"
            shutil.rmtree(part, ignore_errors=True)
            shutil.copytree(source, part, symlinks=True)
            for packed in part.rglob("*.gz"):
                plain = packed.with_suffix("")
                if not plain.exists():
                    plain.write_bytes(gzip.decompress(packed.read_bytes()))
                    plain.chmod(packed.stat().st_mode | 0o200)
            part.rename(self.folder)
        tools = work / "project/bin/tools"
        tools.mkdir(parents=True, exist_ok=True)
        for name in "RunFunctions", "CleanFunctions", "LogFunctions":
            (tools / name).write_text(FUNCTIONS)
        settings = work / "project/etc"
        if not settings.exists():
            settings.symlink_to(project / "etc")
        programs = work / "programs"
        shutil.rmtree(programs, ignore_errors=True)
        programs.mkdir()
        for name in FILES:
            if found := shutil.which(name):
                (programs / name).symlink_to(found)
        self.missing = [name for name in MESHERS if not shutil.which(name)]
        for name in MESHERS:
            if found := shutil.which(name):
                (programs / name).write_text(WRAPPER.format(program=shlex.quote(found), name=name))
                (programs / name).chmod(0o755)
        for name in PASSED:
            (programs / name).symlink_to(shutil.which("true") or "/bin/true")
        self.environment = {
            "HOME": str(work), "LANG": "C", "LC_ALL": "C", "PATH": str(programs), "WM_PROJECT": "OpenFOAM",
            "WM_PROJECT_DIR": str(work / "project"), "FOAM_TUTORIALS": str(self.folder),
            "FOAM_ETC": str(settings), "MESHERS": " ".join(MESHERS), "PASSED": " ".join(PASSED),
            "MESHING_LOG": str(work / "meshing.log"), "MAKE_CASES_MEMORY": str(arguments.memory << 30),
            "MAKE_CASES_FILE": str(arguments.file << 20),
        }  # fmt: skip
        self.meshing_log = work / "meshing.log"
        self.checker = {**self.environment, "PATH": os.environ["PATH"]}

    def cases(self) -> list[str]:
        """All with a blockMeshDict, those last whose scripts take long."""
        found = set()
        for dictionary in sorted(self.folder.rglob("blockMeshDict*")):
            for folder in dictionary.parents:
                if (folder / "system/controlDict").exists():
                    found.add(str(folder.relative_to(self.folder)))
                    break
                if folder == self.folder:
                    break

        def long(name: str) -> bool:
            return any((self.folder / name / "system").glob("snappyHexMeshDict*")) or "foamy" in name

        return sorted(found, key=lambda name: (long(name), name))

    def script(self, case: str) -> tuple[Path, str | None]:
        """Folder and name of the script that makes the mesh of a case: the highest for this tutorial alone."""
        best: tuple[Path, str | None] = (self.folder / case, None)
        for folder in [self.folder / case, *(self.folder / case).parents]:
            depth = len(folder.relative_to(self.folder).parts)
            if folder != self.folder / case and depth <= SHARED_DEPTH:
                break
            for name in SCRIPTS:
                if (folder / name).exists():
                    best = folder, name
                    break
        return best

    def make(self, case: str) -> list[str]:
        """Makes the meshes of a case and of all that its script makes; the commands that ran, with bad exit status."""
        folder, script = self.script(case)
        for control in folder.rglob("system/controlDict"):
            set_format(control.parents[1])
        if not (folder / "system/controlDict").exists() and not any(folder.rglob("system/controlDict")):
            return []
        self.meshing_log.write_text("")
        end = time.monotonic() + self.arguments.seconds
        try:
            if script:
                shell = "bash" if "bash" in first_line(folder / script) else "sh"
                run([shell, f"./{script}"], folder, self.environment, self.arguments.seconds, folder / "log.script")
            if not meshes(self.folder / case) and not any(self.folder.joinpath(case).glob("processor*")):
                left = max(1.0, end - time.monotonic())
                log = self.folder / case / "log.blockMesh.alone"
                run(["blockMesh"], self.folder / case, self.environment, left, log)
        finally:
            commands = []
            for line in self.meshing_log.read_text(errors="replace").splitlines():
                words, _, status = line.rpartition("\t")
                commands.append(words if status == "0" else f"{words} [exit {status}]")
        return commands

    def decompose(self, case: Path, region: str, pieces: int, seconds: float) -> bool:
        """Divides a mesh of a case, which has no fields yet."""
        mesh = case / "constant" / region / "polyMesh"
        text = HEAD.format(kind="dictionary", location="system", name="decomposeParDict")
        text += DECOMPOSITION.format(pieces=pieces, parts=" ".join(map(str, parts(mesh, pieces))))
        for folder in {case / "system", case / "system" / region}:
            folder.mkdir(exist_ok=True)
            (folder / "decomposeParDict").write_text(text)
        options = ["-region", region] if region else []
        log = case / ("log.decomposePar" + (f".{region}" if region else ""))
        return run(["decomposePar", "-constant", *options], case, self.checker, seconds, log) == 0

    def check(self, case: Path, region: str, seconds: float, pieces: int = 1) -> str:
        """Checks a mesh of a case, or its pieces, and writes its fields; returns the verdict of checkMesh."""
        log = case / (("log.checkPieces" if pieces > 1 else "log.checkMesh") + (f".{region}" if region else ""))
        options = ["-region", region] if region else []
        environment, check = self.checker, CHECK
        if pieces > 1:
            environment = {**environment, **PARALLEL}
            check = ["mpirun", "--oversubscribe", "-np", str(pieces), *CHECK, "-parallel"]
        status = run([*check, "-writeAllFields", *options], case, environment, seconds, log)
        if status:
            log.rename(log.with_name(log.name + ".allFields"))
            fields = ["-writeFields", f"({' '.join(FIELDS)})"]
            status = run([*check, *fields, *options], case, environment, seconds, log)
        text = log.read_text(errors="replace")
        verdicts = re.findall(r"^(Mesh OK\.|Failed \d+ mesh checks\.)", text, flags=re.M)
        if status and (found := re.search(r"FOAM FATAL.*?\n(.*?)\n(?:\s*From|\n)", text, flags=re.S)):
            return f"{verdicts[-1] if verdicts else ''} checkMesh ended: {' '.join(found[1].split())[:200]}".strip()
        if status:
            return f"{verdicts[-1] if verdicts else ''} checkMesh ended with exit status {status}".strip()
        return verdicts[-1] if verdicts else "no verdict"


def first_line(file: Path) -> str:
    """The first line of a file."""
    with file.open(errors="replace") as lines:
        return lines.readline()


def meshes(case: Path) -> list[str]:
    """Regions of a case that have a mesh; '' is the one without a name. A mesh of a later time moves to constant."""
    times = []
    for folder in case.iterdir() if case.is_dir() else []:
        if re.fullmatch(r"[0-9.]+(e[-+]?\d+)?", folder.name) and folder.is_dir():
            times.append((float(folder.name), folder))
    for _, folder in sorted(times):
        for mesh in sorted(folder.glob("polyMesh")) + sorted(folder.glob("*/polyMesh")):
            if (mesh / "faces").exists() or (mesh / "points").exists():
                target = case / "constant" / mesh.relative_to(folder)
                if (mesh / "faces").exists() and target.exists():
                    shutil.rmtree(target)
                shutil.copytree(mesh, target, dirs_exist_ok=True)
                shutil.rmtree(mesh)
    needed = ["points", "faces", "owner", "neighbour", "boundary"]
    found = sorted((case / "constant").glob("polyMesh")) + sorted((case / "constant").glob("*/polyMesh"))
    for mesh in found:
        for name in needed:
            if (mesh / f"{name}.gz").exists() and not (mesh / name).exists():
                (mesh / name).write_bytes(gzip.decompress((mesh / f"{name}.gz").read_bytes()))
    whole = [mesh for mesh in found if all((mesh / name).exists() for name in needed)]
    return [mesh.parent.name if mesh.parents[1] != case else "" for mesh in whole]


def reason(folder: Path) -> str:
    """The fault that ended the last program, from the logs in a folder."""
    logs = sorted(folder.rglob("log.*"), key=lambda file: file.stat().st_mtime)
    for log in reversed(logs):
        text = log.read_text(errors="replace")
        if found := re.search(r"FOAM FATAL.*?\n(.*?)\n(?:\s*From|\n)", text, flags=re.S):
            return f"{log.name}: {' '.join(found[1].split())[:200]}"
    script = folder / "log.script"
    return f"no mesh; {' '.join(script.read_text(errors='replace').split())[-200:]}" if script.exists() else "no mesh"


class Results:
    """The table of all meshes, and the cases that are kept."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.file = folder, folder / "results.json"
        folder.mkdir(parents=True, exist_ok=True)
        self.rows: list[dict[str, Any]] = json.loads(self.file.read_text()) if self.file.exists() else []
        self.known = {row["hash"]: row["case"] for row in self.rows if row.get("hash") and not row.get("same_as")}
        self.done = {row["tutorial"] for row in self.rows}

    def add(self, **row: Any) -> None:
        """Adds a row and writes the table."""
        self.rows.append(row)
        self.done.add(row["tutorial"])
        print(f"{row['tutorial']} {row.get('region') or ''}: {row.get('cells', '')} {row['verdict']}", flush=True)
        self.file.write_text(json.dumps(self.rows, indent=1) + "\n")
        columns = "tutorial region case cells seconds verdict pieces verdict_of_pieces same_as patches commands hash"
        columns = columns.split()
        with self.file.with_suffix(".csv").open("w", newline="") as output:
            writer = csv.DictWriter(output, columns)
            writer.writeheader()
            for each in self.rows:
                line = {name: each.get(name, "") for name in columns}
                line["commands"] = "; ".join(each.get("commands", []))
                writer.writerow(line)

    def keep(self, tutorials: Tutorials, tutorial: str, case: Path, commands: list[str], seconds: float) -> int:
        """Checks and keeps the meshes of a case that are new; the number of meshes it has."""
        regions = meshes(case)
        name = tutorial.replace("/", "_")
        target = self.folder / name
        for region in regions:
            row: dict[str, Any] = {"tutorial": tutorial, "region": region, "case": name, "commands": commands}
            mesh = case / "constant" / region / "polyMesh"
            if re.search(rb"\bformat\s+binary\b", (mesh / "points").read_bytes()[:2000]):
                self.add(**row, verdict="binary mesh")
                continue
            row["cells"] = number_of_cells(mesh)
            row["patches"] = " ".join(sorted({kind for _, kind, faces in patches(mesh) if faces}))
            row["hash"] = fingerprint(mesh)
            row["seconds"] = round(seconds, 1)
            if row["hash"] in self.known:
                row["same_as"] = self.known[row["hash"]]
                self.add(**row, verdict=f"same mesh as {row['same_as']}")
            elif row["cells"] > tutorials.arguments.cells:
                self.add(**{**row, "hash": ""}, verdict="too many cells")
            else:
                if not target.exists():
                    copy_case(case, target)
                try:
                    self.divide(tutorials, target, region, row)
                    start = time.monotonic()
                    verdict = tutorials.check(target, region, tutorials.arguments.seconds)
                    row["check_seconds"] = round(time.monotonic() - start, 1)
                except TooLong as fault:
                    verdict = str(fault)
                self.known[row["hash"]] = name
                self.add(**row, verdict=verdict)
                tidy(target)
        return len(regions)

    def divide(self, tutorials: Tutorials, case: Path, region: str, row: dict[str, Any]) -> None:
        """Divides a mesh, and checks the pieces."""
        pieces, seconds = tutorials.arguments.decompose, tutorials.arguments.seconds
        if not 1 < pieces <= row["cells"]:
            return
        if tutorials.decompose(case, region, pieces, seconds):
            row["pieces"], row["verdict_of_pieces"] = pieces, tutorials.check(case, region, seconds, pieces)
        else:
            row["verdict_of_pieces"] = "decomposePar failed"


def copy_case(case: Path, target: Path) -> None:
    """Copies what checkMesh needs of a case, and how its mesh was made."""
    (target / "constant").mkdir(parents=True)
    shutil.copytree(case / "system", target / "system", ignore=shutil.ignore_patterns("*.gz"))
    for mesh in [*(case / "constant").glob("polyMesh"), *(case / "constant").glob("*/polyMesh")]:
        skipped = shutil.ignore_patterns("*.gz", "refinementHistory", "surfaceIndex", "*Level", "*Map*", "*Addressing")
        shutil.copytree(mesh, target / mesh.relative_to(case), ignore=skipped)
    for file in (case / "constant").glob("regionProperties"):
        shutil.copy(file, target / "constant")
    for log in case.glob("log.*"):
        if log.stat().st_size < 1 << 20:
            shutil.copy(log, target)


def tidy(case: Path) -> None:
    """Deletes what the results do not need."""
    for file in case.rglob("wallDistance"):
        file.unlink()
    for folder in "postProcessing", "dynamicCode":
        shutil.rmtree(case / folder, ignore_errors=True)


def ordered_faces(cells: Sequence[Sequence[Face]]) -> tuple[list[Face], list[int], list[int]]:
    """Faces, owners, and neighbors of cells that are given by their faces, in the order that OpenFOAM requires.

    The faces of each cell are directed outward. A face of two cells is given by both, in opposite directions.
    """
    first: dict[frozenset[int], tuple[int, Face]] = {}
    inner: list[tuple[int, int, Face]] = []
    for number, cell in enumerate(cells):
        for face in cell:
            key = frozenset(face)
            if key in first:
                owner, outward = first.pop(key)
                inner.append((owner, number, outward))
            else:
                first[key] = number, face
    inner.sort(key=lambda entry: entry[:2])
    outer = sorted(((owner, face) for owner, face in first.values()), key=lambda entry: entry[0])
    faces = [face for _, _, face in inner] + [face for _, face in outer]
    owners = [owner for owner, _, _ in inner] + [owner for owner, _ in outer]
    return faces, owners, [neighbor for _, neighbor, _ in inner]


Patch = tuple[str, str, Callable[[Sequence[Point]], bool]]


def everywhere(_: Sequence[Point]) -> bool:
    """Takes all faces."""
    return True


def on_plane(axis: int, place: float) -> Callable[[Sequence[Point]], bool]:
    """Takes the faces with all points on a plane."""
    return lambda face: all(abs(point[axis] - place) < 1e-9 for point in face)


def write_list(file: Path, kind: str, lines: Iterable[str]) -> None:
    """Writes a list of OpenFOAM."""
    lines = list(lines)
    head = HEAD.format(kind=kind, location="constant/polyMesh", name=file.name)
    file.write_text("\n".join([head, str(len(lines)), "(", *lines, ")", ""]))


def write_mesh(
    case: Path, points: Sequence[Point], mesh: tuple[list[Face], list[int], list[int]],
    boundary: Sequence[Patch] = (("walls", "wall", everywhere),),
) -> None:  # fmt: skip
    """Writes a case with a mesh. Its outer faces go to the first patch that takes them, faces of a cyclicACMI patch
    once more to a wall after it.
    """
    faces, owners, neighbors = mesh
    outer: list[list[int]] = [[] for _ in boundary]
    for number in range(len(neighbors), len(faces)):
        corners = [points[corner] for corner in faces[number]]
        outer[next(i for i, patch in enumerate(boundary) if patch[2](corners))].append(number)
    written: list[tuple[str, str, list[int]]] = []
    for (name, kind, _), numbers in zip(boundary, outer, strict=True):
        written.append((name, kind, numbers))
        if kind == "cyclicACMI":
            written.append((f"rest_of_{name}", "wall", numbers))
    order = [*range(len(neighbors)), *itertools.chain(*(numbers for _, _, numbers in written))]
    folder = case / "constant/polyMesh"
    folder.mkdir(parents=True)
    (case / "system").mkdir()
    head = HEAD.format(kind="dictionary", location="system", name="controlDict")
    (case / "system/controlDict").write_text(head + CONTROL)
    set_format(case)
    write_list(folder / "points", "vectorField", (f"({x!r} {y!r} {z!r})" for x, y, z in points))
    write_list(folder / "faces", "faceList", (f"{len(faces[i])}({' '.join(map(str, faces[i]))})" for i in order))
    write_list(folder / "owner", "labelList", (str(owners[i]) for i in order))
    write_list(folder / "neighbour", "labelList", map(str, neighbors))
    entries, start = [], len(neighbors)
    for name, kind, numbers in written:
        extra = ""
        if kind.startswith("cyclic"):
            other = name[:-1] + {"0": "1", "1": "0"}[name[-1]]
            extra = f"neighbourPatch {other};"
        if kind == "cyclicACMI":
            extra += f" transform noOrdering; nonOverlapPatch rest_of_{name};"
        entries.append(f"{name} {{ type {kind}; nFaces {len(numbers)}; startFace {start}; {extra} }}")
        start += len(numbers)
    write_list(folder / "boundary", "polyBoundaryMesh", entries)


HEX_FACES = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]


def pick(corners: Sequence[int], faces: Iterable[Sequence[int]]) -> list[Face]:
    """Faces of a cell from its corners. Corners that fall together are left out, and faces with two corners."""
    result = []
    for face in faces:
        numbers = [corners[i] for i in face]
        merged = tuple(number for i, number in enumerate(numbers) if number != numbers[i - 1])
        if len(merged) > 2:
            result.append(merged)
    return result


def grid(counts: tuple[int, int, int], lengths: Point = (1.0, 1.0, 1.0)) -> tuple[list[Point], list[list[int]]]:
    """Points and corners of the cells of a box."""
    sizes = [count + 1 for count in counts]
    points = [
        (lengths[0] * i / counts[0], lengths[1] * j / counts[1], lengths[2] * k / counts[2])
        for k in range(sizes[2]) for j in range(sizes[1]) for i in range(sizes[0])
    ]  # fmt: skip

    def at(i: int, j: int, k: int) -> int:
        return i + sizes[0] * (j + sizes[1] * k)

    steps = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [
        [at(i + a, j + b, k + c) for a, b, c in steps]
        for k in range(counts[2]) for j in range(counts[1]) for i in range(counts[0])
    ]  # fmt: skip
    return points, cells


def hexes(cells: Iterable[Sequence[int]]) -> list[list[Face]]:
    """Faces of hexahedra."""
    return [pick(cell, HEX_FACES) for cell in cells]


def tetrahedra(points: Sequence[Point], cells: Iterable[Sequence[int]]) -> list[list[Face]]:
    """Faces of the six tetrahedra of every cell of a box, around its diagonal."""
    result = []
    for cell in cells:
        for path in [(1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1)]:
            a, b, c, d = cell[0], cell[path[0]], cell[path[1]], cell[6]
            p, q, r, s = (points[i] for i in (a, b, c, d))
            u, v, w = ([x - y for x, y in zip(end, p, strict=True)] for end in (q, r, s))
            volume = (
                u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2])
                + u[2] * (v[0] * w[1] - v[1] * w[0])
            )  # fmt: skip
            if volume < 0:
                b, c = c, b
            result.append([(a, c, b), (a, b, d), (b, c, d), (a, d, c)])
    return result


def moved(points: Sequence[Point], reach: float, seed: int, where: Callable[[Point], bool]) -> list[Point]:
    """Points moved by up to a reach in each direction, where a rule allows it."""
    chance = random.Random(seed)
    result = []
    for x, y, z in points:
        dx, dy, dz = (chance.uniform(-reach, reach) for _ in range(3))
        result.append((x + dx, y + dy, z + dz) if where((x, y, z)) else (x, y, z))
    return result


def inside(point: Point) -> bool:
    """True off the sides of the unit cube."""
    return all(1e-9 < x < 1 - 1e-9 for x in point)


def layer(outline: Sequence[tuple[float, float]], polygons: Sequence[Sequence[int]], heights: Sequence[float],
          twist: float = 0.0) -> tuple[list[Point], list[list[Face]]]:  # fmt: skip
    """Prisms over polygons (counterclockwise) of a plane, turned about its origin with the height."""
    points: list[Point] = []
    for height in heights:
        c, s = math.cos(twist * height), math.sin(twist * height)
        points += [(c * x - s * y, s * x + c * y, height) for x, y in outline]
    cells: list[list[Face]] = []
    for level in range(len(heights) - 1):
        low, high = level * len(outline), (level + 1) * len(outline)
        for polygon in polygons:
            cell: list[Face] = [tuple(low + i for i in reversed(polygon)), tuple(high + i for i in polygon)]
            for a, b in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
                cell.append((low + a, low + b, high + b, high + a))
            cells.append(cell)
    return points, cells


def synthetic(folder: Path) -> Iterator[tuple[str, str]]:
    """Writes meshes with faults of many kinds; names of their cases, and a program that still changes each."""

    def case(name: str) -> Path:
        shutil.rmtree(folder / name, ignore_errors=True)
        return folder / name

    points, cells = grid((6, 6, 6))
    # Moved points: cells become non-orthogonal, skew, and turn inside out.
    for percent in 10, 25, 40, 60, 100, 300:
        write_mesh(case(f"hexes_moved_{percent}"), moved(points, percent / 600, 1, inside), ordered_faces(hexes(cells)))
        yield f"hexes_moved_{percent}", ""
    for percent in 0, 20, 35, 70:
        mesh = ordered_faces(tetrahedra(points, cells))
        write_mesh(case(f"tetrahedra_moved_{percent}"), moved(points, percent / 600, 2, inside), mesh)
        yield f"tetrahedra_moved_{percent}", ""
        write_mesh(case(f"dual_moved_{percent}"), moved(points, percent / 600, 2, inside), mesh)
        yield f"dual_moved_{percent}", "polyDualMesh 60 -overwrite"
    write_mesh(case("dual_of_hexes"), moved(points, 0.05, 3, inside), ordered_faces(hexes(cells)))
    yield "dual_of_hexes", "polyDualMesh 60 -overwrite"
    write_mesh(case("sides_moved"), moved(points, 0.06, 4, everywhere_inside), ordered_faces(hexes(cells)))
    yield "sides_moved", ""

    # Planes: one cell thick, with empty sides; the faults concern the direction that is left out.
    flat, squares = grid((8, 6, 1))
    empty: list[Patch] = [("sides", "empty", lambda face: len({point[2] for point in face}) == 1),
                          ("walls", "wall", everywhere)]  # fmt: skip
    shifted = [(x + 0.03 * math.sin(9 * y), y + 0.03 * math.cos(7 * x), z) for x, y, z in flat]
    write_mesh(case("plane"), shifted, ordered_faces(hexes(squares)), empty)
    yield "plane", ""
    for axis, name in enumerate("xy"):
        turned = [(z, x, y) if axis == 0 else (y, z, x) for x, y, z in shifted]
        sides: list[Patch] = [("sides", "empty", lambda face, a=axis: len({point[a] for point in face}) == 1),
                              ("walls", "wall", everywhere)]  # fmt: skip
        write_mesh(case(f"plane_normal_{name}"), turned, ordered_faces(hexes(squares)), sides)
        yield f"plane_normal_{name}", ""
    sheared = [(x + 0.1 * z, y, z) for x, y, z in shifted]
    write_mesh(case("plane_sheared"), sheared, ordered_faces(hexes(squares)), empty)
    yield "plane_sheared", ""
    write_mesh(case("plane_one_side_empty"), shifted, ordered_faces(hexes(squares)),
               [("sides", "empty", lambda face: all(point[2] > 0.5 for point in face)), ("walls", "wall", everywhere)])
    yield "plane_one_side_empty", ""
    thick, cubes = grid((3, 3, 2))
    write_mesh(case("empty_two_layers"), thick, ordered_faces(hexes(cubes)),
               [("sides", "empty", lambda face: len({point[2] for point in face}) == 1 and face[0][2] in (0.0, 1.0)),
                ("walls", "wall", everywhere)])  # fmt: skip
    yield "empty_two_layers", ""
    write_mesh(case("empty_odd"), thick, ordered_faces(hexes(cubes)),
               [("sides", "empty", lambda face: all(point[0] < 0.5 for point in face)), ("walls", "wall", everywhere)])
    yield "empty_odd", ""
    line, segments = grid((7, 1, 1))
    write_mesh(case("line"), line, ordered_faces(hexes(segments)),
               [("ends", "patch", lambda face: len({point[0] for point in face}) == 1), ("sides", "empty", everywhere)])
    yield "line", ""

    # Wedges about the x axis, with prisms at the axis.
    for name, half, lift in [("wedge", 2.5, 0.0), ("wedge_bent", 2.5, 0.002), ("wedge_alone", 2.5, 0.0)]:
        radial: list[Point] = []
        for x, y, z in grid((8, 5, 1))[0]:
            angle = math.radians(half) * (2 * z - 1)
            bend = lift * x * (1 - x) * y * (1 if z > 0.5 else 0)
            radial.append((x, y * math.cos(angle), y * math.sin(angle) + bend))
        at_axis = {i: next(j for j, q in enumerate(radial) if q == p) for i, p in enumerate(radial)}
        used = sorted(set(at_axis.values()))
        number = {point: i for i, point in enumerate(used)}
        wedge_cells = hexes([[number[at_axis[i]] for i in cell] for cell in grid((8, 5, 1))[1]])
        front: Patch = ("front", "wedge", lambda face: side_of(face) > 0)
        back: Patch = ("back", "patch" if name == "wedge_alone" else "wedge", lambda face: side_of(face) < 0)
        write_mesh(case(name), [radial[i] for i in used], ordered_faces(wedge_cells),
                   [front, back, ("walls", "wall", everywhere)])
        yield name, ""

    # Periodic sides, straight and moved.
    periodic: list[Patch] = [("ends0", "cyclic", on_plane(0, 0.0)), ("ends1", "cyclic", on_plane(0, 1.0)),
                             ("walls", "wall", everywhere)]  # fmt: skip
    write_mesh(case("periodic"), moved(points, 0.05, 5, inside), ordered_faces(hexes(cells)), periodic)
    yield "periodic", ""
    strong = moved(points, 0.14, 5, inside)
    write_mesh(case("periodic_moved"), strong, ordered_faces(hexes(cells)), periodic)
    yield "periodic_moved", ""
    # So far that centers of cells are beyond their faces on the periodic sides.
    write_mesh(case("periodic_moved_far"), moved(points, 0.5, 8, inside), ordered_faces(hexes(cells)), periodic)
    yield "periodic_moved_far", ""

    # Two blocks that slide along each other, the second one finer, and 0.3 farther in y.
    lengths: Point = (0.5, 1.0, 1.0)
    left, right = grid((3, 3, 3), lengths), grid((4, 4, 4), lengths)
    sliding = moved(left[0], 0.03, 6, lambda point: inside((2 * point[0], *point[1:])))
    for x, y, z in moved(right[0], 0.02, 7, lambda point: inside((2 * point[0], *point[1:]))):
        sliding.append((x + 0.5, y + 0.3, z))
    shifted_cells = [[len(left[0]) + i for i in cell] for cell in right[1]]

    def of_left(face: Sequence[Point]) -> bool:
        """Takes the faces of the first block at the second one."""
        return on_plane(0, 0.5)(face) and all(abs(3 * point[1] - round(3 * point[1])) < 1e-9 for point in face)

    write_mesh(case("sliding"), sliding, ordered_faces(hexes([*left[1], *shifted_cells])),
               [("slide0", "cyclicACMI", of_left), ("slide1", "cyclicACMI", on_plane(0, 0.5)),
                ("walls", "wall", everywhere)])  # fmt: skip
    yield "sliding", ""

    # Sizes: thin, jumping, tiny.
    thin = [(x, y, z * 1e-4) for x, y, z in points]
    write_mesh(case("thin"), thin, ordered_faces(hexes(cells)))
    yield "thin", ""
    jumps = [(x if x < 0.5 else 0.5 + (x - 0.5) * 1e-3, y, z) for x, y, z in points]
    write_mesh(case("jumps"), jumps, ordered_faces(hexes(cells)))
    yield "jumps", ""
    tiny = [(x * 1e-6, y * 1e-6, z * 1e-6) for x, y, z in moved(points, 0.1, 1, inside)]
    write_mesh(case("tiny"), tiny, ordered_faces(hexes(cells)))
    yield "tiny", ""
    close = [(x if i != 172 else points[171][0] + 1e-8, y, z) for i, (x, y, z) in enumerate(points)]
    write_mesh(case("close_points"), close, ordered_faces(hexes(cells)))
    yield "close_points", ""
    same = [point if i != 172 else points[171] for i, point in enumerate(points)]
    write_mesh(case("same_points"), same, ordered_faces(hexes(cells)))
    yield "same_points", ""

    # All kinds of cells, each apart.
    unit: list[Point] = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    collapsed = {
        "hex": {}, "prism": {2: 1, 6: 5}, "wedge": {4: 0}, "pyramid": {5: 4, 6: 4, 7: 4},
        "tetrahedron": {3: 0, 5: 4, 6: 4, 7: 4},
    }  # fmt: skip
    every: list[list[Face]] = []
    places: list[Point] = []
    for step, merged in enumerate(collapsed.values()):
        numbers = [merged.get(i, i) for i in range(8)]
        taken = sorted(set(numbers))
        every.append(pick([len(places) + taken.index(i) for i in numbers], HEX_FACES))
        places += [(unit[i][0] + 2.0 * step, unit[i][1], unit[i][2]) for i in taken]
    # Two triangles and two quads with five corners, which OpenFOAM calls a tet wedge.
    at_end = len(places)
    every.append([tuple(at_end + i for i in face) for face in [(0, 2, 1), (0, 1, 3), (0, 3, 4, 2), (1, 2, 4, 3)]])
    places += [(0.0, 2.0, 0.0), (1.0, 2.0, 0.0), (0.5, 3.0, 0.0), (0.5, 2.0, 1.0), (0.5, 2.6, 0.6)]
    write_mesh(case("kinds_of_cells"), places, ordered_faces(every))
    yield "kinds_of_cells", ""
    one: tuple[list[Point], list[list[int]]] = grid((1, 1, 1))
    write_mesh(case("one_cell"), one[0], ordered_faces(hexes(one[1])))
    yield "one_cell", ""

    # Polygons: concave, twisted, with many corners, and with edges in line.
    shape = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0), (2.0, 2.0)]
    for name, twist in [("concave", 0.0), ("concave_twisted", 1.2), ("concave_twisted_far", 2.6)]:
        at, prisms = layer(shape, [(0, 1, 2, 3, 4, 5), (2, 6, 4, 3)], [0.0, 0.5, 1.0], twist)
        write_mesh(case(name), at, ordered_faces(prisms))
        yield name, ""
    star = [(math.cos(i * math.pi / 5) * (1 if i % 2 else 0.35), math.sin(i * math.pi / 5) * (1 if i % 2 else 0.35))
            for i in range(10)]  # fmt: skip
    at, prisms = layer(star, [tuple(range(10))], [0.0, 0.3, 0.7], 0.4)
    write_mesh(case("star"), at, ordered_faces(prisms))
    yield "star", ""
    round_shape = [(math.cos(i * math.pi / 6), math.sin(i * math.pi / 6)) for i in range(12)]
    for name, twist in [("column", 0.0), ("column_twisted", 2.0)]:
        at, prisms = layer(round_shape, [tuple(range(7)), (0, *range(6, 12))], [0.0, 0.4, 1.0], twist)
        write_mesh(case(name), at, ordered_faces(prisms))
        yield name, ""
    in_line = [(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.05), (0.0, 1.0)]
    at, prisms = layer(in_line, [tuple(range(6))], [0.0, 1.0, 1.5])
    write_mesh(case("edges_in_line"), at, ordered_faces(prisms))
    yield "edges_in_line", ""
    bow = [(x, y, z + (0.9 if (i % 7 + i // 7) % 2 else 0.0) / 6) for i, (x, y, z) in enumerate(points)]
    write_mesh(case("warped"), bow, ordered_faces(hexes(cells)))
    yield "warped", ""

    # Topology: order, unused points, regions, several faces between two cells, open cells, faces given twice.
    faces, owners, neighbors = ordered_faces(hexes(cells))
    inner = len(neighbors)
    order = [*reversed(range(inner)), *range(inner, len(faces))]
    write_mesh(case("order"), points, ([faces[i] for i in order], [owners[i] for i in order], neighbors[::-1]))
    yield "order", ""
    write_mesh(case("unused_points"), [*points, (2.0, 0.0, 0.0), (0.5, 0.5, 0.5)], (faces, owners, neighbors))
    yield "unused_points", ""
    parts = [cell for cell in cells if not 0.3 < points[cell[0]][0] < 0.6]
    taken = sorted({i for cell in parts for i in cell})
    number = {point: i for i, point in enumerate(taken)}
    write_mesh(case("two_regions"), [points[i] for i in taken],
               ordered_faces(hexes([[number[i] for i in cell] for cell in parts])))
    yield "two_regions", ""
    diagonal = [cell for cell in grid((2, 2, 1))[1]]
    write_mesh(case("regions_at_edge"), grid((2, 2, 1))[0], ordered_faces(hexes([diagonal[0], diagonal[3]])))
    yield "regions_at_edge", ""
    two, pair = grid((2, 1, 1))
    both = hexes(pair)
    halves = [face for face in both[0] if frozenset(face) == frozenset(pair[0][i] for i in (1, 2, 6, 5))][0]
    a, b, c, d = halves
    split = [[face for face in both[0] if face != halves] + [(a, b, c), (a, c, d)],
             [face for face in both[1] if frozenset(face) != frozenset(halves)] + [(c, b, a), (d, c, a)]]  # fmt: skip
    write_mesh(case("two_faces_between"), two, ordered_faces(split))
    yield "two_faces_between", ""
    write_mesh(case("open_cell"), two, ordered_faces([both[0], both[1][:-1]]))
    yield "open_cell", ""
    twice = ordered_faces(both)
    write_mesh(case("face_twice"), two, ([*twice[0], twice[0][-1]], [*twice[1], twice[1][-1]], twice[2]))
    yield "face_twice", ""
    write_mesh(case("corner_twice"), two,
               ([*twice[0][:-1], (*twice[0][-1][:2], *twice[0][-1][1:])], twice[1], twice[2]))
    yield "corner_twice", ""
    turned_faces = [face if i != 5 else face[::-1] for i, face in enumerate(faces)]
    write_mesh(case("face_turned"), points, (turned_faces, owners, neighbors))
    yield "face_turned", ""


def everywhere_inside(point: Point) -> bool:
    """Takes all points off the edges of the unit cube."""
    return sum(1e-9 < x < 1 - 1e-9 for x in point) >= 2


def side_of(face: Sequence[Point]) -> float:
    """1 and -1 for the two flat sides of a wedge about the x axis, 0 for all others."""
    signs = {math.copysign(1.0, z) for _, y, z in face if y > 1e-12}
    return signs.pop() if len(signs) == 1 else 0.0


def main() -> int:
    """The program."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("stopped"))
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("tutorials", nargs="*", help="as in category/solver/case; all with a blockMeshDict without")
    parser.add_argument("--work", type=Path, required=True, help="folder for the copy of the tutorials")
    parser.add_argument("--cases", type=Path, required=True, help="folder for the results")
    parser.add_argument("--synthetic", action="store_true", help="make meshes with faults as well")
    parser.add_argument("--decompose", type=int, default=1, metavar="N", help="also check each mesh in N pieces")
    parser.add_argument("--seconds", type=float, default=120, help="limit for a script, and for a check")
    parser.add_argument("--cells", type=int, default=400_000, help="largest mesh to check")
    parser.add_argument("--memory", type=int, default=6, help="limit for a program, in GiB")
    parser.add_argument("--file", type=int, default=400, help="limit for a file that a program writes, in MiB")
    arguments = parser.parse_args()
    if not {"FOAM_TUTORIALS", "WM_PROJECT_DIR"} <= os.environ.keys():
        parser.error("set FOAM_TUTORIALS and WM_PROJECT_DIR")
    arguments.work, arguments.cases = arguments.work.resolve(), arguments.cases.resolve()
    arguments.work.mkdir(parents=True, exist_ok=True)
    source, project = Path(os.environ["FOAM_TUTORIALS"]), Path(os.environ["WM_PROJECT_DIR"])
    tutorials = Tutorials(source, project, arguments.work, arguments)
    results = Results(arguments.cases)
    if arguments.synthetic:
        folder = arguments.work / "synthetic"
        for name, command in synthetic(folder):
            if f"synthetic/{name}" in results.done:
                continue
            commands = ["written"]
            if command:
                log = folder / name / f"log.{command.split()[0]}"
                status = run(command.split(), folder / name, tutorials.checker, arguments.seconds, log)
                commands.append(command if status == 0 else f"{command} [exit {status}]")
            results.keep(tutorials, f"synthetic/{name}", folder / name, commands, 0.0)
    for name in arguments.tutorials or (DECOMPOSED if arguments.decompose > 1 else tutorials.cases()):
        name = name.rstrip("/")
        if name in results.done:
            continue
        start = time.monotonic()
        cells = estimated_cells(tutorials.folder / name / "system/blockMeshDict")
        if cells > arguments.cells:
            results.add(tutorial=name, cells=cells, verdict="too many cells for blockMesh alone")
            continue
        commands, fault = [], ""
        try:
            commands = tutorials.make(name)
        except TooLong as late:
            fault = str(late)
        seconds = time.monotonic() - start
        folder, _ = tutorials.script(name)
        found = 0
        for control in [] if fault else sorted(folder.rglob("system/controlDict")):
            case = control.parents[1]
            tutorial = str(case.relative_to(tutorials.folder))
            if tutorial not in results.done and "processor" not in tutorial:
                found += results.keep(tutorials, tutorial, case, commands, seconds)
        if name not in results.done:
            results.add(tutorial=name, commands=commands, seconds=round(seconds, 1), verdict=fault or reason(folder))
    checked = [row for row in results.rows if row.get("hash") and not row.get("same_as")]
    print(f"{len(checked)} meshes of {len(results.done)} tutorials", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
