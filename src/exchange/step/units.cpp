#include "units.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>

#include "exchange/length_units.hpp"
#include "exchange/part21/part21_text.hpp"

namespace knead::step {
namespace {

struct Prefix {
  std::string_view name;
  const char* symbol;
  double factor;
};

// ISO 10303-41, si_prefix.
constexpr std::array<Prefix, 16> prefixes = {{{"EXA", "E", 1e18},
                                              {"PETA", "P", 1e15},
                                              {"TERA", "T", 1e12},
                                              {"GIGA", "G", 1e9},
                                              {"MEGA", "M", 1e6},
                                              {"KILO", "k", 1e3},
                                              {"HECTO", "h", 1e2},
                                              {"DECA", "da", 1e1},
                                              {"DECI", "d", 1e-1},
                                              {"CENTI", "c", 1e-2},
                                              {"MILLI", "m", 1e-3},
                                              {"MICRO", "u", 1e-6},
                                              {"NANO", "n", 1e-9},
                                              {"PICO", "p", 1e-12},
                                              {"FEMTO", "f", 1e-15},
                                              {"ATTO", "a", 1e-18}}};

// A length unit is SI_UNIT(prefix, .METRE.) or CONVERSION_BASED_UNIT(name, measure) with
// LENGTH_UNIT, the measure in another unit; both are complex records with NAMED_UNIT (ISO
// 10303-41). Names of the latter are free text, so that lengths decide.
constexpr int max_conversions = 8;  // inch of cm of m; more is a loop

std::optional<brep::LengthUnit> si_unit(const Reader& reader, std::uint32_t unit) {
  // SI_UNIT(prefix, name); in a simple record NAMED_UNIT's derived dimensions come first.
  const auto attributes = reader.attributes(unit, "SI_UNIT", 1, 2);
  if (attributes.empty() || !same_keyword(reader.enumeration(attributes[1]), "METRE"))
    return std::nullopt;
  const auto prefix = reader.enumeration(attributes[0]);
  if (prefix.empty()) return brep::LengthUnit{{}, "m", 1};
  for (const auto& known : prefixes) {
    if (same_keyword(prefix, known.name))
      return brep::LengthUnit{{}, std::string(known.symbol) + "m", known.factor};
  }
  return std::nullopt;
}

// The number of a MEASURE_WITH_UNIT, LENGTH_MEASURE(25.4), and its unit.
struct Measure {
  double value = 0;
  std::uint32_t unit = no_instance;
};

std::optional<Measure> measure(const Reader& reader, const std::vector<std::uint32_t>& attributes) {
  if (attributes.size() < 2 || reader.file().value(attributes[0]).kind != Part21Kind::typed)
    return std::nullopt;
  const auto number = reader.file().children(attributes[0]);
  const auto unit = reader.reference(attributes[1]);
  if (number.size() != 1 || !unit) return std::nullopt;
  const auto value = reader.real(number[0]);
  if (!value) return std::nullopt;
  return Measure{*value, *unit};
}

std::optional<Measure> measure_with_unit(const Reader& reader, std::uint32_t instance) {
  // LENGTH_MEASURE_WITH_UNIT and the others add nothing to MEASURE_WITH_UNIT.
  return measure(reader, reader.attributes(instance, "MEASURE_WITH_UNIT", 0, 2));
}

std::optional<brep::LengthUnit> length_unit(const Reader& reader, std::uint32_t unit,
                                            int depth = 0) {
  if (reader.is(unit, "SI_UNIT")) return si_unit(reader, unit);
  if (!reader.is(unit, "CONVERSION_BASED_UNIT") || !reader.is(unit, "LENGTH_UNIT"))
    return std::nullopt;
  const auto attributes = reader.attributes(unit, "CONVERSION_BASED_UNIT", 1, 1);
  if (attributes.empty()) return std::nullopt;
  brep::LengthUnit result{{}, reader.string(attributes[0]), 0};
  std::transform(result.name.begin(), result.name.end(), result.name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto factor = attributes.size() > 1 ? reader.reference(attributes[1]) : std::nullopt;
  const auto conversion = factor ? measure_with_unit(reader, *factor) : std::nullopt;
  if (conversion && depth < max_conversions) {
    if (const auto base = length_unit(reader, conversion->unit, depth + 1)) {
      result.metres = conversion->value * base->metres;
      // What files call a unit is anything: 'METRE', 'Inches', "IN". Its length says what it is.
      if (const KnownLengthUnit* known = length_unit_of(1000 * result.metres))
        result.name = known->name;
    }
  }
  return result;
}

double uncertainty(const Reader& reader, std::uint32_t context, const brep::LengthUnit& unit) {
  double largest = 0;
  const auto attributes = reader.attributes(context, "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT", 0, 1);
  if (!reader.is(context, "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT") || attributes.empty()) return 0;
  for (const auto instance : reader.references(attributes[0])) {
    const auto given =
        measure(reader, reader.attributes(instance, "UNCERTAINTY_MEASURE_WITH_UNIT", 0, 2));
    const auto own_unit = given ? length_unit(reader, given->unit) : std::nullopt;
    if (!own_unit) continue;
    const double scale =
        own_unit->metres > 0 && unit.metres > 0 ? own_unit->metres / unit.metres : 1.0;
    if (std::isfinite(given->value * scale)) largest = std::max(largest, given->value * scale);
  }
  return largest;
}

// Marks everything reached from the items of one representation. Styles refer to what they colour;
// the contexts of their representations say nothing of its lengths.
class Reach {
 public:
  Reach(const Reader& reader, const std::vector<bool>& representation)
      : reader_(&reader),
        representation_(&representation),
        mark_(reader.file().instances().size(), -1),
        style_(reader.file().instances().size(), false) {
    for (const auto k : reader.file().named({"STYLED_ITEM", "OVER_RIDING_STYLED_ITEM",
                                             "CONTEXT_DEPENDENT_OVER_RIDING_STYLED_ITEM"}))
      style_[k] = true;
  }

  void follow(std::uint32_t from, int context) {
    stack_.assign(1, from);
    while (!stack_.empty()) {
      const auto instance = stack_.back();
      stack_.pop_back();
      const auto& record = reader_->file().instance(instance);
      for (auto k = record.first; k < record.last; ++k) {
        const auto target = reader_->reference(k);
        if (!target || (*representation_)[*target] || style_[*target] || mark_[*target] == context)
          continue;
        mark_[*target] = context;
        visited_.emplace_back(*target, context);
        stack_.push_back(*target);
      }
    }
  }

  [[nodiscard]] const std::vector<std::pair<std::uint32_t, int>>& visited() const {
    return visited_;
  }

 private:
  const Reader* reader_;
  const std::vector<bool>* representation_;
  std::vector<int> mark_;
  std::vector<bool> style_;
  std::vector<std::uint32_t> stack_;
  std::vector<std::pair<std::uint32_t, int>> visited_;
};

/// Leaves those to which more refers than what only shows shapes: their lengths are of pens and
/// texts.
void leave_contexts_of_shapes(const Reader& reader, std::vector<UnitContext>& contexts) {
  if (contexts.size() < 2) return;
  std::vector<bool> shows(reader.file().instances().size(), false);
  for (const std::string_view keyword : reader.file().keywords()) {
    if (!keyword.contains("PRESENTATION_REPRESENTATION") && keyword != "DRAUGHTING_MODEL") continue;
    for (const auto k : reader.file().named({keyword})) shows[k] = true;
  }
  std::vector<int> context_at(shows.size(), -1);
  for (std::size_t c = 0; c < contexts.size(); ++c)
    context_at[contexts[c].instance] = static_cast<int>(c);
  std::vector<bool> referred(contexts.size(), false);
  for (std::uint32_t k = 0; k < shows.size(); ++k) {
    if (shows[k]) continue;
    const auto& record = reader.file().instance(k);
    for (auto value = record.first; value < record.last; ++value) {
      const auto target = reader.reference(value);
      if (target && context_at[*target] >= 0)
        referred[static_cast<std::size_t>(context_at[*target])] = true;
    }
  }
  std::vector<UnitContext> left;
  for (std::size_t c = 0; c < contexts.size(); ++c) {
    if (referred[c]) left.push_back(contexts[c]);
  }
  if (!left.empty()) contexts = std::move(left);
}

}  // namespace

std::vector<UnitContext> read_unit_contexts(const Reader& reader) {
  std::vector<UnitContext> result;
  for (const auto k : reader.file().named({"GLOBAL_UNIT_ASSIGNED_CONTEXT"})) {
    const auto attributes = reader.attributes(k, "GLOBAL_UNIT_ASSIGNED_CONTEXT", 0, 1);
    if (attributes.empty()) continue;
    for (const auto unit : reader.references(attributes[0])) {
      auto length = length_unit(reader, unit);
      if (!length) continue;
      length->context = "#" + std::to_string(reader.file().instance(k).id);
      const double gap = uncertainty(reader, k, *length);
      result.push_back({k, *std::move(length), gap});
      break;
    }
  }
  leave_contexts_of_shapes(reader, result);
  return result;
}

std::vector<int> contexts_of(const Reader& reader, const std::vector<UnitContext>& contexts,
                             const std::vector<std::uint32_t>& instances) {
  std::vector<int> result(instances.size(), contexts.size() == 1 ? 0 : -1);
  if (contexts.size() < 2 || instances.empty()) return result;
  const auto count = reader.file().instances().size();
  std::vector<int> context_at(count, -1);
  for (std::size_t c = 0; c < contexts.size(); ++c)
    context_at[contexts[c].instance] = static_cast<int>(c);
  std::vector<bool> representation(count, false);
  std::vector<std::vector<std::uint32_t>> of_context(contexts.size());
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto& record = reader.file().instance(k);
    for (auto value = record.first; value < record.last; ++value) {
      const auto target = reader.reference(value);
      if (!target || context_at[*target] < 0) continue;
      representation[k] = true;
      of_context[static_cast<std::size_t>(context_at[*target])].push_back(k);
    }
  }
  std::vector<int> found(count, -1);
  std::vector<bool> ambiguous(count, false);
  Reach reach(reader, representation);
  for (std::size_t c = 0; c < contexts.size(); ++c) {
    for (const auto from : of_context[c]) reach.follow(from, static_cast<int>(c));
  }
  for (const auto& [instance, context] : reach.visited()) {
    const auto same_unit = [&](int a, int b) {
      return contexts[static_cast<std::size_t>(a)].unit.name ==
             contexts[static_cast<std::size_t>(b)].unit.name;
    };
    if (found[instance] >= 0 && !same_unit(found[instance], context)) ambiguous[instance] = true;
    if (found[instance] < 0) found[instance] = context;
  }
  for (std::size_t k = 0; k < instances.size(); ++k) {
    if (!ambiguous[instances[k]]) result[k] = found[instances[k]];
  }
  return result;
}

}  // namespace knead::step
