#include "align.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/decompositions.hpp"
#include "base/interruption.hpp"
#include "base/parallel_for.hpp"
#include "knead/spline/evaluate.hpp"
#include "robust_weights.hpp"
#include "spline/box_tree.hpp"

namespace knead::morph {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double cube_share = 1.0 / 40;  // side of the cubes that thin points, of the size
constexpr double nearer_part = 0.8;

/// A partner of a point of the scan: where it is now, the point of the model, the normal there.
struct Pair {
  Point x, q, n;
  double weight = 1;
};

/// The motion after another one.
RigidMotion after(const RigidMotion& second, const RigidMotion& first) {
  return {second.rotation * first.rotation, second.rotation * first.shift + second.shift};
}

/// The small motion of least Σ w (n · (x + ω × (x − c) + v − q))². The lengths of arms are taken
/// in units of `size`, so that all six unknowns are lengths; directions of which the pairs say less
/// than a billionth of what they say of others stay.
/// None where a number is not finite.
std::optional<RigidMotion> small_motion(std::span<const Pair> pairs, double size) {
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Point centre = Point::Zero();
  double total = 0;
  for (const Pair& pair : pairs) {
    centre += pair.weight * pair.x;
    total += pair.weight;
  }
  if (!(total > 0)) return RigidMotion();
  centre /= total;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(6, 6);
  Vector6 b = Vector6::Zero();
  for (const Pair& pair : pairs) {
    Vector6 row;
    row << (pair.x - centre).cross(pair.n) / size, pair.n;
    a += pair.weight * row * row.transpose();
    b += pair.weight * pair.n.dot(pair.q - pair.x) * row;
  }
  const auto axes = detail::symmetric_eigen(a);
  if (!axes) return std::nullopt;
  Vector6 step = Vector6::Zero();
  constexpr double least = 1e-9;
  for (int k = 0; k < 6; ++k) {
    const double value = axes->values[k];
    if (value > least * axes->values[5])
      step += axes->vectors.col(k).dot(b) / value * axes->vectors.col(k);
  }
  const Point turn = step.head<3>() / size;
  RigidMotion result;
  if (turn.norm() > 0)
    result.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  result.shift = centre + step.tail<3>() - result.rotation * centre;
  return result;
}

/// Points of a model with normals, about one in each cube of a grid.
struct ModelSamples {
  std::vector<Point> points, normals;
  BoxTree tree = {};
};

Expected<ModelSamples> samples_of(std::span<const FitSurface> surfaces,
                                  const std::vector<bool>& shown, double size) {
  constexpr int lines = 48;
  std::vector<Point> points, normals;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (!shown.empty() && !shown[s]) continue;
    const auto extent = surfaces[s].region.extent();
    std::vector<std::array<double, 2>> at;
    for (int k = 0; k < lines * lines; ++k) {
      const Vector2d part((k / lines + 0.5) / lines, (k % lines + 0.5) / lines);
      const Vector2d place = extent[0] + part.cwiseProduct(extent[1] - extent[0]);
      if (surfaces[s].region.contains(place))
        at.push_back(parameters_of(*surfaces[s].surface, place));
    }
    Parameters<2> parameters(static_cast<Eigen::Index>(at.size()), 2);
    for (std::size_t k = 0; k < at.size(); ++k)
      parameters.row(static_cast<Eigen::Index>(k)) << at[k][0], at[k][1];
    const auto places = evaluate<2>(*surfaces[s].surface, parameters);
    if (!places) return std::unexpected(places.error());
    const auto facing = unit_normals(*surfaces[s].surface, parameters);
    if (!facing) return std::unexpected(facing.error());
    for (Eigen::Index k = 0; k < parameters.rows(); ++k) {
      points.emplace_back(places->points().row(k).transpose());
      normals.emplace_back(facing->row(k).transpose());
    }
  }
  ModelSamples result;
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const std::size_t k : thinned(points, cube_share * size)) {
    result.points.push_back(points[k]);
    result.normals.push_back(normals[k]);
    boxes.emplace_back(points[k]);
  }
  result.tree = BoxTree(boxes);
  return result;
}

