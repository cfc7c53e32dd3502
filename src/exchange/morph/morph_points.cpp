#include "morph_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "exchange/fields/mesh_points.hpp"
#include "knead/base/printable.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using morph::FitSurface;

/// Data and model in different units differ in size by 10 or more; so do data on a small part.
Expected<void> check_size(const std::vector<Point>& points, const AlignedBox3d& model,
                          const MorphSettings& settings, const std::string& unit) {
  constexpr double most = 5;
  AlignedBox3d box;
  for (const Point& p : points) box.extend(p);
  const double data = box.diagonal().norm(), size = model.diagonal().norm();
  if (!settings.unit.empty() || points.size() < 2 || (data <= most * size && size <= most * data))
    return {};
  return input_error(
      fmt::format("the box of the data measures {:.4g} and that of the model {:.4g} {}", data, size,
                  unit == "unknown" ? "" : unit),
      "data",
      fmt::format("say in what unit the data are with --unit, {}",
                  unit == "unknown" ? list_of_length_units() : "also if it is " + unit));
}

/// How many units of the model one of the data is.
Expected<double> unit_factor(const MovingModel& model, const MorphSettings& settings) {
  if (settings.unit.empty()) return 1.0;
  const auto data = millimetres_of(settings.unit);
  if (!data)
    return input_error("there is no unit \"" + settings.unit + "\"", "unit",
                       "use " + list_of_length_units());
  const auto own = millimetres_of(model.unit());
  return own ? *data / *own : 1.0;
}

/// The map of space of the data; a block is put round the nets of all faces.
Expected<fields::SpaceMap> map_of(const MovingModel& model, const MorphData& data) {
  AlignedBox3d box;
  for (std::size_t k = 0; k < model.placed.size(); ++k) {
    if (!model.shown[k]) continue;
    const Points& net = model.placed[k].surface->control_points();
    box.extend(Point(net.colwise().minCoeff().transpose()));
    box.extend(Point(net.colwise().maxCoeff().transpose()));
  }
  if (data.map) return fields::SpaceMap(data.map);
  auto map = fields::SpaceMap::parse(data.space, {box.min(), box.max()});
  if (!map) return std::unexpected(map.error().within("space"));
  return map;
}

/// A grid over what is visible of a surface: feet. \param between the middles of its cells instead
std::vector<Vector2d> grid_on(const FitSurface& surface, bool between) {
  constexpr int least = 24;  // lines per direction
  const auto extent = surface.region.extent();
  std::array<int, 2> lines{};
  for (int d = 0; d < 2; ++d) {
    // More lines in every span than it has functions there, also after raising to degree 3.
    const KnotVector& knots = surface.surface->knots(d);
    const int per_span = std::max(knots.degree(), 3) + 2;
    const auto spans = static_cast<int>(knots.spans().size());
    lines[static_cast<std::size_t>(d)] = std::clamp(per_span * spans, least, 400);
  }
  const int last = between ? 1 : 0;
  const double shift = between ? 1 : 0.5;
  std::vector<Vector2d> result;
  for (int i = 0; i < lines[0] - last; ++i) {
    for (int j = 0; j < lines[1] - last; ++j) {
      const Vector2d part((i + shift) / lines[0], (j + shift) / lines[1]);
      const Vector2d at = extent[0] + part.cwiseProduct(extent[1] - extent[0]);
      if (surface.region.contains(at)) result.push_back(at);
    }
  }
  return result;
}

/// That grid, and the edges between faces that move: feet.
std::vector<Vector2d> places_on(const FitSurface& surface, const std::set<std::string>& moving) {
  constexpr std::size_t along_edges = 33;
  std::vector<Vector2d> result = grid_on(surface, false);
  for (const TrimEdge& edge : surface.region.edges) {
    // Beside a face that stays the edge is held.
    const bool moves = std::ranges::all_of(
        edge.neighbours, [&](const std::string& face) { return moving.contains(face); });
    if (!moves) continue;
    const std::size_t step = std::max<std::size_t>(1, edge.course.size() / along_edges);
    for (std::size_t k = 0; k < edge.course.size(); k += step) result.push_back(edge.course[k]);
  }
  return result;
}

