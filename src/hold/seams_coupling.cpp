#include "knead/hold/seams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "seams_edge.hpp"
#include "seams_rest.hpp"
#include "seams_space.hpp"

namespace knead {
namespace {

using seams::RowMatrix;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// One seam being converted to constraints.
struct Coupling {
  const Seam& seam;
  const Surface &a, &b;
  int first_a, first_b;  // rows of the unknowns
  const SeamOptions& options;
  std::string name;
  std::vector<LinearConstraint>& constraints;
  SeamReport report;
  std::vector<std::pair<int, double>> terms;

  void reason(std::string text) {
    report.reason += (report.reason.empty() ? "" : "; ") + std::move(text);
  }

  void add_row(const RowMatrix& form, Eigen::Index row, int first, double factor) {
    for (RowMatrix::InnerIterator it(form, row); it; ++it) {
      if (it.value() != 0)
        terms.emplace_back(first + static_cast<int>(it.col()), factor * it.value());
    }
  }

  /// Σ terms = 0, the largest coefficient scaled to 1.
  void finish() {
    double largest = 0;
    for (const auto& term : terms) largest = std::max(largest, std::abs(term.second));
    if (largest > 0) {
      LinearConstraint constraint{name, std::move(terms)};
      for (auto& term : constraint.terms) term.second /= largest;
      constraints.push_back(std::move(constraint));
      ++report.constraints;
    }
    terms.clear();
  }

