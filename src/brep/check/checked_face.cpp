#include "checked_face.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "brep/boundary_curve.hpp"
#include "brep/face_region.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::brep {
namespace {

using Eigen::Vector2d;

constexpr double on_line = 1e-7;           // fractions: a foot so near a knot is on it
constexpr double beside_line = 1e-9;       // fractions: where limits at a knot are taken
constexpr double no_tangent_plane = 1e-9;  // |S_u × S_v| over |S_u|² + |S_v|²
constexpr double least_speed = 1e-5;       // of the width of a surface: derivatives by fractions
constexpr double exact = 1e-9;             // of the size: a foot so near is the foot
constexpr double believed = 1.25;
constexpr double beyond = 0.05;  // of its extent, by which a swept surface goes on past its face

/// A surface at a place, up to second derivatives by fractions of its domain.
struct Jet {
  Point point = Point::Zero(), u = point, v = point, uu = point, uv = point, vv = point;
};

std::optional<Jet> jet_at(const Surface& surface, const Vector2d& fractions) {
  std::array<double, 2> length{};
  Parameters<2> place(1, 2);
  for (int d = 0; d < 2; ++d) {
    const Interval domain = surface.knots(d).domain();
    length[static_cast<std::size_t>(d)] = domain.length();
    place(0, d) =
        std::clamp(domain.lower + fractions[d] * domain.length(), domain.lower, domain.upper);
  }
  const auto jet = evaluate<2>(surface, place, 2);
  if (!jet) return std::nullopt;
  const auto derivative = [&](int i, int j) {
    return Point(std::pow(length[0], i) * std::pow(length[1], j) *
                 jet->at({i, j}).row(0).transpose());
  };
  return Jet{jet->points().row(0).transpose(),
             derivative(1, 0),
             derivative(0, 1),
             derivative(2, 0),
             derivative(1, 1),
             derivative(0, 2)};
}

/// One step of Newton's iteration towards the foot of p, within the domain.
Vector2d closer(const Jet& jet, const Point& p, const Vector2d& at) {
  const Point off = p - jet.point;
  Eigen::Matrix2d hessian;
  hessian << jet.u.dot(jet.u) - off.dot(jet.uu), jet.u.dot(jet.v) - off.dot(jet.uv),
      jet.u.dot(jet.v) - off.dot(jet.uv), jet.v.dot(jet.v) - off.dot(jet.vv);
  const Vector2d gradient(jet.u.dot(off), jet.v.dot(off));
  const double det = hessian.determinant();
  if (!(det > 1e-14 * hessian.squaredNorm())) return at;
  const Vector2d step(hessian(1, 1) * gradient[0] - hessian(0, 1) * gradient[1],
                      hessian(0, 0) * gradient[1] - hessian(1, 0) * gradient[0]);
  return (at + step / det).cwiseMax(0).cwiseMin(1);
}

/// Moves a place that is on a knot line beside it, to the side of a direction.
Vector2d beside_lines(const std::array<std::vector<CheckedSpline::Line>, 2>& lines, Vector2d at,
                      const Vector2d& into) {
  for (int d = 0; d < 2; ++d) {
    for (const auto& line : lines[static_cast<std::size_t>(d)]) {
      if (std::abs(at[d] - line.fraction) > on_line || into[d] == 0) continue;
      at[d] = line.fraction + std::copysign(beside_line, into[d]);
      break;
    }
  }
  return at;
}

/// The direction in parameters to the left of one in space, seen from the tip of the normal; 0
/// where there is no tangent plane.
Vector2d left_of(const Jet& jet, const Point& along) {
  const Point left = jet.u.cross(jet.v).cross(along);
  const double e = jet.u.squaredNorm(), f = jet.u.dot(jet.v), g = jet.v.squaredNorm();
  const double det = e * g - f * f, a = jet.u.dot(left), b = jet.v.dot(left);
  if (!(det > 0)) return Vector2d::Zero();
  return Vector2d(g * a - f * b, e * b - f * a) / det;
}

/// How wide a surface is in each direction: the largest extent of a row of its net.
std::array<double, 2> widths_of(const Surface& surface) {
  const auto [m, n] = surface.net();
  const Points& p = surface.control_points();
  std::array<double, 2> result = {};
  for (int j = 0; j < n; ++j)
    result[0] = std::max(result[0], net_diagonal(p(Eigen::seqN(j, m, n), Eigen::all)));
  for (int i = 0; i < m; ++i)
    result[1] = std::max(result[1], net_diagonal(p(Eigen::seqN(i * n, n), Eigen::all)));
  return result;
}

/// Beside poles and cusps, where a derivative is far smaller than the surface is wide, its
/// direction is rounding.
void bend(FaceFoot& foot, const Jet& jet, const std::array<double, 2>& widths) {
  if (!(jet.u.norm() > least_speed * widths[0] && jet.v.norm() > least_speed * widths[1])) return;
  const Point normal = jet.u.cross(jet.v);
  if (!(normal.norm() > no_tangent_plane * (jet.u.squaredNorm() + jet.v.squaredNorm()))) return;
  foot.normal = normal.normalized();
  const FundamentalForms forms(jet.u, jet.v, jet.uu, jet.uv, jet.vv, foot.normal);
  foot.bending = shape_operator(jet.u, jet.v, forms);
}

/// Where a swept surface has points of a face, in one direction of it.
Expected<Surface> patch_under(const FaceSurface& surface, std::span<const Point> on_it) {
  std::array<Interval, 2> range;
  for (int d = 0; d < 2; ++d) {
    const auto k = static_cast<std::size_t>(d);
    if (const auto whole = surface.whole()[k]) {
      range[k] = *whole;
      continue;
    }
    if (surface.periods()[k] > 0) {
      range[k] = {0, surface.periods()[k]};
      continue;
    }
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Point& p : on_it) {
      const double at = surface.foot(p).parameters[d];
      least = std::min(least, at);
      most = std::max(most, at);
    }
    if (!(most > least)) return input_error("the edges of the face span nothing");
    const double more = beyond * (most - least);
    range[k] = {least - more, most + more};
    if (d == 0) continue;
    if (const auto& pole = surface.poles()[0]) range[k].lower = std::max(range[k].lower, *pole);
    if (const auto& pole = surface.poles()[1]) range[k].upper = std::min(range[k].upper, *pole);
  }
  return surface.patch(range[0], range[1]);
}

}  // namespace

