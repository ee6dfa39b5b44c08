# SPDX-License-Identifier: BSD-3-Clause
"""No failure leaves a part of a file: killed processes, full disks, links, directories without permission, two writers.

Every writer of the package and every own writer that ParaView uses is tried. After each failure the file, and every
file that belongs to it, must be the older or a complete new one.
"""

import argparse
import contextlib
import io
import os
import random
import shutil
import signal
import stat
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import tautline as tl
from checks import DATA, OUT, rejected, shell, square, wording
from tautline import _files, studies
from tautline.__main__ import _parser as shell_parser
from tautline.__main__ import main as shell_main
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkMultiBlockDataSet, vtkPolyData
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter

FOLDER = OUT / "files"
NOBODY = 65534
KILLS = 10  # of each writer
DISK = "512k"
#: Own writers as ParaView's Save Data uses them.
CLASSES = {".mesh": "vtkMeditWriter", ".msh": "vtkGmshWriter", ".off": "vtkOffWriter", ".node": "vtkTetGenWriter"}
SURFACES = (".vtp", ".ply", ".stl", ".off")
MESHES = (".vtu", ".vtk", ".vtm", ".vti", ".node", ".poly", ".mesh", ".msh")
TEXTS = (".csv", ".png")
MESHIO = (".inp", ".bdf", ".su2", ".mdpa") if find_spec("meshio") else ()
WRITERS = (*MESHES, *SURFACES, *TEXTS, *MESHIO, *(f"{name} {ending}" for ending, name in CLASSES.items()))


def new_folder(name: str) -> Path:
    """An empty directory."""
    shutil.rmtree(FOLDER / name, ignore_errors=True)
    (FOLDER / name).mkdir(parents=True)
    return FOLDER / name


def mesh_for(writer: str, n: int):
    """A mesh, of 2 n^2 triangles, as the writer can write it."""
    mesh = square(n)
    ending = writer.split()[-1]
    if ending == ".vti":
        return tl.metric_field(dimensions=(n, n, 1)).mesh
    if ending == ".vtm":
        blocks = vtkMultiBlockDataSet()
        for i in range(3):
            blocks.SetBlock(i, mesh)
        return blocks
    if ending in SURFACES:
        surface = vtkGeometryFilter()
        surface.SetInputData(mesh)
        surface.Update()
        return surface.GetOutput()
    if ending == ".poly":  # which holds segments
        lines = vtkPolyData()
        lines.SetPoints(mesh.GetPoints())
        segments = vtkCellArray()
        for i in range(0, mesh.GetNumberOfPoints() - 1):
            segments.InsertNextCell(2, (i, i + 1))
        lines.SetLines(segments)
        return lines
    return mesh


def file_of(writer: str) -> str:
    return "out" + writer.split()[-1]


def write(writer: str, mesh, file: Path) -> None:
    """Write a mesh, or as much text; raises tautline.Error."""
    if writer == ".csv":
        points = range(mesh.GetNumberOfPoints())
        _files.replace_text(file, "".join(f"{i},{mesh.GetPoint(i)[0]!r}\n" for i in points) + "end\n", stream=True)
    elif writer == ".png":
        _files.save_figure(Figure(mesh.GetNumberOfPoints()), file)
    elif " " in writer:
        own = getattr(tl, writer.split()[0])()
        own.SetInputData(mesh)
        own.SetFileName(str(file))
        own.AddObserver("ErrorEvent", lambda *_: None)
        if not own.Write():
            raise tl.Error(own.GetErrorText())
    else:
        tl.write(mesh, file)


class Figure:
    """Writes as a figure of matplotlib does, piece by piece."""

    def __init__(self, count: int) -> None:
        self.count = count

    def savefig(self, out, format) -> None:
        for _ in range(self.count):
            out.write(format.encode() * 10)
        out.write(b"end\n")


def one_of(whole: list, found, writer: str) -> bool:
    """Whether what was found is one of the complete contents; of several files, each by itself."""
    return all(f in w for f, w in zip(found, zip(*whole))) if writer.endswith(".node") else found in whole


