#include "shared_edge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "boundary_curve.hpp"
#include "brep/surfaces/surface_foot.hpp"
#include "face_loops.hpp"
#include "face_region.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {

using namespace brep;
namespace {

using Eigen::Vector2d;

// 64 intervals at least resolve what nets of usual density do
// along an edge; `at` finds feet between samples from an interpolated start.
constexpr double sampling_chord = 2e-3;  // of the edge in space, between samples
constexpr int least_samples = 64;        // intervals
constexpr double least_speed = 1e-5;     // of a derivative, as a share of the other one
constexpr double least_sine = 1e-9;
constexpr double least_distance = 1e-12;  // of the surface: nearer than by that is rounding
constexpr double on_closing_line = 1e-4;  // fractions of the domain, as for edges along knot lines

/// The B-spline surfaces of the faces at an edge. Errors: a face that cannot follow it.
Expected<std::vector<Index>> surfaces_at(const Model& model, Index edge) {
  std::vector<Index> result;
  const std::string& id = model.edges[edge].id;
  for (const Face& face : model.faces) {
    const auto around = edges_around(face);
    if (std::ranges::find(around, edge) == around.end()) continue;
    if (model.spline_under(face) == nullptr) {
      const auto of_support = [&](const std::string Record::*part) {
        return face.support == none ? std::string() : model.supports[face.support].*part;
      };
      return input_error("the face " + face.id + " would have to follow the edge, but lies on " +
                             model.label_under(face),
                         id, "convert that surface to a B-spline surface, or hold the edge",
                         {ErrorCode::edge_face_not_spline,
                          {{"edge", id},
                           {"face", face.id},
                           {"surface", of_support(&Record::id)},
                           {"form", of_support(&Record::kind)}}});
    }
    const Index surface = model.supports[face.support].spline;
    if (std::ranges::find(result, surface) == result.end()) result.push_back(surface);
  }
  if (result.empty()) return input_error("no face has this edge", id);
  return result;
}

/// The other edges that end in each of two vertices.
std::array<std::vector<std::string>, 2> edges_ending_at(const Model& model, Index edge,
                                                        const std::array<Index, 2>& vertices) {
  std::array<std::vector<std::string>, 2> result;
  for (Index k = 0; k < model.edges.size(); ++k) {
    if (k == edge) continue;
    const Edge& other = model.edges[k];
    for (std::size_t v = 0; v < 2; ++v) {
      if (other.start == vertices[v] || other.end == vertices[v]) result[v].push_back(other.id);
    }
  }
  return result;
}

Point normal_of(const Tangents& tangents) {
  // Near a pole one tangent vanishes and its direction is rounding: no normal is better than a
  // wrong one.
  const double u = tangents.col(0).norm(), v = tangents.col(1).norm();
  const Point n = tangents.col(0).cross(tangents.col(1));
  if (!(std::min(u, v) > least_speed * std::max(u, v) && n.norm() > least_sine * u * v))
    return Point::Zero();
  return n.normalized();
}

/// The foot that was found, or that between its neighbours where it is nearer. A descent may leave
/// a foot for another sheet of a folded surface that is almost as near.
Vector2d nearer(const Surface& surface, const Point& p, const Vector2d& found,
                const Vector2d& between) {
  const auto distance = [&](const Vector2d& foot) {
    const auto point = evaluate_point<2>(surface, parameters_at_foot(surface, foot));
    return point ? (*point - p).norm() : std::numeric_limits<double>::infinity();
  };
  const double rest = least_distance * net_diagonal(surface.control_points());
  return distance(between) + rest < distance(found) ? between : found;
}

/// The closed direction along whose closing line all feet lie.
std::optional<int> closed_across(std::span<const Vector2d> feet, const ParameterSpace& space) {
  for (int d = 0; d < 2; ++d) {
    if (space.periods[static_cast<std::size_t>(d)] == 0) continue;
    const bool along = std::ranges::all_of(feet, [d](const Vector2d& foot) {
      return std::abs(foot[d] - std::round(foot[d])) <= on_closing_line;
    });
    if (along) return d;
  }
  return std::nullopt;
}

/// At least `least_samples` intervals, each chord within a small part of the edge's extent.
std::vector<double> sampled(const EdgePiece& piece) {
  const std::vector<double> coarse = piece.curve.subdivided(piece.from, piece.to, {sampling_chord});
  std::vector<double> result = {coarse.front()};
  const double longest = (piece.to - piece.from) / least_samples;
  for (std::size_t k = 1; k < coarse.size(); ++k) {
    const int parts =
        std::max(1, static_cast<int>(std::ceil((coarse[k] - coarse[k - 1]) / longest - 1e-9)));
    for (int j = 1; j <= parts; ++j) {
      result.push_back(j == parts
                           ? coarse[k]
                           : std::lerp(coarse[k - 1], coarse[k], static_cast<double>(j) / parts));
    }
  }
  return result;
}

}  // namespace

