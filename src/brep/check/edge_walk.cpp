#include "edge_walk.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace knead::brep {
namespace {

constexpr int first_steps = 16, most_samples = 600, most_crossings = 200, most_halvings = 5;
constexpr std::array end_shares = {1.0 / 1024, 1.0 / 256, 1.0 / 64};
constexpr double settled = 5e-3;    // of a largest value, by which halving may still change it
constexpr double beside = 1e-7;     // of the edge: limits at knots that it crosses
constexpr double same_line = 1e-7;  // fractions: a foot that runs along a knot does not cross it
constexpr int golden_steps = 16, most_tops = 4;
constexpr double least_top = 0.8, risen = 1e-3, drop = 0.02;  // of the largest value

double& value(EdgeSample& sample, Measure m) { return sample.values[static_cast<std::size_t>(m)]; }

class Walker {
 public:
  Walker(const EdgePiece& piece, const std::vector<EdgeSide>& sides, const EdgeScale& scale)
      : piece_(piece), sides_(sides), scale_(scale) {}

  EdgeWalk run() {
    for (const double t : first_parameters()) samples_.push_back(look(t, last()));
    cross_lines();
    for (int k = 0; k < most_halvings && samples_.size() < most_samples / 2; ++k) {
      const auto before = largest();
      halve();
      if (have_settled(before, largest())) break;
    }
    climb();
    EdgeWalk result;
    for (std::size_t m = 0; m < measure_count; ++m) {
      result.largest[m] =
          *std::ranges::max_element(samples_, {}, [m](const EdgeSample& s) { return s.values[m]; });
    }
    result.length = length();
    result.samples = std::move(samples_);
    return result;
  }

 private:
  const EdgeSample* last() const { return samples_.empty() ? nullptr : &samples_.back(); }

  /// Even steps, the knots of a spline and the middles between them.
  std::vector<double> first_parameters() const {
    const double from = piece_.from, to = piece_.to;
    std::vector<double> result;
    for (int k = 0; k <= first_steps; ++k)
      result.push_back(std::lerp(from, to, static_cast<double>(k) / first_steps));
    // Where edges end, surfaces may have corners and poles, and gaps rise within a short way.
    for (const double share : end_shares) {
      result.push_back(std::lerp(from, to, share));
      result.push_back(std::lerp(to, from, share));
    }
    std::vector<double> ends = {from};
    if (const auto whole = piece_.curve.whole()) {
      if (const auto curve = piece_.curve.spline(*whole)) {
        const KnotVector& knots = curve->knots(0);
        for (const double turns : {0.0, 1.0}) {
          for (const int s : knots.spans()) {
            const double at = knots[s] + turns * whole->length();
            if (at > from && at < to) ends.push_back(at);
          }
        }
      }
    }
    ends.push_back(to);
    std::ranges::sort(ends);
    if (ends.size() < most_crossings) {
      for (std::size_t k = 0; k + 1 < ends.size() && ends.size() > 2; ++k) {
        result.push_back(ends[k]);
        result.push_back((ends[k] + ends[k + 1]) / 2);
      }
    }
    std::ranges::sort(result);
    const double near = 1e-6 * (to - from);
    std::vector<double> apart;
    for (const double t : result) {
      if (apart.empty() || t - apart.back() > near) apart.push_back(t);
    }
    apart.back() = to;
    return apart;
  }

  /// Everything at a parameter; `near`: a sample beside it.
  EdgeSample look(double t, const EdgeSample* near) const {
    EdgeSample sample;
    sample.t = t;
    sample.point = piece_.curve.at(t);
    Point tangent = piece_.curve.derivative(t);
    if (tangent.norm() > 0) tangent.normalize();
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      const FaceFoot* beside_it = near != nullptr ? &near->feet[k] : nullptr;
      const EdgeSide& side = sides_[k];
      sample.feet.push_back(
          side.face->foot(sample.point, beside_it, side.way * tangent, side.line));
    }
    measure(sample, tangent);
    return sample;
  }

  void measure(EdgeSample& sample, const Point& tangent) const {
    sample.values.fill(-1);
    double& gap = value(sample, Measure::gap);
    double& off = value(sample, Measure::off_curve);
    for (const FaceFoot& foot : sample.feet)
      off = std::max(off, (foot.point - sample.point).norm());
    if (sample.feet.size() == 1) gap = off;
    for (std::size_t a = 0; a < sample.feet.size(); ++a) {
      for (std::size_t b = a + 1; b < sample.feet.size(); ++b) {
        gap = std::max(gap, (sample.feet[a].point - sample.feet[b].point).norm());
        turn(sample, a, b, tangent);
      }
    }
  }

