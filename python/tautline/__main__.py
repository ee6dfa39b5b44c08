"""The verbs from a shell: python3 -m tautline VERB ..."""

from __future__ import annotations

import argparse
import json
import sys
from importlib import import_module
from typing import Any

import tautline
from tautline import _quality, _tables


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",") if name.strip()]


def _quality_run(arguments: argparse.Namespace) -> None:
    result = tautline.quality(
        arguments.mesh,
        arguments.metrics,
        combination=arguments.combination,
        power=arguments.power,
        reference=arguments.reference,
        size=_number_or_name(arguments.size),
        tensor=arguments.tensor,
        beta=arguments.beta,
        epsilon=arguments.epsilon,
        reversed_mesh=arguments.reversed_mesh,
        histogram_bins=arguments.histogram_bins,
        threads=arguments.threads,
    )
    print(_tables.quality_text(result, arguments.worst))
    if arguments.output:
        _say(tautline.write(result, arguments.output))
    if arguments.csv:
        _save(arguments.csv, _tables.csv_text(_tables.quality_rows(result)))


def _perturb_run(arguments: argparse.Namespace) -> None:
    result = tautline.perturb(
        arguments.mesh,
        fraction=arguments.fraction,
        percentage=arguments.percentage,
        seed=arguments.seed,
        tangle=arguments.tangle,
        fixed=arguments.fixed,
        threads=arguments.threads,
    )
    print(result.summary)
    _say(tautline.write(result, arguments.output))


def _compare_run(arguments: argparse.Namespace) -> None:
    result = tautline.compare(
        arguments.before,
        arguments.after,
        arguments.metrics,
        tolerance=arguments.tolerance,
        threads=arguments.threads,
    )
    print(_tables.comparison_text(result))
    if arguments.output:
        _say(tautline.write(result, arguments.output))
    if arguments.csv:
        _save(arguments.csv, _tables.csv_text(_tables.comparison_rows(result)))


def _field_run(arguments: argparse.Namespace) -> None:
    given = {"bounds": arguments.bounds, "dimensions": arguments.dimensions}
    options: dict[str, Any] = {key: value for key, value in given.items() if value}
    result = tautline.metric_field(arguments.metrics, arguments.cell, threads=arguments.threads, **options)
    for name, values in result.values.items():
        valid = values[result.validity == 1]
        range_ = f"{valid.min():.6g} to {valid.max():.6g}" if valid.size else "no valid position"
        print(f"{name}: {' x '.join(map(str, values.shape[::-1]))} points, {range_}")
    _say(tautline.write(result, arguments.output))


def _metrics_run(arguments: argparse.Namespace) -> None:
    facts = tautline.metrics()
    if arguments.json:
        print(json.dumps(_tables.finite(facts), indent=2))
    elif arguments.markdown:
        print(_tables.metrics_markdown(facts))
    else:
        print(_tables.metrics_text(facts))


def _study_run(arguments: argparse.Namespace) -> int:
    return import_module("tautline.studies").main(arguments.arguments)


def _number_or_name(text: str | None) -> float | str | None:
    try:
        return None if text is None else float(text)
    except ValueError:
        return text


def _say(files: list[str]) -> None:
    print("\n".join(files))


