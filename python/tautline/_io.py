# SPDX-License-Identifier: BSD-3-Clause
"""Meshes as arguments, from files and to files."""

from __future__ import annotations

import gzip
import os
import shutil
import warnings
import zlib
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Callable, Union

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet, vtkDataObject, vtkDataSet, vtkPointSet

from ._array_templates import ARRAY_TEMPLATES, rewrite_arrays
from ._arrays import Array, keep_source, leaves, source_of
from ._arguments import number, picked
from ._errors import Error, checked, interruptible, plain, run, watch
from ._files import check_input, check_target, file_name, require_memory
from ._foam_case import FOAM, write_case
from ._formats import FLUENT_READER, FORMATS, Format
from ._groups import Groups, with_groups
from ._interrupts import Progress, updating
from ._grid_checks import check_grid, mark_attributes, same_cells, writable
from ._legacy import check_counts, scan_legacy
from ._mesh import from_arrays
from ._meshio import MESHIO_FORMATS, check_installed, from_meshio, is_meshio, meshio_of, read_meshio, write_meshio
from ._nastran import NASTRAN_ENDINGS, write_nastran
from ._reading import answer, read_apart
from ._su2 import read_su2, write_su2
from ._surfaces import check_surface
from ._template import LOCATORS, rewrite
from ._unv import read_unv
from ._vtk import CLASSES
from ._views import MeshViews, viewed
from ._vtk_readers import (
    EXODUS_ENDINGS,
    SERIES,
    SOLVER_FORMATS,
    SolverFormat,
    check_content,
    is_ucd,
    read_series,
    read_solver,
    series,
    times_of,
)
from ._vtk_writers import block_files, write_composite, write_data

#: Types that every function accepts as a mesh: a vtkDataSet, a composite data set, a file name, the result of another
#: function, (points, cells), see from_arrays(), a mesh of meshio, or one of PyVista, which is a vtkDataSet.
Mesh = Union[vtkDataObject, str, PathLike[str], "tuple[Any, Any]", Any]

# VTK 9.1 and 9.2 with the expat of today's Debian 12 (VTK issue 19258).
_APPENDED = (
    "The file has appended data, which VTK before 9.3 cannot read with a recent libexpat: "
    "save it with the data mode Binary or Ascii."
)
# Files that name other files: of the pieces of one mesh, and of blocks.
_IN_PIECES = (".pvtu", ".pvtp")
_REFERRING = (".vtm", *_IN_PIECES)
# Multiple of a compressed file's size: text, bytes, expanded bytes, the mesh and the buffers of the reader.
_MEMORY_PER_BYTE = 8
#: How to convert formats that nothing here reads.
_CONVERTERS = {
    ".h5": "of Fluent, save the case in the legacy format, .cas: in its console, file/cff-files? no",
    ".step": "it is a geometry without a mesh: mesh it with Gmsh",
    ".stp": "it is a geometry without a mesh: mesh it with Gmsh",
    ".iges": "it is a geometry without a mesh: mesh it with Gmsh",
    ".pos": "it holds views without their mesh: write .msh",
    ".geo": "it is a geometry without a mesh: mesh it with Gmsh",
    ".solb": "save it as text, .sol, with the program that wrote it",
    ".cdb": "save it as Nastran .bdf in ANSYS",
    ".ans": "save it as Nastran .bdf in ANSYS",
}
SU2, UNV = ".su2", ".unv"
# Files compressed by gzip, of formats whose meshes are in one file.
_COMPRESSED = ".gz"
_OF_ONE_FILE = (
    ".msh", ".msh2", ".msh4", ".mesh", ".meshb", ".inp", ".bdf", ".nas", ".fem", ".su2", ".unv", ".off", ".vtk", ".vtu",
    ".vtp", ".stl", ".ply", ".obj", ".cas",
)  # fmt: skip
_ALWAYS_BINARY = ".meshb"
_MFEM, _MFEM_SPACES = ".mesh", ("H1", "L2")
# Options of read() for OpenFOAM, and of write().
_FOAM_OPTIONS, _KEEP_ORIGINAL = ("lower_cells", "region", "decomposed"), "keep_original"
# Formats whose readers in VTK crash on damaged files.
_UNSAFE = (".ply", ".obj")
# Formats of VTK that are templates by their data.
_VTK_TEMPLATES = (".vtk", ".vtu")
# Formats with cells that are only read on demand, and with more than a mesh.
_WITH_LOWER_CELLS = (".msh", ".mesh", ".meshb", ".su2", ".unv", ".inp", ".bdf", ".nas", ".fem")
_MODELS = (".unv", ".inp", ".bdf", ".nas", ".fem")
# Relative to the extent of a mesh: a larger rounding of coordinates causes a warning.
_ROUNDING = 1e-9
# For one file; a damaged one may have thousands.
_MOST_MESSAGES = 5