/// Middle and right-handed principal axes, the longest one first.
struct Frame {
  Point middle = Point::Zero();
  Matrix3d axes = Matrix3d::Identity();
};
Expected<Frame> frame_of(std::span<const Point> points) {
  Frame result;
  for (const Point& p : points) result.middle += p / static_cast<double>(points.size());
  Matrix3d moments = Matrix3d::Zero();
  for (const Point& p : points) moments += (p - result.middle) * (p - result.middle).transpose();
  const auto principal = detail::symmetric_eigen(moments);
  if (!principal) return std::unexpected(principal.error());
  const Matrix3d& axes = principal->vectors;
  result.axes << axes.col(2), axes.col(1), axes.col(2).cross(axes.col(1));
  return result;
}

std::vector<RigidMotion> starts_of(const Frame& scan, const Frame& model) {
  static constexpr std::array<std::array<int, 3>, 6> orders = {
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  std::vector<RigidMotion> result;
  for (std::size_t order = 0; order < orders.size(); ++order) {
    for (int signs = 0; signs < 4; ++signs) {
      Matrix3d turned = Matrix3d::Zero();
      for (int k = 0; k < 3; ++k)
        turned(k, orders[order][static_cast<std::size_t>(k)]) = (signs >> k & 1) != 0 ? -1 : 1;
      if (turned.determinant() < 0) turned.row(2) *= -1;
      for (int spin = 0; spin < 3; ++spin) {
        const Matrix3d spun =
            Eigen::AngleAxisd(spin * std::numbers::pi / 6, Point::UnitX()).toRotationMatrix();
        RigidMotion motion;
        motion.rotation = model.axes * spun * turned * scan.axes.transpose();
        motion.shift = model.middle - motion.rotation * scan.middle;
        result.push_back(motion);
      }
    }
  }
  return result;
}

struct Start {
  RigidMotion motion;
  double rms = 0;
};

/// A start improved against samples, with the rms distance of the nearer part of its points.
Start improved(RigidMotion motion, std::span<const Point> points, const ModelSamples& model,
               double size) {
  constexpr int turns = 15;
  std::vector<std::pair<double, Pair>> pairs(points.size());
  const auto part = std::max<std::size_t>(
      1, static_cast<std::size_t>(nearer_part * static_cast<double>(points.size())));
  double rms = 0;
  for (int turn = 0; turn <= turns; ++turn) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Point x = motion.at(points[k]);
      double within = infinite;
      std::uint32_t best = 0;
      model.tree.near(x, within, [&](std::uint32_t j) {
        const double distance = (model.points[j] - x).norm();
        if (distance < within || (distance == within && j < best)) best = j;
        within = std::min(within, distance);
      });
      pairs[k] = {within, {x, model.points[best], model.normals[best]}};
    }
    std::ranges::nth_element(pairs, pairs.begin() + static_cast<std::ptrdiff_t>(part) - 1, {},
                             [](const auto& pair) { return pair.first; });
    rms = 0;
    std::vector<Pair> nearer;
    for (std::size_t k = 0; k < part; ++k) {
      rms += pairs[k].first * pairs[k].first / static_cast<double>(part);
      nearer.push_back(pairs[k].second);
    }
    const auto step = turn < turns ? small_motion(nearer, size) : std::nullopt;
    if (!step) break;
    motion = after(*step, motion);
  }
  return {motion, std::sqrt(rms)};
}

/// The partners of points on the model itself; those on a border beside the point are left out.
Expected<std::vector<Pair>> partners(const RigidMotion& motion, std::span<const Point> points,
                                     const VisibleSearch& search,
                                     std::span<const FitSurface> surfaces, double size) {
  std::vector<Point> now;
  for (const Point& p : points) now.push_back(motion.at(p));
  const auto feet = search.nearest(now, infinite);
  std::vector<Pair> result;
  std::vector<double> distances;
  for (std::size_t k = 0; k < feet.size(); ++k) {
    if (feet[k].surface < 0) continue;
    Parameters<2> at(1, 2);
    at << feet[k].parameters[0], feet[k].parameters[1];
    const auto normal =
        unit_normals(*surfaces[static_cast<std::size_t>(feet[k].surface)].surface, at);
    if (!normal) return std::unexpected(normal.error());
    const Pair pair{now[k], feet[k].point, normal->row(0).transpose()};
    if (beside(pair.x - pair.q, pair.n, search_accuracy * size)) continue;
    result.push_back(pair);
    distances.push_back(std::abs(pair.n.dot(pair.x - pair.q)));
  }
  const double scale = robust_deviation(distances);
  for (std::size_t k = 0; k < result.size(); ++k)
    result[k].weight = tukey_weight(distances[k], scale);
  return result;
}

