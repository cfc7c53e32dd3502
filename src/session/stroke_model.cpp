#include <algorithm>

#include "executor.hpp"

namespace knead {

Points StrokeModel::at_abscissae(const Points& x) const {
  Points result(x.rows(), 3);
  Eigen::Index first = 0;
  for (const GrevilleValues<2>& patch : values) {
    result.middleRows(first, patch.size()) = patch.values(x.middleRows(first, patch.size()));
    first += patch.size();
  }
  return result;
}

Points StrokeModel::control_points(const Points& x) const {
  Points result(x.rows(), 3);
  Eigen::Index first = 0;
  for (const GrevilleValues<2>& patch : values) {
    result.middleRows(first, patch.size()) = patch.coefficients(x.middleRows(first, patch.size()));
    first += patch.size();
  }
  return result;
}

/// Where coupled surfaces are one, the nearest that they allow: elsewhere, what held points leave.
Points StrokeModel::allowed(const Points& x) const {
  const auto couples = [](const SeamReport& seam) { return seam.continuity != SeamContinuity::none; };
  const bool coupled = !scene.input.followed.empty() || std::ranges::any_of(scene.seams, couples);
  return coupled ? scene.model.nearest_allowed(x) : scene.model.allowed(x);
}

Expected<void> Executor::keep_stroke_model(ModelInput input, std::span<const OpenStroke::Before> before) {
  if (stroke_cache && stroke_cache->scene.input == input) return {};
  stroke_cache.reset();
  std::vector<GrevilleValues<2>> values;
  for (const OpenStroke::Before& b : before) {
    auto made = GrevilleValues<2>::create(*b.current);
    if (!made) return std::unexpected(made.error());
    values.push_back(std::move(*made));
  }
  auto made = make_model(std::move(input));
  if (!made) return std::unexpected(made.error());
  stroke_cache = StrokeModel{std::move(*made), std::move(values)};
  return {};
}

/// Where the displacement of the last place is expected after these travels.
Points Executor::stroke_guess(std::span<const Travel> travels) const {
  const OpenStroke& stroke = *state.stroke;
  if (stroke.last.rows() == 0) return {};
  Points result(stroke.last.rows(), 3);
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < stroke.before.size(); ++k) {
    const Surface& shape = *stroke.before[k].current;
    result.middleRows(first, shape.size()) =
        travelled(shape, stroke_cache->values[k], stroke.last.middleRows(first, shape.size()), travels);
    first += shape.size();
  }
  return stroke_cache->allowed(result);
}

}  // namespace knead
