#include "face_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "brep/geometry_forms.hpp"

namespace knead::brep {
namespace {

constexpr double turn = 2 * std::numbers::pi;

}  // namespace

Expected<FaceSurface> FaceSurface::create(const Model& model, const Support& support,
                                          std::span<const Point> on_it) {
  if (support.wrong) return std::unexpected(*support.wrong);
  if (std::holds_alternative<ElementarySurface>(support.form))
    return elementary(model, support, on_it);
  if (std::holds_alternative<SweptSurface>(support.form)) return swept(model, support, on_it);
  return model.error(support, "faces on surfaces of this form are not drawn");
}

Expected<FaceSurface> FaceSurface::under(const Model& model, const Face& face, EdgeSampler& edges) {
  const auto loops = edges.loops(face);
  if (!loops) return std::unexpected(loops.error());
  return under(model, face, *loops);
}

Expected<FaceSurface> FaceSurface::under(const Model& model, const Face& face,
                                         std::span<const Loop> loops) {
  std::vector<Point> on_it;
  for (const Loop& loop : loops) on_it.insert(on_it.end(), loop.begin(), loop.end());
  if (face.support != none) return create(model, model.supports[face.support], on_it);
  auto plane = plane_of(on_it);
  if (!plane) return model.error(face, "it has no surface, and its bounds span no plane");
  return *std::move(plane);
}

// Planes, cylinders, cones, spheres and tori in the parametrisations of ISO 10303-42 (clause 4.5,
// elementary_surface): u is the angle around the axis; v the height (of cones along the axis, not
// along the ruling), the latitude, or the angle around the tube. Points of a face say which sheet
// it is on: a cone has two nappes, and a torus with r > R an inner and an outer part
// (degenerate_toroidal_surface).
Expected<FaceSurface> FaceSurface::elementary(const Model& model, const Support& support,
                                              std::span<const Point> on_it) {
  const auto& form = std::get<ElementarySurface>(support.form);
  static_assert(static_cast<int>(ElementarySurface::Kind::torus) == static_cast<int>(Kind::torus));
  const auto kind = static_cast<Kind>(form.kind);
  FaceSurface surface(kind, form.frame);
  surface.radius_ = form.radius;
  surface.minor_ = form.second;
  surface.inner_ = form.inner;
  if (kind != Kind::plane) surface.periods_[0] = turn;
  if (kind == Kind::cone && !surface.find_half_angle(on_it, model.angle_units)) {
    return model.error(support, "its half angle is not below a right angle");
  }
  surface.find_sheet(on_it);
  surface.set_poles();
  surface.set_reach(on_it);
  return surface;
}

Expected<FaceSurface> FaceSurface::swept(const Model& model, const Support& support,
                                         std::span<const Point> on_it) {
  const auto& form = std::get<SweptSurface>(support.form);
  FaceSurface surface(form.revolution ? Kind::revolution : Kind::extrusion, form.frame);
  if (form.revolution) surface.periods_[0] = turn;
  if (auto status = surface.tabulate(model, support, on_it); !status)
    return std::unexpected(std::move(status.error()));
  surface.set_poles();
  surface.set_reach(on_it);
  return surface;
}

// The largest radius that the face can have around its axis, by which chords around it are divided.
void FaceSurface::set_reach(std::span<const Point> on_it) {
  reach_ = kind_ == Kind::torus ? radius_ + std::abs(minor_) : radius_;
  for (const auto& q : samples_) reach_ = std::max(reach_, std::abs(q.x()));
  if (kind_ != Kind::cone && kind_ != Kind::revolution) return;
  for (const Point& p : on_it) {
    const Point d = p - frame_.origin;
    reach_ = std::max(reach_, (d - d.dot(frame_.z) * frame_.z).norm());
  }
}

// Newell's normal: the area vector of a polygon, which is exact for a plane one and an average for
// one that is not quite.
std::optional<FaceSurface> FaceSurface::plane_of(std::span<const Point> loop) {
  const Point normal = newell_normal(loop);
  if (!(normal.norm() > 0)) return std::nullopt;
  Point middle = Point::Zero();
  for (const Point& p : loop) middle += p / static_cast<double>(loop.size());
  Frame frame{middle};
  frame.z = normal.normalized();
  frame.x = frame.z.unitOrthogonal();
  frame.y = frame.z.cross(frame.x);
  return FaceSurface(Kind::plane, frame);
}

// Where parallels shrink to points: a sphere's at ±π/2, a cone's apex at v = −R/tan α, the
// crossings of a spindle torus with its axis at cos v = −R/r, ends of a profile on the axis.
void FaceSurface::set_poles() {
  constexpr double quarter = turn / 4;
  if (kind_ == Kind::sphere) poles_ = {-quarter, quarter};
  if (kind_ == Kind::cone) {
    const double apex = -radius_ / minor_;
    poles_[(minor_ > 0) != inner_ ? 0 : 1] = apex;
  }
  if (kind_ == Kind::torus) {
    if (minor_ <= radius_) {
      periods_[1] = turn;
    } else {
      const double v = std::acos(-radius_ / minor_);
      poles_ = inner_ ? std::array<std::optional<double>, 2>{v, turn - v}
                      : std::array<std::optional<double>, 2>{-v, v};
    }
  }
  if (kind_ == Kind::revolution) {
    double size = 0;
    for (const auto& q : samples_) size = std::max(size, std::abs(q.x()));
    if (!(periods_[1] > 0)) {
      if (std::abs(samples_.front().x()) <= 1e-6 * size) poles_[0] = sample_parameters_.front();
      if (std::abs(samples_.back().x()) <= 1e-6 * size) poles_[1] = sample_parameters_.back();
    }
  }
}

Point FaceSurface::at(const Eigen::Vector2d& uv) const {
  const double u = uv.x(), v = uv.y();
  const auto& [origin, x, y, z] = frame_;
  switch (kind_) {
    case Kind::plane:
      return origin + u * x + v * y;
    case Kind::cylinder:
      return origin + radius_ * around(u) + v * z;
    case Kind::cone:
      return origin + (radius_ + v * minor_) * around(u) + v * z;
    case Kind::sphere:
      return origin + radius_ * std::cos(v) * around(u) + radius_ * std::sin(v) * z;
    case Kind::torus:
      return origin + (radius_ + minor_ * std::cos(v)) * around(u) + minor_ * std::sin(v) * z;
    case Kind::revolution: {
      const Point d = profile_->at(v) - origin;
      return origin + std::cos(u) * d + (1 - std::cos(u)) * d.dot(z) * z + std::sin(u) * z.cross(d);
    }
    case Kind::extrusion:
      return profile_->at(u) + v * z;
  }
  return origin;
}

Point FaceSurface::normal(const Eigen::Vector2d& uv) const {
  const double u = uv.x(), v = uv.y();
  const Point& z = frame_.z;
  // On an inner sheet the distance from the axis, R + v tan α or R + r cos v, is negative, and
  // turns ∂u × ∂v around.
  const double side = inner_ != mirrored_ ? -1 : 1;
  switch (kind_) {
    case Kind::plane:
      return z;
    case Kind::cylinder:
      return around(u);
    case Kind::cone:
      return side * (around(u) - minor_ * z).normalized();
    case Kind::sphere:
    case Kind::torus:
      return side * (std::cos(v) * around(u) + std::sin(v) * z);
    case Kind::extrusion: {
      const Point n = profile_->derivative(u).cross(z);
      return n.norm() > 0 ? Point(n.normalized()) : frame_.x;
    }
    case Kind::revolution:
      break;
  }
  // ∂u = z × d, turned by u; both turned by u.
  for (const double w : {v, v + 1e-4 * range_.length(), v - 1e-4 * range_.length()}) {
    const Point across = z.cross(profile_->at(w) - frame_.origin);
    const Point n = across.cross(profile_->derivative(w));
    if (n.norm() > 1e-9 * across.norm() * profile_->derivative(w).norm() && across.norm() > 0) {
      return Eigen::AngleAxisd(u, z) * n.normalized();
    }
  }
  return z;
}

ParameterSpace FaceSurface::space() const {
  ParameterSpace space;
  space.periods = periods_;
  space.poles[1] = poles_;
  return space;
}

// The parameters of a point on the surface. Closed formulas, but for profiles (`nearest`); they are
// those of points on the surface, and of others near the nearest. On a cone v is the height of p
// itself, not of its foot. Where p is on the axis u is free.
Foot FaceSurface::foot(const Point& p, const std::optional<Eigen::Vector2d>& /*near*/) const {
  const Point d = p - frame_.origin;
  const double x = d.dot(frame_.x), y = d.dot(frame_.y), z = d.dot(frame_.z);
  if (kind_ == Kind::plane) return {{x, y}};
  if (kind_ == Kind::extrusion) {
    const double u = nearest(section(p));
    return {{u, (p - profile_->at(u)).dot(frame_.z)}};
  }
  const double rho = std::hypot(x, y);
  Foot foot{{std::atan2(y, x), z}};
  double& u = foot.parameters.x();
  double& v = foot.parameters.y();
  double size = radius_;
  if (kind_ == Kind::cone) {
    size = std::max(radius_, std::abs(z * minor_));
  } else if (kind_ == Kind::sphere) {
    v = std::atan2(z, rho);
  } else if (kind_ == Kind::torus) {
    size = radius_ + minor_;
    v = std::atan2(z, (inner_ ? -rho : rho) - radius_);
    if (inner_ && v < 0) v += turn;
  } else if (kind_ == Kind::revolution) {
    v = nearest({rho, z});
    const Point q = profile_->at(v) - frame_.origin;
    // u counts from the profile, which need not lie in the plane of x and z.
    u -= std::atan2(q.dot(frame_.y), q.dot(frame_.x));
    size = std::max(rho, std::hypot(q.dot(frame_.x), q.dot(frame_.y)));
    for (const auto& s : samples_) size = std::max(size, std::abs(s.x()));
  }
  if (inner_) u += turn / 2;
  // Of a curve that ends near the axis, whatever `set_poles` takes for a pole.
  foot.free[0] = rho <= (kind_ == Kind::revolution ? 1e-6 : 1e-7) * size;
  return foot;
}

std::array<bool, 2> FaceSurface::straight() const {
  switch (kind_) {
    case Kind::plane:
      return {true, true};
    case Kind::cylinder:
    case Kind::cone:
      return {false, true};
    case Kind::sphere:
    case Kind::torus:
      return {false, false};
    case Kind::revolution:
      return {false, profile_->straight() && !(waist_ > 0)};
    case Kind::extrusion:
      return {profile_->straight(), true};
  }
  return {false, false};
}

// A step is a length of the parameter over which a chord misses the surface by the limit at most:
// along u an angle, evenly, along profiles wherever they are divided. Charts count these steps: in
// them a unit square is a cell that may be two triangles.
void FaceSurface::set_steps(ChordLimit chord) {
  const auto step = [chord](double radius) {
    return turn / std::ceil(turn / chord_angle(chord.of(radius)));
  };
  angle_steps_ = {step(reach_), step(kind_ == Kind::torus ? std::abs(minor_) : reach_)};
  if (profile_) steps_ = profile_->subdivided(range_.lower, range_.upper, chord);
  if (waist_ > 0) {
    // Rulings that are not parallel: a cell of a by b deviates from its surface by up to a b / 4 at
    // the waist.
    const double pieces =
        std::clamp(std::ceil(2 * range_.length() / (waist_ * angle_steps_[0])), 1.0, 1000.0);
    steps_.clear();
    for (double k = 0; k <= pieces; ++k)
      steps_.push_back(range_.lower + range_.length() * k / pieces);
  }
}

namespace {

// Piecewise linear between whole steps, extrapolated from the outermost ones.
double steps_at(const std::vector<double>& steps, double t) {
  auto k = std::upper_bound(steps.begin() + 1, steps.end() - 1, t) - steps.begin() - 1;
  const auto i = static_cast<std::size_t>(k);
  return static_cast<double>(k) + (t - steps[i]) / (steps[i + 1] - steps[i]);
}

double parameter_at(const std::vector<double>& steps, double s) {
  const auto last = static_cast<double>(steps.size() - 2);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(s), 0.0, last));
  return steps[i] + (s - static_cast<double>(i)) * (steps[i + 1] - steps[i]);
}

}  // namespace