def _save(file: str, text: str) -> None:
    try:
        with open(file, "w", encoding="utf-8", newline="") as out:
            out.write(text)
    except OSError as error:
        raise tautline.Error(f"{file}: cannot be written: {error.strerror}") from None
    print(file)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m tautline", description="Measure, repair, warp and match meshes.")
    verbs = parser.add_subparsers(dest="verb", metavar="VERB", required=True)

    def verb(name: str, run: Any, text: str, *, metrics: bool = True, threads: bool = True) -> argparse.ArgumentParser:
        made = verbs.add_parser(name, help=text, description=text[0].upper() + text[1:] + ".")
        made.set_defaults(run=run)
        if metrics:
            made.add_argument("--metrics", type=_names, default=["imr"], metavar="NAME,...",
                              help="names, see the verb metrics (default: imr)")  # fmt: skip
        if threads:
            made.add_argument("--threads", type=int, default=0, help="0, the default, is all cores")
        return made

    made = verb("quality", _quality_run, "measure every element of a mesh")
    made.add_argument("mesh", metavar="FILE")
    made.add_argument("-o", "--output", metavar="FILE", help="write the mesh with a cell array per metric")
    made.add_argument("--csv", metavar="FILE", help="write the statistics, a row per metric")
    made.add_argument("--worst", type=int, choices=range(11), default=0, metavar="0..10",
                      help="list so many of the worst elements")  # fmt: skip
    made.add_argument("--combination", choices=_quality.COMBINATIONS, default="mean", help="of the corners of a cell")
    made.add_argument("--power", type=float, default=2.0, help="exponent of the power mean (default: 2)")
    target = made.add_mutually_exclusive_group()
    target.add_argument("--reference", metavar="FILE", help="target: the same cells of this mesh")
    target.add_argument("--size", metavar="VALUE|ARRAY", help="target: this area or volume, or that in an array")
    target.add_argument("--tensor", metavar="ARRAY", help="target: the metric tensor in this array of the mesh")
    made.add_argument("--beta", type=float, default=0.0, help="of the untangling metric (default: 0)")
    made.add_argument("--epsilon", type=float, default=1e-4, help="of mu_211 and mu_311 (default: 1e-4)")
    made.add_argument("--reversed-mesh", choices=_quality.REVERSED, default="measure flipped")
    made.add_argument("--histogram-bins", type=int, default=32, help=argparse.SUPPRESS)

    made = verb("perturb", _perturb_run, "move interior points at random", metrics=False)
    made.add_argument("mesh", metavar="FILE")
    made.add_argument("-o", "--output", metavar="FILE", required=True)
    made.add_argument("--fraction", type=float, default=0.5, help="of the distance to inversion, 0 to 1 (default: 0.5)")
    made.add_argument("--percentage", type=float, default=50, help="of the points to move, 0 to 100 (default: 50)")
    made.add_argument("--seed", type=int, default=1, help="another number, another mesh (default: 1)")
    made.add_argument("--tangle", type=float, default=0.0, help="fraction of elements to invert, 0 to 1 (default: 0)")
    made.add_argument("--fixed", metavar="ARRAY", help="point array, not 0 where points stay")

    made = verb("compare", _compare_run, "tell what changed between two meshes with the same cells")
    made.add_argument("before", metavar="BEFORE")
    made.add_argument("after", metavar="AFTER")
    made.add_argument("-o", "--output", metavar="FILE", help="write the second mesh with the differences")
    made.add_argument("--csv", metavar="FILE", help="write the comparison, a row per metric")
    made.add_argument("--tolerance", type=float, default=1e-6, help="up to which values are equal (default: 1e-6)")

    made = verb("field", _field_run, "a metric as a function of a cell's last vertex, on a grid")
    made.add_argument("-o", "--output", metavar="FILE.vti", required=True)
    made.add_argument("--cell", choices=("triangle", "tetrahedron"), default="triangle")
    made.add_argument("--bounds", type=float, nargs=6, metavar="X",
                      help="xmin xmax ymin ymax zmin zmax (default: -1 2 0 2 0 2)")  # fmt: skip
    made.add_argument("--dimensions", type=int, nargs=3, metavar="N", help="grid points (default: 301 201 101)")

    made = verb("metrics", _metrics_run, "list the metrics", metrics=False, threads=False)
    form = made.add_mutually_exclusive_group()
    form.add_argument("--markdown", action="store_true", help="as a Markdown table")
    form.add_argument("--json", action="store_true", help="all facts")

    made = verbs.add_parser("study", help="regenerate tables and figures of the dissertation; study list names them",
                            add_help=False)  # fmt: skip
    made.add_argument("arguments", nargs=argparse.REMAINDER)
    made.set_defaults(run=_study_run)

    for module in ("_optimization", "_deformation", "_shapes", "_conditioning", "_peridynamics", "_inputs"):
        try:
            import_module(f"tautline.{module}").add_commands(verbs)
        except ImportError:  # built without the modules it needs
            pass
    return parser


def main(arguments: list[str] | None = None) -> int:
    """Run a verb; 0 is success, 1 an error (told on stderr); wrong usage exits with 2."""
    parsed = _parser().parse_args(arguments)
    try:
        return parsed.run(parsed) or 0
    except tautline.Error as error:
        print(f"tautline: {error}", file=sys.stderr)
        return 1
    except BrokenPipeError:  # ... | head
        sys.stderr.close()
        return 1


if __name__ == "__main__":
    sys.exit(main())