/// The displacement that a map wants at a foot on surface k.
Expected<morph::Datum> mapped_point(const MovingModel& model, std::size_t k, const Vector2d& at,
                                    const fields::SpaceMap& map, const MorphSettings& settings) {
  const Surface& surface = *model.placed[k].surface;
  const auto parameters = parameters_at_foot(surface, at);
  const auto point = evaluate_point<2>(surface, parameters);
  if (!point) return std::unexpected(point.error());
  auto wanted = map.at(*point);
  if (wanted && settings.along_normal)
    wanted = morph::part_along_normal(*wanted, surface, parameters);
  if (!wanted) return std::unexpected(wanted.error());
  return morph::Datum{static_cast<int>(k), parameters, settings.scale * *wanted, 1};
}

// A map is known everywhere: each surface has points of its own, which need no partner. Those of
// surfaces that stay are left out, which are no data.
Expected<morph::Correspondences> mapped_points(const MovingModel& model,
                                               const fields::SpaceMap& map,
                                               const MorphSettings& settings) {
  morph::Correspondences result;
  std::set<std::string> moving;
  for (std::size_t k = 0; k < model.placed.size(); ++k) {
    if (!model.placed[k].fixed) moving.insert(model.faces[k].begin(), model.faces[k].end());
  }
  for (std::size_t k = 0; k < model.placed.size(); ++k) {
    if (!model.shown[k] || model.placed[k].fixed) continue;
    for (const Vector2d& at : places_on(model.placed[k], moving)) {
      auto datum = mapped_point(model, k, at, map, settings);
      if (!datum) return std::unexpected(datum.error());
      result.numbers.push_back(result.data.size());
      result.data.push_back(*datum);
    }
  }
  return result;
}

/// Errors: a part in several places has data, and nobody has said which of them is meant.
Expected<void> check_places(const MovingModel& model, const std::vector<morph::Datum>& data) {
  for (const morph::Datum& datum : data) {
    const SurfacePlace& place = model.places[static_cast<std::size_t>(datum.surface)];
    if (place.others.empty()) continue;
    std::string list;
    for (const std::string& path : place.others) list += (list.empty() ? "" : ", ") + path;
    return input_error(
        fmt::format("the part \"{}\" has data, and stands in {} places", printable(place.part, 60),
                    place.others.size()),
        model.source->surfaces()[static_cast<std::size_t>(datum.surface)].id,
        "say with --place which of them the data are about: " + printable(list, 300));
  }
  return {};
}

}  // namespace

Expected<void> check_settings(const MorphSettings& settings) {
  const auto positive = [](std::optional<double> x) { return !x || (*x > 0 && std::isfinite(*x)); };
  if (!std::isfinite(settings.scale)) return input_error("the scale is not finite", "scale");
  if (!positive(settings.tolerance))
    return input_error("it is no length above 0", "tolerance", "use one of the file's unit");
  if (!positive(settings.reach))
    return input_error("it is no length above 0", "reach", "use one of the file's unit");
  if (!positive(settings.noise))
    return input_error("it is no length above 0", "noise", "use one of the file's unit");
  if (!(settings.refinement >= 1 && settings.refinement <= 1000))
    return input_error("it is not from 1 to 1000", "refinement",
                       "it is a multiple of the control points");
  return {};
}

Expected<fields::Displacements> given_displacements(const MorphData& data,
                                                    const MorphSettings& settings) {
  if (data.vectors) {
    fields::DisplacementColumns which{.field = settings.field};
    if (!settings.columns.empty()) {
      if (settings.columns.size() != which.columns.size())
        return input_error(fmt::format("{} columns are named, not six", settings.columns.size()),
                           "columns", "name those of x, y, z and of the displacement");
      std::ranges::copy(settings.columns, which.columns.begin());
    }
    return fields::read_displacements(data.vectors->bytes, data.vectors->name, which);
  }
  return fields::mesh_pair(data.from->bytes, data.from->name, data.to->bytes, data.to->name);
}

