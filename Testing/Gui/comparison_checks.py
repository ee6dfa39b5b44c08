# SPDX-License-Identifier: BSD-3-Clause
"""Checks of what Side by Side makes, in a session. See session_checks.py."""

from paraview import simple, smtrace
from session_checks import check, find, find_named

TRACED = {"config": None}


def names():
    """The proxies in the pipeline browser, in alphabetical order."""
    return sorted(source.GetXMLName() for source in simple.GetSources().values())


@check
def once():
    assert names().count("ElementQuality") == names().count("TextSource") == 2, names()
    assert len(simple.GetLayouts()) == 2, simple.GetLayouts()


@check
def delete_after():
    simple.Delete(find_named("After"))


@check
def caption_gone():
    """The caption of the other mesh is left."""
    assert names().count("ElementQuality") == names().count("TextSource") == 1, names()
    assert find_named("Before, text").Text.startswith("before: ")


@check
def delete_filter():
    simple.Delete(find("MeshOptimizer"))


@check
def all_gone():
    assert names() == ["XMLUnstructuredGridReader"], names()
    assert len(simple.GetLayouts()) == 1, simple.GetLayouts()


@check
def start_trace():
    TRACED["config"] = smtrace.start_trace()


@check
def play_trace():
    code = smtrace.stop_trace()
    TRACED["config"] = None
    exec(compile(code, "trace", "exec"), {})


@check
def same_views():
    """The displays in the two views of the trace and in the original views, with the properties that are set."""
    views = [view for view in simple.GetViews() if view.GetXMLName() == "RenderView"]
    assert len(views) == 5, len(views)
    drawn = [sorted(map(look, shown_in(view))) for view in views]
    made, repeated = drawn[1:3], drawn[3:5]
    assert made == repeated, (made, repeated)
    assert all(len(one) == 3 for one in made), made  # mesh, elements outside of the range, caption


def shown_in(view):
    return [one for one in view.Representations if hasattr(one, "Input") and one.Visibility]


def look(shown):
    of = shown.Input.SMProxy.GetXMLName(), shown.Input.Port
    if of[0] == "TextSource":
        return *of, shown.Input.Text, shown.WindowLocation, shown.FontSize
    return *of, shown.Representation, round(shown.Opacity, 3), tuple(shown.ColorArrayName)
