// The numbers of a surface.
#include "query.hpp"

namespace knead::studio {
namespace {

struct SurfaceNumbers {
  std::array<int, 2> degree = {0, 0}, net = {0, 0};
  Doubles knots_u, knots_v, weights, points;
};

void describe(SurfaceNumbers& s, Fields& fields) {
  fields.name("surface numbers", "A surface; control point (i, j) is number i net[1] + j.");
  fields.add("degree", s.degree);
  fields.add("net", s.net);
  fields.add("knots_u", s.knots_u);
  fields.add("knots_v", s.knots_v);
  fields.add("weights", s.weights, {.help = "none where all are 1"});
  fields.add("points", s.points, {.help = "three numbers each"});
}

Expected<SurfaceNumbers> surface(Session& session, int number) {
  const auto of = surface_of(session, number);
  if (!of) return std::unexpected(of.error());
  const Surface& s = *(*of)->current;
  const auto numbers = [](std::span<const double> list) {
    return Doubles{{list.begin(), list.end()}};
  };
  return SurfaceNumbers{
      {s.knots(0).degree(), s.knots(1).degree()},
      s.net(),
      numbers(s.knots(0).knots()),
      numbers(s.knots(1).knots()),
      numbers(s.weights()),
      numbers({s.control_points().data(), static_cast<std::size_t>(s.control_points().size())})};
}

Expected<Doubles> control_points(Session& session, int number) {
  const auto of = surface_of(session, number);
  if (!of) return std::unexpected(of.error());
  const Points& points = (*of)->current->control_points();
  return Doubles{{points.data(), points.data() + points.size()}};
}

}  // namespace

std::vector<Query> surface_queries() {
  return {
      query<SurfaceNumbers, surface>(
          "surface", "All numbers of a surface as it is now; each reads back as the same bits."),
      query<Doubles, control_points>("control_points",
                                     "The control points of a surface, three numbers each.")};
}

}  // namespace knead::studio
