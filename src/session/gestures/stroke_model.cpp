#include "stroke_model.hpp"
#include "session/acts/selection.hpp"

#include <algorithm>
#include <utility>

namespace knead {

namespace {

/// Stacked rows of all patches, those of patch k as f(k, its rows) makes them.
template <class F>
Points by_patch(const std::vector<SiteValues<2>>& patches, const Points& x, const F& f) {
  Points result(x.rows(), 3);
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const Eigen::Index rows = patches[k].size();
    result.middleRows(first, rows) = f(k, x.middleRows(first, rows));
    first += rows;
  }
  return result;
}

}  // namespace

Points StrokeModel::at_abscissae(const Points& x) const {
  return by_patch(values, x,
                  [&](std::size_t k, const Points& part) { return values[k].values(part); });
}

Points StrokeModel::control_points(const Points& x) const {
  return by_patch(values, x,
                  [&](std::size_t k, const Points& part) { return values[k].coefficients(part); });
}

/// Where coupled surfaces are one, the nearest that they allow: elsewhere, what held points leave.
Points StrokeModel::allowed(const Points& x) const {
  const auto couples = [](const SeamReport& seam) {
    return seam.continuity != SeamContinuity::none;
  };
  const bool coupled = !scene.input.followed.empty() || std::ranges::any_of(scene.seams, couples);
  return coupled ? scene.model.nearest_allowed(x) : scene.model.allowed(x);
}

// The model and the interpolation at Chebyshev abscissae are kept as long as the input is the same:
// a gesture asks for both at every place.
Expected<void> keep_stroke_model(std::optional<StrokeModel>& kept, ModelInput input,
                                 std::span<const OpenStroke::Before> before) {
  if (kept && kept->scene.input == input) return {};
  kept.reset();
  std::vector<SiteValues<2>> values;
  for (const OpenStroke::Before& b : before) {
    auto made = SiteValues<2>::create(*b.current, Sites::chebyshev);
    if (!made) return std::unexpected(made.error());
    values.push_back(std::move(*made));
  }
  auto made = make_model(std::move(input));
  if (!made) return std::unexpected(made.error());
  kept = StrokeModel{std::move(*made), std::move(values), {}};
  Points shapes(kept->scene.model.rows().back(), 3);
  Eigen::Index first = 0;
  for (const OpenStroke::Before& b : before) {
    shapes.middleRows(first, b.current->size()) = b.current->control_points();
    first += b.current->size();
  }
  kept->places = kept->at_abscissae(shapes);
  return {};
}

double StrokeModel::depth_of(std::span<const Tool> tools) const {
  double deepest = 0;
  for (const Tool& tool : tools) {
    if (!tool.collides()) continue;
    const BoundingBox box = tool.shape.bounding_box();
    for (Eigen::Index i = 0; i < places.rows(); ++i) {
      const Point x = places.row(i);
      if ((x.array() < box.lower.array()).any() || (x.array() > box.upper.array()).any()) continue;
      deepest = std::max(deepest, -tool.shape.nearest(x).distance);
    }
  }
  return deepest;
}

Points StrokeModel::after_travels(std::span<const OpenStroke::Before> before, const Points& last,
                                  std::span<const Travel> travels) const {
  if (last.rows() == 0) return {};
  return allowed(by_patch(values, last, [&](std::size_t k, const Points& part) {
    return travelled(*before[k].current, values[k], part, travels);
  }));
}

Points unmasked(const Scene& scene, Points displacement) {
  Eigen::Index first = 0;
  for (const SceneSurface& s : selected_surfaces(scene)) {
    for (std::size_t i = 0; i < s.mask.size(); ++i) {
      displacement.row(first + static_cast<Eigen::Index>(i)) *= 1 - s.mask[i];
    }
    first += s.current->size();
  }
  return displacement;
}

}  // namespace knead
