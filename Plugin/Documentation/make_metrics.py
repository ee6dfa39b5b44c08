# SPDX-License-Identifier: BSD-3-Clause
"""make_metrics.py [--write] [--pictures]: what is generated from the registry of metrics.

The sections of the page metrics.md (from metrics.md.in, with the formulas of formulas.json) and the list of metrics
that the panels include, ServerManager/Snippets/MetricDomain.xml. Without an option, compares and exits with 1 if they
differ, if README.md has another number of metrics, or if a panel has a list of its own; --write writes them; --pictures
draws metric_<name>.png with vtkMetricField.
Needs the package tautline: eval "$(./run env)" first.
"""

import html
import json
import sys
from pathlib import Path

from tautline import vtkElementQuality, vtkMetricField

HERE = Path(__file__).resolve().parent
PROXIES = HERE.parents[1] / "ServerManager"
DOMAIN = PROXIES / "Snippets/MetricDomain.xml"
MOST_BYTES = 6000  # of a picture

# The window of the pictures, and the colors of the plugin's color maps.
X, Y, PIXELS = (-1.0, 2.0), (-0.5, 1.75), 60  # pixels per unit length
RAMP = [(0.84, 0.90, 0.93), (0.99, 0.90, 0.55), (0.96, 0.55, 0.20), (0.72, 0.06, 0.11)]
INVERTED, BASE, IDEAL = (0.05, 0.35, 1.0), (0.0, 0.0, 0.0), (0.0, 0.45, 0.2)
BANDS = 10


def registry() -> list:
    """Every metric as a dict of the registry's fields."""
    fields = vtkElementQuality.GetKnownMetricFields().split("\t")
    count = vtkElementQuality.GetNumberOfKnownMetrics()
    facts = [dict(zip(fields, vtkElementQuality.GetKnownMetric(i).split("\t"))) for i in range(count)]
    return facts[: vtkElementQuality.GetNumberOfBuiltInMetrics()]


# --- the page --------------------------------------------------------------------------------------


def text(value: str) -> str:
    """A text in a cell of a table."""
    return html.escape(value, quote=False).replace("-inf", "-∞").replace(" inf", " ∞").replace("|", "\\|")


def by_dimension(metric: dict, name: str, between: str = "<br>") -> str:
    """ "1 to 3" if the same in 2D and 3D, else each with its dimension."""
    values = {d: metric[f"{name} {d}"] for d in ("2D", "3D") if d[0] in metric["dimensions"]}
    if len(set(values.values())) == 1:
        return text(values.popitem()[1])
    return between.join(f"{d}: {text(value)}" for d, value in values.items())


def table(head: list, rows: list) -> str:
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, ["---"] * len(head), *rows]) + "\n"


def overview(metrics: list) -> str:
    """A row for each metric, with a link to its section."""
    rows = [
        [f"[{text(m['label'])}](#{m['name']})", f"`{m['name']}`",
         by_dimension(m, "acceptable"), by_dimension(m, "ideal"), text(m["cell types"])]
        for m in metrics
    ]  # fmt: skip
    return table(["Metric", "Array", "Acceptable", "Ideal", "Cells"], rows)


def section(metric: dict, formula: str) -> str:
    """Formula, source, picture and facts of a metric."""
    name = metric["name"]
    also = f", also {text(metric['aliases'].replace(',', ', '))}" if metric["aliases"] else ""
    unit = f", in {text(metric['unit'])}" if metric["unit"] else ""
    ranges = {"full range": "full", "acceptable": "acceptable", "ideal": "ideal"}
    yes_or_no = ("barrier", "differentiable", "scale invariant", "rotation invariant")
    facts = [
        f"Cells: {text(metric['cell types'])}",
        "; ".join(f"{label}: {by_dimension(metric, key, ', ')}" for label, key in ranges.items()) + unit,
        metric["direction"],
        f"Inverted elements: {metric['inverted']}",
        "; ".join(f"{key.replace(' ', '-')}: {metric[key]}" for key in yes_or_no),
    ]
    listed = "\n".join(f"- {fact[0].upper()}{fact[1:]}" for fact in facts)
    return f"""<a name="{name}"></a>

### {text(metric["label"])}

`{name}`, symbol {text(metric["symbol"])}{also}

<!-- formula: {metric["formula"]} -->
$$
{formula}
$$

*{text(metric["source"])}*

![field of {name}](metric_{name}.png)

{listed}
"""