def as_mesh(mesh: Mesh) -> vtkDataObject:
    """The VTK data object of a mesh given in any way; a file is read. Raises Error for anything that is not a mesh."""
    if isinstance(mesh, (vtkDataSet, vtkCompositeDataSet)):
        if isinstance(mesh, MeshViews):
            mesh.refresh()
        return mesh
    if isinstance(mesh, (str, PathLike)):
        return read(mesh)
    if isinstance(mesh, (tuple, list)) and len(mesh) == 2:
        return from_arrays(*mesh)
    if is_meshio(mesh):
        grid = from_meshio(mesh)
        check_grid(grid)
        return grid
    inner = getattr(mesh, "mesh", None)  # of a result
    if isinstance(inner, (vtkDataSet, vtkCompositeDataSet)):
        return as_mesh(inner)
    if hasattr(mesh, "IsA") and mesh.IsA("vtkDataSet"):
        raise Error(f"this {type(mesh).__name__} is of another VTK than Tautline's; save it as .vtu and read that")
    raise Error(f"a mesh is a vtkDataSet, a file name or (points, cells), not {type(mesh).__name__}")


@interruptible
def read(
    file: str | PathLike[str],
    *,
    progress: Progress | bool | None = None,
    **options: Any,
) -> vtkDataObject:
    """Read a mesh. The ending of the file name decides on the format.

    Parameters
    ----------
    file : str or path
        VTK (.vtk .vtu .vtp .vti .vtr .vts .vtm .pvtu .pvtp .ply .stl .obj), or, where the module of readers was built,
        TetGen and Triangle (.node .ele .face .edge .poly .smesh), Medit (.mesh .meshb .sol), Gmsh and FreeFem++ (.msh),
        OFF (.off .coff .noff .cnoff), Abaqus and CalculiX (.inp), Nastran (.bdf .nas .fem), the mesh of an OpenFOAM
        case (.foam, a file in its directory, which may be empty), the mesh of Fluent (.cas, and .msh that begin with a
        parenthesis), without results. Formats of solvers: SU2, universal files (.unv), Exodus (.e .exo .ex2), CGNS,
        XDMF (.xmf .xdmf), AVS UCD (.avs .ucd .inp), EnSight (.case), Gambit (.neu), Tecplot (.tec); .pvd; and where
        meshio is installed MED, Netgen (.vol) and others, see formats(). Single-file formats also with .gz behind
        their ending.
    **options
        lower_cells (False): also read boundary triangles beside tetrahedra, and edges beside triangles; for the formats
        of mesh generators, Abaqus, Nastran, SU2 and .unv; for OpenFOAM and Fluent the faces of the patches, by default
        True. region (""), for OpenFOAM: the mesh in constant/region. decomposed, for OpenFOAM: True merges the meshes
        of the processors, False reads the one in constant; the default is the latter if it is there. time: the
        time step to read, the nearest to this number, see times(); the default is the first. For the formats of
        solvers and .pvd.
    progress : bool or callable, optional
        True: a bar on the terminal, if there is one. Otherwise a function, called ten times a second with the fraction
        done, 0 to 1, and a text; it cancels by returning False, which raises Aborted. Ctrl-C raises KeyboardInterrupt.

    Returns
    -------
    vtkDataObject
        A vtkDataSet with the attributes points, cells, point_data and cell_data, numpy arrays; of .vtm and some .vtk
        files a composite data set. The pieces of a .pvtu or .pvtp file come one after the other, without their ghost
        cells and with the points of each: every function treats the points on their seams as one
        (merge_coincident_points).

    Raises
    ------
    Error
        If the file cannot be read, is truncated or damaged; with file and line where they are known. Only a .vtk file
        that ends between two sections, or inside the last number of one, cannot be distinguished from a complete file.

    Examples
    --------
    >>> mesh = tautline.read("part.msh", lower_cells=True)
    """
    name = file_name(file)
    mesh = _read_compressed(name, options) if name.lower().endswith(_COMPRESSED) else _read(name, options)
    for leaf in leaves(mesh):
        check_grid(leaf, name)
    made = viewed(mesh)
    keep_source(made, os.path.abspath(name))
    return made