namespace {

/// Errors: no point has a partner, or on a part that stands in several places.
Expected<void> check_partners(const MovingModel& model, const MorphPoints& points,
                              const morph::ScanPartners& first) {
  if (!first.found.data.empty()) return check_places(model, first.found.data);
  return input_error(
      fmt::format("none of {} points of the scan is within {:.4g} of a face: {} are farther, {} "
                  "beside the model, {} face another way",
                  points.count, points.reach, first.found.left_out, first.beyond_border,
                  first.turned_away),
      "data", "is it in the coordinates and the unit of the model? --unit, --align, --reach");
}

/// Reads a scan into the coordinates of the model.
Expected<void> read_scan(const MovingModel& model, const MorphFile& file,
                         const MorphSettings& settings, const morph::VisibleSearch& search,
                         MorphPoints& result) {
  auto mesh = fields::read_mesh_points(file.bytes, file.name);
  if (!mesh) return std::unexpected(std::move(mesh.error()));
  if (mesh->format == "STL") *mesh = fields::joined(*std::move(mesh));
  const auto factor = unit_factor(model, settings);
  if (!factor) return std::unexpected(factor.error());
  for (Point& p : mesh->points) p *= *factor;
  if (auto right = check_size(mesh->points, search.box(), settings, model.unit()); !right)
    return right;
  result.count = mesh->points.size();
  result.scan = morph::scan_of(std::move(mesh->points), std::move(mesh->normals), mesh->triangles);
  if (!settings.align) return {};
  auto alignment = morph::align(*result.scan, search, model.placed, model.shown);
  if (!alignment) return std::unexpected(alignment.error());
  for (Point& p : result.scan->points) p = alignment->motion.at(p);
  for (Point& n : result.scan->normals) n = alignment->motion.rotation * n;
  result.alignment = *alignment;
  return {};
}

morph::ScanSettings scan_settings(const MorphSettings& settings, const MorphPoints& points) {
  return {.reach = points.reach,
          .noise = settings.noise,
          .tolerance = settings.tolerance,
          .refinement = settings.refinement,
          .scale = settings.scale,
          .along_normal = settings.along_normal};
}

}  // namespace

MorphAlignment as_reported(const morph::Alignment& alignment) {
  MorphAlignment result{.angle = alignment.motion.angle(),
                        .rms_before = alignment.rms_before,
                        .rms_after = alignment.rms_after};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    for (std::size_t c = 0; c < 3; ++c)
      result.rotation[k][c] = alignment.motion.rotation(row, static_cast<Eigen::Index>(c));
    result.shift[k] = alignment.motion.shift[row];
  }
  return result;
}

Expected<morph::FitResult> follow_scan(const MovingModel& model, const MorphSettings& settings,
                                       MorphPoints& points, MorphReport& report,
                                       const MorphTold& told) {
  auto with = scan_settings(settings, points);
  with.told = told;
  with.check = [&](const morph::ScanPartners& first) {
    return check_partners(model, points, first);
  };
  auto fit = morph::fit_scan(*points.scan, model.placed, model.edges, model.shown, with);
  if (!fit) return std::unexpected(fit.error());
  points.found = std::move(fit->last.found);
  for (morph::Datum& datum : points.found.data) datum.displacement *= settings.scale;
  MorphScan said{.noise = fit->noise,
                 .noise_estimated = !settings.noise && fit->noise > 0,
                 .turns = fit->turns,
                 .beyond_border = static_cast<int>(fit->last.beyond_border),
                 .turned_away = static_cast<int>(fit->last.turned_away),
                 .outliers = static_cast<int>(fit->last.outliers),
                 .rms_before = fit->first.rms,
                 .rms_after = fit->last.rms};
  if (points.alignment) said.alignment = as_reported(*points.alignment);
  report.scan = said;
  if (!settings.tolerance) report.tolerance = fit->noise;
  return std::move(fit->fit);
}