Expected<std::shared_ptr<const CheckedSpline>> CheckedSpline::create(
    std::shared_ptr<const Surface> surface) {
  auto feet = SurfaceFoot::create(*surface);
  if (!feet) return std::unexpected(feet.error());
  auto result = std::make_shared<CheckedSpline>(
      CheckedSpline{surface, *std::move(feet), 0, {}, widths_of(*surface)});
  result->size = net_diagonal(surface->control_points());
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = surface->knots(d);
    const Interval domain = knots.domain();
    for (const int s : knots.spans()) {
      if (!(knots[s] > domain.lower)) continue;
      result->lines[static_cast<std::size_t>(d)].push_back(
          {(knots[s] - domain.lower) / domain.length(),
           knots.multiplicity(knots[s]) >= knots.degree() - 1});
    }
  }
  return result;
}

Expected<CheckedFace> CheckedFace::create(const Model& model, const Face& face,
                                          std::shared_ptr<const CheckedSpline> spline) {
  CheckedFace result;
  if (spline) {
    result.spline_ = std::move(spline);
    return result;
  }
  EdgeSampler edges(model, {under_chord});
  const auto loops = edges.loops(face);
  if (!loops) return std::unexpected(loops.error());
  auto surface = FaceSurface::under(model, face, *loops);
  if (!surface) return std::unexpected(surface.error());
  result.turned_ = surface->turned();
  if (face.support != none) {
    const Support& support = model.supports[face.support];
    if (std::holds_alternative<SweptSurface>(support.form)) {
      std::vector<Point> on_it;
      for (const Loop& loop : *loops) on_it.insert(on_it.end(), loop.begin(), loop.end());
      if (auto patch = patch_under(*surface, on_it)) {
        auto made = CheckedSpline::create(std::make_shared<const Surface>(*std::move(patch)));
        if (made) result.spline_ = *std::move(made);
      }
    }
  }
  result.other_ = std::make_shared<const FaceSurface>(*std::move(surface));
  return result;
}

// The search ends close to the foot; two steps more take it there to rounding. Derivatives are
// those beside a knot line on the side of the face, the point is that of the foot itself.
FaceFoot CheckedFace::spline_foot(const Point& p, const FaceFoot* near, const Point& along,
                                  const std::optional<Side>& side) const {
  const CheckedSpline& spline = *spline_;
  FaceFoot result;
  if (side) {
    result.at = along_side(p, *side, near);
  } else {
    // Beside a pole a descent may end in a minimum that is none of the whole surface: it is
    // believed where it is hardly farther away than the foot before.
    std::optional<Vector2d> hint;
    if (near != nullptr) hint = near->at;
    const double enough =
        std::max(exact * spline.size, near != nullptr ? believed * near->distance : 0);
    result.at = spline.feet.nearest(p, hint, enough).foot.parameters;
    for (int d = 0; d < 2; ++d) result.at[d] = std::clamp(result.at[d], 0.0, 1.0);
  }
  auto jet = jet_at(*spline.surface, result.at);
  for (int k = 0; jet && !side && k < 2; ++k) {
    const Vector2d next = closer(*jet, p, result.at);
    const auto there = jet_at(*spline.surface, next);
    if (!there || !((there->point - p).norm() < (jet->point - p).norm())) break;
    result.at = next;
    jet = there;
  }
  if (!jet) return result;
  result.point = jet->point;
  result.distance = (p - jet->point).norm();
  const Vector2d seen = beside_lines(spline.lines, result.at, left_of(*jet, along));
  if (seen != result.at) jet = jet_at(*spline.surface, seen);
  if (jet) bend(result, *jet, spline.widths);
  return result;
}

