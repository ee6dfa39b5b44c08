# SPDX-License-Identifier: BSD-3-Clause
"""Solve PDE, Condition Estimator and Solver Study in ParaView: menus, defaults, outputs, errors, state."""

import os

from paraview import servermanager, simple
from wording import wording

PLUGIN = os.environ["TAUTLINE_PLUGIN"]
simple.LoadPlugin(PLUGIN, ns=globals())
simple.LoadPlugin(PLUGIN, ns=globals())  # twice: no harm


def update(filter_):
    filter_.UpdatePipeline()
    filter_.UpdatePropertyInformation()
    return filter_


plate = simple.XMLUnstructuredGridReader(FileName=[os.path.join(os.environ["TAUTLINE_DATA_DIR"], "plate.vtu")])
solved = update(SolvePDE(Input=plate))
assert (solved.Equation, solved.Solver, solved.Preconditioner) == ("Poisson", "CG", "BoomerAMG")
assert (solved.SourceType, solved.SourceValue, solved.FixedPart) == ("Constant", 1, "Whole Boundary")
assert abs(solved.PointData["Solution"].GetRange()[1] - 1.81) < 0.01 and "Gradient" in solved.CellData.keys()
assert solved.Unknowns == 1011 and solved.Iterations > 1 and "Converged" in solved.Summary, solved.Summary
history = servermanager.Fetch(solved, idx=1)
assert history.GetNumberOfRows() == solved.Iterations + 1
assert history.GetValueByName(history.GetNumberOfRows() - 1, "Log10 residual").ToDouble() <= -5

solved.SourceType = "Expression"
solved.SourceExpression = "x*y"
solved.FixedPart = "Part of the Boundary"
solved.FixedWhere = "x < 0"
update(solved)
assert solved.Unknowns > 1011 and solved.PointData["Solution"].GetRange()[0] < 0

# Two in a pipeline: the second is loaded with the first's solution.
second = update(SolvePDE(Input=solved, SourceType="Array", SourceArray=["POINTS", "Solution"], SolutionName="Second"))
assert {"Solution", "Second"} <= set(second.PointData.keys())

elastic = update(SolvePDE(Input=plate, Equation="Linear Elasticity", BodyForce=[0, -1, 0], PlaneState="Plane Stress"))
assert elastic.PointData["Displacement"].GetNumberOfComponents() == 3
assert elastic.CellData["Stress"].GetNumberOfComponents() == 6 and elastic.CellData["VonMises"].GetRange()[0] >= 0

# The heat equation from 1 inside: the time controls have its steps; an earlier time is warmer.
heat = SolvePDE(Input=plate, SourceValue=0, TimeScheme="Heat: BDF2", TimeStep=1, NumberOfTimeSteps=4, InitialValue=1)
update(heat)
assert len(heat.TimestepValues) == 5 and heat.TimestepValues[-1] == 4, heat.TimestepValues
warmest = []
for moment in heat.TimestepValues:
    heat.UpdatePipeline(moment)
    warmest.append(heat.PointData["Solution"].GetRange()[1])
assert warmest[0] == 1 and all(b < a + 1e-6 for a, b in zip(warmest, warmest[1:])) and warmest[-1] < 0.99, warmest
assert servermanager.Fetch(heat, idx=1).GetNumberOfRows() == 4
heat.TimeScheme = "Stationary"
heat.UpdatePipelineInformation()
assert not heat.TimestepValues, heat.TimestepValues

# A wrong expression: an error, an empty output; then right again.
solved.SourceExpression = "x*"
update(solved)
assert solved.GetDataInformation().GetNumberOfCells() == 0
solved.SourceExpression = "x"
assert update(solved).GetDataInformation().GetNumberOfCells() == 1913
solved.PETScOptions = "-ksp_type nonsense"
update(solved)
assert solved.GetDataInformation().GetNumberOfCells() == 0
solved.PETScOptions = "-ksp_max_it 1"
update(solved)
assert wording("limit-of-iterations") in solved.Summary and solved.GetDataInformation().GetNumberOfCells() == 1913

estimate = update(ConditionEstimator(Input=plate))
assert abs(estimate.Condition / 1619.5 - 1) < 1e-3 and 1 < estimate.PreconditionedCondition < 2, estimate.Summary
assert {"Excess", "Share", "LargestEigenvalue"} <= set(estimate.CellData.keys())
assert servermanager.Fetch(estimate, idx=1).GetNumberOfRows() == 2

study = update(SolverStudy(Input=plate))
table = servermanager.Fetch(study, idx=1)
assert table.GetNumberOfRows() == 16 and study.Recommended in study.Summary
assert study.Summary.startswith("Recommended: " if study.Recommended else "No clear recommendation: "), study.Summary
study.Combinations = ["13: CG + BoomerAMG", "17: Direct"]
update(study)
table = servermanager.Fetch(study, idx=1)
assert [table.GetValueByName(i, "N combination").ToInt() for i in range(2)] == [13, 17]

simple.Show(solved)
simple.Show(estimate)
simple.Render()
chart = simple.CreateView("XYBarChartView")
display = simple.Show(servermanager.OutputPort(study, 1), chart)
shown = display.SeriesVisibility
assert wording("total-time-s") in shown and "N iterations" not in shown, shown[:]
