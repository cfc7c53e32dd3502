#include "faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "cli.hpp"
#include "knead/session/report.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

double in_degrees(double radians) { return radians * 180 / std::numbers::pi; }

void print_visible(const FileVisible& v) {
  const auto& [lower, upper] = v.extent;
  const auto& [from, to] = v.box;
  say("           visible from ({:.6g}, {:.6g}) to ({:.6g}, {:.6g}) of the domain", lower[0],
      lower[1], upper[0], upper[1]);
  say(", its edges from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n", from[0], from[1],
      from[2], to[0], to[1], to[2]);
  if (v.middle) {
    say("           middle [{:.4f}, {:.4f}], {:.6g} from the nearest edge\n", (*v.middle)[0],
        (*v.middle)[1], v.distance);
  }
  for (const FileVisibleEdge& e : v.edges) {
    say("           edge {:<8} ({:.4f}, {:.4f}) to ({:.4f}, {:.4f}), {} {}{}\n", e.id, e.from[0],
        e.from[1], e.to[0], e.to[1], e.faces.size() > 1 ? "faces" : "face",
        fmt::join(e.faces, ", "), e.seam ? ", a seam" : "");
  }
}

}  // namespace

void print_edges(const Session& session) {
  const std::vector<SessionSurface> surfaces = session.surfaces();
  for (const EdgesReport& report : report_edges(session)) {
    const SessionSurface& s = surfaces[static_cast<std::size_t>(report.surface)];
    int held = 0;
    double largest = 0;
    for (const EdgeReport& edge : report.edges) {
      held += edge.held ? 1 : 0;
      if (edge.held) largest = std::max(largest, edge.deviation);
    }
    say("  {}: {} of {} edges held, {} of {} control points free, largest deviation along held "
        "edges {:.2g} {}",
        s.id, held, report.edges.size(), report.free, s.current->size(), largest, s.unit);
    say("; largest edge gap {:.2g} {} (at {} points)\n", report.largest_gap, s.unit,
        report.samples);
  }
  for (const FollowedReport& edge : report_followed(session)) {
    say("  edge {} follows smoothly, with at most {:.2g} degrees between its tangent planes, "
        "{:.2g} as opened\n",
        edge.id, in_degrees(edge.angle), in_degrees(edge.angle_before));
  }
}

void print_faces(const FileInfo& info) {
  for (const FileVisible& v : info.visible) {
    if (!v.reason.empty()) {
      say("  {:<8} its edges cannot be followed: {}\n", v.surface, v.reason);
      continue;
    }
    say("  {:<8} {}{}\n", v.surface, counted(v.edges.size(), "edge", "edges"),
        v.in_shell ? ", in a shell" : "");
    print_visible(v);
  }
  for (const FileOtherSurface& s : info.other_surfaces) {
    std::string spline;
    if (s.spline) {
      const auto& [degree, net] = *s.spline;
      spline = fmt::format("can be converted, degree {} x {}, net {} x {}", degree[0], degree[1],
                           net[0], net[1]);
    } else {
      spline = "cannot be converted: " + s.spline.error().what;
    }
    say("  {:<8} {}, {} {}: {}\n", s.id, s.form, s.faces.size() == 1 ? "face" : "faces",
        fmt::join(s.faces, ", "), spline);
  }
}

}  // namespace knead::cli
