# Check that cmake/module.cmake keeps the layers: a project that obeys them configures, and each kind of breach is
# refused with a message that names it.
#   SOURCE  the repository     WORK  a folder for the projects
cmake_minimum_required(VERSION 3.24)

# What each folder of the projects declares and includes when it obeys. They are added in this order.
set(folders core spp grid render render/reference)
set(depends_spp core)
set(depends_grid core spp)
set(depends_render core)
set(depends_render_reference core render)
set(include_grid "\n#include <vector>\n#include \"core/core.hpp\"\n#include \"grid/grid.hpp\"\n#include <spp/spp.hpp>")

# Configures the project in WORK/<name> with what one folder declares (kind DEPENDS) or includes (INCLUDE) replaced.
function(configure status_out errors_out name kind folder value)
  if(kind STREQUAL "DEPENDS")
    set(depends_${folder} ${value})
  elseif(kind STREQUAL "INCLUDE")
    set(include_${folder} "${value}")
  endif()
  set(project "${WORK}/${name}")
  file(REMOVE_RECURSE "${project}")
  file(COPY "${SOURCE}/cmake/module.cmake" DESTINATION "${project}/cmake")
  set(top "cmake_minimum_required(VERSION 3.24)\nproject(layers LANGUAGES NONE)\ninclude(cmake/module.cmake)\n")
  foreach(part IN LISTS folders)
    string(REPLACE "/" "_" key ${part})
    list(JOIN depends_${key} " " depends)
    string(APPEND top "add_subdirectory(${part})\n")
    file(WRITE "${project}/${part}/CMakeLists.txt" "sunfleck_module(HEADERS ${key}.hpp DEPENDS ${depends})\n")
    file(WRITE "${project}/${part}/${key}.hpp" "#pragma once\n${include_${key}}\n")
  endforeach()
  file(WRITE "${project}/CMakeLists.txt" "${top}")
  execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S "${project}" -B "${project}/build"
    RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE errors)
  string(REGEX REPLACE "[ \n]+" " " errors "${errors}")
  set(${status_out} "${status}" PARENT_SCOPE)
  set(${errors_out} "${errors}" PARENT_SCOPE)
endfunction()

function(must_refuse name kind folder value expected)
  configure(status errors ${name} ${kind} ${folder} "${value}")
  if(status EQUAL 0)
    message(SEND_ERROR "${name}: configured, but must be refused with '${expected}'")
  elseif(NOT errors MATCHES "${expected}")
    message(SEND_ERROR "${name}: must be refused with '${expected}', but says: ${errors}")
  endif()
endfunction()

configure(status errors obeys "" "" "")
if(NOT status EQUAL 0)
  message(SEND_ERROR "a project that keeps the layers is refused: ${errors}")
endif()

must_refuse(upward DEPENDS spp "core;grid" "spp depends on grid, which is not a layer below it")
must_refuse(undeclared INCLUDE core "#include \"spp/spp.hpp\"" "core.hpp includes spp/, which core does not declare")
must_refuse(undeclared_angle INCLUDE core "#include <grid/grid.hpp>" "core.hpp includes grid/, which core does not declare")
must_refuse(undeclared_indented INCLUDE core "  # include \"grid/detail/cells.hpp\"" "core.hpp includes grid/, which")
must_refuse(witness DEPENDS render_reference "core;spp" "render/reference depends on spp")
must_refuse(witness_by_way DEPENDS render_reference "core;grid" "render/reference depends on spp")
