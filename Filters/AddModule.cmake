# SPDX-License-Identifier: BSD-3-Clause
# tautline_add_module(NAME LINK LIBRARY): defines the VTK module Tautline::NAME with the sources in the current folder
# and in its subfolders without a CMakeLists.txt. vtkName.h with vtkName.cxx is a class, which is wrapped and installed;
# vtkName.h alone is installed; all other headers are private. The module links the library, and has the proxies of
# ServerManager/NAME.xml.in if this file exists.
function (tautline_add_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "LINK" "")
  set(folder "${CMAKE_CURRENT_SOURCE_DIR}")
  file(GLOB files RELATIVE "${folder}" CONFIGURE_DEPENDS *.h *.cxx */*.h */*.cxx)
  set(classes)
  set(installed)
  set(headers)
  set(folders)
  set(sources ${files})
  list(FILTER sources INCLUDE REGEX "\\.cxx$")
  foreach (file IN LISTS files)
    get_filename_component(directory "${file}" DIRECTORY)
    string(REGEX REPLACE "\\.(h|cxx)$" "" stem "${file}")
    if (directory AND EXISTS "${folder}/${directory}/CMakeLists.txt")
      list(REMOVE_ITEM sources "${file}")
    elseif (NOT file MATCHES "\\.h$")
      continue ()
    elseif (NOT file MATCHES "^vtk")
      list(APPEND headers "${file}")
      list(APPEND folders "${directory}")
    elseif ("${stem}.cxx" IN_LIST sources)
      list(APPEND classes "${stem}")
      list(REMOVE_ITEM sources "${stem}.cxx")
    else ()
      list(APPEND installed "${file}")
    endif ()
  endforeach ()
  vtk_module_add_module("Tautline::${name}"
    CLASSES ${classes}
    HEADERS ${installed}
    SOURCES ${sources}
    PRIVATE_HEADERS ${headers})
  vtk_module_link("Tautline::${name}" PUBLIC "${arg_LINK}")
  list(REMOVE_DUPLICATES folders)
  list(REMOVE_ITEM folders "")
  foreach (directory IN LISTS folders)
    vtk_module_include("Tautline::${name}" PUBLIC "$<BUILD_INTERFACE:${folder}/${directory}>")
  endforeach ()
  if (EXISTS "${TAUTLINE_SERVER_MANAGER_DIR}/${name}.xml.in")
    tautline_add_server_manager_xmls(XMLS "${name}")
  endif ()
endfunction ()
