#include "moved_edge.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/parallel_for.hpp"
#include "boundary_curve.hpp"
#include "brep/surfaces/surface_foot.hpp"
#include "fitted_curve.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::brep {
namespace {

// With feet u_k(t) of the edge C(t) on the surfaces, S_k before and S'_k after:
//   C' = (1 − w) (C + mean_k (S'_k − S_k)(u_k)) + w mean_k S'_k(u_k).
// Displacements alone would keep the gap that the file has between curve and surfaces; the mean of
// the surfaces alone would leave the vertices, where other edges expect the old distance.
constexpr double margin = 0.125;            // of the edge, at its ends
constexpr double share_of_tolerance = 0.1;  // for the fit of a curve
constexpr double least_tolerance = 1e-7;    // of the size, as for held edges
// Of the model's size: surfaces that have parted by more leave the edge where it was. Of small
// faces that is much of their own size, and still what a fit of the whole model may leave.
constexpr double open_above = 1e-5;
constexpr double rounding = 1e-11;  // of the size

/// Points of the moved edge.
class Path {
 public:
  Path(const SharedEdge& edge, std::span<const Surface* const> before,
       std::span<const Surface* const> after)
      : edge_(edge), before_(before), after_(after) {}

  [[nodiscard]] Expected<Point> displacement(const SharedEdge::Sample& sample) const {
    Point sum = Point::Zero();
    for (std::size_t k = 0; k < before_.size(); ++k) {
      const auto way = displacement_at(*before_[k], *after_[k], sample.feet[k]);
      if (!way) return way;
      sum += *way;
    }
    return Point(sum / static_cast<double>(before_.size()));
  }
  /// The largest distance between the displacements of two surfaces, at the samples.
  [[nodiscard]] Expected<double> parted() const {
    double largest = 0;
    for (const SharedEdge::Sample& sample : edge_.samples()) {
      Point first = Point::Zero();
      for (std::size_t k = 0; k < before_.size(); ++k) {
        const auto way = displacement_at(*before_[k], *after_[k], sample.feet[k]);
        if (!way) return std::unexpected(way.error());
        if (k == 0) first = *way;
        largest = std::max(largest, (*way - first).norm());
      }
    }
    return largest;
  }
  [[nodiscard]] Expected<Point> at(double t) const {
    const SharedEdge::Sample sample = edge_.at(t);
    const auto way = displacement(sample);
    if (!way) return way;
    Point middle = Point::Zero();
    for (std::size_t k = 0; k < after_.size(); ++k) {
      const auto p = evaluate_point<2>(*after_[k], parameters_at_foot(*after_[k], sample.feet[k]));
      if (!p) return p;
      middle += *p / static_cast<double>(after_.size());
    }
    const double share = inner(t);
    return Point((1 - share) * (sample.point + *way) + share * middle);
  }

 private:
  /// 0 at the ends, where the curve must keep its distance from the vertices, and 1 in between;
  /// twice differentiable.
  [[nodiscard]] double inner(double t) const {
    const double from = edge_.samples().front().parameter, to = edge_.samples().back().parameter;
    const double x = std::min(1.0, std::min(t - from, to - t) / (margin * (to - from)));
    // The quintic with w = w' = w'' = 0 at 0 and 1 − w = w' = w'' = 0 at 1: a cubic fit needs two
    // continuous derivatives of the path to converge quickly.
    return x * x * x * (x * (6 * x - 15) + 10);
  }

  const SharedEdge& edge_;
  std::span<const Surface*const> before_, after_;
};

std::unexpected<Error> not_followed(const SharedEdge& edge) {
  return numerical_error("the moved edge cannot be followed by a spline", edge.id(),
                         "undo the step and press less deep, or on a finer net");
}

/// On the parameters of the curve's record, and in its direction.
Expected<Curve> recorded(const SharedEdge& edge, const Curve& curve) {
  const auto knot_values = curve.knots(0).knots();
  std::vector<double> knots;
  for (const double t : knot_values) knots.push_back(edge.file_parameter(t));
  const Points& net = curve.control_points();
  Points points(net.rows(), 3);
  for (Eigen::Index k = 0; k < net.rows(); ++k)
    points.row(k) = net.row(edge.turned() ? net.rows() - 1 - k : k);
  if (edge.turned()) {
    const double sum = knots.front() + knots.back();
    std::ranges::reverse(knots);
    for (double& t : knots) t = sum - t;
  }
  auto vector = KnotVector::create(3, std::move(knots));
  if (!vector) return std::unexpected(vector.error());
  return Curve::create({*std::move(vector)}, std::move(points));
}

double size_of(std::span<const Surface* const> surfaces) {
  double size = 0;
  for (const Surface* s : surfaces) size = std::max(size, net_diagonal(s->control_points()));
  return size;
}

/// Takes vertices that are all of a loop, such as a whole sphere's pole, along with the surfaces
/// that replace others.
Expected<void> move_loop_vertices(const Model& model, std::span<const Replacement> replacements,
                                  std::map<std::string, Point>& vertices) {
  std::map<Index, const Replacement*> after;  // by the surface
  for (const Replacement& r : replacements) after[model.surface_index(r.id)] = &r;
  for (const Face& face : model.faces) {
    const auto found =
        face.support == none ? after.end() : after.find(model.supports[face.support].spline);
    if (found == after.end()) continue;
    std::optional<SurfaceFoot> feet;
    const Surface& before = model.surfaces[found->first].surface;
    for (const Bound& bound : face.bounds) {
      if (bound.kind != Bound::Kind::vertex || bound.vertex == none) continue;
      const Vertex& vertex = model.vertices[bound.vertex];
      if (!vertex.of_one_use) continue;
      if (vertex.wrong) return std::unexpected(*vertex.wrong);
      if (!feet) {
        auto made = SurfaceFoot::create(before);
        if (!made) return std::unexpected(made.error());
        feet = *std::move(made);
      }
      const auto foot = feet->nearest(vertex.place, std::nullopt, 0).foot.parameters;
      const auto way = displacement_at(before, found->second->surface, foot);
      if (!way) return std::unexpected(way.error());
      if (way->norm() <= rounding * net_diagonal(before.control_points())) continue;
      vertices.try_emplace(vertex.id, vertex.place + *way);
    }
  }
  return {};
}

}  // namespace

