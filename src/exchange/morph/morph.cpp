#include "knead/exchange/morph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "base/interruption.hpp"
#include "data_stretch.hpp"
#include "knead/base/printable.hpp"
#include "knead/brep/edge_measures.hpp"
#include "knead/exchange/format.hpp"
#include "morph_deviation.hpp"
#include "morph_points.hpp"
#include "moving_model.hpp"

namespace knead {
namespace {

using brep::EdgeKind;
using brep::EdgeMeasures;
using detail::MorphPoints;
using detail::MovingModel;

/// Seconds since the last call.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::optional<double> parted(const EdgeMeasures& edge) {
  if (!edge.gap && !edge.off_curve) return std::nullopt;
  return std::max(edge.gap ? edge.gap->value : 0, edge.off_curve ? edge.off_curve->value : 0);
}

std::optional<double> value_of(const std::optional<brep::EdgeFigure>& figure) {
  return figure ? std::optional(figure->value) : std::nullopt;
}

std::array<double, 3> place_of(const EdgeMeasures& edge) {
  if (edge.gap && edge.off_curve)
    return edge.gap->value >= edge.off_curve->value ? edge.gap->at.point : edge.off_curve->at.point;
  return edge.gap ? edge.gap->at.point : edge.off_curve ? edge.off_curve->at.point : edge.middle;
}

/// What would help an edge that comes open.
std::string remedy_at(const MovingModel& model, const EdgeMeasures& edge) {
  std::set<std::string> moving;
  for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
    if (model.surfaces[k].fixed) continue;
    moving.insert(model.faces[k].begin(), model.faces[k].end());
    moving.insert(model.source->surfaces()[k].id);  // called so where no face is on it
  }
  for (const std::string& face : edge.faces) {
    if (!moving.contains(face))
      return fmt::format(
          "face {} stays while the data move what is beside it: let it move, or "
          "--keep its neighbours too",
          face);
  }
  return "allow more control points with --refine, or a --tolerance that is smaller or larger";
}

/// The edge without the number of its part: "#12+#15" of "#12+#15/2".
std::string_view without_part(std::string_view id) { return id.substr(0, id.find('/')); }

/// Refuses a pair of edges that met without being one, if one of them is open now that was not.
Expected<void> check_pairs(const brep::ModelMeasures& before, const brep::ModelMeasures& after) {
  const auto open_in = [](const brep::ModelMeasures& measures) {
    std::set<std::string_view> open;
    for (const EdgeMeasures& edge : measures.edges) {
      if (edge.kind == EdgeKind::open) open.insert(without_part(edge.id));
    }
    return open;
  };
  const auto open_before = open_in(before), open = open_in(after);
  for (const EdgeMeasures& edge : before.edges) {
    const std::string_view pair = without_part(edge.id);
    const std::size_t plus = pair.find('+');
    if (plus == std::string_view::npos) continue;
    for (const std::string_view one : {pair.substr(0, plus), pair.substr(plus + 1)}) {
      if (!open.contains(one) || open_before.contains(one)) continue;
      const auto& at = edge.middle;
      return numerical_error(
          "they would come apart",
          fmt::format("edges {} of faces {} at ({:.6g}, {:.6g}, {:.6g})", edge.id,
                      fmt::join(edge.faces, ", "), at[0], at[1], at[2]),
          "allow more control points with --refine, a larger --tolerance, or --keep its faces");
    }
  }
  return {};
}

/// The largest parting by the fit that the check takes, whatever was parted before; none: that
/// which is wanted, where edges are parted by more than the tolerance, to which 1 % may be added.
std::optional<double> allowed_parting(const brep::ModelMeasures& before) {
  const bool open = std::ranges::any_of(before.edges, [&](const EdgeMeasures& edge) {
    return parted(edge).value_or(0) > before.gap_tolerance / 2;
  });
  return open ? std::nullopt : std::optional(before.gap_tolerance / 2);
}