Expected<std::vector<morph::Datum>> points_between(const MovingModel& model, const MorphData& data,
                                                   const MorphSettings& settings) {
  std::vector<morph::Datum> result;
  if (!data.known_everywhere()) return result;
  const auto map = map_of(model, data);
  if (!map) return std::unexpected(map.error());
  for (std::size_t k = 0; k < model.placed.size(); ++k) {
    if (!model.shown[k] || model.placed[k].fixed) continue;
    for (const Vector2d& at : grid_on(model.placed[k], true)) {
      const auto datum = mapped_point(model, k, at, *map, settings);
      if (!datum) return std::unexpected(datum.error());
      result.push_back(*datum);
    }
  }
  return result;
}

Expected<MorphPoints> points_of(const MovingModel& model, const MorphData& data,
                                const MorphSettings& settings) {
  const int kinds = (data.vectors ? 1 : 0) + (data.from && data.to ? 1 : 0) +
                    (data.known_everywhere() ? 1 : 0) + (data.scan ? 1 : 0);
  if (kinds != 1 || data.from.has_value() != data.to.has_value())
    return input_error(
        "data are displacements, or a mesh before and after, or a scan, or a map of space", "data",
        "give one of them");
  if (settings.align && !data.scan)
    return input_error("only a scan can be aligned", "align", "leave it out");
  if (settings.noise && data.known_everywhere())
    return input_error("a map of space has no noise", "noise", "leave it out");
  const auto search = morph::VisibleSearch::create(model.placed, model.shown);
  if (!search) return std::unexpected(search.error());
  const AlignedBox3d box = search->box();
  MorphPoints result;
  result.size = box.isEmpty() ? 0 : box.diagonal().norm();
  result.reach = settings.reach.value_or(0.01 * result.size);
  if (data.scan) {
    if (auto read = read_scan(model, *data.scan, settings, *search, result); !read)
      return std::unexpected(read.error());
    if (settings.scale != 0) return result;
    auto partners =
        morph::scan_partners(*result.scan, *search, model.placed, scan_settings(settings, result));
    if (!partners) return std::unexpected(partners.error());
    if (auto right = check_partners(model, result, *partners); !right)
      return std::unexpected(right.error());
    result.found = std::move(partners->found);
    result.first = *std::move(partners);
    return result;
  }
  if (data.known_everywhere()) {
    const auto map = map_of(model, data);
    if (!map) return std::unexpected(map.error());
    auto points = mapped_points(model, *map, settings);
    if (!points) return std::unexpected(points.error());
    result.found = *std::move(points);
    result.count = result.found.data.size();
    if (!settings.along_normal) {
      result.map.emplace([map = *map, scale = settings.scale](const Point& x) -> Expected<Point> {
        auto displacement = map.at(x);
        if (displacement) *displacement *= scale;
        return displacement;
      });
    }
  } else {
    auto given = given_displacements(data, settings);
    if (!given) return std::unexpected(given.error());
    const auto factor = unit_factor(model, settings);
    if (!factor) return std::unexpected(factor.error());
    for (Point& p : given->points) p *= *factor;
    for (Point& d : given->vectors) d *= settings.scale * *factor;
    if (auto right = check_size(given->points, box, settings, model.unit()); !right)
      return std::unexpected(right.error());
    auto found = morph::correspond(*search, model.placed, given->points, given->vectors,
                                   {result.reach, settings.along_normal});
    if (!found) return std::unexpected(found.error());
    result.found = *std::move(found);
    result.count = given->points.size();
    result.places = std::move(given->points);
  }
  if (result.found.data.empty()) {
    return input_error(
        fmt::format("none of {} points is within {:.4g} of a face", result.count, result.reach),
        "data", "is it in the coordinates and the unit of the model? --unit, --reach");
  }
  if (auto right = check_places(model, result.found.data); !right)
    return std::unexpected(right.error());
  return result;
}

}  // namespace knead::detail
