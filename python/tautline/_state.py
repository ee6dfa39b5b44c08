# SPDX-License-Identifier: BSD-3-Clause
"""The function run_state: the filters of a ParaView state, without its window."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

from vtkmodules.vtkCommonDataModel import vtkDataObject

from ._errors import Error, checked
from ._files import check_input, file_name
from ._io import read
from ._results import Result

#: The ending of the name of a state.
STATE = ".pvsm"
_PROGRAM = "pvpython"
_RUNNER = Path(__file__).with_name("_state_runner.py")
#: The groups of proxies that are kept: filters and their parts; views and their parts need a display.
_DROPPED = (
    "additional_lights", "animation", "animation_keyframes", "annotations", "cameramanipulators", "extractors",
    "layouts", "lookup_tables", "misc", "piecewise_functions", "representations", "scalar_bars", "settings", "textures",
    "timekeeper", "views",
)  # fmt: skip
_FILE_PROPERTIES = ("FileName", "FileNames")


@dataclass(frozen=True, repr=False, eq=False)
class StateResult(Result):
    """The result of run_state().

    Attributes
    ----------
    mesh : vtkDataObject
        The output of the chosen filter.
    filters : list[dict[str, str]]
        name, label and summary (empty for filters without one) of each filter, in the order of their run.
    summary : str
        A line per filter.
    """

    mesh: vtkDataObject
    filters: list[dict[str, str]]
    summary: str


@checked
def run_state(state: str | PathLike[str], *, mesh: str | PathLike[str] | None = None, filter: str = "") -> StateResult:
    """Run the filters of a ParaView state one after the other, without a window or a display.

    Parameters
    ----------
    state : str or path
        A .pvsm file that ParaView saved (File > Save State). Views, colors and animations are left out. Input files are
        searched at the paths in the state, then beside it.
    mesh : str or path, optional
        Another file, instead of the one that the state reads.
    filter : str, default ""
        The filter whose output is the mesh of the result, by its name in the Pipeline Browser or its label. It may be
        left out where the state has one end.

    Returns
    -------
    StateResult

    Raises
    ------
    Error
        If the state cannot be read, if it reads several files and `mesh` is given, if it has several ends and no filter
        is chosen, and for every error of a filter.

    Notes
    -----
    Needs ParaView with the plugin: pvpython is run, and finds the plugin by itself or in PV_PLUGIN_PATH.

    Examples
    --------
    >>> tautline.run_state("analysis.pvsm", mesh="part2.vtu").summary
    """
    name = file_name(state)
    check_input(name)
    other = "" if mesh is None else os.path.abspath(file_name(mesh))
    if other:
        check_input(other)
    program = shutil.which(_PROGRAM)
    if program is None:
        words = "which is not on the PATH; a file of steps (.toml) does not"
        raise Error(f"{name}: a ParaView state needs {_PROGRAM}, {words}")
    with TemporaryDirectory() as folder:
        short, result = os.path.join(folder, "state.pvsm"), os.path.join(folder, "result.json")
        Path(short).write_text(_computing(name, bool(other)), encoding="utf-8")
        paths = [str(Path(__file__).parent.parent), os.environ.get("PYTHONPATH", "")]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in paths if path)}
        job = Path(folder, "job.json")
        wanted = {"state": short, "mesh": other, "filter": filter, "result": result}
        job.write_text(json.dumps(wanted), encoding="utf-8")
        command = [program, str(_RUNNER), str(job)]
        done = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
        if done.returncode or not os.path.exists(result):
            words = (done.stderr or done.stdout).strip()
            raise Error(f"{name}: {words or f'{_PROGRAM} ended with {done.returncode}'}")
        facts = json.loads(Path(result).read_text(encoding="utf-8"))
        if "error" in facts:
            raise Error(f"{name}: {facts['error']}")
        found = read(facts["mesh"])
    filters: list[dict[str, str]] = facts["filters"]
    lines = [f"{i} {each['label']}: {each['summary'].partition(chr(10))[0]}" for i, each in enumerate(filters, 1)]
    return StateResult(mesh=found, filters=filters, summary="\n".join(line.removesuffix(": ") for line in lines))


def _computing(name: str, replaced: bool) -> str:
    """The text of the state without views, and with the names of files that exist."""
    try:
        root = ElementTree.fromstring(Path(name).read_bytes())
    except ElementTree.ParseError as error:
        raise Error(f"{name}: not a state of ParaView: {error}") from None
    found = root if root.tag == "ServerManagerState" else root.find("ServerManagerState")
    if found is None:
        raise Error(f"{name}: not a state of ParaView: it has no ServerManagerState")
    for part in list(found):
        kept = part.tag == "Proxy" and part.get("group") not in _DROPPED
        kept = kept or (part.tag == "ProxyCollection" and part.get("name") not in _DROPPED)
        if not kept:
            found.remove(part)
    for item in found.iter("Property"):
        if item.get("name") in _FILE_PROPERTIES:
            for element in item.iter("Element"):
                element.set("value", _place(name, element.get("value", ""), replaced))
    return ElementTree.tostring(found, encoding="unicode")


def _place(state: str, file: str, replaced: bool) -> str:
    """The path of a file of a state: as in the state, or beside the state."""
    beside = os.path.join(os.path.dirname(os.path.abspath(state)), os.path.basename(file))
    for candidate in (file, beside):
        if os.path.isabs(candidate) and os.path.exists(candidate):
            return candidate
    if file and not replaced:
        raise Error(f"{state}: the file that it reads is not there: {file}")
    return file
