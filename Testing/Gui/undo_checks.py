# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the undo stack in a session. See session_checks.py.

ParaView clears the stack after each command of the Python shell: between the steps that are checked there is none.
"""

from paraview import servermanager, simple
from session_checks import check, find


def labels():
    """The steps that Undo reverts, the last one first."""
    stack = servermanager.vtkSMProxyManager.GetProxyManager().GetUndoStackBuilder().GetUndoStack()
    return [stack.GetUndoSetLabel(i) for i in range(stack.GetNumberOfUndoSets())]


@check
def steps(*expected):
    """The last steps are these, which ParaView's own filters make also."""
    assert labels()[: len(expected)] == list(expected), labels()


@check
def sources(*expected):
    """The proxies in the pipeline browser, in any order."""
    names = [source.GetXMLName() for source in simple.GetSources().values()]
    assert sorted(names) == sorted(expected), names
    kinds = [view.GetXMLName() for view in simple.GetViews()]
    assert kinds.count("RenderView") == len(simple.GetLayouts()) == 1, kinds


@check
def delete(name):
    """Delete a filter as a script does, which no open dialog prevents."""
    simple.Delete(find(name))
