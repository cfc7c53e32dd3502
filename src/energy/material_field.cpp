#include "knead/energy/material_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace knead {
namespace {

constexpr double conversion_slack = 1e-12;

template <int D>
bool varies(const Coefficient<D>& c) {
  return std::holds_alternative<SplineField<D>>(c);
}

/// The multi-index of coefficient k, for messages.
template <int D>
std::string place_of(const SplineField<D>& field, std::size_t k) {
  std::string text;
  const std::array<int, D> net = field.net();
  for (std::size_t d = D; d-- > 0;) {
    const auto n = static_cast<std::size_t>(net[d]);
    text = fmt::format("{}{}{}", k % n, text.empty() ? "" : ", ", text);
    k /= n;
  }
  return fmt::format("coefficient ({})", text);
}

template <int D>
Expected<void> check_positive(const Coefficient<D>& coefficient, const std::string& name,
                              bool positive) {
  const auto bad = [&](double c) { return !std::isfinite(c) || (positive && c < 0); };
  const auto message = [](double c) {
    return std::isfinite(c) ? fmt::format("{} is negative, so the energy has no minimum", c)
                            : std::string("the coefficient is not a finite number");
  };
  if (const double* constant = std::get_if<double>(&coefficient)) {
    if (bad(*constant)) return input_error(message(*constant), name, "use a value >= 0");
    return {};
  }
  const auto& field = std::get<SplineField<D>>(coefficient);
  const auto at = std::ranges::find_if(field.coefficients(), bad);
  if (at == field.coefficients().end()) return {};
  return input_error(
      message(*at),
      name + ": " + place_of(field, static_cast<std::size_t>(at - field.coefficients().begin())),
      "use values >= 0, or finer knots where the values are");
}

// The energy is convex where the matrix α(u) is positive semidefinite. With all α on one basis,
// α(u) is a combination of matrices of coefficients with factors N_k(u) >= 0: it suffices that each
// of those is (and is not necessary: finer knots come closer). Where bases had to be united by knot
// insertion a little is allowed for its rounding.
template <int D>
Expected<void> check_alpha_matrix(const MaterialFieldOf<D>& material) {
  std::vector<std::array<KnotVector, D>> knots;
  double largest = 0;
  for (const Coefficient<D>& c : material.alpha) {
    if (const double* constant = std::get_if<double>(&c)) {
      largest = std::max(largest, std::abs(*constant));
      continue;
    }
    const auto& field = std::get<SplineField<D>>(c);
    knots.push_back(field.knots());
    largest = std::max({largest, std::abs(field.range().lower), std::abs(field.range().upper)});
  }
  const bool constant = knots.empty();
  MaterialOf<D> one;
  one.beta.fill(0);
  if (constant) {
    for (std::size_t k = 0; k < one.alpha.size(); ++k)
      one.alpha[k] = std::get<double>(material.alpha[k]);
    if (auto ok = validated<D>(one); !ok) return std::unexpected(ok.error());
    return {};
  }
  const bool shared = std::ranges::all_of(knots, [&](const auto& k) { return k == knots.front(); });
  if (!shared) {
    auto common = common_knots<D>(std::span<const std::array<KnotVector, D>>(knots));
    if (!common) return std::unexpected(common.error().within("alpha"));
    knots.assign(1, std::move(*common));
  }
  std::vector<SplineField<D>> fields;
  for (const Coefficient<D>& c : material.alpha) {
    auto field = on_knots<D>(c, knots.front());
    if (!field) return std::unexpected(field.error().within("alpha"));
    fields.push_back(std::move(*field));
  }
  for (std::size_t k = 0; k < fields.front().coefficients().size(); ++k) {
    for (std::size_t c = 0; c < fields.size(); ++c) one.alpha[c] = fields[c].coefficients()[k];
    if (!shared) {
      for (int i = 0; i < D; ++i) {
        double& diagonal = one.alpha[MaterialOf<D>::place(i, i)];
        diagonal = std::max(diagonal, 0.0) + conversion_slack * largest;
      }
    }
    if (auto ok = validated<D>(one); !ok) {
      Error error = ok.error();
      error.where += ": " + place_of(fields.front(), k);
      return std::unexpected(error);
    }
  }
  return {};
}

template <int D>
const Coefficient<D>& beta_ii(const MaterialFieldOf<D>& material, int i) {
  return material.beta[MaterialOf<D>::place(i, i)];
}

/// Whether the coefficients of S_ii·S_jj are known: no bend varies, or all vary alike.
template <int D>
bool couples_bends(const MaterialFieldOf<D>& material) {
  bool varying = false, alike = true;
  for (int i = 0; i < D; ++i) {
    varying = varying || varies<D>(beta_ii(material, i));
    alike = alike && beta_ii(material, i) == beta_ii(material, 0);
  }
  return material.poisson == 0 || !varying || alike;
}

}  // namespace

