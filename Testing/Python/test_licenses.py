# SPDX-License-Identifier: BSD-3-Clause
"""test_licenses.py SOURCE_TREE LIBRARIES [PROGRAM]: what is linked and loaded, against the table of the licenses.

The import of the package loads nothing under the GPL or AGPL; a solver loads PETSc. Every binary in LIBRARIES and below
links what Plugin/Site/licenses.md lists.
"""

import re
import subprocess
import sys
from pathlib import Path

from checks import DATA, run_tests

import tautline
from tautline import _vtk

SOURCE, LIBRARIES = Path(sys.argv[1]), Path(sys.argv[2])
PROGRAMS = [Path(name) for name in sys.argv[3:] if name]
PAGE = SOURCE / "Plugin" / "Site" / "licenses.md"
#: TetGen, CGAL and its arithmetic; what brings FFTW, UMFPACK and others.
UNWANTED = re.compile(r"lib(tet|CGAL|gmp|mpfr|petsc|slepc|fftw|umfpack|spqr|cholmod|TautlineSolvers)\w*[.-]")
MAPPED = 'print(*{line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}, sep="\\n")'
#: The C and C++ runtime.
RUNTIME = re.compile(r"(lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+|asan|ubsan)|ld-linux[\w-]*)\.so")
GROUPS = {
    "ParaView": re.compile(r"lib(pq|vtk(PV|Remoting|GUISupportQt))\w*-pv"),
    "VTK": re.compile(r"libvtk"),
    "Qt": re.compile(r"libQt\d"),
}
SOLVERS = "libTautlineSolvers"
ROWS = {"the plugin": r"plugins/Tautline/Tautline\.so$", "compiled modules": r"/tautline/Tautline\w+\.so$"}


def mapped(code: str) -> set[str]:
    """The libraries in a fresh process after some code."""
    done = subprocess.run([sys.executable, "-c", f"{code}\n{MAPPED}"], capture_output=True, text=True, check=True)
    return {Path(line).name for line in done.stdout.splitlines() if "/" in line}


def test_import():
    loaded = mapped("import tautline")
    assert not {name for name in loaded if UNWANTED.match(name)}, loaded
    assert any(name.startswith("libTautlineQuality") for name in loaded), loaded
    loaded = mapped(f"import tautline as tl; tl.tet_mesh({str(DATA / 'cube.smesh')!r}); tl.domain('disk2d')")
    assert not {name for name in loaded if UNWANTED.match(name)}, loaded


def test_solver():
    """Also whether the check finds anything."""
    loaded = mapped("import tautline as tl; tl.vtkMeshWarp")
    assert any(name.startswith("libpetsc") for name in loaded) and any(map(UNWANTED.match, loaded)), loaded


def test_later():
    """The classes that are imported on use belong to their modules, and attributes of the package before."""
    for module in sorted(set(_vtk.LATER.values())):
        names = {name for name, of in _vtk.LATER.items() if of == module}
        assert names <= set(dir(tautline)) and names <= set(tautline.__all__), names - set(dir(tautline))
        assert all(getattr(tautline, name).__module__.endswith(module) for name in names)
        assert names == {name for name in vars(sys.modules[f"tautline.{module}"]) if name.startswith("vtk")}, names
    assert not hasattr(tautline, "vtkNoSuchClass")


def test_text_of_the_agpl():
    """The meshers go with the whole license, which Debian does not install elsewhere, in the form of its files."""
    text = (SOURCE / "Plugin" / "Packaging" / "notices" / "meshers").read_text()
    begin, end = text.index("GNU AFFERO GENERAL PUBLIC LICENSE"), text.index("END OF TERMS AND CONDITIONS")
    sections = re.findall(r"^ (\d+)\. [A-Z]", text[begin:end], re.MULTILINE)
    assert sections == [str(number) for number in range(18)], sections
    assert all(line.startswith(" ") and line.strip() for line in text[begin:].splitlines()[1:])


def needed(binary: Path) -> set[str]:
    """The names of the libraries that a binary links."""
    text = subprocess.run(["readelf", "-d", str(binary)], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", text))


def links(binary: Path) -> set[str]:
    """The libraries that a binary links, as in the table; the solvers also through a linked library of Tautline."""
    found = set()
    for name in needed(binary):
        group = next((group for group, names in GROUPS.items() if names.match(name)), "")
        own = name.startswith("libTautline")
        if group:
            found.add(group)
        elif own and (name.startswith(SOLVERS) or SOLVERS in links(LIBRARIES / name)):
            found.add(SOLVERS)
        elif not own and not RUNTIME.match(name):
            found.add(re.sub(r"\.so.*", "", name))
    return found


def table() -> dict[str, set[str]]:
    """The libraries that each binary links, by the name of its row."""
    rows = re.findall(r"^\| (.+?) \| [\w-]+ \| (.*?) ?\| .* \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
    return {name.strip("`"): {link for link in re.split("[,;] ", listed) if link} for name, listed in rows[1:]}


def binaries() -> dict[Path, str]:
    """The binaries of the build, and the names of their rows."""
    found = {}
    for path in [*LIBRARIES.rglob("*.so"), *PROGRAMS]:
        special = next((row for row, pattern in ROWS.items() if re.search(pattern, path.as_posix())), "")
        name = next((row for row in table() if special and special in row), path.name.partition(".")[0])
        found[path] = next((row for row in table() if name in row.split("`")[:2]), name)
    return found


def test_table():
    """Every binary that was built has a row that lists what it links."""
    rows, seen = table(), set()
    assert len(rows) > 15, rows
    for path, row in binaries().items():
        assert row in rows, f"{path} has no row in {PAGE}"
        listed = rows[row] - {SOLVERS} if row.startswith("compiled") else rows[row]
        linked = links(path) - {SOLVERS} if row.startswith("compiled") else links(path)
        assert linked == listed, f"{path} links {sorted(linked)}; {PAGE} lists {sorted(listed)}"
        seen.add(row)
    absent = rows.keys() - seen
    assert not absent or not PROGRAMS or not list(LIBRARIES.rglob("Tautline.so")), f"{absent} were not built"


def test_closure():
    """Without what ParaView, VTK, Qt and PETSc bring, nothing under the GPL is linked, directly or by others."""
    paths = [path for path in binaries() if path not in PROGRAMS]
    assert len(paths) > 10, paths
    for path in paths:
        for name in {link for link in closure(path) if UNWANTED.match(link)}:
            assert re.match(f"lib(petsc|slepc|{SOLVERS[3:]})", name), f"{path} links {name}"


def closure(path: Path) -> set[str]:
    """The libraries that a binary links, and the libraries that these link, except groups and PETSc."""
    found, waiting = set(), [path]
    while waiting:
        for name in needed(waiting.pop()) - found:
            found.add(name)
            place = LIBRARIES / name if (LIBRARIES / name).exists() else INSTALLED.get(name)
            if place and not re.match("lib(petsc|slepc)", name) and not any(g.match(name) for g in GROUPS.values()):
                waiting.append(place)
    return found


CACHE = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
ENTRY = re.compile(r"^\s+(\S+) \(.*\) => (\S+)$", re.MULTILINE)
INSTALLED = {name: Path(path) for name, path in reversed(ENTRY.findall(CACHE))}  # the first counts

run_tests(globals())
