"""The verbs silhouette, match and retrieval, their commands, and the study on a small synthetic set."""

import csv
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import tautline as tl
from tautline.studies import _silhouettes

OUTPUT = Path(os.environ["TAUTLINE_TEST_DIR"]) / "shapes"
KIMIA = Path(os.environ["TAUTLINE_DATA_DIR"]).parent.parent / "shared" / "data" / "kimia99"


def raises(part, action, *arguments, **options):
    try:
        action(*arguments, **options)
    except tl.Error as error:
        assert part in str(error), error
    else:
        raise AssertionError(f"no error with '{part}'")


def run(*arguments, code=0):
    done = subprocess.run(
        [sys.executable, "-m", "tautline", *map(str, arguments)], cwd=OUTPUT, capture_output=True, text=True
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr


def write_png(file, image):
    from vtkmodules.vtkImagingCore import vtkImageCast
    from vtkmodules.vtkIOImage import vtkPNGWriter

    cast = vtkImageCast()
    cast.SetInputData(tl._shapes.as_image(image))
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
    # The centre of mass of the area is the mean of the pixels.
    y, x = np.nonzero(images[2])
    assert np.allclose(shape.centre, [x.mean(), y.mean()], atol=0.15), (shape.centre, x.mean(), y.mean())
    assert shape.components == 1 and shape.holes == 0
    raises("one value", tl.silhouette, np.ones((9, 9)))
    raises("spacing", tl.silhouette, images[0], 0)
    raises("no such file", tl.silhouette, "nowhere.png")
    raises("axes", tl.silhouette, np.ones(9))
    raises("foreground", tl.silhouette, images[0], foreground="pink")


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
    raises("no option 'c'", tl.match, images[2], images[3], c=1)
    raises("finite", tl.match, images[2], images[3], a=float("nan"))
    raises("too small", tl.match, images[2], images[3], grid=(1, 1))


def test_retrieval():
    images, labels = _silhouettes.families(3, 4, seed=2)
    found = tl.retrieval(images, labels, best=2)
    assert found.distances.shape == (12, 12) and found.ranking.shape == (12, 11)
    assert np.allclose(found.distances, found.distances.T) and (np.diag(found.distances) == 0).all()
    assert found.rate >= 80, found.summary
    hits = sum(found.labels[t] == found.labels[q] for q in range(12) for t in found.ranking[q, :2])
    assert np.isclose(found.rate, 100 * hits / 24) and found.correct_at.sum() == hits
    assert np.allclose(found.confusion.sum(axis=1), 100)
    raises("labels for", tl.retrieval, images, labels[:3])
    raises("setting", tl.retrieval, images, labels, setting="best")


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
    told = run("retrieval", folder.parent, "--best", 1, "--csv", "best.csv")
    assert "6 shapes of 3 classes" in told, told
    rows = list(csv.DictReader(open(OUTPUT / "best.csv")))
    assert len(rows) == 6 and rows[0]["QueryLabel"] == "disc"
    assert "no such file" in run("match", "a.png", "b.png", code=1)
    assert "shapes" in run("study", "list")
    assert "no study 'x'" in run("study", "x", code=1)


def test_study():
    options = ["--synthetic", "--size", "small", "--locations", "contour", "--no-pictures", "--out", "study"]
    told = run("study", "shapes", *options)
    rows = {row["method"]: row for row in csv.DictReader(open(OUTPUT / "study" / "table_5_1.csv"))}
    assert rows["dissertation"]["dissertation"] == "72.2" and rows["felzenszwalb"]["dissertation"] == "64.4"
    assert 100 > float(rows["dissertation"]["rate"]) > float(rows["felzenszwalb"]["rate"]) > 30, rows
    assert "holds, by" in (OUTPUT / "study" / "findings.txt").read_text(), told


def test_kimia():
    """A sixth of the queries' classes of the real set: two classes that are easily told apart from the others."""
    if not (KIMIA / "labels.csv").is_file():
        print("Kimia's silhouettes are not there: skipped")
        return
    shapes = tl.read_silhouettes(KIMIA)
    assert shapes.GetNumberOfBlocks() == 99
    some = [i for i in range(99) if i % 11 in (0, 3, 6, 9)]
    labels = [shapes.GetBlock(i).GetFieldData().GetAbstractArray("Label").GetValue(0) for i in some]
    assert len(set(labels)) == 9
    images = [shapes.GetBlock(i) for i in some]
    options = dict(setting="custom", locations="contour", best=3)
    ours = tl.retrieval(images, labels, **options)
    theirs = tl.retrieval(images, labels, **options, b=0, centre_tolerance=0)
    assert ours.rate > 80 and ours.rate > theirs.rate, (ours.summary, theirs.summary)


if __name__ == "__main__":
    OUTPUT.mkdir(parents=True, exist_ok=True)
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
            print(name)
