#pragma once

#include "foot_search.hpp"
#include "knead/base/error.hpp"
#include "knead/spline/spline.hpp"

namespace knead::detail {

/// One Bézier piece of a surface, rational or not, over [0, 1]², or of a curve (degree q = 0) over
/// [0, 1] × {0}. Its bounds are those of the convex hull of the piece's control points, restricted
/// to the rectangle by de Casteljau's algorithm.
class BezierPatch final : public Patch {
 public:
  using Net = std::vector<Eigen::Vector4d>;

  /// \param net homogeneous control points (wx, wy, wz, w), v fastest, (p + 1)(q + 1) of them, w >
  /// 0
  BezierPatch(int p, int q, Net net, bool rational)
      : Patch({{Range{0, 1}, Range{0, q > 0 ? 1.0 : 0.0}}}),
        p_(p),
        q_(q),
        net_(std::move(net)),
        rational_(rational) {}

  [[nodiscard]] PatchBounds bounds(const ParameterRectangle& at) const override;
  [[nodiscard]] PatchJet jet(double u, double v) const override;
  [[nodiscard]] bool pole(std::size_t side, const std::array<double, 2>& at) const override {
    return at[1 - side] < 1e-6 || at[1 - side] > 1 - 1e-6;
  }

 private:
  int p_, q_;
  Net net_;
  bool rational_;
};

/// All pieces of a surface, span by span, v fastest; coordinates times `scale`. Errors: a Bézier
/// weight that is not positive, named by its span.
[[nodiscard]] Expected<std::vector<std::unique_ptr<Patch>>> bezier_patches(const Surface& surface,
                                                                           const Point& scale);
/// The same for a curve.
[[nodiscard]] Expected<std::vector<std::unique_ptr<Patch>>> bezier_patches(const Curve& curve);

}  // namespace knead::detail
