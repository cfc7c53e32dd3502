#include "knead/sculpt/active_spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "active_model.hpp"
#include "knead/energy/field_assembler.hpp"

namespace knead {
namespace {

/// Rows and columns of the block moved by `first`, to be one of several on the diagonal.
void add_block(const SparseMatrix& block, int first, std::vector<Eigen::Triplet<double>>& entries) {
  for (Eigen::Index j = 0; j < block.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(block, j); it; ++it) {
      entries.emplace_back(first + static_cast<int>(it.row()), first + static_cast<int>(j), it.value());
    }
  }
}

SparseMatrix block_diagonal(std::vector<SparseMatrix> blocks) {
  if (blocks.size() == 1) return std::move(blocks.front());
  std::vector<Eigen::Triplet<double>> entries;
  int size = 0;
  for (const SparseMatrix& block : blocks) {
    add_block(block, size, entries);
    size += static_cast<int>(block.rows());
  }
  SparseMatrix result(size, size);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

template <int D>
Expected<void> check(const ActiveSettings<D>& s) {
  if (const auto material = validated<D>(s.material); !material) return std::unexpected(material.error());
  for (const MaterialFieldOf<D>& field : s.fields) {
    if (const auto checked = validated<D>(field); !checked) return std::unexpected(checked.error());
  }
  if (!std::isfinite(s.lambda) || s.lambda < 0) {
    return input_error(fmt::format("{} is not a step parameter", s.lambda), "lambda", "use a finite number >= 0");
  }
  if (s.evolution == Evolution::dynamic && !(std::isfinite(s.time_step) && s.time_step > 0)) {
    return input_error(fmt::format("{} is not a time step", s.time_step), "time_step", "use a finite number > 0");
  }
  if (!std::isfinite(s.mass) || s.mass < 0 || (s.evolution == Evolution::dynamic && s.mass == 0)) {
    return input_error(fmt::format("{} is not a mass", s.mass), "mass", "use a finite number > 0");
  }
  if (!std::isfinite(s.damping) || s.damping < 0) {
    return input_error(fmt::format("{} is not a damping", s.damping), "damping", "use a finite number >= 0");
  }
  return {};
}

/// The parts of the energy: stretch has a first derivative in every factor of a term, bend a second.
template <int D>
std::array<Energy<D>, 2> parts(const MaterialOf<D>& material) {
  std::array<Energy<D>, 2> result;
  for (const EnergyTerm<D>& term : stretch_and_bend<D>(material)) {
    int order = 0;
    for (int a : term.a) order += a;
    result[order == 1 ? 0 : 1].push_back(term);
  }
  return result;
}

}  // namespace

template <int D>
Expected<ActiveSpline<D>> ActiveSpline<D>::create(std::vector<Spline<D>> patches, const ActiveSettings<D>& settings) {
  if (auto checked = check<D>(settings); !checked) return std::unexpected(checked.error());
  if (patches.empty()) return usage_error("there is nothing to make active");
  std::vector<int> rows = {0};
  for (const Spline<D>& patch : patches) rows.push_back(rows.back() + patch.size());
  const int size = rows.back();
  if (!settings.fields.empty() && settings.fields.size() != patches.size()) {
    return usage_error(fmt::format("{} materials do not fit {} patches", settings.fields.size(), patches.size()));
  }
  if (!settings.held.empty() && settings.held.size() != static_cast<std::size_t>(size)) {
    return usage_error(
        fmt::format("{} flags of held control points do not fit {} control points", settings.held.size(), size));
  }
  std::vector<DomainScaling<D>> scalings;
  std::vector<ToolLoad<D>> loads;
  std::vector<GrevilleForce<D>> greville;
  std::vector<SparseMatrix> stretch, bend, weight, mass, damping;
  const StiffnessOptions options{settings.method, 0};
  const auto [stretching, bending] = parts<D>(settings.material);
  Points rest(size, 3);
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const Spline<D>& patch = patches[k];
    rest.middleRows(rows[k], patch.size()) = patch.control_points();
    DomainScaling<D> scaling;
    if (!settings.raw) {
      const auto normalised = normalised_scaling<D>(patch);
      if (!normalised) return std::unexpected(normalised.error());
      scaling = k == 0 ? *normalised : in_unit<D>(*normalised, scalings.front().length);
    }
    scalings.push_back(scaling);
    const auto w = Stiffness<D>::create(patch, on_scaled_domain<D>(mass_energy<D>(), scaling.factors), options);
    if (!w) return std::unexpected(w.error());
    weight.push_back(w->assemble());
    if (settings.fields.empty()) {
      for (const auto& [energy, blocks] : {std::pair{&stretching, &stretch}, std::pair{&bending, &bend}}) {
        const auto matrix = Stiffness<D>::create(patch, on_scaled_domain<D>(*energy, scaling.factors), options);
        if (!matrix) return std::unexpected(matrix.error());
        blocks->push_back(matrix->assemble());
      }
      mass.push_back(settings.mass * weight.back());
      damping.push_back(settings.damping * weight.back());
    } else {
      auto matrices = FieldAssembler<D>(patch, options).assemble(settings.fields[k], scaling.factors);
      if (!matrices) return std::unexpected(matrices.error());
      stretch.push_back(std::move(matrices->stretch));
      bend.push_back(std::move(matrices->bend));
      mass.push_back(std::move(matrices->mass));
      damping.push_back(std::move(matrices->damping));
    }
    auto load = ToolLoad<D>::create(patch, scaling,
                                    settings.detail > 0 ? settings.detail : std::numeric_limits<double>::infinity());
    if (!load) return std::unexpected(load.error());
    loads.push_back(std::move(*load));
    if (settings.route == ForceRoute::analytic) {
      auto force = GrevilleForce<D>::create(patch, scaling, options);
      if (!force) return std::unexpected(force.error());
      greville.push_back(std::move(*force));
    }
  }
  const double length = scalings.front().length;
  const Eigen::RowVector3d lower = rest.colwise().minCoeff(), upper = rest.colwise().maxCoeff();
  const Point centre = (lower + 0.5 * (upper - lower)).transpose();