def _read_compressed(name: str, options: dict[str, Any]) -> vtkDataObject:
    """Read a file of one of the formats of a single file, compressed by gzip."""
    inner = os.path.basename(name[: -len(_COMPRESSED)])
    if Path(inner).suffix.lower() not in _OF_ONE_FILE:
        raise Error(f"{name}: compressed files are read of {' '.join(_OF_ONE_FILE)}; decompress it with gunzip")
    check_input(name)
    with TemporaryDirectory(prefix="tautline-") as folder:
        expanded = os.path.join(folder, inner)
        try:
            with gzip.open(name, "rb") as source, open(expanded, "wb") as target:
                shutil.copyfileobj(source, target)
        except (OSError, EOFError, zlib.error) as error:
            raise Error(f"{name}: cannot be decompressed: {error}") from None
        try:
            return _read(expanded, options)
        except Error as error:
            raise Error(str(error).replace(expanded, name)) from None


def _read(name: str, options: dict[str, Any]) -> vtkDataObject:
    """Read a file with the reader of its format, which may return cells and arrays that do not fit each other."""
    ending = Path(name).suffix.lower()
    time = options.pop("time", None)
    ucd = ending == ".inp" and os.path.isfile(name) and is_ucd(name)
    if ucd or ending not in FORMATS or not FORMATS[ending].reader:
        return _read_other(name, ending, options, None if time is None else number("time", time))
    if time is not None:
        raise Error(f"{name}: '{ending}' has no time steps; leave out time")
    form = FORMATS[ending]
    _check_options(name, ending, options, *(_FOAM_OPTIONS if ending == FOAM else ["lower_cells"] if form.own else []))
    check_input(name)
    if form.own:
        reader = form.make_reader(name)
        reader.SetLowerCells(options.get("lower_cells", bool(reader.GetLowerCells())))
        if ending == FOAM:
            reader.SetRegionName(options.get("region", ""))
            decomposed = options.get("decomposed")
            reader.SetCaseType(
                reader.AUTOMATIC if decomposed is None else reader.DECOMPOSED if decomposed else reader.RECONSTRUCTED
            )
        reader.SetFileName(name)
        for text in dict.fromkeys(run(reader).warnings):
            warnings.warn(text, stacklevel=5)  # the caller of read()
        return reader.GetOutput()
    if _may_crash(name, ending):
        if os.path.getsize(name):
            check_surface(name)  # before a process is started for it
        return read_apart(name, {}, lambda: _read_vtk(name, form))
    return _read_vtk(name, form)


def _is_fluent(name: str) -> bool:
    """Whether a file is in Fluent's format, including .msh files, which can be Gmsh's instead."""
    return bool(CLASSES[FLUENT_READER]().CanReadFile(name)) if FLUENT_READER in CLASSES else False


def _may_crash(name: str, ending: str) -> bool:
    """Whether a reader of VTK trusts the file's contents: lists of vertices, the faces of polyhedra."""
    if ending == ".vtu":
        return b'Name="faces"' in Path(name).read_bytes()
    return ending in _UNSAFE


def read_for_another() -> None:
    """Read a file, or its time steps, in a process that read_apart() has started."""
    answer(lambda request: _times(request["name"]) if request.get("times") else _read_checked(request))


def _read_checked(request: dict[str, Any]) -> vtkDataObject:
    options = {} if request.get("time") is None else {"time": request["time"]}
    mesh = _read(request["name"], options)
    for leaf in leaves(mesh):
        check_grid(leaf, request["name"])
    return mesh


