// Planes, cylinders and the like become B-spline surfaces, and Open CASCADE finds the same solid.

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <map>

#include "exchange/step/conversion.hpp"
#include "knead/brep/face_conversion.hpp"
#include "oracle/occt_gaps.hpp"
#include "oracle/occt_shapes.hpp"
#include "oracle/occt_shells.hpp"
#include "oracle/pressed_edges.hpp"
#include "support/long_run.hpp"

namespace knead::oracle {
namespace {

constexpr std::size_t most_of_a_form = 6, few_of_a_form = 1;
// Of the size: the distances that Open CASCADE finds of points on equal surfaces.
constexpr double exact = 1e-12;
constexpr double resolution = 2e-9;   // mm: its search ends at 1e-9
constexpr double confusion = 1e-7;    // mm: within which it takes points for the same
constexpr double same_normal = 1e-4;  // degrees, from feet that are only as exact as the search

/// A row of the table in docs/evidence/trims.md, where its file is named.
void write_row(const std::string& row) {
  std::cout << row << "\n";
  if (const char* path = std::getenv("KNEAD_CONVERT_TABLE"))
    std::ofstream(path, std::ios::app) << row << "\n";
}

double size_of(const Surface& surface) {
  const Points& net = surface.control_points();
  return (net.colwise().maxCoeff() - net.colwise().minCoeff()).norm();
}

/// Converts surfaces of a file, and lets Open CASCADE compare.
void convert(const fs::path& path, const step::File& file, const OcctFaces& before,
             const std::vector<brep::OtherSurface>& surfaces, const fs::path& directory) {
  std::vector<std::string> ids;
  for (const auto& s : surfaces) ids.push_back(s.id);
  const auto converted = step::with_splines(file, ids);
  ASSERT_TRUE(converted) << converted.error().message();
  const auto written = directory / path.filename();
  ASSERT_TRUE(write_file_atomically(written, converted->bytes()));
  const auto after = OcctFaces::read(written);
  ASSERT_TRUE(after);
  EXPECT_EQ(before.topology(), after->topology());
  EXPECT_LE(after->bad_faces(), before.bad_faces());
  EXPECT_LE(after->bad_edges(), before.bad_edges());
  const double mm = file.model().units.empty() ? 1 : 1000 * file.model().units.front().metres;
  OcctFaces::Apart worst;
  double gap_before = 0, gap = 0, tolerance_before = 0, tolerance = 0;
  for (const auto& s : surfaces) {
    SCOPED_TRACE(s.id + " " + s.form);
    const auto apart = before.apart(s.id, *after);
    EXPECT_GT(apart.points, 0);
    EXPECT_LE(apart.distance,
              exact * mm * size_of(converted->model().find_surface(s.id)->surface) + resolution);
    EXPECT_LE(apart.turn, same_normal);
    const auto old_edges = before.edges(s.id, before), new_edges = after->edges(s.id, *after);
    EXPECT_EQ(old_edges.size(), new_edges.size());
    for (std::size_t k = 0; k < std::min(old_edges.size(), new_edges.size()); ++k) {
      EXPECT_LE(new_edges[k].gap, std::max(old_edges[k].gap, confusion) + resolution)
          << "edge " << k;
      EXPECT_LE(new_edges[k].ends, std::max(old_edges[k].ends, confusion) + resolution)
          << "edge " << k;
      gap_before = std::max(gap_before, old_edges[k].gap);
      gap = std::max(gap, new_edges[k].gap);
      tolerance_before = std::max(tolerance_before, old_edges[k].tolerance);
      tolerance = std::max(tolerance, new_edges[k].tolerance);
    }
    worst.distance = std::max(worst.distance, apart.distance);
    worst.turn = std::max(worst.turn, apart.turn);
  }
  const std::string what = surfaces.size() == 1
                               ? surfaces[0].id + " " + surfaces[0].form
                               : fmt::format("all {} that can be", surfaces.size());
  write_row(fmt::format("| {} | {} | {:.2g} | {:.2g} | {:.2g} | {:.2g} | {:.2g} | {:.2g} |",
                        path.filename().string(), what, worst.distance, worst.turn, gap_before, gap,
                        tolerance_before, tolerance));
}

/// Those that can be converted; every other one is named with its reason.
std::vector<brep::OtherSurface> convertible(const step::File& file) {
  std::vector<brep::OtherSurface> result;
  for (const auto& s : brep::other_surfaces(file.model())) {
    const auto made = brep::exact_spline(file.model(), s.id);
    if (made) result.push_back(s);
    if (!made) std::cout << s.id << " " << s.form << ": " << made.error().message() << "\n";
  }
  return result;
}

/// Up to six of every form, spread over the file; one but in a long run.
std::vector<brep::OtherSurface> spread(const std::vector<brep::OtherSurface>& all) {
  std::map<std::string, std::vector<brep::OtherSurface>> by_form;
  for (const auto& s : all) by_form[s.form].push_back(s);
  std::vector<brep::OtherSurface> result;
  for (const auto& [form, list] : by_form) {
    const std::size_t count =
        std::min(list.size(), testing::long_run() ? most_of_a_form : few_of_a_form);
    for (std::size_t k = 0; k < count; ++k) {
      result.push_back(list[count == 1 ? 0 : k * (list.size() - 1) / (count - 1)]);
    }
  }
  return result;
}

void convert_some(const fs::path& path, const step::File& file, const fs::path& directory) {
  const auto all = convertible(file);
  const auto before = OcctFaces::read(path);
  ASSERT_TRUE(before);
  for (const auto& s : spread(all)) convert(path, file, *before, {s}, directory);
  if (all.size() > 1) convert(path, file, *before, all, directory);
}

class ConvertedFile : public StepOracle {};

TEST_P(ConvertedFile, IsTheSameSolid) {
  if (GetParam() == "linkrods.step" && !testing::long_run())
    GTEST_SKIP() << "with KNEAD_LONG=1";  // its nets are large
  if (brep::other_surfaces(file_->model()).empty())
    GTEST_SKIP() << "all of its faces lie on B-spline surfaces";
  convert_some(path_, *file_, directory_);
}

INSTANTIATE_TEST_SUITE_P(Files, ConvertedFile, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

/// Gives the file that `write` makes of this name, with its path and a directory beside it, which
/// are removed after.
template <class F>
void on_made(const std::string& name, bool (*write)(const std::string&, const fs::path&),
             const F& act) {
  const auto directory = fs::temp_directory_path() / ("knead-convert-" + std::to_string(getpid()));
  fs::create_directories(directory / "after");
  const auto path = directory / (name + ".step");
  ASSERT_TRUE(write(name, path));
  const auto file = step::File::read(path);
  ASSERT_TRUE(file) << file.error().message();
  act(path, *file, directory / "after");
  fs::remove_all(directory);
}

class ConvertedShape : public ::testing::TestWithParam<std::string> {};

TEST_P(ConvertedShape, IsTheSameSolid) {
  on_made(GetParam(), occt_write_shape,
          [](const fs::path& path, const step::File& file, const fs::path& directory) {
            EXPECT_EQ(convertible(file).size(), brep::other_surfaces(file.model()).size())
                << "all of them can be converted";
            convert_some(path, file, directory);
          });
}

INSTANTIATE_TEST_SUITE_P(Shapes, ConvertedShape, ::testing::ValuesIn(occt_shape_names()),
                         [](const auto& instance) { return instance.param; });

/// Edges at which one of the faces lies on a converted surface, or both do.
bool has_one_of(const std::vector<std::string>& surfaces,
                const std::vector<brep::OtherSurface>& converted) {
  return std::ranges::any_of(surfaces, [&](const std::string& id) {
    return std::ranges::find(converted, id, &brep::OtherSurface::id) != converted.end();
  });
}

/// Converts all that can be, and presses edges to it, of which there are at least so many.
void press_converted(const fs::path& path, const step::File& file, const fs::path& directory,
                     double least_reached, std::size_t least_pairs = 1) {
  const auto others = convertible(file);
  std::vector<std::string> ids;
  for (const auto& s : others) ids.push_back(s.id);
  const auto converted = step::with_splines(file, ids);
  ASSERT_TRUE(converted) << converted.error().message();
  const auto written = directory / ("converted_" + path.filename().string());
  ASSERT_TRUE(write_file_atomically(written, converted->bytes()));
  fs::create_directories(directory / "pressed");
  const auto pairs = pairs_of(converted->model(),
                              [&](const auto& surfaces) { return has_one_of(surfaces, others); });
  EXPECT_GE(pairs.size(), least_pairs);
  if (pairs.empty()) GTEST_SKIP() << "no edge has faces on both of its sides";
  for (const Pair& pair : each_kind(converted->model(), pairs)) {
    move(written, converted->model(), pair, Motion::press, directory / "pressed", least_reached);
  }
}

class PressedConvertedFile : public StepOracle {};

TEST_P(PressedConvertedFile, StaysClosedAlongItsEdges) {
  if (GetParam() == "linkrods.step" && !testing::long_run())
    GTEST_SKIP() << "with KNEAD_LONG=1";  // its nets are large
  if (brep::other_surfaces(file_->model()).empty())
    GTEST_SKIP() << "all of its faces lie on B-spline surfaces";
  press_converted(path_, *file_, directory_, 0);
}

INSTANTIATE_TEST_SUITE_P(Files, PressedConvertedFile, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

class PressedConvertedShell : public ::testing::TestWithParam<std::string> {};

TEST_P(PressedConvertedShell, StaysClosedAlongItsEdges) {
  on_made(GetParam(), occt_write_shell,
          [](const fs::path& path, const step::File& file, const fs::path& directory) {
            ASSERT_FALSE(brep::other_surfaces(file.model()).empty());
            press_converted(path, file, directory, 0.5);
          });
}

INSTANTIATE_TEST_SUITE_P(Shells, PressedConvertedShell,
                         ::testing::ValuesIn(occt_mixed_shell_names()),
                         [](const auto& instance) { return instance.param; });

class PressedConvertedShape : public ::testing::TestWithParam<std::string> {};

TEST_P(PressedConvertedShape, StaysClosedAlongItsEdges) {
  // Balls and crossing edges have their turn in sphere_zone, drilled_sphere, drilled_torus and
  // drilled_cone, too.
  const bool slow = GetParam() == "hemisphere" || GetParam() == "crossing_cylinders";
  if (slow && !testing::long_run()) GTEST_SKIP() << "with KNEAD_LONG=1";
  on_made(GetParam(), occt_write_shape,
          [](const fs::path& path, const step::File& file, const fs::path& directory) {
            press_converted(path, file, directory, 0, 0);
          });
}

INSTANTIATE_TEST_SUITE_P(Shapes, PressedConvertedShape, ::testing::ValuesIn(occt_shape_names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace knead::oracle
