// What Open CASCADE finds in the new files that `save_faces` makes of others, beside what it finds
// in these.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>

#include "exchange/length_units.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/exchange/save_model.hpp"
#include "oracle/body_files.hpp"
#include "oracle/occt_bodies.hpp"
#include "oracle/occt_held.hpp"
#include "oracle/occt_places.hpp"
#include "oracle/occt_shapes.hpp"
#include "support/long_run.hpp"
#include "support/made_iges_solids.hpp"

namespace knead::oracle {
namespace {

constexpr double same = 1e-5;  // of areas, as Open CASCADE integrates them
constexpr double sewn = 1e-4;  // of volumes between faces that it sews
// Of swept and rational faces, whose areas and volumes it finds at fixed points.
constexpr double fixed = 0.05;
constexpr double resolution = 1e-3;  // mm: of gaps

struct Target {
  const char* format;
  const char* ending;
  bool convert;
  const char* title;
};
constexpr Target targets[] = {{"step", ".step", false, "STEP"},
                              {"iges", ".igs", false, "IGES"},
                              {"step", ".step", true, "STEP, converted"},
                              {"iges", ".igs", true, "IGES, converted"}};

class SavedFacesOracle : public BodyFile {
 protected:
  void SetUp() override {
    BodyFile::SetUp();
    if (ended()) return;
    if (source_->model() == nullptr || source_->model()->faces.empty())
      GTEST_SKIP() << "it has no faces";
    before_ = occt_bodies(path_);
    const auto held = OcctHeld::read(path_);
    ASSERT_TRUE(before_);
    if (!held) GTEST_SKIP() << "Open CASCADE reads no edges of a file without products";
    bad_ = held->bad_shapes();
    gap_ = std::ranges::max(held->gaps());
    if (source_->format() != "IGES") return;
    sewn_ = 1e-6 * before_->whole.box.diagonal().norm();
    const auto* unit = length_unit_named(source_->model()->length_unit());
    for (const brep::Support& s : source_->model()->supports)
      sewn_ = std::max(sewn_, s.uncertainty * (unit != nullptr ? unit->millimetres : 1));
  }

  void check(const Target& target);

  std::optional<OcctBodies> before_;
  int bad_ = 0;
  double gap_ = 0;   // of edges from faces, mm
  double sewn_ = 0;  // within which edges of IGES faces are one, mm
};

double volume_of_solids(const OcctBodies& bodies) {
  double result = 0;
  for (const OcctBody& shell : bodies.shells.empty() ? bodies.sewn : bodies.shells)
    result += shell.volume;
  return result;
}

void SavedFacesOracle::check(const Target& target) {
  SCOPED_TRACE(target.title);
  // Swept surfaces, and tori that cross themselves, are B-splines in IGES.
  const bool swept =
      std::ranges::any_of(source_->model()->supports, [](const brep::Support& support) {
        const auto* form = std::get_if<brep::ElementarySurface>(&support.form);
        const bool crosses = form != nullptr && form->kind == brep::ElementarySurface::Kind::torus;
        return std::holds_alternative<brep::SweptSurface>(support.form) ||
               (crosses && form->second > form->radius);
      });
  const bool rational = target.convert || (swept && std::string_view(target.format) == "iges");
  const auto saved = save_faces(*source_, *find_format(target.format), {}, target.convert);
  ASSERT_TRUE(saved) << saved.error().message();
  const auto path = std::filesystem::temp_directory_path() /
                    ("knead-saved-" + std::to_string(::getpid()) + std::string(target.ending));
  ASSERT_TRUE(write_file_atomically(path, saved->bytes));
  const auto after = occt_bodies(path);
  const auto held = OcctHeld::read(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(after && held);
  std::size_t left = 0;
  for (const LeftOut& one : saved->left_out) {
    if (one.one.starts_with("face")) left += one.count;
  }
  EXPECT_EQ(left, 0U);
  EXPECT_EQ(after->faces, before_->faces);
  EXPECT_GE(after->solids, before_->solids);
  EXPECT_LE(held->bad_shapes(), bad_);
  const double gap = std::ranges::max(held->gaps());
  EXPECT_LE(gap, std::max(gap_ * (1 + same) + sewn_, resolution));
  const double volume = volume_of_solids(*before_), now = volume_of_solids(*after);
  // An edge that stands off its face leaves open which of the two bounds it.
  const double area = before_->whole.area, open = gap_ * std::sqrt(area);
  EXPECT_NEAR(after->whole.area, area, (rational ? fixed : same) * area + open);
  if (volume != 0) {
    const bool arcs = std::string_view(target.format) == "iges";  // of ellipses are B-splines there
    const double within = rational ? fixed : before_->solids == 0 || arcs ? sewn : same;
    EXPECT_NEAR(now, volume, within * std::abs(volume));
  }
  const double off = (after->whole.box.min() - before_->whole.box.min()).norm() +
                     (after->whole.box.max() - before_->whole.box.max()).norm();
  const std::string row =
      fmt::format("| {} | {} | {} | {} | {} | {} | {:.1e} | {} | {:.1e} | {:.1e} | {:.1e} |",
                  GetParam(), target.title, saved->faces, left, after->solids,
                  held->bad_shapes() - bad_, std::abs(after->whole.area / before_->whole.area - 1),
                  volume != 0 ? fmt::format("{:.1e}", std::abs(now / volume - 1)) : "",
                  off / before_->whole.box.diagonal().norm(), gap_, gap);
  std::cout << row << "\n";
  const char* table = std::getenv("KNEAD_SAVED_TABLE");
  if (table != nullptr && !testing::file_makers().contains(GetParam()))
    std::ofstream(table, std::ios::app) << row << "\n";
}

TEST_P(SavedFacesOracle, OpenCascadeFindsTheSameFacesAreasAndVolumes) {
  for (const Target& target : targets) check(target);
}

INSTANTIATE_TEST_SUITE_P(Files, SavedFacesOracle,
                         ::testing::ValuesIn(files_with_bodies(occt_shape_names())),
                         testing::file_test_name);

}  // namespace
}  // namespace knead::oracle
