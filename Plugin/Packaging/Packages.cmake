# SPDX-License-Identifier: BSD-3-Clause
# Packages for Debian, made by ./run package (cpack -G DEB): libtautline, python3-tautline, paraview-tautline,
# tautline-meshers, libtautline-dev and tautline-doc, one for each install component.
install(DIRECTORY Data/ DESTINATION "${CMAKE_INSTALL_DATADIR}/tautline/samples" COMPONENT doc
  PATTERN "*.py" EXCLUDE)
install(DIRECTORY python/examples python/studies DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT doc
  PATTERN "__pycache__" EXCLUDE)
install(FILES CHANGELOG.md SECURITY.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT doc)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tautline)
set(CPACK_PACKAGE_VENDOR "Tautline developers")
set(CPACK_PACKAGE_CONTACT "Tautline developers <tautline@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_OUTPUT_FILE_PREFIX "${CMAKE_BINARY_DIR}/packages")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL runtime python plugin development doc)
set(meshers)
if (TAUTLINE_MESHING)
  list(APPEND CPACK_COMPONENTS_ALL meshers)
  set(meshers ", tautline-meshers")
endif ()
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(version "${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}")
set(library "libtautline (= ${version})")
# The classes of ParaView's VTK are binary compatible only within one upstream version: the Debian revisions
# 5.11.0+dfsg-1 and -2 are compatible, 5.11.1 is not.
set(paraview)
set(python_paraview python3-vtk9)
if (TAUTLINE_USE_PARAVIEW)
  execute_process(COMMAND dpkg-query -W "-f=\${source:Upstream-Version}" paraview
    OUTPUT_VARIABLE upstream ERROR_QUIET)
  if (upstream)
    set(paraview "paraview (>= ${upstream}), paraview (<< ${upstream}.)")
    set(python_paraview "python3-paraview (>= ${upstream}), python3-paraview (<< ${upstream}.)")
  endif ()
endif ()

# The packages that find_package(ParaView) needs on the release of this build.
set(headers)
file(STRINGS /etc/os-release release REGEX "^(ID|VERSION_CODENAME)=")
string(REGEX REPLACE ".*VERSION_CODENAME=([a-z]+).*" "\\1" codename "${release}")
string(REGEX REPLACE "(^|.*;)ID=([a-z]+).*" "\\2" system "${release}")
set(requirements "${CMAKE_CURRENT_LIST_DIR}/requirements/${system}-${codename}")
if (EXISTS "${requirements}")
  file(STRINGS "${requirements}" lines REGEX "^headers: ")
  list(TRANSFORM lines REPLACE "^headers: " "")
  string(REPLACE ";" " " headers "${lines}")
  string(REPLACE " " ", " headers "${headers}")
endif ()

# The license in the format of Debian's copyright files: indented, with a period in empty lines.
file(STRINGS LICENSE lines)
set(TAUTLINE_LICENSE)
foreach (line IN LISTS lines)
  if (line STREQUAL "")
    set(line ".")
  endif ()
  string(APPEND TAUTLINE_LICENSE " ${line}\n")
endforeach ()

# tautline_package(COMPONENT NAME SUMMARY TEXT DEPENDS): a package of one install component. Its file in notices
# lists the libraries that its binaries link and their licenses: a comment, an empty line, then the licenses of parts.
function (tautline_package component name summary text depends)
  string(TOUPPER "${component}" upper)
  set("CPACK_DEBIAN_${upper}_PACKAGE_NAME" "${name}" PARENT_SCOPE)
  set("CPACK_DEBIAN_${upper}_DESCRIPTION" "${summary}\n${text}" PARENT_SCOPE)
  string(REGEX REPLACE "(^, |, $)" "" depends "${depends}")
  set("CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS" "${depends}" PARENT_SCOPE)
  file(READ "${PROJECT_SOURCE_DIR}/Plugin/Packaging/notices/${component}" notice)
  string(REGEX MATCH "^([^\n]*\n)([^\n]+\n)*" TAUTLINE_NOTICE "${notice}")
  string(LENGTH "${TAUTLINE_NOTICE}" length)
  string(SUBSTRING "${notice}" ${length} -1 TAUTLINE_FURTHER_LICENSES)
  set(copyright "${CMAKE_BINARY_DIR}/Packaging/copyright/${name}")
  configure_file(Plugin/Packaging/copyright.in "${copyright}" @ONLY)
  set(place "${CMAKE_INSTALL_DATADIR}/doc/${name}")
  install(FILES "${copyright}" DESTINATION "${place}" COMPONENT "${component}" RENAME copyright)
  install(FILES Plugin/Site/licenses.md DESTINATION "${place}" COMPONENT "${component}" RENAME THIRD-PARTY.md)
endfunction ()
tautline_package(runtime libtautline "measures, repairs, deforms and matches meshes - libraries"
  "C++ libraries: the numerics, which need no VTK, and modules for the VTK of ParaView." "${paraview}")
tautline_package(python python3-tautline "measures, repairs, deforms and matches meshes - Python and shell"
  "The Python package tautline and the command tautline." "${library}, ${python_paraview}, python3-numpy")
tautline_package(plugin paraview-tautline "measures, repairs, deforms and matches meshes - plugin for ParaView"
  "Filters, sources, readers, writers and panels. ParaView loads the plugin when it starts.\n\
The package tautline-doc has a tutorial: /usr/share/doc/tautline/help/tutorial.html" "${library}, ${paraview}")
if (TAUTLINE_MESHING)
  tautline_package(meshers tautline-meshers "measures, repairs, deforms and matches meshes - mesh generators"
    "A program that the meshers and domains of the other packages run. It links TetGen\n\
and CGAL, which are under the AGPL and the GPL; the other packages do not." "${library}, ${paraview}")
endif ()
tautline_package(development libtautline-dev "measures, repairs, deforms and matches meshes - development files"
  "Headers and CMake files, for find_package(Tautline)." "${library}, paraview-dev, ${headers}")
tautline_package(doc tautline-doc "measures, repairs, deforms and matches meshes - documentation"
  "Help pages, tutorial, sample meshes, example scripts and the studies of the dissertation." "")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "tautline-doc${meshers}")