struct SharedEdge::Data {
  /// A side of the line along which a closed surface meets itself.
  struct ClosingSide {
    int direction = 0;  ///< in which it is closed
    int end = 0;
  };
  std::string id;
  EdgePiece piece;
  std::vector<std::string> surfaces = {};
  std::vector<Surface> shapes = {};
  std::vector<SurfaceFoot> feet = {};
  std::vector<double> near = {};  // distances within which a foot is right
  std::vector<std::optional<ClosingSide>> sides = {};
  std::array<std::string, 2> vertices = {};
  std::array<std::vector<std::string>, 2> edges_at = {};
  std::vector<double> corners = {};
  std::vector<Sample> samples = {};
  double gap = 0, angle = 0, uncertainty = 0;

  /// Adds a surface, twice if the edge runs along the line where it meets itself.
  void follow(const SplineSurface& s, const SurfaceFoot& search) {
    std::vector<Point> points;
    for (const Sample& sample : samples) points.push_back(sample.point);
    const double within = on_surface * net_diagonal(s.surface.control_points());
    SurfaceFoot::Path path = search.along(points, within);
    for (std::size_t k = 1; k + 1 < points.size(); ++k) {
      const double before = samples[k - 1].parameter, after = samples[k + 1].parameter;
      const double share = (samples[k].parameter - before) / (after - before);
      const Vector2d middle = (1 - share) * path.feet[k - 1] + share * path.feet[k + 1];
      path.feet[k] = nearer(s.surface, points[k], path.feet[k], middle);
    }
    gap = std::max(gap, path.distance);
    const auto closed = closed_across(path.feet, search.space());
    for (int end = 0; end < (closed ? 2 : 1); ++end) {
      surfaces.push_back(s.id);
      shapes.push_back(s.surface);
      feet.push_back(search);
      // A foot between samples may be as far away as those at samples are; twice that is still the
      // right sheet.
      near.push_back(std::max(within, 2 * gap));
      sides.push_back(closed ? std::optional(ClosingSide{*closed, end}) : std::nullopt);
      for (std::size_t k = 0; k < samples.size(); ++k)
        samples[k].feet.push_back(sided(path.feet[k], sides.back()));
    }
  }
  static Vector2d sided(Vector2d foot, const std::optional<ClosingSide>& side) {
    if (side) foot[side->direction] = side->end;
    return foot;
  }
};

Expected<SharedEdge> SharedEdge::create(const Model& model, const std::string& id) {
  const auto found = std::ranges::find(model.edges, id, &Edge::id);
  if (found == model.edges.end()) return input_error("there is no such edge", id);
  const auto edge = static_cast<Index>(found - model.edges.begin());
  const auto surfaces = surfaces_at(model, edge);
  if (!surfaces) return std::unexpected(surfaces.error());
  auto piece = edge_piece(model, edge);
  if (!piece) return std::unexpected(piece.error());
  auto made = std::make_shared<Data>(Data{.id = id, .piece = *std::move(piece)});
  const EdgePiece& stored = made->piece;
  const std::array vertices = stored.backwards ? std::array{stored.end_vertex, stored.start_vertex}
                                               : std::array{stored.start_vertex, stored.end_vertex};
  made->vertices = {model.vertices[vertices[0]].id, model.vertices[vertices[1]].id};
  made->edges_at = edges_ending_at(model, edge, vertices);
  for (const double t : stored.curve.corners()) {
    if (t > stored.from && t < stored.to) made->corners.push_back(t);
  }
  for (const double t : sampled(stored)) made->samples.push_back({t, stored.curve.at(t), {}});
  for (const Index k : *surfaces) {
    const SplineSurface& s = model.surfaces[k];
    auto feet = SurfaceFoot::create(s.surface);
    if (!feet) return std::unexpected(feet.error());
    made->follow(s, *feet);
    made->uncertainty = std::max(made->uncertainty, s.uncertainty);
  }
  for (Sample& s : made->samples) {
    look_across(made->shapes, stored.curve.derivative(s.parameter), s);
    made->angle = std::max(made->angle, s.angle);
  }
  return SharedEdge(std::move(made));
}

