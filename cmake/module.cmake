# How every folder becomes a library, and how the layers are kept.

add_library(sunfleck_options INTERFACE)
target_compile_options(sunfleck_options INTERFACE
  -Wall -Wextra -Wno-missing-field-initializers  # designated initializers name what differs from the default
  -Wpedantic -Wshadow -Wconversion
  $<$<CXX_COMPILER_ID:GNU>:-Wdouble-promotion>  # Clang's also warns of double{x}, which says what it does
  $<$<BOOL:${SUNFLECK_WERROR}>:-Werror>)
if(SUNFLECK_SANITIZE)
  target_compile_options(sunfleck_options INTERFACE -fsanitize=${SUNFLECK_SANITIZE} -fno-omit-frame-pointer
    $<$<CXX_COMPILER_ID:GNU,Clang>:-fno-sanitize-recover=all>)
  target_link_options(sunfleck_options INTERFACE -fsanitize=${SUNFLECK_SANITIZE})
endif()

set(CMAKE_VERIFY_INTERFACE_HEADER_SETS ON)  # target all_verify_interface_header_sets compiles each public header alone

# Solvers of the same physics that are checked against each other: none may rest on another, or their agreement would be
# no evidence.
set(SUNFLECK_WITNESSES spp pp_solver render/reference)

# sunfleck_module(HEADERS ... [SOURCES ...] [DEPENDS <folder>...] [LINKS <target>...] [PRIVATE_LINKS <target>...])
# Makes the calling folder a library: render/gl becomes sunfleck::render_gl. A dependency must stand in a layer below
# (have been added before), and a file may include only its own folder and those in DEPENDS.
function(sunfleck_module)
  cmake_parse_arguments(M "" "" "HEADERS;SOURCES;DEPENDS;LINKS;PRIVATE_LINKS" ${ARGN})
  file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  string(REPLACE "/" "_" name "${folder}")
  if(M_SOURCES)
    add_library(sunfleck_${name} STATIC ${M_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(sunfleck_${name} PRIVATE sunfleck_options ${M_PRIVATE_LINKS})
  else()
    add_library(sunfleck_${name} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(sunfleck::${name} ALIAS sunfleck_${name})
  target_sources(sunfleck_${name} ${scope}
    FILE_SET HEADERS BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${M_HEADERS})
  target_link_libraries(sunfleck_${name} ${scope} ${M_LINKS})

  set(below ${M_DEPENDS})  # all folders this one rests on, directly or not
  foreach(dependency IN LISTS M_DEPENDS)
    string(REPLACE "/" "_" target "sunfleck_${dependency}")
    if(NOT TARGET ${target})
      message(FATAL_ERROR "${folder} depends on ${dependency}, which is not a layer below it")
    endif()
    target_link_libraries(sunfleck_${name} ${scope} ${target})
    get_property(further GLOBAL PROPERTY sunfleck_below_${dependency})
    list(APPEND below ${further})
  endforeach()
  set_property(GLOBAL PROPERTY sunfleck_below_${folder} "${below}")
  foreach(witness IN LISTS SUNFLECK_WITNESSES)
    if(folder IN_LIST SUNFLECK_WITNESSES AND witness IN_LIST below)
      message(FATAL_ERROR "${folder} depends on ${witness}, directly or not; their agreement would be no evidence")
    endif()
  endforeach()

  file(GLOB files CONFIGURE_DEPENDS *.hpp *.cpp *.glsl *.vert *.frag *.comp detail/*)
  foreach(file IN LISTS files)
    file(STRINGS "${file}" includes REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^[^<\"]*([<\"])([^>\"]*)[>\"].*" "\\2" path "${line}")
      set(quoted "${CMAKE_MATCH_1}")
      get_filename_component(used "${path}" DIRECTORY)
      string(REGEX REPLACE "(^|/)detail$" "" used "${used}")
      if(quoted STREQUAL "<" AND (NOT used OR NOT EXISTS "${PROJECT_SOURCE_DIR}/${used}"))
        continue()  # a library's header
      endif()
      if(NOT used STREQUAL folder AND NOT used IN_LIST M_DEPENDS)
        message(FATAL_ERROR "${file} includes ${used}/, which ${folder} does not declare in DEPENDS")
      endif()
    endforeach()
  endforeach()
endfunction()

# sunfleck_kernel(<target> <source>...): compiles sources of a target once for each instruction set, with SUNFLECK_ISA, its
# name, and SUNFLECK_VECTOR_BYTES, the size of its vectors; the program chooses when it runs (core/instruction_set.hpp).
# Each puts its code in a namespace SUNFLECK_ISA, or code of one set could stand in for another's. Where there is more
# than the baseline the target has SUNFLECK_X86 defined.
function(sunfleck_kernel target)
  set(baseline_bytes 16)
  set(avx2_bytes 32)
  set(avx2_flags -mavx2 -mfma)
  set(avx512_bytes 64)
  set(avx512_flags -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512)
  set(optimised -O3)
  if(SUNFLECK_SANITIZE)
    # The checks between unrolled code would compile for minutes, and make GCC see what is not set where all is.
    set(optimised -O1 -Wno-maybe-uninitialized)
  endif()
  set(sets baseline)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    list(APPEND sets avx2 avx512)
    target_compile_definitions(${target} PRIVATE SUNFLECK_X86)
  endif()
  foreach(isa IN LISTS sets)
    set(kernel ${target}_kernel_${isa})
    add_library(${kernel} OBJECT ${ARGN})
    target_compile_definitions(${kernel} PRIVATE SUNFLECK_ISA=${isa} SUNFLECK_VECTOR_BYTES=${${isa}_bytes})
    target_compile_options(${kernel} PRIVATE ${optimised} -fno-math-errno -ffp-contract=fast -fopenmp-simd -Wno-psabi
      ${${isa}_flags})
    target_include_directories(${kernel} PRIVATE "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${kernel} PRIVATE sunfleck_options)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${kernel}>)
  endforeach()
endfunction()
