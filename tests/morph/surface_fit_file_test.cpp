// The sample file, whose faces lie on other surfaces too, follows maps of space.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "knead/brep/face_conversion.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/session/document.hpp"
#include "morph/fit_models.hpp"
#include "support/own_files.hpp"

namespace knead::morph::testing {
namespace {

/// The surfaces and edges of a file, with all of its other surfaces converted.
Model model_in(const std::string& name) {
  auto document = Document::open(knead::testing::path_of(name));
  EXPECT_TRUE(document);
  std::vector<std::string> others;
  for (const auto& other : brep::other_surfaces(*document->model())) others.push_back(other.id);
  document = document->with_splines(others);
  EXPECT_TRUE(document);
  Model result;
  Eigen::AlignedBox3d box;
  std::map<std::string, int> index;
  std::set<std::string> edges;
  const VisibleRegions regions(document->source()->model());
  for (const DocumentSurface& surface : document->surfaces()) {
    index[surface.id] = static_cast<int>(result.surfaces.size());
    result.surfaces.push_back({surface.surface, regions.of(surface.id).value()});
    for (const TrimEdge& edge : result.surfaces.back().region.edges) {
      edges.insert(edge.id);
      for (const Point& p : edge.points) box.extend(p);
    }
  }
  for (const std::string& id : edges) {
    const auto course = SharedEdge::create(*document->model(), id);
    EXPECT_TRUE(course) << id;
    FitEdge edge{.course = std::make_shared<const SharedEdge>(*course), .surfaces = {}};
    for (const std::string& surface : course->surfaces())
      edge.surfaces.push_back(index.at(surface));
    result.edges.push_back(std::move(edge));
  }
  result.size = box.diagonal().norm();
  return result;
}

/// Visible points of a surface, by chance.
std::vector<std::array<double, 2>> visible_points(const FitSurface& s, int count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  const auto extent = s.region.extent();
  std::vector<std::array<double, 2>> result;
  for (int tried = 0; tried < 50 * count && static_cast<int>(result.size()) < count; ++tried) {
    const Eigen::Vector2d f(std::lerp(extent[0].x(), extent[1].x(), share(random)),
                            std::lerp(extent[0].y(), extent[1].y(), share(random)));
    if (s.region.contains(f)) result.push_back(parameters_of(*s.surface, f));
  }
  return result;
}

TEST(SurfaceFit, MovesTheSampleAndKeepsItsFacesTogether) {
  const Model model = model_in("bonnet.step");
  ASSERT_GT(model.edges.size(), 10U);
  Eigen::AlignedBox3d box;
  for (const FitSurface& s : model.surfaces) {
    for (const TrimEdge& edge : s.region.edges) {
      for (const Point& p : edge.points) box.extend(p);
    }
  }
  const Map map = [&](const Point& x) {
    const Point y = 2 * (x - box.center()) / model.size;
    return Point(model.size * (bend(0.01)(y) + bulge(0.01)(y)));
  };
  std::vector<Datum> data;
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    for (const auto& place : visible_points(model.surfaces[s], 1000, 1)) {
      const auto x = evaluate_point<2>(*model.surfaces[s].surface, place);
      data.push_back({static_cast<int>(s), place, map(*x)});
    }
  }
  const FitResult result = fit(model, data);
  EXPECT_TRUE(result.above.empty());
  EXPECT_NEAR(result.size, model.size, 1e-9 * model.size);
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    for (const auto& place : visible_points(model.surfaces[s], 500, 2)) {
      const auto x = evaluate_point<2>(*model.surfaces[s].surface, place),
                 y = evaluate_point<2>(result.surfaces[s], place);
      EXPECT_LT((*y - *x - map(*x)).norm(), 5e-5 * model.size);
    }
  }
  for (const FitEdge& edge : model.edges) {
    const auto& samples = edge.course->samples();
    for (std::size_t k = 0; k + 1 < samples.size() && edge.surfaces.size() > 1; ++k) {
      const auto sample =
          edge.course->at(std::lerp(samples[k].parameter, samples[k + 1].parameter, 0.37));
      std::vector<Point> before, after;
      for (std::size_t j = 0; j < edge.surfaces.size(); ++j) {
        const auto s = static_cast<std::size_t>(edge.surfaces[j]);
        const auto place = parameters_at_foot(*model.surfaces[s].surface, sample.feet[j]);
        before.push_back(*evaluate_point<2>(*model.surfaces[s].surface, place));
        after.push_back(*evaluate_point<2>(result.surfaces[s], place));
      }
      for (std::size_t j = 1; j < after.size(); ++j) {
        EXPECT_LT((after[j] - after[0]).norm(), (before[j] - before[0]).norm() + 1e-6 * model.size)
            << edge.course->id();
      }
    }
  }
}

}  // namespace
}  // namespace knead::morph::testing