def _times(name: str) -> list[float]:
    return times_of(name, SOLVER_FORMATS[Path(name).suffix.lower()])


def _read_other(name: str, ending: str, options: dict[str, Any], time: float | None) -> vtkDataObject:
    """Read a file of a solver with a reader of VTK, otherwise with meshio."""
    if ending not in readable():
        raise Error(f"{name}: no reader for '{ending}'{_tool(ending)}; there are {' '.join(readable())}")
    _check_options(name, ending, options, *(["lower_cells"] if ending in (SU2, UNV) else []))
    check_input(name)
    if os.path.getsize(name) == 0:
        raise Error(f"{name}: the file is empty")
    if ending == SERIES:
        return read_series(name, time, read)
    form = SOLVER_FORMATS.get(ending) or (SOLVER_FORMATS[".avs"] if ending == ".inp" and is_ucd(name) else None)
    if form is None:
        if time is not None:
            raise Error(f"{name}: '{ending}' has no time steps; leave out time")
        if ending == SU2:
            return read_su2(name, **options)
        if ending == UNV:
            return read_unv(name, **options)
        check_installed(name)
        return read_apart(name, {}, lambda: read_meshio(name))
    known = form
    check_content(name, known)  # before a process is started for it
    return read_apart(name, {"time": time}, lambda: _read_with(name, known, time))


def _read_with(name: str, form: SolverFormat, time: float | None) -> vtkDataObject:
    """Read a file with a reader of VTK; each of its messages is an error."""
    with _CapturedOutput() as captured:
        try:
            mesh = read_solver(name, form, time)
        except Error as error:
            text = str(error).removeprefix(f"{name}: ")
            raise Error("\n".join(dict.fromkeys([f"{name}: {text}", *captured()]))) from None
        if found := captured():
            raise Error("\n".join([f"{name}: the file is truncated or damaged:", *found[:_MOST_MESSAGES]]))
    return mesh


def readable() -> list[str]:
    """The endings of the files that read() takes, whether meshio is installed or not."""
    own = {ending for ending, form in FORMATS.items() if form.reader}
    return sorted({*own, *SOLVER_FORMATS, SERIES, SU2, UNV, *MESHIO_FORMATS})


def _tool(ending: str) -> str:
    """How to convert files that nothing here reads."""
    return f": {_CONVERTERS[ending]}" if ending in _CONVERTERS else ""


@checked
def times(file: str | PathLike[str]) -> list[float]:
    """The time steps of a file (Exodus, CGNS, XDMF, EnSight, .pvd), for the option `time` of read().

    Parameters
    ----------
    file : str or path
        The file; other formats have no time steps.

    Returns
    -------
    list[float]

    Examples
    --------
    >>> [tautline.quality(tautline.read("run.e", time=t)).inverted for t in tautline.times("run.e")]
    """
    name = file_name(file)
    ending = Path(name).suffix.lower()
    if ending not in readable():
        raise Error(f"{name}: no reader for '{ending}'{_tool(ending)}; there are {' '.join(readable())}")
    check_input(name)
    if ending == SERIES:
        return sorted({when for when, _ in series(name)})
    if ending not in SOLVER_FORMATS:
        return []
    steps: list[float] = read_apart(name, {"times": True}, lambda: _times(name))
    return steps