Eigen::Vector2d FaceSurface::chart(const Eigen::Vector2d& uv) const {
  switch (kind_) {
    case Kind::plane:
      return uv;
    case Kind::cylinder:
    case Kind::cone:
      return {uv.x() / angle_steps_[0], uv.y()};
    case Kind::sphere:
    case Kind::torus:
      return {uv.x() / angle_steps_[0], uv.y() / angle_steps_[1]};
    case Kind::revolution:
      return {uv.x() / angle_steps_[0], steps_at(steps_, uv.y())};
    case Kind::extrusion:
      return {steps_at(steps_, uv.x()), uv.y()};
  }
  return uv;
}

Eigen::Vector2d FaceSurface::from_chart(const Eigen::Vector2d& steps) const {
  switch (kind_) {
    case Kind::plane:
      return steps;
    case Kind::cylinder:
    case Kind::cone:
      return {steps.x() * angle_steps_[0], steps.y()};
    case Kind::sphere:
    case Kind::torus:
      return {steps.x() * angle_steps_[0], steps.y() * angle_steps_[1]};
    case Kind::revolution:
      return {steps.x() * angle_steps_[0], parameter_at(steps_, steps.y())};
    case Kind::extrusion:
      return {parameter_at(steps_, steps.x()), steps.y()};
  }
  return steps;
}

}  // namespace knead::brep
