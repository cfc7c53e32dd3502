// Where the surfaces of an assembly stand, and what is theirs there.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "knead/base/printable.hpp"
#include "moving_model.hpp"

namespace knead::detail {
namespace {

/// The paths of a part's places; those that are equal are counted from the second on: "a/bolt",
/// "a/bolt:2".
std::vector<std::string> names_of(const brep::Part& part) {
  std::vector<std::string> names;
  std::map<std::string, int> known;
  for (const brep::PartPlace& place : part.places) {
    const int count = ++known[place.path];
    names.push_back(count == 1 ? place.path : fmt::format("{}:{}", place.path, count));
  }
  return names;
}

/// Where the surface stands: where its part does, of several places the one that is asked for.
SurfacePlace place_of(const brep::Part& part, const std::vector<std::string>& asked) {
  SurfacePlace result{part.places.front().to_model, part.name, {}};
  if (part.places.size() == 1) return result;
  result.others = names_of(part);
  for (std::size_t k = 0; k < part.places.size(); ++k) {
    if (std::ranges::find(asked, result.others[k]) != asked.end())
      return {part.places[k].to_model, part.name, {}};
  }
  return result;
}

/// What a surface keeps in its part, of its image in the model.
morph::SurfaceHolds moved_by(const Eigen::Affine3d& move, morph::SurfaceHolds holds) {
  holds.conditions =
      [move, own = std::move(holds.conditions)](const Surface& net) -> Expected<ConstraintList> {
    const auto in_part = image_of(net, move.inverse());
    if (!in_part) return std::unexpected(in_part.error());
    auto list = own(*in_part);
    if (!list) return list;
    for (LinearConstraint& condition : list->constraints) {
      if (condition.normal) *condition.normal = move.linear() * *condition.normal;
    }
    return list;
  };
  return holds;
}

/// A surface with its edges as they stand in the model.
Expected<morph::FitSurface> moved_by(const Eigen::Affine3d& move, morph::FitSurface surface) {
  auto moved = image_of(*surface.surface, move);
  if (!moved) return std::unexpected(moved.error());
  surface.surface = std::make_shared<const Surface>(*std::move(moved));
  if (surface.holds) {
    surface.holds = std::make_shared<const morph::SurfaceHolds>(moved_by(move, *surface.holds));
  }
  for (TrimEdge& edge : surface.region.edges) {
    for (Point& p : edge.points) p = move * p;
  }
  return surface;
}

}  // namespace

Expected<void> add_places(const MorphSettings& settings, MovingModel& result) {
  result.places.resize(result.surfaces.size());
  const auto& assembly = result.model->assembly;
  if (assembly) {
    for (const std::string& path : settings.places) {
      const bool known = std::ranges::any_of(assembly->parts, [&](const brep::Part& part) {
        const auto names = names_of(part);
        return std::ranges::find(names, path) != names.end();
      });
      if (!known)
        return input_error("no part stands at \"" + printable(path, 60) + "\"", "place",
                           "`knead info FILE` lists the places");
    }
  }
  result.placed = result.surfaces;
  for (std::size_t k = 0; assembly && k < result.surfaces.size(); ++k) {
    const brep::Part* part = assembly->part_of(result.source->surfaces()[k].id);
    if (part == nullptr || part->places.empty()) continue;
    result.places[k] = place_of(*part, settings.places);
    const Eigen::Affine3d& move = result.places[k].to_model;
    if (move.matrix().isIdentity(0)) continue;
    auto placed = moved_by(move, result.surfaces[k]);
    if (!placed) return std::unexpected(placed.error());
    result.placed[k] = *std::move(placed);
  }
  return {};
}

Expected<Surface> image_of(const Surface& surface, const Eigen::Affine3d& map) {
  Points net = surface.control_points();
  for (Eigen::Index row = 0; row < net.rows(); ++row)
    net.row(row) = (map * Point(net.row(row).transpose())).transpose();
  return surface.with_control_points(net);
}

}  // namespace knead::detail
