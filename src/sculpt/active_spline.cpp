#include "knead/sculpt/active_spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact_newton.hpp"
#include "knead/energy/field_assembler.hpp"
#include "knead/spline/extremum.hpp"
#include "patch_potential.hpp"
#include "surface_forces.hpp"

namespace knead {
namespace {

constexpr double run_away = 1e4;  // a step longer than this many sizes of the model is refused
constexpr double first_rigid_stiffness = 1e6;
constexpr double developed_slip = 1e-4;  // friction is fully developed after this way, in lengths of the model
constexpr double limit_stiffness = 1e8;
constexpr double limit_tolerance = 1e-6;
constexpr int max_limit_rounds = 12;
const double stage = 1 - std::sqrt(0.5);  // of a dynamic step

double dot(const Points& a, const Points& b) { return a.cwiseProduct(b).sum(); }

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
struct ActiveSpline<D>::Model {
  ActiveSettings<D> settings;
  std::vector<Spline<D>> patches;
  std::vector<int> rows;
  std::vector<DomainScaling<D>> scalings;
  std::vector<ToolLoad<D>> loads;
  double length;
  Point centre;   // positions are computed relative to this point, to keep digits where coordinates are large
  double extent;  // diagonal of the control points, in units of `length`
  Points rest;
  SparseMatrix stretch, bend, stiffness, weight, mass, damping, a;
  ConstrainedCholesky inverse;

  /// What X is measured from.
  [[nodiscard]] Points origin(const ActiveState& state) const {
    if (settings.rest == RestMode::none) return centre.transpose().replicate(rest.rows(), 1);
    return state.rest.rows() > 0 ? state.rest : rest;
  }
  /// Xᵀ K X. K annihilates constants: without their mean the numbers are smaller, and so is the rounding.
  [[nodiscard]] double energy(const SparseMatrix& matrix, const Points& x) const {
    const Points y = x.rowwise() - x.colwise().mean();
    return std::max(0.0, dot(y, matrix * y));
  }

  Expected<Points> load_of(const ActiveState& state, const ActiveLoads& given) const;
  void report(ActiveStep& result, const Points& x, const Points& external, const PotentialState& contact,
              std::span<const Tool> tools) const;
};

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
  if (!settings.fixed.empty() && settings.fixed.size() != static_cast<std::size_t>(size)) {
    return usage_error(fmt::format("{} fixed flags do not fit {} control points", settings.fixed.size(), size));
  }
  std::vector<DomainScaling<D>> scalings;
  std::vector<ToolLoad<D>> loads;
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
  auto space = ConstraintSpace::create(size, constraints, settings.fixed);
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
      const double tau = stage * settings.time_step;
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
    for (int i = 0; i < size && !held; ++i)
      held = !settings.fixed.empty() && settings.fixed[static_cast<std::size_t>(i)];
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
      Model{settings, std::move(patches), std::move(rows), std::move(scalings), std::move(loads), length, centre,
            (upper - lower).norm() / length, std::move(rest), std::move(s), std::move(b), std::move(k_matrix),
            std::move(w), std::move(m), std::move(d), std::move(a), std::move(*inverse)}));
}

/// G: all forces but those of tools, in normalised units.
template <int D>
Expected<Points> ActiveSpline<D>::Model::load_of(const ActiveState& state, const ActiveLoads& given) const {
  Points g = Points::Zero(rest.rows(), 3);
  // Σ_j ∫ R_i R_j = ∫ R_i, since the basis sums to one: exact.
  const auto everywhere = [this](const Point& f) { return Points(f.transpose().replicate(rest.rows(), 1)); };
  if (given.force != Point::Zero()) g += weight * everywhere(given.force);
  if (given.gravity != Point::Zero()) g += mass * everywhere(given.gravity);
  if (given.nodal.rows() > 0) g += given.nodal;
  if constexpr (D == 2) {
    if (given.pressure != 0 || given.wind != Point::Zero()) {
      for (std::size_t k = 0; k < patches.size(); ++k) {
        const int n = rows[k + 1] - rows[k];
        const Points points = (state.control_points.middleRows(rows[k], n).rowwise() - centre.transpose()) / length;
        const Points velocity =
            state.velocity.rows() > 0 ? Points(state.velocity.middleRows(rows[k], n) / length) : Points(0, 3);
        const auto normal = normal_forces(patches[k], scalings[k], points, velocity, given.pressure, given.wind);
        if (!normal) return std::unexpected(normal.error());
        g.middleRows(rows[k], n) += *normal;
      }
    }
  } else if (given.pressure != 0 || given.wind != Point::Zero()) {
    return input_error("pressure and wind act on surfaces", "load", "use a force or gravity");
  }
  return g;
}

