# SPDX-License-Identifier: BSD-3-Clause
"""Files that are read in a process of their own, because their reader may end it.

Readers of VTK and meshio crash, exit, or never end on some damaged files. Such a failure becomes an error of read().
The process has a limit of time and of memory.
"""

from __future__ import annotations

import json
import os
import re
import resource
import signal
import subprocess
import sys
import warnings
from tempfile import TemporaryDirectory
from typing import Any, Callable

from vtkmodules.vtkCommonDataModel import vtkDataObject

from ._errors import Error
from ._packing import Packed

#: Seconds that reading may take: at least, and for each MiB of the file.
_SECONDS, _SECONDS_PER_MEBIBYTE = 60.0, 2.0
#: Bytes of address space that reading may take: at least, and for each byte of the file.
_MEMORY, _MEMORY_PER_BYTE = 8 * 2**30, 100
_MEBIBYTE = 2**20
#: In the process: reading does not start yet another one.
_HERE = "TAUTLINE_READS_HERE"
_PYTHON = re.compile(r"python[\d.]*|pvpython|pvbatch")
_RESULT, _STARTED = "mesh", "started"
#: Variables by which MPI recognizes its processes.
_OF_MPI = ("OMPI_COMM_", "OMPI_MCA_", "PMIX_", "PMI_", "HYDRA_")
_END = b"\n"


def reads_here() -> bool:
    """Whether this is a process that reads a file for another one."""
    return _HERE in os.environ


def read_apart(name: str, request: dict[str, Any], here: Callable[[], Any]) -> Any:
    """The answer of another process to a request, see answer(): a data object or a value of JSON.

    here: does it in this process, if no other one can be started. Raises Error if the process reports one, if it is
    ended by a signal or a limit, or exits. Its warnings are issued again.
    """
    python = _interpreter()
    if reads_here() or python is None:
        return here()
    size = os.path.getsize(name)
    seconds = _SECONDS + _SECONDS_PER_MEBIBYTE * size / _MEBIBYTE
    with TemporaryDirectory(prefix="tautline-") as folder:
        task = {"name": name, "folder": folder, "memory": _MEMORY + _MEMORY_PER_BYTE * size,
                "seconds": int(seconds) + 1, **request}  # fmt: skip
        command = [python, "-c", "from tautline._io import read_for_another; read_for_another()", json.dumps(task)]
        try:
            done = subprocess.run(
                command,
                env=_environment(),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
                timeout=seconds,
                check=False,
                start_new_session=True,
            )
        except subprocess.TimeoutExpired:
            raise Error(f"{name}: reading takes more than {seconds:.0f} s: the file is damaged or too large") from None
        except OSError:
            return here()
        if not os.path.exists(os.path.join(folder, _STARTED)):  # another Python, which cannot import the package
            return here()
        return _result(name, os.path.join(folder, _RESULT), done)


def _interpreter() -> str | None:
    """The program that runs Python: in ParaView's programs with a window, the system's Python."""
    if sys.executable and _PYTHON.fullmatch(os.path.basename(sys.executable)):
        return sys.executable
    found = os.path.join(sys.base_prefix, "bin", f"python{sys.version_info.major}.{sys.version_info.minor}")
    return found if os.access(found, os.X_OK) else None


def _environment() -> dict[str, str]:
    kept = {key: value for key, value in os.environ.items() if not key.startswith(_OF_MPI)}
    return kept | {_HERE: "1", "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}


def _result(name: str, file: str, done: subprocess.CompletedProcess[bytes]) -> Any:
    if done.returncode or not os.path.exists(file):
        code = done.returncode
        how = f"ended by {signal.Signals(-code).name}" if code < 0 else f"exited with {code}"
        said = " ".join(done.stderr.decode(errors="replace").split())[-200:]
        raise Error(f"{name}: the file is damaged: its reader {how}" + (f" ({said})" if said else ""))
    with open(file, "rb") as content:
        answer = json.loads(content.readline())
        for text in answer["warnings"]:
            warnings.warn(text, stacklevel=6)
        if answer["error"] is not None:
            raise Error(answer["error"])
        if "class" not in answer:
            return answer["value"]
        packed = Packed.__new__(Packed)
        packed.class_name, packed.grids = answer["class"], answer["grids"]
        packed.content = content.read()
    return packed.data()


def answer(act: Callable[[dict[str, Any]], Any]) -> None:
    """Execute the request in sys.argv, in a process that read_apart() has started, and write the result."""
    request = json.loads(sys.argv[1])
    for limit, value in ((resource.RLIMIT_AS, request["memory"]), (resource.RLIMIT_CPU, request["seconds"])):
        hard = resource.getrlimit(limit)[1]
        value = value if hard == resource.RLIM_INFINITY else min(value, hard)
        resource.setrlimit(limit, (value, hard))
    resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
    folder = request["folder"]
    with open(os.path.join(folder, _STARTED), "wb"):
        pass
    facts: dict[str, Any] = {"error": None, "value": None}
    content = b""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            value = act(request)
            if isinstance(value, vtkDataObject):
                packed = Packed(value)
                facts |= {"class": packed.class_name, "grids": packed.grids}
                content = packed.content
            else:
                facts["value"] = value
        except Error as error:
            facts["error"] = str(error)
        except MemoryError:
            facts["error"] = f"{request['name']}: there is not enough memory: the file is damaged or too large"
    facts["warnings"] = list(dict.fromkeys(str(each.message) for each in told))
    with open(os.path.join(folder, _RESULT + ".part"), "wb") as file:
        file.write(json.dumps(facts).encode() + _END + content)
    os.replace(file.name, os.path.join(folder, _RESULT))
