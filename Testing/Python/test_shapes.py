# SPDX-License-Identifier: BSD-3-Clause
"""The functions silhouette, match and retrieval, their commands, and the study on a small synthetic set."""

import csv

import numpy as np
import tautline as tl
from checks import OUT, rejected, run_tests, shell, wording
from study_checks import Studies
from tautline.studies import _silhouettes, shapes
from vtkmodules.util.numpy_support import vtk_to_numpy
from wrong_data import verdicts

GREY, GREEN, RED = (120, 120, 120), (0, 150, 60), (215, 25, 30)  # frames on the sheet of pictures
OUTPUT = OUT / "shapes"
OUTPUT.mkdir(parents=True, exist_ok=True)


def run(*arguments, code=0):
    return shell(*arguments, code=code, folder=OUTPUT)


def write_png(file, image):
    from vtkmodules.vtkImagingCore import vtkImageCast
    from vtkmodules.vtkIOImage import vtkPNGWriter

    cast = vtkImageCast()
    cast.SetInputData(tl._shapes_parts.as_image(image))
    cast.SetOutputScalarTypeToUnsignedChar()
    writer = vtkPNGWriter()
    writer.SetInputConnection(cast.GetOutputPort())
    writer.SetFileName(str(file))
    writer.Write()


def test_silhouette():
    images, labels = _silhouettes.families(2, 3, seed=5)
    assert labels == ["disc", "disc", "bean", "bean", "bar", "bar"]
    again, _ = _silhouettes.families(2, 3, seed=5)
    assert all((a == b).all() for a, b in zip(images, again))
    shape = tl.silhouette(images[2], spacing=15)
    assert shape.mesh.GetNumberOfCells() == shape.mesh.GetNumberOfPoints() - 2 > 6
    # The center of mass of the area is the mean of the pixels.
    y, x = np.nonzero(images[2])
    assert np.allclose(shape.centre, [x.mean(), y.mean()], atol=0.15), (shape.centre, x.mean(), y.mean())
    assert shape.components == 1 and shape.holes == 0
    rejected(wording("one-value"), tl.silhouette, np.ones((9, 9)))
    rejected("spacing", tl.silhouette, images[0], 0)
    rejected(wording("no-such-file"), tl.silhouette, "nowhere.png")
    rejected("axes", tl.silhouette, np.ones(9))
    rejected("foreground", tl.silhouette, images[0], foreground="pink")


def test_match():
    images, _ = _silhouettes.families(2, 3, seed=5)
    same = tl.match(images[2], images[2], locations="contour", contour_points=80)
    like = tl.match(images[2], images[3], locations="contour", contour_points=80)
    other = tl.match(images[2], images[5], locations="contour", contour_points=80)
    assert same.energy < like.energy < other.energy
    assert like.exact and like.rank == 1
    assert np.isclose(like.triangles["energy"].sum(), like.energy)
    terms = [like.statistics[name] for name in ("EdgeCost", "Deformation", "Distortion")]
    assert np.isclose(np.dot(terms, [1, 12, 3]), like.energy)
    assert like.displacement.shape == like.points.shape
    # Felzenszwalb's energy is the case b = 0; a mesh is as good a source as its image.
    plain = tl.match(tl.silhouette(images[2]), images[3], b=0, locations="contour", contour_points=80)
    assert plain.energy < like.energy
    one, two = (tl.match(images[2], images[3], threads=threads, grid=(12, 12)) for threads in (1, 2))
    assert one.energy == two.energy and (one.points == two.points).all()
    rejected(wording("argument-of-match-c"), tl.match, images[2], images[3], c=1)
    rejected(wording("a-is-nan"), tl.match, images[2], images[3], a=float("nan"))
    rejected(wording("too-small"), tl.match, images[2], images[3], grid=(1, 1))