SharedEdge::Sample SharedEdge::at(double parameter) const {
  const Data& d = *data_;
  const auto after = std::ranges::lower_bound(d.samples, parameter, {}, &Sample::parameter);
  if (after == d.samples.end()) return d.samples.back();
  if (after == d.samples.begin() || after->parameter == parameter) return *after;
  const Sample& a = *(after - 1);
  const double share = (parameter - a.parameter) / (after->parameter - a.parameter);
  Sample result{parameter, d.piece.curve.at(parameter), {}};
  for (std::size_t k = 0; k < d.feet.size(); ++k) {
    const Vector2d hint = (1 - share) * a.feet[k] + share * after->feet[k];
    const Vector2d found = Data::sided(d.feet[k].beside(result.point, hint, d.near[k]), d.sides[k]);
    result.feet.push_back(nearer(d.shapes[k], result.point, found, hint));
  }
  look_across(d.shapes, d.piece.curve.derivative(parameter), result);
  return result;
}

const std::string& SharedEdge::id() const { return data_->id; }
const std::vector<std::string>& SharedEdge::surfaces() const { return data_->surfaces; }
const std::array<std::string, 2>& SharedEdge::vertices() const { return data_->vertices; }
std::array<Point, 2> SharedEdge::vertex_points() const {
  const EdgePiece& piece = data_->piece;
  return piece.backwards ? std::array{piece.end, piece.start} : std::array{piece.start, piece.end};
}
const std::array<std::vector<std::string>, 2>& SharedEdge::edges_at_vertices() const {
  return data_->edges_at;
}
const std::vector<SharedEdge::Sample>& SharedEdge::samples() const { return data_->samples; }
const std::vector<double>& SharedEdge::corners() const { return data_->corners; }
double SharedEdge::gap() const { return data_->gap; }
double SharedEdge::angle() const { return data_->angle; }
double SharedEdge::uncertainty() const { return data_->uncertainty; }
double SharedEdge::file_parameter(double parameter) const {
  return data_->piece.curve.file_parameter(parameter);
}
bool SharedEdge::turned() const { return data_->piece.curve.turned(); }

std::array<double, 2> parameters_at_foot(const Surface& surface, const Vector2d& foot) {
  Vector2d at = foot;
  constexpr double touch = 1e-6;  // beyond the domain by rounding, not by a turn
  for (int d = 0; d < 2; ++d) {
    if (at[d] < -touch || at[d] > 1 + touch) at[d] -= std::floor(at[d]);
  }
  return parameters_of(surface, at);
}

Expected<Tangents> tangents_at_foot(const Surface& surface, const Vector2d& foot) {
  const auto u = parameters_at_foot(surface, foot);
  Parameters<2> here(1, 2);
  here << u[0], u[1];
  const auto jet = evaluate<2>(surface, here, 1);
  if (!jet) return std::unexpected(jet.error());
  Tangents result;
  result.col(0) = surface.knots(0).domain().length() * jet->at({1, 0}).row(0);
  result.col(1) = surface.knots(1).domain().length() * jet->at({0, 1}).row(0);
  return result;
}

void look_across(std::span<const Surface> surfaces, const Point& along,
                 SharedEdge::Sample& sample) {
  std::vector<Tangents> tangents;
  Point first = Point::Zero(), mean = Point::Zero();
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    const auto at = tangents_at_foot(surfaces[k], sample.feet[k]);
    const Point n = at ? normal_of(*at) : Point(Point::Zero());
    if (n.isZero()) return;
    if (k == 0) first = n;
    sample.angle = std::max(sample.angle, angle_between_planes(first, n));
    // Orientations of parametrisations differ; planes have none.
    mean += first.dot(n) < 0 ? Point(-n) : n;
    tangents.push_back(*at);
  }
  const Point across = mean.cross(along);
  if (!(across.norm() > least_sine * mean.norm() * along.norm())) return;
  for (const Tangents& t : tangents) {
    // The least-squares solution of dS w = c by the metric of the surface. Regular: `normal_of` has
    // found tangents that are neither parallel nor of very different length.
    const Eigen::Matrix2d gramian = t.transpose() * t;
    sample.across.push_back(gramian.inverse() * (t.transpose() * across.normalized()));
  }
}

Expected<Point> normal_at_foot(const Surface& surface, const Vector2d& foot) {
  const auto tangents = tangents_at_foot(surface, foot);
  if (!tangents) return std::unexpected(tangents.error());
  return normal_of(*tangents);
}

double angle_between_planes(const Point& normal, const Point& other) {
  return std::atan2(normal.cross(other).norm(), std::abs(normal.dot(other)));
}

Expected<Point> displacement_at(const Surface& before, const Surface& after, const Vector2d& foot) {
  const auto now = evaluate_point<2>(after, parameters_at_foot(after, foot));
  if (!now) return std::unexpected(now.error());
  const auto then = evaluate_point<2>(before, parameters_at_foot(before, foot));
  if (!then) return std::unexpected(then.error());
  return Point(*now - *then);
}

}  // namespace knead
