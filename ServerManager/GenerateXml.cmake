# SPDX-License-Identifier: BSD-3-Clause
# The XML of ParaView's proxies is generated from ServerManager/<Capability>.xml.in when CMake configures. What
# repeats is written once, in ServerManager/Snippets:
#
#   <?include Threads.xml?>                               stands for the content of the snippet's root element
#   <?include ShownIf.xml property="Preset" value="0"?>   with values for its parameters @property@ and @value@
#   <?if value?> ... <?end?>                              in a snippet: kept if the parameter is not empty
#
# Attributes of the root element <Snippet> are the parameters that may be left out, with their defaults. An attribute
# that is nothing but a parameter, as in panel_visibility="@visibility@", is left out where the parameter is empty.
# Templates and snippets are well-formed XML. A parameter that is missing or unknown stops the configuration.
# Attributes that begin with python or shell are for the Python package, see python/generator; ParaView ignores them.

set(TAUTLINE_SERVER_MANAGER_DIR "${CMAKE_CURRENT_LIST_DIR}")

# Puts `value` in the place of the parameter `name` in `text` and `defaults`; `used`: whether there was one. A macro
# without arguments, as a macro would take escape sequences in them for its own.
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

# Drops what stands between <?skip?> and <?end?> in `text`, and the marks around what is kept.
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

# The text of a template or snippet with its parameters and all it includes. No list is made of any text: texts
# contain semicolons and brackets.
function (_tautline_expand_xml out file arguments)
  if (NOT EXISTS "${file}")
    message(FATAL_ERROR "ServerManager: there is no ${file}")
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
    # What is given comes before the default.
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
    message(FATAL_ERROR "${file}: ${CMAKE_MATCH_0} has no value, or is not understood")
  endif ()
  set(${out} "${text}" PARENT_SCOPE)
endfunction ()

# tautline_add_server_manager_xmls(XMLS name...): the proxies of a module, from ServerManager/<name>.xml.in. The Python
# package is generated from them, too (python/generator).
function (tautline_add_server_manager_xmls)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "XMLS")
  set(xmls)
  foreach (name IN LISTS arg_XMLS)
    _tautline_expand_xml(text "${TAUTLINE_SERVER_MANAGER_DIR}/${name}.xml.in" "")
    set(xml "${CMAKE_CURRENT_BINARY_DIR}/${name}.xml")
    file(CONFIGURE OUTPUT "${xml}" CONTENT "${text}" @ONLY) # leaves a file that would not change
    list(APPEND xmls "${xml}")
  endforeach ()
  set_property(GLOBAL APPEND PROPERTY TAUTLINE_SERVER_MANAGER_XMLS ${xmls})
endfunction ()

# tautline_join_server_manager_xmls(out): one file with the proxies of all modules. ParaView makes its menus, readers and
# writers anew after each file of a plugin, which takes a fifth of a second: its start would be two seconds longer.
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
