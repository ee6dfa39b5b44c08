# SPDX-License-Identifier: BSD-3-Clause
"""Every property of the XML arrives at its filter, from Python and from the shell.

test_properties.py SERVER_MANAGER_XML...: for each property of each proxy with the hint Python, a value that is not the
default is given, and the filter is asked for it when it would run.
"""

import inspect
import re
import sys
import xml.etree.ElementTree as ElementTree
from importlib import import_module

import numpy as np
import tautline as tl
from checks import DATA, OUT, run_tests
from tautline import _vtk
from tautline.__main__ import _parser
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkDataObject

MESH, FISH = OUT / "properties.vtu", DATA / "fish.png"
#: The first argument if it is not a mesh.
INPUTS = {
    "compare": [MESH, MESH],
    "transfer": [MESH, MESH],
    "silhouette": [FISH],
    "match": [FISH, DATA / "fish-bent.png"],
    "retrieval": [OUT / "properties.csv"],
    "domain": ["square"],
    "triangle_mesh": [DATA / "plate.poly"],
    "tet_mesh": [DATA / "cube.smesh"],
}
OTHER = DATA / "plate.vtu"
ROTATION = {"rotate": 30, "axis": (0, 1, 0), "center": (1, 2, 3)}
#: Further arguments that a function needs, in Python and on the shell.
NEEDED = {"warp": ({"transform": {"rotate": 30}}, ["--rotate", "30"])}
#: Arguments that set other properties than one of their name, and what the filter has then.
TOGETHER = {
    "quality": [
        ({"metrics": ["size", "imr"]}, {"Metrics": [8, 0]}),
        ({"criteria": "fem"}, {"Criteria": "fem"}),
        ({"size": "C"}, {"TargetType": 2, "SizeArray": "C"}),
        ({"tensor": "T"}, {"TargetType": 3, "TensorArray": "T"}),
        ({"reference": OTHER}, {"TargetType": 1, "Reference": True}),
    ],
    "compare": [({"metrics": ["size"]}, {"Metrics": [8]})],
    "metric_field": [
        ({"metrics": ["size"]}, {"Metrics": [8]}),
        ({"vertices": [(0, 0), (2, 1)]}, {"Vertex1": (0, 0, 0), "Vertex2": (2, 1, 0)}),
        ({"cell": "tetrahedron", "vertices": np.eye(3)}, {"Vertex3": (0, 0, 1)}),
        ({"bounds": (1, 2, 3, 4), "dimensions": (5, 6)}, {"Bounds": (1, 2, 3, 4, 0, 0), "Dimensions": (5, 6, 1)}),
    ],
    "optimize": [
        (
            {
                "objectives": [
                    ("imr", {"template": "sum", "weight": 2}),
                    ("size", {"template": "maximum", "target": "size"}),
                    ("mean_ratio", {"weight": 3, "target": "reference"}),
                    ("rr", {"template": "power mean", "target": "tensor"}),
                ],
                "size": "C",
                "tensor": "T",
                "reference": OTHER,
            },
            {
                "Preset": 0,
                "NumberOfObjectives": 4,
                **{"Metric1": "imr", "Template1": 3, "Target1": 0, "Weight1": 2.0},
                **{"Metric2": "size", "Template2": 5, "Target2": 2, "Weight2": 1.0},
                **{"Metric3": "mean_ratio", "Template3": -1, "Target3": 1, "Weight3": 3.0},
                **{"Metric4": "rr", "Template4": 4, "Target4": 3, "Weight4": 1.0},
            },
        ),
        ({"size": "C"}, {"SizeArray": "C"}),
        ({"worst_metric": "size"}, {"WorstMetric": 8}),
        ({"utopia": [0.5, 2]}, {"Utopia": [0.5, 2.0]}),
        ({"best_known": 0.25}, {"UseBestKnown": 1, "BestKnown": 0.25}),
        ({"limits": 0.5}, {"MaximumDisplacement": 0.5}),
        ({"limits": "P"}, {"LimitArray": "P"}),
    ],
    "metric": [
        ({"sizes": "P"}, {"Source": 0, "SizeArray": "P"}),
        ({"field": "P"}, {"Source": 1, "Field": "P"}),
        ({"distance": "P"}, {"Source": 3, "DistanceArray": "P"}),
        ({"source": "distance"}, {"Source": 3}),
    ],
    "transfer": [
        ({"point_arrays": ["P", "V"]}, {"PointArrays": ["P", "V"]}),
        ({"cell_arrays": ["C"]}, {"CellArrays": ["C"]}),
    ],
    "improve": [
        ({"metric": "Radius ratio"}, {"Objective": 3, "Metric": 2}),
        ({"objective": "sum"}, {"Objective": 4}),
        ({"edge_length": 0.5}, {"EdgeLengths": 1, "EdgeLength": 0.5}),
        ({"edge_length": "P"}, {"EdgeLengths": 2, "SizeArray": "P"}),
        ({"preset": "custom", "swap": False}, {"Preset": 0, "Swap": 0, "Smooth": 1}),
        ({"preset": "custom", "smooth": False, "contract": False}, {"Smooth": 0, "Contract": 0, "Insert": 1}),
        ({"preset": "custom", "insert": False, "compound": False}, {"Insert": 0, "Compound": 0}),
    ],
    "warp": [
        ({"displacement": "V"}, {"Motion": 0, "Displacement": "V"}),
        ({"target": MESH, "target_ids": "P"}, {"Motion": 1, "Target": True, "TargetIds": "P"}),
        ({"transform": ROTATION}, {"Motion": 2, "TransformKind": 2, "Angle": 30.0, "Axis": (0, 1, 0)}),
        ({"transform": ROTATION}, {"OwnCenter": 0, "Center": (1, 2, 3)}),
        ({"transform": {"translate": (1, 2)}}, {"TransformKind": 1, "Translation": (1, 2, 0)}),
        ({"transform": {"scale": 2}}, {"TransformKind": 3, "ScaleFactors": (2, 2, 2)}),
        ({"transform": {"bend": 9, "direction": (0, 1)}}, {"TransformKind": 4, "Direction": (0, 1, 0)}),
        ({"transform": np.eye(4)}, {"TransformKind": 0, "Transform": True}),
        ({"transform": ROTATION, "moved": "whole boundary"}, {"MovedPart": 1}),
        ({"transform": ROTATION, "moved": [2, 3]}, {"MovedPart": 3, "Parts": [2, 3]}),
        ({"transform": ROTATION, "moved": "P", "values": [4]}, {"MovedPart": 4, "MovedArray": "P", "Values": [4.0]}),
        ({"transform": ROTATION, "coefficients": "local gradients"}, {"Coefficients": 5}),
        ({"transform": ROTATION, "coefficients": (1, 2, 3)}, {"Coefficients": 2, "Tensor": (1, 2, 3, 0, 0, 0)}),
        ({"transform": ROTATION, "coefficients": "C"}, {"Coefficients": 3, "CellTensors": "C"}),
        (
            {"transform": ROTATION, "regions": ("C", {1: (1, 2, 3)})},
            {"Coefficients": 4, "RegionArray": "C", "Regions": [(1.0, 1.0, 2.0, 3.0)]},
        ),
        ({"transform": ROTATION, "solver": "minres"}, {"AutomaticSolver": 0, "Solver": 2}),
    ],
    "solve": [
        ({"initial": 2, "time_scheme": "bdf2"}, {"InitialType": 0, "InitialValue": 2.0}),
        ({"initial": "P", "time_scheme": "bdf2"}, {"InitialType": 1, "InitialArray": "P"}),
        ({"initial": "x", "time_scheme": "bdf2"}, {"InitialType": 2, "InitialExpression": "x"}),
        (
            {"pde": "elasticity", "initial": (1, 2), "velocity": (3, 4), "time_scheme": "newmark"},
            {"InitialDisplacement": (1, 2, 0), "VelocityVector": (3, 4, 0)},
        ),
        ({"velocity": 2, "time_scheme": "newmark"}, {"VelocityType": 0, "VelocityValue": 2.0}),
        ({"velocity": "P", "time_scheme": "newmark"}, {"VelocityType": 1, "VelocityArray": "P"}),
        ({"velocity": "x", "time_scheme": "newmark"}, {"VelocityType": 2, "VelocityExpression": "x"}),
    ],
    "solver_study": [({"combinations": [3, "CG + SSOR"]}, {"Combinations": [3, 5]})],
    "peridynamics": [
        ({"values": [3, 2, 1]}, {"KernelValues": [3.0, 2.0, 1.0]}),
        ({"model": "state-based", "plane": "stress"}, {"Elastic": 1, "StateBased": 1, "PlaneStress": 1}),
        ({"region": "C"}, {"RegionArray": "C"}),
        ({"source": 3}, {"UniformSource": 3.0}),
        ({"source": "C"}, {"SourceArray": "C"}),
    ],
    "silhouette": [({"threshold": 99}, {"UseThreshold": 1, "Threshold": 99.0})],
    "match": [({"grid": (7, 8)}, {"GridSize": (7, 8)})],
    "retrieval": [({"grid": (7, 8)}, {"GridSize": (7, 8)})],
    "horizon_neighbors": [({"center": (1, 2)}, {"Center": (1, 2, 0)})],
}
#: The same of the problem of solve(), condition() and solver_study().
PROBLEM = [
    ({"source": 3}, {"SourceType": 0, "SourceValue": 3.0}),
    ({"pde": "elasticity", "source": (1, 2)}, {"BodyForce": (1, 2, 0)}),
    ({"source": "P"}, {"SourceType": 1, "SourceArray": "P"}),
    ({"source": "x"}, {"SourceType": 2, "SourceExpression": "x"}),
    ({"given": 3}, {"GivenType": 0, "GivenValue": 3.0}),
    ({"pde": "elasticity", "given": (1, 2)}, {"GivenDisplacement": (1, 2, 0)}),
    ({"given": "P"}, {"GivenType": 1, "GivenArray": "P"}),
    ({"given": "x"}, {"GivenType": 2, "GivenExpression": "x"}),
    ({"fixed": "x < 1"}, {"FixedPart": 1, "FixedWhere": "x < 1"}),
    ({"fixed": "P"}, {"FixedPart": 2, "FixedPoints": "P"}),
]
for function in ("solve", "condition", "solver_study"):
    TOGETHER[function] = TOGETHER.get(function, []) + PROBLEM


