"""The function untangle on every mesh of the folder tangled of TAUTLINE_TEST_DATA; skipped where that is absent."""

import tautline as tl
from checks import test_data

files = sorted(test_data("tangled").glob("*.vtk"))
assert files
for file in files:
    result = tl.untangle(file)
    assert result.inverted_before > 0 == result.inverted == tl.quality(result).inverted, (file, result.summary)
    print(f"{file.name}: {result.inverted_before} inverted, now none")
