# SPDX-License-Identifier: BSD-3-Clause
"""pvpython _state_runner.py JOB: runs the filters of a ParaView state, as tautline.run_state does.

JOB (.json) has `state`, with sources and filters only; `mesh`, a file that replaces the file of the only reader, or
empty; `filter`, the name or the label of the filter whose mesh is the result, or empty (an empty argument of pvpython
would crash it); and `result`, a .json file that gets a list of the filters with their summaries and the file with the
mesh, or `error`.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

import tautline
from paraview import servermanager, simple
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow

_PLUGIN, _PROXY = "Tautline", ("filters", "MeshUntangler")


def _load_plugin() -> None:
    """Load the plugin where ParaView does not do so by itself, from PV_PLUGIN_PATH."""
    if servermanager.vtkSMProxyManager.GetProxyManager().GetActiveSessionProxyManager().GetPrototypeProxy(*_PROXY):
        return
    simple.LoadDistributedPlugin(_PLUGIN, ns=globals())


def _producers(source: Any) -> list[Any]:
    """The sources that a filter takes."""
    found = []
    for name in source.ListProperties():
        value = source.GetProperty(name)
        if isinstance(value, servermanager.InputProperty):
            found += [port.SMProxy for port in value if port is not None]
    return found


def _ordered(sources: list[Any]) -> list[Any]:
    """Sources in the order in which they can be run: each after those that it takes."""
    left = {source.SMProxy.GetGlobalID(): source for source in sources}
    order: list[Any] = []
    while left:
        for key, source in list(left.items()):
            if not any(producer.GetGlobalID() in left for producer in _producers(source)):
                order.append(left.pop(key))
                break
        else:
            raise tautline.Error("the state's filters take each other's output in a circle")
    return order


def _is_reader(source: Any) -> bool:
    return not _producers(source) and any(source.GetProperty(name) is not None for name in ("FileName", "FileNames"))


def _replace_reader(sources: list[Any], mesh: str) -> list[Any]:
    """Connect another file to the consumers of the only reader of the state."""
    readers = [source for source in sources if _is_reader(source)]
    if len(readers) != 1:
        raise tautline.Error(f"the state reads {len(readers)} files; another mesh can be given where it reads one")
    replaced = simple.OpenDataFile(mesh)
    if replaced is None:
        raise tautline.Error(f"{mesh}: ParaView has no reader for it")
    for source in sources:
        for name in source.ListProperties():
            value = source.GetProperty(name)
            if isinstance(value, servermanager.InputProperty):
                ports = [replaced if port.SMProxy == readers[0].SMProxy else port for port in value]
                if any(port is replaced for port in ports):
                    source.SetPropertyWithName(name, ports if len(ports) > 1 else ports[0])
    return [replaced, *(source for source in sources if source is not readers[0])]


def _chosen(names: dict[Any, str], order: list[Any], wanted: str) -> Any:
    """The filter of a name or a label, otherwise the one whose output no other one takes."""
    taken = {producer.GetGlobalID() for source in order for producer in _producers(source)}
    if wanted:
        found = [source for source in order if wanted in (names.get(source), source.GetXMLLabel())]
        if len(found) == 1:
            return found[0]
        words = f"{len(found)} filters" if found else "no filter"
    else:
        found = [source for source in order if source.SMProxy.GetGlobalID() not in taken]
        if len(found) == 1:
            return found[0]
        words = "several ends, choose a filter: it has"
    listed = ", ".join(names[source] for source in order if names.get(source))
    raise tautline.Error(f"the state has {words}{f' {wanted!r}; there are' if wanted else ''} {listed}")


def main(state: str, mesh: str, wanted: str, result: str) -> None:
    _load_plugin()
    simple.LoadState(state)
    names = {source: name for (name, _), source in simple.GetSources().items()}
    sources = list(names)
    if not sources:
        raise tautline.Error("the state has no sources")
    if mesh:
        sources = _replace_reader(sources, mesh)
    window = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    filters = []
    order = _ordered(sources)
    chosen = _chosen(names, order, wanted)
    for source in order:
        source.UpdatePipeline()
        source.UpdatePropertyInformation()
        label = source.GetXMLLabel()
        if "ERR" in window.GetOutput() or "Error" in window.GetOutput():
            raise tautline.Error(f"{label}: {window.GetOutput().strip()}")
        if not _is_reader(source):
            summary = source.GetProperty("Summary")
            words = str(summary) if summary is not None else ""
            filters.append({"name": names.get(source, ""), "label": label, "summary": words})
    last = servermanager.Fetch(chosen)
    folder = Path(result).parent
    files = tautline.write(last, folder / f"mesh.{'vtm' if last.IsA('vtkCompositeDataSet') else _ending(last)}")
    Path(result).write_text(json.dumps({"filters": filters, "mesh": files[0]}), encoding="utf-8")


def _ending(data: Any) -> str:
    kinds = {"vtkPolyData": "vtp", "vtkImageData": "vti", "vtkRectilinearGrid": "vtr", "vtkStructuredGrid": "vts"}
    return kinds.get(data.GetClassName(), "vtu")


if __name__ == "__main__":
    job = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    try:
        main(job["state"], job["mesh"], job["filter"], job["result"])
    except tautline.Error as error:
        # not to stderr, which pvpython redirects to the message window
        Path(job["result"]).write_text(json.dumps({"error": str(error)}), encoding="utf-8")
    os._exit(0)  # the end of pvpython can crash in ParaView's own objects
