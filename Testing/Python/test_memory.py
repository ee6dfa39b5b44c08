# SPDX-License-Identifier: BSD-3-Clause
"""Where the memory of the process is limited (ulimit -v), a command succeeds or ends with one line that states the
reason.

The smallest limits are those under which Python just imports the package: below, the interpreter itself fails. No
command may end by a signal, with a traceback or with a half-written file, whichever of its allocations fails: its own,
VTK's, by PETSc and MPI, or for a thread's stack.
"""

import os
import resource
import subprocess
import sys
from pathlib import Path

import tautline as tl
from checks import DATA, OUT, run_tests, wording

MEBIBYTE = 2**20
FOLDER = OUT / "memory"
#: MiB beyond what the imports take.
MARGINS = (2, 8, 80, 300, 1100)
TIME_LIMIT = 100  # seconds of one command
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
CELLS = 60000  # of the larger mesh


def limited(limit: float, command: list[str]) -> subprocess.CompletedProcess:
    """Run Python with a limit in MiB on the address space."""

    def set_limit() -> None:
        size = int(limit * MEBIBYTE)
        resource.setrlimit(resource.RLIMIT_AS, (size, size))

    return subprocess.run([sys.executable, *command], capture_output=True, text=True, preexec_fn=set_limit,
                          env=ENVIRONMENT, timeout=TIME_LIMIT)  # fmt: skip


def smallest_limit() -> int:
    """MiB of address space under which the package is imported and shows its help."""
    low, high = 32, 4096
    while high - low > 1:
        middle = (low + high) // 2
        done = limited(middle, ["-m", "tautline", "quality", "--help"])
        low, high = (low, middle) if done.returncode == 0 and "usage" in done.stdout else (middle, high)
    return high


def commands(large: str, small: str, layer: str) -> dict[str, list[str]]:
    """The arguments by name."""
    out, field = str(FOLDER / "result.vtu"), str(FOLDER / "result.vti")
    return {
        "quality": ["quality", large, "--metrics", "imr,radius_ratio,scaled_jacobian,size", "-o", out],
        "optimize": ["optimize", large, "-o", out],
        "untangle": ["untangle", str(DATA / "bracket-tangled.vtu"), "-o", out],
        "improve": ["improve", str(DATA / "bracket.vtu"), "--preset", "aggressive", "-o", out],
        "perturb": ["perturb", large, "-o", out],
        "solve": ["solve", large, "-o", out],
        "condition": ["condition", small, "-o", out],
        "domain": ["domain", "square", "--element-size", "0.002", "-o", out],
        "disk": ["domain", "disk3d", "--cells", "40000", "-o", out],
        "huge domain": ["domain", "disk2d", "--cells", "100000000", "-o", out],
        "peridynamics": ["peridynamics", layer, "-o", out],
        "match": ["match", str(DATA / "fish.png"), str(DATA / "fish-bent.png"), "-o", out],
        "convert": ["convert", large, str(FOLDER / "result.vtk")],
        "field": ["field", "--cell", "tetrahedron", "--dimensions", "150", "150", "150", "-o", field],
    }


# A message of the C library, which ends the process if a thread that starts gets no memory for its variables.
OF_THREADS = "cannot allocate memory for thread-local data: ABORT"


def complaint(done: subprocess.CompletedProcess) -> str:
    """The error in the end of a command; "" if there is none."""
    errors = [line for line in done.stderr.strip().splitlines() if line != OF_THREADS]
    if done.returncode < 0:
        return f"ended by signal {-done.returncode}"
    if "Traceback" in done.stderr or wording("terminate-called") in done.stderr:
        return "a traceback"
    if done.returncode == 0:
        return ""
    if OF_THREADS in done.stderr and not errors:  # nothing can catch it
        return ""
    ours = [line for line in errors if line.startswith("tautline: ") or line.startswith("python3 -m tautline")]
    if len(ours) != 1 or len(ours[0]) < len("tautline: ") + 10:
        return f"{len(ours)} messages"
    return "" if len(errors) == 1 else f"{len(errors)} lines"


def test_matrix() -> None:
    """Every command under every limit."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    large, small, layer = (str(FOLDER / f"{name}.vtu") for name in ("large", "small", "layer"))
    tl.write(tl.domain("disk3d", cells=CELLS), large)
    tl.write(tl.domain("disk2d", cells=3000), small)
    tl.write(tl.domain("square", element_size=0.05), layer)
    start = smallest_limit()
    print(f"imports need {start} MiB")
    outcomes, complaints = {}, []
    for name, arguments in commands(large, small, layer).items():
        outcomes[name] = ""
        for margin in MARGINS:
            result = Path(arguments[-1])
            result.unlink(missing_ok=True)
            done = limited(start + margin, ["-m", "tautline", *arguments])
            if wrong := complaint(done):
                complaints.append(f"{name}, {margin} MiB: {wrong}: {done.stderr[-1000:]}")
            elif done.returncode == 0:
                assert tl.read(result).GetNumberOfPoints() > 0
            outcomes[name] += "-" if done.returncode else "+"
        print(f"{name:14}{outcomes[name]}", flush=True)
    assert not complaints, "\n".join(complaints)
    # The matrix has both ends: limits that are too small, and some that suffice.
    for name in ("quality", "optimize", "solve"):
        assert outcomes[name].startswith("-") and outcomes[name].endswith("+"), outcomes
    assert "+" not in outcomes["huge domain"], outcomes


if __name__ == "__main__":
    run_tests(globals())