set(CPACK_DEBIAN_PLUGIN_PACKAGE_RECOMMENDS "tautline-doc, python3-tautline${meshers}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_LIST_DIR}/triggers")
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
  "${CMAKE_CURRENT_LIST_DIR}/postinst;${CMAKE_CURRENT_LIST_DIR}/prerm")
set(CPACK_DEBIAN_DOC_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_LIST_DIR}/prerm") # Python compiles examples and studies

# ParaView reads paraview.conf, a list of files that name plugins. Debian 12's ParaView has no such file, so it is
# installed beside the program. Debian 13's ParaView reads only the file in its library directory, whose second line
# names a file for plugins of other packages; no Debian package provides it.
if (TAUTLINE_USE_PARAVIEW AND TAUTLINE_AUTOLOAD)
  set(prefix "${CPACK_PACKAGING_INSTALL_PREFIX}")
  set(plugins "/${CMAKE_INSTALL_LIBDIR}/${PARAVIEW_PLUGIN_SUBDIR}")
  get_filename_component(own "${prefix}${plugins}/../paraview.conf" ABSOLUTE)
  set(hook "${prefix}/${CMAKE_INSTALL_DATADIR}/paraview/plugins")
  set(lines)
  if (EXISTS "${own}")
    file(STRINGS "${own}" lines)
    if (NOT hook IN_LIST lines)
      message(WARNING "${own} has no line ${hook}, and ParaView reads no other list of plugins: it will not load the \
plugin of the package when it starts.")
    endif ()
  endif ()
  if (hook IN_LIST lines)
    file(WRITE "${CMAKE_BINARY_DIR}/Packaging/plugins" "<?xml version=\"1.0\"?>\n<Plugins>\n\
  <Plugin name=\"Tautline\" auto_load=\"1\" filename=\"${prefix}${plugins}/Tautline/Tautline.so\"/>\n</Plugins>\n")
    install(FILES "${CMAKE_BINARY_DIR}/Packaging/plugins" DESTINATION "${CMAKE_INSTALL_DATADIR}/paraview"
      COMPONENT plugin)
  else ()
    file(RELATIVE_PATH list "/${CMAKE_INSTALL_BINDIR}" "${plugins}/tautline.plugins.xml")
    file(WRITE "${CMAKE_BINARY_DIR}/Packaging/paraview.conf" "${list}\n")
    install(FILES "${CMAKE_BINARY_DIR}/Packaging/paraview.conf" DESTINATION "${CMAKE_INSTALL_BINDIR}"
      COMPONENT plugin)
  endif ()
endif ()
include(CPack)
