# SPDX-License-Identifier: BSD-3-Clause
"""pvpython make_strips.py FOLDER: makes the picture strips of jobs.html from the screenshots that the sessions save.

    TAUTLINE_SCREENSHOTS=FOLDER ctest --test-dir build -R '^Gui.(Quality|Repair|Fields|Shapes)$'
    pvpython Plugin/Documentation/make_strips.py FOLDER

The screenshots of job N are jobN-STEP-NAME.png (Testing/Gui/screenshots.py). Its strip is job_N.png; the place of the
strip in jobs.html is between the comments <!-- strip: N --> and <!-- end of strip -->. Jobs without screenshots in
FOLDER keep their strips. A file tutorial-7-report.png becomes the picture of the tutorial's step; openfoam-N-NAME.png
becomes openfoam_mesh_N.png of Plugin/Site/openfoam-mesh.md, and openfoam-3-*.png may be a plot of
Testing/OpenFoam/solve_case.py.
"""

import re
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from small_png import FINEST, MAX_COLOURS, read, shrink, write  # noqa: E402

PAGE = HERE / "jobs.html"
JOBS = range(1, 8)
WIDTH, GAP = 326, 8  # pixels of a frame, and between two
COLUMNS = 2
WIDE = COLUMNS * (WIDTH + GAP) - GAP
WIDEST = 860  # of a picture on the site (Testing/Docs/check_links.py)
SHADE = 24  # shades are rounded to multiples, for small files


def window(image: np.ndarray) -> np.ndarray:
    """The screen without the black border around the window."""
    lit = image[..., :3].max(axis=2) > 0
    rows, columns = np.flatnonzero(lit.any(axis=1)), np.flatnonzero(lit.any(axis=0))
    return image[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1, :3]


def posterized(image: np.ndarray) -> np.ndarray:
    return np.minimum((image.astype(int) + SHADE // 2) // SHADE * SHADE, 255).astype(np.uint8)


def frequent(image: np.ndarray) -> np.ndarray:
    """Each color is replaced by the nearest of the most frequent ones: dim faces keep their colors."""
    rounded = np.minimum((image.astype(int) + FINEST // 2) // FINEST * FINEST, 255)
    colors, places, counts = np.unique(rounded.reshape(-1, 3), axis=0, return_inverse=True, return_counts=True)
    kept = colors[np.argsort(-counts, kind="stable")[:MAX_COLOURS]]
    nearest = [((kept - color) ** 2).sum(axis=1).argmin() for color in colors]
    return kept[nearest][places].reshape(image.shape).astype(np.uint8)


def strip(files: list) -> np.ndarray:
    """The frames in rows, from left to right, and the last one below them, large."""
    windows = [window(read(file)) for file in files]
    last = shrink(windows.pop(), WIDE)
    frames = [shrink(image, WIDTH) for image in windows]
    height = max((frame.shape[0] for frame in frames), default=0) + GAP
    begin = -(-len(frames) // COLUMNS) * height
    result = np.full((begin + last.shape[0], WIDE, 3), 255, np.uint8)
    for number, frame in enumerate(frames):
        top, left = number // COLUMNS * height, number % COLUMNS * (WIDTH + GAP)
        result[top : top + frame.shape[0], left : left + WIDTH] = frame
    result[begin:] = last
    return posterized(result)


def main(folder: Path) -> int:
    text = PAGE.read_text(encoding="utf-8")
    made = 0
    for job in JOBS:
        files = sorted(folder.glob(f"job{job}-*.png"))
        if not files:
            print(f"job {job}: no screenshots in {folder}")
            continue
        picture = HERE / f"job_{job}.png"
        write(strip(files), picture)
        begin, end = f"<!-- strip: {job} -->\n", "<!-- end of strip -->"
        image = f'<p><img src="{picture.name}" alt="The steps of job {job}"></p>\n'
        text, places = re.subn(f"{begin}.*?{end}", f"{begin}{image}{end}", text, flags=re.DOTALL)
        assert places == 1, f"jobs.html has {places} places for the strip of job {job}"
        print(f"{picture.name}: {len(files)} frames, {picture.stat().st_size} bytes")
        made += 1
    PAGE.write_text(text, encoding="utf-8")
    for file in folder.glob("tutorial-7-*.png"):
        write(posterized(shrink(window(read(file)), WIDE)), HERE / "tutorial_7.png")
        made += 1
    for file in folder.glob("openfoam-*.png"):
        write(frequent(shrink(window(read(file)), WIDEST)), HERE / f"openfoam_mesh_{file.name.split('-')[1]}.png")
        made += 1
    return 0 if made else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
