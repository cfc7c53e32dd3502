#include "studio_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace knead::studio {
namespace {

/// Of the size of the scene: how far chords may be from a surface as opened. A quarter of a pixel
/// where the scene takes 2000 pixels.
constexpr double chord = 1.25e-4;

std::optional<GridWindow> window_of(const Surface& surface,
                                    const std::optional<PictureWindow>& asked) {
  if (!asked) return {};
  GridWindow window{.tolerance = asked->tolerance};
  for (int d = 0; d < 2; ++d) {
    const Interval domain = surface.knots(d).domain();
    const auto k = static_cast<std::size_t>(d);
    window.lower[k] = domain.lower + asked->lower[k] * domain.length();
    window.upper[k] = domain.lower + asked->upper[k] * domain.length();
  }
  return window;
}

void append(std::vector<float>& to, const Point& p) {
  for (int d = 0; d < 3; ++d) to.push_back(static_cast<float>(p[d]));
}

}  // namespace

Expected<AskedDisplay> asked_display(
    std::string_view name, std::span<const std::pair<std::string, std::vector<double>>> settings) {
  if (name == "none") return AskedDisplay{};
  const auto display = find_display(name);
  if (!display) return std::unexpected(display.error());
  auto values = display_settings(**display, settings);
  if (!values) return std::unexpected(values.error());
  return AskedDisplay{*display, *std::move(values)};
}

Expected<std::array<GridLines, 2>> PictureMaker::lines(const Scene& scene, int index,
                                                       const Surface& drawn, int detail,
                                                       const std::optional<GridWindow>& window) {
  const auto& opened = scene.surfaces[static_cast<std::size_t>(index)].opened;
  const auto known = std::ranges::find_if(lines_, [&](const KeptLines& l) {
    return l.of == opened && l.detail == detail && l.window == window;
  });
  // Another net than that of the surface as opened has another grid.
  if (known != lines_.end() && opened->knots() == drawn.knots()) return known->lines;
  Point lower = Point::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  for (const SceneSurface& s : scene.surfaces) {
    lower = lower.cwiseMin(s.opened->control_points().colwise().minCoeff().transpose());
    upper = upper.cwiseMax(s.opened->control_points().colwise().maxCoeff().transpose());
  }
  const double size = (upper - lower).norm();
  ChordOptions options;
  options.detail = std::max(1, detail);
  options.tolerance = size > 0 ? chord * size * 96 / options.detail : 1;
  options.window = window;
  auto made = grid_lines(opened->knots() == drawn.knots() ? *opened : drawn, options);
  if (made && opened->knots() == drawn.knots()) {
    constexpr std::size_t most_kept = 512;
    if (lines_.size() == most_kept) lines_.clear();
    lines_.push_back({opened, detail, window, *made});
  }
  return made;
}

Expected<void> PictureMaker::tabulate(const Scene& scene, int index, const Surface& surface,
                                      const PictureOptions& options) {
  const int detail = options.detail;
  const auto window = window_of(surface, options.window);
  const auto& opened = scene.surfaces[static_cast<std::size_t>(index)].opened;
  if (knots_ && *knots_ == surface.knots() && detail_ == detail && window_ == window &&
      of_ == opened)
    return {};
  knots_.reset();
  auto grids = lines(scene, index, surface, detail, window);
  if (!grids) return std::unexpected(grids.error());
  of_ = opened;
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots(d);
    const Interval domain = knots.domain();
    GridLines& grid = (*grids)[static_cast<std::size_t>(d)];
    std::vector<double>& parameters = grid.parameters;
    auto& fractions = d == 0 ? picture_.s : picture_.t;
    fractions.clear();
    (d == 0 ? picture_.lines_u : picture_.lines_v) = std::move(grid.knot_lines);
    (d == 0 ? picture_.coarse_u : picture_.coarse_v) = std::move(grid.coarse);
    for (double u : parameters)
      fractions.push_back(static_cast<float>((u - domain.lower) / domain.length()));
    picture_.counts[static_cast<std::size_t>(d)] = static_cast<int>(parameters.size());
    auto table = tabulate_basis(knots, parameters, 2);
    if (!table) return std::unexpected(table.error());
    parameters_[static_cast<std::size_t>(d)] = std::move(parameters);
    tables_[static_cast<std::size_t>(d)] = std::move(*table);
  }
  detail_ = detail;
  window_ = window;
  knots_ = surface.knots();
  return {};
}

