# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of the tests of the package: directories, checks of errors and commands, small meshes."""

import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import tautline as tl
from vtkmodules.util.numpy_support import vtk_to_numpy
from wording import wording  # noqa: F401, for those that import from here

DATA, OUT = Path(os.environ["TAUTLINE_DATA_DIR"]), Path(os.environ["TAUTLINE_TEST_DIR"])
SKIPPED = 77  # exit code, SKIP_RETURN_CODE of ctest
SLOW = os.environ.get("TAUTLINE_SLOW_TESTS") == "1"  # ./run test --all


def rejected(text: str, function, *arguments, **options) -> None:
    """Check that a call raises tautline.Error with a text in its message."""
    try:
        function(*arguments, **options)
    except tl.Error as error:
        assert text in str(error), f"'{text}' is not in '{error}'"
    else:
        raise AssertionError(f"{function.__name__} accepted {arguments} {options}; '{text}' was expected")


def shell(*arguments, code: int = 0, folder: Path = None) -> str:
    """The output of python3 -m tautline; checks the exit code, and that stderr is empty after success."""
    command = [sys.executable, "-m", "tautline", *map(str, arguments)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == code, (arguments, done.returncode, done.stdout, done.stderr)
    assert code or not done.stderr, (arguments, done.stderr)
    return done.stdout + done.stderr


def points(mesh) -> np.ndarray:
    """The coordinates, n x 3."""
    return vtk_to_numpy(mesh.GetPoints().GetData())


def square(n: int):
    """The unit square of 2 n^2 right triangles."""
    x, y = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n)
    a = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    cells = np.stack([a, a + 1, a + n + 2, a, a + n + 2, a + n + 1], axis=1).reshape(-1, 3)
    return tl.from_arrays(np.column_stack([x.ravel(), y.ravel()]), {"triangle": cells})


def quadratic_square(n: int, bend: float = 0.0):
    """The unit square of 2 n^2 triangles of 6 nodes; all edges inside are curved where it is bent."""
    steps = 2 * n + 1
    x, y = (at.ravel() / (2 * n) for at in np.meshgrid(np.arange(steps), np.arange(steps)))
    a = (2 * np.arange(n)[:, None] * steps + 2 * np.arange(n)).ravel()
    lower = [0, 2, 2 * steps + 2, 1, steps + 2, steps + 1]
    upper = [0, 2 * steps + 2, 2 * steps, steps + 1, 2 * steps + 1, steps]
    cells = np.stack([a + step for step in lower + upper], axis=1).reshape(-1, 6)
    wave = bend * np.sin(np.pi * x) * np.sin(np.pi * y)
    return tl.from_arrays(np.column_stack([x + wave, y - 0.7 * wave]), {"triangle6": cells})


def test_data(name: str) -> Path:
    """A folder of the test data that are not part of the repository; where it is absent, the test is skipped."""
    top = os.environ.get("TAUTLINE_TEST_DATA")
    if top and Path(top, name).is_dir():
        return Path(top, name)
    print(f"skipped: there is no {Path(top, name)}" if top else "skipped: TAUTLINE_TEST_DATA is not set")
    sys.exit(SKIPPED)


def slow(test):
    """Mark a test that takes long: it runs in ./run test --all (TAUTLINE_SLOW_TESTS=1), or where it is named."""
    test.slow = True
    return test


def run_tests(module: dict) -> None:
    """Run the functions test_... of a module, in their order, and print how long each takes.

    Where the environment variable TAUTLINE_TEST_PART is set, the tests whose names contain it.
    """
    part = os.environ.get("TAUTLINE_TEST_PART", "")
    for name, test in list(module.items()):
        if not name.startswith("test_") or test is test_data or part not in name:
            continue
        if getattr(test, "slow", False) and not part and not SLOW:
            print(f"{name} left out: slow", flush=True)
            continue
        began = time.monotonic()
        test()
        print(f"{name} passed in {time.monotonic() - began:.2f} s", flush=True)
