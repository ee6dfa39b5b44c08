# SPDX-License-Identifier: BSD-3-Clause
# The XML of ParaView's proxies is generated from ServerManager/<Capability>.xml.in when CMake configures.
# Repeated parts are written once, in ServerManager/Snippets:
#
#   <?include Threads.xml?>                               inserts the content of the snippet's root element
#   <?include ShownIf.xml property="Preset" value="0"?>   with values for its parameters @property@ and @value@
#   <?if value?> ... <?end?>                              in a snippet: kept if the parameter is not empty
#
# Attributes of the root element <Snippet> are the optional parameters, with their defaults. An attribute that
# consists only of a parameter, as in panel_visibility="@visibility@", is omitted if the parameter is empty.
# Templates and snippets are well-formed XML. A parameter that is missing or unknown stops the configuration.
# Attributes that begin with python or shell are for the Python package, see python/generator; ParaView ignores them.

set(TAUTLINE_SERVER_MANAGER_DIR "${CMAKE_CURRENT_LIST_DIR}")

# Replaces the parameter `name` with `value` in `text` and `defaults`; sets `used` if the parameter was present. This
# macro has no arguments, because CMake would interpret escape sequences in them.
macro (_tautline_substitute)
  set(before "${text}${defaults}")
  if (value STREQUAL "")
    string(REGEX REPLACE "[ \n]+[a-z_]+=\"@${name}@\"" "" text "${text}")
    string(REPLACE "<?if ${name}?>" "<?skip?>" text "${text}")
  else ()
    string(REPLACE "<?if ${name}?>" "<?keep?>" text "${text}")
  endif ()
  string(REPLACE "@${name}@" "${value}" text "${text}")
  string(REPLACE "@${name}@" "${value}" defaults "${defaults}")
  string(COMPARE NOTEQUAL "${before}" "${text}${defaults}" used)
endmacro ()

# Removes the text between <?skip?> and <?end?> from `text`, and the marks around the parts that are kept.
macro (_tautline_drop_skipped)
  set(end "<?end?>")
  string(LENGTH "${end}" end_length)
  string(FIND "${text}" "<?skip?>" start)
  while (NOT start EQUAL -1)
    string(SUBSTRING "${text}" 0 ${start} head)
    string(SUBSTRING "${text}" ${start} -1 tail)
    string(FIND "${tail}" "${end}" length)
    if (length EQUAL -1)
      message(FATAL_ERROR "${file}: an <?if?> has no ${end}")
    endif ()
    math(EXPR length "${length} + ${end_length}")
    string(SUBSTRING "${tail}" ${length} -1 tail)
    set(text "${head}${tail}")
    string(FIND "${text}" "<?skip?>" start)
  endwhile ()
  string(REGEX REPLACE "<\\?(keep|end)\\?>" "" text "${text}")
endmacro ()

# The text of a template or snippet with its parameters and includes expanded. Texts are never treated as lists,
# because they contain semicolons and brackets.
function (_tautline_expand_xml out file arguments)
  if (NOT EXISTS "${file}")
    message(FATAL_ERROR "ServerManager: ${file} does not exist")
  endif ()
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  file(READ "${file}" text)
  set(defaults "")
  if (text MATCHES "^(<!--.*-->\n)?<Snippet([^>]*)>\n(.*)</Snippet>\n$")
    set(defaults "${CMAKE_MATCH_2}")
    set(text "${CMAKE_MATCH_3}")
  endif ()

  while (arguments MATCHES "^[ \n]*([a-z_]+)=\"([^\"]*)\"(.*)$")
    set(name "${CMAKE_MATCH_1}")
    set(value "${CMAKE_MATCH_2}")
    set(arguments "${CMAKE_MATCH_3}")
    # A given value overrides the default.
    string(REGEX REPLACE "(^|[ \n])${name}=\"[^\"]*\"" "" defaults "${defaults}")
    _tautline_substitute()
    if (NOT used)
      message(FATAL_ERROR "${file} has no parameter ${name}")
    endif ()
  endwhile ()
  while (defaults MATCHES "^[ \n]*([a-z_]+)=\"([^\"]*)\"(.*)$")
    set(name "${CMAKE_MATCH_1}")
    set(value "${CMAKE_MATCH_2}")
    set(defaults "${CMAKE_MATCH_3}")
    _tautline_substitute()
  endwhile ()
  _tautline_drop_skipped()

  while (text MATCHES "<\\?include ([A-Za-z]+\\.xml)([^?]*)\\?>")
    set(mark "${CMAKE_MATCH_0}")
    _tautline_expand_xml(included "${TAUTLINE_SERVER_MANAGER_DIR}/Snippets/${CMAKE_MATCH_1}" "${CMAKE_MATCH_2}")
    string(STRIP "${included}" included)
    string(REPLACE "${mark}" "${included}" text "${text}")
  endwhile ()
  if (text MATCHES "@[a-z_]+@|<\\?[a-z]+[^?]*\\?>")
    message(FATAL_ERROR "${file}: ${CMAKE_MATCH_0} has no value or is unknown")
  endif ()
  set(${out} "${text}" PARENT_SCOPE)
endfunction ()

# tautline_add_server_manager_xmls(XMLS name...): the proxies of a module, from ServerManager/<name>.xml.in. The Python
# package is also generated from them (python/generator).
function (tautline_add_server_manager_xmls)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "XMLS")
  set(xmls)
  foreach (name IN LISTS arg_XMLS)
    _tautline_expand_xml(text "${TAUTLINE_SERVER_MANAGER_DIR}/${name}.xml.in" "")
    set(xml "${CMAKE_CURRENT_BINARY_DIR}/${name}.xml")
    file(CONFIGURE OUTPUT "${xml}" CONTENT "${text}" @ONLY) # does not touch an unchanged file
    list(APPEND xmls "${xml}")
  endforeach ()
  set_property(GLOBAL APPEND PROPERTY TAUTLINE_SERVER_MANAGER_XMLS ${xmls})
endfunction ()

# tautline_join_server_manager_xmls(out): one file with the proxies of all modules. ParaView rebuilds its menus, readers
# and writers after each XML file of a plugin, which takes 0.2 s: separate files would delay its start by 2 s.
function (tautline_join_server_manager_xmls out)
  get_property(xmls GLOBAL PROPERTY TAUTLINE_SERVER_MANAGER_XMLS)
  set(all "<ServerManagerConfiguration>\n")
  foreach (xml IN LISTS xmls)
    file(READ "${xml}" text)
    string(REGEX REPLACE "</?ServerManagerConfiguration>\n" "" text "${text}")
    string(APPEND all "${text}")
  endforeach ()
  string(APPEND all "</ServerManagerConfiguration>\n")
  file(CONFIGURE OUTPUT "${out}" CONTENT "${all}" @ONLY)
endfunction ()