/// The largest parting of an edge before that counts where it is parted now. Where a part along
/// which edges meet ends, and the next one begins, is known as far as edges meet (docs/check.md):
/// at its end also that of the parts beside it.
double parted_there(const brep::ModelMeasures& before, const EdgeMeasures& was,
                    const EdgeMeasures& now) {
  double result = parted(was).value_or(0);
  const auto at = place_of(now);
  if (was.id.find('+') == std::string::npos || (at != now.start && at != now.end)) return result;
  for (const EdgeMeasures& other : before.edges) {
    if (other.id.find('+') == std::string::npos) continue;
    if (other.start == was.start || other.start == was.end || other.end == was.start ||
        other.end == was.end)
      result = std::max(result, parted(other).value_or(0));
  }
  return result;
}

/// By how much an edge may be parted now: if it was closed by the tolerance, the larger of the
/// file's uncertainty and 1e-6 of the size; else what it was as opened, stretched as the data
/// stretch the model there, and 1 %.
Expected<double> most_parted(const MovingModel& model, const MorphPoints& data,
                             const brep::ModelMeasures& before, const EdgeMeasures& was,
                             const EdgeMeasures& now) {
  const double own = parted(was).value_or(0), most = std::max(1.01 * own, before.gap_tolerance);
  if (parted(now).value_or(0) <= most || own <= before.gap_tolerance) return most;
  std::vector<Point> at;
  for (const auto& place : {was.start, was.middle, was.end, place_of(was)})
    at.emplace_back(place[0], place[1], place[2]);
  const auto stretch = detail::data_stretch(model, data, was.faces, at, before.size);
  if (!stretch) return std::unexpected(stretch.error());
  return 1.01 * *stretch * parted_there(before, was, now);
}

/// Compares the edges of the file that would be written with those of the one that was opened, and
/// refuses what has come open.
Expected<void> check_edges(const MovingModel& model, const MorphPoints& data,
                           const brep::ModelMeasures& before, const brep::ModelMeasures& after,
                           MorphReport& report) {
  if (auto right = check_pairs(before, after); !right) return right;
  std::map<std::string, const EdgeMeasures*> old;
  for (const EdgeMeasures& edge : before.edges) old[edge.id] = &edge;
  for (const EdgeMeasures& edge : after.edges) {
    const auto found = old.find(edge.id);
    if (found == old.end()) continue;
    const EdgeMeasures& was = *found->second;
    const auto gap = parted(edge), gap_before = parted(was);
    const auto most = most_parted(model, data, before, was, edge);
    if (!most) return std::unexpected(most.error());
    const auto at = place_of(edge);
    const std::string where =
        fmt::format("edge {} of faces {} at ({:.6g}, {:.6g}, {:.6g})", edge.id,
                    fmt::join(edge.faces, ", "), at[0], at[1], at[2]);
    if (gap && gap_before && *gap > *most) {
      return numerical_error(
          fmt::format("it would be parted by {:.3g}, more than {:.3g}", *gap, *most), where,
          remedy_at(model, edge));
    }
    if (edge.kind == EdgeKind::unknown && was.kind != EdgeKind::unknown)
      return numerical_error("it could not be followed any more: " + edge.reason, where,
                             "keep its faces with --keep");
    const auto angle = value_of(edge.angle), angle_before = value_of(was.angle);
    const auto bend = value_of(edge.relative_curvature),
               bend_before = value_of(was.relative_curvature);
    if (gap == gap_before && angle == angle_before && bend == bend_before) continue;
    report.edges.push_back({edge.id, std::string(brep::name_of(edge.kind)), gap_before, gap,
                            angle_before, angle, bend_before, bend});
  }
  return {};
}

std::string described(const MorphData& data) {
  if (data.vectors) return "displacements " + data.vectors->name;
  if (data.scan) return "scan " + data.scan->name;
  if (data.from && data.to) return "meshes " + data.from->name + " and " + data.to->name;
  return "map of space " + printable(data.space, 200);
}

void describe_task(const Source& source, const MorphData& data, const MorphSettings& settings,
                   MorphReport& report) {
  report.file = source.name();
  report.format = source.format();
  report.data = described(data);
  report.data_unit = settings.unit;
  report.scale = settings.scale;
  report.refinement = settings.refinement;
  report.along_normal = settings.along_normal;
  report.only = settings.faces;
  report.kept = settings.keep;
  report.places = settings.places;
}

