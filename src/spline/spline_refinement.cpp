#include "knead/spline/spline_refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

#include "onto_net.hpp"

namespace knead {
namespace {

/// Control points with their weights along one direction, as `Refinement::apply` sees them.
struct Along {
  int outer = 1, inner = 1;
};

template <int D>
Along along(const Spline<D>& spline, int direction) {
  Along result;
  const auto net = spline.net();
  for (int d = 0; d < D; ++d) {
    if (d < direction) result.outer *= net[static_cast<std::size_t>(d)];
    if (d > direction) result.inner *= net[static_cast<std::size_t>(d)];
  }
  return result;
}

}  // namespace

// A rational spline is refined as its homogeneous net (w P, w), which is a polynomial spline. Rows
// that the refinement only copies take P itself: (w P) / w may differ from it in the last bit.
template <int D>
Expected<Spline<D>> refined(const Spline<D>& spline, int direction, const Refinement& refinement) {
  assert(0 <= direction && direction < D);
  if (refinement.from() != spline.knots(direction)) {
    return usage_error("the refinement is for other knots", fmt::format("direction {}", direction));
  }
  auto knots = spline.knots();
  knots[static_cast<std::size_t>(direction)] = refinement.to();
  const auto [outer, inner] = along(spline, direction);
  const int before = refinement.from().count(), after = refinement.to().count();
  Points points(outer * after * inner, 3);
  if (!spline.rational()) {
    refinement.apply(spline.control_points().data(), points.data(), outer, 3 * inner);
    return Spline<D>::create(std::move(knots), std::move(points));
  }

  std::vector<double> weights(static_cast<std::size_t>(points.rows()));
  refinement.apply(spline.weights().data(), weights.data(), outer, inner);
  Points premultiplied = spline.control_points();
  for (Eigen::Index k = 0; k < premultiplied.rows(); ++k) {
    premultiplied.row(k) *= spline.weights()[static_cast<std::size_t>(k)];
  }
  refinement.apply(premultiplied.data(), points.data(), outer, 3 * inner);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const Eigen::Index o = row / (after * inner), i = row / inner % after, c = row % inner;
    if (const int j = refinement.copied(static_cast<int>(i)); j >= 0) {
      points.row(row) = spline.control_points().row((o * before + j) * inner + c);
      continue;
    }
    const double weight = weights[static_cast<std::size_t>(row)];
    if (weight == 0) {
      return numerical_error("a weight comes out zero",
                             fmt::format("direction {}, row {}", direction, i),
                             "use positive weights");
    }
    points.row(row) /= weight;
  }
  return Spline<D>::create(std::move(knots), std::move(points), std::move(weights));
}

template <int D>
Expected<Spline<D>> insert_knots(const Spline<D>& spline,
                                 const std::array<std::vector<double>, D>& inserted) {
  Spline<D> result = spline;
  for (int d = 0; d < D; ++d) {
    const auto& list = inserted[static_cast<std::size_t>(d)];
    if (list.empty()) continue;
    auto knots = with_knots(result.knots(d), list);
    if (!knots) return std::unexpected(knots.error().within(fmt::format("direction {}", d)));
    auto refinement = Refinement::create(result.knots(d), *std::move(knots));
    if (!refinement) return std::unexpected(std::move(refinement.error()));
    auto next = refined(result, d, *refinement);
    if (!next) return next;
    result = *std::move(next);
  }
  return result;
}

// Step by step, as a refinement raises a degree by one at most.
template <int D>
Expected<Spline<D>> elevate_degree(const Spline<D>& spline, int direction, int times) {
  Spline<D> result = spline;
  for (int k = 0; k < times; ++k) {
    auto knots = elevated_knots(result.knots(direction));
    if (!knots)
      return std::unexpected(knots.error().within(fmt::format("direction {}", direction)));
    auto refinement = Refinement::create(result.knots(direction), *std::move(knots));
    if (!refinement) return std::unexpected(std::move(refinement.error()));
    auto next = refined(result, direction, *refinement);
    if (!next) return next;
    result = *std::move(next);
  }
  return result;
}

