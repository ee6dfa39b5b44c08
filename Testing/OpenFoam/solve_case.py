#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""solve_case.py [options] [CASE...]: a solver that diverges on a perturbed mesh, and converges on it after the repair.

Each case (all by default) is solved three times with the same settings: on the mesh as it was made; with the internal
points moved at random; and after

    tautline optimize case.foam --preset "finite volumes" --in-place

A table has the verdict of checkMesh, the largest
non-orthogonality and skewness, how the solver ended after how many iterations (time steps where it is transient), its
largest initial residual there, and the mean of a field on a patch. The exit code is 1 unless checkMesh fails and the
solver diverges on the perturbed mesh, and the repaired mesh passes, takes about as many iterations as the original, and
has about its mean. --picture draws the residuals and the meshes, --json writes both tables.

pitzDaily and flange are tutorials, in the folder of FOAM_TUTORIALS; elbow is the sample in Data, with the schemes and
solvers of pitzDaily. The settings of OpenFOAM are in the folder of WM_PROJECT_DIR, its programs in PATH.
"""

import argparse
import gzip
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from compare_cases import verdict
from make_cases import HEAD, foam_list, patches

DATA = Path(__file__).resolve().parents[2] / "Data"
ENVIRONMENT = {
    "FOAM_TUTORIALS": "/usr/share/doc/openfoam-examples/examples",
    "WM_PROJECT_DIR": "/usr/share/openfoam",
    **os.environ,
    "FOAM_SIGFPE": "true",  # ends a solver that diverges
}
REPAIR = ["optimize", "case.foam", "--preset", "finite volumes", "--in-place"]
MESHES = ("original", "perturbed", "repaired")
#: The repaired mesh takes at most this multiple of the original's iterations.
MORE_ITERATIONS = 1.3
#: Largest relative difference between the means of both.
LARGEST_DIFFERENCE = 0.03
SECONDS = 300
#: The solver whose log has a line when it has converged; the other one runs to the end of the time.
STEADY = "simpleFoam"
#: How a solver ends on a good mesh.
DONE = ("converged", "finished")
#: Sets that checkMesh writes of the faces that fail.
FAILING = ("nonOrthoFaces", "wrongOrientedFaces", "skewFaces")
BAD = "#c8102e"  # color of what fails
LAMINAR = "simulationType laminar;\n"
VISCOSITY = "transportModel Newtonian;\nnu 0.02;\n"
VELOCITY = """
dimensions [0 1 -1 0 0 0 0];
internalField uniform (0 0 0);
boundaryField
{
    inlet { type surfaceNormalFixedValue; refValue uniform -1; }
    outlet { type zeroGradient; }
    walls { type noSlip; }
}
"""
PRESSURE = """
dimensions [0 2 -2 0 0 0 0];
internalField uniform 0;
boundaryField
{
    inlet { type zeroGradient; }
    outlet { type fixedValue; value uniform 0; }
    walls { type zeroGradient; }
}
"""
#: Files of the elbow: class, folder, and entries.
ELBOW = {
    "0/U": ("volVectorField", VELOCITY),
    "0/p": ("volScalarField", PRESSURE),
    "constant/transportProperties": ("dictionary", VISCOSITY),
    "constant/turbulenceProperties": ("dictionary", LAMINAR),
}


@dataclass
class Case:
    """How a case is made, perturbed, and solved."""

    #: The tutorial whose settings are taken.
    settings: str
    solver: str
    #: The largest displacement of a point along each axis, in meters.
    length: float
    #: Field and patch whose mean is compared.
    mean: tuple[str, str]
    #: The command that makes the mesh of the tutorial; empty for the sample in Data.
    mesher: list[str] = field(default_factory=list)
    #: For one layer of cells across z: where points move, in x and y, and the distance at which the displacement has
    #: fallen by a factor of e. Without it, all points move.
    spot: tuple[tuple[float, float], float] | None = None


CASES = {
    "pitzDaily": Case("incompressible/simpleFoam/pitzDaily", "simpleFoam", 5e-4, ("p", "inlet"), ["blockMesh"],
                      ((0.06, 0.0), 0.015)),  # fmt: skip
    "flange": Case("basic/laplacianFoam/flange", "laplacianFoam", 7e-4, ("T", "patch1"),
                   ["ansysToFoam", "flange.ans", "-scale", "0.001"]),  # fmt: skip
    "elbow": Case("incompressible/simpleFoam/pitzDaily", "simpleFoam", 0.2, ("p", "inlet")),
}


@dataclass
class Outcome:
    """The results of checkMesh and the solver on a mesh."""

    failed_checks: int
    non_orthogonality: float
    skewness: float
    ended: str
    iterations: int
    mean: float | None
    residuals: list[float]


def run(command: list[str], folder: Path) -> tuple[int, str]:
    """Exit status and output of a command; the output is also in log.NAME."""
    log = folder / f"log.{command[0]}"
    with log.open("w", encoding="utf-8") as output:
        done = subprocess.run(command, cwd=folder, env=ENVIRONMENT, stdout=output, stderr=subprocess.STDOUT,
                              timeout=SECONDS)  # fmt: skip
    return done.returncode, log.read_text(errors="replace")


def must_run(command: list[str], folder: Path) -> str:
    """The output of a command that ends well."""
    status, text = run(command, folder)
    if status:
        raise SystemExit(f"{' '.join(command)} in {folder} ended with {status}:\n{text[-2000:]}")
    return text


def make(name: str, folder: Path) -> None:
    """The case with its mesh, as the tutorial's script makes it."""
    case = CASES[name]
    tutorial = Path(ENVIRONMENT["FOAM_TUTORIALS"]) / case.settings
    if case.mesher:
        shutil.copytree(tutorial, folder)
        for packed in list(folder.rglob("*.gz")):
            packed.with_suffix("").write_bytes(gzip.decompress(packed.read_bytes()))
            packed.unlink()
        must_run(case.mesher, folder)
    else:
        shutil.copytree(DATA / name / "constant", folder / "constant")
        shutil.copytree(tutorial / "system", folder / "system")
        for file, (kind, text) in ELBOW.items():
            target = folder / file
            target.parent.mkdir(exist_ok=True)
            target.write_text(HEAD.format(kind=kind, location=target.parent.name, name=target.name) + text)
    (folder / "case.foam").touch()


