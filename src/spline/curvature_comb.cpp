#include "curvature_comb.hpp"

#include <Eigen/Geometry>

#include "knead/spline/evaluate.hpp"

namespace knead {
namespace {

/// Parameters of teeth, and which of them are the limit from below.
struct Teeth {
  std::vector<double> at;
  std::vector<bool> ends_span;
};

Teeth teeth_of(const KnotVector& knots, int pieces) {
  Teeth teeth;
  for (const int span : knots.spans()) {
    const double from = knots[span], to = knots[span + 1];
    for (int k = 0; k <= pieces; ++k) {
      teeth.at.push_back(k == pieces ? to : from + (to - from) * k / pieces);
      teeth.ends_span.push_back(k == pieces);
    }
  }
  return teeth;
}

std::vector<double> equally_spaced(const Interval& domain, int count) {
  std::vector<double> result;
  for (int k = 0; k < count; ++k) {
    const double share = count == 1 ? 0.5 : static_cast<double>(k) / (count - 1);
    result.push_back(k == count - 1 && count > 1 ? domain.upper
                                                 : domain.lower + share * domain.length());
  }
  return result;
}

Point curvature_vector(const Point& first, const Point& second) {
  const double squared = first.squaredNorm();
  if (!(squared > 0)) return Point::Zero();
  return (second - second.dot(first) / squared * first) / squared;
}

/// Appends the combs along which the parameter d runs.
Expected<void> append(const Surface& surface, int d, int count, int pieces,
                      std::vector<CurvatureComb>& combs) {
  if (count == 0) return {};
  const Teeth teeth = teeth_of(surface.knots(d), pieces);
  const std::vector<double> across = equally_spaced(surface.knots(1 - d).domain(), count);
  std::array<std::span<const double>, 2> grid;
  grid[static_cast<std::size_t>(d)] = teeth.at;
  grid[static_cast<std::size_t>(1 - d)] = across;
  const auto above = evaluate_grid<2>(surface, grid, 2, Side::right);
  const auto below = evaluate_grid<2>(surface, grid, 2, Side::left);
  if (!above) return std::unexpected(above.error());
  if (!below) return std::unexpected(below.error());
  const std::array<int, 2> first = d == 0 ? std::array{1, 0} : std::array{0, 1};
  const auto size = static_cast<Eigen::Index>(teeth.at.size());
  for (int c = 0; c < count; ++c) {
    CurvatureComb& comb = combs.emplace_back();
    comb.direction = d;
    comb.at = across[static_cast<std::size_t>(c)];
    comb.runs = teeth.at;
    comb.places.resize(size, 3);
    comb.vectors.resize(size, 3);
    for (Eigen::Index k = 0; k < size; ++k) {
      const Evaluation<2>& side = teeth.ends_span[static_cast<std::size_t>(k)] ? *below : *above;
      const Eigen::Index row = d == 0 ? k * count + c : c * size + k;
      comb.places.row(k) = side.points().row(row);
      const Point tangent = side.at(first).row(row),
                  bend = side.at({2 * first[0], 2 * first[1]}).row(row);
      comb.vectors.row(k) = curvature_vector(tangent, bend).transpose();
    }
  }
  return {};
}

}  // namespace

Expected<std::vector<CurvatureComb>> curvature_combs(const Surface& surface,
                                                     const CurvatureCombOptions& options) {
  const auto& [along_u, along_v] = options.curves;
  if (along_u < 0 || along_v < 0 || options.teeth < 1) {
    return std::unexpected(
        Error{ErrorKind::usage,
              "curvature combs need numbers of curves that are not negative, and a piece per span",
              {},
              "ask for 7 curves each way and 6 pieces"});
  }
  std::vector<CurvatureComb> combs;
  for (const int d : {0, 1}) {
    if (auto status = append(surface, d, d == 0 ? along_u : along_v, options.teeth, combs);
        !status) {
      return std::unexpected(status.error());
    }
  }
  return combs;
}

}  // namespace knead
