# SPDX-License-Identifier: BSD-3-Clause
"""pvpython make_strips.py FOLDER [--play BUILD]: makes the pictures of ParaView's window from screenshots of sessions.

    pvpython Plugin/Documentation/make_strips.py /tmp/screenshots --play build

plays the sessions of the tutorial and the jobs (Testing/Gui) with the plugin of the build tree, which takes some
minutes, and makes all pictures; without --play, it makes pictures of the screenshots that are in FOLDER.

The screenshots of job N are jobN-STEP-NAME.png (Testing/Gui/screenshots.py). Its strip is job_N.png; the place of the
strip in jobs.md is between the comments <!-- strip: N --> and <!-- end of strip -->. Jobs without screenshots in
FOLDER keep their strips. A file tutorial-N-NAME.png becomes tutorial_N_NAME.png, with the places to click of
tutorial-N-NAME.json marked; a tutorial_*.png without a screenshot is an error. openfoam-N-NAME.png becomes
openfoam_mesh_N.png of Plugin/Site/openfoam-mesh.md, and openfoam-3-*.png may be a plot of
Testing/OpenFoam/solve_case.py.
"""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from small_png import read, shrink, write_smooth  # noqa: E402

PAGE = HERE / "jobs.md"
JOBS = range(1, 8)
GUI, DATA = HERE.parents[1] / "Testing" / "Gui", HERE.parents[1] / "Data"
SESSIONS = ("Tutorial*", "Job*")  # which save screenshots
COLUMNS, GAP = 2, 8  # of a strip; pixels between two frames
WIDEST = 1200  # of a picture on the site (Testing/Docs/check_links.py)
WIDTH = (WIDEST - (COLUMNS - 1) * GAP) // COLUMNS  # of a frame
MARK, WHITE = (235, 95, 0), (255, 255, 255)  # no color of a mesh
THICK, RADIUS, APART = 3, 12, 4  # pixels: of a frame around a widget, of its number, and between widget and frame
NARROW = 40  # pixels: of a widget that a number would hide
#: The digits from 1, 5 x 7 pixels.
DIGITS = """
..#.. .###. ##### ...#. ##### ..##. ##### .###. .###.
.##.. #...# ...#. ..##. #.... .#... ....# #...# #...#
..#.. ....# ..#.. .#.#. ####. #.... ...#. #...# #...#
..#.. ...#. ...#. #..#. ....# ####. ..#.. .###. .####
..#.. ..#.. ....# ##### ....# #...# .#... #...# ....#
..#.. .#... #...# ...#. #...# #...# .#... #...# ...#.
.###. ##### .###. ...#. .###. .###. .#... .###. .##..
"""


def window(image: np.ndarray) -> np.ndarray:
    """The screen without the black border around the window."""
    lit = image[..., :3].max(axis=2) > 0
    rows, columns = np.flatnonzero(lit.any(axis=1)), np.flatnonzero(lit.any(axis=0))
    return image[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1, :3]


def digit(number: int) -> np.ndarray:
    """A digit from 1 to 9 as a field of truth values, twice its size."""
    rows = [line.split()[number - 1] for line in DIGITS.split("\n") if line]
    return np.array([[mark == "#" for mark in row] for row in rows]).repeat(2, axis=0).repeat(2, axis=1)


def frame(image: np.ndarray, place: list, apart: int, thick: int, color: tuple) -> None:
    """A frame around a rectangle, within the image."""
    left, top, wide, high = place
    rows, columns = np.ogrid[: image.shape[0], : image.shape[1]]

    def inside(margin: int) -> np.ndarray:
        across = np.maximum(left - columns, columns - left - wide + 1)
        return np.maximum(across, np.maximum(top - rows, rows - top - high + 1)) <= margin

    image[inside(apart + thick) & ~inside(apart)] = color


