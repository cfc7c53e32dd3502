#include "edge_coupling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "constraint_rows.hpp"
#include "solve/constraint_space.hpp"

namespace knead {
namespace {

using detail::Terms;

struct Patches {
  std::span<const Surface* const> all;
  std::span<const int> rows;
};

/// R of one patch at its parameters, or its derivative in a direction, in unknowns of all patches,
/// times a sign.
Expected<void> add_row(const Patches& patches, const SharedPoint::value_type& place,
                       const std::optional<Eigen::Vector2d>& across, double sign, Terms& terms) {
  const auto& [patch, at] = place;
  const Surface& s = *patches.all[static_cast<std::size_t>(patch)];
  for (int d = 0; d < 2; ++d) {
    auto inside =
        detail::check_parameter(s.knots(d), at[static_cast<std::size_t>(d)], d == 0 ? "u" : "v");
    if (!inside) return inside;
  }
  const int first = patches.rows[static_cast<std::size_t>(patch)];
  for (int along = across ? 0 : -1; along < (across ? 2 : 0); ++along) {
    const double share = across ? sign * (*across)[along] : sign;
    const auto row = detail::rational_row(s, at[0], at[1], s.knots(0).find_span(at[0]),
                                          s.knots(1).find_span(at[1]), along);
    if (!row) return std::unexpected(row.error());
    for (const auto& [unknown, c] : *row) {
      if (share * c != 0) terms.emplace_back(first + unknown, share * c);
    }
  }
  return {};
}

/// The conditions on positions at the points of an edge, or those on derivatives.
Expected<std::vector<Terms>> conditions(const Patches& patches, const CoupledEdge& edge,
                                        bool derivatives) {
  std::vector<Terms> result;
  for (std::size_t p = 0; p < edge.points.size(); ++p) {
    const SharedPoint& point = edge.points[p];
    if (derivatives && edge.across[p].empty()) continue;
    for (std::size_t k = 1; k < point.size(); ++k) {
      Terms terms;
      for (const std::size_t side : {std::size_t{0}, k}) {
        const auto across = derivatives ? std::optional(edge.across[p][side]) : std::nullopt;
        auto added = add_row(patches, point[side], across, side == 0 ? 1 : -1, terms);
        if (!added) return std::unexpected(added.error().within(edge.name));
      }
      result.push_back(std::move(terms));
    }
  }
  if (!derivatives) return result;
  double largest = 0;
  for (const Terms& terms : result) {
    for (const auto& [unknown, c] : terms) largest = std::max(largest, std::abs(c));
  }
  for (Terms& terms : result) {
    for (auto& [unknown, c] : terms) c /= largest;
  }
  return result;
}

/// An unknown in those that are independent. Where a constraint along a normal couples the
/// coordinates, those of x stand for all.
Terms independent_terms(const detail::ConstraintElimination& elimination, int unknown) {
  const int at = elimination.coupled() ? 3 * unknown : unknown;
  const auto& definition = elimination.definition(at);
  if (definition.held) return {};
  if (!definition.dependent) return {{at, 1.0}};
  Terms terms;
  for (const auto& [other, c] : definition.terms) {
    if (!elimination.definition(other).held) terms.emplace_back(other, c);
  }
  return terms;
}

/// The conditions in the unknowns that an elimination leaves independent.
///
/// Independence must be judged after what holds anyway: two conditions that differ in an unknown
/// that a seam ties may say the same.
std::vector<Terms> reduced(const detail::ConstraintElimination& elimination,
                           const std::vector<Terms>& conditions) {
  std::map<int, Terms> known;  // of every unknown
  std::vector<Terms> result;
  for (const Terms& condition : conditions) {
    std::map<int, double> sum;
    for (const auto& [unknown, c] : condition) {
      auto found = known.find(unknown);
      if (found == known.end())
        found = known.emplace(unknown, independent_terms(elimination, unknown)).first;
      for (const auto& [y, a] : found->second) sum[y] += c * a;
    }
    result.emplace_back(sum.begin(), sum.end());
  }
  return result;
}

LinearConstraint constraint_of(const std::string& name, const Terms& terms) {
  std::map<int, double> sum;
  for (const auto& [unknown, c] : terms) sum[unknown] += c;
  double largest = 0;
  for (const auto& [unknown, c] : sum) largest = std::max(largest, std::abs(c));
  LinearConstraint result{name, {}, Point::Zero(), {}};
  for (const auto& [unknown, c] : sum) {
    if (c != 0) result.terms.emplace_back(unknown, c / largest);
  }
  return result;
}

}  // namespace

// One elimination serves all curves: each chosen condition is added to it, so that the next curve
// is expressed in what those before have left.
Expected<EdgeCoupling> couple_edges(std::span<const Surface* const> patches,
                                    std::span<const int> rows, std::span<const CoupledEdge> edges,
                                    std::span<const LinearConstraint> before,
                                    const std::vector<bool>& held,
                                    const CouplingTolerance& tolerance) {
  for (const double t : {tolerance.position, tolerance.tangent}) {
    if (t > 0 && t <= 1) continue;
    return input_error(fmt::format("{} is not a tolerance", t), "tolerance",
                       "use a number above 0, up to 1");
  }
  auto elimination = ConstraintSpace::eliminated(rows.back(), before, held);
  if (!elimination) return std::unexpected(elimination.error());
  EdgeCoupling result;
  const auto couple = [&](const CoupledEdge& edge, bool derivatives, double to) -> Expected<void> {
    const auto given = conditions({patches, rows}, edge, derivatives);
    if (!given) return std::unexpected(given.error());
    const auto selected = detail::select_rows(reduced(*elimination, *given), to);
    if (!selected) return std::unexpected(selected.error().within(edge.name));
    if (!derivatives) result.bound = std::max(result.bound, selected->remainder);
    for (const int k : selected->chosen) {
      result.constraints.push_back(constraint_of(edge.name, (*given)[static_cast<std::size_t>(k)]));
      if (auto added = elimination->add(result.constraints.back()); !added) return added;
    }
    return {};
  };
  for (const CoupledEdge& edge : edges) {
    if (auto status = couple(edge, false, tolerance.position); !status)
      return std::unexpected(status.error());
    if (edge.across.empty()) continue;
    if (auto status = couple(edge, true, tolerance.tangent); !status)
      return std::unexpected(status.error());
  }
  return result;
}

}  // namespace knead
