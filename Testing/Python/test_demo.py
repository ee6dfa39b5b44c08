# SPDX-License-Identifier: BSD-3-Clause
"""test_demo.py MODULE...: the demo writes mesh, table and a picture that shows something.

It does so without the plugin, and with these compiled modules only: the target demo builds no more.
"""

import os
import runpy
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

OUT = Path(os.environ["TAUTLINE_TEST_DIR"], "demo")
MODULES = [f"Tautline{name}" for name in sys.argv[1:]]

shutil.rmtree(OUT, ignore_errors=True)
package = OUT / "lib/python3/dist-packages/tautline"  # as in the build tree: libraries are found from here
package.mkdir(parents=True)
whole = Path(find_spec("tautline").origin).parent
for path in whole.iterdir():
    if path.suffix != ".so" or path.stem in MODULES:
        (package / path.name).symlink_to(path)
for path in whole.parents[2].glob("*.so*"):
    (OUT / "lib" / path.name).symlink_to(path)
sys.path.insert(0, str(package.parent))

import tautline as tl  # noqa: E402

assert Path(tl.__file__).parent == package and not hasattr(tl, "vtkMeshWarp")
sys.argv = ["demo.py", str(OUT)]
runpy.run_module("tautline.demo", run_name="__main__")
result = tl.quality(OUT / "quality.vtu")
assert 10 < result.inverted < 100 and (OUT / "quality.csv").read_text().startswith("metric,label,")

reader = vtkPNGReader()
reader.SetFileName(str(OUT / "quality.png"))
reader.Update()
pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)[:, :3]
white = (pixels == 255).all(axis=1).mean()
blue = ((pixels[:, 0] < 60) & (pixels[:, 1] < 120) & (pixels[:, 2] > 150)).mean()
assert 0.4 < white < 0.85, white
assert 0.002 < blue < 0.1, blue

better = tl.quality(OUT / "better.vtu")
assert better.inverted == 0
assert better.statistics["imr"]["mean"] < result.statistics["imr"]["mean"]
reader.SetFileName(str(OUT / "better.png"))
reader.Update()
pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).astype(int)[:, :3]
legend = ((pixels[:, 0] < 60) & (pixels[:, 1] < 120) & (pixels[:, 2] > 150)).mean()
assert 0.4 < (pixels == 255).all(axis=1).mean() < 0.85 and legend < 0.5 * blue, (legend, blue)