def test_retrieval():
    images, labels = _silhouettes.families(3, 4, seed=2)
    found = tl.retrieval(images, labels, best=2)
    assert found.distances.shape == (12, 12) and found.ranking.shape == (12, 11)
    assert np.allclose(found.distances, found.distances.T) and (np.diag(found.distances) == 0).all()
    assert found.rate >= 80, found.summary
    hits = sum(found.labels[t] == found.labels[q] for q in range(12) for t in found.ranking[q, :2])
    assert np.isclose(found.rate, 100 * hits / 24) and found.correct_at.sum() == hits
    assert np.allclose(found.confusion.sum(axis=1), 100)
    # As many frames on the sheet as right and wrong matches.
    frames = [(found.sheet == color).all(axis=2).sum() for color in (GREY, GREEN, RED)]
    assert found.sheet.shape == (1200, 1200, 3) and found.sheet.dtype == np.uint8
    assert frames[0] > 0 and frames == [frames[0], frames[0] * hits / 12, frames[0] * (24 - hits) / 12], frames
    assert tl.retrieval(images, labels, best=2, sheet_size=300).sheet.shape == (300, 300, 3)
    # Some pairs only, with the same distances; and the rates after diffusion.
    some = tl.retrieval(images, labels, best=2, shortlist=4)
    known = some.distances >= 0
    assert 12 < known.sum() < 144 and (some.distances[known] == found.distances[known]).all()
    assert f"{known.sum() - 12} of 132 pairs were matched" in some.summary, some.summary
    passed = tl.retrieval(images, labels, best=2, neighbors=3)
    assert passed.rate >= 80 and wording("after-diffusion") in passed.summary, passed.summary
    assert passed.distances.min() == 0 and passed.distances.max() <= 1
    rejected("shortlist", tl.retrieval, images, labels, shortlist=-1)
    rejected("neighbors", tl.retrieval, images, labels, neighbors=float("nan"))
    rejected("sheet_size", tl.retrieval, images, labels, sheet_size=0)
    rejected(wording("labels-for"), tl.retrieval, images, labels[:3])
    rejected("setting", tl.retrieval, images, labels, setting="best")