def page(metrics: list) -> str:
    formulas = json.loads((HERE / "formulas.json").read_text(encoding="utf-8"))
    sections = "\n".join(section(metric, formulas[metric["name"]]) for metric in metrics)
    made = (HERE / "metrics.md.in").read_text(encoding="utf-8").replace("@COUNT@", str(len(metrics)))
    return made.replace("@OVERVIEW@", overview(metrics)).replace("@SECTIONS@", f"## The metrics\n\n{sections}")


# --- the list of the panels --------------------------------------------------------------------------


def domain(metrics: list) -> str:
    entries = "".join(f'    <Entry value="{m["number"]}" text="{html.escape(m["label"])}"/>\n' for m in metrics)
    return f"""<!-- Written by Plugin/Documentation/make_metrics.py from the registry of metrics. -->
<Snippet automatic="">
  <EnumerationDomain name="enum">
<?if automatic?>    <Entry value="-1" text="@automatic@"/><?end?>
{entries}    <RequiredProperties>
      <Property name="UserMetrics" function="List"/>
    </RequiredProperties>
  </EnumerationDomain>
</Snippet>
"""


def wrong_lists(metrics: list):
    """Panels must include the list, and have none of their own."""
    panels = {path: path.read_text(encoding="utf-8") for path in PROXIES.rglob("*.xml*") if path != DOMAIN}
    own = f'text="{html.escape(metrics[0]["label"])}"'
    yield from (f"{path} has a list of metrics of its own" for path, content in panels.items() if own in content)
    if not any(f"<?include {DOMAIN.name}?>" in content for content in panels.values()):
        yield f"no XML file includes {DOMAIN.name}"


# --- the pictures ------------------------------------------------------------------------------------


def field(metric: dict):
    """Values and validity over the window, first row at the bottom; of tetrahedra, over their plane of symmetry."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    columns, rows = (round((end - start) * PIXELS) for start, end in (X, Y))
    if metric["family"] == "faces":
        return field_of_faces(metric, columns, rows)
    source = vtkMetricField()
    source.AddMetricByName(metric["name"])
    if "2" in metric["dimensions"]:
        source.SetBounds(*X, *Y, 0, 0)
        source.SetDimensions(columns, rows, 1)
    else:
        middle = 3**0.5 / 6  # y of the center of the base
        source.SetCellToTetrahedron()
        source.SetBounds(*X, middle, middle, *Y)
        source.SetDimensions(columns, 1, rows)
    source.Update()
    data = source.GetOutput().GetPointData()
    return [vtk_to_numpy(data.GetArray(name)).reshape(rows, columns) for name in (metric["name"], "Validity")]


def field_of_faces(metric: dict, columns: int, rows: int):
    """The same of a triangle between three others, whose outer points are those about the regular one."""
    import numpy as np
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_TRIANGLE, vtkCellArray, vtkUnstructuredGrid

    height = 3**0.5 / 2
    corners = np.array([(0, 0), (1, 0), (0.5, height), (0.5, -height), (1.5, height), (-0.5, height)])
    triangles = np.array([(0, 1, 2), (1, 0, 3), (2, 1, 4), (0, 2, 5)])
    x, y = np.meshgrid(np.linspace(*X, columns), np.linspace(*Y, rows))
    points = np.zeros((x.size, len(corners), 3))
    points[:, :, :2] = corners
    points[:, 2, 0], points[:, 2, 1] = x.ravel(), y.ravel()
    points[:, :, :2] += 10 * np.stack([x.ravel() - X[0], y.ravel() - Y[0]], axis=1)[:, None, :] * PIXELS  # side by side
    cells = triangles + len(corners) * np.arange(x.size)[:, None, None]
    grid, places, polygons = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(points.reshape(-1, 3), deep=True))
    polygons.SetData(3, numpy_to_vtkIdTypeArray(cells.reshape(-1), deep=True))
    grid.SetPoints(places)
    grid.SetCells(VTK_TRIANGLE, polygons)
    quality = vtkElementQuality()
    quality.SetInputData(grid)
    quality.AddMetricByName(metric["name"])
    quality.SetReversedMesh(quality.MEASURE_AS_GIVEN)
    quality.SetFaceOutput(quality.NO_FACES)
    quality.Update()
    data = quality.GetOutputDataObject(0).GetCellData()
    # What differs by rounding is of one band.
    return [
        vtk_to_numpy(data.GetArray(name))[:: len(triangles)].reshape(rows, columns).round(9)
        for name in (metric["name"], "Validity")
    ]


def picture(metric: dict):
    """RGB of one metric: bands of equal area, pale is good; blue is inverted, where the metric's sign shows it."""
    import numpy as np

    values, validity = field(metric)
    signed = metric["inverted"] == "negative"
    shown = validity == 1 if signed else validity != 0
    badness = -values if metric["direction"].startswith("larger") else values
    levels = np.unique(np.quantile(badness[shown], np.linspace(0, 1, BANDS + 1)[1:-1]))
    band = np.searchsorted(levels, badness) / max(len(levels), 1)
    ramp = np.array(RAMP)
    stops = np.linspace(0, 1, len(ramp))
    rgb = np.stack([np.interp(band, stops, ramp[:, c]) for c in range(3)], axis=-1)
    rgb[validity == 0] = RAMP[-1]
    if signed:
        rgb[validity == -1] = INVERTED

    def pixel(x, y):
        return round((y - Y[0]) * PIXELS), round((x - X[0]) * PIXELS)

    row_number, left = pixel(0, 0)
    rgb[row_number - 1 : row_number + 1, left : pixel(1, 0)[1] + 1] = BASE
    height = 3**0.5 / 2 if "2" in metric["dimensions"] else (2 / 3) ** 0.5
    up, across = pixel(0.5, height)
    rgb[up - 2 : up + 3, across - 2 : across + 3] = IDEAL
    return (rgb * 255).astype(np.uint8)


