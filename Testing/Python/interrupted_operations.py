"""Operations that take much longer than test_interrupts.py waits, and the child process that runs one of them.

python3 interrupted_operations.py MODE NAME, where MODE is "function" (reports its first progress and expects
KeyboardInterrupt), "shell" (the same as a command of the shell), "cancel" (the progress callback returns False) or
"limit" (with a time limit of a second).
"""

import sys
import time
from pathlib import Path

import numpy as np
import tautline as tl
from checks import OUT, square
from tautline import _interrupts
from tautline.__main__ import main

TIME_LIMIT = 1.0
MANY = 1000000
INPUT = OUT / "interrupts-input"


def cube(n: int):
    """The unit cube of 6 n^3 tetrahedra."""
    axis = np.arange(n + 1) / n
    z, y, x = (a.ravel() for a in np.meshgrid(axis, axis, axis, indexing="ij"))
    k, j, i = (a.ravel() for a in np.meshgrid(*[np.arange(n)] * 3, indexing="ij"))
    first = (k * (n + 1) + j) * (n + 1) + i
    steps = (1, n + 1, (n + 1) ** 2)
    cells = []
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (1, 0, 2), (0, 2, 1), (2, 1, 0)):
        corners = [first, first + steps[a], first + steps[a] + steps[b], first + sum(steps)]
        even = (a, b, c) in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        cells.append(np.stack(corners if even else [corners[0], corners[2], corners[1], corners[3]], axis=1))
    return tl.from_arrays(np.column_stack([x, y, z]), {"tetrahedron": np.concatenate(cells)})


def spiral(n: int) -> np.ndarray:
    """The image of a spiral arm, whose outline is long."""
    y, x = (np.mgrid[:n, :n] - n / 2) / n
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    arm = np.sin(angle - 120 * radius) > 0
    return np.where(arm & (radius < 0.45) & (radius > 0.02), 255.0, 0.0)


def disk(n: int, stretch: float) -> np.ndarray:
    """The image of an ellipse."""
    y, x = (np.mgrid[:n, :n] - n / 2) / n
    return np.where((x * stretch) ** 2 + y**2 < 0.1, 255.0, 0.0)


def all_metrics() -> list[str]:
    return [metric["name"] for metric in tl.metrics()]


def file_of(name: str, make) -> str:
    """The name of an input file of a command, which is written at first use."""
    file = INPUT / name
    if not file.exists():
        INPUT.mkdir(parents=True, exist_ok=True)
        tl.write(make(), file)
    return str(file)


ENDLESS = {"maximum_iterations": MANY, "relative_change": 0.0, "gradient_norm": 0.0}


def moving(n: int) -> dict:
    """The arguments of warp() that turn a part of the boundary of a cube."""
    mesh = cube(n)
    return {"mesh": tl.perturb(mesh, fraction=0.3).mesh}


#: By name: the function of further keyword arguments, and the arguments of the command of the shell, or None.
OPERATIONS = {
    "quality": (
        lambda **k: tl.quality(cube(70), all_metrics(), threads=1, **k),
        lambda: ["quality", file_of("cube70.vtu", lambda: cube(70)), "-o", "out.vtu", "--metrics",
                 ",".join(all_metrics())],
    ),
}  # fmt: skip
#: Those with a time limit, and a part of the output.
LIMITED = {}


def run_function(name: str) -> None:
    began = []

    def progress(fraction: float, text: str) -> None:
        if not began:
            began.append(text)
            print("progress", fraction, text, flush=True)

    try:
        OPERATIONS[name][0](progress=progress)
    except KeyboardInterrupt:
        print("KeyboardInterrupt")
        return
    raise AssertionError(f"{name} has ended by itself")


if __name__ == "__main__":
    {"function": run_function}[sys.argv[1]](sys.argv[2])