def read_points(mesh: Path) -> np.ndarray:
    """The coordinates of a mesh in ASCII, n x 3."""
    lists = re.findall(rb"\(([^()]+)\)", foam_list(mesh / "points"))
    return np.array([values.split() for values in lists], float)


def read_faces(mesh: Path) -> list[np.ndarray]:
    """The points of each face."""
    return [np.array(ids.split(), int) for ids in re.findall(rb"\(([\d\s]+)\)", foam_list(mesh / "faces"))]


def boundary(mesh: Path, faces: list[np.ndarray], empty: bool) -> list[np.ndarray]:
    """The faces of the patches of the kind "empty", or of the others."""
    found, kinds = [], patches(mesh)
    start = len(faces) - sum(count for _, _, count in kinds)
    for _, kind, count in kinds:
        if (kind == "empty") == empty:
            found += faces[start : start + count]
        start += count
    return found


def perturb(folder: Path, case: Case) -> None:
    """Moves the internal points, with one layer in the same way on both sides. The same each time."""
    mesh = folder / "constant/polyMesh"
    points, faces = read_points(mesh), read_faces(mesh)
    inside = np.ones(len(points), bool)
    inside[np.concatenate(boundary(mesh, faces, empty=False))] = False
    axes, sides = 3, np.arange(len(points))
    weights = np.ones(len(points))
    if case.spot:
        axes = 2
        inside[np.setdiff1d(sides, np.concatenate(boundary(mesh, faces, empty=True)))] = False
        sides = np.unique(points[:, :axes], axis=0, return_inverse=True)[1]
        weights = np.exp(-(((points[:, :axes] - case.spot[0]) / case.spot[1]) ** 2).sum(axis=1))
    random = np.random.RandomState(1).uniform(-1, 1, (len(points), axes))[sides]
    points[inside, :axes] += (case.length * weights[:, None] * random)[inside]
    lines = "".join("({:.17g} {:.17g} {:.17g})\n".format(*point) for point in points)
    head = HEAD.format(kind="vectorField", location="constant/polyMesh", name="points")
    (mesh / "points").write_text(f"{head}\n{len(points)}\n(\n{lines})\n")


