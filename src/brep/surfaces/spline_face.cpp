#include "spline_face.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "brep/boundary_curve.hpp"
#include "brep/face_region.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::brep {
namespace {

constexpr double unnoticed = 0.02;   // of the limit: where chords are closer, they may turn
constexpr double least_round = 3;    // steps around a closed direction
constexpr double degenerate = 1e-9;  // |S_u × S_v| over |S_u|² + |S_v|²

/// `to` at x, where `from` is ascending: piecewise linear; beyond the ends as often again if
/// closed, else straight on.
double mapped(const std::vector<double>& from, const std::vector<double>& to, double x,
              bool closed) {
  const double length = from.back() - from.front(), whole = to.back() - to.front();
  double turns = 0;
  if (closed) turns = std::floor((x - from.front()) / length);
  x -= turns * length;
  const auto k = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(std::upper_bound(from.begin(), from.end(), x) - from.begin() - 1,
                                 0, static_cast<std::ptrdiff_t>(from.size()) - 2));
  return to[k] + (to[k + 1] - to[k]) * (x - from[k]) / (from[k + 1] - from[k]) + turns * whole;
}

}  // namespace

SplineFace::SplineFace(const Surface& surface, SurfaceFoot feet)
    : surface_(&surface), feet_(std::move(feet)), size_(net_diagonal(surface.control_points())) {}

Expected<SplineFace> SplineFace::create(const Surface& surface) {
  auto feet = SurfaceFoot::create(surface);
  if (!feet) return std::unexpected(std::move(feet.error()));
  SplineFace result(surface, *std::move(feet));
  for (int d = 0; d < 2; ++d) {
    auto chords = span_chords(surface, d);
    if (!chords) return std::unexpected(std::move(chords.error()));
    const KnotVector& knots = surface.knots(d);
    const Interval domain = knots.domain();
    const auto k = static_cast<std::size_t>(d);
    result.chords_[k] = *std::move(chords);
    for (const int s : knots.spans())
      result.ends_[k].push_back((knots[s] - domain.lower) / domain.length());
    result.ends_[k].push_back(1);
    result.steps_[k] = result.ends_[k];
  }
  return result;
}

std::array<double, 2> SplineFace::parameters(const Eigen::Vector2d& fractions) const {
  std::array<double, 2> result;
  for (int d = 0; d < 2; ++d) {
    const Interval domain = surface_->knots(d).domain();
    double x = fractions[d];
    if (feet_.space().periods[static_cast<std::size_t>(d)] > 0) x -= std::floor(x);
    result[static_cast<std::size_t>(d)] =
        std::clamp(domain.lower + x * domain.length(), domain.lower, domain.upper);
  }
  return result;
}

Point SplineFace::at(const Eigen::Vector2d& uv) const {
  const auto point = evaluate_point<2>(*surface_, parameters(uv));
  return point ? *point : Point(surface_->control_points().row(0).transpose());
}

Point SplineFace::normal(const Eigen::Vector2d& uv) const {
  constexpr double beside = 1e-4;
  const Eigen::Vector2d inwards = Eigen::Vector2d::Constant(0.5) - uv;
  for (const Eigen::Vector2d& place : {uv, Eigen::Vector2d(uv + beside * inwards)}) {
    const auto parameter = parameters(place);
    const auto jet = evaluate<2>(*surface_, Parameters<2>{{parameter[0], parameter[1]}}, 1);
    if (!jet) continue;
    const Point u = jet->at({1, 0}).row(0), v = jet->at({0, 1}).row(0), n = u.cross(v);
    if (n.norm() > degenerate * (u.squaredNorm() + v.squaredNorm())) return n.normalized();
  }
  return Point::UnitZ();
}

Foot SplineFace::foot(const Point& p, const std::optional<Eigen::Vector2d>& near) const {
  return feet_.nearest(p, near, on_surface * size_).foot;
}

