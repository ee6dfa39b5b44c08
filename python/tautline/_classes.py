# SPDX-License-Identifier: BSD-3-Clause
"""The compiled VTK classes by name, for type checkers; see _vtk."""

from __future__ import annotations

from ._vtk import vtkAbaqusReader as vtkAbaqusReader
from ._vtk import vtkBoundaryMesher as vtkBoundaryMesher
from ._vtk import vtkConditionEstimator as vtkConditionEstimator
from ._vtk import vtkDomainSource as vtkDomainSource
from ._vtk import vtkElementQuality as vtkElementQuality
from ._vtk import vtkEllipticAlgorithm as vtkEllipticAlgorithm
from ._vtk import vtkEllipticSolver as vtkEllipticSolver
from ._vtk import vtkGmshReader as vtkGmshReader
from ._vtk import vtkGmshWriter as vtkGmshWriter
from ._vtk import vtkHorizonNeighbors as vtkHorizonNeighbors
from ._vtk import vtkHtmlReport as vtkHtmlReport
from ._vtk import vtkImageFileReader as vtkImageFileReader
from ._vtk import vtkInteractionLayer as vtkInteractionLayer
from ._vtk import vtkInterruption as vtkInterruption
from ._vtk import vtkKrylovAlgorithm as vtkKrylovAlgorithm
from ._vtk import vtkMeditReader as vtkMeditReader
from ._vtk import vtkMeditWriter as vtkMeditWriter
from ._vtk import vtkMeshBoundaryAlgorithm as vtkMeshBoundaryAlgorithm
from ._vtk import vtkMeshComparison as vtkMeshComparison
from ._vtk import vtkMeshCurving as vtkMeshCurving
from ._vtk import vtkMeshDecomposition as vtkMeshDecomposition
from ._vtk import vtkMeshFileReader as vtkMeshFileReader
from ._vtk import vtkMeshFileWriter as vtkMeshFileWriter
from ._vtk import vtkMeshImprover as vtkMeshImprover
from ._vtk import vtkMeshMotionAlgorithm as vtkMeshMotionAlgorithm
from ._vtk import vtkMeshOptimizer as vtkMeshOptimizer
from ._vtk import vtkMeshPerturbation as vtkMeshPerturbation
from ._vtk import vtkMeshUntangler as vtkMeshUntangler
from ._vtk import vtkMeshWarp as vtkMeshWarp
from ._vtk import vtkMetricAlgorithm as vtkMetricAlgorithm
from ._vtk import vtkMetricField as vtkMetricField
from ._vtk import vtkMfemReader as vtkMfemReader
from ._vtk import vtkMfemWriter as vtkMfemWriter
from ._vtk import vtkMovingBoundary as vtkMovingBoundary
from ._vtk import vtkNastranReader as vtkNastranReader
from ._vtk import vtkOffReader as vtkOffReader
from ._vtk import vtkOffWriter as vtkOffWriter
from ._vtk import vtkPeridynamicStiffness as vtkPeridynamicStiffness
from ._vtk import vtkShapeAlgorithm as vtkShapeAlgorithm
from ._vtk import vtkShapeMatcher as vtkShapeMatcher
from ._vtk import vtkShapeRetrieval as vtkShapeRetrieval
from ._vtk import vtkSilhouetteMesher as vtkSilhouetteMesher
from ._vtk import vtkSilhouetteSetReader as vtkSilhouetteSetReader
from ._vtk import vtkSolverStudy as vtkSolverStudy
from ._vtk import vtkTautlineAlgorithm as vtkTautlineAlgorithm
from ._vtk import vtkTautlineTimedAlgorithm as vtkTautlineTimedAlgorithm
from ._vtk import vtkTetGenMesher as vtkTetGenMesher
from ._vtk import vtkTetGenReader as vtkTetGenReader
from ._vtk import vtkTetGenWriter as vtkTetGenWriter
from ._vtk import vtkTriangleMesher as vtkTriangleMesher
from ._vtk import vtkUpdateGuard as vtkUpdateGuard
from ._vtk import vtkUserMetric as vtkUserMetric