@interruptible
def write(
    mesh: Mesh,
    file: str | PathLike[str],
    *,
    groups: Groups | None = None,
    template: str | PathLike[str] | bool | None = None,
    progress: Progress | bool | None = None,
    **options: Any,
) -> list[str]:
    """Write a mesh. The ending of the file name decides on the format.

    Parameters
    ----------
    mesh : Mesh
        A vtkDataSet, a composite data set, the result of another function, a file name or (points, cells).
    file : str or path
        VTK (.vtk .vtu .vtp .vti .vtr .vts .vtm .ply .stl), always binary and compressed where the format can be; or,
        where the module of readers was built, TetGen and Triangle (.node .ele .face .edge .poly .smesh), Medit (.mesh
        .meshb), MFEM (.mesh, see options), Gmsh (.msh, and .pos: a view for each array), OFF (.off).
    groups : Groups, optional
        Sets of cells by name: numbers of cells from 0, or a mask of one value per cell; see QualityResult.groups().
        They are element sets in Abaqus's .inp and groups in Salome's .med, in other files cell arrays of 0 and 1.
    template : str, path or bool, optional
        The file that the mesh was read from, of the same format. The output is a copy of it in which only the
        coordinates change: markers, sets, materials, types of elements, comments and the format of the
        numbers stay. The mesh must have the cells of that file, in its order, as after untangle(), optimize(), warp()
        and perturb(); its arrays are not written. For .msh, .mesh, .meshb, .su2, .inp, .bdf .nas .fem, .unv, .off, .vtk
        and .vtu; Salome's .med, CGNS, Exodus and MOAB's .h5m, where h5py is installed (Exodus also without it, unless
        it is in HDF5); .foam: the points of the case, or of a copy of it if the file is in another directory, which
        must be empty. The default, for the results of these functions: the file that the mesh was read from if it is
        of the same format, except VTK's. False: none; the mesh is written with its arrays.
    **options
        binary (False): write .msh as bytes. Not for VTK's formats. mfem: "H1" or "L2" write .mesh for MFEM, with nodes
        that neighbors share, or with nodes of each element; the default is Medit's .mesh, which has no curved cells.
        keep_original (False), for .foam: keep the replaced file of points as points.orig, unless there is one.
    progress : bool or callable, optional
        True: a bar on the terminal, if there is one. Otherwise a function, called ten times a second with the fraction
        done, 0 to 1, and a text; it cancels by returning False, which raises Aborted. Ctrl-C raises KeyboardInterrupt.

    Returns
    -------
    list[str]
        The names of the files written.

    Raises
    ------
    Error
        If the format cannot hold the mesh, or if a file cannot be written.

    Notes
    -----
    A file is replaced as a whole: whatever happens, there is the older file or the complete new one. Where `file` is a
    link, the file it points to is replaced. The blocks of a .vtm file are in a directory beside it.
    """
    name = file_name(file)
    ending = Path(name).suffix.lower()
    if ending == FOAM and ending in FORMATS and template is not False and groups is None:
        return _write_foam(mesh, name, template, options)
    if template is not None and not isinstance(template, bool):
        if groups is not None or options:
            raise Error(f"{name}: with a template there are no groups and no other options")
        check_target(name)
        return _write_like(as_mesh(mesh), name, file_name(template))
    source = _source_for(mesh, name) if template is not False and groups is None and not options else ""
    form = check_output(name, source)
    if source:
        try:
            return _write_like(as_mesh(mesh), name, source)
        except Error as error:
            try:
                check_output(name)
            except Error:  # there is no writer, only a copy is possible
                raise error from None
            warnings.warn(f"{error}; {name} is written without it", stacklevel=4)
    if form is None:
        _check_options(name, ending, options)
        one = as_data_set(mesh)
        check_grid(one)
        if ending in MESHIO_FORMATS:
            return write_meshio(one, name, groups)
        if groups is not None:
            raise Error(f"{name}: '{ending}' has no groups of cells; write .vtu, .inp or .med")
        return write_su2(one, name) if ending == SU2 else write_nastran(one, name)
    known = {key: value for key, value in options.items() if key != "mfem" or ending != _MFEM}
    _check_options(name, ending, known, *(["binary"] if form.own else []))
    data = as_mesh(mesh) if groups is None else with_groups(as_mesh(mesh), groups)
    for leaf in leaves(data):
        check_grid(leaf)
    if not _holds(form, data):
        able = [key for key, other in FORMATS.items() if other.writer and not other.own and _holds(other, data)]
        raise Error(f"{name}: '{ending}' cannot hold a {data.GetClassName()}; {' '.join(able)} can")
    if form.own:
        return _write_own(data, name, _own_writer(form, name, **options))
    return write_composite(data, name) if ending == ".vtm" else write_data(data, name, form)


