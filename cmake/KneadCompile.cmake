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
