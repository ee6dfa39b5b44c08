# SPDX-License-Identifier: BSD-3-Clause
"""test_lost_server.py PVSERVER PVPYTHON: a server killed in a long filter ends its client with a message, not a hang.

A pvserver, and one of the two of mpirun -np 2 pvserver (skipped without mpirun).
"""

import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

PVSERVER, PVPYTHON = sys.argv[1:]
HERE = Path(__file__).parent
ENVIRONMENT = dict(os.environ, OMPI_MCA_btl_vader_single_copy_mechanism="none", OMPI_MCA_mpi_yield_when_idle="1",
                   OMP_NUM_THREADS="1")
START_SECONDS, END_SECONDS = 120, 60
IN_FILTER_SECONDS = 3  # in the filter before the server is killed
MESSAGE = "Server failed to gather information"  # ParaView's
LISTENING = "Accepting connection(s): "


class Output:
    """The lines that a process prints, as they come."""

    def __init__(self, process: subprocess.Popen) -> None:
        self.lines: list[str] = []
        self.complete = False
        self.changed = threading.Condition()
        threading.Thread(target=self.read, args=(process.stdout,), daemon=True).start()

    def read(self, stream) -> None:
        for line in stream:
            with self.changed:
                self.lines.append(line)
                self.changed.notify_all()
        with self.changed:
            self.complete = True
            self.changed.notify_all()

    def wait(self, text: str, seconds: float) -> str:
        """The first line with a text."""
        with self.changed:
            self.changed.wait_for(lambda: self.complete or self.has(text), seconds)
            assert self.has(text), f"no '{text}' in {seconds} s: {''.join(self.lines)}"
            return next(line for line in self.lines if text in line)

    def has(self, text: str) -> bool:
        return any(text in line for line in self.lines)


def started(command: list) -> tuple:
    process = subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               start_new_session=True)  # fmt: skip
    return process, Output(process)


def servers_of(pid: int) -> list[int]:
    """The pvservers among a process and its descendants, in the order of their ids."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                name, rest = (entry / "stat").read_text().split("(", 1)[1].rsplit(")", 1)
            except OSError:
                continue  # ended meanwhile
            if int(rest.split()[1]) == pid:
                found += servers_of(int(entry.name))
            elif int(entry.name) == pid and "pvserver" in name:
                found.append(pid)
    return sorted(found)


def end(process: subprocess.Popen) -> None:
    """Ends a process of its own session and all that it started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    process.wait()


def check(launcher: list[str], processes: int) -> None:
    server, listening = started([*launcher, PVSERVER, "--server-port=0", "--force-offscreen-rendering"])
    client = None
    try:
        line = listening.wait(LISTENING, START_SECONDS)
        port = line.strip().rsplit(":", 1)[1]
        client, said = started([PVPYTHON, str(HERE / "lost_server.py"), port])
        assert f"on {processes} processes" in said.wait("running on", START_SECONDS), said.lines
        time.sleep(IN_FILTER_SECONDS)
        assert client.poll() is None and not said.has("ended"), f"the filter was not long enough: {said.lines}"
        ranks = servers_of(server.pid)
        assert len(ranks) == processes, ranks
        os.kill(ranks[-1], signal.SIGKILL)
        killed = time.time()
        try:
            code = client.wait(END_SECONDS)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"the client hangs: {''.join(said.lines)}") from None
        text = "".join(said.lines)
        print(f"{processes} processes: the client ended after {time.time() - killed:.1f} s with exit code {code}")
        assert text.index(MESSAGE) > text.index("running on"), text
        # A script of pvpython goes on, without a result.
        assert code != 0 or said.has("ended with 0 cells"), (code, text)
    finally:
        for process in filter(None, (client, server)):
            end(process)


check([], 1)
MPIRUN = shutil.which("mpirun")
if MPIRUN:
    check([MPIRUN, "--oversubscribe", "--bind-to", "none", "-np", "2"], 2)
else:
    print("without mpirun: a server of one process only")