// From the foot beside it, if that leads to one hardly farther away; else from that on the whole
// surface, whose search is long where points of a sliver are all as near.
Vector2d CheckedFace::along_side(const Point& p, const Side& side, const FaceFoot* near) const {
  if (near != nullptr) {
    const Vector2d at = slid_along(p, side, near->at);
    const auto jet = jet_at(*spline_->surface, at);
    const double enough = std::max(exact * spline_->size, believed * near->distance);
    if (jet && (jet->point - p).norm() <= enough) return at;
  }
  return slid_along(p, side, spline_->feet.nearest(p, std::nullopt, 0).foot.parameters);
}

Vector2d CheckedFace::slid_along(const Point& p, const Side& side, Vector2d at) const {
  const int other = 1 - side.direction;
  at[side.direction] = side.end;
  for (int k = 0; k < 8; ++k) {
    const auto jet = jet_at(*spline_->surface, at);
    if (!jet) break;
    const Point &first = other == 0 ? jet->u : jet->v, &second = other == 0 ? jet->uu : jet->vv;
    const Point off = p - jet->point;
    const double slope = first.squaredNorm() - off.dot(second);
    const double step = first.dot(off) / (slope > 0 ? slope : first.squaredNorm());
    if (!std::isfinite(step)) break;
    at[other] = std::clamp(at[other] + step, 0.0, 1.0);
    if (std::abs(step) < 1e-14) break;
  }
  return at;
}

std::optional<std::array<CheckedFace::Side, 2>> CheckedFace::seam_at(const Point& p,
                                                                     const Point& along) const {
  if (!spline_) return std::nullopt;
  const double nearest = spline_->feet.nearest(p, std::nullopt, 0).distance;
  for (int d = 0; d < 2; ++d) {
    std::array<Side, 2> both = {{{d, 0}, {d, 1}}};
    const bool meets = std::ranges::all_of(both, [&](const Side& side) {
      const auto jet = jet_at(*spline_->surface, along_side(p, side, nullptr));
      return jet && (jet->point - p).norm() <= 3 * nearest + on_surface * spline_->size;
    });
    if (!meets) continue;
    const auto jet = jet_at(*spline_->surface, along_side(p, both[0], nullptr));
    if (jet && left_of(*jet, along)[d] < 0) std::swap(both[0], both[1]);
    return both;
  }
  return std::nullopt;
}

FaceFoot CheckedFace::other_foot(const Point& p) const {
  FaceFoot result;
  result.at = other_->foot(p).parameters;
  result.normal = other_->normal(result.at);
  result.point = other_->at(result.at);
  // On a cone the parameters are those of the same height: from the foot of the perpendicular.
  const double off = (p - result.point).dot(result.normal);
  if (off != 0) {
    result.at = other_->foot(p - off * result.normal).parameters;
    result.normal = other_->normal(result.at);
    result.point = other_->at(result.at);
  }
  const auto bending = other_->shape_operator(result.at);
  if (bending) result.bending = *bending;
  const bool apex = !bending && bending.error().kind == ErrorKind::numerical;
  if (apex) result.normal.setZero();
  return result;
}

FaceFoot CheckedFace::foot(const Point& p, const FaceFoot* near, const Point& along,
                           const std::optional<Side>& side) const {
  return spline_ ? spline_foot(p, near, along, side) : other_foot(p);
}

const std::array<std::vector<CheckedSpline::Line>, 2>& CheckedFace::lines() const {
  static const std::array<std::vector<CheckedSpline::Line>, 2> none_of_them;
  return spline_ ? spline_->lines : none_of_them;
}

std::array<double, 2> CheckedFace::told(const FaceFoot& foot) const {
  const Vector2d at = spline_ && other_ ? other_->foot(foot.point).parameters : foot.at;
  return {at.x(), at.y()};
}

}  // namespace knead::brep
