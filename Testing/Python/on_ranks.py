# SPDX-License-Identifier: BSD-3-Clause
"""Common parts of the tests that run a script by pvbatch on MPI ranks. A test that imports it is skipped without
mpirun."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

MPIRUN = shutil.which("mpirun")
if not MPIRUN:
    print("there is no mpirun")
    sys.exit(77)
HERE, OUT = Path(__file__).parent, Path(os.environ["TAUTLINE_TEST_DIR"])
# Also as root, and where processes may not read each other's memory; ranks that wait leave the cores to others. Code
# that runs on the ranks, also scripts of sources, imports modules from here.
ENVIRONMENT = dict(
    os.environ, OMPI_MCA_btl_vader_single_copy_mechanism="none", OMPI_MCA_mpi_yield_when_idle="1", OMP_NUM_THREADS="1",
    PYTHONPATH=os.pathsep.join(filter(None, (str(HERE), os.environ.get("PYTHONPATH")))),
)  # fmt: skip
SECONDS = 400


def printed(folder: str) -> list[str]:
    """The output of each rank."""
    return [part.read_text(encoding="utf-8", errors="replace") for part in sorted(Path(folder).iterdir())]


def run_with_output(script: str, ranks: int, *arguments: str, symmetric: bool = False) -> tuple[dict, str]:
    """The JSON that a script writes to the file of its first argument, and the printed text.

    The test was given the path of pvbatch. symmetric: the script runs on each rank, not on the first only.
    """
    file = OUT / f"{Path(script).stem}_{ranks}.json"
    file.unlink(missing_ok=True)
    command = [MPIRUN, "--oversubscribe", "--bind-to", "none", "-np", str(ranks)]
    with tempfile.TemporaryDirectory() as folder:
        # A file for what each rank prints: mpirun mixes lines of several.
        command += ["sh", "-c", f'exec "$0" "$@" >"{folder}/$$" 2>&1', sys.argv[1], *(["--sym"] if symmetric else [])]
        try:
            done = subprocess.run([*command, str(HERE / script), str(file), *arguments], env=ENVIRONMENT,
                                  timeout=SECONDS, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  text=True)  # fmt: skip
        except subprocess.TimeoutExpired:
            print(f"{script} on {ranks} ranks takes longer than {SECONDS} s", *printed(folder), sep="\n", flush=True)
            raise
        text = "".join([done.stdout, *printed(folder)])
    assert file.exists(), text
    found = json.loads(file.read_text(encoding="utf-8"))
    assert found["ranks"] == ranks, found["ranks"]
    return found, text


def run(script: str, ranks: int, *arguments: str, symmetric: bool = False) -> dict:
    """The same for a script that is to report no error."""
    found, text = run_with_output(script, ranks, *arguments, symmetric=symmetric)
    assert "ERR|" not in text, text
    return found