  /// Faces on both sides of the edge with the same way along it have opposite normals where they
  /// are smooth; that of the second is turned.
  void turn(EdgeSample& sample, std::size_t a, std::size_t b, const Point& tangent) const {
    const FaceFoot &first = sample.feet[a], &second = sample.feet[b];
    if (first.normal.isZero() || second.normal.isZero()) return;
    const int here = sides_[a].way, there = -sides_[b].way;
    const Point n = here * first.normal, m = there * second.normal;
    const double angle = std::atan2(n.cross(m).norm(), n.dot(m));
    value(sample, Measure::angle) = std::max(value(sample, Measure::angle), angle);
    if (angle > scale_.tangent) return;
    Point across = tangent.cross(n + m);
    if (!(across.norm() > 0)) return;
    across.normalize();
    const double one = here * across.dot(first.bending * across),
                 other = there * across.dot(second.bending * across);
    double difference = std::abs(one - other);
    if (std::max(std::abs(one), std::abs(other)) < scale_.flat()) difference = 0;
    const double relative =
        difference > 0 ? 100 * difference / (std::abs(one) + std::abs(other)) : 0;
    value(sample, Measure::curvature) = std::max(value(sample, Measure::curvature), difference);
    value(sample, Measure::relative_curvature) =
        std::max(value(sample, Measure::relative_curvature), relative);
  }

  /// Adds samples at knots of the surfaces that the edge crosses, on both sides where second
  /// derivatives may jump.
  void cross_lines() {
    std::vector<EdgeSample> added;
    for (std::size_t k = 0; k < sides_.size(); ++k) {
      for (int d = 0; d < 2; ++d) {
        for (const auto& line : sides_[k].face->lines()[static_cast<std::size_t>(d)]) {
          for (std::size_t i = 0; i + 1 < samples_.size(); ++i) {
            if (added.size() > most_crossings) return merge(std::move(added));
            cross(k, d, line, samples_[i], samples_[i + 1], added);
          }
        }
      }
    }
    merge(std::move(added));
  }

  // Regula falsi with Illinois' modification, on the foot's fraction.
  void cross(std::size_t k, int d, const CheckedSpline::Line& line, const EdgeSample& a,
             const EdgeSample& b, std::vector<EdgeSample>& added) const {
    double from = a.t, to = b.t, f = a.feet[k].at[d] - line.fraction,
           g = b.feet[k].at[d] - line.fraction;
    if (std::min(std::abs(f), std::abs(g)) < same_line || (f > 0) == (g > 0)) return;
    if (std::abs(f - g) > 0.5) return;  // over a seam
    const double range = piece_.to - piece_.from;
    double at = from;
    int kept = 0;
    for (int n = 0; n < 30 && to - from > 1e-2 * beside * range; ++n) {
      at = (from * g - to * f) / (g - f);
      EdgeSample sample = look(at, &a);
      const double h = sample.feet[k].at[d] - line.fraction;
      if (std::abs(h) < 1e-12) break;
      if ((h > 0) == (g > 0)) {
        to = at;
        g = h;
        if (kept == 1) f /= 2;
        kept = 1;
      } else {
        from = at;
        f = h;
        if (kept == 2) g /= 2;
        kept = 2;
      }
    }
    if (!line.kink) {
      added.push_back(look(at, &a));
      return;
    }
    for (const double side : {-beside, beside}) {
      const double t = at + side * range;
      if (t > piece_.from && t < piece_.to) added.push_back(look(t, &a));
    }
  }

  void merge(std::vector<EdgeSample> added) {
    for (EdgeSample& sample : added) samples_.push_back(std::move(sample));
    std::ranges::stable_sort(samples_, {}, &EdgeSample::t);
  }

  void halve() {
    const double least = 10 * beside * (piece_.to - piece_.from);
    std::vector<EdgeSample> added;
    for (std::size_t k = 0; k + 1 < samples_.size(); ++k) {
      if (samples_[k + 1].t - samples_[k].t < least) continue;
      added.push_back(look((samples_[k].t + samples_[k + 1].t) / 2, &samples_[k]));
    }
    merge(std::move(added));
  }

