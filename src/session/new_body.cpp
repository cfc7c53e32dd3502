#include "new_body.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acts/limits.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/revolution.hpp"
#include "knead/spline/spline_refinement.hpp"
#include "spline/interpolation/site_values.hpp"

namespace knead {
namespace {

constexpr std::size_t directions_of_volume = 3;

std::string_view name_of(BodyForm form) {
  return choices(BodyForm{})[static_cast<std::size_t>(form)].name;
}

Expected<void> check_size(double control_points) {
  if (control_points <= static_cast<double>(max_net_size)) return {};
  return input_error(fmt::format("more than {} control points are asked for", max_net_size), "net",
                     "give a smaller net");
}

/// Knots of all directions. Errors: too many control points in all (input).
template <std::size_t D>
Expected<std::vector<KnotVector>> all_knots(const NewCommand& c) {
  std::vector<KnotVector> knots;
  double size = 1;
  for (std::size_t d = 0; d < D; ++d) {
    size *= std::max(in_direction(c.net, d), 1);
    if (auto fits = check_size(size); !fits) return std::unexpected(fits.error());
    auto made = knots_of(c, d, in_direction(c.net, d), "net");
    if (!made) return std::unexpected(made.error());
    knots.push_back(*std::move(made));
  }
  return knots;
}

/// The place of a control point within the domain: the fraction of its Greville abscissa.
double fraction_of(const KnotVector& knots, int i) {
  const Interval domain = knots.domain();
  return (knots.greville(i) - domain.lower) / domain.length();
}

Expected<Points> given_points(const NewCommand& c, int count) {
  if (static_cast<int>(c.points.size()) != count) {
    return input_error(fmt::format("{} points for a net of {}", c.points.size(), count), "points",
                       fmt::format("give {}, the last direction fastest, or another net", count));
  }
  Points points(count, 3);
  for (int k = 0; k < count; ++k) {
    points.row(k) = Eigen::RowVector3d(c.points[static_cast<std::size_t>(k)].data());
  }
  return points;
}

/// A helix about z from (radius, 0, 0), interpolated at the Greville abscissae, which is noted with
/// its error: no NURBS is one.
Expected<Curve> helix(const NewCommand& c, const KnotVector& knots, double radius,
                      std::vector<std::string>& notes) {
  const double height = c.height.value_or(2 * radius), turns = c.turns.value_or(3);
  if (!std::isfinite(height))
    return input_error(fmt::format("{} is not a height", height), "height", "use a number");
  constexpr double most_turns = 1e4;
  if (!(turns > 0 && turns <= most_turns)) {
    return input_error(fmt::format("{} turns", turns), "turns",
                       "use a number from above 0 to 10000");
  }
  const Interval domain = knots.domain();
  const auto at = [&](double u) {
    const double t = (u - domain.lower) / domain.length(), angle = 2 * std::numbers::pi * turns * t;
    return Point(radius * std::cos(angle), radius * std::sin(angle), height * t);
  };
  auto plain = Curve::create({knots}, Points::Zero(knots.count(), 3));
  if (!plain) return plain;
  const auto interpolation = SiteValues<1>::create(*plain, Sites::greville);
  if (!interpolation) return std::unexpected(interpolation.error());
  Points values(knots.count(), 3);
  for (int i = 0; i < knots.count(); ++i) {
    values.row(i) = at(interpolation->abscissae(0)[static_cast<std::size_t>(i)]).transpose();
  }
  auto curve = plain->with_control_points(interpolation->coefficients(std::move(values)));
  if (!curve) return curve;
  // The interpolation error vanishes at the sites, and is largest about halfway between them:
  // samples within each span.
  constexpr int samples = 8;  // per span
  double error = 0;
  for (const int span : knots.spans()) {
    for (int k = 0; k <= samples; ++k) {
      const double u =
          std::min(knots[span] + (knots[span + 1] - knots[span]) * k / samples, knots[span + 1]);
      const auto point = evaluate_point<1>(*curve, {u});
      if (!point) return std::unexpected(point.error());
      error = std::max(error, (*point - at(u)).norm());
    }
  }
  notes.push_back(fmt::format(
      "the helix is met to {:.2g}, as no spline is one; a larger net meets it better", error));
  return curve;
}

Expected<Curve> curve_of(const NewCommand& c, BodyForm form, std::vector<std::string>& notes) {
  const double radius = c.radius.value_or(0.5);
  if (auto checked = positive(radius, "radius"); !checked) return std::unexpected(checked.error());
  if (!c.knots_v.empty())
    return input_error("a curve has one direction", "knots_v", "leave it out");
  if (form == BodyForm::circle && c.points.empty()) {
    if (!c.knots_u.empty())
      return input_error("a circle has its own knots", "knots_u", "leave it out");
    auto circle = circle_quarters({0, 0}, radius, 0, 4);
    if (!circle) return circle;
    Points points = circle->control_points();
    points.col(1).swap(points.col(2));  // from the plane of x and z to that of x and y
    return circle->with_control_points(std::move(points));
  }
  const auto knots = all_knots<1>(c);
  if (!knots) return std::unexpected(knots.error());
  const KnotVector& u = knots->front();
  if (form == BodyForm::helix && c.points.empty()) return helix(c, u, radius, notes);
  if (!c.points.empty()) {
    auto points = given_points(c, u.count());
    if (!points) return std::unexpected(points.error());
    if (auto checked = check_weights(c.weights, u.count()); !checked)
      return std::unexpected(checked.error());
    return Curve::create({u}, *std::move(points), c.weights);
  }
  const double length = c.size ? c.size->front() : 1;
  if (auto checked = positive(length, "size"); !checked) return std::unexpected(checked.error());
  Points points = Points::Zero(u.count(), 3);
  for (int i = 0; i < u.count(); ++i) points(i, 0) = length * fraction_of(u, i);
  return Curve::create({u}, std::move(points));
}

/// A disc in z = 0 of one rational biquadratic piece times the height: the sides u0, u1, v0 and v1
/// are quarters of the cylinder. Its Jacobian vanishes on the four lines where they meet.
Expected<Volume> cylinder(const NewCommand& c, double radius) {
  const double height = c.height.value_or(2 * radius);
  if (auto checked = positive(height, "height"); !checked) return std::unexpected(checked.error());
  if (!c.knots_u.empty() || !c.knots_v.empty()) {
    return input_error("a round volume has its own knots across",
                       c.knots_u.empty() ? "knots_v" : "knots_u", "leave it out");
  }
  const auto along = knots_of(c, 2, in_direction(c.net, 2), "net");
  if (!along) return std::unexpected(along.error());
  constexpr double half_root = std::numbers::sqrt2 / 2;
  const auto across = KnotVector::clamped_uniform(2, 3);
  const int n = along->count();
  if (auto fits = check_size(9.0 * n); !fits) return std::unexpected(fits.error());
  Points points(static_cast<Eigen::Index>(9) * n, 3);
  std::vector<double> weights;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      // Corners lie on the circle at 45°; between two of them the tangents meet at √2 times the
      // radius, with the weight cos 45° of a quarter. The weight of the centre is free.
      const bool corner = i != 1 && j != 1, centre = i == 1 && j == 1;
      const double reach = corner ? half_root : centre ? 0 : std::numbers::sqrt2;
      for (int k = 0; k < n; ++k) {
        points.row((i * 3 + j) * n + k) << radius * reach * (i - 1), radius * reach * (j - 1),
            height * fraction_of(*along, k);
        weights.push_back(corner || centre ? 1 : half_root);
      }
    }
  }
  auto disc = Volume::create({*across, *across, *along}, std::move(points), std::move(weights));
  if (!disc) return disc;
  std::array<std::vector<double>, 3> inserted;
  for (std::size_t d = 0; d < 2; ++d) {
    const int spans = in_direction(c.net, d) - 2;
    if (spans < 1) {
      return input_error(fmt::format("{} control points across", in_direction(c.net, d)), "net",
                         "use 3 or more");
    }
    if (auto fits = check_size((spans + 2.0) * (spans + 2.0) * n); !fits)
      return std::unexpected(fits.error());
    for (int k = 1; k < spans; ++k) inserted[d].push_back(static_cast<double>(k) / spans);
  }
  return insert_knots<3>(*disc, inserted);
}

