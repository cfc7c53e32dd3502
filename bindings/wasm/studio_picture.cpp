#include "studio_picture.hpp"

#include <algorithm>
#include <cmath>

#include "knead/spline/grid_lines.hpp"

namespace knead::studio {
namespace {

void append(std::vector<float>& to, const Point& p) {
  for (int d = 0; d < 3; ++d) to.push_back(static_cast<float>(p[d]));
}

}  // namespace

Expected<void> Painter::tabulate(const Surface& surface, int detail) {
  if (knots_ && *knots_ == surface.knots() && detail_ == detail) return {};
  knots_.reset();
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots(d);
    const Interval domain = knots.domain();
    GridLines grid = grid_lines(knots, std::max(1, detail));
    std::vector<double>& parameters = grid.parameters;
    auto& fractions = d == 0 ? picture_.fractions_s : picture_.fractions_t;
    fractions.clear();
    (d == 0 ? picture_.lines_u : picture_.lines_v) = std::move(grid.knot_lines);
    for (double u : parameters) fractions.push_back(static_cast<float>((u - domain.lower) / domain.length()));
    picture_.counts[static_cast<std::size_t>(d)] = static_cast<std::uint32_t>(parameters.size());
    auto table = tabulate_basis(knots, parameters, 2);
    if (!table) return std::unexpected(table.error());
    parameters_[static_cast<std::size_t>(d)] = std::move(parameters);
    tables_[static_cast<std::size_t>(d)] = std::move(*table);
  }
  detail_ = detail;
  knots_ = surface.knots();
  return {};
}

Expected<void> Painter::paint(const SessionState& state, int index, const Point& origin, int detail, PictureField field,
                              bool opened) {
  const SceneSurface& surface = state.surfaces[static_cast<std::size_t>(index)];
  const Surface& current = opened ? *surface.opened : *surface.current;
  if (auto done = tabulate(current, detail); !done) return done;
  const bool curved = field == PictureField::mean_curvature || field == PictureField::gaussian_curvature;
  const std::array<const BasisTable*, 2> tables = {&tables_[0], &tables_[1]};
  if (auto done = evaluate_grid<2>(current, tables, curved ? 2 : 1, evaluation_); !done) return done;

  const Points& points = evaluation_.points();
  picture_.positions.clear();
  for (Eigen::Index k = 0; k < points.rows(); ++k) append(picture_.positions, points.row(k).transpose() - origin);
  paint_normals();
  if (auto done = paint_values(state, index, field, opened); !done) return done;

  picture_.net.clear();
  for (Eigen::Index k = 0; k < current.size(); ++k) {
    append(picture_.net, current.control_points().row(k).transpose() - origin);
  }
  return paint_held(surface);
}

Expected<void> Painter::paint_held(const SceneSurface& surface) {
  const HeldInput by = held_input(surface);
  for (const auto& [known, held] : held_) {  // kept curves take their time
    if (!(known == by)) continue;
    picture_.held = held;
    return {};
  }
  auto held = held_points(by);
  if (!held) return std::unexpected(held.error());
  picture_.held = std::move(*held);
  constexpr std::size_t most_kept = 64;
  if (held_.size() == most_kept) held_.erase(held_.begin());
  held_.emplace_back(by, picture_.held);
  return {};
}

Expected<void> Painter::paint_energy(const SessionState& state, int index) {
  const SceneSurface& surface = state.surfaces[static_cast<std::size_t>(index)];
  // Its units change when the rest shape is set anew, or the selection.
  const EnergyScalingInput by = energy_scaling_input(state, index);
  auto known = std::ranges::find(scalings_, by, &std::pair<EnergyScalingInput, DomainScaling<2>>::first);
  if (known == scalings_.end()) {
    const auto scaling = energy_scaling(by);
    if (!scaling) {  // a surface without area has no energy
      picture_.values.assign(picture_.positions.size() / 3, 0);
      return {};
    }
    constexpr std::size_t most_kept = 64;
    if (scalings_.size() == most_kept) scalings_.erase(scalings_.begin());
    scalings_.emplace_back(by, *scaling);
    known = scalings_.end() - 1;
  }
  const auto density =
      energy_density(surface, known->second, {parameters_[0], parameters_[1]}, {&tables_[0], &tables_[1]});
  if (!density) return std::unexpected(density.error());
  picture_.values.assign(density->begin(), density->end());
  return {};
}

