"""Measure, repair, warp and match meshes with VTK."""

from importlib import import_module as _import_module
from pkgutil import iter_modules as _iter_modules

# Every compiled module (TautlineQuality, ...) brings its VTK classes into this name space.
for _found in _iter_modules(__path__):
    if _found.name.startswith("Tautline"):
        _compiled = _import_module("." + _found.name, __name__)
        globals().update({k: v for k, v in vars(_compiled).items() if k.startswith("vtk")})
