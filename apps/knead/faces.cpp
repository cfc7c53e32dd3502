#include "faces.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/session/report.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

double in_degrees(double radians) { return radians * 180 / std::numbers::pi; }

void print_region(const brep::SplineSurface& s, const VisibleRegion& region) {
  const auto [lower, upper] = region.extent();
  say("           visible from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) of the domain", lower.x(), lower.y(), upper.x(),
      upper.y());
  Eigen::AlignedBox3d box;
  for (const TrimEdge& edge : region.edges) {
    for (const Point& p : edge.points) box.extend(p);
  }
  say(", its edges from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n", box.min().x(), box.min().y(),
      box.min().z(), box.max().x(), box.max().y(), box.max().z());
  if (const auto middle = visible_middle(s.surface, region)) {
    say("           middle [{:.4f}, {:.4f}], {:.6g} from the nearest edge\n", middle->at.x(), middle->at.y(),
        middle->distance);
  }
  for (const TrimEdge& edge : region.edges) {
    std::string faces;
    for (const std::string& face : edge.neighbours) faces += (faces.empty() ? "" : ", ") + face;
    const auto &a = edge.course.front(), &b = edge.course.back();
    say("           edge {:<8} ({:.4f}, {:.4f}) to ({:.4f}, {:.4f}), {}{}\n", edge.id, a.x(), a.y(), b.x(), b.y(),
        faces.find(',') == std::string::npos ? "face " : "faces ", faces + (edge.seam ? ", a seam" : ""));
  }
}

}  // namespace

void print_edges(const SessionState& state) {
  for (const auto& [index, report] : report_edges(state)) {
    const SceneSurface& s = state.surfaces[static_cast<std::size_t>(index)];
    int held = 0;
    double largest = 0;
    for (const TrimReport::Edge& edge : report.edges) {
      held += edge.held.order >= 0 ? 1 : 0;
      if (edge.held.order >= 0) largest = std::max(largest, edge.deviation);
    }
    say("  {}: {} of {} edges held, {} of {} control points free, largest deviation along held edges {:.2g} {}", s.id,
        held, report.edges.size(), report.free, s.current->size(), largest, s.unit);
    say("; largest edge gap {:.2g} {} (at {} points)\n", report.largest, s.unit, report.samples);
  }
  for (const FollowedEdge& edge : state.followed) {
    const auto angles = angles_at(state, edge.id);
    if (!angles) continue;
    say("  edge {} follows smoothly, with at most {:.2g} degrees between its tangent planes, {:.2g} as opened\n",
        edge.id, in_degrees(angles->angle), in_degrees(angles->angle_before));
  }
}

std::string edges_json(const SessionState& state) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& [index, report] : report_edges(state)) {
    nlohmann::ordered_json edges = nlohmann::ordered_json::array();
    for (const TrimReport::Edge& edge : report.edges) {
      edges.push_back({{"id", edge.held.id},
                       {"hold", hold_of(edge)},
                       {"along_lines", edge.held.along_lines},
                       {"control_points", edge.held.points},
                       {"deviation", edge.deviation},
                       {"faces", edge.neighbours}});
      const auto angles = edge.follows ? angles_at(state, edge.held.id) : std::nullopt;
      if (!angles) continue;
      edges.back()["angle"] = in_degrees(angles->angle);
      edges.back()["angle_before"] = in_degrees(angles->angle_before);
    }
    list.push_back({{"surface", state.surfaces[static_cast<std::size_t>(index)].id},
                    {"net", report.net},
                    {"free", report.free},
                    {"visible", report.visible},
                    {"largest_gap", report.largest},
                    {"samples", report.samples},
                    {"edges", std::move(edges)}});
  }
  return list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print_faces(const std::shared_ptr<const brep::Model>& held) {
  const brep::Model& model = *held;
  const VisibleRegions regions(held);
  for (const brep::SplineSurface& s : model.surfaces) {
    const auto region = regions.of(s.id);
    if (!region) {
      say("  {:<8} its edges cannot be followed: {}\n", s.id, region.error().message());
    } else if (!region->edges.empty()) {
      say("  {:<8} {} edge{}{}\n", s.id, region->edges.size(), region->edges.size() == 1 ? "" : "s",
          region->in_shell ? ", in a shell" : "");
      print_region(s, *region);
    }
  }
  const auto splines = brep::exact_splines(model);
  for (std::size_t k = 0; const brep::OtherSurface& s : brep::other_surfaces(model)) {
    const auto& made = splines[k++];
    const std::string net = made ? fmt::format("can be converted, degree {} x {}, net {} x {}", made->knots(0).degree(),
                                               made->knots(1).degree(), made->net()[0], made->net()[1])
                                 : "cannot be converted: " + made.error().what;
    say("  {:<8} {}, {} {}: {}\n", s.id, s.form, s.faces.size() == 1 ? "face" : "faces", fmt::join(s.faces, ", "), net);
  }
}

}  // namespace knead::cli
