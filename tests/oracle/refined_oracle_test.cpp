// Open CASCADE 7.6 reads refined surfaces as what they are, on faces that stay what they were, and
// files made of surfaces alone.

#include <cmath>

#include "exchange/new_surfaces.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "oracle/step_oracle.hpp"

namespace knead::oracle {
namespace {

using knead::testing::same_bits;

class RefinedOracle : public StepOracle {};

/// Open CASCADE holds it as it is: not made periodic, not clamped, not converted.
bool holds(const OcctSurface& occt, const Surface& surface) {
  return occt.net == surface.net() && same_bits(occt.poles, surface.control_points());
}

/// The same up to the rounding of a conversion of units.
bool nearly_holds(const OcctSurface& occt, const Surface& surface) {
  const Points& points = surface.control_points();
  return occt.net == surface.net() &&
         (occt.poles - points).cwiseAbs().maxCoeff() <= 1e-14 * points.cwiseAbs().maxCoeff();
}

void expect_holds(const OcctSurface& occt, const Surface& surface, const std::string& name) {
  EXPECT_TRUE(holds(occt, surface)) << name;
  for (int d = 0; d < 2; ++d) {
    const auto& knots = surface.knots(d);
    const auto at = static_cast<std::size_t>(d);
    EXPECT_EQ(occt.degree[at], knots.degree()) << name;
    EXPECT_TRUE(std::ranges::equal(occt.knots[at], knots.knots())) << name;
  }
  // Weights that are all the same it leaves out.
  if (!occt.weights.empty()) {
    EXPECT_TRUE(std::ranges::equal(occt.weights, surface.weights())) << name;
  }
}

TEST_P(RefinedOracle, FindsTheSameFacesOnRefinedSurfaces) {
  std::vector<brep::Replacement> refined;
  for (const auto& surface : file_->surfaces()) {
    const auto middles = [&](int d) {
      return span_midpoints(surface.surface.knots(d), surface.surface.knots(d).domain());
    };
    auto finer = insert_knots<2>(surface.surface, {middles(0), middles(1)});
    ASSERT_TRUE(finer);
    finer = elevate_degree(*finer, 1);
    ASSERT_TRUE(finer);
    refined.push_back({surface.id, *std::move(finer)});
  }
  const auto after = read_written(file_->with_surfaces(refined));
  EXPECT_EQ(before_->topology, after.topology);
  EXPECT_EQ(before_->faces, after.faces);
  int exact = 0, near = 0, altered = 0;
  for (std::size_t k = 0; k < refined.size(); ++k) {
    const auto& id = refined[k].id;
    const auto a = before_->results.find(id);
    const auto b = after.results.find(id);
    ASSERT_NE(a, before_->results.end()) << id;
    ASSERT_NE(b, after.results.end()) << id;
    ASSERT_EQ(a->second.surfaces.size(), b->second.surfaces.size()) << id;
    for (std::size_t f = 0; f < a->second.surfaces.size(); ++f) {
      if (holds(a->second.surfaces[f], file_->surfaces()[k].surface)) {
        expect_holds(b->second.surfaces[f], refined[k].surface, id);
        ++exact;
      } else if (nearly_holds(a->second.surfaces[f], file_->surfaces()[k].surface)) {
        EXPECT_TRUE(nearly_holds(b->second.surfaces[f], refined[k].surface)) << id;
        EXPECT_TRUE(
            std::ranges::equal(b->second.surfaces[f].knots[0], refined[k].surface.knots(0).knots()))
            << id;
        EXPECT_TRUE(
            std::ranges::equal(b->second.surfaces[f].knots[1], refined[k].surface.knots(1).knots()))
            << id;
        ++near;
      } else {
        ++altered;
      }
    }
    // Faces are cut out as before.
    ASSERT_EQ(a->second.area_ratios.size(), b->second.area_ratios.size()) << id;
    for (std::size_t f = 0; f < a->second.area_ratios.size(); ++f) {
      EXPECT_NEAR(a->second.area_ratios[f], b->second.area_ratios[f], 1e-3) << id;
    }
  }
  std::cout << GetParam() << ": " << exact << " faces hold refined surfaces bit for bit, " << near
            << " to 1e-14, " << altered << " are on surfaces that Open CASCADE alters anyway\n";
}

INSTANTIATE_TEST_SUITE_P(Files, RefinedOracle, ::testing::ValuesIn(testing::step_files()),
                         testing::file_test_name);

TEST(StepTextOracle, ReadsNewSurfacesAsWholeFaces) {
  const auto surfaces = knead::testing::new_surfaces();
  for (const auto* unit : {"mm", "m"}) {
    const auto text = step::text_of(surfaces, {.unit = unit});
    ASSERT_TRUE(text);
    const auto path =
        fs::temp_directory_path() / ("knead-new-" + std::to_string(getpid()) + ".step");
    ASSERT_TRUE(write_file_atomically(path, *text));
    auto model = occt_read(path, unit);
    fs::remove(path);
    ASSERT_TRUE(model);
    EXPECT_EQ(model->topology["faces"], static_cast<int>(surfaces.size()));
    const auto file = *step::File::parse(*text, "new.step");
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      const auto& name = surfaces[k].name;
      const auto& result = model->results[file.surfaces()[k].id];
      ASSERT_EQ(result.surfaces.size(), 1U) << name;
      // It makes closed surfaces periodic and clamps open knots.
      if (name == "sheet" || name == "thirds")
        expect_holds(result.surfaces[0], surfaces[k].surface, name);
      ASSERT_EQ(result.area_ratios.size(), 1U) << name;
      EXPECT_NEAR(result.area_ratios[0], 1, 1e-3) << name;
    }
  }
}

}  // namespace
}  // namespace knead::oracle