Expected<void> PictureMaker::make(const Scene& scene, int index, const PictureOptions& options) {
  const SceneSurface& surface = scene.surfaces[static_cast<std::size_t>(index)];
  const Surface& drawn = options.opened ? *surface.opened : *surface.current;
  if (auto status = tabulate(scene, index, drawn, options); !status) return status;
  const int order = options.display.display ? options.display.display->order : 1;
  if (auto status =
          evaluate_grid<2>(drawn, {&tables_[0], &tables_[1]}, std::max(1, order), evaluation_);
      !status) {
    return status;
  }

  picture_.surface = index;
  picture_.window = options.window;
  const Points& points = evaluation_.points();
  picture_.positions.clear();
  for (Eigen::Index k = 0; k < points.rows(); ++k)
    append(picture_.positions, points.row(k).transpose() - options.origin);
  find_normals();
  if (auto status = find_values(scene, index, options); !status) return status;

  picture_.net.clear();
  for (Eigen::Index k = 0; k < drawn.size(); ++k) {
    append(picture_.net, drawn.control_points().row(k).transpose() - options.origin);
  }
  return find_held(surface);
}

Expected<void> PictureMaker::find_held(const SceneSurface& surface) {
  const HeldInput by = held_input(surface);
  for (const auto& [known, held] : held_) {  // kept curves are slow
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

void PictureMaker::find_normals() {
  const Points &u = evaluation_.at({1, 0}), &v = evaluation_.at({0, 1});
  const auto [rows, columns] = picture_.counts;
  const auto normal_at = [&](int k, int l, Point& normal) {
    const Point a = u.row(k * columns + l), b = v.row(k * columns + l);
    normal = a.cross(b);
    const double length = normal.norm();
    if (!(length > 1e-9 * (a.squaredNorm() + b.squaredNorm()))) return false;
    normal /= length;
    return true;
  };
  normals_.resize(u.rows(), 3);
  picture_.normals.clear();
  for (int k = 0; k < rows; ++k) {
    for (int l = 0; l < columns; ++l) {
      Point normal;
      // At a pole the derivatives vanish or are parallel: the next point inside gives the limit, up
      // to a pixel.
      if (!normal_at(k, l, normal)) {
        const int inner_k = std::clamp(k, 1, std::max(1, rows - 2)),
                  inner_l = std::clamp(l, 1, std::max(1, columns - 2));
        if (!normal_at(inner_k, l, normal) && !normal_at(k, inner_l, normal) &&
            !normal_at(inner_k, inner_l, normal)) {
          normal = Point::UnitZ();
        }
      }
      normals_.row(k * columns + l) = normal.transpose();
      append(picture_.normals, normal);
    }
  }
}

Expected<void> PictureMaker::find_values(const Scene& scene, int index,
                                         const PictureOptions& options) {
  picture_.values.clear();
  const auto& [display, settings] = options.display;
  if (index == 0 || display != display_) range_.clear();
  display_ = display;
  if (!display) return {};
  const DisplayInput input{.scene = scene,
                           .surface = index,
                           .opened = options.opened,
                           .parameters = parameters_,
                           .tables = {&tables_[0], &tables_[1]},
                           .evaluation = evaluation_,
                           .normals = normals_,
                           .settings = settings,
                           .memory = memory_,
                           .visible = options.visible,
                           .around = options.around};
  const auto values = display->values(input);
  if (!values) return std::unexpected(values.error());
  for (const double x : *values)
    picture_.values.push_back(std::isnan(x) ? no_value : static_cast<float>(x));
  range_.add(input, *values);
  return {};
}

}  // namespace knead::studio
