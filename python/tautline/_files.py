# SPDX-License-Identifier: BSD-3-Clause
"""Files that are replaced as a whole: after a failure there is the older file or the complete new one, never a part.

A file is written under a temporary name with a random part, `.tautline-....part`, in the directory where it will be;
that name is always a new file, and never followed if it is a link. Then the content is forced to the disk and the
temporary file renamed. Programs that open files themselves (meshio) write into a directory of such a name. A process
that is killed may leave the temporary file or directory behind, which can be deleted.
"""

from __future__ import annotations

import fcntl
import os
import resource
import shutil
import stat
from contextlib import contextmanager, suppress
from os import PathLike, fspath
from secrets import token_hex
from typing import Any, BinaryIO, Iterator

from ._errors import Error

# Links in a row, as in Linux.
_MAX_LINKS = 40
# Names of open files, such as a pipe: `--csv /dev/stdout`.
_STREAMS = ("/dev/std", "/dev/fd/", "/proc/")
_MEBIBYTE = 2**20
_NEW_FILE = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC


def file_name(file: str | PathLike[str]) -> str:
    """The name of a file as a text. Raises Error for anything else."""
    try:
        name = fspath(file)
    except TypeError:
        raise Error(f"a file name is expected, not {type(file).__name__}") from None
    if not isinstance(name, str) or not name or "\0" in name:
        raise Error(f"{name!r} is no file name")
    return name


def check_input(file: str | PathLike[str]) -> None:
    """Raise Error if there is no regular file, before a reader blocks or reads from it forever."""
    name = file_name(file)
    try:
        mode = os.stat(name).st_mode
        if stat.S_ISREG(mode):
            with open(name, "rb"):
                return
    except FileNotFoundError:
        raise Error(f"{name}: there is no such file") from None
    except OSError as error:
        raise Error(f"{name}: cannot be read: {error.strerror}") from None
    raise Error(f"{name}: {'is a directory' if stat.S_ISDIR(mode) else 'is not a regular file'}")


def check_target(file: str | PathLike[str]) -> str:
    """The name of the file that writing to `file` replaces. Raises Error if it cannot be written.

    A link is followed: the file it points to is replaced, and the link stays. A link of another user in a directory
    where everybody may write, such as /tmp, is rejected, as in Linux.
    """
    name = file_name(file)
    target = _follow(name)
    folder = _folder(target)
    if not os.path.isdir(folder):
        raise _unwritable(name, f"there is no directory {folder}")
    if os.path.isdir(target):
        raise _unwritable(name, "it is a directory")
    exists = os.path.lexists(target)
    if exists and not stat.S_ISREG(os.lstat(target).st_mode):
        raise _unwritable(name, "it is not a regular file")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise _unwritable(name, f"files cannot be made in the directory {folder}")
    if exists and not os.access(target, os.W_OK):
        raise _unwritable(name, "the file is write-protected")
    return target


def check_stream_or_target(file: str | PathLike[str]) -> None:
    """check_target() for files that may also be a pipe or a device, such as /dev/stdout."""
    if not _is_stream(file_name(file)):
        check_target(file)


@contextmanager
def replacing(file: str | PathLike[str], *, stream: bool = False) -> Iterator[BinaryIO]:
    """A binary file for the new content of `file`, which replaces it at the end of the block.

    stream: whether the file may be a pipe or a device, which are written directly. Raises Error if the file cannot be
    written; it is then as it was.
    """
    name = file_name(file)
    try:
        if stream and _is_stream(name):
            with open(name, "wb") as out:
                yield out
            return
        target = check_target(name)
        temporary = os.path.join(_folder(target), temporary_name())
        descriptor = os.open(temporary, _NEW_FILE, 0o666)
        try:
            with open(descriptor, "wb") as out:
                yield out
                _keep_mode(target, descriptor)
                out.flush()
                os.fsync(descriptor)
            os.replace(temporary, target)
        except BaseException:
            with suppress(OSError):
                os.unlink(temporary)
            raise
        sync_folder(_folder(target))
    except OSError as error:
        raise _unwritable(name, error.strerror or str(error)) from None