/// How far the twist takes the middle of a cell of one by one step off its triangles, about the
/// largest.
/// Chords along both directions are within the limit by the steps themselves, but S_uv lifts the
/// middle of a cell by S_uv Δu Δv / 4 off its corners' mean. Measured at the middles of 64 × 64
/// spans at most.
double SplineFace::twist() const {
  constexpr std::size_t most = 64;
  std::array<std::vector<double>, 2> places,
      lengths;  // middles of spans, and what one step there is in parameters
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = surface_->knots(static_cast<int>(d)).domain();
    const std::size_t count = ends_[d].size() - 1, stride = (count - 1) / most + 1;
    for (std::size_t k = 0; k < count; k += stride) {
      places[d].push_back(domain.lower + domain.length() * (ends_[d][k] + ends_[d][k + 1]) / 2);
      const double step = (ends_[d][k + 1] - ends_[d][k]) / (steps_[d][k + 1] - steps_[d][k]);
      lengths[d].push_back(domain.length() * std::min(step, 1.0));
    }
  }
  const auto jet = evaluate_grid<2>(*surface_, {places[0], places[1]}, 2);
  if (!jet) return 0;
  double result = 0;
  for (std::size_t k = 0; k < places[0].size(); ++k) {
    for (std::size_t l = 0; l < places[1].size(); ++l) {
      const auto row = static_cast<Eigen::Index>(k * places[1].size() + l);
      const Point u = jet->at({1, 0}).row(row), v = jet->at({0, 1}).row(row), n = u.cross(v);
      if (!(n.norm() > 0)) continue;
      const double across = std::abs(jet->at({1, 1}).row(row).dot(n.normalized()));
      result = std::max(result, across * lengths[0][k] * lengths[1][l] / 4);
    }
  }
  return result;
}

// Chord errors fall with the square of the length: a span whose chord is off by d needs √(d /
// limit) steps. Each direction may use half of the limit. Turning is limited too, by shading,
// except where it cannot be seen. If the twist exceeds the limit, all steps are shortened alike by
// √excess, as its error falls with their product.
void SplineFace::set_steps(ChordLimit chord) {
  const double limit = std::min(chord.share * size_ / 2, chord.length) / 2,
               angle = chord_angle(chord.share);
  for (std::size_t d = 0; d < 2; ++d) {
    double total = 0;
    std::vector<double> widths;
    for (const SpanChord& span : chords_[d]) {
      const double turning =
          std::min(span.turn / angle, std::sqrt(span.distance / (unnoticed * limit)));
      widths.push_back(std::max(std::sqrt(span.distance / limit), turning));
      total += widths.back();
    }
    // Flat spans get a little as well, so that the chart is one to one.
    const double least = feet_.space().periods[d] > 0 ? least_round : 1;
    const double evenly = std::max(1e-3 * std::max(least, total), least - total);
    for (std::size_t k = 0; k < widths.size(); ++k) {
      steps_[d][k + 1] = steps_[d][k] + widths[k] + evenly * (ends_[d][k + 1] - ends_[d][k]);
    }
  }
  const double excess = std::sqrt(twist() / limit);
  if (!(excess > 1)) return;
  for (auto& steps : steps_) {
    for (double& s : steps) s *= excess;
  }
}

Eigen::Vector2d SplineFace::chart(const Eigen::Vector2d& uv) const {
  const auto& periods = feet_.space().periods;
  return {mapped(ends_[0], steps_[0], uv[0], periods[0] > 0),
          mapped(ends_[1], steps_[1], uv[1], periods[1] > 0)};
}

Eigen::Vector2d SplineFace::from_chart(const Eigen::Vector2d& steps) const {
  const auto& periods = feet_.space().periods;
  return {mapped(steps_[0], ends_[0], steps[0], periods[0] > 0),
          mapped(steps_[1], ends_[1], steps[1], periods[1] > 0)};
}

}  // namespace knead::brep
