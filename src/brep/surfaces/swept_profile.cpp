// The profile curves of surfaces of revolution and of linear extrusion, seen along the sweep.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "face_surface.hpp"

namespace knead::brep {
namespace {

constexpr int samples_per_piece = 6;
constexpr double sample_chord = 1e-3;

}  // namespace

/// For a revolution: distance from the axis and height; for an extrusion: the position across its
/// direction.
Eigen::Vector2d FaceSurface::section(const Point& p) const {
  const Point d = p - frame_.origin;
  const double x = d.dot(frame_.x), y = d.dot(frame_.y);
  if (kind_ == Kind::extrusion) return {x, y};
  const double rho = std::hypot(x, y);
  return {one_side_ && d.dot(side_) < 0 ? -rho : rho, d.dot(frame_.z)};
}

Expected<void> FaceSurface::tabulate(const Model& model, const Support& support,
                                     std::span<const Point> on_it) {
  const auto& swept = std::get<SweptSurface>(support.form);
  if (swept.wrong) return std::unexpected(*swept.wrong);
  auto curve = EdgeCurve::create(*swept.curve);
  if (!curve) return std::unexpected(std::move(curve.error()));
  profile_ = *std::move(curve);
  if (auto status = find_range(model, support, on_it); !status) return status;
  if (kind_ == Kind::revolution) {
    find_side();
    if (auto status = end_at_axis(model, support, on_it); !status) return status;
  }
  sample_profile();
  if (one_side_) keep_one_side();
  return {};
}

/// The needed part of the profile. If it is unbounded, as far as the face can reach: a point on the
/// face is as far from the axis, or along it, as the point of the curve that sweeps it.
Expected<void> FaceSurface::find_range(const Model& model, const Support& support,
                                       std::span<const Point> on_it) {
  const bool revolution = kind_ == Kind::revolution;
  if (const auto domain = profile_->domain()) {
    range_ = *domain;
    periods_[revolution ? 1 : 0] = profile_->closed() ? domain->length() : 0;
  } else {
    range_ = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    const Point start = profile_->at(0);
    const double first = section(start).norm();
    for (const Point& p : on_it) {
      const double reach =
          revolution ? section(p).norm() + first : (section(p) - section(start)).norm();
      double t = 1;
      for (const double sign : {-1.0, 1.0}) {  // in both directions from t = 0 up to that distance
        t = sign * std::max(reach, 1e-9);
        if (!profile_->straight()) {
          for (t = sign;
               (section(profile_->at(t)) - section(start)).norm() < reach && std::abs(t) < 700;
               t *= 2) {
          }
        } else if (!revolution) {
          // Only distances across the direction of the extrusion count.
          const double across = (section(profile_->at(1)) - section(start)).norm();
          if (!(across > 1e-9)) return model.error(support, "it is swept along itself");
          t = sign * std::max(reach, 1e-9) / across;
        }
        range_.lower = std::min(range_.lower, t);
        range_.upper = std::max(range_.upper, t);
      }
    }
  }
  if (!(range_.length() > 0)) return model.error(support, "its curve has no length");
  return {};
}

/// A circle whose centre is on the axis sweeps everything twice: the side of its largest extent
/// suffices.
void FaceSurface::find_side() {
  double largest = 0;
  for (int k = 0; k <= 64; ++k) {
    const Point d = profile_->at(range_.lower + range_.length() * k / 64) - frame_.origin;
    const Point across = d - d.dot(frame_.z) * frame_.z;
    if (across.norm() <= largest) continue;
    largest = across.norm();
    side_ = across;
  }
}

/// For a line that meets the axis, keeps only the nappe of the cone with the face; for a skew one,
/// finds the waist.
Expected<void> FaceSurface::end_at_axis(const Model& model, const Support& support,
                                        std::span<const Point> on_it) {
  if (profile_->domain() != std::nullopt || !profile_->straight()) return {};
  const Point a = profile_->at(0) - frame_.origin;
  const Point direction = profile_->derivative(0);
  const Point across = direction - direction.dot(frame_.z) * frame_.z;
  if (!(across.norm() > 1e-9)) return {};
  const double t = -(a - a.dot(frame_.z) * frame_.z).dot(across) / across.squaredNorm();
  const double waist = section(profile_->at(t)).x();
  if (waist > 1e-9 * range_.length() && std::abs(direction.dot(frame_.z)) > 1e-9) {
    waist_ = waist;
  } else if (waist <= 1e-9 * range_.length()) {
    double middle = 0;
    for (const Point& p : on_it) middle += section(p).y() / static_cast<double>(on_it.size());
    const double height_at_pole = section(profile_->at(t)).y();
    const bool upper = (middle > height_at_pole) == (direction.dot(frame_.z) > 0);
    (upper ? range_.lower : range_.upper) = t;
    if (!(range_.length() > 0))
      return model.error(support, "the face lies beyond where its curve meets the axis");
  }
  return {};
}

void FaceSurface::sample_profile() {
  const std::vector<double> parameters =
      profile_->straight() ? std::vector<double>{range_.lower, range_.upper}
                           : profile_->subdivided(range_.lower, range_.upper, {sample_chord});
  const auto pieces = static_cast<std::size_t>(profile_->straight() ? 64 : samples_per_piece);
  for (std::size_t k = 0; k + 1 < parameters.size(); ++k) {
    for (std::size_t i = 0; i < pieces; ++i) {
      sample_parameters_.push_back(parameters[k] + (parameters[k + 1] - parameters[k]) *
                                                       static_cast<double>(i) /
                                                       static_cast<double>(pieces));
    }
  }
  sample_parameters_.push_back(parameters.back());
  const bool revolution = kind_ == Kind::revolution;
  one_side_ = revolution;  // so that `section` has signs
  bool crosses = false;
  double size = 0;
  for (const double t : sample_parameters_) {
    samples_.push_back(section(profile_->at(t)));
    size = std::max(size, std::abs(samples_.back().x()));
  }
  for (const auto& q : samples_) crosses = crosses || q.x() < -1e-6 * size;
  one_side_ = revolution && crosses && profile_->closed();
  if (!one_side_ && revolution) {
    for (auto& q : samples_) q.x() = std::abs(q.x());
  }
}

/// Only the part on the positive side: from one crossing of the axis to the next.
void FaceSurface::keep_one_side() {
  const auto n = samples_.size() - 1;
  std::size_t begin = 0;
  while (begin < n && !(samples_[begin].x() < 0 && samples_[(begin + 1) % n].x() >= 0)) ++begin;
  std::size_t end = begin + 1;
  while (end < begin + n && samples_[(end + 1) % n].x() >= 0) ++end;
  const auto crossing = [&](std::size_t k, std::size_t l) {
    const double a = samples_[k % n].x(), b = samples_[l % n].x();
    const double step = sample_parameters_[k % n + 1] - sample_parameters_[k % n];
    return sample_parameters_[k % n] + (k >= n ? range_.length() : 0) + step * a / (a - b);
  };
  range_ = {crossing(begin, begin + 1), crossing(end, end + 1)};
  periods_[1] = 0;
  sample_parameters_.clear();
  samples_.clear();
  constexpr int count = 512;
  for (int k = 0; k <= count; ++k) {
    sample_parameters_.push_back(range_.lower + range_.length() * k / count);
    samples_.push_back(section(profile_->at(sample_parameters_.back())));
  }
  samples_.front().x() = samples_.back().x() = 0;
}

double FaceSurface::nearest(const Eigen::Vector2d& q) const {
  // The nearest point of the polygon through the samples, and Newton's iteration from there.
  double best = std::numeric_limits<double>::infinity(), t = range_.lower;
  double lower = range_.lower, upper = range_.upper;
  for (std::size_t k = 0; k + 1 < samples_.size(); ++k) {
    const Eigen::Vector2d side = samples_[k + 1] - samples_[k];
    const double length = side.squaredNorm();
    const double share =
        length > 0 ? std::clamp((q - samples_[k]).dot(side) / length, 0.0, 1.0) : 0;
    const double distance = (samples_[k] + share * side - q).squaredNorm();
    if (distance >= best) continue;
    best = distance;
    const double step = sample_parameters_[k + 1] - sample_parameters_[k];
    t = sample_parameters_[k] + share * step;
    lower = std::max(range_.lower, sample_parameters_[k] - step);
    upper = std::min(range_.upper, sample_parameters_[k + 1] + step);
  }
  // Gauss and Newton's step (q − s) · s' / |s'|² for the nearest point: it converges quadratically
  // for points on the surface, which is what feet are asked of, and stays within one sample of the
  // polygon's answer.
  const double h = 1e-4 * (upper - lower);
  for (int iteration = 0; iteration < 6; ++iteration) {
    // By differences: the section of a skew curve has no simple derivative.
    const double a = std::max(t - h, range_.lower), b = std::min(t + h, range_.upper);
    const Eigen::Vector2d slope = (section(profile_->at(b)) - section(profile_->at(a))) / (b - a);
    const double divisor = slope.squaredNorm();
    if (!(divisor > 0)) break;
    const double next =
        std::clamp(t + (q - section(profile_->at(t))).dot(slope) / divisor, lower, upper);
    if (std::abs(next - t) <= 1e-12 * range_.length()) return next;
    t = next;
  }
  return t;
}

}  // namespace knead::brep
