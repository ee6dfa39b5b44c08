"""Measure, repair, warp and match meshes with VTK.

>>> import tautline as tl
>>> worse = tl.perturb("part.vtu", fraction=0.5, seed=1)
>>> tl.quality(worse, ["imr", "radius_ratio"]).statistics["imr"]["worst"]

The verbs take a mesh as a vtkDataSet, a file name or (points, cells) numpy arrays and never change it;
they return a result with `.mesh`. Whatever goes wrong is a tautline.Error. The VTK classes (vtkElementQuality,
...) are here too. `python3 -m tautline --help` tells how to run the verbs from a shell.
"""

from importlib import import_module as _import_module
from pkgutil import iter_modules as _iter_modules

from ._errors import Error

# Every compiled module (TautlineQuality, ...) brings its VTK classes into this name space.
for _found in _iter_modules(__path__):
    if _found.name.startswith("Tautline"):
        _compiled = _import_module("." + _found.name, __name__)
        globals().update({k: v for k, v in vars(_compiled).items() if k.startswith("vtk")})

# The verbs, which use these classes.
from ._io import read, write  # noqa: E402
from ._mesh import Mesh, from_arrays  # noqa: E402
from ._metrics import metrics  # noqa: E402
from ._quality import Quality, quality  # noqa: E402
from ._verbs import Comparison, Field, Perturbed, compare, metric_field, perturb  # noqa: E402
from ._optimization import Optimized, Untangled, optimize, untangle  # noqa: E402

try:
    from ._inputs import domain, domains  # noqa: E402
except ImportError:  # built without the modules of readers and domains
    pass

try:
    from ._deformation import Warped, warp  # noqa: E402
except ImportError:  # built without the module of deformation
    pass

try:
    from ._shapes import Match, Retrieved, SilhouetteMesh, match, read_silhouettes, retrieval, silhouette  # noqa: E402
except ImportError:  # built without the module of shapes
    pass

try:
    from ._conditioning import Conditioned, Solved, Study, condition, solve, solver_combinations, solver_study  # noqa: E402
except ImportError:  # built without the module of linear systems
    pass

try:
    from ._peridynamics import Peridynamics, collar, peridynamics  # noqa: E402
except ImportError:  # built without the module of nonlocal models
    pass
