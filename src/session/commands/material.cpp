#include "material.hpp"

#include <fmt/format.h>

#include "describe/record_json.hpp"
#include "knead/energy/paint.hpp"
#include "material_presets.hpp"
#include "scene/formula_field.hpp"
#include "scene/places.hpp"
#include "session/acts/selection.hpp"

namespace knead {
namespace {

constexpr Choice coefficients[] = {
    {"alpha11", "stretch"},  {"alpha12", "stretch"},
    {"alpha22", "stretch"},  {"beta11", "bend"},
    {"beta12", "bend"},      {"beta22", "bend"},
    {"mass", "per area"},    {"damping", "force per velocity and area"},
    {"young", "of a shell"}, {"thickness", "of a shell"}};

Coefficient<2>* coefficient_named(MaterialFieldOf<2>& material, const std::string& name) {
  static constexpr const char* suffixes[] = {"11", "12", "22"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (name == fmt::format("alpha{}", suffixes[k])) return &material.alpha[k];
    if (name == fmt::format("beta{}", suffixes[k])) return &material.beta[k];
  }
  if (name == "mass") return &material.mass;
  if (name == "damping") return &material.damping;
  return nullptr;
}

/// A coefficient by samples or a formula over the whole domain.
Expected<SplineField<2>> field_of(const MaterialCommand& c, const SceneSurface& s) {
  if (c.formula) {
    if (!c.samples.empty())
      return input_error("there are samples and a formula", "formula", "give one of them");
    std::optional<Interval> range;
    if (*c.coefficient != "alpha12") range = Interval{0, std::numeric_limits<double>::infinity()};
    auto field = formula_field(*c.formula, *s.reference, c.tolerance, range);
    if (!field) return std::unexpected(field.error().within("formula"));
    return field;
  }
  auto field = sampled_field<2>({s.reference->knots(0).domain(), s.reference->knots(1).domain()},
                                c.counts, c.samples);
  if (!field) return std::unexpected(field.error().within("samples"));
  return field;
}

/// One coefficient alone, over the whole domain.
Expected<MaterialFieldOf<2>> varied(const MaterialCommand& c, const SceneSurface& s) {
  MaterialFieldOf<2> next = s.material;
  Coefficient<2>* const place = coefficient_named(next, *c.coefficient);
  if (place == nullptr) {
    return input_error(fmt::format("\"{}\" is not a coefficient", *c.coefficient), "coefficient",
                       fmt::format("use one of: {}", fmt::join(names_of(coefficients), ", ")));
  }
  auto field = field_of(c, s);
  if (!field) return std::unexpected(field.error());
  *place = std::move(*field);
  return next;
}

/// The constants that are named, everywhere.
MaterialFieldOf<2> everywhere(const MaterialCommand& c, const SceneSurface& s) {
  MaterialFieldOf<2> next = s.material;
  if (c.model == MaterialModel::plate) {
    next = MaterialFieldOf<2>(thin_plate(c.rigidity.value_or(0.01), c.poisson.value_or(0)));
    next.mass = s.material.mass;
    next.damping = s.material.damping;
  } else if (c.beta || c.model) {
    next.poisson = 0;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (c.alpha) next.alpha[i] = (*c.alpha)[i];
    if (c.beta) next.beta[i] = (*c.beta)[i];
  }
  if (c.mass) next.mass = *c.mass;
  if (c.damping) next.damping = *c.damping;
  return next;
}

/// The constants that are named, in the region.
Expected<MaterialFieldOf<2>> painted(const MaterialCommand& c, const SceneSurface& s) {
  const auto where = region_at(*s.reference, *c.region);
  if (!where) return std::unexpected(where.error());
  Region<2> region;
  const auto& [u, v] = *where;
  region.shape = ParameterBox<2>{{u.lower, v.lower}, {u.upper, v.upper}};
  region.falloff = c.falloff;
  // The fall-off is a fraction of the domain in either direction.
  for (std::size_t d = 0; d < 2; ++d)
    region.factors[d] = 1 / s.reference->knots()[d].domain().length();
  MaterialPaint<2> values;
  for (std::size_t i = 0; i < 3; ++i) {
    if (c.alpha) values.alpha[i] = (*c.alpha)[i];
    if (c.beta) values.beta[i] = (*c.beta)[i];
  }
  values.mass = c.mass;
  values.damping = c.damping;
  std::vector<KnotVector> hint;
  for (std::size_t d = 0; d < 2; ++d) {
    const Interval domain = s.reference->knots()[d].domain();
    hint.push_back(*KnotVector::create(
        2, {domain.lower, domain.lower, domain.lower, domain.upper, domain.upper, domain.upper}));
  }
  return paint<2>(s.material, values, region, {hint[0], hint[1]});
}

std::vector<double> list_of(const std::array<double, 3>& numbers) {
  return {numbers.begin(), numbers.end()};
}

/// Whether the coefficient that varies is one of a shell.
bool varies_shell(const MaterialCommand& c) {
  return c.coefficient == "young" || c.coefficient == "thickness";
}

bool names_shell(const MaterialCommand& c) {
  return c.young || (c.poisson && c.model != MaterialModel::plate) || c.thickness || c.density ||
         varies_shell(c);
}

bool names_something(const MaterialCommand& c) {
  return c.alpha || c.beta || c.mass || c.damping || c.coefficient || c.preset || c.plasticity ||
         c.yield || c.locality || c.model || c.rigidity || names_shell(c) || c.w1 || c.w2 ||
         c.reset || c.formula || !c.samples.empty();
}

/// The model that a surface has after the command.
MaterialModel model_of(const MaterialCommand& c, const SceneSurface& s) {
  return c.model.value_or(static_cast<MaterialModel>(s.elasticity.index()));
}

/// The shell that a surface is after the command.
Expected<ShellMaterial> shell_of(const MaterialCommand& c, const SceneSurface& s) {
  const auto* before = std::get_if<ShellMaterial>(&s.elasticity);
  const bool young = c.young || c.coefficient == "young",
             thickness = c.thickness || c.coefficient == "thickness";
  if (before == nullptr && !(young && thickness)) {
    return input_error("a shell needs a Young's modulus and a thickness",
                       young ? "thickness" : "young",
                       R"(give them, as "young":210000,"thickness":1)");
  }
  ShellMaterial next = before != nullptr ? *before : ShellMaterial{};
  if (c.young) {
    next.young = *c.young;
    next.young_field.reset();
  }
  if (c.poisson) next.poisson = *c.poisson;
  if (c.thickness) {
    next.thickness = *c.thickness;
    next.thickness_field.reset();
  }
  if (c.density) next.density = *c.density;
  if (varies_shell(c)) {
    auto field = field_of(c, s);
    if (!field) return std::unexpected(field.error());
    const bool of_young = c.coefficient == "young";
    (of_young ? next.young : next.thickness) = mean_of(*field);
    (of_young ? next.young_field : next.thickness_field) = std::move(*field);
  }
  return validated(next);
}

/// The weights of its fundamental forms after the command.
Expected<FundamentalMaterial> fundamental_of(const MaterialCommand& c, const SceneSurface& s) {
  const auto* before = std::get_if<FundamentalMaterial>(&s.elasticity);
  FundamentalMaterial next = before != nullptr ? *before : FundamentalMaterial{};
  if (c.w1) next.w1 = *c.w1;
  if (c.w2) next.w2 = *c.w2;
  return validated_weights(next);
}

/// What resists in a surface after the command.
Expected<Elasticity<2>> elasticity_of(const MaterialCommand& c, const SceneSurface& s) {
  const MaterialModel model = model_of(c, s);
  if (model != MaterialModel::shell && names_shell(c)) {
    return input_error(
        "only shells have a Young's modulus, a thickness or a density, and with plates a Poisson's "
        "ratio",
        "model", R"(add "model":"shell", or use alpha, beta and mass)");
  }
  if (model == MaterialModel::shell) {
    auto shell = shell_of(c, s);
    if (!shell) return std::unexpected(shell.error());
    if (!c.w1 && !c.w2) return Elasticity<2>(*std::move(shell));
  }
  if (model == MaterialModel::fundamental) return fundamental_of(c, s);
  if (!c.w1 && !c.w2) return Elasticity<2>();
  return input_error("only fundamental forms have weights w1 and w2", "model",
                     R"(add "model":"fundamental")");
}

Expected<void> check_fields(const MaterialCommand& c) {
  for (const auto& [name, given] : {std::pair{"alpha", &c.alpha}, std::pair{"beta", &c.beta}}) {
    if (!*given || (*given)->size() == 3) continue;
    return input_error(fmt::format("{} numbers for a surface", (*given)->size()), name,
                       "give [11, 12, 22]");
  }
  if (c.coefficient &&
      ((c.young && c.coefficient == "young") || (c.thickness && c.coefficient == "thickness"))) {
    return input_error("it is given as a number and by samples or a formula", *c.coefficient,
                       "give one of them");
  }
  if (c.region && (names_shell(c) || c.w1 || c.w2)) {
    return input_error(
        "a region is of alpha, beta, mass and damping", "region",
        R"(let a shell vary by a formula: "coefficient":"thickness","formula":"1 + s^2")");
  }
  if (!c.coefficient && (c.formula || !c.samples.empty())) {
    return input_error("of which coefficient is not said", "coefficient",
                       R"(name it, as "coefficient":"beta11")");
  }
  if (c.tolerance && !c.formula) {
    return input_error("a tolerance is given without a formula", "tolerance", "leave it out");
  }
  if (c.rigidity && c.model != MaterialModel::plate) {
    return input_error("only a plate has a rigidity", "rigidity", R"(add "model":"plate")");
  }
  if (c.model == MaterialModel::plate &&
      (c.alpha || c.beta || c.preset || c.region || c.coefficient)) {
    return input_error(
        "the coefficients of a plate are those of its rigidity and Poisson's ratio", "model",
        "give rigidity and poisson alone, or afterwards, in a command without model, what differs");
  }
  if (c.preset && (c.region || c.coefficient)) {
    return input_error("a preset is for whole surfaces", "preset",
                       "leave out region and coefficient");
  }
  return {};
}

/// What strokes leave after the command.
PlasticPolicy plastic_of(const MaterialCommand& c, const Preset* preset, PlasticPolicy before) {
  if (preset != nullptr) before = preset->plastic;
  if (!c.plasticity && !c.yield && !c.locality) return before;
  before.along = true;
  if (c.plasticity) before.share = *c.plasticity;
  if (c.yield) before.yield = *c.yield;
  if (c.locality) before.locality = *c.locality;
  if (c.yield || c.locality)
    before.in_radii = c.lengths.value_or(LengthUnit::radii) == LengthUnit::radii;
  return before;
}

}  // namespace

std::span<const Choice> choices(LengthUnit) {
  static constexpr Choice list[] = {{"radii", LengthUnit::radii, "of the tool"},
                                    {"file", LengthUnit::file, "units of the file"}};
  return list;
}

std::span<const Choice> choices(MaterialModel) {
  static constexpr Choice list[] = {
      {"linear", MaterialModel::linear, "the active model"},
      {"shell", MaterialModel::shell, "Koiter's shell ([shell.md](shell.md))"},
      {"fundamental", MaterialModel::fundamental, "keeps both fundamental forms (thesis Eq. 3.42)"},
      {"plate", MaterialModel::plate,
       "a thin plate: a linear model that bends with Poisson's ratio and does not stretch, β11 = "
       "β22 = `rigidity`, β12 = (1 − `poisson`) `rigidity`, α = 0"}};
  return list;
}

void describe(MaterialCommand& c, Fields& fields) {
  fields.name(
      "material",
      "resistance to stretching and bending, in the order 11, 12, 22; fields not given stay");
  fields.add("alpha", c.alpha,
             {.help = "stretch; α11, α22 ≥ 0 and α12² ≤ α11 α22; of a curve `[11]`, of a volume "
                      "`[11, 12, 13, 22, 23, 33]`",
              .fallback = "as it was"});
  fields.add("beta", c.beta, {.help = "bend; none negative", .fallback = "as it was"});
  fields.add("mass", c.mass,
             {.help = "per area, for `evolve` dynamic and `load` gravity",
              .range = at_least(0),
              .fallback = "as it was"});
  fields.add("damping", c.damping,
             {.help = "force per velocity and area, for `evolve` dynamic",
              .range = at_least(0),
              .fallback = "as it was"});
  fields.add("region", c.region,
             {.help = "`[[s0, s1], [t0, t1]]`: only there; what was set elsewhere stays",
              .unit = Unit::fraction,
              .range = between(0, 1),
              .fallback = "everywhere"});
  fields.add("falloff", c.falloff,
             {.help = "width of the border of the region, in fractions", .unit = Unit::fraction});
  fields.add("coefficient", c.coefficient,
             {.help = "only this one, by samples or a formula; `alpha` and `beta` are then ignored",
              .choices = coefficients});
  fields.add("counts", c.counts, {.help = "`[m, n]` samples over the domain, its ends included"});
  fields.add("samples", c.samples,
             {.help = "m n numbers, along v first, linear in between; all that is convex "
                      "coefficient by coefficient"});
  fields.add(
      "formula", c.formula,
      {.help = "of `s`, `t`, the fractions along u and v, and `x`, `y`, `z`, the place there, as "
               "`1 + 4*exp(-40*((s - 0.5)^2 + (t - 0.5)^2))`; as a cubic spline "
               "([materials-and-loads.md](materials-and-loads.md))"});
  fields.add(
      "tolerance", c.tolerance,
      {.help = "of that spline", .range = above(0), .fallback = "1e-6 of the largest value"});
  fields.add(
      "preset", c.preset,
      {.help = "of whole surfaces: coefficients, the lambda of `evolve` and what strokes leave, as "
               "[clay.md](clay.md) lists them"});
  fields.add("plasticity", c.plasticity,
             {.help = "share of a displacement that strokes leave",
              .unit = Unit::fraction,
              .range = between(0, 1),
              .fallback = "that of the preset"});
  fields.add("yield", c.yield,
             {.help = "up to this displacement strokes leave nothing",
              .range = at_least(0),
              .fallback = "that of the preset"});
  fields.add("locality", c.locality,
             {.help = "how far a dent is felt, 0 as far as lambda lets it",
              .range = at_least(0),
              .fallback = "that of the preset"});
  fields.add("lengths", c.lengths,
             {.help = "what `yield` and `locality` count", .fallback = "`radii`"});
  fields.add("model", c.model,
             {.help = "of whole surfaces", .fallback = "as it was, at first `linear`"});
  fields.add("young", c.young,
             {.help = "of a shell: Young's modulus, force per area; all in units of the file",
              .range = above(0)});
  fields.add("poisson", c.poisson,
             {.help = "of a shell or a plate: Poisson's ratio",
              .range = {.least = -1, .most = 0.5, .open_below = true},
              .fallback = "as it was, at first 0"});
  fields.add("thickness", c.thickness,
             {.help = "of a shell", .unit = Unit::length, .range = above(0)});
  fields.add("density", c.density,
             {.help = "of a shell: mass per volume, for `load` gravity",
              .range = at_least(0),
              .fallback = "as it was, at first 0"});
  fields.add(
      "rigidity", c.rigidity,
      {.help = "of a plate, in the units of `beta`", .range = above(0), .fallback = "`0.01`"});
  fields.add("w1", c.w1,
             {.help = "of `fundamental`: weights of the first form, 11, 12, 22, or one number for "
                      "all; per du dv of the knots as they are",
              .range = at_least(0),
              .fallback = "as it was, at first 1",
              .uniform = true});
  fields.add("w2", c.w2,
             {.help = "of the second form, of a curve of its curvature",
              .range = at_least(0),
              .fallback = "as it was, at first 1",
              .uniform = true});
  fields.add("reset", c.reset,
             {.help = "first all of it is as of a new surface, everywhere: stretch, bend, mass, "
                      "damping, the model and what strokes leave"});
}

Expected<void> execute(const MaterialCommand& given, Act& act) {
  if (act.state.body) return set_body_material(act, given);
  if (auto surface = selected(act); !surface) return std::unexpected(surface.error());
  if (!names_something(given)) {
    return input_error("no field is given", "alpha",
                       "give a preset, alpha, beta, mass, damping, plasticity, yield, locality, "
                       "coefficient, model, or reset");
  }
  if (auto checked = check_fields(given); !checked) return checked;
  MaterialCommand c = given;
  const Preset* preset = nullptr;
  if (c.preset) {
    preset = &preset_named(*c.preset);
    if (!c.alpha) c.alpha = list_of(preset->material.alpha);
    if (!c.beta) c.beta = list_of(preset->material.beta);
    act.state.evolution.lambda = preset->lambda;
  }
  Material constants;
  if (c.alpha) std::ranges::copy(*c.alpha, constants.alpha.begin());
  if (c.beta) std::ranges::copy(*c.beta, constants.beta.begin());
  if (auto material = validated(constants); !material) return std::unexpected(material.error());
  for (SceneSurface& s : selected_surfaces(act.state)) {
    if (c.reset) reset_material(s);
    auto next = c.coefficient && !varies_shell(c) ? varied(c, s)
                : c.region                        ? painted(c, s)
                                                  : everywhere(c, s);
    if (!next) return std::unexpected(next.error());
    if (auto checked = validated<2>(*next); !checked) return std::unexpected(checked.error());
    auto elasticity = elasticity_of(c, s);
    if (!elasticity) return std::unexpected(elasticity.error());
    s.elasticity = *std::move(elasticity);
    s.material = std::move(*next);
    s.plastic = plastic_of(c, preset, s.plastic);
  }
  return {};
}

}  // namespace knead