  std::array<double, measure_count> largest() const {
    std::array<double, measure_count> result;
    result.fill(-1);
    for (const EdgeSample& sample : samples_) {
      for (std::size_t m = 0; m < measure_count; ++m)
        result[m] = std::max(result[m], sample.values[m]);
    }
    return result;
  }

  bool have_settled(const std::array<double, measure_count>& before,
                    const std::array<double, measure_count>& now) const {
    const auto negligible = scale_.negligible();
    for (std::size_t m = 0; m < measure_count; ++m) {
      if (now[m] > negligible[m] && now[m] - before[m] > settled * now[m]) return false;
    }
    return true;
  }

  /// A golden-section search around the samples of each measure that may stand beside a larger
  /// value than any: as the parabola through a sample and those beside it says.
  void climb() {
    const auto highest = largest();
    const auto negligible = scale_.negligible();
    std::vector<EdgeSample> added;
    for (std::size_t m = 0; m < measure_count; ++m) {
      if (highest[m] <= negligible[m]) continue;
      int tops = 0;
      for (std::size_t k = 0; k < samples_.size() && tops < most_tops; ++k) {
        const double here = samples_[k].values[m];
        if (here < least_top * highest[m]) continue;
        const auto [before, after] = around(k);
        const double left = samples_[before].values[m], right = samples_[after].values[m];
        if (here < left || here < right) continue;
        const bool steep = here == highest[m] && std::max(left, right) < (1 - drop) * here;
        if (!steep && here + rise(m, before, k, after) < (1 + risen) * highest[m]) continue;
        ++tops;
        added.push_back(top(m, k));
      }
    }
    merge(std::move(added));
  }

  /// By how much the parabola through three samples rises above the middle one.
  double rise(std::size_t m, std::size_t before, std::size_t k, std::size_t after) const {
    const double a = samples_[k].t - samples_[before].t, b = samples_[after].t - samples_[k].t;
    if (!(a > 0 && b > 0)) return 0;
    const double here = samples_[k].values[m], up = (here - samples_[before].values[m]) / a,
                 down = (samples_[after].values[m] - here) / b;
    const double bend = (up - down) / (a + b), slope = (up * b + down * a) / (a + b);
    return bend > 0 ? slope * slope / (4 * bend) : 0;
  }

  /// The samples on both sides of one, beyond those of a knot that it is beside.
  std::pair<std::size_t, std::size_t> around(std::size_t k) const {
    const double least = 10 * beside * (piece_.to - piece_.from);
    std::size_t before = k, after = k;
    while (before > 0 && samples_[k].t - samples_[before].t < least) --before;
    while (after + 1 < samples_.size() && samples_[after].t - samples_[k].t < least) ++after;
    return {before, after};
  }

  EdgeSample top(std::size_t m, std::size_t k) const {
    constexpr double ratio = 0.6180339887498949;
    const auto [before, after] = around(k);
    double from = samples_[before].t, to = samples_[after].t;
    EdgeSample best = samples_[k];
    const auto at = [&](double t) {
      EdgeSample sample = look(t, &samples_[k]);
      if (sample.values[m] > best.values[m]) best = sample;
      return sample.values[m];
    };
    double a = to - ratio * (to - from), b = from + ratio * (to - from);
    double f = at(a), g = at(b);
    for (int n = 0; n < golden_steps; ++n) {
      if (f < g) {
        from = a;
        a = b;
        f = g;
        b = from + ratio * (to - from);
        g = at(b);
      } else {
        to = b;
        b = a;
        g = f;
        a = to - ratio * (to - from);
        f = at(a);
      }
    }
    return best;
  }

  // Gauss's rule of three points between the samples.
  double length() const {
    constexpr std::array<double, 3> places = {0.1127016653792583, 0.5, 0.8872983346207417},
                                    weights = {5.0 / 18, 4.0 / 9, 5.0 / 18};
    double result = 0;
    for (std::size_t k = 0; k + 1 < samples_.size(); ++k) {
      const double from = samples_[k].t, step = samples_[k + 1].t - from;
      for (std::size_t i = 0; i < 3; ++i)
        result += weights[i] * step * piece_.curve.derivative(from + places[i] * step).norm();
    }
    return result;
  }

  const EdgePiece& piece_;
  const std::vector<EdgeSide>& sides_;
  const EdgeScale& scale_;
  std::vector<EdgeSample> samples_;
};

}  // namespace

EdgeWalk walk(const EdgePiece& piece, const std::vector<EdgeSide>& sides, const EdgeScale& scale) {
  return Walker(piece, sides, scale).run();
}

}  // namespace knead::brep
