# SPDX-License-Identifier: BSD-3-Clause
"""The plugin loads in a pvserver, which has no Qt, and its filter runs there."""

import os
import socket
import subprocess
import sys
import time

from paraview import simple

HOST = "127.0.0.1"
START_SECONDS = 60


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        return probe.getsockname()[1]


def connect(port: int) -> None:
    end = time.time() + START_SECONDS
    while time.time() < end:
        with socket.socket() as probe:
            listening = probe.connect_ex((HOST, port)) == 0
        if listening:
            break
        time.sleep(0.2)
    simple.Connect(HOST, port)


port = free_port()
# --multi-clients: the probe above counts as a client that left again
server = subprocess.Popen([sys.argv[1], f"--server-port={port}", "--multi-clients"])
try:
    connect(port)
    simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], remote=True)
    simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], remote=False, ns=globals())
    mesh = simple.Tetrahedralize(simple.Wavelet(WholeExtent=[0, 3, 0, 3, 0, 3]))
    quality = ElementQuality(mesh)  # noqa: F821, defined by the plugin
    quality.UpdatePipeline()
    assert quality.CellData["imr"] is not None, quality.CellData.keys()
    print(quality.CellData["imr"].GetRange())
finally:
    server.terminate()
    server.wait(START_SECONDS)
