# SPDX-License-Identifier: BSD-3-Clause
"""The functions of the package as methods of PyVista's meshes: mesh.tautline.untangle().

>>> import pyvista, tautline.pyvista
>>> result = pyvista.read("part.vtu").tautline.untangle()
>>> result.inverted, result.mesh.volume  # result.mesh is also a mesh of PyVista

PyVista has to be of the same VTK as Tautline; Debian 12 does not have it. Where it was imported before Tautline,
`import tautline` is enough.
"""

from __future__ import annotations

import functools
import inspect
from dataclasses import is_dataclass, replace
from typing import Any, Callable

import tautline

from ._errors import Error

try:
    import pyvista
except ImportError:
    raise ImportError("pyvista is not installed (Debian 13: apt-get install python3-pyvista)") from None

_MESHES = ("mesh", "input", "before", "boundary")  # first arguments that are meshes


class Accessor:
    """The functions of tautline for one mesh of PyVista, which is their first argument."""

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *_functions()]

    def __getattr__(self, name: str) -> Callable[..., Any]:
        if name not in _functions():
            raise AttributeError(f"tautline has no function '{name}' of a mesh; there are {', '.join(_functions())}")

        function = _functions()[name]

        def method(*arguments: Any, **options: Any) -> Any:
            return wrapped(function(self._mesh, *arguments, **options))

        return functools.update_wrapper(method, function)


def wrapped(result: Any) -> Any:
    """A result whose mesh is one of PyVista; a mesh as one of PyVista; anything else unchanged."""
    if is_dataclass(result) and not isinstance(result, type) and hasattr(result, "mesh"):
        return replace(result, mesh=pyvista.wrap(result.mesh))
    return pyvista.wrap(result) if hasattr(result, "IsA") else result


@functools.lru_cache(maxsize=None)
def _functions() -> dict[str, Callable[..., Any]]:
    """The public functions whose first argument is a mesh, by name."""
    found = {}
    for name in tautline.__all__:
        function = getattr(tautline, name)
        if inspect.isfunction(function) and next(iter(inspect.signature(function).parameters), "") in _MESHES:
            found[name] = function
    return dict(sorted(found.items()))


class _Property:
    """`tautline` as an attribute of PyVista's classes."""

    def __get__(self, mesh: Any, owner: type) -> Any:
        return Accessor if mesh is None else Accessor(mesh)

    def __set__(self, mesh: Any, value: Any) -> None:
        raise Error("mesh.tautline cannot be replaced")


def _register() -> None:
    pyvista.DataObject.tautline = _Property()


_register()