Expected<Volume> volume_of(const NewCommand& c, BodyForm form) {
  const double radius = c.radius.value_or(0.5);
  if (auto checked = positive(radius, "radius"); !checked) return std::unexpected(checked.error());
  if (form == BodyForm::cylinder && c.points.empty()) return cylinder(c, radius);
  const auto knots = all_knots<directions_of_volume>(c);
  if (!knots) return std::unexpected(knots.error());
  const int l = (*knots)[0].count(), m = (*knots)[1].count(), n = (*knots)[2].count();
  if (auto fits = check_size(1.0 * l * m * n); !fits) return std::unexpected(fits.error());
  const int count = l * m * n;
  if (!c.points.empty()) {
    auto points = given_points(c, count);
    if (!points) return std::unexpected(points.error());
    if (auto checked = check_weights(c.weights, count); !checked)
      return std::unexpected(checked.error());
    return Volume::create({(*knots)[0], (*knots)[1], (*knots)[2]}, *std::move(points), c.weights);
  }
  std::vector<double> size = c.size.value_or(std::vector<double>{1});
  size.resize(directions_of_volume, size.front());
  for (const double side : size) {
    if (auto checked = positive(side, "size"); !checked) return std::unexpected(checked.error());
  }
  Points points(count, 3);
  for (int k = 0; k < count; ++k) {
    points.row(k) << size[0] * fraction_of((*knots)[0], k / (m * n)),
        size[1] * fraction_of((*knots)[1], k / n % m), size[2] * fraction_of((*knots)[2], k % n);
  }
  return Volume::create({(*knots)[0], (*knots)[1], (*knots)[2]}, std::move(points));
}

