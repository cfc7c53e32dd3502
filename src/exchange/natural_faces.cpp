#include "natural_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>

#include "brep/boundary_curve.hpp"
#include "knead/exchange/format.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead {
namespace detail {
namespace {

constexpr double same_place = 1e-9;  // of the largest surface's size
constexpr double same_ratio = 1e-9;  // of knots in their domain, and of weights

/// How a side runs along another: 1 the same way, -1 the other way, 0 not at all.
/// Splines on the same knots are equal exactly if their control points are, and no farther apart
/// than these: a test without samples. Knots are compared over the unit interval, weights up to a
/// common factor. Sides that are one curve on different knots stay two edges.
int along(const Curve& a, const Curve& b, double tolerance) {
  const KnotVector &u = a.knots(0), &v = b.knots(0);
  if (u.degree() != v.degree() || u.count() != v.count() || a.rational() != b.rational()) return 0;
  const auto runs = [&](bool back) {
    const auto n = static_cast<std::size_t>(u.count());
    const std::size_t knots = u.knots().size();
    for (std::size_t k = 0; k < knots; ++k) {
      const double x = (u.knots()[k] - u.domain().lower) / u.domain().length();
      const double y = back ? (v.domain().upper - v.knots()[knots - 1 - k]) / v.domain().length()
                            : (v.knots()[k] - v.domain().lower) / v.domain().length();
      if (std::abs(x - y) > same_ratio) return false;
    }
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t j = back ? n - 1 - k : k;
      const auto p = a.control_points().row(static_cast<Eigen::Index>(k));
      if ((p - b.control_points().row(static_cast<Eigen::Index>(j))).norm() > tolerance)
        return false;
      if (!a.rational()) continue;
      const double w = a.weights()[k] / a.weights()[0],
                   other = b.weights()[j] / b.weights()[back ? n - 1 : 0];
      if (std::abs(w - other) > same_ratio * std::abs(w)) return false;
    }
    return true;
  };
  return runs(false) ? 1 : runs(true) ? -1 : 0;
}

/// Whether a side is a point, a pole.
bool is_point(const Curve& side, double tolerance) {
  const Points& points = side.control_points();
  return (points.rowwise() - points.row(0)).rowwise().norm().maxCoeff() <= tolerance;
}

double natural_tolerance(std::span<const Surface* const> surfaces) {
  double size = 0;
  for (const Surface* s : surfaces) size = std::max(size, brep::net_diagonal(s->control_points()));
  return same_place * size;
}

class Builder {
 public:
  explicit Builder(double tolerance) : tolerance_(tolerance) {}

  Expected<void> add(const Surface& surface) {
    NaturalFace face;
    // Counterclockwise: v at its start along u, u at its end along v, and back.
    for (const auto& [direction, end, forward] :
         {std::tuple(1, 0, true), {0, 1, true}, {1, 1, false}, {0, 0, false}}) {
      auto side = brep::boundary_curve(surface, direction, end);
      if (!side) return std::unexpected(std::move(side.error()));
      if (is_point(*side, tolerance_)) continue;
      auto use = edge_of(*std::move(side));
      if (!use) return std::unexpected(std::move(use.error()));
      if (!forward) use->forward = !use->forward;
      face.loop.push_back(*use);
    }
    if (face.loop.empty())
      return input_error("all its sides are points: it has no face", {},
                         "leave it out, or write surfaces without faces");
    for (const auto& use : face.loop)
      users_[use.edge].push_back(static_cast<int>(result_.faces.size()));
    result_.faces.push_back(std::move(face));
    return {};
  }