def _write_foam(
    mesh: Mesh, name: str, template: str | PathLike[str] | bool | None, options: dict[str, Any]
) -> list[str]:
    """Write the points of a mesh into the case that it was read from, or into a copy."""
    _check_options(name, FOAM, options, _KEEP_ORIGINAL)
    check_target(name)
    data = as_data_set(mesh)
    source = source_of(data) if template is None or isinstance(template, bool) else file_name(template)
    if Path(source).suffix.lower() not in ("", FOAM):
        raise Error(f"{name}: the template {source} is of another format")
    writer = CLASSES["vtkFoamPointsWriter"]()
    writer.SetKeepOriginal(options.get(_KEEP_ORIGINAL, False))
    known = source if os.path.isfile(source) else ""
    files = write_case(name, known, lambda target: _write_own(data, target, writer))
    _warn_of_rounding(name, writer.GetRounding(), [data])
    return files


def _warn_of_rounding(name: str, rounding: float, meshes: list[vtkDataSet]) -> None:
    extents = (mesh.GetBounds() for mesh in meshes)
    extent = max(max(bounds[1::2][axis] - bounds[::2][axis] for axis in range(3)) for bounds in extents)
    if rounding > _ROUNDING * extent:
        warnings.warn(f"{name}: the fields of the file round coordinates by up to {rounding:.2g}", stacklevel=6)


def _source_for(mesh: Mesh, name: str) -> str:
    """The file whose points a result has moved, if it can be the template; otherwise ""."""
    inner = getattr(mesh, "mesh", None)
    source = source_of(inner) if inner is not None and hasattr(mesh, "displacement") else ""
    known = source and os.path.isfile(source) and can_be_template(source, name)
    return source if known and not _is_fluent(source) else ""


def is_template(ending: str) -> bool:
    """Whether files with an ending can be templates of write() here."""
    if ending in ARRAY_TEMPLATES:
        older = ending in EXODUS_ENDINGS  # netCDF, without HDF5
        return ending in readable() and (older or find_spec("h5py") is not None)
    return ending in LOCATORS or ending in _VTK_TEMPLATES or (ending == FOAM and ending in FORMATS)


def can_be_template(source: str, target: str) -> bool:
    """Whether a file can be the template of another one: both are of one format, and of one for which that is useful.

    Files of VTK have everything in the mesh.
    """
    ending = Path(target).suffix.lower()
    return ending in (*LOCATORS, *ARRAY_TEMPLATES, FOAM) and ending == Path(source).suffix.lower()


def losses(source: str) -> str:
    """The contents of a file beside the mesh that is read from it, in words; "" if nothing."""
    ending = Path(source).suffix.lower()
    found = []
    if ending in _WITH_LOWER_CELLS:
        all_, own = (read(source, lower_cells=lower).GetNumberOfCells() for lower in (True, False))
        if all_ > own:
            found.append(f"{all_ - own} boundary cells and their groups")
    if ending in _MODELS:
        found.append("materials, properties, loads and comments")
    return " and ".join(found)


def _write_like(data: vtkDataObject, name: str, source: str) -> list[str]:
    """Write a copy of a file with the coordinates of a mesh."""
    ending = Path(name).suffix.lower()
    if ending != Path(source).suffix.lower():
        raise Error(f"{name}: the template {source} is of another format")
    if _is_fluent(source):
        raise Error(f"{name}: the template {source} is of Fluent, whose files do not come back; leave out template")
    if ending not in LOCATORS and ending not in _VTK_TEMPLATES and ending not in ARRAY_TEMPLATES:
        known = " ".join(sorted([*LOCATORS, *_VTK_TEMPLATES, *ARRAY_TEMPLATES]))
        raise Error(f"{name}: files '{ending}' cannot be templates; these can: {known}")
    lower = ending in (SU2, UNV) or (ending in FORMATS and FORMATS[ending].own)
    with warnings.catch_warnings():  # these were issued when the mesh was read
        warnings.simplefilter("ignore")
        found = read(source)
        if lower and isinstance(found, vtkDataSet) and _cells(found) != _cells(data):
            found = read(source, lower_cells=True)
    mine, its = list(leaves(data)), list(leaves(found))
    if len(its) > 1 and ending not in ARRAY_TEMPLATES:
        raise Error(f"{name}: a template holds one mesh, not a {found.GetClassName()}")
    if not all(isinstance(leaf, vtkPointSet) for leaf in (*mine, *its)):
        raise Error(f"{name}: a template holds a mesh with points of its own, not a {found.GetClassName()}")
    if len(mine) != len(its) or not all(map(same_cells, its, mine)):
        raise Error(f"{name}: the mesh has other cells or another number of points than the template {source}; leave "
                    "out template")  # fmt: skip
    if ending in _VTK_TEMPLATES:
        made = found.NewInstance()
        made.ShallowCopy(found)
        made.SetPoints(mine[0].GetPoints())
        return write_data(made, name, FORMATS[ending])
    before, after = ([_coordinates(leaf) for leaf in parts] for parts in (its, mine))
    if not all(np.isfinite(part).all() for part in after):
        raise Error(f"{name}: a coordinate is not finite")
    if _is_curved_mfem(source):
        writer = CLASSES["vtkMfemWriter"]()
        writer.SetTemplateFileName(os.path.abspath(source))
        return _write_own(mine[0], name, writer)
    if ending in ARRAY_TEMPLATES:
        rounding = rewrite_arrays(source, name, ending, before, after)
    else:
        rounding = rewrite(source, name, before[0], after[0])
    _warn_of_rounding(name, rounding, mine)
    return [name]


