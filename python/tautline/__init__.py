# SPDX-License-Identifier: BSD-3-Clause
"""Measure, repair, deform and match meshes with VTK, and solve equations on them.

>>> import tautline as tl
>>> worse = tl.perturb("part.vtu", fraction=0.5, seed=1)
>>> tl.quality(worse, ["imr", "radius_ratio"]).statistics["imr"]["worst"]

The functions take a mesh as a vtkDataSet, a file name, (points, cells) numpy arrays or the result of another function,
and never change it. They return a result; where it has a mesh, this is its attribute `mesh`. Errors raise
tautline.Error. Functions that can take long have the arguments time_limit and progress, and end soon after Ctrl-C.
The compiled VTK classes (vtkElementQuality, ...) are attributes of the package, too.
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
from ._comparison import CompareResult, compare
from ._conversion import formats
from ._errors import Aborted, Error
from ._io import Mesh, read, times, to_meshio, write
from ._mesh import from_arrays
from ._metric_field import MetricFieldResult, metric_field
from ._metrics import load_metrics, metrics, register_metric, unregister_metric
from ._pipeline import StepsResult, run_steps
from ._quality import QualityResult, criteria, quality
from ._report import report
from ._state import StateResult, run_state

__version__ = _build.VERSION

__all__ = [
    "CompareResult", "compare", "Aborted", "Error", "Mesh", "read", "write", "from_arrays", "MetricFieldResult",
    "metric_field", "load_metrics", "metrics", "register_metric", "unregister_metric", "QualityResult", "criteria",
    "quality", "report", "StepsResult", "run_steps", "StateResult", "run_state",
    "formats", "times", "to_meshio",
]

if TYPE_CHECKING:
    from ._classes import *
globals().update(_vtk.CLASSES)

# What needs a compiled module that is optional. One that was built but cannot be imported raises ImportError.
if _vtk.available("_optimization"):
    from ._optimization import OptimizeResult, optimize
    __all__ += ["OptimizeResult", "optimize"]
if _vtk.available("_untangling"):
    from ._untangling import UntangleResult, untangle
    __all__ += ["UntangleResult", "untangle"]
if _vtk.available("_reconnection"):
    from ._reconnection import ImproveResult, improve
    __all__ += ["ImproveResult", "improve"]
if _vtk.available("_perturbation"):
    from ._perturbation import PerturbResult, perturb
    __all__ += ["PerturbResult", "perturb"]
if _vtk.available("_domains"):
    from ._domains import domain, domains
    __all__ += ["domain", "domains"]
if _vtk.available("_meshing"):
    from ._meshing import MeshResult, tet_mesh, triangle_mesh
    __all__ += ["MeshResult", "tet_mesh", "triangle_mesh"]
if _vtk.available("_deformation"):
    from ._deformation import WarpResult, warp
    __all__ += ["WarpResult", "warp"]
if _vtk.available("_shapes"):
    from ._shapes import (
        MatchResult,
        RetrievalResult,
        SilhouetteResult,
        match,
        read_silhouettes,
        retrieval,
        silhouette,
    )
    __all__ += ["MatchResult", "RetrievalResult", "SilhouetteResult"]
    __all__ += ["match", "read_silhouettes", "retrieval", "silhouette"]
if _vtk.available("_elliptic"):
    from ._elliptic import (
        ConditionResult,
        SolveResult,
        SolverStudyResult,
        condition,
        solve,
        solver_combinations,
        solver_study,
    )
    __all__ += ["ConditionResult", "SolveResult", "SolverStudyResult"]
    __all__ += ["condition", "solve", "solver_combinations", "solver_study"]
if _vtk.available("_peridynamics"):
    from ._peridynamics import (
        HorizonResult,
        PeridynamicsResult,
        horizon_neighbors,
        interaction_layer,
        peridynamics,
    )
    __all__ += ["HorizonResult", "PeridynamicsResult", "horizon_neighbors", "interaction_layer", "peridynamics"]

globals()["__all__"] += sorted(_vtk.CLASSES)

if "pyvista" in sys.modules and hasattr(sys.modules["pyvista"], "DataObject"):
    _import_module(".pyvista", __name__)