  NaturalFaces build() {
    std::vector<bool> known(result_.faces.size(), false);
    for (std::size_t k = 0; k < result_.faces.size(); ++k) {
      if (!known[k]) add_shell(static_cast<int>(k), known);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] bool forward(int face, int edge) const {
    const auto& f = result_.faces[static_cast<std::size_t>(face)];
    const auto use = std::ranges::find(f.loop, edge, &NaturalFace::Use::edge);
    return use->forward != f.flipped;
  }

  /// All faces that are connected with one, turned as it is.
  /// Breadth first: a face is turned if it runs along a common edge the same way as the neighbour
  /// that it was reached from. The shell is not closed if an edge has one face, or neighbours
  /// disagree after that.
  void add_shell(int first, std::vector<bool>& known) {
    const int shell = result_.shells();
    bool closed = true;
    std::queue<int> next;
    next.push(first);
    known[static_cast<std::size_t>(first)] = true;
    while (!next.empty()) {
      const int present = next.front();
      next.pop();
      NaturalFace& face = result_.faces[static_cast<std::size_t>(present)];
      face.shell = shell;
      for (const auto& use : face.loop) {
        const auto& users = users_[use.edge];
        closed = closed && users.size() == 2;
        for (const int other : users) {
          if (other == present) continue;
          if (!known[static_cast<std::size_t>(other)]) {
            known[static_cast<std::size_t>(other)] = true;
            result_.faces[static_cast<std::size_t>(other)].flipped =
                forward(other, use.edge) == forward(present, use.edge);
            next.push(other);
          }
          closed = closed && forward(other, use.edge) != forward(present, use.edge);
        }
      }
    }
    result_.closed.push_back(closed);
  }

  /// By cells twice as wide as the tolerance: one that is as near is in this cell or beside it.
  int vertex_of(const Point& p) {
    const double width = tolerance_ > 0 ? 2 * tolerance_ : 1;
    std::array<long long, 3> cell{};
    for (std::size_t c = 0; c < 3; ++c) {
      const double place = std::floor(p[static_cast<Eigen::Index>(c)] / width);
      cell[c] = static_cast<long long>(std::clamp(place, -9e17, 9e17));
    }
    for (long long k = 0; k < 27; ++k) {
      const auto near =
          cells_.find({cell[0] + k % 3 - 1, cell[1] + k / 3 % 3 - 1, cell[2] + k / 9 - 1});
      if (near == cells_.end()) continue;
      for (const int v : near->second) {
        if ((result_.vertices[static_cast<std::size_t>(v)] - p).norm() <= tolerance_) return v;
      }
    }
    result_.vertices.push_back(p);
    cells_[cell].push_back(static_cast<int>(result_.vertices.size()) - 1);
    return static_cast<int>(result_.vertices.size()) - 1;
  }

  Expected<NaturalFace::Use> edge_of(Curve side) {
    const Interval domain = side.knots(0).domain();
    const auto from = evaluate_point<1>(side, {domain.lower}),
               to = evaluate_point<1>(side, {domain.upper});
    if (!from || !to) return std::unexpected(!from ? from.error() : to.error());
    const int first = vertex_of(*from), last = vertex_of(*to);
    auto& alike = by_ends_[{std::min(first, last), std::max(first, last)}];
    for (const int edge : alike) {
      // A third surface at the same place gets an edge of its own: shells of solids have two faces
      // at each.
      if (uses_[static_cast<std::size_t>(edge)] == 2) continue;
      const int way = along(result_.edges[static_cast<std::size_t>(edge)].curve, side, tolerance_);
      if (way == 0) continue;
      ++uses_[static_cast<std::size_t>(edge)];
      return NaturalFace::Use{edge, way > 0};
    }
    result_.edges.push_back({std::move(side), first, last});
    uses_.push_back(1);
    alike.push_back(static_cast<int>(result_.edges.size()) - 1);
    return NaturalFace::Use{alike.back(), true};
  }

  double tolerance_;
  NaturalFaces result_;
  std::vector<int> uses_;                                       // of each edge
  std::map<std::array<long long, 3>, std::vector<int>> cells_;  // vertices
  std::map<std::array<int, 2>, std::vector<int>> by_ends_;      // edges by their vertices
  std::map<int, std::vector<int>> users_;  // faces of each edge; twice where it is a seam
};

}  // namespace

Expected<NaturalFaces> natural_faces(std::span<const Surface* const> surfaces) {
  Builder builder(natural_tolerance(surfaces));
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    if (auto status = builder.add(*surfaces[k]); !status) {
      return std::unexpected(status.error().within("surface " + std::to_string(k)));
    }
  }
  return builder.build();
}

}  // namespace detail

Expected<std::vector<std::size_t>> without_faces(std::span<const NamedSurface> surfaces) {
  std::vector<const Surface*> shapes;
  for (const NamedSurface& s : surfaces) shapes.push_back(&s.surface);
  const double tolerance = detail::natural_tolerance(shapes);
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    bool point = true;
    for (int side = 0; side < 4 && point; ++side) {
      const auto curve = brep::boundary_curve(*shapes[k], side / 2, side % 2);
      if (!curve) return std::unexpected(curve.error());
      point = detail::is_point(*curve, tolerance);
    }
    if (point) result.push_back(k);
  }
  return result;
}

}  // namespace knead
