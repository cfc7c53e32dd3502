#include "oracle/pressed_edges.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "brep/shared_edge.hpp"
#include "knead/brep/face_edges.hpp"
#include "knead/exchange/format.hpp"
#include "knead/session/command_json.hpp"
#include "knead/spline/evaluate.hpp"
#include "oracle/occt_gaps.hpp"
#include "session/session_state.hpp"

namespace knead::oracle {
namespace {

constexpr double closed = 1e-3;  // mm: an edge that is no farther from its faces counts as closed
constexpr double resolution = 1e-9;               // mm: to which distances are measured
constexpr double smooth = 0.02, accepted = 0.05;  // degrees

constexpr const char* names[] = {"press", "groove", "grab"};

std::string quoted(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& s : list) text += (text.empty() ? "\"" : ",\"") + s + "\"";
  return text;
}

std::string vector(const Point& p) {
  return fmt::format("[{:.17g},{:.17g},{:.17g}]", p.x(), p.y(), p.z());
}

void write_row(const std::string& row) {
  std::cout << row << "\n";
  if (const char* path = std::getenv("KNEAD_FOLLOW_TABLE"))
    std::ofstream(path, std::ios::app) << row << "\n";
}

/// Records of `before` that are missing in `after`, except those that moved with the edges:
/// surfaces, control points, edges, vertices, curves.
std::vector<std::string> lost_records(const std::string& before, const std::string& after) {
  const auto new_records = records_of(after);
  std::vector<std::string> lost;
  for (const std::string& record : records_of(before)) {
    const auto is = [&](const char* entity) { return record.find(entity) != std::string::npos; };
    if (new_records.contains(record) || is("CARTESIAN_POINT") || is("B_SPLINE_SURFACE") ||
        is("EDGE_CURVE") || is("VERTEX_POINT") || is("SURFACE_CURVE") || is("SEAM_CURVE") ||
        is("INTERSECTION_CURVE")) {
      continue;
    }
    lost.push_back(record);
  }
  return lost;
}

bool is_iges(const fs::path& path) {
  return path.extension() == ".igs" || path.extension() == ".iges";
}

/// Entities of an IGES file whose parameters differ, except those that move with edges: surfaces,
/// curves, vertex lists.
std::vector<std::string> lost_entities(const std::string& before, const std::string& after) {
  const auto entities = [](const std::string& bytes) {
    std::map<std::string, std::string> result;
    std::istringstream lines(bytes);
    for (std::string line; std::getline(lines, line);) {
      if (line.size() > 72 && line[72] == 'P') result[line.substr(64, 8)] += line.substr(0, 64);
    }
    return result;
  };
  const auto now = entities(after);
  std::vector<std::string> lost;
  for (const auto& [number, text] : entities(before)) {
    const std::string type = text.substr(0, text.find_first_not_of("0123456789"));
    constexpr std::array moving = {"128", "100", "106", "110", "126", "502"};
    if (std::ranges::find(moving, type) != moving.end()) continue;
    if (!now.contains(number) || now.at(number) != text) lost.push_back(number + " " + text);
  }
  return lost;
}

/// What an IGES file says of the distances that it tells apart, in its own unit; 0: nothing.
double resolution_of(const Source& source) {
  double result = 0;
  for (const std::string& remark : source.remarks())
    std::sscanf(remark.c_str(), "resolution %lg", &result);
  return result;
}

double to_mm(const brep::Model& file) {
  if (file.units.empty()) {
    const std::string unit = file.surfaces.empty() ? "mm" : file.surfaces.front().unit;
    return unit == "inch" ? 25.4 : unit == "m" ? 1000 : 1;
  }
  return 1000 * file.units.front().metres;
}

/// Whether an edge that Open CASCADE has read is one of those that are pressed.
bool is_pressed(const OcctCrease& crease, const brep::Model& file, const Pair& pair) {
  const double length = (crease.points.front() - crease.points[crease.points.size() / 2]).norm() +
                        (crease.points.back() - crease.points[crease.points.size() / 2]).norm();
  return std::ranges::any_of(pair.edges, [&](const std::string& id) {
    const auto edge = SharedEdge::create(file, id);
    const auto& samples = edge->samples();
    const Point middle =
        to_mm(file) * edge->at(0.5 * (samples.front().parameter + samples.back().parameter)).point;
    return std::ranges::any_of(crease.points,
                               [&](const Point& p) { return (p - middle).norm() < 0.01 * length; });
  });
}

/// The largest angle, in degrees, between tangent planes along the pressed edges that have no angle
/// above `smooth` as opened; −1: there are none.
double bend_at(const OcctFaces& before, const OcctFaces& now, const brep::Model& file,
               const Pair& pair) {
  double result = -1;
  for (const std::string& a : pair.surfaces) {
    for (const std::string& b : pair.surfaces) {
      if (a > b) continue;
      const auto was = before.creases(a, b), is = now.creases(a, b);
      for (std::size_t k = 0; k < std::min(was.size(), is.size()); ++k) {
        if (was[k].angle <= smooth && is_pressed(was[k], file, pair))
          result = std::max(result, is[k].angle);
      }
    }
  }
  return result;
}

}  // namespace