def content(folder: Path, writer: str):
    """The contents of the file, read with the package: the numbers of points and cells."""
    file = folder / file_of(writer)
    if writer in TEXTS:
        text = file.read_bytes()
        assert text.endswith(b"end\n"), f"{file} is cut"
        return len(text)
    if file.suffix == ".node":  # of two files, each of which is complete, but may be of another mesh after a kill
        return tuple(hash((folder / name).read_bytes()) for name in ("out.node", "out.ele"))
    mesh = tl.read(file)
    if isinstance(mesh, vtkMultiBlockDataSet):
        assert all(mesh.GetBlock(i) for i in range(3)), f"{file}: blocks are missing"
        return [mesh.GetBlock(i).GetNumberOfCells() for i in range(3)]
    return mesh.GetNumberOfPoints(), mesh.GetNumberOfCells()


def names(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def test_kill() -> None:
    """A process that writes two meshes in turn is killed at any time."""
    random.seed(1)
    for writer in WRITERS:
        folder = new_folder("kill")
        meshes = [mesh_for(writer, 20), mesh_for(writer, 90)]
        whole = []
        for mesh in meshes:
            write(writer, mesh, folder / file_of(writer))
            whole.append(content(folder, writer))
        for _ in range(KILLS):
            child = os.fork()
            if child == 0:
                try:
                    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
                    while True:
                        for mesh in meshes:
                            write(writer, mesh, folder / file_of(writer))
                finally:
                    os._exit(1)
            time.sleep(random.uniform(0.002, 0.1))
            os.kill(child, signal.SIGKILL)
            assert os.WIFSIGNALED(os.waitpid(child, 0)[1]), f"{writer}: the process ended by itself"
            found = content(folder, writer)
            assert one_of(whole, found, writer), f"{writer}: {found} after a kill, not {whole}"


def test_full_disk() -> None:
    """On a disk of 512 kB a mesh that is too large is rejected, and the older file stays."""
    disk = new_folder("disk")
    command = ["mount", "-t", "tmpfs", "-o", f"size={DISK}", "tmpfs", disk]
    mounted = subprocess.run(command, capture_output=True, text=True)
    if mounted.returncode:
        print(f"  not run: no file system can be mounted ({mounted.stderr.strip()})")
        return
    try:
        for writer in WRITERS:
            small, large = mesh_for(writer, 20), mesh_for(writer, 300)
            if writer == ".vti":
                large = tl.metric_field(dimensions=(600, 600, 1), metrics=["imr", "si"]).mesh
            write(writer, small, disk / file_of(writer))
            before, files = content(disk, writer), names(disk)
            rejected(wording("no-space-left-on-device"), write, writer, large, disk / file_of(writer))
            assert content(disk, writer) == before, f"{writer}: the older file is not as it was"
            assert names(disk) == files, f"{writer}: {names(disk) ^ files} are left"
            write(writer, small, disk / file_of(writer))  # and there is room again
            for path in disk.iterdir():
                shutil.rmtree(path) if path.is_dir() else path.unlink()
    finally:
        subprocess.run(["umount", disk], check=True)


def as_nobody(function) -> None:
    """Run a function in a process of the user nobody, if this one is root's: root may write everywhere."""
    child = os.fork()
    if child == 0:
        try:
            if os.geteuid() == 0:
                os.setgroups([])
                os.setgid(NOBODY)
                os.setuid(NOBODY)
            function()
            os._exit(0)
        except BaseException as error:
            print(repr(error), flush=True)
        finally:
            os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0, "the check of the user nobody failed"


def test_directory_without_permission() -> None:
    folder = new_folder("closed")
    meshes = {writer: mesh_for(writer, 5) for writer in WRITERS}
    for writer in WRITERS:
        write(writer, meshes[writer], folder / file_of(writer))
    before = {name: (folder / name).read_bytes() for name in names(folder)}
    folder.chmod(0o555)
    (folder / "out.vtu").chmod(0o444)

    def check() -> None:
        for writer in WRITERS:
            rejected(wording("cannot-be-written"), write, writer, meshes[writer], folder / file_of(writer))

    as_nobody(check)
    folder.chmod(0o777)
    as_nobody(lambda: rejected("write-protected", tl.write, meshes[".vtu"], folder / "out.vtu"))
    assert before == {name: (folder / name).read_bytes() for name in names(folder)}


def test_links() -> None:
    """The file behind a link is replaced, in its own directory, and the link stays."""
    for writer in WRITERS:
        folder = new_folder("links")
        (folder / "real").mkdir()
        small, large = mesh_for(writer, 3), mesh_for(writer, 6)
        real, link = folder / "real" / file_of(writer), folder / file_of(writer)
        write(writer, small, real)
        before, inode = content(folder / "real", writer), real.stat().st_ino
        real.chmod(0o640)
        link.symlink_to(Path("real", real.name))
        write(writer, large, link)
        assert link.is_symlink() and not real.is_symlink(), writer
        assert content(folder / "real", writer) != before and real.stat().st_ino != inode, writer
        assert stat.S_IMODE(real.stat().st_mode) == 0o640, f"{writer}: other permissions"
        assert not any(name.endswith(".part") for name in names(folder)), names(folder)
        link.unlink()
        link.symlink_to(link.name)
        rejected(wording("cannot-be-written"), write, writer, large, link)
    if os.geteuid() == 0:  # a link that another user put into a directory for everybody
        folder = new_folder("everybody")
        folder.chmod(0o1777)
        victim = new_folder("victim") / "out.vtu"
        victim.write_text("precious")
        for writer in (".vtu", "vtkMeditWriter .mesh"):
            link = folder / file_of(writer)
            link.symlink_to(victim)
            os.lchown(link, NOBODY, NOBODY)
            rejected(wording("link-of-another-user"), write, writer, mesh_for(writer, 3), link)
        assert victim.read_text() == "precious"


def test_two_writers() -> None:
    """Two processes write the same file again and again; whenever it is read, it is complete."""
    for writer in WRITERS:
        if writer.endswith((".node", ".mesh")) and writer not in (".node", ".mesh"):
            continue  # the same code
        folder = new_folder("two")
        meshes = [mesh_for(writer, 10), mesh_for(writer, 30)]
        whole = []
        for mesh in meshes:
            write(writer, mesh, folder / file_of(writer))
            whole.append(content(folder, writer))
        children = []
        for mesh in meshes:
            child = os.fork()
            if child == 0:
                code = 1
                try:
                    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
                    for _ in range(8):
                        write(writer, mesh, folder / file_of(writer))
                    code = 0
                finally:
                    os._exit(code)
            children.append(child)
        for child in children:
            status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
            assert status == 0, f"{writer}: a writer failed"
        assert one_of(whole, content(folder, writer), writer), writer
        assert not any(".part" in name for name in names(folder)), names(folder)
        if writer == ".vtm":
            assert len(names(folder)) == 1 + 3, f"blocks of older files are left: {names(folder)}"


def test_name_first() -> None:
    """The name of the output is checked before the work, even before the input is read."""
    absent = FOLDER / "absent"
    shutil.rmtree(absent, ignore_errors=True)
    no_mesh = FOLDER / "no-mesh.vtu"
    for name, text in (("x.docx", "no writer for '.docx'"), ("absent/x.vtu", "there is no directory")):
        rejected(text, tl.write, no_mesh, FOLDER / name)
        assert text in shell("quality", no_mesh, "-o", FOLDER / name, code=1)
        assert text in shell("convert", no_mesh, FOLDER / name, code=1)
    assert wording("there-is-no-directory") in shell("quality", no_mesh, "--csv", absent / "x.csv", code=1)
    (FOLDER / "folder.vtu").mkdir(exist_ok=True)
    rejected(wording("it-is-a-directory"), tl.write, no_mesh, FOLDER / "folder.vtu")


def commands() -> dict[str, argparse.ArgumentParser]:
    """The commands of the shell by name."""
    found = [a for a in shell_parser()._actions if isinstance(a, argparse._SubParsersAction)]
    return {name: parser for name, parser in found[0].choices.items() if name != "study"}


def call(arguments: list[str]) -> str:
    """The output of a command on stderr before it exits with 1."""
    with contextlib.redirect_stderr(io.StringIO()) as said:
        assert shell_main(arguments) == 1, arguments
    return said.getvalue()


def test_every_output_first() -> None:
    """Every command with an output rejects a name that cannot be written before it reads its input."""
    absent, no_mesh = FOLDER / "absent", str(FOLDER / "no-mesh.vtu")
    shutil.rmtree(absent, ignore_errors=True)
    needed = {"warp": ["--target", no_mesh]}  # options of which one must be given
    outputs = 0
    for name, parser in commands().items():
        inputs, options = [], []
        for action in parser._actions:
            writes = action.dest in ("output", "csv", "report", "sheet", "certificate")
            named = action.nargs != 0 and (action.help or "").startswith("write ")
            assert writes or not named, f"{name}: --{action.dest} is not checked"
            if writes:
                options.append(action)
            elif not action.option_strings and action.nargs not in ("*", "?"):
                inputs.append(action.choices[0] if action.choices else no_mesh)
        for option in options:
            others = [o for o in options if o.required and o is not option and o.option_strings]
            fixed = inputs + needed.get(name, []) + [text for o in others for text in (o.option_strings[0], "x.vtu")]
            for file, text in ((absent / "x.vtu", "there is no directory"), (FOLDER / "x.docx", ".docx")):
                if option.dest in ("csv", "report", "certificate") and file.suffix == ".docx":
                    continue  # a table or report may have any name
                flag = option.option_strings[-1:]
                error = call([name, *fixed, *flag, str(file)])
                assert text in error and "no-mesh" not in error, (name, option.dest, error)
                outputs += 1
    assert outputs > 30, outputs


def test_every_study_first() -> None:
    """Every study rejects a directory that cannot be made before it works."""
    blocked = FOLDER / "a-file"
    blocked.write_text("")
    for name in studies.names():
        signal.alarm(20)  # ends the test with an error
        rejected(wording("cannot-be-made"), studies.main, [name, "--out", str(blocked / "out")])
    signal.alarm(0)
    assert len(studies.names()) > 20


def test_streams() -> None:
    """Tables may go to a pipe or a device, which stay what they are; meshes may not."""
    done = subprocess.run([sys.executable, "-m", "tautline", "quality", DATA / "plate.vtu", "--csv", "/dev/stdout"],
                          capture_output=True, text=True, check=True)  # fmt: skip
    assert "metric,label" in done.stdout, done.stdout
    shell("quality", DATA / "plate.vtu", "--csv", "/dev/null")
    assert stat.S_ISCHR(os.stat("/dev/null").st_mode)
    pipe = new_folder("pipes") / "pipe.vtu"
    os.mkfifo(pipe)
    os.mkfifo(pipe.with_suffix(".mesh"))
    rejected(wording("not-a-regular-file"), tl.write, DATA / "plate.vtu", pipe)
    own = tl.vtkMeditWriter()
    own.SetInputData(square(2))
    own.SetFileName(str(pipe.with_suffix(".mesh")))
    own.AddObserver("ErrorEvent", lambda *_: None)
    assert not own.Write() and wording("not-a-regular-file") in own.GetErrorText()


FOLDER.mkdir(parents=True, exist_ok=True)
OUT.chmod(OUT.stat().st_mode | 0o055)
for test in [value for name, value in list(globals().items()) if name.startswith("test_")]:
    start = time.monotonic()
    test()
    print(f"{test.__name__} passed, {time.monotonic() - start:.1f} s", flush=True)
