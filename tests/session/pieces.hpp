#pragma once

#include <fmt/format.h>

#include <Eigen/LU>

#include "sheet.hpp"

namespace knead::testing {

/// A flat quadrilateral: the points of fractions (0, 0), (1, 0), (0, 1) and (1, 1).
struct Quad {
  std::array<Point, 4> corners;
  std::array<int, 2> net = {64, 64};
  int degree = 3;
  std::vector<const char*> held = {};  ///< its edges

  [[nodiscard]] Point at(double s, double t) const {
    return (1 - s) * ((1 - t) * corners[0] + t * corners[2]) +
           s * ((1 - t) * corners[1] + t * corners[3]);
  }
};

/// The sheets as surfaces, selected together, their outer edges held.
inline Session pieces(const std::vector<Quad>& quads, const std::vector<std::string>& more = {}) {
  Session session = fresh();
  std::string ids;
  for (const Quad& q : quads) {
    const KnotVector u = *KnotVector::clamped_uniform(q.degree, q.net[0]),
                     v = *KnotVector::clamped_uniform(q.degree, q.net[1]);
    std::string points;
    for (int i = 0; i < q.net[0]; ++i) {
      for (int j = 0; j < q.net[1]; ++j) {
        const Interval a = u.domain(), b = v.domain();
        const Point p =
            q.at((u.greville(i) - a.lower) / a.length(), (v.greville(j) - b.lower) / b.length());
        points += fmt::format("{}[{:.17g},{:.17g},{:.17g}]", points.empty() ? "" : ",", p.x(),
                              p.y(), p.z());
      }
    }
    run(session, {fmt::format(R"({{"do":"new","degree":[{0},{0}],"net":[{1},{2}],"points":[{3}]}})",
                              q.degree, q.net[0], q.net[1], points)});
    for (const char* edge : q.held)
      run(session, {fmt::format(R"({{"do":"edge","which":"{}"}})", edge)});
    ids += fmt::format(R"({}"{}")", ids.empty() ? "" : ",", session.state().surfaces.back().id);
  }
  run(session, {R"({"do":"select","surfaces":[)" + ids + "]}"});
  run(session, more);
  return session;
}

/// A sheet of 200 × 200 in two halves that meet at x = 100.
inline std::vector<Quad> halves(std::array<int, 2> left = {64, 64},
                                std::array<int, 2> right = {64, 64}, int degree_right = 3) {
  return {{{Point(0, 0, 0), {100, 0, 0}, {0, 200, 0}, {100, 200, 0}}, left, 3, {"u0", "v0", "v1"}},
          {{Point(100, 0, 0), {200, 0, 0}, {100, 200, 0}, {200, 200, 0}},
           right,
           degree_right,
           {"u1", "v0", "v1"}}};
}
/// The right half with its parameters exchanged, so that its normals point to the other side.
inline std::vector<Quad> turned_halves(std::array<int, 2> net) {
  std::vector<Quad> all = halves(net, net);
  std::swap(all[1].corners[1], all[1].corners[2]);
  all[1].held = {"v1", "u0", "u1"};
  return all;
}
/// Three quadrilaterals around the point (100, 100).
inline std::vector<Quad> three() {
  const Point o(100, 100, 0), above(100, 200, 0), left(0, 40, 0), right(200, 40, 0);
  return {{{o, above, left, Point(0, 200, 0)}, {48, 48}, 3, {"u1", "v1"}},
          {{o, right, above, Point(200, 200, 0)}, {48, 48}, 3, {"u1", "v1"}},
          {{o, left, right, Point(100, -80, 0)}, {48, 48}, 3, {"u1", "v1"}}};
}

inline std::vector<const Surface*> shapes_of(const Session& session,
                                             std::shared_ptr<const Surface> SceneSurface::*which) {
  std::vector<const Surface*> all;
  for (const SceneSurface& s : session.state().surfaces) all.push_back((s.*which).get());
  return all;
}

/// The parallelogram that has a point as opened, and its fractions there.
inline std::pair<std::size_t, Fractions> where(const Session& session, double x, double y) {
  for (std::size_t k = 0; k < session.state().surfaces.size(); ++k) {
    const Surface& s = *session.state().surfaces[k].opened;
    const Points& net = s.control_points();
    const Eigen::Vector2d at = net.row(0).head<2>();
    Eigen::Matrix2d sides;
    sides << net.row(net.rows() - s.net()[1]).head<2>().transpose() - at,
        net.row(s.net()[1] - 1).head<2>().transpose() - at;
    const Eigen::Vector2d f = sides.inverse() * (Eigen::Vector2d(x, y) - at);
    if (f.minCoeff() >= -1e-12 && f.maxCoeff() <= 1 + 1e-12) {
      return {k, {std::clamp(f[0], 0., 1.), std::clamp(f[1], 0., 1.)}};
    }
  }
  ADD_FAILURE() << "no sheet has this point";
  return {};
}

}  // namespace knead::testing
