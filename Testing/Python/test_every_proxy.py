# SPDX-License-Identifier: BSD-3-Clause
"""Guarantees of every proxy of the plugin: the time limit, the meaning of 0, empty inputs, summaries of blocks."""

import os
import re
import sys
from pathlib import Path

from paraview import servermanager, simple
from vtkmodules.vtkCommonCore import vtkOutputWindow

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "Plugin"))
import list_proxies  # noqa: E402
from wording import wording

LIMIT = 600
#: Finds the elements around one point; ends at once.
UNLIMITED = {"HorizonNeighbors"}
#: Properties whose 0 is a value like any other, or one of an array.
PLAIN_ZERO = {"FixedPoints", "MovedArray", "Amount", "Animation", "ShowFeatures", "KernelValues", "Cell"}
MEANING = re.compile(r"(?:^|[\s(;:])0(?: is|:| means|,| =)|if 0\b")
DATA = Path(os.environ["TAUTLINE_DATA_DIR"])
#: The empty data, where Input does not take any mesh; and required inputs besides it.
EMPTY = {"SilhouetteToMesh": "vtkImageData", "MatchShape": "vtkImageData", "ShapeRetrieval": "vtkImageData",
         "TriangleMesher": "vtkPolyData", "TetGenMesher": "vtkPolyData"}  # fmt: skip
SECOND = {"MatchShape": "Target", "MeshComparison": "Other", "FieldTransfer": "Source"}
#: They find shapes in images, generate meshes, or compute on all blocks as one mesh: their summaries have no blocks.
WITHOUT_BLOCKS = {"SilhouetteToMesh", "MatchShape", "ShapeRetrieval", "TriangleMesher", "TetGenMesher",
                  "InteractionLayer", "HorizonNeighbors", "PeridynamicCondition", "FieldTransfer"}  # fmt: skip
#: The sums over both blocks of 8140 elements.
SUMS = {"ElementQuality": "16280 valid elements", "MeshComparison": "16280 equal", "MeshPerturbation": "of 16280"}

before = list_proxies.proxies()
simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns={})
PROXIES = sorted(list_proxies.proxies() - before)
MESSAGES = []


def listen():
    """Collect the errors and warnings, as the window Output Messages does."""
    for event in ("ErrorEvent", "WarningEvent"):

        def collect(_caller, _event, text):
            MESSAGES.append(text.strip())

        collect.CallDataType = "string0"
        vtkOutputWindow.GetInstance().AddObserver(event, collect)


def properties(proxy):
    iterator = proxy.NewPropertyIterator()
    iterator.Begin()
    while not iterator.IsAtEnd():
        yield iterator.GetKey(), iterator.GetProperty()
        iterator.Next()


def meaning_of_zero(prop):
    """The text of the field for 0, or None."""
    hints = prop.GetHints()
    for i in range(hints.GetNumberOfNestedElements() if hints else 0):
        element = hints.GetNestedElement(i)
        if element.GetAttribute("type") == "tautline_zero":
            return element.GetAttribute("text") or element.GetAttribute("meaning")
    return None


def make(name, **inputs):
    """The filter, whatever its label is."""
    proxy = servermanager.ProxyManager().NewProxy("filters", name)
    filter_ = servermanager._getPyProxy(proxy)
    for key, value in inputs.items():
        filter_.SetPropertyWithName(key, value)
    return filter_


def test_limits():
    """Every filter and source that computes ends after ten minutes by default."""
    for group, name in PROXIES:
        known = dict(properties(servermanager.ProxyManager().NewProxy(group, name)))
        reads = "Reader" in name or group == "writers"
        if reads or name in UNLIMITED:
            assert "TimeLimit" not in known, name
            continue
        assert known["TimeLimit"].GetElement(0) == LIMIT, (name, known["TimeLimit"].GetElement(0))


def test_zero():
    """A field whose 0 has another meaning shows it."""
    shown = 0
    for group, name in PROXIES:
        for key, prop in properties(servermanager.ProxyManager().NewProxy(group, name)):
            text = prop.GetDocumentation().GetDescription() if prop.GetDocumentation() else ""
            number = prop.IsA("vtkSMDoubleVectorProperty") or prop.IsA("vtkSMIntVectorProperty")
            if not number or prop.GetInformationOnly() or key in PLAIN_ZERO or not MEANING.search(text):
                continue
            assert meaning_of_zero(prop), f"{name}.{key} does not show what 0 stands for: {text}"
            shown += 1
    assert shown > 30, shown