/// All other edges are held.
std::string Pair::script(const brep::Model& file, Motion motion) const {
  std::string text =
      R"({"knead":2,"commands":[{"do":"select","surfaces":[)" + quoted(surfaces) + "]}";
  for (const std::string& edge : edges)
    text += R"(,{"do":"edge","which":")" + edge + R"(","hold":"follow"})";
  const std::string ball = R"(,{"do":"tool","name":"ball","radius":)";
  if (motion == Motion::grab) {
    const auto near = visible_near(file.find_surface(surfaces[0])->surface, {}, place);
    return text +
           fmt::format(
               R"(,{{"do":"brush","kind":"grab","path":[[{:.17g},{:.17g}]],"radius":{:.17g},)"
               R"("by":{}}}]}})",
               near->at.x(), near->at.y(), radius, vector(-depth * normal));
  }
  if (motion == Motion::groove) {
    const double r = radius / 2;
    const Point home = place + r * normal, centre = place + (r - depth) * normal,
                half = 0.4 * radius * across;
    return text +
           fmt::format(
               R"(,{{"do":"material","preset":"clay"}}{}{:.17g},"plasticity":1,"position":{}}},)"
               R"({{"do":"stroke","path":[{},{}]}}]}})",
               ball, r, vector(home), vector(centre - half), vector(centre + half));
  }
  return text +
         fmt::format(R"(,{{"do":"material","alpha":[1,0,1],"beta":[0.003,0.003,0.003]}}{}{:.17g},)"
                     R"("stiffness":1e5,)"
                     R"("position":{}}},{{"do":"evolve","mode":"static"}}]}})",
                     ball, radius, vector(place + (radius - depth) * normal));
}