@contextmanager
def replacing_by_name(file: str | PathLike[str]) -> Iterator[str]:
    """The name of a new file, for programs that open it themselves; it replaces `file` at the end of the block.

    It has the ending of `file`, and is in a new directory beside it, of a temporary name. Raises Error if the file
    cannot be written; it is then as it was.
    """
    name = file_name(file)
    try:
        target = check_target(name)
        folder = os.path.join(_folder(target), temporary_name())
        os.mkdir(folder)
        try:
            made = os.path.join(folder, "content" + os.path.splitext(name)[1])
            yield made
            descriptor = os.open(made, os.O_RDWR)
            try:
                _keep_mode(target, descriptor)
                os.fsync(descriptor)
            finally:
                os.close(descriptor)
            os.replace(made, target)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        sync_folder(_folder(target))
    except OSError as error:
        raise _unwritable(name, error.strerror or str(error)) from None


def replace_bytes(file: str | PathLike[str], content: bytes) -> None:
    """Replace a file. Raises Error if it cannot be written; it is then as it was."""
    with replacing(file) as out:
        out.write(content)


def replace_text(file: str | PathLike[str], text: str, *, stream: bool = False) -> None:
    """Replace a file by a text, as it is, in UTF-8; see replacing()."""
    with replacing(file, stream=stream) as out:
        out.write(text.encode())


def save_figure(figure: Any, file: str | PathLike[str], **options: Any) -> None:
    """Replace a file by the picture of a figure of matplotlib."""
    with replacing(file) as out:
        figure.savefig(out, format=os.path.splitext(file_name(file))[1][1:], **options)


def make_folder(folder: str | PathLike[str]) -> None:
    """Make a directory for output, if there is none. Raises Error if it cannot be made or written to."""
    name = file_name(folder)
    try:
        os.makedirs(name, exist_ok=True)
    except OSError as error:
        raise Error(f"{name}: cannot be made: {error.strerror}") from None
    if not os.access(name, os.W_OK | os.X_OK):
        raise _unwritable(name, "files cannot be made in the directory")


def temporary_name() -> str:
    """An unpredictable name for a new file or directory."""
    return f".tautline-{token_hex(8)}.part"


@contextmanager
def locked(folder: str) -> Iterator[None]:
    """Wait until no other process is in such a block for the same directory, if the file system has locks."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def sync_folder(folder: str) -> None:
    """Force the names of the files in a directory to the disk, if the file system can."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _follow(name: str) -> str:
    """The name after all links are resolved, one after the other."""
    target = name
    for _ in range(_MAX_LINKS):
        if not os.path.islink(target):
            return target
        folder = os.stat(_folder(target))
        everybody = folder.st_mode & stat.S_ISVTX and folder.st_mode & stat.S_IWOTH
        if everybody and os.lstat(target).st_uid not in (os.geteuid(), folder.st_uid):
            raise _unwritable(name, f"{target} is a link of another user")
        target = os.path.join(_folder(target), os.readlink(target))
    raise _unwritable(name, "too many links")


def _folder(name: str) -> str:
    return os.path.dirname(name) or "."


def _is_stream(name: str) -> bool:
    if os.path.abspath(name).startswith(_STREAMS):
        return True
    try:
        mode = os.stat(name).st_mode
    except OSError:
        return False
    return not stat.S_ISREG(mode) and not stat.S_ISDIR(mode)


def _keep_mode(target: str, descriptor: int) -> None:
    """Give the new file the permissions of the older one."""
    with suppress(OSError):
        os.fchmod(descriptor, stat.S_IMODE(os.lstat(target).st_mode) & 0o777)


def _unwritable(name: str, reason: str) -> Error:
    return Error(f"{name}: cannot be written: {reason}")


def require_memory(size: float, work: str) -> None:
    """Raise Error if the limit on the address space (ulimit -v) leaves less than `size` bytes for some work.

    Without a limit nothing is checked. VTK's readers and writers end the process where an allocation fails.
    """
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit == resource.RLIM_INFINITY:
        return
    with open("/proc/self/statm", encoding="ascii") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    if size > limit - used:
        needed, free = size / _MEBIBYTE, max(0, limit - used) / _MEBIBYTE
        raise Error(
            f"{work} takes about {needed:.3g} MiB of memory and {free:.3g} MiB are available: raise the limit on the "
            "memory of the process"
        )