def marked(image: np.ndarray, places: list) -> np.ndarray:
    """The image with frames around the places, numbered if there are several."""
    image = image[..., :3].copy()
    for place in places:
        frame(image, place, APART - 1, THICK + 2, WHITE)
        frame(image, place, APART, THICK, MARK)
    rows, columns = np.ogrid[: image.shape[0], : image.shape[1]]
    for number, (left, top, wide, _) in enumerate(places if len(places) > 1 else (), 1):
        x = left + wide + APART + RADIUS if wide < NARROW else max(left - APART, RADIUS + 1)  # beside small ones
        y = max(top - APART, RADIUS + 1)
        apart = np.hypot(columns - x, rows - y)
        image[apart <= RADIUS + 1] = WHITE
        image[apart <= RADIUS] = MARK
        shape = digit(number)
        high, wide = shape.shape
        image[y - high // 2 : y - high // 2 + high, x - wide // 2 : x - wide // 2 + wide][shape] = WHITE
    return image


def strip(files: list) -> np.ndarray:
    """The frames in rows, from left to right, and the last one below them, large."""
    windows = [window(read(file)) for file in files]
    last = shrink(windows.pop(), WIDEST)
    frames = [shrink(image, WIDTH) for image in windows]
    height = max((image.shape[0] for image in frames), default=0) + GAP
    begin = -(-len(frames) // COLUMNS) * height
    result = np.full((begin + last.shape[0], WIDEST, 3), 255, np.uint8)
    for number, image in enumerate(frames):
        top, left = number // COLUMNS * height, number % COLUMNS * (WIDTH + GAP)
        result[top : top + image.shape[0], left : left + WIDTH] = image
    result[begin:] = last
    return result


def make_jobs(folder: Path) -> None:
    text = PAGE.read_text(encoding="utf-8")
    for job in JOBS:
        files = sorted(folder.glob(f"job{job}-*.png"))
        if not files:
            print(f"job {job}: no screenshots in {folder}")
            continue
        picture = HERE / f"job_{job}.png"
        write_smooth(strip(files), picture)
        begin, end = f"<!-- strip: {job} -->\n", "<!-- end of strip -->"
        image = f"\n![The steps of job {job}]({picture.name})\n\n"
        text, places = re.subn(f"{begin}.*?{end}", f"{begin}{image}{end}", text, flags=re.DOTALL)
        assert places == 1, f"jobs.md has {places} places for the strip of job {job}"
        print(f"{picture.name}: {len(files)} frames, {picture.stat().st_size} bytes")
    if text != PAGE.read_text(encoding="utf-8"):
        PAGE.write_text(text, encoding="utf-8")


def make_tutorial(folder: Path) -> None:
    made = set()
    for file in sorted(folder.glob("tutorial-*.png")):
        picture = HERE / f"{file.stem.replace('-', '_')}.png"
        write_smooth(marked(read(file), json.loads(file.with_suffix(".json").read_text(encoding="utf-8"))), picture)
        print(picture.name, picture.stat().st_size)
        made.add(picture)
    left = sorted(path.name for path in set(HERE.glob("tutorial_*.png")) - made)
    assert not (made and left), f"no session makes {left}"


def play(build: Path, folder: Path) -> None:
    """Plays the sessions one after another in one ParaView, which saves the screenshots."""
    plugin = next(build.glob("lib/paraview-*/plugins/Tautline"))
    environment = {
        **os.environ, "TAUTLINE_SCREENSHOTS": str(folder), "TAUTLINE_GUI": str(GUI), "LIBGL_ALWAYS_SOFTWARE": "1",
        "TAUTLINE_WIDGETS": str(build / "Testing/Gui/libTautlineWidgetPlaces.so"), "TAUTLINE_DATA_DIR": str(DATA),
        "TAUTLINE_SAMPLE": str(DATA / "bracket-tangled.vtu"), "TAUTLINE_TEST_DIR": str(folder),
        "TAUTLINE_SAMPLE_SCRIPT": str(HERE.parent / "open_sample.py"),
        "PARAVIEW_TEST_BASELINE_DIR": str(HERE.parents[1] / "Testing" / "Baseline"),
    }  # fmt: skip
    environment.pop("PV_PLUGIN_PATH", None)  # a plugin is loaded once
    script = folder / "sessions.xml"
    sessions = [file for pattern in SESSIONS for file in sorted(GUI.glob(f"{pattern}.xml"))]
    subprocess.run([sys.executable, GUI / "join_sessions.py", "--no-pictures", script, *sessions], check=True)
    subprocess.run(
        [build / "Testing" / "Gui" / "headless-paraview", f"--plugin-search-paths={plugin}", "--plugins=Tautline",
         f"--test-script={script}", f"--test-directory={folder}", f"--data-directory={DATA}", "--dr", "--exit"],
        env=environment, check=True)  # fmt: skip


def main(folder: Path, build: str) -> None:
    folder = folder.resolve()
    if build:
        folder.mkdir(parents=True, exist_ok=True)
        for old in (*folder.glob("*.png"), *folder.glob("*.json")):
            if re.match("job|tutorial-|openfoam-[12]", old.name):
                old.unlink()
        play(Path(build).resolve(), folder)
    make_jobs(folder)
    make_tutorial(folder)
    for file in folder.glob("openfoam-*.png"):
        picture = HERE / f"openfoam_mesh_{file.name.split('-')[1]}.png"
        write_smooth(shrink(window(read(file)), WIDEST), picture)
        print(picture.name, picture.stat().st_size)


if __name__ == "__main__":
    names = [name for name in sys.argv[1:] if name != "--play"]
    main(Path(names[0]), names[1] if "--play" in sys.argv else "")
