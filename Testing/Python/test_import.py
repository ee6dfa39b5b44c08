# SPDX-License-Identifier: BSD-3-Clause
"""The compiled classes and the functions are in the package tautline, in python3 and in pvpython."""

import tautline

assert tautline.vtkElementQuality().IsA("vtkDataObjectAlgorithm")
assert callable(tautline.quality)
