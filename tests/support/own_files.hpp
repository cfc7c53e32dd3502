#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/foreign_files.hpp"

namespace knead::testing {

inline std::filesystem::path samples() { return std::filesystem::path(KNEAD_SOURCE_DIR) / "samples"; }

/// STEP files of the project: those of `samples`.
inline std::vector<std::string> own_step() { return {"bonnet.step"}; }

/// Where a file of this name lies, the project's or one of others.
inline std::filesystem::path path_of(const std::string& name) {
  const auto sample = samples() / name;
  return std::filesystem::exists(sample) ? sample : foreign_cad(name);
}

inline std::vector<std::string> with_own(std::vector<std::string> own, const auto& foreign) {
  own.insert(own.end(), foreign.begin(), foreign.end());
  return own;
}
/// All STEP files, the parameters of tests.
inline std::vector<std::string> step_files() { return with_own(own_step(), foreign_step); }
inline std::vector<std::string> iges_files() { return with_own({}, foreign_iges); }
inline std::vector<std::string> brep_files() { return with_own({}, foreign_brep); }

inline std::vector<std::filesystem::path> own_step_paths() {
  std::vector<std::filesystem::path> result;
  for (const std::string& name : own_step()) result.push_back(path_of(name));
  return result;
}

/// Tests of one file, whose name is their parameter.
class FileTest : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { KNEAD_NEEDS(path_); }
  const std::filesystem::path path_ = path_of(GetParam());
};

}  // namespace knead::testing
