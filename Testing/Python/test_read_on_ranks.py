# SPDX-License-Identifier: BSD-3-Clause
"""test_read_on_ranks.py PVBATCH: MPI ranks share a file and compute what one rank does; skipped without mpirun.

The points, the arrays and the messages equal one rank's, also where a rank gets no cell. An error on one rank is
an error on all.
"""

import itertools
import shutil
from pathlib import Path

import numpy as np
from on_ranks import OUT, run_with_output

DATA = Path(__file__).parents[2] / "Data"
CLOSE = 1e-10
FORMATS = OUT / "read-on-ranks"
EDGE = 6  # cubes of 6 tetrahedra each along an edge
DAMAGED_LINE = 1000
COMPANIONS = {".node", ".sol"}


def write_formats(stem: str, edge: int, size: int) -> None:
    """The same tetrahedra in each format, and files with a damaged line where they have as many lines."""
    side = edge + 1
    number = np.arange(side**3)
    points = np.stack([number % side, number // side % side, number // side**2], 1).astype(float)
    points += np.random.default_rng(3).uniform(-0.1, 0.1, points.shape)
    cube = np.arange(edge**3)
    first = cube % edge + side * (cube // edge % edge + side * (cube // edge**2))
    steps = (1, side, side**2)
    tetrahedra = np.concatenate(
        [np.stack([first + sum(order[:k]) for k in range(4)], 1) for order in itertools.permutations(steps)]
    )[:size]
    heat = [repr(value) for value in np.sin(number).tolist()]
    rows = [f"{x!r} {y!r} {z!r}" for x, y, z in points.tolist()]
    cells = [" ".join(map(str, nodes)) for nodes in (tetrahedra + 1).tolist()]
    count = len(rows)

    def write(ending: str, *lists: list[str]) -> None:
        lines = list(itertools.chain(*lists))
        file = FORMATS / (stem + ending)
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        damaged = file.with_name("damaged-" + file.name)
        if file.suffix in COMPANIONS:
            shutil.copy(file, damaged)
        elif len(lines) > DAMAGED_LINE:
            lines[DAMAGED_LINE - 1] = "damaged " + lines[DAMAGED_LINE - 1]
            damaged.write_text("\n".join(lines) + "\n", encoding="utf-8")

    numbered = [f"{i} {row} {value}" for i, (row, value) in enumerate(zip(rows, heat), 1)]
    write(".node", [f"{count} 3 1 0", "# a comment", ""], numbered)
    write(".ele", [f"{size} 4 1"], [f"{i} {nodes} {i % 3}  # one" for i, nodes in enumerate(cells, 1)])
    medit = ["MeshVersionFormatted 2", "Dimension 3"]
    write(".mesh", [*medit, "Vertices", str(count)], [f"{row} {i % 5}" for i, row in enumerate(rows)],
          ["Tetrahedra", str(size)], [f"{nodes} {i % 3}" for i, nodes in enumerate(cells)], ["End"])  # fmt: skip
    write(".sol", [*medit, "SolAtVertices", str(count), "1 1", ""], heat, ["End"])
    # numbers of nodes with gaps
    tags = (7 * np.arange(1, count + 1)).tolist()
    tagged = [" ".join(map(str, nodes)) for nodes in (7 * (tetrahedra + 1)).tolist()]
    data = ["$NodeData", "1", '"Heat"', "1", "0.0", "3", "0", "1", str(count)]
    data += [*(f"{tag} {value}" for tag, value in zip(tags, heat)), "$EndNodeData"]
    write("2.msh", ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(count)],
          [f"{tag} {row}" for tag, row in zip(tags, rows)], ["$EndNodes", "$Elements", str(size)],
          [f"{i} 4 2 {i % 3} 1 {nodes}" for i, nodes in enumerate(tagged, 1)], ["$EndElements"], data)  # fmt: skip
    half = size // 2
    write("4.msh", ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$Entities", "0 0 0 2"],
          ["1 0 0 0 1 1 1 1 5 0", "2 0 0 0 1 1 1 0 0", "$EndEntities", "$Nodes"],
          [f"1 {count} {tags[0]} {tags[-1]}", f"3 1 0 {count}"], map(str, tags), rows, ["$EndNodes", "$Elements"],
          [f"2 {size} 1 {size}", f"3 1 4 {half}"], [f"{i} {nodes}" for i, nodes in enumerate(tagged[:half], 1)],
          [f"3 2 4 {size - half}"], [f"{i} {nodes}" for i, nodes in enumerate(tagged[half:], half + 1)],
          ["$EndElements"], data)  # fmt: skip


def files(stem: str) -> list[str]:
    """The files of each format that begin so."""
    return sorted(path.name for path in FORMATS.glob(stem + "*") if path.suffix not in COMPANIONS)


def run(script: str, ranks: int) -> dict:
    """The results of the ranks; each damaged file has one message, the same whoever finds it."""
    found, text = run_with_output(script, ranks, str(DATA), str(FORMATS))
    for file in damaged:
        message = f"{FORMATS / file}:{DAMAGED_LINE}: "
        assert text.count(message) >= ranks, (ranks, file, text)
        assert found[file]["parts"] == 0, (ranks, file)
    others = [line for line in text.splitlines() if "ERR|" in line and "vtkMeshFileReader" not in line
              and "Executive" not in line]  # fmt: skip
    assert not others, others
    return found


def check_requests(ranks: int) -> None:
    """The parts of the files that each rank gets, and of requests that only some of them can fulfill."""
    result, text = run_with_output("requests_on_ranks.py", ranks, str(FORMATS), symmetric=True)
    of_ranks = result["found"]
    for name in (*cubes, *single):
        assert not any(read[name]["message"] for read in of_ranks), (name, of_ranks, text)
        cells = [read[name]["cells"] for read in of_ranks]
        size = 6 * EDGE**3 if name in cubes else 1
        assert sum(cells) == size and max(cells) - min(cells) <= 1, (name, cells)
    for name in damaged:
        messages = {read[name]["message"] for read in of_ranks}
        assert len(messages) == 1 and f":{DAMAGED_LINE}: " in messages.pop(), (name, of_ranks)
    assert len({read["first piece"]["cells"] for read in of_ranks}) == 1
    for name in ("no name", "missing"):
        assert all(read[name]["message"] and read[name]["cells"] == 0 for read in of_ranks), (name, of_ranks)
    assert all(f"{FORMATS / 'missing.msh'}: " in read["missing"]["message"] for read in of_ranks), of_ranks


shutil.rmtree(FORMATS, ignore_errors=True)
FORMATS.mkdir(parents=True)
write_formats("cubes", EDGE, 6 * EDGE**3)
write_formats("single", 1, 1)
cubes, single, damaged = files("cubes"), files("single"), files("damaged-cubes")
assert len(damaged) == len(cubes) == len(single) == 4, (cubes, single, damaged)
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
    for name in (*cubes, *single):
        same = {key: value for key, value in found[name].items() if key not in {"mean", "parts", "sizes"}}
        expected = {key: value for key, value in one[name].items() if key not in {"mean", "parts", "sizes"}}
        assert {"points", "Reference"} < set(same) and same == expected, (name, ranks, same, expected)
        assert name in single or found[name]["parts"] == ranks, (name, ranks)
        assert abs(found[name]["mean"] - one[name]["mean"]) < CLOSE * one[name]["mean"], (name, ranks)
        print(name, "on", ranks, "ranks: cells with ghosts", found[name]["sizes"])
    far = np.abs(np.array(found["optimized"]) - np.array(one["optimized"])).max()
    print(ranks, "ranks: farthest point", far)
    assert far < CLOSE