template <int D>
Expected<SceneBody> body_of(Expected<Spline<D>> made, const NewCommand& c, std::string_view name) {
  if (!made) return std::unexpected(made.error());
  auto at = placed(*std::move(made), c.position);
  if (!at) return std::unexpected(at.error().within("position"));
  return untouched<D>({}, std::string(name), {}, std::make_shared<const Spline<D>>(*std::move(at)));
}

}  // namespace

std::span<const Choice> choices(BodyForm) {
  static constexpr Choice list[] = {
      {"line", BodyForm::line, "along x from the origin"},
      {"circle", BodyForm::circle, "about the origin in z = 0, exact"},
      {"helix", BodyForm::helix, "about z from z = 0, interpolated"},
      {"box", BodyForm::box, "with a corner in the origin"},
      {"cylinder", BodyForm::cylinder, "about z, from z = 0, filled"}};
  return list;
}

Expected<void> positive(double value, const char* where) {
  if (std::isfinite(value) && value > 0) return {};
  return input_error(fmt::format("{} is not a length", value), where, "use a number > 0");
}

Expected<void> check_weights(const std::vector<double>& weights, int count) {
  if (weights.empty()) return {};
  if (static_cast<int>(weights.size()) != count) {
    return input_error(fmt::format("{} weights for {} control points", weights.size(), count),
                       "weights", "give one for each, or none");
  }
  const auto bad =
      std::ranges::find_if(weights, [](double w) { return !(std::isfinite(w) && w > 0); });
  if (bad == weights.end()) return {};
  return input_error(fmt::format("{} is not a weight", *bad),
                     fmt::format("weights[{}]", bad - weights.begin()), "use finite numbers > 0");
}

Expected<void> check_counts(const NewCommand& c, std::size_t directions) {
  const auto check = [directions](std::size_t given, const char* field) -> Expected<void> {
    if (given == 1 || given == directions) return {};
    return input_error(
        fmt::format("{} numbers for {} direction{}", given, directions, directions == 1 ? "" : "s"),
        field, directions == 1 ? "give one" : fmt::format("give {}, or one for all", directions));
  };
  if (auto status = check(c.degree.size(), "degree"); !status) return status;
  if (auto status = check(c.net.size(), "net"); !status) return status;
  return c.size ? check(c.size->size(), "size") : Expected<void>();
}

Expected<KnotVector> knots_of(const NewCommand& c, std::size_t d, int count,
                              const char* counted_by) {
  const std::vector<double> given = d == 0   ? c.knots_u
                                    : d == 1 ? c.knots_v
                                             : c.knots_w.value_or(std::vector<double>{});
  const int degree = in_direction(c.degree, d);
  auto made = given.empty() ? KnotVector::clamped_uniform(degree, count)
                            : KnotVector::create(degree, given);
  static constexpr const char* names[] = {"knots_u", "knots_v", "knots_w"};
  if (!made) return std::unexpected(made.error().within(given.empty() ? counted_by : names[d]));
  return made;
}

Expected<SceneBody> new_body(const NewCommand& c, std::vector<std::string>& notes) {
  const bool curve = c.shape == "curve";
  const BodyForm form = c.form.value_or(curve ? BodyForm::line : BodyForm::box);
  const bool of_curve = form <= BodyForm::helix;
  if (of_curve != curve) {
    return input_error(fmt::format("a {} has no form {}", c.shape, name_of(form)), "form",
                       curve ? "use line, circle or helix" : "use box or cylinder");
  }
  if (c.form && !c.points.empty()) {
    return input_error("both points and a form are given", "points", "leave one of them out");
  }
  if (auto counted = check_counts(c, curve ? 1 : directions_of_volume); !counted) {
    return std::unexpected(counted.error());
  }
  if (curve && c.knots_w)
    return input_error("a curve has one direction", "knots_w", "leave it out");
  if (!c.weights.empty() && c.points.empty()) {
    return input_error(fmt::format("a {} has its own weights", name_of(form)), "weights",
                       "leave them out");
  }
  if (curve) return body_of<1>(curve_of(c, form, notes), c, name_of(form));
  return body_of<3>(volume_of(c, form), c, name_of(form));
}

}  // namespace knead
