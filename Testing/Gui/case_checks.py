# SPDX-License-Identifier: BSD-3-Clause
"""Checks of the session JobOpenFoam: the faces of the sample elbow-failing, and the case that is saved.

The numbers come from OpenFOAM's checkMesh on both meshes.
"""

import os
import shutil

import numpy
from paraview import servermanager, simple
from session_checks import check, find
from vtkmodules.util.numpy_support import vtk_to_numpy

HERE = os.path.dirname(os.path.abspath(__file__))
NAME = "elbow-failing"
CASE = os.path.join(os.environ["TAUTLINE_TEST_DIR"], NAME)
MESH = os.path.join("constant", "polyMesh")
BAD_PORT, FACES_PORT, CHECKS_PORT = 7, 8, 9  # of Element Quality
COLUMNS = ("Maximum", "Offending", "Failed", "OnRequest")  # of the checks
FAILED = {"cell_aspect_ratio": 2, "cell_volume": 2, "non_orthogonality": 25, "pyramid_volume": 54, "face_skewness": 19}
LARGEST = {"non_orthogonality": 169.779, "face_skewness": 191.872}  # by checkMesh
TARGETS = {"non_orthogonality": 65, "face_skewness": 3.5}  # the defaults of the preset
CLOSE = 1e-5  # relative: checkMesh prints six digits
RIGHT_ANGLE, STRAIGHT_ANGLE = 90, 180  # degrees
RED, INSIDE = (0.8, 0.2, 0.15), 0.25  # color of faces, and opacity of the mesh around them


@check
def copy_case():
    """The session writes into the case: it has a copy of its own."""
    shutil.rmtree(CASE, ignore_errors=True)
    shutil.copytree(os.path.join(HERE, "..", "..", "Data", NAME), CASE)


def mesh_checks():
    """For each check: the largest value, the number of offending faces or cells, and whether checkMesh counts it."""
    table = servermanager.Fetch(find("ElementQuality"), idx=CHECKS_PORT)
    largest, bad, fails, asked = (vtk_to_numpy(table.GetColumnByName(name)) for name in COLUMNS)
    names = [table.GetColumnByName("Check").GetValue(row) for row in range(table.GetNumberOfRows())]
    return {name: (largest[row], int(bad[row]), fails[row] and not asked[row]) for row, name in enumerate(names)}


@check
def failed():
    found = mesh_checks()
    assert {name: bad for name, (_, bad, counted) in found.items() if counted} == FAILED, found
    for name, value in LARGEST.items():
        assert numpy.isclose(found[name][0], value, rtol=CLOSE), (name, found[name][0])
    summary = find("ElementQuality").Summary
    assert f"checkMesh: Failed {len(FAILED)} mesh checks." in summary, summary


@check
def show_faces():
    """Those with a non-orthogonality of more than 90 degrees, red in the translucent mesh."""
    quality = find("ElementQuality")
    faces = simple.Threshold(Input=simple.OutputPort(quality, FACES_PORT), Scalars=["CELLS", "non_orthogonality"])
    faces.LowerThreshold, faces.UpperThreshold = RIGHT_ANGLE, STRAIGHT_ANGLE
    shown = simple.Show(faces)
    assert faces.GetDataInformation().GetNumberOfCells() == FAILED["non_orthogonality"]
    simple.ColorBy(shown, None)
    shown.DiffuseColor = shown.AmbientColor = RED
    shown.SetRepresentationType("Surface With Edges")
    simple.GetDisplayProperties(quality).Opacity = INSIDE
    simple.Hide(simple.OutputPort(quality, BAD_PORT))
    simple.SetActiveSource(quality)


@check
def repaired():
    simple.Hide(find("Threshold"))
    summary = find("MeshOptimizer").Summary
    assert f"checkMesh before: Failed {len(FAILED)} mesh checks. After: Mesh OK." in summary, summary


@check
def passed():
    found = mesh_checks()
    assert not any(counted for _, _, counted in found.values()), found
    assert all(found[name][0] <= target for name, target in TARGETS.items()), found


@check
def saved():
    """The file of the points is another one, with the old one beside it; the faces are the same file."""
    original = os.path.join(HERE, "..", "..", "Data", NAME, MESH)
    before, after = ({name: open(os.path.join(folder, name), "rb").read() for name in os.listdir(folder)}
                     for folder in (original, os.path.join(CASE, MESH)))  # fmt: skip
    assert after.pop("points.orig") == before.pop("points") != after.pop("points")
    assert before == after, sorted(after)