/// Point to plane, until no point moves by more than rounding.
Expected<Start> settled(RigidMotion motion, std::span<const Point> points, int turns,
                        const VisibleSearch& search, std::span<const FitSurface> surfaces,
                        double size) {
  constexpr double rounding = 1e-13;
  for (int turn = 0;; ++turn) {
    const auto pairs = partners(motion, points, search, surfaces, size);
    if (!pairs) return std::unexpected(pairs.error());
    double squares = 0, total = 0;
    for (const Pair& pair : *pairs) {
      squares += pair.weight * std::pow(pair.n.dot(pair.x - pair.q), 2);
      total += pair.weight;
    }
    // A place at which few points have partners is none, however near these are.
    const double share = total / static_cast<double>(points.size());
    const Start now{motion, total > 0 ? std::sqrt(squares / total) / share : infinite};
    if (turn >= turns) return now;
    const auto step = small_motion(*pairs, size);
    if (!step) return now;
    motion = after(*step, motion);
    if ((step->rotation - Matrix3d::Identity()).norm() < rounding) return now;
  }
}

double rms_of(std::span<const Point> points, const VisibleSearch& search) {
  double squares = 0;
  for (const VisibleFoot& foot : search.nearest(points, infinite))
    squares += foot.distance * foot.distance;
  return std::sqrt(squares / static_cast<double>(points.size()));
}

std::vector<Point> chosen(std::span<const Point> points, double side) {
  std::vector<Point> result;
  for (const std::size_t k : thinned(points, side)) result.push_back(points[k]);
  return result;
}

}  // namespace

double RigidMotion::angle() const {
  return std::abs(Eigen::AngleAxisd(rotation).angle()) * 180 / std::numbers::pi;
}

Expected<Alignment> align(const Scan& scan, const VisibleSearch& search,
                          std::span<const FitSurface> surfaces, const std::vector<bool>& shown) {
  constexpr std::size_t least_points = 10, most_points = 20'000, finalists = 4;
  constexpr int short_run = 12, long_run = 60;
  if (scan.points.size() < least_points)
    return input_error("fewer than ten points cannot be aligned", "data");
  const double size = search.box().diagonal().norm();
  const auto model = samples_of(surfaces, shown, size);
  if (!model) return std::unexpected(model.error());
  if (model->points.empty()) return numerical_error("nothing of the model is visible", "surfaces");
  const std::vector<Point> few = chosen(scan.points, 2.5 * cube_share * size),
                           more = chosen(scan.points, cube_share * size);
  const auto of_scan = frame_of(more), of_model = frame_of(model->points);
  if (!of_scan) return std::unexpected(of_scan.error());
  if (!of_model) return std::unexpected(of_model.error());
  const auto starts = starts_of(*of_scan, *of_model);
  std::vector<Start> found(starts.size());
  detail::parallel_for(
      static_cast<std::ptrdiff_t>(starts.size()), 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k)
          found[k] = improved(starts[k], few, *model, size);
      });
  std::ranges::stable_sort(found, {}, &Start::rms);
  std::optional<Start> best;
  for (std::size_t k = 0; k < std::min(finalists, found.size()); ++k) {
    if (Interruption::asked_for()) return interrupted_error();
    const auto start = settled(found[k].motion, few, short_run, search, surfaces, size);
    if (!start) return std::unexpected(start.error());
    if (!best || start->rms < best->rms) best = *start;
  }
  auto last = settled(best->motion, more, long_run, search, surfaces, size);
  // Noise of all points evens out better than that of some.
  const std::size_t step = (scan.points.size() + most_points - 1) / most_points;
  std::vector<Point> all;
  for (std::size_t k = 0; k < scan.points.size(); k += step) all.push_back(scan.points[k]);
  if (last) last = settled(last->motion, all, short_run, search, surfaces, size);
  if (!last) return std::unexpected(last.error());
  Alignment result{last->motion, rms_of(more, search), 0};
  std::vector<Point> moved;
  for (const Point& p : more) moved.push_back(last->motion.at(p));
  result.rms_after = rms_of(moved, search);
  return result;
}

}  // namespace knead::morph