def _cells(data: vtkDataObject) -> int:
    return sum(leaf.GetNumberOfCells() for leaf in leaves(data))


def _coordinates(mesh: vtkPointSet) -> Array:
    return np.array(vtk_to_numpy(mesh.GetPoints().GetData()), float)


@checked
def to_meshio(mesh: Mesh) -> Any:
    """The mesh of meshio of a mesh, with its point and cell arrays.

    Parameters
    ----------
    mesh : Mesh
        A vtkDataSet, a file name, the result of another function, or (points, cells).

    Returns
    -------
    Any

    Raises
    ------
    Error
        If meshio is not installed, and for cells that it lacks. Functions take meshes of meshio as they are.

    Examples
    --------
    >>> tautline.to_meshio(tautline.untangle("part.vtu")).write("part.xdmf")
    """
    return meshio_of(as_data_set(mesh))


def check_output(file: str | PathLike[str], source: str = "") -> Format | None:
    """The format of a mesh to be written; None: SU2, Nastran, or meshio writes it, or it is a copy of `source`.

    source: the file the mesh was read from. Raises Error if there is no writer for the format or no file can be made
    there.
    """
    name = file_name(file)
    ending = Path(name).suffix.lower()
    if ending == SU2 or ending in NASTRAN_ENDINGS:
        check_target(name)
        return None
    if (ending not in FORMATS or not FORMATS[ending].writer) and can_be_template(source, name):
        check_target(name)
        return None
    if ending in MESHIO_FORMATS:
        check_installed(name)
        check_target(name)
        return None
    if ending not in FORMATS or not FORMATS[ending].writer:
        known = " ".join(sorted(key for key, form in FORMATS.items() if form.writer))
        raise Error(f"{name}: no writer for '{ending}'; there are {known}")
    check_target(name)
    return FORMATS[ending]


def as_data_set(mesh: Mesh) -> vtkDataSet:
    """as_mesh() for functions that do not take composite data. Raises Error for these."""
    data = as_mesh(mesh)
    if isinstance(data, vtkDataSet):
        return data
    raise Error(f"one mesh is expected, not a {data.GetClassName()}; take one of its blocks, or Merge Blocks first")


def _check_options(name: str, ending: str, options: dict[str, Any], *known: str) -> None:
    unknown = [option for option in options if option not in known]
    if unknown:
        plural = "s" if len(known) > 1 else ""
        options_of = f"the option{plural} {', '.join(known)}" if known else "no options"
        raise Error(f"{name}: '{ending}' has {options_of}, not {', '.join(unknown)}")


def _holds(form: Format, data: vtkDataObject) -> bool:
    return form.holds is None or bool(data.IsA(form.holds))


