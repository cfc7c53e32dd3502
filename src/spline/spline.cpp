#include "knead/spline/spline.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/counts.hpp"

namespace knead {
namespace {

template <int D>
std::array<int, D> net_of(const std::array<KnotVector, D>& knots) {
  std::array<int, D> net;
  for (std::size_t d = 0; d < D; ++d) net[d] = knots[d].count();
  return net;
}

/// "control point 17" on a curve, "control point (3, 4)" on a surface.
template <int D>
std::string name_of(int index, const std::array<int, D>& net) {
  std::string text;
  for (int d = D - 1; d >= 0; --d) {
    const int n = net[static_cast<std::size_t>(d)];
    text.insert(0, std::to_string(index % n) + (text.empty() ? "" : ", "));
    index /= n;
  }
  return D == 1 ? "control point " + text : "control point (" + text + ")";
}

std::string to_use() {
  return fmt::format("use numbers of at most {}; another unit of length may help", largest_number);
}

/// Knots whose differences, and what they are divided by, stay within the range of doubles when
/// they are squared.
template <int D>
Expected<void> check_knots(const std::array<KnotVector, D>& knots) {
  for (const KnotVector& knot_vector : knots) {
    const auto values = knot_vector.knots();
    for (const std::size_t k : {std::size_t{0}, values.size() - 1}) {  // they do not decrease
      if (std::abs(values[k]) > largest_number) {
        return input_error(fmt::format("{} is too large for a knot", values[k]),
                           fmt::format("knot {}", k), to_use());
      }
    }
    if (knot_vector.domain().length() < 1 / largest_number) {
      return input_error(fmt::format("the domain is only {} long", knot_vector.domain().length()),
                         "knots", fmt::format("use at least {}", 1 / largest_number));
    }
  }
  return {};
}

}  // namespace

template <int D>
Expected<Spline<D>> Spline<D>::create(std::array<KnotVector, D> knots, Points control_points,
                                      std::vector<double> weights) {
  const std::array<int, D> net = net_of<D>(knots);
  const std::optional<std::int64_t> asked = product_of(net);
  if (!asked)
    return input_error(fmt::format("a net of {} is too large", fmt::join(net, " x ")), {},
                       "use fewer knots");
  const auto expected = static_cast<Eigen::Index>(*asked);
  if (control_points.rows() != expected) {
    return input_error(fmt::format("{} control points do not fit the knots", control_points.rows()),
                       {}, fmt::format("the knots ask for {}", expected));
  }
  if (auto checked = check_knots<D>(knots); !checked) return std::unexpected(checked.error());
  for (Eigen::Index i = 0; i < expected; ++i) {
    if (!control_points.row(i).allFinite()) {
      return input_error("a coordinate is not a finite number",
                         name_of<D>(static_cast<int>(i), net));
    }
    if (const double largest = control_points.row(i).cwiseAbs().maxCoeff();
        largest > largest_number) {
      return input_error(fmt::format("the coordinate {} is too large", largest),
                         name_of<D>(static_cast<int>(i), net), to_use());
    }
  }
  if (!weights.empty()) {
    if (static_cast<Eigen::Index>(weights.size()) != expected) {
      return input_error(
          fmt::format("{} weights do not fit {} control points", weights.size(), expected));
    }
    double largest = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      largest = std::max(largest, std::abs(weights[i]));
      if (std::isfinite(weights[i]) && std::abs(weights[i]) <= largest_number) continue;
      return input_error(
          fmt::format("the weight {} is {}", weights[i],
                      std::isfinite(weights[i]) ? "too large" : "not a finite number"),
          name_of<D>(static_cast<int>(i), net),
          fmt::format("use weights of at most {}", largest_number));
    }
    if (largest > 0 && largest < 1 / largest_number) {
      return input_error(fmt::format("no weight is larger than {}", largest), "weights",
                         "multiply all of them by one factor: the shape stays the same");
    }
  }
  return Spline(std::move(knots), std::move(control_points), std::move(weights));
}

template <int D>
std::array<int, D> Spline<D>::net() const {
  return net_of<D>(knots_);
}

template <int D>
Expected<Spline<D>> Spline<D>::with_control_points(Points control_points) const {
  return create(knots_, std::move(control_points), weights_);
}

template class Spline<1>;
template class Spline<2>;
template class Spline<3>;

}  // namespace knead
