# SPDX-License-Identifier: BSD-3-Clause
"""lost_server.py PORT: for pvpython, see test_lost_server.py; a long filter on a pvserver that will be killed."""

import os
import sys

from paraview import simple

simple.Connect("127.0.0.1", int(sys.argv[1]))
simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], remote=True)
simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], remote=False, ns=globals())
mesh = simple.Tetrahedralize(simple.Wavelet(WholeExtent=[0, 40, 0, 40, 0, 40]))
mesh.UpdatePipeline()
study = SolverStudy(mesh, Repetitions=100)  # noqa: F821, defined by the plugin
processes = simple.servermanager.ActiveConnection.GetNumberOfDataPartitions()
# pvpython 5.13 keeps what goes to sys.stdout.
print(f"running on {processes} processes", file=sys.__stdout__, flush=True)
study.UpdatePipeline()
# ParaView reports the loss and goes on with the script: what it has of the filter is empty.
print(f"ended with {study.GetDataInformation().GetNumberOfCells()} cells", file=sys.__stdout__, flush=True)
