# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the package share: directories, checks of errors and commands, small meshes."""

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


def refused(text: str, function, *arguments, **options) -> None:
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