void move(const fs::path& path, const brep::Model& file, const Pair& pair, Motion motion,
          const fs::path& directory, double least_reached) {
  SCOPED_TRACE(names[static_cast<int>(motion)] + std::string(" ") + quoted(pair.edges) + " of " +
               quoted(pair.surfaces));
  const auto before = OcctFaces::read(path);
  ASSERT_TRUE(before);
  const auto bytes_before = read_file(path);
  ASSERT_TRUE(bytes_before);
  const auto source = *open_source(*bytes_before, file.name);
  const double accepted_gap =
      std::max(closed, is_iges(path) ? resolution_of(*source) * to_mm(file) : 0);
  Session session(Document::from(source));
  const auto commands = parse_script(pair.script(file, motion), "move");
  ASSERT_TRUE(commands) << commands.error().message();
  const std::string what = fmt::format(
      "| {} | {} | {} | {}", path.filename().string(), names[static_cast<int>(motion)],
      pair.edges.size() == 1 ? pair.edges[0] : fmt::format("{} edges", pair.edges.size()),
      fmt::join(pair.surfaces, ", "));
  for (const Command& command : *commands) {
    const auto result = session.execute(command);
    if (result) continue;
    // A motion is refused that would fold a face, or part the faces by more than the tolerance;
    // both are said.
    EXPECT_EQ(result.error().kind, ErrorKind::numerical) << result.error().message();
    EXPECT_EQ(least_reached, 0) << result.error().message();
    write_row(fmt::format("{} | refused: {} | | | | |", what, result.error().what));
    return;
  }
  const auto bytes = session.save();
  ASSERT_TRUE(bytes) << bytes.error().message();
  const auto written = directory / path.filename();
  ASSERT_TRUE(write_file_atomically(written, *bytes));
  const auto after = OcctFaces::read(written);
  ASSERT_TRUE(after);
  EXPECT_EQ(before->topology(), after->topology());
  EXPECT_LE(after->bad_faces(), before->bad_faces());
  EXPECT_LE(after->bad_edges(), before->bad_edges());
  const auto lost =
      is_iges(path) ? lost_entities(*bytes_before, *bytes) : lost_records(*bytes_before, *bytes);
  for (const std::string& record : lost) ADD_FAILURE() << record << " is lost";
  double gap_before = 0, gap = 0, tolerance = 0, tolerance_before = 0;
  for (const std::string& surface : pair.surfaces) {
    const auto old_edges = before->edges(surface, *before),
               new_edges = after->edges(surface, *after);
    ASSERT_EQ(old_edges.size(), new_edges.size());
    for (std::size_t k = 0; k < new_edges.size(); ++k) {
      EXPECT_LE(new_edges[k].gap,
                std::max({accepted_gap, old_edges[k].tolerance, old_edges[k].gap}) + resolution)
          << "edge " << k;
      EXPECT_LE(new_edges[k].ends,
                std::max({accepted_gap, old_edges[k].tolerance, old_edges[k].ends}) + resolution)
          << "edge " << k;
      gap_before = std::max(gap_before, old_edges[k].gap);
      gap = std::max(gap, new_edges[k].gap);
      tolerance_before = std::max(tolerance_before, old_edges[k].tolerance);
      tolerance = std::max(tolerance, new_edges[k].tolerance);
    }
    EXPECT_FALSE(before->moved(surface, *after).folded);
  }
  const double bend_before = bend_at(*before, *before, file, pair),
               bend = bend_at(*before, *after, file, pair);
  if (bend_before >= 0) {
    EXPECT_LE(bend, std::max(accepted, 2 * bend_before)) << "degrees across a smooth edge";
  }
  // How far the place that is pressed went, by the surfaces that have it.
  double reached = std::numeric_limits<double>::infinity();
  for (const SceneSurface& s : session.state().surfaces) {
    if (std::ranges::find(pair.surfaces, s.id) == pair.surfaces.end()) continue;
    const auto near = visible_near(*s.opened, {}, pair.place);
    ASSERT_TRUE(near);
    if ((near->place - pair.place).norm() > 0.01 * pair.radius)
      continue;  // it is on another face of the chain
    const auto now = evaluate_point<2>(*s.current, parameters_of(*s.current, near->at));
    ASSERT_TRUE(now);
    reached = std::min(reached, (*now - near->place).norm() / pair.depth);
  }
  EXPECT_GE(reached, least_reached) << "of the depth that was asked for";
  const std::string bends =
      bend_before < 0 ? "sharp | |"
                      : fmt::format("{:.2g} | {:.2g} |", std::max(0.0, bend_before), bend);
  write_row(fmt::format("{} | {:.0f} % | {:.2g} | {:.2g} | {:.2g} | {:.2g} | {}", what,
                        100 * reached, gap_before, gap, tolerance_before, tolerance, bends));
}

}  // namespace knead::oracle
