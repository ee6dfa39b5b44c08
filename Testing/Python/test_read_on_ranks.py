# SPDX-License-Identifier: BSD-3-Clause
"""test_read_on_ranks.py PVBATCH: MPI ranks share a file and compute what one rank does; skipped without mpirun.

Files of more than 1 MiB are read by ranges: the points, the arrays and the messages are those of one rank.
"""

import itertools
import shutil
from pathlib import Path

import numpy as np
from on_ranks import OUT, run_with_output

DATA = Path(__file__).parents[2] / "Data"
CLOSE = 1e-10
LARGE = OUT / "read-on-ranks"
EDGE = 21  # cubes of 6 tetrahedra each along an edge
DAMAGED_LINE = 30000


def write_large() -> None:
    """The same mesh in each format, and files with a damaged line near their middles."""
    side = EDGE + 1
    number = np.arange(side**3)
    points = np.stack([number % side, number // side % side, number // side**2], 1).astype(float)
    points += np.random.default_rng(3).uniform(-0.1, 0.1, points.shape)
    cube = np.arange(EDGE**3)
    first = cube % EDGE + side * (cube // EDGE % EDGE + side * (cube // EDGE**2))
    steps = (1, side, side**2)
    tetrahedra = np.concatenate(
        [np.stack([first + sum(order[:k]) for k in range(4)], 1) for order in itertools.permutations(steps)]
    )
    heat = [repr(value) for value in np.sin(number).tolist()]
    rows = [f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    cells = [" ".join(map(str, nodes)) for nodes in (tetrahedra + 1).tolist()]
    count, size = len(rows), len(cells)

    def write(name: str, *lists: list[str]) -> None:
        lines = list(itertools.chain(*lists))
        (LARGE / name).write_text("\n".join(lines) + "\n", encoding="utf-8")
        if not name.endswith((".node", ".sol")):
            lines[DAMAGED_LINE - 1] = "damaged " + lines[DAMAGED_LINE - 1]
            (LARGE / f"damaged-{name}").write_text("\n".join(lines) + "\n", encoding="utf-8")

    shutil.rmtree(LARGE, ignore_errors=True)
    LARGE.mkdir(parents=True)
    numbered = [f"{i} {row} {value}" for i, (row, value) in enumerate(zip(rows, heat), 1)]
    for name in ("large.node", "damaged-large.node"):
        write(name, [f"{count} 3 1 0", "# a comment", ""], numbered)
    write("large.ele", [f"{size} 4 1"], [f"{i} {nodes} {i % 3}  # one" for i, nodes in enumerate(cells, 1)])
    medit = ["MeshVersionFormatted 2", "Dimension 3"]
    write("large.mesh", [*medit, "Vertices", str(count)], [f"{row} {i % 5}" for i, row in enumerate(rows)],
          ["Tetrahedra", str(size)], [f"{nodes} {i % 3}" for i, nodes in enumerate(cells)], ["End"])  # fmt: skip
    write("large.sol", [*medit, "SolAtVertices", str(count), "1 1", ""], heat, ["End"])
    # numbers of nodes with gaps
    tags = (7 * np.arange(1, count + 1)).tolist()
    tagged = [" ".join(map(str, nodes)) for nodes in (7 * (tetrahedra + 1)).tolist()]
    data = ["$NodeData", "1", '"Heat"', "1", "0.0", "3", "0", "1", str(count)]
    data += [*(f"{tag} {value}" for tag, value in zip(tags, heat)), "$EndNodeData"]
    write("large2.msh", ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(count)],
          [f"{tag} {row}" for tag, row in zip(tags, rows)], ["$EndNodes", "$Elements", str(size)],
          [f"{i} 4 2 {i % 3} 1 {nodes}" for i, nodes in enumerate(tagged, 1)], ["$EndElements"], data)  # fmt: skip
    half = size // 2
    write("large4.msh", ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$Entities", "0 0 0 2"],
          ["1 0 0 0 1 1 1 1 5 0", "2 0 0 0 1 1 1 0 0", "$EndEntities", "$Nodes"],
          [f"1 {count} {tags[0]} {tags[-1]}", f"3 1 0 {count}"], map(str, tags), rows, ["$EndNodes", "$Elements"],
          [f"2 {size} 1 {size}", f"3 1 4 {half}"], [f"{i} {nodes}" for i, nodes in enumerate(tagged[:half], 1)],
          [f"3 2 4 {size - half}"], [f"{i} {nodes}" for i, nodes in enumerate(tagged[half:], half + 1)],
          ["$EndElements"], data)  # fmt: skip


def run(script: str, ranks: int) -> dict:
    """What the ranks have found; each damaged file has one message, the same whoever finds it."""
    found, text = run_with_output(script, ranks, str(DATA), str(LARGE))
    for file in damaged:
        message = f"{LARGE / file}:{DAMAGED_LINE}: "
        assert text.count(message) >= ranks, (ranks, file, text)
        assert found[file]["parts"] == 0, (ranks, file)
    others = [line for line in text.splitlines() if "ERR|" in line and "vtkMeshFileReader" not in line
              and "Executive" not in line]  # fmt: skip
    assert not others, others
    return found


def check_requests(ranks: int) -> None:
    """Which files the ranks read by ranges, and that none waits for a rank that does not take part."""
    result, text = run_with_output("requests_on_ranks.py", ranks, str(DATA), str(LARGE), symmetric=True)
    of_ranks = result["found"]
    by_ranges = {name for name, read in of_ranks[0].items() if read.get("ranges")}
    assert by_ranges == set(large), (by_ranges, text)
    for name, read in of_ranks[0].items():
        assert all(other[name]["ranges"] == read["ranges"] for other in of_ranks), name
    for name in large:
        cells = [read[name]["cells"] for read in of_ranks]
        assert sum(cells) == 6 * EDGE**3 and max(cells) - min(cells) <= 1, (name, cells)
    for name in damaged:
        assert all(f":{DAMAGED_LINE}: " in read[name]["message"] for read in of_ranks), (name, of_ranks)
    assert len({read["first piece"]["cells"] for read in of_ranks}) == 1
    assert of_ranks[0]["no name"] == {"ranges": False, "cells": 0, "message": "no file name"}, of_ranks[0]["no name"]
    for read in of_ranks[1:]:
        assert read["no name"] == {**read["large2.msh"], "ranges": False}, read["no name"]
    for name, read in of_ranks[-1]["alone"].items():
        assert read["cells"] > 0 and not read["message"], (name, read)


write_large()
damaged = sorted(path.name for path in LARGE.glob("damaged-*") if path.suffix not in {".node", ".sol"})
large = sorted(path.name for path in LARGE.glob("large*") if path.suffix not in {".node", ".sol"})
assert len(damaged) == len(large) == 4, (damaged, large)
for ranks in (2, 3):
    check_requests(ranks)
one = run("read_on_ranks.py", 1)
for ranks in (1, 2, 3):
    found = one if ranks == 1 else run("read_on_ranks.py", ranks)
    assert found["ranks"] == ranks
    for name in ("cube.1.ele", "part.msh", "cylinder.msh", "house.off"):
        assert found[name]["parts"] == ranks, (name, found[name])
        assert found[name]["cells"] == one[name]["cells"], (name, ranks)
        assert abs(found[name]["mean"] - one[name]["mean"]) < CLOSE * one[name]["mean"], (name, ranks)
    for name in large:
        same = {key: value for key, value in found[name].items() if key not in {"mean", "parts", "sizes"}}
        expected = {key: value for key, value in one[name].items() if key not in {"mean", "parts", "sizes"}}
        assert {"points", "Reference"} < set(same) and same == expected, (name, ranks, same, expected)
        assert found[name]["parts"] == ranks, (name, ranks)
        assert abs(found[name]["mean"] - one[name]["mean"]) < CLOSE * one[name]["mean"], (name, ranks)
        print(name, "on", ranks, "ranks: cells with ghosts", found[name]["sizes"])
    far = np.abs(np.array(found["optimized"]) - np.array(one["optimized"])).max()
    print(ranks, "ranks: farthest point", far)
    assert far < CLOSE
