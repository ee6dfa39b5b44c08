"""The compiled classes are in the package tautline."""

import tautline

assert tautline.vtkElementQuality().IsA("vtkDataSetAlgorithm")
