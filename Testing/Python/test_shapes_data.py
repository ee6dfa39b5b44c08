# SPDX-License-Identifier: BSD-3-Clause
"""Retrieval on Kimia's 99 silhouettes, the folder kimia99 of TAUTLINE_TEST_DATA; skipped where that is absent.

The dissertation's energy on part of them: every class is there, with four of its eleven shapes.
"""

import tautline as tl
from checks import test_data

shapes = tl.read_silhouettes(test_data("kimia99"))
assert shapes.GetNumberOfBlocks() == 99
some = [i for i in range(99) if i % 11 in (0, 3, 6, 9)]
labels = [shapes.GetBlock(i).GetFieldData().GetAbstractArray("Label").GetValue(0) for i in some]
assert len(set(labels)) == 9
images = [shapes.GetBlock(i) for i in some]
highest = tl.retrieval(shapes)
assert highest.rate >= 98.5, highest.summary
assert tl.retrieval(shapes, neighbors=7).rate >= 99.5
options = dict(setting="custom", locations="contour", best=3)
ours = tl.retrieval(images, labels, **options)
theirs = tl.retrieval(images, labels, **options, b=0, centre_tolerance=0)
assert ours.rate > 80 and ours.rate > theirs.rate, (ours.summary, theirs.summary)