class Arrived(Exception):
    """Instead of the execution of a filter."""


def stop(filter_, *_):
    raise Arrived(filter_)


def functions():
    """Name, proxy, module and the positional arguments of each function."""
    for xml in sys.argv[1:]:
        for proxy in ElementTree.parse(xml).iterfind("ProxyGroup/*"):
            for hint in proxy.iterfind("Hints/Python"):
                module = import_module(f"tautline.{hint.get('module')}")
                module.run = stop
                record(proxy)
                meshes = [MESH] if proxy.find("InputProperty[@name='Input']") is not None else []
                yield hint.get("function"), proxy, INPUTS.get(hint.get("function"), meshes)


def record(proxy) -> None:
    """Let the filter keep what is added to it by commands that have no Get."""
    made = getattr(tl, proxy.get("class"))

    def adder(command):
        def add(self, *values):
            vars(self).setdefault(f"added by {command}", []).append(values[0] if len(values) == 1 else values)
            return getattr(made, command)(self, *values)

        return add

    commands = [element.get("command") for element in proxy if element.get("repeat_command") == "1"]
    commands += ["AddMetricByName", "AddObjectiveByName"]  # which Python has instead
    commands = [command for command in commands if hasattr(made, command)]
    setattr(_vtk, proxy.get("class"), type(made.__name__, (made,), {command: adder(command) for command in commands}))