def test_no_array():
    """A menu of arrays shows None, not "None (?)": its first entry is None of the points."""
    menus = 0
    for group, name in PROXIES:
        for key, prop in properties(servermanager.ProxyManager().NewProxy(group, name)):
            count = prop.GetNumberOfElements() if prop.FindDomain("vtkSMArrayListDomain") else 0
            if count == 5 and prop.GetElement(4) == "None":
                assert prop.GetElement(3) == "0", f"{name}.{key} shows None (?)"
                menus += 1
    assert menus > 30, menus


def test_empty():
    """An empty input is reported once, with a remedy, and no other error is."""
    for group, name in PROXIES:
        if group != "filters":
            continue
        kind = EMPTY.get(name, "vtkUnstructuredGrid")
        source = simple.ProgrammableSource(OutputDataSetType=kind, Script="pass")
        source.UpdatePipeline()
        if name == "ShapeRetrieval":  # takes several images
            source = simple.GroupDatasets(Input=[source])
        inputs = {"Input": source}
        if name in SECOND:
            inputs[SECOND[name]] = source
        filter_ = make(name, **inputs)
        MESSAGES.clear()
        filter_.UpdatePipeline()
        filter_.UpdatePipeline()
        expected = "The image is empty" if name == "ShapeRetrieval" else "choose another input"
        assert len(MESSAGES) == 1 and expected in MESSAGES[0], (name, MESSAGES)
        if "Summary" in filter_.ListProperties() and name != "ShapeRetrieval":
            filter_.UpdatePropertyInformation()
            assert wording("has-no") in filter_.Summary, (name, filter_.Summary)


def test_error_once():
    """An input that is rejected is one message, whatever outputs are asked for how often; the outputs are empty."""
    table = simple.ProgrammableSource(OutputDataSetType="vtkTable", Script="pass")
    table.UpdatePipeline()
    rejected = 0
    for group, name in PROXIES:
        if group != "filters":
            continue
        inputs = {key: table for key in ("Input", SECOND.get(name)) if key}
        filter_ = make(name, **inputs)
        MESSAGES.clear()
        filter_.UpdatePipeline()
        if "vtkDemandDrivenPipeline" in MESSAGES[0]:  # VTK itself rejects a table in the place of an image or surface
            continue
        for port in 2 * list(range(filter_.SMProxy.GetNumberOfOutputPorts())):
            simple.OutputPort(filter_, port).UpdatePipeline()
            assert servermanager.Fetch(filter_, idx=port).GetNumberOfElements(0) == 0, (name, port)
        assert len(MESSAGES) == 1, (name, MESSAGES)
        assert wording("returned-failure") not in MESSAGES[0], MESSAGES
        # After a change it executes, and reports, again.
        executed = filter_.SMProxy.GetClientSideObject()
        executed.Modified()
        executed.Update()
        assert len(MESSAGES) == 2, (name, MESSAGES)
        assert executed.GetErrorCode() != 0, name
        rejected += 1
    assert rejected > 10, rejected


def test_blocks():
    """The summary of a mesh of two blocks names both, or has the numbers of both."""
    for group, name in PROXIES:
        if group != "filters" or name in WITHOUT_BLOCKS:
            continue
        mesh = simple.XMLUnstructuredGridReader(FileName=[str(DATA / "bracket.vtu")])
        blocks = simple.GroupDatasets(Input=[mesh, mesh])
        inputs = {"Input": blocks}
        if name in SECOND:
            inputs[SECOND[name]] = blocks
        filter_ = make(name, **inputs)
        filter_.UpdatePipeline()
        filter_.UpdatePropertyInformation()
        # The text of the progress begins with the name in the menu.
        shown = filter_.SMProxy.GetClientSideObject().GetProgressText()
        assert shown.startswith(filter_.SMProxy.GetXMLLabel()), (name, shown)
        expected = [SUMS[name]] if name in SUMS else ["In block 1: ", "In block 2: "]
        assert not [text for text in expected if text not in filter_.Summary], (name, filter_.Summary)


def main() -> None:
    """In names of its own: with ParaView 5.13, loading a plugin defines many in this module."""
    listen()
    for name, test in [(key, value) for key, value in list(globals().items()) if key.startswith("test_")]:
        test()
        print(f"{name} passed", flush=True)


main()
