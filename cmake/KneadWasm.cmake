# The libraries that Knead stands on, for WebAssembly: the headers that this machine has anyway, without anything
# compiled. Their directory also holds the headers of this machine's C library, which must not be seen: each library is
# linked into a directory of its own.
function(knead_header_library target directory header)
  find_path(${directory}_HEADERS ${directory}/${header} PATHS /usr/include /usr/include/eigen3 NO_DEFAULT_PATH
            NO_CMAKE_FIND_ROOT_PATH REQUIRED)
  mark_as_advanced(${directory}_HEADERS)
  set(links ${PROJECT_BINARY_DIR}/headers)
  file(MAKE_DIRECTORY ${links})
  file(CREATE_LINK ${${directory}_HEADERS}/${directory} ${links}/${directory} SYMBOLIC)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} INTERFACE ${links})
endfunction()

knead_header_library(Eigen3::Eigen Eigen Core)
knead_header_library(fmt::fmt fmt format.h)
# Without a fixed separator of thousands, {fmt} brings the locales of the C++ library along, unused.
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY "FMT_STATIC_THOUSANDS_SEPARATOR=','")
knead_header_library(nlohmann_json::nlohmann_json nlohmann json.hpp)