template <int D>
void ActiveSpline<D>::Model::report(ActiveStep& result, const Points& x, const Points& external,
                                    const PotentialState& contact, std::span<const Tool> tools) const {
  const ConstraintSpace& space = inverse.space();
  // Forces on what is free: of tools and loads, of the free part of the net, and of the part that is held.
  Points free_part = x;
  for (int i = 0; i < space.size(); ++i) {
    if (space.is_fixed(i)) free_part.row(i).setZero();
  }
  const Points from_free = stiffness * free_part, from_held = stiffness * (x - free_part);
  const double scale = contact.force.norm() + external.norm() + from_free.norm() + from_held.norm();
  result.residual = scale > 0 ? space.reduce(contact.force + external - from_free - from_held).norm() / scale : 0;
  result.stretch = energy(stretch, x);
  result.bend = energy(bend, x);
  result.energy = energy(stiffness, x);
  result.contact = contact.potential;
  result.gap = contact.entry;
  if (contact.entered >= 0) result.gap_tool = tools[static_cast<std::size_t>(contact.entered)].name;
  result.coarseness = contact.coarseness;
  result.violation = length * space.violation(x);
}

/// The largest |S| of a displacement field. Of volumes the samples alone, 2p + 3 to a span.
template <int D>
double largest_of(const Spline<D>& field) {
  if constexpr (D == 2) return largest_norm(field).value;
  if constexpr (D == 1) {  // as a ruled surface that is constant along its rulings
    Points twice(2 * field.size(), 3);
    std::vector<double> weights;
    for (int i = 0; i < field.size(); ++i) {
      twice.row(2 * i) = twice.row(2 * i + 1) = field.control_points().row(i);
      if (field.rational()) weights.insert(weights.end(), 2, field.weights()[static_cast<std::size_t>(i)]);
    }
    const auto surface = Surface::create({field.knots(0), *KnotVector::clamped_uniform(1, 2)}, twice, weights);
    return surface ? largest_norm(*surface).value : 0;
  }
  if constexpr (D == 3) {
    std::array<std::vector<double>, D> parameters;
    std::array<std::span<const double>, D> spans;
    for (std::size_t d = 0; d < D; ++d) {
      const KnotVector& knots = field.knots()[d];
      const int steps = 2 * knots.degree() + 3;
      for (int span : knots.spans()) {
        const double a = knots[span], b = knots[span + 1];
        for (int k = 0; k <= steps; ++k) parameters[d].push_back(k == steps ? b : a + (b - a) * k / steps);
      }
      spans[d] = parameters[d];
    }
    const auto grid = evaluate_grid<D>(field, spans);
    return grid ? grid->points().rowwise().norm().maxCoeff() : 0;
  }
}

/// The largest |S − S_original| over all patches, for control points that differ by `way`.
template <int D>
double largest_way(const std::vector<Spline<D>>& patches, const std::vector<int>& rows, const Points& way) {
  double largest = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const auto field = patches[k].with_control_points(way.middleRows(rows[k], rows[k + 1] - rows[k]));
    if (field) largest = std::max(largest, largest_of<D>(*field));
  }
  return largest;
}

template <int D>
struct ActiveSpline<D>::Run {
  const Model& m;
  PatchPotential<D>& potential;
  ContactSummary summary = {0, 0, true, true};
  std::string note = {};

  /// One minimisation, with the stiffness of rigid tools raised until nothing enters them any more.
  PotentialState minimise(const StepProblem& problem, Points& y) {
    while (true) {
      const ContactSummary part = minimise_step(problem, potential, y);
      summary.iterations += part.iterations;
      summary.solves += part.solves;
      summary.finite = summary.finite && part.finite && y.allFinite();
      summary.converged = part.converged;
      if (!summary.finite) return {};
      PotentialState contact = potential.evaluate(problem.start + y);
      if (contact.entered < 0 || contact.entry <= rigid_gap) return contact;
      const auto t = static_cast<std::size_t>(contact.entered);
      const Tool& tool = potential.tool(t);
      if (!tool.rigid) return contact;
      if (potential.stiffness(t) >= max_tool_stiffness) {
        summary.converged = false;
        note = fmt::format(
            "tool {} stays entered by {:.2g} of its size: what is held lies inside it, or the net cannot give way",
            tool.name, contact.entry);
        return contact;
      }
      potential.set_stiffness(t, std::min(10 * potential.stiffness(t), max_tool_stiffness));
    }
  }