  bool periodic();
  void rigid(const std::string& why);
  void whole(const Expected<seams::RestMeeting>& rest);
  void tangents(const seams::EdgeForms& forms_a, const seams::EdgeForms& forms_b,
                const seams::CommonSpace& space, const seams::RestMeeting& rest);
};

/// X_{n−p+k} = X_k across a closed direction whose knots and weights repeat.
///
/// With knots that repeat by a period, x_{n−p+k} = x_k + period for k = 1 … 2p − 1, p control
/// points that repeat make all p − 1 derivatives continuous: more than tangents, by conditions of
/// two terms.
bool Coupling::periodic() {
  const int across = edge_across(seam.a.edge);
  const bool closed = seam.a.patch == seam.b.patch && seam.kind == SeamKind::whole &&
                      !seam.reversed && seam.a.edge != seam.b.edge &&
                      across == edge_across(seam.b.edge);
  if (!closed || options.most < SeamContinuity::periodic) return false;
  const KnotVector& knots = a.knots(across);
  const int p = knots.degree(), n = knots.count();
  if (p < 2 || n < p + 1) return false;
  const double period = knots.domain().length();
  double mismatch = 0;
  for (int k = 1; k < 2 * p; ++k)
    mismatch = std::max(mismatch, std::abs(knots[n - p + k] - knots[k] - period) / period);
  const int other = a.net()[at(1 - across)];
  const auto row = [&](int i, int j) { return across == 0 ? i * other + j : j * n + i; };
  if (a.rational()) {
    const auto quotient = [&](int i, int j) {
      return a.weights()[at(row(n - p + i, j))] / a.weights()[at(row(i, j))];
    };
    for (int i = 0; i < p; ++i) {
      for (int j = 0; j < other; ++j)
        mismatch = std::max(mismatch, std::abs(quotient(i, j) / quotient(0, 0) - 1));
    }
  }
  if (!(mismatch <= options.agreement)) return false;
  report.mismatch = std::max(report.mismatch, mismatch);
  for (int i = 0; i < p; ++i) {
    for (int j = 0; j < other; ++j) {
      terms = {{first_a + row(n - p + i, j), 1.0}, {first_a + row(i, j), -1.0}};
      finish();
    }
  }
  report.continuity = SeamContinuity::periodic;
  return true;
}

/// All edge points of both sides move by the same displacement: D is constant if every E_j is its
/// weight times it.
void Coupling::rigid(const std::string& why) {
  if (!options.rigid) {
    reason("not coupled: " + why);
    return;
  }
  const seams::EdgeForms forms_a = seams::edge_forms(a, seam.a.edge),
                         forms_b = seams::edge_forms(b, seam.b.edge);
  Eigen::Index reference = 0;
  if (!(forms_a.weight.cwiseAbs().maxCoeff(&reference) > 0)) {
    reason("not coupled: the edge has no weight");
    return;
  }
  const auto follow = [&](const seams::EdgeForms& forms, int first) {
    for (Eigen::Index j = 0; j < forms.value.rows(); ++j) {
      if (&forms == &forms_a && j == reference) continue;
      add_row(forms.value, j, first, 1);
      add_row(forms_a.value, reference, first_a, -forms.weight[j] / forms_a.weight[reference]);
      finish();
    }
  };
  follow(forms_a, first_a);
  if (seam.a != seam.b) follow(forms_b, first_b);
  report.continuity = SeamContinuity::c0;
  report.rigid = true;
  reason("the edge moves as a whole: " + why);
}

// D_a = D_b along the edge is E_a/W_a = E_b/W_b. With W_b = f W_a, in coefficients on the common
// space, it is linear: R_a E_a/w_a = R_b E_b/w_b, row by row. Weights out of proportion make both
// sides rational functions that agree only if they are constant along the edge, hence `rigid`.
void Coupling::whole(const Expected<seams::RestMeeting>& rest) {
  const auto space =
      seams::common_space(a.knots(edge_along(seam.a.edge)), b.knots(edge_along(seam.b.edge)),
                          seam.reversed, options.agreement);
  if (!space) return rigid("the knots of its sides cannot be compared");
  const seams::EdgeForms forms_a = seams::edge_forms(a, seam.a.edge),
                         forms_b = seams::edge_forms(b, seam.b.edge);
  const RowMatrix value_a = space->from_a * forms_a.value, value_b = space->from_b * forms_b.value;
  const Eigen::VectorXd weight_a = space->from_a * forms_a.weight,
                        weight_b = space->from_b * forms_b.weight;
  const double factor = weight_b.sum() / weight_a.sum();
  double mismatch = 0;
  for (Eigen::Index k = 0; k < weight_a.size(); ++k) {
    if (!(weight_a[k] > 0 && weight_b[k] > 0)) return rigid("its weights are not all positive");
    mismatch = std::max(mismatch, std::abs(weight_b[k] / (factor * weight_a[k]) - 1));
  }
  if (!(mismatch <= options.agreement))
    return rigid("the weights of its sides are not in proportion");
  report.mismatch = std::max({report.mismatch, space->mismatch, mismatch});
  report.restricted = !space->same;
  if (report.restricted)
    reason("degrees or knots of its sides differ: it follows only what both can");

  for (const Eigen::Index k : space->independent) {
    add_row(value_a, k, first_a, 1 / weight_a[k]);
    add_row(value_b, k, first_b, -1 / weight_b[k]);
    finish();
  }
  report.continuity = SeamContinuity::c0;
  if (!rest) return reason(rest.error().message());
  report.angle = rest->angle;
  report.ratio = rest->ratio;
  report.deviation = rest->deviation;
  if (options.most >= SeamContinuity::g1) tangents(forms_a, forms_b, *space, *rest);
}

// Inward derivatives: D_a' + ρ D_b' = 0, ρ of the rest shape. With D' = (E' − D W')/W this is
// E_a'/W_a + ρ E_b'/W_b = κ D, κ = W_a'/W_a + ρ W_b'/W_b, and linear in coefficients of the common
// space where κ is constant along the edge; 1/length of the domain is the scale in which its spread
// is judged, as κ is a derivative by the parameter.
void Coupling::tangents(const seams::EdgeForms& forms_a, const seams::EdgeForms& forms_b,
                        const seams::CommonSpace& space, const seams::RestMeeting& rest) {
  // Folded onto each other, as at a thin trailing edge, counts as smooth: the same condition
  // preserves both.
  if ((rest.ratio >= 0 ? rest.angle : rest.fold) > options.angle) {
    return reason(fmt::format("C0: a sharp edge, {:.3g} degrees at rest",
                              rest.angle * 180 / std::numbers::pi));
  }
  if (rest.ratio == 0) return reason("C0: the cross-derivatives vanish");
  if (!(rest.deviation <= options.angle)) {
    return reason(fmt::format(
        "C0: the cross-derivatives are in no fixed ratio (lengths {:.4g} to {:.4g}, off by {:.2g})",
        rest.lowest, rest.highest, rest.deviation));
  }
  const RowMatrix value = space.from_a * forms_a.value;
  const RowMatrix derivative_a = space.from_a * forms_a.derivative,
                  derivative_b = space.from_b * forms_b.derivative;
  const Eigen::VectorXd weight_a = space.from_a * forms_a.weight,
                        weight_b = space.from_b * forms_b.weight;
  const Eigen::ArrayXd a_part =
      (space.from_a * forms_a.weight_derivative).array() / weight_a.array();
  const Eigen::ArrayXd b_part =
      rest.ratio * (space.from_b * forms_b.weight_derivative).array() / weight_b.array();
  const Eigen::ArrayXd kappa = a_part + b_part;
  if (a.rational() || b.rational()) {
    const double inside =
        edge_across(seam.a.edge) == 0 ? a.knots(0).domain().length() : a.knots(1).domain().length();
    const double scale = std::max({a_part.abs().maxCoeff(), b_part.abs().maxCoeff(), 1 / inside});
    const double spread = (kappa.maxCoeff() - kappa.minCoeff()) / scale;
    if (!(spread <= options.agreement))
      return reason("C0: the weights beside the edge are not in proportion to its own");
    report.mismatch = std::max(report.mismatch, spread);
  }
  for (const Eigen::Index k : space.independent) {
    add_row(derivative_a, k, first_a, 1 / weight_a[k]);
    add_row(derivative_b, k, first_b, rest.ratio / weight_b[k]);
    add_row(value, k, first_a, -kappa[k] / weight_a[k]);
    finish();
  }
  report.continuity = SeamContinuity::g1;
  if (rest.ratio < 0) reason("its sides are folded onto each other");
  if (report.deviation > 1e-6) {
    reason(fmt::format(
        "its sides are {:.2g} off a smooth join at rest: the angle may change by {:.2g} rad",
        report.deviation, report.deviation));
  }
}

}  // namespace

// Ratios are made to agree over all seams before any condition is written (`agree_ratios`).
Expected<SeamCoupling> couple_seams(std::span<const Surface* const> patches,
                                    std::span<const int> rows, std::span<const Seam> found,
                                    const SeamOptions& options) {
  SeamCoupling result;
  for (std::size_t k = 0; k < found.size(); ++k) {
    for (int patch : {found[k].a.patch, found[k].b.patch}) {
      if (patch < 0 || at(patch) >= patches.size()) {
        return input_error(fmt::format("there is no patch {}", patch), fmt::format("seam {}", k));
      }
    }
  }
  std::vector<Expected<seams::RestMeeting>> rests(found.size());
  std::vector<seams::RestMeeting*> smooth(found.size(), nullptr);
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k].kind != SeamKind::whole || options.most == SeamContinuity::none) continue;
    rests[k] = seams::rest_meeting(*patches[at(found[k].a.patch)], *patches[at(found[k].b.patch)],
                                   found[k]);
    if (rests[k] && rests[k]->deviation <= options.angle) smooth[k] = &*rests[k];
  }
  seams::agree_ratios(patches, found, smooth);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Seam& seam = found[k];
    const std::string name =
        fmt::format("seam {} ({} – {})", k, to_string(seam.a), to_string(seam.b));
    Coupling coupling{seam,
                      *patches[at(seam.a.patch)],
                      *patches[at(seam.b.patch)],
                      rows[at(seam.a.patch)],
                      rows[at(seam.b.patch)],
                      options,
                      name,
                      result.constraints,
                      {},
                      {}};
    coupling.report.seam = seam;
    if (seam.kind == SeamKind::partial) {
      coupling.reason("not coupled: part of an edge");
    } else if (options.most == SeamContinuity::none) {
      coupling.reason("not coupled: switched off");
    } else if (seam.kind == SeamKind::reparametrised) {
      coupling.rigid("its sides run through it differently");
    } else if (!coupling.periodic()) {
      coupling.whole(rests[k]);
    }
    result.reports.push_back(std::move(coupling.report));
  }
  return result;
}

}  // namespace knead
