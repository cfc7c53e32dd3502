#include <fmt/format.h>

#include <algorithm>

#include "commands/material.hpp"

#include "acts/selection.hpp"

namespace knead {
namespace {

template <int D>
Expected<void> set_material(SceneShape<D>& s, const MaterialCommand& c) {
  MaterialOf<D> next = s.material.constants();
  const double mass = c.mass.value_or(std::get<double>(s.material.mass));
  const double damping = c.damping.value_or(std::get<double>(s.material.damping));
  const auto set = [](const std::optional<std::vector<double>>& given, auto& to,
                      const char* field) -> Expected<void> {
    if (!given) return {};
    if (given->size() != to.size()) {
      return input_error(
          fmt::format("{} numbers for a {}", given->size(), D == 1 ? "curve" : "volume"), field,
          D == 1 ? "give [11]" : "give [11, 12, 13, 22, 23, 33]");
    }
    std::ranges::copy(*given, to.begin());
    return {};
  };
  if (auto status = set(c.alpha, next.alpha, "alpha"); !status) return status;
  if (auto status = set(c.beta, next.beta, "beta"); !status) return status;
  if (auto checked = validated<D>(next); !checked) return std::unexpected(checked.error());
  s.material = MaterialFieldOf<D>(next, mass, damping);
  return {};
}

/// What resists in the body after the command.
template <int D>
Expected<void> set_elasticity(const MaterialCommand& c, Elasticity<D>& elasticity) {
  if (c.model == MaterialModel::shell || c.model == MaterialModel::plate) {
    return input_error(fmt::format("a {} is no {}", kind_of(D),
                                   c.model == MaterialModel::shell ? "shell" : "plate"),
                       "model", R"(use "linear" or "fundamental")");
  }
  const bool keeps = c.model ? *c.model == MaterialModel::fundamental : is_nonlinear(elasticity);
  if (!keeps) {
    if (c.w1 || c.w2) {
      return input_error("only fundamental forms have weights w1 and w2", "model",
                         R"(add "model":"fundamental")");
    }
    elasticity = LinearElasticity{};
    return {};
  }
  if (c.w2 && D == 3) {
    return input_error("a volume has a metric alone", "w2", "leave it out");
  }
  const auto* before = std::get_if<FormWeights>(&elasticity);
  FormWeights next = before != nullptr ? *before : FormWeights{};
  for (const auto& [given, to, field] :
       {std::tuple{&c.w1, &next.w1, "w1"}, std::tuple{&c.w2, &next.w2, "w2"}}) {
    if (!*given) continue;
    const std::array<double, 3>& w = **given;
    if (w[0] != w[1] || w[1] != w[2]) {
      return input_error(fmt::format("a {} has one weight of each form", kind_of(D)), field,
                         "give one number");
    }
    *to = w[0];
  }
  elasticity = next;
  return {};
}

}  // namespace

Expected<void> set_body_material(Act& act, const MaterialCommand& c) {
  const struct {
    const char* name;
    bool given;
  } fields[] = {{"region", c.region.has_value()},       {"coefficient", c.coefficient.has_value()},
                {"samples", !c.samples.empty()},        {"formula", c.formula.has_value()},
                {"preset", c.preset.has_value()},       {"plasticity", c.plasticity.has_value()},
                {"yield", c.yield.has_value()},         {"locality", c.locality.has_value()},
                {"young", c.young.has_value()},         {"poisson", c.poisson.has_value()},
                {"thickness", c.thickness.has_value()}, {"density", c.density.has_value()},
                {"rigidity", c.rigidity.has_value()}};
  for (const auto& [name, given] : fields) {
    if (given) return of_surfaces(act, name, "use alpha, beta, mass and damping");
  }
  if (!c.alpha && !c.beta && !c.mass && !c.damping && !c.model && !c.w1 && !c.w2 && !c.reset) {
    return input_error("no field is given", "alpha",
                       "give alpha, beta, mass, damping, a model, or reset");
  }
  const auto set = [&]<int D>(SceneShape<D>& s) -> Expected<void> {
    if (c.reset) reset_material(s);
    if (auto status = set_elasticity<D>(c, s.elasticity); !status) return status;
    return set_material(s, c);
  };
  return std::visit(set, *body(act));
}

}  // namespace knead