template <int D>
Expected<Spline<D>> refine_region(const Spline<D>& spline, const std::array<Interval, D>& region) {
  std::array<std::vector<double>, D> midpoints;
  for (int d = 0; d < D; ++d) {
    const auto [lower, upper] = region[static_cast<std::size_t>(d)];
    const auto where = fmt::format("direction {}", d);
    if (!std::isfinite(lower) || !std::isfinite(upper) || lower > upper) {
      return input_error(fmt::format("the region from {} to {} is no interval", lower, upper),
                         where);
    }
    const Interval domain = spline.knots(d).domain();
    if (upper < domain.lower || domain.upper < lower) {
      return input_error(
          fmt::format("the region from {} to {} is outside of the domain", lower, upper), where,
          fmt::format("the domain is [{}, {}]", domain.lower, domain.upper));
    }
    midpoints[static_cast<std::size_t>(d)] = span_midpoints(spline.knots(d), {lower, upper});
  }
  return insert_knots<D>(spline, midpoints);
}

template <int D>
Expected<Spline<D>> bezier_pieces(const Spline<D>& spline) {
  Spline<D> result = spline;
  for (int d = 0; d < D; ++d) {
    auto refinement = Refinement::create(result.knots(d), bezier_knots(result.knots(d)));
    if (!refinement) return std::unexpected(std::move(refinement.error()));
    auto next = refined(result, d, *refinement);
    if (!next) return next;
    result = *std::move(next);
  }
  return result;
}

#define KNEAD_INSTANTIATE(D)                                                                       \
  template Expected<Spline<D>> refined<D>(const Spline<D>&, int, const Refinement&);               \
  template Expected<Spline<D>> insert_knots<D>(const Spline<D>&,                                   \
                                               const std::array<std::vector<double>, D>&);         \
  template Expected<Spline<D>> elevate_degree<D>(const Spline<D>&, int, int);                      \
  template Expected<Spline<D>> refine_region<D>(const Spline<D>&, const std::array<Interval, D>&); \
  template Expected<Spline<D>> bezier_pieces<D>(const Spline<D>&);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

// Knots at the ends of the domain are inserted up to multiplicity p + 1, and all functions beyond
// are dropped: the surface over its domain stays what it is.
Expected<Surface> with_clamped_ends(const Surface& surface) {
  std::array<std::vector<double>, 2> ends;
  for (std::size_t d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots()[d];
    if (knots.clamped()) continue;
    for (const double end : {knots.domain().lower, knots.domain().upper}) {
      ends[d].insert(ends[d].end(),
                     static_cast<std::size_t>(knots.degree() + 1 - knots.multiplicity(end)), end);
    }
  }
  const auto inserted = insert_knots<2>(surface, ends);
  if (!inserted) return std::unexpected(inserted.error());
  // What lies outside of the domain has no support in it.
  std::array<KnotVector, 2> knots = inserted->knots();
  std::array<int, 2> first = {0, 0};
  for (std::size_t d = 0; d < 2; ++d) {
    const auto all = inserted->knots()[d].knots();
    const Interval domain = surface.knots()[d].domain();
    std::vector<double> inside;
    std::ranges::copy_if(all, std::back_inserter(inside),
                         [&](double x) { return domain.contains(x); });
    first[d] = static_cast<int>(std::ranges::lower_bound(all, domain.lower) - all.begin());
    auto made = KnotVector::create(knots[d].degree(), std::move(inside));
    if (!made) return std::unexpected(made.error());
    knots[d] = std::move(*made);
  }
  const int rows = knots[0].count(), columns = knots[1].count();
  Points points(rows * columns, 3);
  std::vector<double> weights;
  for (int i = 0; i < rows; ++i) {
    const int from = (i + first[0]) * inserted->net()[1] + first[1];
    points.middleRows(i * columns, columns) = inserted->control_points().middleRows(from, columns);
    if (!surface.rational()) continue;
    const auto row = inserted->weights().subspan(static_cast<std::size_t>(from),
                                                 static_cast<std::size_t>(columns));
    weights.insert(weights.end(), row.begin(), row.end());
  }
  return Surface::create(std::move(knots), std::move(points), std::move(weights));
}

Expected<Surface> onto_net(Surface shape, const Surface& like) {
  std::array<std::vector<double>, 2> more;
  for (std::size_t d = 0; d < 2; ++d) {
    if (const int times = like.knots()[d].degree() - shape.knots()[d].degree(); times > 0) {
      auto elevated = elevate_degree<2>(shape, static_cast<int>(d), times);
      if (!elevated) return std::unexpected(elevated.error());
      shape = std::move(*elevated);
    }
    std::ranges::set_difference(like.knots()[d].knots(), shape.knots()[d].knots(),
                                std::back_inserter(more[d]));
  }
  return insert_knots<2>(shape, more);
}

}  // namespace knead
