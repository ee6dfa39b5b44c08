# SPDX-License-Identifier: BSD-3-Clause
"""Sphinx's settings for the site: ./run docs."""

import os

project = "Tautline"
author = "Tautline developers"
copyright = "2026, Tautline developers"  # noqa: A001
release = version = os.environ["TAUTLINE_VERSION"]
extensions = ["myst_parser", "sphinx.ext.mathjax"]
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS_SVG"  # a copy of Debian's, beside the pages
mathjax2_config = {"SVG": {"linebreaks": {"automatic": True}}}
html_theme = "sphinx_rtd_theme"
html_show_sourcelink = False
html_copy_source = False
html_use_index = False  # the pages have no index entries
html_theme_options = {"navigation_depth": 2, "collapse_navigation": True}
html_static_path = ["static"]
html_css_files = ["style.css"]
html_extra_path = ["extra"]  # pictures and sample meshes
myst_heading_anchors = 3
suppress_warnings = ["myst.header", "myst.xref_missing"]
highlight_language = "none"
