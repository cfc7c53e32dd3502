#include "knead/sculpt/active_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact_newton.hpp"

namespace knead {

struct ActiveSurface::Model {
  ActiveSettings settings;
  DomainScaling scaling;
  Points origin;  // X = (P − origin) / length
  Point centre;   // positions are computed relative to this point, to keep digits where coordinates are large
  ImplicitEuler euler;
  SurfaceLoad load;

  [[nodiscard]] Points unknown(const Points& control_points) const {
    return (control_points - origin) / scaling.length;
  }
  [[nodiscard]] Points origin_about_centre() const { return (origin.rowwise() - centre.transpose()) / scaling.length; }
  /// Σ Xᵀ K X. K annihilates constants: without their mean the numbers are smaller, and so is the rounding.
  [[nodiscard]] double energy(const Points& x) const {
    const Points y = x.rowwise() - x.colwise().mean();
    return std::max(0.0, y.cwiseProduct(euler.k() * y).sum());
  }
  [[nodiscard]] Tool normalised(Tool tool) const {
    tool.shape.centre = (tool.shape.centre - centre) / scaling.length;
    tool.shape.radius /= scaling.length;
    tool.range /= scaling.length;
    return tool;
  }
};

Expected<ActiveSurface> ActiveSurface::create(const Surface& rest, const ActiveSettings& settings) {
  const auto material = validated(settings.material);
  if (!material) return std::unexpected(material.error());
  if (!settings.fixed.empty() && settings.fixed.size() != static_cast<std::size_t>(rest.size())) {
    return usage_error(fmt::format("{} fixed flags do not fit {} control points", settings.fixed.size(), rest.size()));
  }
  const auto scaling = normalised_scaling(rest);
  if (!scaling) return std::unexpected(scaling.error());

  const StiffnessOptions options{settings.method, 0};
  const auto k =
      Stiffness<2>::create(rest, on_scaled_domain<2>(stretch_and_bend(*material), scaling->factors), options);
  if (!k) return std::unexpected(k.error());
  SparseMatrix weight;
  if (settings.weight == StepWeight::mass) {
    const auto w = Stiffness<2>::create(rest, on_scaled_domain<2>(mass_energy<2>(), scaling->factors), options);
    if (!w) return std::unexpected(w.error());
    weight = w->assemble();
  } else {
    weight.resize(rest.size(), rest.size());
    weight.setIdentity();
  }
  Partition partition = settings.fixed.empty() ? Partition(rest.size()) : Partition(settings.fixed);
  auto euler = ImplicitEuler::create(k->assemble(), weight, settings.lambda, std::move(partition));
  if (!euler) return std::unexpected(euler.error());
  auto load = SurfaceLoad::create(rest, *scaling,
                                  settings.detail > 0 ? settings.detail : std::numeric_limits<double>::infinity());
  if (!load) return std::unexpected(load.error());

  Points origin = rest.control_points();
  const Eigen::RowVector3d lower = origin.colwise().minCoeff(), upper = origin.colwise().maxCoeff();
  const Eigen::RowVector3d centre = lower + 0.5 * (upper - lower);
  if (settings.rest == RestMode::none) origin.rowwise() = centre;  // K annihilates constants
  return ActiveSurface(std::make_shared<const Model>(
      Model{settings, *scaling, std::move(origin), centre.transpose(), std::move(*euler), std::move(*load)}));
}

Expected<ActiveStep> ActiveSurface::step(const Points& control_points, std::span<const Tool> tools) const {
  const Model& m = *model_;
  std::vector<Tool> scaled;
  for (const Tool& tool : tools) scaled.push_back(m.normalised(tool));
  const Points origin = m.origin_about_centre(), before = m.unknown(control_points);
  Points x = before;
  const ContactSummary summary = minimise_step(m.euler, m.load, scaled, origin, x);
  if (!x.allFinite() || !summary.finite) {
    return numerical_error("the step gives no finite result and was refused", "step",
                           "use a larger lambda, a smaller stiffness or larger material coefficients");
  }
  ActiveStep result;
  result.control_points = control_points;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (x(i, c) != before(i, c)) result.control_points(i, c) = m.origin(i, c) + m.scaling.length * x(i, c);
    }
  }
  // Forces at the free control points: of the tools, of the free part of the net, and of the part that is held.
  const Partition& partition = m.euler.partition();
  const Points free_part = partition.free_part(x);
  const Points from_free = partition.gather(m.euler.k() * free_part);
  const Points from_held = partition.gather(m.euler.k() * (x - free_part));
  const Points from_tools = partition.gather(m.load.evaluate(origin + x, scaled).force());
  const double scale = from_tools.norm() + from_free.norm() + from_held.norm();
  result.energy = m.energy(x);
  result.residual = scale > 0 ? (from_tools - from_free - from_held).norm() / scale : 0;
  result.iterations = summary.iterations;
  result.solves = summary.solves;
  result.converged = summary.converged;
  return result;
}

double ActiveSurface::energy(const Points& control_points) const {
  return model_->energy(model_->unknown(control_points));
}

const DomainScaling& ActiveSurface::scaling() const { return model_->scaling; }

const ActiveSettings& ActiveSurface::settings() const { return model_->settings; }

int ActiveSurface::free_count() const { return model_->euler.partition().free_count(); }

}  // namespace knead
