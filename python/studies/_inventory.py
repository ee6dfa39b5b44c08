# SPDX-License-Identifier: BSD-3-Clause
"""The dissertation's tables, figures and sections, and where they are in this package, for the study `all`."""

from __future__ import annotations

from typing import NamedTuple


class Entry(NamedTuple):
    """A table or figure: its caption in short, its study, patterns of its files, and sections.

    The files are pictures and tables; findings of the study on the sections also belong to it.
    """

    name: str
    caption: str
    study: str
    files: tuple[str, ...] = ()
    sections: tuple[str, ...] = ()


def _entries(text: str) -> list[Entry]:
    """Rows of name | caption | study | patterns | sections."""
    rows = [[part.strip() for part in line.split("|")] for line in text.strip().split("\n")]
    return [Entry(row[0], row[1], row[2], tuple(row[3].split()), tuple(row[4].split() if len(row) > 4 else ()))
            for row in rows]


ENTRIES = _entries("""
Figure 1.1 | a mesh before and after the improvement | figures | figure_1_1
Figure 1.2 | a tangled mesh | figures | figure_1_2
Figure 2.1 | contours of IMR, RR, SI and SS | figures | figure_2_1
Figure 2.2 | meshes of wrench and hinge | figures | figure_2_2
Table 2.4 | numbers of triangles | mesh_independence | table_2_4
Table 2.6 | smoothing times | smoothing_times | table_2_6*
Table 2.7 | angles by metric | smoothing_times | table_2_7* boundary angles meshes
Figure 2.3 | restart value of GMRES | solver_restart | iterations_* seconds_* figure_2_3
Table 2.8 | solvers by metric, Poisson | solver_metrics | poisson_* total_poisson_*
Table 2.9 | solvers by perturbation, Poisson | solver_perturbation | poisson_*
Figure 2.4 | increase of the time by perturbation, Poisson | solver_perturbation | pi_poisson_* failures_poisson_*
Figure 2.5 | order of the iterations, Poisson | solver_orders | figure_2_5 poisson_* eigenvalues_*
Figure 2.6 | order of the time, Poisson | solver_orders | figure_2_6 poisson_orders_seconds
Table 2.10 | solvers by metric, general second order | solver_metrics | elliptic_* total_elliptic_*
Figure 2.7 | increase of the time by perturbation, general second order | solver_perturbation | *elliptic_*
Figure 2.8 | order of the iterations, general second order | solver_orders | figure_2_8 elliptic_*
Figure 2.9 | order of the time, general second order | solver_orders | figure_2_9 elliptic_orders_seconds
Table 2.11 | solvers by metric, elasticity | solver_metrics | elasticity_* total_elasticity_*
Table 2.12 | solvers by perturbation, elasticity | solver_perturbation | elasticity_*
Figure 2.10 | increase of the time by perturbation, elasticity | solver_perturbation | pi_elasticity_*
Figure 2.11 | order of the iterations, elasticity | solver_orders | figure_2_11 elasticity_*
Figure 2.12 | order of the time, elasticity | solver_orders | figure_2_12 elasticity_orders_seconds
Figure 3.1 | contours of five metrics | figures | figure_3_1
Figure 3.2 | scalarizations on a structured mesh | toy | *
Figure 3.3 | disk and barrier | figures | figure_3_3
Table 3.2 | times, shape and size | shape_size | times*
Figure 3.4 | averages, shape and size | shape_size | average* quality_disk3d
Figure 3.5 | worst elements, shape and size | shape_size | worst
Table 3.3 | times, shape and interpolation | shape_interpolation | times*
Figure 3.6 | averages, shape and interpolation | shape_interpolation | average*
Figure 3.7 | worst elements, shape and interpolation | shape_interpolation | worst
Table 3.4 | inverted elements, barrier in the plane | shape_untangling | table_3_4*
Table 3.5 | inverted elements, barrier in space | shape_untangling | table_3_5*
Figure 3.8 | untangled meshes | shape_untangling | meshes
Figure 3.9 | averages and worst elements, untangling | shape_untangling | quality
Table 3.6 | inverted elements, three objectives | shape_size_untangling | table_3_6*
Figure 3.10 | averages, three objectives | shape_size_untangling | average
Table 3.7 | inverted elements, brain | hydrocephalus | inverted* quality units
Figure 3.11 | brain with ventricles | hydrocephalus | domain close_up
Figure 3.12 | bore | figures | figure_3_12
Table 3.8 | condition numbers, brain | conditioning | table_3_8
Table 3.9 | condition numbers, bore | conditioning | table_3_9
Table 3.10 | condition numbers, disk | conditioning | table_3_10
Figure 4.1 | horizon and force | figures | figure_4_1
Figure 4.2 | sparsity pattern | figures | figure_4_2
Figure 4.3 | boundary conditions, local and nonlocal | figures | figure_4_3
Figure 4.4 | triangles cut by the horizon | figures | figure_4_4
Figure 4.5 | areas by chords | figures | figure_4_5
Figure 4.6 | meshes with an interaction layer | figures | figure_4_6
Figure 4.7 | anisotropic mesh | figures | figure_4_7
Figure 4.8 | aspect ratio | figures | figure_4_8
Table 4.1 | condition numbers, constant basis, p = 1 | peridynamics_tables | table_4_1* peridynamics_tables
Table 4.2 | condition numbers, linear basis, p = 1 | peridynamics_tables | table_4_2* peridynamics_tables
Table 4.3 | condition numbers, linear basis, p = 2.5 | peridynamics_tables | table_4_3* peridynamics_tables
Figure 4.9 | by horizon and ratio, constant basis | peridynamics_horizon | *_constant_p1 *s_p1 short_horizons | 4.5.1
Figure 4.10 | by delta^-2, constant basis | peridynamics_horizon | *_constant_p1_inverse | 4.5.1
Figure 4.11 | by horizon and element size, constant basis | peridynamics_horizon | *_constant_p1 growth_h | 4.5.1
Figure 4.12 | by delta^-2 and element size, constant basis | peridynamics_horizon | *_constant_p1_inverse | 4.5.1
Figure 4.13 | by horizon and aspect ratio, linear basis | peridynamics_horizon | *_linear_p1 growth_ratio | 4.5.2
Figure 4.14 | by delta^-2, linear basis | peridynamics_horizon | *_linear_p1_inverse | 4.5.2
Figure 4.15 | by horizon and element size, linear basis | peridynamics_horizon | *_linear_p1 growth_h | 4.5.2
Figure 4.16 | by delta^-2 and element size, linear basis | peridynamics_horizon | *_linear_p1_inverse | 4.5.2
Figure 4.17 | by horizon and aspect ratio, p = 2.5 | peridynamics_horizon | *_linear_p2.5 growth_ratio | 4.5.3
Figure 4.18 | by horizon and element size, p = 2.5 | peridynamics_horizon | *_linear_p2.5 *_h *_ratio growth_h | 4.5.3
Figure 4.19 | by the exponent of the kernel | peridynamics_kernel | peridynamics_kernel kernel_*
Figure 4.20 | rectangle with a sinking top | rectangle_warp | *
Figure 4.21 | an element of a structured mesh | figures | figure_4_21
Figure 4.22 | the same, anisotropic | rectangle_warp | *
Figure 4.23 | coefficients and direction of the motion | figures | figure_4_23
Figure 4.24 | cylinder | deformation | strip_cylinder | 4.10.1
Figure 4.25 | quality, cylinder | deformation | quality quality_cylinder | 4.10.1
Figure 4.26 | inverted elements, cylinder | deformation | inverted seconds sweep_cylinder | 4.10.1
Figure 4.27 | bar | deformation | strip_bar | 4.10.2
Figure 4.28 | quality, bar | deformation | quality quality_bar | 4.10.2
Figure 4.29 | inverted elements, bar | deformation | inverted seconds sweep_bar | 4.10.2
Figure 4.30 | gate | deformation | strip_gate | 4.10.3
Figure 4.31 | quality, gate | deformation | quality quality_gate | 4.10.3
Figure 4.32 | inverted elements, gate | deformation | inverted seconds sweep_gate | 4.10.3
Figure 4.33 | cylinder, diagonal | deformation | strip_cylinder-diagonal | 4.10.4
Figure 4.34 | quality, cylinder, diagonal | deformation | quality quality_cylinder-diagonal | 4.10.4
Figure 4.35 | bending bar | deformation | strip_bending-bar | 4.10.5
Figure 4.36 | quality, bending bar | deformation | quality quality_bending-bar | 4.10.5
Figure 4.37 | sphere | figures | figure_4_37_a
Figure 4.38 | quality, sphere | deformation | quality quality_sphere | 4.10.6
Figure 4.39 | inverted elements, sphere | deformation | inverted strip_sphere | 4.10.6
Figure 5.1 | overview of shape matching | figures | figure_5_1
Figure 5.2 | largest distance from the center of mass | figures | figure_5_2
Table 5.1 | recognition rates | shapes | table_5_1 sweep ranks | 5.3
Figure 5.3 | a poor and an improved match | shapes | *5_3*
Figure 5.4 | samples of the silhouettes | figures | figure_5_4
Figure 5.5 | good matches | shapes | *5_5*
Figure 5.6 | poor matches | shapes | *5_6*
Figure 5.7 | detected meshes | shapes | *5_7*
""")

