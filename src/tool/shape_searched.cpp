#include "searched_solid.hpp"

#include <cmath>

#include "distance_jet.hpp"
#include "separable_patch.hpp"

namespace knead::detail {
namespace {

using Vector2 = Eigen::Vector2d;

constexpr ParameterRectangle whole = {{Range{0, 1}, Range{0, 1}}};
constexpr ParameterRectangle meridian_only = {{Range{0, 1}, Range{0, 0}}};

constexpr std::array<bool, 2> both_halves = {false, true};

/// Adds the patches swept by a meridian curve over the first quarter of the superellipse of
/// exponent e.
/// Solids without a closed formula for their nearest point: superquadrics, and boxes and solids of
/// revolution that are scaled differently along their axes. By symmetry one octant is searched, as
/// patches that are products of monotone curves (`SeparablePatch`), whose derivatives have tight
/// bounds for `FootSearch`; arcs of superellipses are cut in halves, so that the parameter of each
/// is regular. Inside or outside is told by the implicit equation, exactly, and not by normals,
/// which superquadrics lack along their edges.
void sweep(Patches& patches, const MonotoneCurve& meridian, double e, const Point& scale,
           bool round = false) {
  if (round) {
    const MonotoneCurve start = MonotoneCurve::arc(Vector2::Zero(), Vector2::Ones(), 1, false);
    patches.push_back(std::make_unique<SeparablePatch>(meridian_only, meridian, start, scale));
    return;
  }
  for (bool exchanged : both_halves) {
    const MonotoneCurve parallel =
        MonotoneCurve::arc(Vector2::Zero(), Vector2::Ones(), e, exchanged);
    patches.push_back(std::make_unique<SeparablePatch>(whole, meridian, parallel, scale));
  }
}

bool in_superellipse(double x, double y, double e) {
  if (std::max(std::abs(x), std::abs(y)) > 1) return false;
  const double p = 2 / e;
  return std::pow(std::abs(x), p) + std::pow(std::abs(y), p) <= 1;
}

/// (|x|^p + |y|^p)^(1/p), p = 2/e, without overflow.
double superellipse_norm(double x, double y, double e) {
  const double a = std::max(std::abs(x), std::abs(y)), b = std::min(std::abs(x), std::abs(y));
  return a == 0 ? 0 : a * std::pow(1 + std::pow(b / a, 2 / e), e / 2);
}

/// x / scale.
bool in_superellipsoid(const SuperellipsoidShape& s, const Point& x) {
  const auto& a = s.semi_axes;
  if (std::abs(x.z()) > a[2]) return false;
  return in_superellipse(superellipse_norm(x.x() / a[0], x.y() / a[1], s.e2), x.z() / a[2], s.e1);
}

bool in_supertoroid(const SupertoroidShape& s, const Point& x) {
  return in_superellipse((superellipse_norm(x.x(), x.y(), s.e2) - s.major) / s.semi_axes[0],
                         x.z() / s.semi_axes[1], s.e1);
}

}  // namespace

bool is_outside(const PlacedShape& placed, const Point& x) {
  const auto stored = [&] {
    const Placement& at = placed.placement();
    const Point y = at.rotation.conjugate() * (x - at.position);
    return Point(y.x() / at.scale[0], y.y() / at.scale[1], y.z() / at.scale[2]);
  };
  if (const auto* s = std::get_if<SuperellipsoidShape>(&placed.shape()))
    return !in_superellipsoid(*s, stored());
  if (const auto* s = std::get_if<SupertoroidShape>(&placed.shape()))
    return !in_supertoroid(*s, stored());
  return false;
}

Kernel scaled_revolution_kernel(const Shape& shape, const Meridian& pieces, const Point& scale) {
  const bool round = scale.x() == scale.y();
  Patches patches;
  for (const MeridianPiece& piece : pieces) {
    if (piece.kind == MeridianPiece::Kind::segment) {
      sweep(patches, MonotoneCurve::segment(piece.a, piece.b), 1, scale, round);
    } else {
      for (bool exchanged : both_halves) {
        sweep(patches, MonotoneCurve::arc(piece.a, piece.b, 1, exchanged), 1, scale, round);
      }
    }
  }
  const Kernel plain = revolution_kernel(shape, pieces);
  const BoundingBox extent = {plain->box.lower.cwiseProduct(scale),
                              plain->box.upper.cwiseProduct(scale)};
  const auto inside = [shape, scale](const Point& x) {
    const Point y = x.cwiseQuotient(scale);
    return in_meridian(shape, std::hypot(y.x(), y.y()), y.z());
  };
  return std::make_unique<SearchedSolid>(
      std::move(patches), inside, std::array<bool, 3>{!round, !round, false}, round, extent, 0.0);
}

Kernel scaled_box_kernel(const BoxShape& shape, const Point& scale) {
  const Point half(shape.half_sizes[0], shape.half_sizes[1], shape.half_sizes[2]);
  const Point core = ((half.array() - shape.rounding).max(0.0)).matrix().cwiseProduct(scale);
  const Point reach = shape.rounding * scale, outer = core + reach;
  const auto up = MonotoneCurve::segment(Vector2(1, 0), Vector2(1, 1)),
             across = MonotoneCurve::segment(Vector2(0, 1), Vector2(1, 1));
  Patches patches;
  for (int a = 0; a < 3; ++a) {
    const std::array<int, 3> axes = {a, (a + 1) % 3, (a + 2) % 3};
    const auto [i, j, k] = axes;
    // The face x_j = outer_j over the core's x_i and x_k, and the edge along x_k.
    if (core[i] > 0 && core[k] > 0) {
      patches.push_back(std::make_unique<SeparablePatch>(
          whole, up, across, Point(core[i], outer[j], core[k]), Point::Zero(), axes));
    }
    for (bool exchanged : both_halves) {
      if (core[k] == 0) break;
      const auto arc = MonotoneCurve::arc(Vector2::Zero(), Vector2::Ones(), 1, exchanged);
      patches.push_back(std::make_unique<SeparablePatch>(
          whole, up, arc, Point(reach[i], reach[j], core[k]), Point(core[i], core[j], 0), axes));
    }
  }
  for (bool one : both_halves) {
    for (bool other : both_halves) {
      const auto arc = MonotoneCurve::arc(Vector2::Zero(), Vector2::Ones(), 1, one);
      const auto round = MonotoneCurve::arc(Vector2::Zero(), Vector2::Ones(), 1, other);
      patches.push_back(std::make_unique<SeparablePatch>(whole, arc, round, reach, core));
    }
  }
  const auto inside = [core, reach](const Point& x) {
    return (x.cwiseAbs() - core).cwiseMax(0.0).cwiseQuotient(reach).squaredNorm() <= 1;
  };
  return std::make_unique<SearchedSolid>(std::move(patches), inside,
                                         std::array<bool, 3>{true, true, true}, false,
                                         BoundingBox{-outer, outer}, outer.minCoeff());
}

Kernel superellipsoid_kernel(const SuperellipsoidShape& s, const Point& scale) {
  const Point a(s.semi_axes[0] * scale.x(), s.semi_axes[1] * scale.y(), s.semi_axes[2] * scale.z());
  Patches patches;
  for (bool exchanged : both_halves) {
    sweep(patches, MonotoneCurve::arc(Vector2::Zero(), Vector2::Ones(), s.e1, exchanged), s.e2, a);
  }
  const auto inside = [a, e1 = s.e1, e2 = s.e2](const Point& x) {
    return in_superellipse(superellipse_norm(x.x() / a.x(), x.y() / a.y(), e2), x.z() / a.z(), e1);
  };
  return std::make_unique<SearchedSolid>(std::move(patches), inside,
                                         std::array<bool, 3>{true, true, true}, false,
                                         BoundingBox{-a, a}, a.minCoeff());
}

Kernel supertoroid_kernel(const SupertoroidShape& s, const Point& scale) {
  const bool round = scale.x() == scale.y() && s.e2 == 1;
  Patches patches;
  for (double side : {1.0, -1.0}) {
    for (bool exchanged : both_halves) {
      const Vector2 tube(side * s.semi_axes[0], s.semi_axes[1]);
      sweep(patches, MonotoneCurve::arc(Vector2(s.major, 0), tube, s.e1, exchanged), s.e2, scale,
            round);
    }
  }
  const auto inside = [s, scale](const Point& x) {
    return in_supertoroid(s, x.cwiseQuotient(scale));
  };
  const Point outer(scale.x() * (s.major + s.semi_axes[0]), scale.y() * (s.major + s.semi_axes[0]),
                    scale.z() * s.semi_axes[1]);
  const double feature =
      std::min({scale.x() * s.semi_axes[0], scale.y() * s.semi_axes[0], outer.z()});
  return std::make_unique<SearchedSolid>(std::move(patches), inside,
                                         std::array<bool, 3>{!round, !round, true}, round,
                                         BoundingBox{-outer, outer}, feature);
}

}  // namespace knead::detail