  std::vector<LinearConstraint> constraints = settings.constraints;
  for (LinearConstraint& c : constraints) {
    if (settings.rest == RestMode::none) {  // X is not the displacement, but the displacement and the rest shape
      for (const auto& [unknown, a] : c.terms) {
        if (unknown >= 0 && unknown < size) c.value += a * (rest.row(unknown).transpose() - centre);
      }
    }
    c.value /= length;
  }
  auto space = ConstraintSpace::create(size, constraints, settings.held);
  if (!space) return std::unexpected(space.error());

  SparseMatrix s = block_diagonal(std::move(stretch)), b = block_diagonal(std::move(bend)),
               w = block_diagonal(std::move(weight)), m = block_diagonal(std::move(mass)),
               d = block_diagonal(std::move(damping));
  SparseMatrix k_matrix = s + b, a;
  switch (settings.evolution) {
    case Evolution::stationary:
      a = k_matrix;
      break;
    case Evolution::acm:
      if (settings.weight == StepWeight::mass) {
        a = k_matrix + settings.lambda * w;
      } else {
        SparseMatrix identity(size, size);
        identity.setIdentity();
        a = k_matrix + settings.lambda * identity;
      }
      break;
    case Evolution::dynamic: {
      const double tau = dynamic_stage * settings.time_step;
      a = k_matrix + d / tau + m / (tau * tau);
      break;
    }
  }
  const bool undamped =
      settings.evolution == Evolution::stationary || (settings.evolution == Evolution::acm && settings.lambda == 0);
  if (undamped && space->free_count() > 0) {
    // A displacement of the whole model that no constraint forbids costs nothing: there is no balance to go to.
    const Points constant = Points::Ones(size, 3);
    bool held = false;
    for (int i = 0; i < size && !held; ++i) held = !settings.held.empty() && settings.held[static_cast<std::size_t>(i)];
    if (!held) {
      for (const LinearConstraint& c : constraints) {
        double sum = 0;
        for (const auto& [unknown, coefficient] : c.terms) sum += coefficient;
        held = held || std::abs(sum) > 1e-12;
      }
    }
    if (!held) {
      return numerical_error("nothing holds the model in place, so it has no position of balance", "evolve",
                             "hold an edge or pin points, or use another mode or a positive lambda");
    }
  }
  auto inverse = ConstrainedCholesky::factor(a, std::move(*space));
  if (!inverse) {
    Error error = inverse.error();
    if (undamped && error.kind == ErrorKind::numerical) {
      error.remedy =
          "what is held leaves the model free to move or tilt: hold more, or use another mode or a positive lambda";
    }
    return std::unexpected(error);
  }
  return ActiveSpline(std::make_shared<const Model>(
      Model{settings, std::move(patches), std::move(rows), std::move(scalings), std::move(loads), std::move(greville),
            length, centre, (upper - lower).norm() / length, std::move(rest), std::move(s), std::move(b),
            std::move(k_matrix), std::move(w), std::move(m), std::move(d), std::move(a), std::move(*inverse)}));
}

template <int D>
double ActiveSpline<D>::energy(const ActiveState& state) const {
  return model_->energy(model_->stiffness, (state.control_points - model_->origin(state)) / model_->length);
}

template <int D>
const DomainScaling<D>& ActiveSpline<D>::scaling(int patch) const {
  return model_->scalings[static_cast<std::size_t>(patch)];
}

template <int D>
const ActiveSettings<D>& ActiveSpline<D>::settings() const {
  return model_->settings;
}

template <int D>
const std::vector<int>& ActiveSpline<D>::rows() const {
  return model_->rows;
}

template <int D>
int ActiveSpline<D>::free_count() const {
  return model_->inverse.space().free_count();
}

template class ActiveSpline<1>;
template class ActiveSpline<2>;
template class ActiveSpline<3>;

}  // namespace knead