def _read_vtk(name: str, form: Format) -> vtkDataObject:
    """Read a file with a reader of VTK; every message is an error, although the reader returns a partial mesh."""
    if os.path.getsize(name) == 0:
        raise Error(f"{name}: the file is empty")
    require_memory(_MEMORY_PER_BYTE * os.path.getsize(name), f"reading {name}")
    if Path(name).suffix.lower() in _REFERRING:
        for block in block_files(name):
            check_input(block)
    legacy = form.module == "vtkIOLegacy"
    announced = scan_legacy(name) if legacy else {}
    check_surface(name)
    reader = form.make_reader()
    reader.SetFileName(name)
    with _CapturedOutput() as captured:
        messages = watch(reader)
        try:
            run(reader, messages)
        except Error as error:
            details = [text for text in captured() if text not in str(error)]
            details += [_APPENDED] if b"<AppendedData" in Path(name).read_bytes() else []
            raise Error("\n".join([f"{name}: {error}", *details])) from None
        mesh = reader.GetOutputDataObject(0)
        found = dict.fromkeys(messages.warnings + captured())
    if found:
        raise Error("\n".join([f"{name}: the file is truncated or damaged:", *list(found)[:_MOST_MESSAGES]]))
    if not isinstance(mesh, (vtkDataSet, vtkCompositeDataSet)):
        raise Error(f"{name}: holds no mesh ({mesh.GetClassName() if mesh else 'nothing'})")
    if legacy:
        check_counts(name, mesh, announced)
        for leaf in leaves(mesh):
            mark_attributes(leaf)
    if Path(name).suffix.lower() in _IN_PIECES:
        _remove_ghosts(mesh)
    return mesh


def _remove_ghosts(mesh: vtkDataSet) -> None:
    """Remove the ghost cells of a vtkUnstructuredGrid or vtkPolyData, which are also in another piece."""
    if not mesh.HasAnyGhostCells():
        return
    mesh.RemoveGhostCells()
    if mesh.IsA("vtkUnstructuredGrid"):  # VTK leaves one extra entry
        cells = mesh.GetCells()
        last = int(cells.GetOffsetsArray().GetTuple1(cells.GetNumberOfCells()))
        cells.GetConnectivityArray().SetNumberOfTuples(last)


def _own_writer(form: Format, name: str, binary: bool = False, mfem: str | None = None) -> Any:
    """The writer of one of the formats of mesh generators, with the options of write()."""
    if mfem is not None:
        writer = CLASSES["vtkMfemWriter"]()
        writer.SetContinuous(picked("mfem", mfem, _MFEM_SPACES) == _MFEM_SPACES[0])
        return writer
    writer = form.make_writer()
    if hasattr(writer, "SetBinary"):
        writer.SetBinary(binary)
    elif binary and Path(name).suffix.lower() != _ALWAYS_BINARY:
        raise Error(f"{name}: '{Path(name).suffix}' is always text")
    return writer


def _is_curved_mfem(source: str) -> bool:
    """Whether a file is one of MFEM with nodes, which are not the coordinates of the points."""
    if Path(source).suffix.lower() != _MFEM:
        return False
    content = Path(source).read_bytes()
    return content.lstrip().startswith(b"MFEM") and b"FiniteElementCollection" in content


def _write_own(data: vtkDataSet, name: str, writer: Any) -> list[str]:
    writer.SetInputData(writable(data))
    writer.SetFileName(name)
    messages = watch(writer)
    with updating(writer):
        written = writer.Write()
    messages.raise_errors()
    for text in dict.fromkeys(messages.warnings):
        warnings.warn(text, stacklevel=5)  # the caller of write()
    if not written:
        raise Error(f"{name}: cannot be written")
    return [writer.GetFileWritten(i) for i in range(writer.GetNumberOfFilesWritten())]


class _CapturedOutput:
    """Captures the output of VTK's internal helper objects, which cannot be observed, as a list of texts."""

    def __enter__(self) -> Callable[[], list[str]]:
        self.window = vtkStringOutputWindow()
        self.before = vtkOutputWindow.GetInstance()
        vtkOutputWindow.SetInstance(self.window)
        self.verbosity = vtkLogger.GetCurrentVerbosityCutoff()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
        return self.texts

    def texts(self) -> list[str]:
        output = self.window.GetOutput() or ""
        if isinstance(output, bytes):  # quotes from a binary file
            output = output.decode(errors="backslashreplace")
        return [plain(text) for text in output.split("\n\n") if text.strip()]

    def __exit__(self, *_: Any) -> None:
        vtkOutputWindow.SetInstance(self.before)
        vtkLogger.SetStderrVerbosity(self.verbosity)