  /// The same under a limit: it is kept at Gauss points, so between them it is drawn in until it holds everywhere.
  PotentialState minimise(const StepProblem& problem, Points& y, double limit, const Points& original) {
    if (!(limit > 0)) return minimise(problem, y);
    double inner = limit * (1 - 0.5 * limit_tolerance);
    for (int round = 0;; ++round) {
      potential.limit(original, inner, limit_stiffness);
      PotentialState contact = minimise(problem, y);
      if (!summary.finite || !contact.limited) return contact;
      const double way = largest_way<D>(m.patches, m.rows, problem.start + y - original);
      if (way <= limit * (1 + limit_tolerance)) return contact;
      if (round == max_limit_rounds) {
        summary.converged = false;
        note = "the limit is exceeded between the points where it is kept; refine the net";
        return contact;
      }
      inner -= way - limit;
    }
  }
};

template <int D>
Expected<ActiveStep> ActiveSpline<D>::step(const ActiveState& state, std::span<const Tool> tools,
                                           const ActiveLoads& loads) const {
  const Model& m = *model_;
  const bool dynamic = m.settings.evolution == Evolution::dynamic;
  std::vector<ModelTool> scaled;
  for (const Tool& tool : tools) scaled.emplace_back(tool, m.centre, m.length);
  const Points file_origin = m.origin(state);
  const Points before = (state.control_points - file_origin) / m.length;
  const Points origin = (file_origin.rowwise() - m.centre.transpose()) / m.length;
  auto external = m.load_of(state, loads);
  if (!external) return std::unexpected(external.error());

  const Points kx0 = m.stiffness * before;
  StepProblem problem{m.a, m.inverse, *external - kx0, origin + before, 0.5 * dot(before, kx0)};
  PatchPotential<D> potential(m.loads, m.rows, std::move(scaled));
  potential.grip(problem.start, developed_slip);
  for (PointForce point : loads.points) {
    point.to = (point.to - m.centre) / m.length;
    point.core /= m.length;
    potential.add(std::move(point));
  }
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (tools[t].rigid && tools[t].collides()) {
      potential.set_stiffness(t, std::max(tools[t].stiffness, first_rigid_stiffness));
    }
  }
  const Points& original = loads.original.rows() > 0 ? loads.original : m.rest;
  const Points limit_origin = (original.rowwise() - m.centre.transpose()) / m.length;

  Run run{m, potential};
  Points y = m.inverse.space().feasible(before) - before, after;
  PotentialState contact;
  if (!dynamic) {
    contact = run.minimise(problem, y, loads.limit / m.length, limit_origin);
  } else {
    const double tau = stage * m.settings.time_step;
    const Points b = problem.b;
    const Points v0 = state.velocity.rows() > 0 ? Points(state.velocity / m.length) : Points::Zero(y.rows(), 3);
    // What a stage starts from: the step's beginning, then further on along the first stage.
    Points way = Points::Zero(y.rows(), 3), v = v0;
    for (int k = 0; k < 2 && run.summary.finite; ++k) {
      problem.b = b + m.mass * (way / (tau * tau) + v / tau) + m.damping * (way / tau);
      contact = run.minimise(problem, y, loads.limit / m.length, limit_origin);
      after = (y - way) / tau;
      if (k == 0) {
        way = (1 - stage) / stage * y;
        v = v0 + (1 - stage) / stage * (after - v0);
      }
    }
  }
  if (!y.allFinite() || !run.summary.finite) {
    return numerical_error("the step gives no finite result and was refused", "step",
                           "use a larger lambda, a smaller stiffness or larger material coefficients");
  }
  if (const double way = y.rowwise().norm().maxCoeff(); way > run_away * std::max(m.extent, 1e-300)) {
    return numerical_error(
        fmt::format("the step runs away ({:.1e} sizes of the model) and was refused", way / m.extent), "step",
        dynamic ? "use a smaller time_step or smaller loads" : "hold something, use a larger lambda, or smaller loads");
  }
  const Points x = before + y;
  ActiveStep result;
  result.control_points = state.control_points;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (x(i, c) != before(i, c)) result.control_points(i, c) = file_origin(i, c) + m.length * x(i, c);
    }
  }
  if (dynamic) {
    result.kinetic = 0.5 * dot(after, m.mass * after);
    result.velocity = m.length * after;
  }
  m.report(result, x, *external, contact, tools);
  result.limited = contact.limited;
  result.iterations = run.summary.iterations;
  result.solves = run.summary.solves;
  result.converged = run.summary.converged;
  result.note = run.note;
  return result;
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