def repair(folder: Path) -> None:
    """Moves the points of a case by a command. If invalid elements are left, the exit status is not 0."""
    done = subprocess.run([sys.executable, "-m", "tautline", *REPAIR], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        print(f"the repair ended with {done.returncode}:\n{done.stdout}{done.stderr}")


def check(folder: Path) -> tuple[int, float, float]:
    """Failed checks of a mesh, largest non-orthogonality and skewness."""
    shutil.rmtree(folder / "constant/polyMesh/sets", ignore_errors=True)
    text = must_run(["checkMesh", "-constant"], folder)
    angle, skewness = (re.search(pattern, text) for pattern in (r"orthogonality Max: (\S+)", r"skewness = ([^\s,]+)"))
    failed = verdict(folder / "log.checkMesh")
    assert angle and skewness and failed is not None, folder
    return failed, float(angle[1]), float(skewness[1])


def solve(folder: Path, case: Case) -> tuple[str, int, list[float]]:
    """How the solver ended, after how many iterations, and the largest initial residual of each."""
    status, text = run([case.solver, "-noFunctionObjects"], folder)
    steps = re.split(r"^Time = ", text, flags=re.MULTILINE)[1:]
    found = [re.findall(r"Initial residual = ([^\s,]+)", step) for step in steps]
    residuals = [max(map(float, values)) for values in found if values]
    if status:
        ended = "diverged" if status == -signal.SIGFPE else "failed"
    elif case.solver != STEADY:
        ended = "finished"
    else:
        ended = "converged" if "SIMPLE solution converged" in text else "not converged"
    return ended, len(steps), residuals


def mean(folder: Path, case: Case) -> float:
    """The mean of a field on a patch at the last time."""
    name, patch = case.mean
    text = must_run(["postProcess", "-latestTime", "-func", f"patchAverage(name={patch},{name})"], folder)
    found = re.search(rf"\({patch}\) of {name} = (\S+)", text)
    assert found, folder
    return float(found[1])


def solve_case(name: str, work: Path) -> dict[str, Outcome]:
    """The outcome on each of the three meshes, in folders of their names."""
    case, outcomes = CASES[name], {}
    make(name, work / "original")
    for before, after in zip(MESHES, MESHES[1:]):
        shutil.copytree(work / before, work / after)
        if after == "perturbed":
            perturb(work / after, case)
        else:
            repair(work / after)
    for mesh in MESHES:
        failed, non_orthogonality, skewness = check(work / mesh)
        ended, iterations, residuals = solve(work / mesh, case)
        value = mean(work / mesh, case) if ended in DONE else None
        outcomes[mesh] = Outcome(failed, non_orthogonality, skewness, ended, iterations, value, residuals)
    return outcomes


def faults(outcomes: dict[str, Outcome]) -> list[str]:
    """The deviations from the expected results."""
    original, perturbed, repaired = (outcomes[mesh] for mesh in MESHES)
    found = []
    for mesh in "original", "repaired":
        if outcomes[mesh].failed_checks or outcomes[mesh].ended not in DONE:
            found.append(f"the {mesh} mesh fails, or the solver on it: {outcomes[mesh].ended}")
    if not perturbed.failed_checks or perturbed.ended != "diverged":
        found.append(f"the perturbed mesh passes, or the solver on it: {perturbed.ended}")
    if repaired.iterations > MORE_ITERATIONS * original.iterations:
        found.append(f"{repaired.iterations} iterations instead of {original.iterations}")
    if original.mean is not None and repaired.mean is not None:
        if abs(repaired.mean - original.mean) > LARGEST_DIFFERENCE * abs(original.mean):
            found.append(f"the mean is {repaired.mean} instead of {original.mean}")
    return found


def table(name: str, outcomes: dict[str, Outcome]) -> str:
    """The outcomes of a case, in Markdown."""
    of, patch = CASES[name].mean
    lines = [f"| {name} | checkMesh | non-orthogonality | skewness | {CASES[name].solver} | residual | "
             f"mean {of} on {patch} |", "|---" * 7 + "|"]  # fmt: skip
    for mesh, found in outcomes.items():
        said = f"Failed {found.failed_checks}" if found.failed_checks else "Mesh OK"
        last = f"{found.residuals[-1]:.1e}" if found.residuals else ""
        value = "" if found.mean is None else f"{found.mean:.6g}"
        lines.append(f"| {mesh} | {said} | {found.non_orthogonality:.1f} | {found.skewness:.2f} | "
                     f"{found.ended} at {found.iterations} | {last} | {value} |")  # fmt: skip
    return "\n".join(lines) + "\n"


def failing_faces(mesh: Path) -> np.ndarray:
    """The numbers of the faces in the sets that checkMesh has written."""
    numbers = [np.zeros(0, int)]
    for name in FAILING:
        if (mesh / "sets" / name).exists():
            numbers.append(np.array(re.findall(rb"\d+", foam_list(mesh / "sets" / name))[1:], int))
    return np.unique(np.concatenate(numbers))


def draw_layer(axes: Any, mesh: Path, case: Case) -> None:
    """The side of a layer around the spot, with the cells of the faces that fail."""
    from matplotlib.collections import PolyCollection

    assert case.spot
    points, faces = read_points(mesh), read_faces(mesh)
    cells = [np.array(re.findall(rb"\d+", foam_list(mesh / name))[1:], int) for name in ("owner", "neighbour")]
    failing = failing_faces(mesh)
    bad = np.unique(np.concatenate([numbers[failing[failing < len(numbers)]] for numbers in cells]))
    side = [number for number in range(len(cells[1]), len(faces)) if np.ptp(points[faces[number], 2]) == 0]
    side = [number for number in side if points[faces[number][0], 2] > 0]
    colors = np.where(np.isin(cells[0][side], bad), BAD, "#d9e2ee")
    corners = [points[faces[number], :2] for number in side]
    axes.add_collection(PolyCollection(corners, facecolors=colors, edgecolors="#44484f", linewidths=0.3))
    (x, y), radius = case.spot
    axes.set_xlim(x - 1.6 * radius, x + 1.6 * radius)
    axes.set_ylim(y - 1.3 * radius, y + 1.3 * radius)
    axes.set_aspect("equal")


def draw_solid(axes: Any, mesh: Path) -> None:
    """The faces that fail inside the boundary."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    points, faces = read_points(mesh), read_faces(mesh)
    outside = [points[face] for face in boundary(mesh, faces, empty=False)]
    axes.add_collection3d(Poly3DCollection(outside, facecolors=(0.6, 0.7, 0.8, 0.06), edgecolors=(0.3, 0.3, 0.35, 0.25),
                                           linewidths=0.3))  # fmt: skip
    bad = [points[faces[face]] for face in failing_faces(mesh)]
    axes.add_collection3d(Poly3DCollection(bad, facecolors=BAD, edgecolors="#500010", linewidths=0.3))
    low, high = points.min(axis=0), points.max(axis=0)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_zlim(low[2], high[2])
    axes.set_box_aspect(high - low, zoom=1.3)


def draw(file: Path, results: dict[str, dict[str, Outcome]], work: Path) -> None:
    """A row per case: the perturbed and the repaired mesh, and the residuals of all three."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=(12, 3.6 * len(results)), layout="constrained")
    for row, (name, outcomes) in enumerate(results.items()):
        case = CASES[name]
        for column, mesh in enumerate(MESHES[1:]):
            place = (len(results), 3, 3 * row + column + 1)
            folder = work / name / mesh / "constant/polyMesh"
            if case.spot:
                axes = figure.add_subplot(*place)
                draw_layer(axes, folder, case)
            else:
                axes = figure.add_subplot(*place, projection="3d")
                draw_solid(axes, folder)
            axes.set_axis_off()
            found = outcomes[mesh]
            said = f"{found.failed_checks} checks failed" if found.failed_checks else "Mesh OK"
            axes.set_title(f"{name}, {mesh}: {said}", fontsize=10)
        axes = figure.add_subplot(len(results), 3, 3 * row + 3)
        for mesh, color, style in zip(MESHES, ("#44484f", BAD, "#1f5fa8"), ("--", "-", "-")):
            values, ended = outcomes[mesh].residuals, outcomes[mesh].ended
            axes.semilogy(range(1, len(values) + 1), values, style, color=color, label=f"{mesh}: {ended}")
            if ended == "diverged":
                axes.plot(len(values), values[-1], "x", color=color, markersize=9, markeredgewidth=2)
        axes.set_xlabel("iteration" if case.solver == STEADY else "time step")
        axes.set_title(f"{case.solver}: largest initial residual", fontsize=10)
        axes.legend(fontsize=8)
    figure.savefig(file, dpi=100)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(CASES))
    parser.add_argument("--work", type=Path, help="a new folder that keeps the cases; otherwise a temporary one")
    parser.add_argument("--picture", type=Path, metavar="FILE.png", help="needs Matplotlib")
    parser.add_argument("--json", type=Path, metavar="FILE", help="the table and the residuals")
    arguments = parser.parse_args()
    if unknown := set(arguments.cases) - set(CASES):
        parser.error(f"there is no case {unknown.pop()}, but {', '.join(CASES)}")
    with tempfile.TemporaryDirectory() as temporary:
        work = (arguments.work or Path(temporary)).resolve()
        results, wrong = {}, []
        for name in arguments.cases or CASES:
            results[name] = outcomes = solve_case(name, work / name)
            print(table(name, outcomes), flush=True)
            wrong += [f"{name}: {fault}" for fault in faults(outcomes)]
        if arguments.json:
            tables = {name: {mesh: asdict(found) for mesh, found in of.items()} for name, of in results.items()}
            arguments.json.write_text(json.dumps(tables, indent=1) + "\n")
        if arguments.picture:
            draw(arguments.picture, results, work)
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
