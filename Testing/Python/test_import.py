"""The compiled classes and the verbs are in the package tautline."""

import tautline

assert tautline.vtkElementQuality().IsA("vtkDataObjectAlgorithm")