def properties(proxy):
    """The properties that are set, with the names of their arguments."""
    for element in proxy:
        selection = element.find("DataTypeDomain/DataType[@value='vtkSelection']") is not None
        result = element.get("information_only") == "1"
        if element.tag.endswith("Property") and element.get("name") != "Input" and not (selection or result):
            yield element, element.get("python", re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", element.get("name")).lower())


def other_values(proxy, element):
    """Values that are not the default, and what the filter has then; of an enumeration all labels of the panel."""
    if element.find("EnumerationDomain") is None:
        return [other_value(proxy, element)]
    default = element.get("default_values")
    return [(entry.get("text").upper(), int(entry.get("value"))) for entry in element.iter("Entry")
            if entry.get("value") != default]  # fmt: skip


def other_value(proxy, element):
    default = element.get("default_values", "")
    domain = next((child for child in element if child.tag.endswith("Domain")), None)
    if element.tag == "InputProperty":
        return OTHER, True
    if element.get("command") == "SetInputArrayToProcess":
        domain = element.find("ArrayListDomain").get("input_domain_name")
        on = proxy.find(f"InputProperty/InputArrayDomain[@name='{domain}']").get("attribute_type")
        return ("P", "P") if on == "point" else ("C", "C")
    if element.find("BooleanDomain") is not None:
        value = not int(default)
        return value, int(value)
    if element.tag.startswith("String"):
        return "text", "text"
    low, high = (float(domain.get(end, "nan")) if domain is not None else np.nan for end in ("min", "max"))
    number = float(default)
    value = (number + high) / 2 if high > number else (number + low) / 2 if low < number else number + 2
    value = value if element.tag.startswith("Double") else int(value) + (int(value) == number)
    return value, value


def found(filter_, element):
    """The value of the filter."""
    command = element.get("command")
    if element.tag == "InputProperty":
        return filter_.GetInputDataObject(int(element.get("port_index")), 0) is not None
    if command == "SetInputArrayToProcess":
        index = int(element.get("default_values").split("|")[0])
        name = filter_.GetInputArrayInformation(index).Get(vtkDataObject.FIELD_NAME())
        return name.removeprefix("given ")
    if element.get("repeat_command") == "1":
        numbers = {metric["name"]: metric["number"] for metric in tl.metrics()}
        named = vars(filter_).get(f"added by {command}ByName", ())
        return [numbers[name] for name in named] or vars(filter_).get(f"added by {command}", [])
    objective = re.fullmatch(r"Set(Metric|Template|Weight|Target)(\d)", command)
    if objective:
        facts = vars(filter_)["added by AddObjectiveByName"][int(objective[2]) - 1]
        return facts[("Metric", "Template", "Weight", "Target").index(objective[1])]
    value = getattr(filter_, f"Get{command[3:]}")()
    return value is not None if element.tag == "ProxyProperty" else value


def same(value, expected) -> bool:
    numbers = isinstance(expected, (float, tuple))
    return bool(np.allclose(value, expected, 1e-12, 0) if numbers else value == expected)


def arrived(function, *arguments, **options):
    """The filter that a call is about to run."""
    try:
        function(*arguments, **options)
    except Arrived as done:
        return done.args[0]
    raise AssertionError(f"{function} did not run its filter with {options}")


def test_properties() -> None:
    """Each property that is an argument of its own, in Python and on the shell."""
    checked, commands = 0, _parser()
    for name, proxy, meshes in functions():
        parameters = inspect.signature(getattr(tl, name)).parameters
        together = {key for _, values in TOGETHER.get(name, ()) for key in values}
        for element, argument in properties(proxy):
            key = element.get("name")
            if not argument or key in together:
                continue
            assert argument in parameters, f"{name}() has no argument {argument}, and TOGETHER has no {key}"
            for value, expected in other_values(proxy, element):
                check_argument(name, proxy, meshes, element, argument, value, expected)
                if element.get("shell") != "":
                    check_option(commands, name, proxy, meshes, element, argument, value, expected)
            checked += 1
    assert checked > 120 or not sys.argv[1:], checked


def check_argument(name, proxy, meshes, element, argument, value, expected) -> None:
    filter_ = arrived(getattr(tl, name), *meshes, **NEEDED.get(name, ({}, []))[0], **{argument: value})
    assert same(found(filter_, element), expected), (name, argument, found(filter_, element), expected)
    if element.tag != "InputProperty" and element.get("command") != "SetInputArrayToProcess":
        default = found(getattr(tl, proxy.get("class"))(), element)
        assert not same(default, expected), (name, argument, "is the default of the filter")


def check_option(commands, name, proxy, meshes, element, argument, value, expected) -> None:
    """The option of the command does the same."""
    flag = f"--{argument.rstrip('_').replace('_', '-')}"
    flag = (flag if value else f"--no-{flag[2:]}") if isinstance(value, bool) else f"{flag}={value}"
    output = [] if proxy.find("Hints/Python").get("output") == "" else ["-o", OUT / "properties-out.vtu"]
    line = [name.replace("_", "-"), *meshes, *output, *NEEDED.get(name, ({}, []))[1], flag]
    arguments = commands.parse_args(list(map(str, line)))
    filter_ = arrived(arguments.run, arguments)
    assert same(found(filter_, element), expected), (line, found(filter_, element), expected)


def test_together() -> None:
    """Arguments that set several properties, or are named otherwise."""
    checked = set()
    for name, proxy, meshes in functions():
        elements = {element.get("name"): element for element, _ in properties(proxy)}
        for options, values in TOGETHER.get(name, ()):
            filter_ = arrived(getattr(tl, name), *meshes, **options)
            checked.add(name)
            for key, expected in values.items():
                value = found(filter_, elements[key])
                assert same(value, expected), (name, options, key, value, expected)
    assert checked == set(TOGETHER) or not sys.argv[1:], set(TOGETHER) - checked


def test_signatures() -> None:
    """Every argument is listed, and documented."""
    for name, _, _ in functions():
        function = getattr(tl, name)
        for parameter in inspect.signature(function).parameters.values():
            assert parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL), (name, parameter)
            entry = re.compile(rf"^(    )?(\w+, )*{parameter.name}(, \w+)* : \S", re.MULTILINE)
            assert entry.search(function.__doc__), (name, parameter)


def make_mesh() -> None:
    """A mesh with arrays of numbers of its points and cells, of vectors and of tensors."""
    mesh = tl.read(DATA / "plate.vtu")
    for name, data, size, width in (
        ("P", mesh.GetPointData(), mesh.GetNumberOfPoints(), 1),
        ("V", mesh.GetPointData(), mesh.GetNumberOfPoints(), 3),
        ("C", mesh.GetCellData(), mesh.GetNumberOfCells(), 1),
        ("T", mesh.GetCellData(), mesh.GetNumberOfCells(), 6),
    ):
        array = numpy_to_vtk(np.ones((size, width)), deep=True)
        array.SetName(name)
        data.AddArray(array)
    tl.write(mesh, MESH)
    (OUT / "properties.csv").write_text(f"file,class\n{FISH},fish\n{DATA / 'fish-bent.png'},fish\n")


make_mesh()
run_tests(globals())