def draw(metric: dict, path: Path) -> None:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkPNGWriter

    rgb = picture(metric)
    image = vtkImageData()
    image.SetDimensions(rgb.shape[1], rgb.shape[0], 1)
    image.GetPointData().SetScalars(numpy_to_vtk(rgb.reshape(-1, 3), deep=True))
    writer = vtkPNGWriter()
    writer.SetCompressionLevel(9)
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.Write()


def wrong_pictures(metrics: list):
    wanted = {f"metric_{m['name']}.png" for m in metrics}
    found = {path.name: path.stat().st_size for path in HERE.glob("metric_*.png")
             if not path.with_suffix(".md").is_file()}  # of a help page
    yield from (f"{name}: there is no such picture" for name in sorted(wanted - set(found)))
    yield from (f"{name}: of no metric" for name in sorted(set(found) - wanted))
    yield from (f"{name}: {size} bytes, at most {MOST_BYTES}" for name, size in found.items() if size > MOST_BYTES)


def main(options: set) -> int:
    if options - {"--write", "--pictures"}:
        sys.exit(__doc__)
    metrics = registry()
    if "--pictures" in options:
        for metric in metrics:
            draw(metric, HERE / f"metric_{metric['name']}.png")
    wanted = {HERE / "metrics.md": page(metrics), DOMAIN: domain(metrics)}
    complaints = [*wrong_pictures(metrics), *wrong_lists(metrics)]
    for path, content in wanted.items():
        if "--write" in options:
            path.write_text(content, encoding="utf-8")
        elif not path.is_file() or path.read_text(encoding="utf-8") != content:
            complaints.append(f"{path} is not what the registry says")
    if f"{len(metrics)} quality metrics" not in (HERE.parents[1] / "README.md").read_text(encoding="utf-8"):
        complaints.append(f"README.md does not say that there are {len(metrics)} quality metrics")
    print("\n".join(complaints + [f"{len(metrics)} metrics, {len(complaints)} complaints"]))
    if complaints:
        print("remedy: python3 Plugin/Documentation/make_metrics.py --write --pictures")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(set(sys.argv[1:])))
