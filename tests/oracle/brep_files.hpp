#pragma once

#include "oracle/occt_shells.hpp"
#include "support/own_files.hpp"

namespace knead::oracle {

/// All .brep files, the parameters of tests; Open CASCADE makes our own.
inline std::vector<std::string> brep_files() {
  std::vector<std::string> names = occt_brep_names();
  for (const std::string& name : names) {
    testing::file_makers()[name] = [name](const auto& path) { return occt_write_brep(name, path); };
  }
  return testing::with_own(std::move(names), testing::foreign_brep);
}

}  // namespace knead::oracle