template <int D>
Expected<void> validated(const MaterialFieldOf<D>& material) {
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j) {
      const std::size_t k = MaterialOf<D>::place(i, j);
      const std::string indices = fmt::format("{}{}", i + 1, j + 1);
      if (auto ok = check_positive<D>(material.alpha[k], "alpha" + indices, i == j); !ok) return ok;
      if (auto ok = check_positive<D>(material.beta[k], "beta" + indices, true); !ok) return ok;
    }
  }
  MaterialOf<D> coupled;
  coupled.poisson = material.poisson;
  if (auto ok = validated<D>(coupled); !ok) return std::unexpected(ok.error());
  if (!couples_bends(material)) {
    return input_error(
        "bends that vary differently in different directions have no Poisson's ratio", "poisson",
        "let all beta11, beta22 … be the same, or use 0");
  }
  if (auto ok = check_positive<D>(material.mass, "mass", true); !ok) return ok;
  if (auto ok = check_positive<D>(material.damping, "damping", true); !ok) return ok;
  return check_alpha_matrix<D>(material);
}

namespace {

template <int D>
MultiIndex<D> unit(int i) {
  MultiIndex<D> a{};
  a[static_cast<std::size_t>(i)] = 1;
  return a;
}

template <int D>
MultiIndex<D> second(int i, int j) {
  MultiIndex<D> a = unit<D>(i);
  ++a[static_cast<std::size_t>(j)];
  return a;
}

template <int D>
bool is_zero(const Coefficient<D>& c) {
  return !varies<D>(c) && std::get<double>(c) == 0;
}

}  // namespace

// Σ_ij α_ij S_i · S_j, every term with its mirror image: assembly of a ≠ b alone would not be
// symmetric.
template <int D>
FieldEnergy<D> stretch_energy(const MaterialFieldOf<D>& material) {
  FieldEnergy<D> result;
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j) {
      const Coefficient<D>& alpha = material.alpha[MaterialOf<D>::place(i, j)];
      if (is_zero<D>(alpha)) continue;
      result.push_back({1, alpha, unit<D>(i), unit<D>(j)});
      if (i != j) result.push_back({1, alpha, unit<D>(j), unit<D>(i)});
    }
  }
  return result;
}

// Σ_i β_ii |S_ii|² + 2 Σ_{i<j} β_ij |S_ij|² + 2 ν Σ_{i<j} √(β_ii β_jj) S_ii · S_jj. With the
// geometric mean two directions stay a non-negative form for |ν| ≤ 1, however different their bends
// are. A root of a product of splines is none: where bends vary they must be alike, and the mean is
// one of them.
template <int D>
FieldEnergy<D> bend_energy(const MaterialFieldOf<D>& material) {
  FieldEnergy<D> result;
  for (int i = 0; i < D; ++i) {
    for (int j = i; j < D; ++j) {
      const Coefficient<D>& beta = material.beta[MaterialOf<D>::place(i, j)];
      if (is_zero<D>(beta)) continue;
      result.push_back({i == j ? 1.0 : 2.0, beta, second<D>(i, j), second<D>(i, j)});
    }
  }
  for (int i = 0; i < D && material.poisson != 0; ++i) {
    for (int j = i + 1; j < D; ++j) {
      const Coefficient<D>&ii = beta_ii(material, i), &jj = beta_ii(material, j);
      if (is_zero<D>(ii) || is_zero<D>(jj)) continue;
      const Coefficient<D> coupled =
          varies<D>(ii) ? ii : std::sqrt(std::get<double>(ii) * std::get<double>(jj));
      result.push_back({material.poisson, coupled, second<D>(i, i), second<D>(j, j)});
      result.push_back({material.poisson, coupled, second<D>(j, j), second<D>(i, i)});
    }
  }
  return result;
}

template <int D>
FieldEnergy<D> weighted_mass_energy(const Coefficient<D>& coefficient) {
  return {{1, coefficient, {}, {}}};
}

template <int D>
FieldEnergy<D> on_scaled_domain(const FieldEnergy<D>& energy,
                                const std::array<double, D>& factors) {
  FieldEnergy<D> scaled = energy;
  for (FieldTerm<D>& term : scaled) {
    term.factor =
        on_scaled_domain<D>(Energy<D>{{term.factor, term.a, term.b}}, factors).front().coefficient;
  }
  return scaled;
}

#define KNEAD_INSTANTIATE(D)                                              \
  template Expected<void> validated<D>(const MaterialFieldOf<D>&);        \
  template FieldEnergy<D> stretch_energy<D>(const MaterialFieldOf<D>&);   \
  template FieldEnergy<D> bend_energy<D>(const MaterialFieldOf<D>&);      \
  template FieldEnergy<D> weighted_mass_energy<D>(const Coefficient<D>&); \
  template FieldEnergy<D> on_scaled_domain<D>(const FieldEnergy<D>&, const std::array<double, D>&);
KNEAD_INSTANTIATE(1)
KNEAD_INSTANTIATE(2)
KNEAD_INSTANTIATE(3)
#undef KNEAD_INSTANTIATE

}  // namespace knead
