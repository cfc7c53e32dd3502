#pragma once

#include <unistd.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "knead/exchange/file_io.hpp"
#include "support/foreign_files.hpp"
#include "support/made_files.hpp"

namespace knead::testing {

inline std::filesystem::path samples() {
  return std::filesystem::path(KNEAD_SOURCE_DIR) / "samples";
}

/// How files are made that tests read by their names.
using FileMakers = std::map<std::string, std::function<bool(const std::filesystem::path&)>>;
inline FileMakers& file_makers() {
  static FileMakers makers = [] {
    FileMakers all;
    for (const auto* list : {&made_step_files, &made_iges_files}) {
      for (const auto& [name, text] : *list) {
        all[name] = [text](const auto& path) {
          return write_file_atomically(path, text()).has_value();
        };
      }
    }
    return all;
  }();
  return makers;
}

/// The folder of made files, which goes with the process.
inline const std::filesystem::path& made_folder() {
  struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("knead-made-" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

/// Where a file of this name lies: made now, of the samples, or of others.
inline std::filesystem::path path_of(const std::string& name) {
  if (const auto maker = file_makers().find(name); maker != file_makers().end()) {
    const auto path = made_folder() / name;
    const bool there = std::filesystem::exists(path) || maker->second(path);
    EXPECT_TRUE(there) << name;
    return path;
  }
  const auto sample = samples() / name;
  return std::filesystem::exists(sample) ? sample : foreign_cad(name);
}

inline std::vector<std::string> names_of(const std::vector<MadeFile>& made) {
  std::vector<std::string> result;
  for (const auto& [name, text] : made) result.push_back(name);
  return result;
}
inline std::vector<std::string> with_own(std::vector<std::string> files, const auto& foreign) {
  files.insert(files.end(), foreign.begin(), foreign.end());
  return files;
}
/// STEP files of the project: those of `samples`, and made ones.
inline std::vector<std::string> own_step() {
  return with_own({"bonnet.step"}, names_of(made_step_files));
}

// All files of a kind, the parameters of tests.
inline std::vector<std::string> step_files() { return with_own(own_step(), foreign_step); }
inline std::vector<std::string> iges_files() {
  return with_own(names_of(made_iges_files), foreign_iges);
}

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
