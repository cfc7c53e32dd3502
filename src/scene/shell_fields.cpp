#include "shell_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "places.hpp"
#include "scene/model/shell_model.hpp"

namespace knead {

Expected<std::optional<ShellPointResults>> read_shell(const Scene& scene, int surface,
                                                      const Fractions& at) {
  const SceneSurface& s = scene.surfaces[static_cast<std::size_t>(surface)];
  const auto* shell = std::get_if<ShellMaterial>(&s.elasticity);
  if (shell == nullptr) return std::optional<ShellPointResults>();
  const auto u = parameters_at(*s.current, at);
  if (!u) return std::unexpected(u.error());
  const auto results = shell_results(*s.rest, *s.current, *shell,
                                     (Parameters<2>(1, 2) << (*u)[0], (*u)[1]).finished());
  if (!results) return std::unexpected(results.error());
  return std::optional(results->front());
}

namespace {

GridField vectors(const std::string& name, const Points& x) {
  return {name, 3, {x.data(), x.data() + x.size()}};
}

/// The same spline with other control points, at parameters.
Expected<Points> values_at(const Surface& like, const Points& coefficients,
                           const Parameters<2>& at) {
  const auto field =
      Surface::create(like.knots(), coefficients, {like.weights().begin(), like.weights().end()});
  if (!field) return std::unexpected(field.error());
  const auto values = evaluate<2>(*field, at);
  if (!values) return std::unexpected(values.error());
  return Points(values->points());
}

void append_results(const std::vector<ShellPointResults>& results, std::vector<GridField>& fields) {
  GridField membrane{"membrane", 2, {}}, moment{"moment", 2, {}}, von_mises{"von_mises", 2, {}},
      bending{"bending_strain", 1, {}};
  for (const ShellPointResults& r : results) {
    membrane.values.insert(membrane.values.end(), r.membrane.begin(), r.membrane.end());
    moment.values.insert(moment.values.end(), r.moment.begin(), r.moment.end());
    von_mises.values.insert(von_mises.values.end(), r.von_mises.begin(), r.von_mises.end());
    bending.values.push_back(r.bending_strain);
  }
  for (GridField* field : {&membrane, &moment, &von_mises, &bending})
    fields.push_back(std::move(*field));
}

}  // namespace

Expected<FieldGrid> result_grid(const SceneSurface& s, int samples,
                                std::span<const std::pair<std::string, Points>> shapes) {
  if (samples < 2)
    return input_error(fmt::format("{} samples make no grid", samples), "samples", "use 2 or more");
  const Interval u = s.current->knots(0).domain(), v = s.current->knots(1).domain();
  Parameters<2> at(static_cast<Eigen::Index>(samples) * samples, 2);
  for (int i = 0; i < samples; ++i) {
    for (int j = 0; j < samples; ++j) {
      const double a = static_cast<double>(i) / (samples - 1),
                   b = static_cast<double>(j) / (samples - 1);
      at.row(static_cast<Eigen::Index>(i) * samples + j) << std::lerp(u.lower, u.upper, a),
          std::lerp(v.lower, v.upper, b);
    }
  }
  const auto now = evaluate<2>(*s.current, at), rest = evaluate<2>(*s.rest, at);
  if (!now) return std::unexpected(now.error());
  if (!rest) return std::unexpected(rest.error());
  FieldGrid grid{s.id, {samples, samples}, now->points(), {}};
  grid.fields.push_back(vectors("displacement", now->points() - rest->points()));
  if (const auto* shell = std::get_if<ShellMaterial>(&s.elasticity)) {
    const auto results = shell_results(*s.rest, *s.current, *shell, at);
    if (!results) return std::unexpected(results.error());
    append_results(*results, grid.fields);
  }
  for (const auto& [name, shape] : shapes) {
    const auto values = values_at(*s.current, shape, at);
    if (!values) return std::unexpected(values.error());
    grid.fields.push_back(vectors(name, *values));
  }
  return grid;
}

// At equilibrium ∇E(x) − f = Cᵀ λ: what is out of balance at a control point is carried by what
// holds it. A control point counts once, for the first constraint that contains it, so that the sum
// of all reactions is the negative of all loads. Where the shape is not in equilibrium the
// difference includes the forces that would still move it.
Expected<std::vector<HoldReaction>> hold_reactions(const Scene& scene) {
  const auto problem = shell_problem(scene);
  if (!problem) return std::unexpected(problem.error());
  const Points& x = problem->present;
  Points reactions = problem->structure.gradient(x) - problem->load;
  for (const EdgeMoment& moment : problem->moments) reactions -= moment.forces(x);
  std::vector<HoldReaction> holds;
  std::vector<bool> counted(static_cast<std::size_t>(x.rows()), false);
  for (const LinearConstraint& c : problem->constraints) {
    auto hold = std::ranges::find(holds, c.name, &HoldReaction::hold);
    if (hold == holds.end()) hold = holds.insert(holds.end(), {c.name, Point::Zero()});
    for (const auto& [row, coefficient] : c.terms) {
      if (coefficient == 0 || counted[static_cast<std::size_t>(row)]) continue;
      counted[static_cast<std::size_t>(row)] = true;
      hold->force += reactions.row(row).transpose();
    }
  }
  return holds;
}

}  // namespace knead
