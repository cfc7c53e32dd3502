#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "brep/edge_curve.hpp"
#include "brep/tessellation/parameter_region.hpp"

namespace knead::brep {

/// The parameters of a point on a surface.
struct Foot {
  Eigen::Vector2d parameters = Eigen::Vector2d::Zero();
  /// At a pole: any u is valid. (On a B-spline surface: in either direction.)
  std::array<bool, 2> free = {false, false};
};

/// A surface that faces lie on, with further coordinates, its chart, in which chords may be one
/// unit long.
class ChartedSurface {
 public:
  virtual ~ChartedSurface() = default;

  [[nodiscard]] virtual Point at(const Eigen::Vector2d& uv) const = 0;
  /// Unit normal ∂u × ∂v; at a pole that of the neighbourhood.
  [[nodiscard]] virtual Point normal(const Eigen::Vector2d& uv) const = 0;
  /// Parameters of the point of the surface nearest to p. `near`: those of a point beside it, if
  /// known.
  [[nodiscard]] virtual Foot foot(const Point& p,
                                  const std::optional<Eigen::Vector2d>& near) const = 0;
  /// Those of points one after the other, each beside the one before; none is beside a pole.
  [[nodiscard]] std::vector<Foot> feet(std::span<const Point> points) const {
    std::vector<Foot> result;
    std::optional<Eigen::Vector2d> near;
    for (const Point& p : points) {
      result.push_back(foot(p, near));
      near.reset();
      if (!result.back().free[0] && !result.back().free[1]) near = result.back().parameters;
    }
    return result;
  }
  /// Where it closes on itself, and its poles, in parameters.
  [[nodiscard]] virtual ParameterSpace space() const = 0;

  /// The same surface with its normal on the other side, for sheets of which files do not agree
  /// what their normal is: ∂u × ∂v, or the one away from the axis. Null: there is no doubt.
  [[nodiscard]] virtual std::shared_ptr<const ChartedSurface> other_sense() const {
    return nullptr;
  }

  /// Sets the steps of the chart, such that chords of one step are within the limit.
  virtual void set_steps(ChordLimit chord) = 0;
  [[nodiscard]] virtual Eigen::Vector2d chart(const Eigen::Vector2d& uv) const = 0;
  [[nodiscard]] virtual Eigen::Vector2d from_chart(const Eigen::Vector2d& steps) const = 0;
  /// True for directions along which the surface is straight and its normal constant: chords may
  /// have any length.
  [[nodiscard]] virtual std::array<bool, 2> straight() const = 0;
  [[nodiscard]] bool plane() const { return straight()[0] && straight()[1]; }

 protected:
  ChartedSurface() = default;
  ChartedSurface(const ChartedSurface&) = default;
  ChartedSurface& operator=(const ChartedSurface&) = default;
};

}  // namespace knead::brep
