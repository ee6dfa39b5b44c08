# SPDX-License-Identifier: BSD-3-Clause
"""The compiled modules of the package and their VTK classes.

Every compiled module that was built (TautlineQuality, ...) is beside this file. Its classes are attributes of this
module: `_vtk.vtkElementQuality()`. An optional module that was not built is skipped; a module that exists but cannot be
imported raises ImportError. The modules with linear solvers, which load PETSc and its libraries, are imported when one
of their classes is used.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

_PREFIX = "Tautline"

#: The compiled modules that were built.
MODULES = frozenset(
    found.name for found in iter_modules([str(Path(__file__).parent)]) if found.name.startswith(_PREFIX)
)

#: The files with functions and commands, in the order of the command line's help, and the compiled module of each.
CAPABILITIES = {
    "_information": "TautlineQuality",
    "_quality": "TautlineQuality",
    "_perturbation": "TautlinePerturbation",
    "_comparison": "TautlineQuality",
    "_report": "TautlineQuality",
    "_metric_field": "TautlineQuality",
    "_metrics": "TautlineQuality",
    "_optimization": "TautlineOptimization",
    "_untangling": "TautlineUntangling",
    "_curving": "TautlineCurving",
    "_adaptation": "TautlineAdaptation",
    "_reconnection": "TautlineReconnection",
    "_deformation": "TautlineDeformation",
    "_shapes": "TautlineShapes",
    "_elliptic": "TautlineElliptic",
    "_adapt": "TautlineReconnection",
    "_peridynamics": "TautlinePeridynamics",
    "_domains": "TautlineDomains",
    "_meshing": "TautlineMeshing",
    "_conversion": "TautlineReaders",
    "_pipeline": "TautlineQuality",
}

#: The classes of the modules that link PETSc, by module.
_OF_SOLVERS = {
    "TautlineDeformation": ("vtkMeshWarp", "vtkMovingBoundary"),
    "TautlineElliptic": (
        "vtkConditionEstimator", "vtkEllipticAlgorithm", "vtkEllipticSolver", "vtkKrylovAlgorithm",
        "vtkMeshDecomposition", "vtkSolverStudy",
    ),
    "TautlinePeridynamics": ("vtkHorizonNeighbors", "vtkInteractionLayer", "vtkPeridynamicStiffness"),
}  # fmt: skip

#: The module of each class that is imported on its first use.
LATER = {name: module for module in MODULES & _OF_SOLVERS.keys() for name in _OF_SOLVERS[module]}


def _classes(module: str) -> dict[str, Any]:
    """Import a compiled module; its classes by name."""
    found = vars(import_module(f".{module}", __package__))
    return {name: value for name, value in found.items() if name.startswith("vtk")}


#: The compiled classes by name, without those in LATER.
CLASSES = {name: value for module in sorted(MODULES - _OF_SOLVERS.keys()) for name, value in _classes(module).items()}
globals().update(CLASSES)


def available(capability: str) -> bool:
    """Whether the compiled module of a file in CAPABILITIES was built."""
    return CAPABILITIES[capability] in MODULES


def __getattr__(name: str) -> Any:
    if name in LATER:
        globals().update(_classes(LATER[name]))
        return globals()[name]
    raise AttributeError(f"{name} is in none of the compiled modules that were built: {', '.join(sorted(MODULES))}")
