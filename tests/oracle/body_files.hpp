#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "oracle/brep_files.hpp"
#include "oracle/occt_places.hpp"
#include "oracle/occt_shapes.hpp"
#include "support/foreign_files.hpp"
#include "support/long_run.hpp"
#include "support/made_iges_solids.hpp"

namespace knead::oracle {

/// Files with bodies: those of the folder of foreign data, made ones, and these shapes of Open
/// CASCADE as STEP files.
inline std::vector<std::string> files_with_bodies(std::span<const std::string> shapes) {
  using Maker = std::pair<std::string, std::string (*)()>;
  std::vector<std::string> names = testing::with_own(testing::step_files(), testing::iges_files());
  names = testing::with_own(std::move(names), brep_files());
  for (const auto& [name, text] : {Maker("made_hollow_box.igs", testing::iges_hollow_box),
                                   {"made_hollow_boxes.igs", testing::iges_hollow_boxes},
                                   {"made_drum.igs", testing::iges_drum_in_inch}}) {
    testing::file_makers()[name] = [text](const auto& path) {
      return write_file_atomically(path, text()).has_value();
    };
    names.push_back(name);
  }
  for (const std::string& shape : shapes) {
    const std::string name = "made_" + shape + ".step";
    testing::file_makers()[name] = [shape](const auto& path) {
      return occt_write_shape(shape, path);
    };
    names.push_back(name);
  }
  testing::file_makers()["made_hollow.brep"] = [](const auto& path) {
    return occt_write_placed("hollow", path);
  };
  names.emplace_back("made_hollow.brep");
  names = testing::with_own(std::move(names), testing::foreign_faults);
  return testing::with_own(std::move(names), testing::foreign_morph);
}

/// One of these files, opened. Tests are skipped where it is not there, is large, or Open CASCADE
/// cannot read it.
class BodyFile : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    path_ = GetParam().find('/') == std::string::npos ? testing::path_of(GetParam())
                                                      : testing::foreign("data/" + GetParam());
    KNEAD_NEEDS(path_);
    if (GetParam() == "terrain.brep" && !testing::long_run())
      GTEST_SKIP() << "with KNEAD_LONG=1";  // its net is large
    const auto bytes = read_file(path_);
    ASSERT_TRUE(bytes);
    if (bytes->find("&SCOPE") != std::string::npos) GTEST_SKIP() << "Open CASCADE aborts on &SCOPE";
    source_ = testing::open_or_die(*bytes, path_.string());
  }
  [[nodiscard]] static bool ended() { return IsSkipped() || HasFatalFailure(); }

  std::filesystem::path path_;
  std::shared_ptr<const Source> source_;
};

}  // namespace knead::oracle
