#include "knead/exchange/trim_loops.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "face_loops.hpp"
#include "parameter_region.hpp"
#include "step_data.hpp"
#include "step_faces.hpp"
#include "step_surfaces.hpp"
#include "surface_foot.hpp"

namespace knead {
namespace {

using Eigen::Vector2d;

constexpr double on_surface = 1e-5;   // of the net's diagonal: the foot of a point on the surface is no farther
constexpr double off_surface = 0.02;  // of the extent of the face: edges may be that far from its surface

Expected<std::vector<RegionPart>> region_of(const StepReader& reader, const StepFace& face, EdgeSampler& edges,
                                            const SurfaceFoot& feet, double size) {
  auto loops = edges.loops(face.bounds);
  if (!loops) return std::unexpected(std::move(loops.error()));
  Eigen::AlignedBox3d box;
  for (const Loop& loop : *loops) {
    for (const Point& p : loop) box.extend(p);
  }
  std::vector<std::vector<LoopPoint>> in_chart;
  for (Loop& loop : *loops) {
    if (!face.same_sense) std::reverse(loop.begin(), loop.end());
    auto& points = in_chart.emplace_back();
    std::optional<Vector2d> hint;
    for (const Point& p : loop) {
      const auto found = feet.nearest(p, hint, on_surface * size);
      if (!(found.distance <= off_surface * box.diagonal().norm() + on_surface * size)) {
        return reader.error(face.instance, "its edges do not lie on its surface");
      }
      hint.reset();
      if (!found.foot.free[0] && !found.foot.free[1]) hint = found.foot.parameters;
      points.push_back({found.foot.parameters, found.foot.free});
    }
  }
  auto parts = parameter_region(feet.space(), in_chart);
  if (!parts) return reader.error(face.instance, parts.error().what);
  return parts;
}

// A part, once for every turn that brings some of it into the domain.
void add(const RegionPart& part, const ParameterSpace& space, std::vector<TrimFace>& faces) {
  Vector2d lower = part.outer.front().at, upper = lower;
  for (const auto& p : part.outer) {
    lower = lower.cwiseMin(p.at);
    upper = upper.cwiseMax(p.at);
  }
  std::array<int, 2> from = {0, 0}, to = {0, 0};
  constexpr double near = 1e-6;
  for (int d = 0; d < 2; ++d) {
    if (!(space.periods[std::size_t(d)] > 0)) continue;
    from[std::size_t(d)] = static_cast<int>(std::floor(-upper[d] + near)) + 1;
    to[std::size_t(d)] = static_cast<int>(std::ceil(1 - lower[d] - near)) - 1;
  }
  for (int i = from[0]; i <= to[0]; ++i) {
    for (int j = from[1]; j <= to[1]; ++j) {
      TrimFace& face = faces.emplace_back();
      const auto append = [&](const std::vector<RegionPoint>& polygon) {
        TrimLoop& loop = face.emplace_back();
        for (const auto& p : polygon) loop.push_back(p.at + Vector2d(i, j));
      };
      append(part.outer);
      for (const auto& hole : part.holes) append(hole);
    }
  }
}

}  // namespace

Expected<TrimLoops> trim_loops(const StepFile& file, double chord) {
  if (!(chord >= 1e-6 && chord <= 0.2)) {
    return std::unexpected(Error{ErrorKind::usage, "the tolerance of chords is out of range", {}, "use 1e-6 to 0.2"});
  }
  const StepFile::Data& data = file.data();
  const StepReader reader(data.records);
  TrimLoops result;
  result.surfaces.resize(data.surfaces.size());
  std::unordered_map<std::uint32_t, std::size_t> index;
  for (std::size_t k = 0; k < data.surfaces.size(); ++k) {
    if (data.surfaces[k].trimmed) index.emplace(data.surface_instances[k], k);
  }
  EdgeSampler edges(reader, chord);
  std::unordered_map<std::size_t, Expected<SurfaceFoot>> feet;
  std::vector<bool> failed(data.surfaces.size(), false);
  for (const StepFace& face : read_faces(reader)) {
    const auto found = index.find(face.surface);
    if (found == index.end()) continue;
    const auto k = found->second;
    auto foot = feet.find(k);
    if (foot == feet.end()) foot = feet.emplace(k, SurfaceFoot::create(data.surfaces[k].surface)).first;
    auto parts = foot->second ? region_of(reader, face, edges, *foot->second,
                                          net_diagonal(data.surfaces[k].surface.control_points()))
                              : Expected<std::vector<RegionPart>>(std::unexpected(foot->second.error()));
    if (!parts) {
      failed[k] = true;
      result.skipped.push_back(
          {"#" + std::to_string(reader.file().instance(face.instance).id), std::move(parts.error())});
      continue;
    }
    for (const RegionPart& part : *parts) add(part, foot->second->space(), result.surfaces[k].faces);
  }
  for (std::size_t k = 0; k < result.surfaces.size(); ++k) {
    auto& trim = result.surfaces[k];
    if (failed[k]) trim.faces.clear();
    trim.whole = trim.faces.empty();
  }
  return result;
}

}  // namespace knead
