# SPDX-License-Identifier: BSD-3-Clause
"""The filters of nonlocal models as ParaView users have them: from the menus, with their outputs and errors."""

import os

from paraview import servermanager, simple
from wording import wording

simple.LoadPlugin(os.environ["TAUTLINE_PLUGIN"], ns=globals())



def update(filter_):
    filter_.UpdatePipeline()
    filter_.UpdatePropertyInformation()


source = MeshDomain(Domain="Square with Interaction Layer, Structured", ElementSize=0.1, LayerWidth=0.2)
condition = PeridynamicCondition(Input=source)
update(condition)
assert abs(condition.Condition / 9.2827 - 1) < 1e-3, condition.Condition
assert wording("condition-number") in condition.Summary
assert {"Unknown", "Neighbors", "RowSum", "Diagonal", "SmallestMode", "LargestMode"} <= set(condition.PointData.keys())
table = servermanager.Fetch(condition, idx=1)
assert table.GetNumberOfRows() == 1 and table.GetValueByName(0, "Rows").ToInt() == 81

condition.Basis = "Piecewise Constant"
condition.Discretization = "Dissertation"
condition.SparsityPixels = 50
condition.Solve = 1
update(condition)
assert abs(condition.Condition / 16.31 - 1) < 1e-3, condition.Condition
assert "Solution" in condition.CellData.keys()
image = servermanager.Fetch(condition, idx=2)
assert image.GetDimensions() == (50, 50, 1)

assert condition.SolverIterations > 0
condition.Preconditioner = "AMG of the local limit"
update(condition)
assert wording("preconditioner-amg-of-the-local-limit") in condition.Summary
assert servermanager.Fetch(condition, idx=1).GetValueByName(0, "SolverConverged").ToInt() == 1

condition.Kernel = "Table"
condition.KernelValues = [1, 0.5, 0]
update(condition)
assert condition.Condition > 1

# the state-based model, with its layer
wide = MeshDomain(Domain="Square with Interaction Layer, Structured", ElementSize=0.1, LayerWidth=0.4)
state = PeridynamicCondition(Input=wide, Elastic=1, StateBased=1, PoissonRatio=0.49, PlaneStress=1, Solve=1)
update(state)
softer = state.Condition
assert {"Dilatation", "EnergyDensity"} <= set(state.CellData.keys()) and softer > 1
state.PlaneStress = 0
update(state)
assert state.Condition > 2 * softer, (state.Condition, softer)
state.StateBased = 0
update(state)
assert state.Condition > 1 and state.CutBonds == 1

# without an interaction layer: an error, an empty output; then with one
wrench = MeshDomain(Domain="Rectangle, Structured", NumberOfCells=200)
bare = PeridynamicCondition(Input=wrench, Horizon=0.3)
bare.UpdatePipeline()
assert bare.GetDataInformation().GetNumberOfCells() == 0
layer = InteractionLayer(Input=wrench, Width=0.3)
held = PeridynamicCondition(Input=layer, Horizon=0.3)
update(held)
assert held.Condition > 1 and "Reference" in layer.CellData.keys()

horizon = HorizonNeighbors(Input=source, Center=[0.43, 0.51, 0], Horizon=0.2)
horizon.UpdatePipeline()
assert set(horizon.CellData.keys()) == {"Case", "CellId", "Area", "ChordArea", "Missed"}
assert horizon.CellData["Case"].GetRange()[1] == 3
simple.Show(horizon)
simple.Show(condition)
simple.Render()