void Painter::paint_normals() {
  const Points &u = evaluation_.at({1, 0}), &v = evaluation_.at({0, 1});
  const auto rows = static_cast<int>(picture_.counts[0]), columns = static_cast<int>(picture_.counts[1]);
  const auto normal_at = [&](int k, int l, Point& normal) {
    const Point a = u.row(k * columns + l), b = v.row(k * columns + l);
    normal = a.cross(b);
    const double length = normal.norm();
    if (!(length > 1e-9 * (a.squaredNorm() + b.squaredNorm()))) return false;
    normal /= length;
    return true;
  };
  picture_.normals.clear();
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < columns; ++l) {
      Point normal;
      // At a pole the derivatives vanish or are parallel: the next point inside has the limit, up to a pixel.
      if (!normal_at(k, l, normal)) {
        const int inner_k = std::clamp(k, 1, std::max(1, rows - 2)),
                  inner_l = std::clamp(l, 1, std::max(1, columns - 2));
        if (!normal_at(inner_k, l, normal) && !normal_at(k, inner_l, normal) && !normal_at(inner_k, inner_l, normal)) {
          normal = Point::UnitZ();
        }
      }
      append(picture_.normals, normal);
    }
  }
}

Expected<void> Painter::evaluate_opened(const Surface& opened) {
  if (*knots_ == opened.knots()) return evaluate_grid<2>(opened, {&tables_[0], &tables_[1]}, 0, opened_);
  // Its knots were edited: its own basis at the same parameters.
  std::array<BasisTable, 2> tables;
  for (std::size_t d = 0; d < 2; ++d) {
    auto table = tabulate_basis(opened.knots()[d], parameters_[d], 0);
    if (!table) return std::unexpected(table.error());
    tables[d] = std::move(*table);
  }
  return evaluate_grid<2>(opened, {&tables[0], &tables[1]}, 0, opened_);
}

Expected<void> Painter::paint_values(const SessionState& state, int index, PictureField field, bool opened) {
  const SceneSurface& surface = state.surfaces[static_cast<std::size_t>(index)];
  picture_.values.clear();
  if (field == PictureField::none) return {};
  if (field == PictureField::energy) {
    if (!opened) return paint_energy(state, index);
    picture_.values.assign(picture_.positions.size() / 3, 0);  // as it was opened it was at rest
    return {};
  }
  const Points& points = evaluation_.points();
  const auto normal = [this](Eigen::Index k) {
    const float* n = picture_.normals.data() + 3 * k;
    return Point(n[0], n[1], n[2]);
  };
  if (field == PictureField::deviation) {
    if (auto done = evaluate_opened(*surface.opened); !done) return done;
  }
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    double value = 0;
    if (field == PictureField::deviation) {
      const Point moved = points.row(k) - opened_.points().row(k);
      value = std::copysign(moved.norm(), moved.dot(normal(k)));
    } else if (field == PictureField::gap) {
      value = std::numeric_limits<double>::infinity();
      for (const Tool& tool : state.tools)
        value = std::min(value, tool.shape.nearest(points.row(k).transpose()).distance);
      if (!std::isfinite(value)) value = 0;
    } else {
      // First and second fundamental forms.
      const Point u = evaluation_.at({1, 0}).row(k), v = evaluation_.at({0, 1}).row(k), n = normal(k);
      const double e = u.dot(u), f = u.dot(v), g = v.dot(v);
      const double l = n.dot(evaluation_.at({2, 0}).row(k)), m = n.dot(evaluation_.at({1, 1}).row(k)),
                   o = n.dot(evaluation_.at({0, 2}).row(k));
      const double area = e * g - f * f;
      if (area > 1e-18 * (e + g) * (e + g)) {
        value = field == PictureField::gaussian_curvature ? (l * o - m * m) / area
                                                          : (e * o - 2 * f * m + g * l) / (2 * area);
      }
    }
    picture_.values.push_back(static_cast<float>(value));
  }
  return {};
}

}  // namespace knead::studio
