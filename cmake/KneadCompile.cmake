# Compiler settings shared by the library, the command line, the tests and the benchmarks.
# No -ffast-math and no contraction across statements: results must not depend on how a loop was compiled.
function(knead_compile_settings target)
  target_compile_features(${target} PUBLIC cxx_std_23)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  if(NOT CMAKE_SYSTEM_PROCESSOR STREQUAL wasm32)  # a module is linked at fixed addresses
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                           -Wnon-virtual-dtor -ffp-contract=off
                                           # GCC 12 false positive on std::string (its bug 105651)
                                           $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  if(KNEAD_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# What nearly every source reads, compiled once for a target. Sources include what they use all the same: the preset
# noexcept-alone has none of this (CMAKE_DISABLE_PRECOMPILE_HEADERS), nor have sources with compiler options of their
# own, which a precompiled header must share.
set(KNEAD_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <expected> <functional> <limits> <memory> <optional> <span>
                         <string> <string_view> <utility> <variant> <vector> <Eigen/Core> <Eigen/Geometry> <Eigen/SparseCore>)
function(knead_precompile target)  # knead_precompile(<target> further headers...)
  target_precompile_headers(${target} PRIVATE ${KNEAD_COMMON_HEADERS} ${ARGN})
  knead_precompiled(${target})
endfunction()
function(knead_precompiled target)
  # Precompiled, std::string is a system header no longer, and GCC 12 has more of those false positives to tell.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow;-Wno-array-bounds;-Wno-stringop-overread>)
endfunction()
function(knead_own_options)  # knead_own_options(files of the library with compiler options of their own...)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY knead PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# knead_small(files of the library...): compiled for size in releases, each alone: what describes, reads and reports, for
# which nobody waits. Wheels hold it.
function(knead_small)
  knead_own_options(${ARGN})
  set_source_files_properties(${ARGN} TARGET_DIRECTORY knead
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS "$<$<CONFIG:Release>:-Os>")
endfunction()

# knead_kernels(vector128|avx2|avx512 files of the library... [OPTIONS ...]): kernels compiled for an instruction set,
# each from one source for all sets, which mostly are vectors already. Which of them runs is decided on the machine.
function(knead_kernels set)
  cmake_parse_arguments(PARSE_ARGV 1 kernels "" "" OPTIONS)
  set(files ${kernels_UNPARSED_ARGUMENTS})
  set(avx2 -mavx2)
  set(avx512 -mavx512f -mavx512dq -mavx512vl)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86")
    list(APPEND kernels_OPTIONS ${${set}})
  elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL wasm32)
    list(APPEND kernels_OPTIONS -O2)  # the rest of a module is compiled for size
  endif()
  target_sources(knead PRIVATE ${files})
  knead_own_options(${files})
  set_source_files_properties(${files} TARGET_DIRECTORY knead
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON COMPILE_OPTIONS "${kernels_OPTIONS}")
endfunction()

# knead_batches(<target> rooms...): in a unity build sources of one room alone are compiled together, in batches as even as
# CMAKE_UNITY_BUILD_BATCH_SIZE allows. A file that moves to another room changes the batches of those two.
function(knead_batches target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  get_target_property(all ${target} SOURCES)
  get_target_property(folder ${target} SOURCE_DIR)  # of those that the folder of the target lists
  foreach(room ${ARGN})
    set(files)
    foreach(file ${all})
      cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${folder})
      get_source_file_property(alone ${file} TARGET_DIRECTORY ${target} SKIP_UNITY_BUILD_INCLUSION)
      if(file MATCHES "^${PROJECT_SOURCE_DIR}/src/${room}/" AND NOT alone)
        list(APPEND files ${file})
      endif()
    endforeach()
    list(LENGTH files count)
    if(count GREATER 0 AND CMAKE_UNITY_BUILD_BATCH_SIZE)
      math(EXPR batches "(${count} + ${CMAKE_UNITY_BUILD_BATCH_SIZE} - 1) / ${CMAKE_UNITY_BUILD_BATCH_SIZE}")
      set(index 0)
      foreach(file ${files})
        math(EXPR batch "${index} * ${batches} / ${count}")
        set_source_files_properties(${file} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${room}_${batch})
        math(EXPR index "${index} + 1")
      endforeach()
    endif()
  endforeach()
endfunction()
