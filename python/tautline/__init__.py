# SPDX-License-Identifier: BSD-3-Clause
"""Measure, repair, deform and match meshes with VTK, and solve equations on them.

>>> import tautline as tl
>>> worse = tl.perturb("part.vtu", fraction=0.5, seed=1)
>>> tl.quality(worse, ["imr", "radius_ratio"]).statistics["imr"]["worst"]
>>> worse.points, worse.cells["triangle"], worse.point_data["Displacement"]

The functions take a mesh as a vtkDataSet, a file name, (points, cells) numpy arrays or the result of another function,
and never change it. They return a result; where it has a mesh, this is its attribute `mesh`. Meshes and results have
the numpy arrays points, cells (by the name of the cell), point_data and cell_data. Errors raise tautline.Error.
Functions that can take long have the arguments time_limit and progress, and end soon after Ctrl-C.
The compiled VTK classes (vtkElementQuality, ...) are attributes of the package. Those that solve linear systems load
PETSc when they are first used.
`python3 -m tautline --help` shows the same functions as commands of the shell.
"""

import sys
from importlib import import_module as _import_module
from typing import TYPE_CHECKING

from . import _build, _start

if _start.is_command():
    _start.end_on_interrupt()
_build.check()  # before the first compiled module

from . import _vtk
from ._certificate import Verification, certificate, verify_certificate
from ._comparison import compare
from ._comparison_parts import CompareResult
from ._conversion import formats
from ._errors import Aborted, Error, MissingKey
from ._io import Mesh, read, times, to_meshio, write
from ._mesh import from_arrays
from ._metric_field import metric_field
from ._metric_field_parts import MetricFieldResult
from ._metrics import load_metrics, metrics, register_metric, unregister_metric
from ._pipeline import StepsResult, run_steps
from ._quality import quality
from ._quality_parts import QualityResult, criteria
from ._report import ReportResult, report
from ._state import StateResult, run_state

__version__ = _build.VERSION

__all__ = [
    "CompareResult", "compare", "Aborted", "Error", "MissingKey", "Mesh", "read", "write", "from_arrays",
    "MetricFieldResult", "metric_field", "load_metrics", "metrics", "register_metric", "unregister_metric",
    "QualityResult", "criteria", "Verification", "certificate", "verify_certificate",
    "quality", "ReportResult", "report", "StepsResult", "run_steps", "StateResult", "run_state",
    "formats", "times", "to_meshio",
]

if TYPE_CHECKING:
    from ._classes import *
globals().update(_vtk.CLASSES)

# Names that need an optional compiled module. A module that was built but cannot be imported raises ImportError.
if _vtk.available("_optimization"):
    from ._optimization import optimize
    from ._optimization_parts import OptimizeResult
    __all__ += ["OptimizeResult", "optimize"]
if _vtk.available("_untangling"):
    from ._untangling import untangle
    from ._untangling_parts import UntangleResult
    __all__ += ["UntangleResult", "untangle"]
if _vtk.available("_curving"):
    from ._curving import curve
    from ._curving_parts import CurveResult
    __all__ += ["CurveResult", "curve"]
if _vtk.available("_adaptation"):
    from ._adaptation import metric, transfer
    from ._adaptation_parts import MetricResult, TransferResult
    __all__ += ["MetricResult", "TransferResult", "metric", "transfer"]
if _vtk.available("_reconnection"):
    from ._reconnection import improve
    from ._reconnection_parts import ImproveResult
    __all__ += ["ImproveResult", "improve"]
if _vtk.available("_adaptation") and _vtk.available("_adapt"):
    from ._adapt import AdaptResult, adapt
    __all__ += ["AdaptResult", "adapt"]
if _vtk.available("_perturbation"):
    from ._perturbation import perturb
    from ._perturbation_parts import PerturbResult
    __all__ += ["PerturbResult", "perturb"]
if _vtk.available("_domains"):
    from ._domains import domain
    from ._domains_parts import domains
    __all__ += ["domain", "domains"]
if _vtk.available("_meshing"):
    from ._meshing import tet_mesh, triangle_mesh
    from ._meshing_parts import MeshResult
    __all__ += ["MeshResult", "tet_mesh", "triangle_mesh"]
if _vtk.available("_deformation"):
    from ._deformation import warp
    from ._deformation_parts import WarpResult
    __all__ += ["WarpResult", "warp"]
if _vtk.available("_shapes"):
    from ._shapes import match, retrieval, silhouette
    from ._shapes_parts import MatchResult, RetrievalResult, SilhouetteResult, read_silhouettes
    __all__ += ["MatchResult", "RetrievalResult", "SilhouetteResult"]
    __all__ += ["match", "read_silhouettes", "retrieval", "silhouette"]
if _vtk.available("_elliptic"):
    from ._elliptic import condition, solve, solver_study
    from ._elliptic_parts import ConditionResult, SolveResult, SolverStudyResult, solver_combinations
    __all__ += ["ConditionResult", "SolveResult", "SolverStudyResult"]
    __all__ += ["condition", "solve", "solver_combinations", "solver_study"]
if _vtk.available("_peridynamics"):
    from ._peridynamics import horizon_neighbors, interaction_layer, peridynamics
    from ._peridynamics_parts import HorizonResult, PeridynamicsResult
    __all__ += ["HorizonResult", "PeridynamicsResult", "horizon_neighbors", "interaction_layer", "peridynamics"]

globals()["__all__"] += sorted([*_vtk.CLASSES, *_vtk.LATER])

if not TYPE_CHECKING:  # to a type checker every name would be an attribute

    def __getattr__(name):
        if name in _vtk.LATER:
            return globals().setdefault(name, getattr(_vtk, name))
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

    def __dir__():
        return sorted({*globals(), *_vtk.LATER})

if "pyvista" in sys.modules and hasattr(sys.modules["pyvista"], "DataObject"):
    _import_module(".pyvista", __name__)