void describe_points(const MorphPoints& points, MorphReport& report) {
  const auto& found = points.found;
  report.points = static_cast<int>(points.count);
  report.used = static_cast<int>(found.data.size());
  report.left_out = static_cast<int>(found.left_out);
  report.reach = points.reach;
  report.size = points.size;
  report.largest_distance = found.largest_distance;
  report.rms_distance = found.rms_distance;
  for (const morph::LeftOutPoint& point : found.listed) {
    MorphLeftOut listed{static_cast<int>(point.number) + 1,
                        {point.place.x(), point.place.y(), point.place.z()},
                        {}};
    if (std::isfinite(point.distance)) listed.distance = point.distance;
    report.listed.push_back(listed);
  }
}

void describe_fit(const MovingModel& model, const morph::FitResult& fit, MorphReport& report) {
  static constexpr const char* measures[] = {"residual", "parting", "angle", "contradiction"};
  report.lambda = fit.lambda;
  report.rounds = fit.rounds;
  report.refinements = fit.refinements;
  for (const morph::FitExcess& excess : fit.above) {
    report.above.push_back({measures[static_cast<std::size_t>(excess.measure)],
                            model.source->surfaces()[static_cast<std::size_t>(excess.surface)].id,
                            excess.edge,
                            {excess.place.x(), excess.place.y(), excess.place.z()},
                            excess.found,
                            excess.wanted,
                            excess.count});
  }
}

/// A surface of the model in the coordinates of its part.
Expected<Surface> in_its_part(Surface surface, const Eigen::Affine3d& to_model) {
  if (to_model.matrix().isIdentity(0)) return surface;
  return detail::image_of(surface, to_model.inverse());
}

/// The edges between surfaces that move. An edge at a surface that stays is where it was.
std::vector<std::string> moving_edges(const MovingModel& model) {
  std::vector<std::string> result;
  for (const morph::FitEdge& edge : model.edges) {
    const bool stays = std::ranges::any_of(
        edge.surfaces, [&](int k) { return model.surfaces[static_cast<std::size_t>(k)].fixed; });
    if (!stays && edge.course) result.push_back(edge.course->id());
  }
  return result;
}

/// The bytes with the surfaces that have moved, and these edges anew.
Expected<std::string> saved(const MovingModel& model, std::vector<Surface> moved,
                            const std::vector<std::string>& edges) {
  std::vector<std::shared_ptr<const Surface>> surfaces;
  for (const SourceSurface& surface : model.written->surfaces()) {
    surfaces.push_back(surface.surface);
    const auto k = model.model->surface_index(surface.id);
    if (k == brep::none || model.surfaces[k].fixed) continue;
    auto own = in_its_part(std::move(moved[k]), model.places[k].to_model);
    if (!own) return std::unexpected(own.error());
    surfaces.back() = std::make_shared<const Surface>(*std::move(own));
  }
  return model.written->save(surfaces, edges);
}

/// Of the data as they are followed: it is scaled with them.
std::optional<double> noise_of(const MorphSettings& settings) {
  if (!settings.noise) return std::nullopt;
  return std::abs(settings.scale) * *settings.noise;
}

/// At every point of space, if it is known there.
std::function<Expected<Point>(const Point&)> displacement_of(const MorphPoints& points) {
  if (!points.map) return {};
  return [map = *points.map](const Point& at) { return map.at(at); };
}

Expected<brep::ModelMeasures> measures_after(const std::string& bytes, const Source& source) {
  const auto opened = open_source(bytes, source.name());
  if (!opened) return std::unexpected(opened.error());
  return brep::measure_edges(*(*opened)->model());
}

/// Tells of phases and their parts, and measures their times.
class Progress {
 public:
  explicit Progress(const MorphTold& told) : told_(told) {}

  /// Another phase begins. \param spent of time by what was before
  Expected<void> next(double& spent) {
    spent = lap();
    return tell(++phase_ * parts);
  }
  /// Seconds since another phase began, or since this was called.
  double lap() { return watch_.lap(); }
  /// So much of the present one is done.
  MorphTold within() {
    return [this](int done, int of) { return tell(phase_ * parts + done * parts / of); };
  }