#: Section, subject, where it is in ParaView and Python, studies.
SECTIONS = (
    ("2.2", "elliptic equations by finite elements", "Solve PDE; solve()", "mesh_independence"),
    ("2.3, 3.2.1", "metrics", "Element Quality, Metric Field; quality(), metric_field()", "figures"),
    ("2.4", "smoothing", "Optimize Mesh; optimize()", "smoothing_times"),
    ("2.5, 2.6", "solvers, preconditioners", "Solve PDE, Solver Study; solve(), solver_study()",
     "solver_restart, solver_metrics"),
    ("2.7.2", "perturbation", "Perturb Mesh; perturb()", "solver_perturbation"),
    ("2.7.3", "best combinations, coefficients, problem size", "Solver Study; solver_study()",
     "solver_metrics, solver_coefficients, solver_orders"),
    ("3.2.2, 3.3", "scalarizations, conjugate gradients", "Optimize Mesh; optimize()", "toy"),
    ("3.4.1, 3.4.2", "shape and size, interpolation", "Optimize Mesh; optimize()", "shape_size, shape_interpolation"),
    ("3.4.3, 3.4.4", "untangling", "Untangle Mesh, Optimize Mesh; untangle(), optimize()",
     "shape_untangling, shape_size_untangling"),
    ("3.5", "warped meshes, condition numbers", "Warp Mesh, Condition Estimator; warp(), condition()",
     "hydrocephalus, bore, conditioning"),
    ("4.2 to 4.5", "nonlocal models", "Peridynamic Condition, Interaction Layer; peridynamics(), interaction_layer()",
     "peridynamics_tables, peridynamics_horizon, peridynamics_kernel, peridynamics_local"),
    ("4.6", "preconditioners of nonlocal models", "Peridynamic Condition with a Preconditioner; peridynamics()",
     "nonlocal_preconditioner"),
    ("4.6", "state-based models, unstructured domains with holes",
     "Peridynamic Condition with State Based; peridynamics(model=\"state-based\")", "state_based"),
    ("4.7 to 4.9", "FEMWARP and the hybrid algorithm", "Warp Mesh; warp()", "rectangle_warp"),
    ("4.9.1, 6", "coefficients of FEMWARP that vary in space",
     "Warp Mesh with Coefficients From the motion, local gradients; warp(coefficients=\"local gradients\")",
     "local_coefficients"),
    ("4.10", "six moving domains", "Mesh Domain, Warp Mesh; domain(), warp()", "deformation, deformation_methods"),
    ("5.2", "shape matching", "Silhouette to Mesh, Match Shape; silhouette(), match()", "figures"),
    ("5.3", "retrieval", "Shape Retrieval; retrieval()", "shapes"),
    ("2.8", "time-dependent problems", "Solve PDE with a Time Scheme; solve()", "time_stepping"),
    ("2.7.1, 2.8", "other elements, three dimensions, anisotropic coefficients", "Solver Study; solver_study()",
     "solver_meshes"),
    ("3.2, 3.3", "Pareto optimality, forms of the objective", "Optimize Mesh; optimize()", "pareto, formulations"),
    ("4.11", "target matrices of the initial mesh in FEMWARP", "-", "target_matrices"),
    ("-", "beyond the dissertation", "Improve Mesh, Warp Mesh; improve(), warp()", "reconnection, box_rotation"),
    ("-", "decomposition of the domain, many processes", "Optimize Mesh; optimize()", "decomposition"),
    ("-", "threads and MPI ranks", "all filters", "thread_scaling, rank_scaling"),
)

#: Chapters of the dissertation, in the order of the summary; 0 has what this project states.
CHAPTERS = {
    1: "1 Introduction",
    2: "2 Metrics, preconditioners and solvers",
    3: "3 Several objectives",
    4: "4 Nonlocal models, moving meshes",
    5: "5 Shape matching",
    6: "6 Conclusions",
    0: "This project's own statements",
}

#: Tables and figures without a study, and why.
NOT_MADE: dict[str, str] = {
    "Table 2.1, 2.2, 2.3, 2.5, 3.1": "definitions of notation, metrics, problems and combinations: no results",
    "Figure 1.3": "a picture of another work (fragmentation); there is no model of fracture here",
    "Figure 1.4": "the subject of Figure 4.35",
    "Figure 1.5": "the subject of Figure 5.4",
    "Figure 1.6": "a flowchart of the chapters: nothing to compute",
}
