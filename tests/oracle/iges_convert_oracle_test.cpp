// Planes, cylinders and the like of IGES files become B-spline surfaces, and Open CASCADE finds the
// same faces.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "exchange/support.hpp"
#include "knead/exchange/file_info.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/save_model.hpp"
#include "oracle/occt_file.hpp"
#include "oracle/occt_shapes.hpp"
#include "support/own_files.hpp"

namespace knead::oracle {
namespace {

namespace fs = std::filesystem;

// Of it: Open CASCADE integrates rational surfaces to some thousandths.
constexpr double same_area = 0.005;

/// Converts all that can be, and lets Open CASCADE read both files. `before` lies at `path`.
void convert(const Source& before, const fs::path& path) {
  std::vector<std::string> ids;
  for (const FileOtherSurface& other : file_info(before, {.conversions = true}).other_surfaces) {
    if (other.convertible) ids.push_back(other.id);
  }
  if (ids.empty()) GTEST_SKIP() << "none of its faces can be converted";
  const auto after = before.with_splines(ids);
  ASSERT_TRUE(after) << after.error().message();
  std::vector<std::shared_ptr<const Surface>> surfaces;
  for (const SourceSurface& s : (*after)->surfaces()) surfaces.push_back(s.surface);
  const auto bytes = (*after)->save(surfaces);
  ASSERT_TRUE(bytes) << bytes.error().message();
  const fs::path out =
      fs::temp_directory_path() / ("knead-iges-converted-" + std::to_string(getpid()) + ".igs");
  ASSERT_TRUE(write_file_atomically(out, *bytes));
  const auto was = occt_read_file(path), now = occt_read_file(out);
  fs::remove(out);
  ASSERT_TRUE(was);
  ASSERT_TRUE(now);
  EXPECT_LE(now->bad_faces, was->bad_faces);
  EXPECT_NEAR(now->area, was->area, same_area * was->area);
  EXPECT_EQ(now->topology.at("faces"), was->topology.at("faces"));
}

class IgesConvertedFile : public testing::FileTest {};

TEST_P(IgesConvertedFile, HasTheSameFaces) {
  KNEAD_NEEDS(path_);
  convert(*testing::open_or_die(*read_file(path_), path_.string()), path_);
}

INSTANTIATE_TEST_SUITE_P(Files, IgesConvertedFile, ::testing::ValuesIn(testing::iges_files()),
                         testing::file_test_name);

class IgesConvertedShape : public ::testing::TestWithParam<std::string> {};

/// Shapes with cylinders, cones, spheres and tori, as new IGES files.
TEST_P(IgesConvertedShape, HasTheSameFaces) {
  const fs::path path =
      fs::temp_directory_path() / ("knead-iges-shape-" + std::to_string(getpid()));
  const fs::path step = path.string() + ".step", iges = path.string() + ".igs";
  ASSERT_TRUE(occt_write_shape(GetParam(), step));
  const auto shape = testing::open_or_die(*read_file(step), step.string());
  const auto made = save_faces(*shape, *find_format("iges"));
  ASSERT_TRUE(made) << made.error().message();
  ASSERT_TRUE(write_file_atomically(iges, made->bytes));
  convert(*testing::open_or_die(made->bytes, iges.string()), iges);
  fs::remove(step);
  fs::remove(iges);
}

INSTANTIATE_TEST_SUITE_P(Shapes, IgesConvertedShape, ::testing::ValuesIn(occt_shape_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace knead::oracle
