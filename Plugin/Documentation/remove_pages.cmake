# SPDX-License-Identifier: BSD-3-Clause
# cmake -DDIRECTORY=... -P remove_pages.cmake: removes the pages and pictures in DIRECTORY.
file(GLOB pages "${DIRECTORY}/*.html" "${DIRECTORY}/*.css" "${DIRECTORY}/*.png")
if (pages)
  file(REMOVE ${pages})
endif ()