 private:
  static constexpr int parts = 8;  // as many as a scan has turns

  Expected<void> tell(int done) const {
    if (Interruption::asked_for()) return interrupted_error();
    return told_ ? told_(done, parts * static_cast<int>(morph_phases.size())) : Expected<void>();
  }

  const MorphTold& told_;
  Stopwatch watch_;
  int phase_ = 0;
};

}  // namespace

Expected<MorphedFile> morph_file(const std::shared_ptr<const Source>& source, const MorphData& data,
                                 const MorphSettings& settings, const MorphTold& told) {
  return detail::morph_file(source, data, settings, {}, told);
}

Expected<MorphedFile> detail::morph_file(const std::shared_ptr<const Source>& source,
                                         const MorphData& data, const MorphSettings& settings,
                                         const MorphHolds& holds, const MorphTold& told) {
  if (auto right = detail::check_settings(settings); !right) return std::unexpected(right.error());
  Progress progress(told);
  if (auto on = progress.within()(0, 1); !on) return std::unexpected(on.error());
  MorphedFile result;
  MorphReport& report = result.report;
  describe_task(*source, data, settings, report);
  std::vector<std::shared_ptr<const Surface>> as_opened;
  for (const SourceSurface& s : source->surfaces()) as_opened.push_back(s.surface);
  auto opened = source->save(as_opened);
  if (!opened) return std::unexpected(opened.error());
  report.bytes_before = static_cast<double>(opened->size());
  auto model = detail::moving_model(source, settings, holds);
  if (!model) return std::unexpected(model.error());
  report.unit = model->unit();
  if (auto on = progress.next(report.time_model); !on) return std::unexpected(on.error());
  auto points = detail::points_of(*model, data, settings);
  if (!points) return std::unexpected(points.error());
  describe_points(*points, report);
  report.time_data = progress.lap();
  if (settings.scale == 0) {
    result.bytes = *std::move(opened);
    report.bytes_after = report.bytes_before;
    return result;
  }

  const auto before = brep::measure_edges(*source->model());
  if (!before) return std::unexpected(before.error());
  report.tolerance = settings.tolerance.value_or(1e-5 * points->size);
  if (auto on = progress.next(report.time_check); !on) return std::unexpected(on.error());
  auto fit = points->scan
                 ? detail::follow_scan(*model, settings, *points, report, progress.within())
                 : morph::fit_surfaces(model->placed, model->edges, points->found.data,
                                       {.tolerance = report.tolerance,
                                        .noise = noise_of(settings),
                                        .allowed_parting = allowed_parting(*before),
                                        .displacement = displacement_of(*points),
                                        .refinement = settings.refinement});
  if (!fit) return std::unexpected(fit.error());
  if (points->scan) describe_points(*points, report);
  describe_fit(*model, *fit, report);
  if (auto on = progress.next(report.time_fit); !on) return std::unexpected(on.error());
  const auto between = detail::points_between(*model, data, settings);
  if (!between) return std::unexpected(between.error());
  if (auto added =
          detail::add_deviations(*model, points->found.data, *between, fit->surfaces, result);
      !added)
    return std::unexpected(added.error());
  if (auto on = progress.next(report.time_deviation); !on) return std::unexpected(on.error());
  result.edges = moving_edges(*model);
  auto bytes = saved(*model, std::move(fit->surfaces), result.edges);
  if (!bytes) return std::unexpected(bytes.error());
  result.bytes = *std::move(bytes);
  report.bytes_after = static_cast<double>(result.bytes.size());
  report.converted = std::move(model->converted);
  report.fixed = std::move(model->fixed);
  report.unknown_edges = std::move(model->unknown_edges);
  if (auto on = progress.next(report.time_save); !on) return std::unexpected(on.error());
  const auto after = measures_after(result.bytes, *source);
  if (!after) return std::unexpected(after.error());
  if (auto right = check_edges(*model, *points, *before, *after, report); !right)
    return std::unexpected(right.error());
  report.time_check += progress.lap();
  return result;
}

}  // namespace knead