Expected<Curve> moved_curve(const SharedEdge& edge, std::span<const Surface* const> before,
                            std::span<const Surface* const> after, double tolerance) {
  const Path path(edge, before, after);
  const Interval range{edge.samples().front().parameter, edge.samples().back().parameter};
  const auto curve =
      fitted_curve([&](double t) { return path.at(t); }, range, edge.corners(), tolerance);
  if (!curve && curve.error().what == not_fitted) return not_followed(edge);
  if (!curve) return curve;
  return recorded(edge, *curve);
}

namespace {

/// One edge that has moved, or not, and where its vertices go then.
struct OneMoved {
  std::optional<MovedEdge> edge;
  std::vector<std::pair<std::string, Point>> ends;
};

// An edge along which surfaces have parted stays where it was, as there is no one place for it.
Expected<OneMoved> one_moved(const Model& model, std::span<const Replacement> replacements,
                             const std::string& id, double whole) {
  OneMoved result;
  const auto edge = SharedEdge::create(model, id);
  if (!edge) return std::unexpected(edge.error());
  std::vector<const Surface*> before, after;
  for (const std::string& surface : edge->surfaces()) {
    before.push_back(&model.find_surface(surface)->surface);
    const auto found = std::ranges::find(replacements, surface, &Replacement::id);
    after.push_back(found == replacements.end() ? before.back() : &found->surface);
  }
  const double size = size_of(before);
  const double tolerance = std::max(edge->uncertainty(), least_tolerance * size);
  const Path path(*edge, before, after);
  const auto parted = path.parted();
  if (!parted) return std::unexpected(parted.error());
  if (*parted > std::max(edge->uncertainty(), open_above * std::max(size, whole))) return result;
  double largest = 0;
  for (const auto& sample : edge->samples()) {
    const auto way = path.displacement(sample);
    if (!way) return std::unexpected(way.error());
    largest = std::max(largest, way->norm());
    const bool first = &sample == &edge->samples().front(),
               last = &sample == &edge->samples().back();
    for (std::size_t v = 0; v < 2; ++v) {
      if (!(v == 0 ? first : last) || way->norm() <= rounding * size) continue;
      result.ends.emplace_back(edge->vertices()[v], edge->vertex_points()[v] + *way);
    }
  }
  if (largest <= rounding * size) return result;
  // A file that allows for more does not make the curve coarser: its distance adds to the gap.
  const double fit = std::min(share_of_tolerance * tolerance, least_tolerance * size);
  auto curve = moved_curve(*edge, before, after, fit);
  if (!curve) return std::unexpected(curve.error());
  result.edge = MovedEdge{id, *std::move(curve)};
  return result;
}

}  // namespace

// The first edge that ends in a vertex decides where it goes: others agree to the tolerance at
// which they are closed.
Expected<MovedEdges> moved_edges(const Model& model, std::span<const Replacement> replacements,
                                 std::span<const std::string> ids) {
  Eigen::AlignedBox3d box;
  for (const Vertex& vertex : model.vertices) {
    if (!vertex.wrong) box.extend(vertex.place);
  }
  const double whole = box.isEmpty() ? 0 : box.diagonal().norm();
  std::vector<std::optional<Expected<OneMoved>>> each(ids.size());
  detail::parallel_for(std::ssize(ids), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
      each[k].emplace(one_moved(model, replacements, ids[k], whole));
  });
  MovedEdges result;
  std::map<std::string, Point> vertices;
  for (auto& one : each) {
    if (!*one) return std::unexpected(one->error());
    for (const auto& [id, place] : (*one)->ends) vertices.try_emplace(id, place);
    if ((*one)->edge) result.edges.push_back(*std::move((*one)->edge));
  }
  if (auto moved = move_loop_vertices(model, replacements, vertices); !moved)
    return std::unexpected(moved.error());
  for (const auto& [id, place] : vertices) result.vertices.push_back({id, place});
  return result;
}

}  // namespace knead::brep
