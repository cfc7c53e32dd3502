#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "brep/face_loops.hpp"
#include "charted_surface.hpp"
#include "knead/spline/curvature.hpp"

namespace knead::brep {

/// A surface of a model that is not a B-spline: an elementary or a swept one, parametrised as in
/// ISO 10303-42, except that the u of an extrusion and the v of a revolution are those of the swept
/// curve.
class FaceSurface final : public ChartedSurface {
 public:
  /// \param on_it points of the edges of the face: they determine how much of an unbounded swept
  /// curve is needed, and
  ///   the unit of a cone's angle (the one of the model's `angle_units` that brings the cone
  ///   closest to these points)
  /// Errors (input): another form, or an incomplete one.
  [[nodiscard]] static Expected<FaceSurface> create(const Model& model, const Support& support,
                                                    std::span<const Point> on_it);
  /// Of a face, by its loops; of one without surface the plane of these.
  [[nodiscard]] static Expected<FaceSurface> under(const Model& model, const Face& face,
                                                   EdgeSampler& edges);
  [[nodiscard]] static Expected<FaceSurface> under(const Model& model, const Face& face,
                                                   std::span<const Loop> loops);
  /// For a face without surface (FACE with a POLY_LOOP): the plane of the loop by Newell's normal.
  [[nodiscard]] static std::optional<FaceSurface> plane_of(std::span<const Point> loop);

  [[nodiscard]] Point at(const Eigen::Vector2d& uv) const override;
  [[nodiscard]] Point normal(const Eigen::Vector2d& uv) const override;
  /// By the B-spline surface that is the same about the point (`patch`); its normal is `normal`.
  /// Errors: no tangent plane there, as at a pole (numerical); those of `patch`.
  [[nodiscard]] Expected<SurfaceCurvature> curvature(const Eigen::Vector2d& uv) const;
  /// How it bends, by its `normal`: in closed form, on swept curves by `curvature`. Errors: no
  /// tangent plane there, as at an apex or a pole (numerical); those of `patch`.
  [[nodiscard]] Expected<Eigen::Matrix3d> shape_operator(const Eigen::Vector2d& uv) const;
  /// In closed form; on swept curves by a search and Newton's iteration. A point beside it is not
  /// needed.
  [[nodiscard]] Foot foot(const Point& p,
                          const std::optional<Eigen::Vector2d>& near = {}) const override;
  [[nodiscard]] ParameterSpace space() const override;
  /// Of the far nappe of a cone and the inner part of a torus that crosses its axis.
  [[nodiscard]] std::shared_ptr<const ChartedSurface> other_sense() const override;

  /// Length of one turn in u, in v; 0 where it is not closed.
  [[nodiscard]] const std::array<double, 2>& periods() const { return periods_; }
  /// The lower and upper limits of v, at which the surface is a single point for all u.
  [[nodiscard]] const std::array<std::optional<double>, 2>& poles() const { return poles_; }

  /// The largest distance from the axis of the surface, or of those of its points that were given.
  [[nodiscard]] double reach() const { return reach_; }

  /// The domain of a direction that `patch` covers as a whole, as it is that of a spline; none
  /// elsewhere.
  [[nodiscard]] std::array<std::optional<Interval>, 2> whole() const;
  /// The swept curve is a TRIMMED_CURVE against the curve that it trims: `normal` is then the
  /// opposite of the file's.
  [[nodiscard]] bool turned() const { return profile_ && profile_->turned(); }
  /// Turns the parameters of a plane so that u runs along a direction; others stay.
  void align(const Point& direction);
  /// The part of the surface over [u] × [v] as a B-spline surface, on the same parameters up to its
  /// speed along arcs, so that S_u × S_v points where `normal` does. Exact but for rounding: planes
  /// bilinear; arcs rational quadratic, in parts of at most a quarter (Piegl & Tiller, The NURBS
  /// Book, 7.3, 8.3 and 8.5). The range must not go beyond a pole or a turn; where `whole` has a
  /// domain it must be that.
  [[nodiscard]] Expected<Surface> patch(const Interval& u, const Interval& v) const;

  /// The limit's share is that of the radius (for swept curves: of half their extent). In straight
  /// directions the chart is the parameter.
  void set_steps(ChordLimit chord) override;
  [[nodiscard]] Eigen::Vector2d chart(const Eigen::Vector2d& uv) const override;
  [[nodiscard]] Eigen::Vector2d from_chart(const Eigen::Vector2d& steps) const override;
  [[nodiscard]] std::array<bool, 2> straight() const override;

 private:
  /// Those of `ElementarySurface` first.
  enum class Kind { plane, cylinder, cone, sphere, torus, revolution, extrusion };
  FaceSurface(Kind kind, Frame frame) : kind_(kind), frame_(frame) {}

  [[nodiscard]] Point around(double u) const {
    return std::cos(u) * frame_.x + std::sin(u) * frame_.y;
  }
  [[nodiscard]] static Expected<FaceSurface> elementary(const Model& model, const Support& support,
                                                        std::span<const Point> on_it);
  [[nodiscard]] static Expected<FaceSurface> swept(const Model& model, const Support& support,
                                                   std::span<const Point> on_it);
  [[nodiscard]] bool find_half_angle(std::span<const Point> on_it,
                                     std::span<const double> angle_units);
  void find_sheet(std::span<const Point> on_it);
  void set_poles();
  void set_reach(std::span<const Point> on_it);
  [[nodiscard]] Expected<void> tabulate(const Model& model, const Support& support,
                                        std::span<const Point> on_it);
  [[nodiscard]] Expected<void> find_range(const Model& model, const Support& support,
                                          std::span<const Point> on_it);
  [[nodiscard]] Expected<void> end_at_axis(const Model& model, const Support& support,
                                           std::span<const Point> on_it);
  void find_side();
  void sample_profile();
  void keep_one_side();
  [[nodiscard]] Eigen::Vector2d section(const Point& p) const;
  [[nodiscard]] double nearest(const Eigen::Vector2d& q) const;

  Kind kind_;
  Frame frame_;
  double
      radius_ = 0,
      minor_ =
          0;  // minor: of a cone the tangent of its half angle; of an extrusion the length of v = 1
  bool inner_ = false;  // the nappe of a cone, the part of a torus, on which the distance from the
                        // axis is negative
  bool mirrored_ = false;  // u runs the other way: `other_sense`
  std::optional<EdgeCurve> profile_;
  Interval range_ = {};         // of the profile
  double waist_ = 0;            // of the hyperboloid swept by a skew line: its smallest radius
  bool one_side_ = false;       // only the part of the profile on the positive side of the axis
  Point side_ = Point::Zero();  // that side
  std::vector<double> sample_parameters_;  // fine samples of the profile: for `nearest`
  std::vector<Eigen::Vector2d> samples_;
  std::vector<double> steps_;  // parameters of whole steps along the profile
  double reach_ = 0;           // the largest distance from the axis
  std::array<double, 2> angle_steps_ = {1, 1};
  std::array<double, 2> periods_ = {0, 0};
  std::array<std::optional<double>, 2> poles_ = {};
};

/// Of the edges that tell which part of a swept surface a face needs (`FaceSurface::under`).
inline constexpr double under_chord = 1e-2;

}  // namespace knead::brep