def test_commands():
    folder = OUTPUT / "set" / "images"
    folder.mkdir(parents=True, exist_ok=True)
    images, labels = _silhouettes.families(2, 3, seed=5)
    with open(folder.parent / "labels.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["file", "class"])
        for i, (image, label) in enumerate(zip(images, labels)):
            write_png(folder / f"{i}.png", image)
            writer.writerow([f"{i}.png", label])
    assert "triangles" in run("silhouette", folder / "2.png", "--spacing", 15, "-o", "bean.vtu")
    assert (OUTPUT / "bean.vtu").is_file()
    told = run("match", folder / "2.png", folder / "3.png", "--locations", "contour", "-o", "found.vtu")
    assert "Energy" in told and (OUTPUT / "found.vtu").is_file()
    told = run("retrieval", folder.parent, "--best", 1, "--csv", "best.csv", "--sheet", "sheet.png", "--neighbors", 0)
    assert wording("6-shapes-of-3-classes") in told, told
    expected = tl.retrieval(folder.parent, best=1).sheet
    written = tl._shapes_parts.as_image(OUTPUT / "sheet.png")
    pixels = vtk_to_numpy(written.GetPointData().GetScalars()).reshape(expected.shape)
    assert np.array_equal(pixels[::-1], expected)
    assert wording("no-directory") in run("retrieval", folder.parent, "--sheet", "nowhere/sheet.png", code=1)
    rows = list(csv.DictReader(open(OUTPUT / "best.csv")))
    assert len(rows) == 6 and rows[0]["QueryLabel"] == "disc"
    assert wording("no-such-file") in run("match", "a.png", "b.png", code=1)
    assert "shapes" in run("study", "list")
    assert wording("no-study-x") in run("study", "x", code=2)


def test_study():
    """Two seeds: rates by method and weight, pictures, and verdicts of such numbers as the dissertation's."""
    studies = Studies(OUTPUT / "study")
    told = studies.run("shapes", "--locations", "contour", "--seeds", "2")
    calls = studies.calls["shapes"]
    studies.check("shapes", 14, ("figure_5_5", "figure_5_6", "figure_5_7"), {"table_5_1": 20}, kimia(calls))
    first = [row for row in studies.rows("shapes", "table_5_1") if row["seed"] == "1" and row["b"] == "3.0"]
    rows = {row["method"]: row for row in first}
    full, plain = rows[shapes.TITLES["dissertation"]], rows[shapes.TITLES["felzenszwalb"]]
    assert full["dissertation"] == "72.2" and plain["dissertation"] == "64.4"
    assert 100 > float(full["rate"]) > float(plain["rate"]) > 30, rows
    assert wording("synthetic-silhouettes") in told
    assert "labels.csv" in run("study", "shapes", "--data", "nowhere", code=1)
    found = verdicts(kimia(calls), OUTPUT / "study")
    assert len(found) == 15 and set(found.values()) == {"holds"}, found
    # The printed rates are in the range of the rates with other weights: b decides, which the dissertation lacks.
    open_rates = {m: {0.3: r - 5, 1.0: r + 5} for m, r in zip(shapes.METHODS, (64.4, 70.0, 66.0, 72.2))}
    call = rate_call(calls), (open_rates, True), {}
    found = verdicts([call], OUTPUT / "study")
    assert [v for (source, _), v in found.items() if source == "Table 5.1"] == ["not decided"] * 2, found
    call = rate_call(calls), ({m: {b: r + 30 for b, r in row.items()} for m, row in open_rates.items()}, True), {}
    found = verdicts([call], OUTPUT / "study")
    assert [v for (source, _), v in found.items() if source == "Table 5.1"] == ["does not hold"] * 2, found
    call = rate_call(calls), (open_rates, False), {}
    found = verdicts([call], OUTPUT / "study")
    assert [v for (source, _), v in found.items() if source == "Table 5.1"] == ["not decided"] * 2, found


def rate_call(calls):
    """The function that states the findings on rates."""
    return next(function for function, _, _ in calls if function.__name__ == "rate_findings")


def kimia(calls):
    """The calls with numbers as the dissertation's, on its set, and one on theta."""
    rates = {m: {b: rate for b in (1.0, 3.0)} for m, rate in zip(shapes.METHODS, (64.4, 68.0, 66.0, 72.2))}
    made = {
        "rate_findings": (rates, True),
        "high_findings": ({"highest": 99.0, "diffusion": 100.0}, (97.1, 97.0), True),
        "figure_findings": ([(9, 10)], [(2, 4)], 0.1, [(0.5, 0.1), (0.4, 0.2)]),
    }
    return [(function, made[function.__name__], named) for function, _, named in calls] + [
        (shapes.theta_findings, (72.2, 72.0), {})]


def test_seeds():
    """Images of a folder get random borders with seeds after the first; they show the same."""
    images, _ = _silhouettes.families(1, 2, seed=5)
    moved = _silhouettes.moved(images, 2)
    again = _silhouettes.moved(images, 2)
    assert all(np.array_equal(a, b) for a, b in zip(moved, again))
    for image, other in zip(images, moved):
        assert other.shape > image.shape and other.sum() == image.sum()


def test_unseen_study():
    """A folder of images named by their class: the rate of the nearest members, and its verdicts."""
    folder = OUTPUT / "unseen"
    folder.mkdir(parents=True, exist_ok=True)
    images, labels = _silhouettes.families(4, 3, seed=2)
    for i, (image, label) in enumerate(zip(images, labels)):
        write_png(folder / f"{label}-{i}.png", image)
    studies = Studies(OUTPUT / "study_unseen")
    told = studies.run("shapes", "--data", str(folder), "--unseen", "--per-class", "3")
    assert wording("9-silhouettes-of-3-classes") in told, told
    function, (rates, seconds, count, real), _ = studies.calls["shapes"][0]
    large = [(function, (rates, time, 1400, True), {}) for time in (1.0, 1e6)]
    studies.check("shapes", 3, (), {"unseen": 2}, large)
    for row in studies.rows("shapes", "unseen"):
        assert 50 < float(row["rate"]) <= 100, row
    assert count == 9 and real and 0 < seconds < 100
    result = tl.retrieval(images, labels, setting="highest")
    ranked = np.array(result.labels)[result.ranking[:, :3]]
    expected = 100 * (ranked == np.array(result.labels)[:, None]).mean()
    assert abs(shapes.nearest_of_class(result) - expected) < 1e-9
    for rate, time, verdict in ((88.0, 3000.0, "holds"), (87.9, 4000.0, "does not hold")):
        call = function, (dict.fromkeys(rates, rate), time, 1400, True), {}
        assert set(verdicts([call], OUTPUT / "study_unseen").values()) == {verdict}
    call = function, (rates, seconds, 1399, False), {}
    assert set(verdicts([call], OUTPUT / "study_unseen").values()) == {"not decided"}


run_tests(globals())
