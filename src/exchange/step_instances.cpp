#include "step_instances.hpp"

#include <optional>
#include <string_view>
#include <unordered_map>

namespace knead::step {
namespace {

using Index = std::uint32_t;

// Attribute k of an entity as an instance of the file.
std::optional<Index> attribute(const Reader& reader, Index instance, std::string_view entity, std::size_t inherited,
                               std::size_t k) {
  if (!reader.is(instance, entity)) return std::nullopt;
  const auto own = reader.attributes(instance, entity, inherited, k + 1);
  return own.empty() ? std::nullopt : reader.reference(own[k]);
}

class Assemblies {
 public:
  explicit Assemblies(const Reader& reader) : reader_(reader) {
    const auto count = static_cast<Index>(reader.file().instances().size());
    for (Index k = 0; k < count; ++k) {
      if (reader.is(k, "SHAPE_DEFINITION_REPRESENTATION")) {
        const auto shape = attribute(reader, k, "SHAPE_DEFINITION_REPRESENTATION", 0, 0);
        const auto representation = attribute(reader, k, "SHAPE_DEFINITION_REPRESENTATION", 0, 1);
        const auto definition = shape ? attribute(reader, *shape, "PRODUCT_DEFINITION_SHAPE", 0, 2) : std::nullopt;
        if (!definition || !representation) continue;
        representation_of_.try_emplace(*definition, *representation);
        definition_of_.try_emplace(*representation, *definition);
      } else if (reader.is(k, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")) {
        const auto relation = attribute(reader, k, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", 0, 0);
        const auto shape = attribute(reader, k, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", 0, 1);
        const auto usage = shape ? attribute(reader, *shape, "PRODUCT_DEFINITION_SHAPE", 0, 2) : std::nullopt;
        if (relation && usage) relation_of_.try_emplace(*usage, *relation);
      } else if (reader.is(k, "REPRESENTATION_RELATIONSHIP") || reader.is(k, "SHAPE_REPRESENTATION_RELATIONSHIP")) {
        link(k);
      }
    }
  }

  std::optional<Instance> usage(Index k) const {
    // ASSEMBLY_COMPONENT_USAGE: id, name, description, relating and related PRODUCT_DEFINITION.
    const auto own = reader_.attributes(k, "PRODUCT_DEFINITION_RELATIONSHIP", 0, 5);
    if (own.empty()) return std::nullopt;
    Instance result;
    result.id = "#" + std::to_string(reader_.file().instance(k).id);
    result.name = reader_.string(own[1]);
    if (result.name.empty()) result.name = reader_.string(own[0]);
    const auto parent = reader_.reference(own[3]);
    const auto child = reader_.reference(own[4]);
    if (parent) result.parent = product(*parent);
    if (child) result.child = product(*child);
    const auto relation = relation_of_.find(k);
    if (relation != relation_of_.end()) transform(relation->second, parent, child, result);
    return result;
  }

  std::optional<Instance> mapped_item(Index k) const {
    const auto source = attribute(reader_, k, "MAPPED_ITEM", 1, 0);
    const auto target = attribute(reader_, k, "MAPPED_ITEM", 1, 1);
    if (!source || !target) return std::nullopt;
    Instance result;
    result.id = "#" + std::to_string(reader_.file().instance(k).id);
    result.name = reader_.item_name(k);
    result.placement = read_placement(reader_, *target);
    if (const auto origin = attribute(reader_, *source, "REPRESENTATION_MAP", 0, 0)) {
      result.frame = read_placement(reader_, *origin);
    }
    if (const auto mapped = attribute(reader_, *source, "REPRESENTATION_MAP", 0, 1)) {
      result.child = product_of_representation(*mapped);
    }
    return result;
  }

  std::string product_of_representation(Index representation) const {
    const auto direct = definition_of_.find(representation);
    if (direct != definition_of_.end()) return product(direct->second);
    // A representation is often only related, without a transformation, to the one the product has.
    const auto linked = linked_.find(representation);
    if (linked == linked_.end()) return {};
    const auto definition = definition_of_.find(linked->second);
    return definition == definition_of_.end() ? std::string() : product(definition->second);
  }

 private:
  void link(Index k) {
    if (reader_.is(k, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION")) return;
    const auto own = reader_.attributes(k, "REPRESENTATION_RELATIONSHIP", 0, 4);
    if (own.empty()) return;
    const auto first = reader_.reference(own[2]);
    const auto second = reader_.reference(own[3]);
    if (!first || !second) return;
    linked_.try_emplace(*first, *second);
    linked_.try_emplace(*second, *first);
  }

  // PRODUCT_DEFINITION -> PRODUCT_DEFINITION_FORMATION -> PRODUCT, by position: each has subtypes with other names.
  std::string product(Index definition) const {
    const auto step = [this](Index from, std::string_view entity, std::size_t k) -> std::optional<Index> {
      const auto own = reader_.attributes(from, entity, 0, k + 1);
      return own.empty() ? std::nullopt : reader_.reference(own[k]);
    };
    const auto formation = step(definition, "PRODUCT_DEFINITION", 2);
    const auto made = formation ? step(*formation, "PRODUCT_DEFINITION_FORMATION", 2) : std::nullopt;
    if (!made || !reader_.is(*made, "PRODUCT")) return {};
    const auto own = reader_.attributes(*made, "PRODUCT", 0, 2);
    if (own.empty()) return {};
    const auto name = reader_.string(own[1]);
    return name.empty() ? reader_.string(own[0]) : name;
  }

  void transform(Index relation, std::optional<Index> parent, std::optional<Index> child, Instance& result) const {
    const auto transformation = attribute(reader_, relation, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION", 4, 0);
    const auto own = reader_.attributes(relation, "REPRESENTATION_RELATIONSHIP", 0, 4);
    if (!transformation || own.empty()) return;
    const auto first = attribute(reader_, *transformation, "ITEM_DEFINED_TRANSFORMATION", 0, 2);
    const auto second = attribute(reader_, *transformation, "ITEM_DEFINED_TRANSFORMATION", 0, 3);
    if (!first || !second) return;
    // rep_1 is the component by convention (CAx-IF recommended practice); some writers reverse it.
    const auto rep_1 = reader_.reference(own[2]);
    const auto rep_2 = reader_.reference(own[3]);
    const auto has = [this](std::optional<Index> definition, std::optional<Index> representation) {
      if (!definition || !representation) return false;
      const auto found = representation_of_.find(*definition);
      return found != representation_of_.end() && found->second == *representation;
    };
    const bool turned = (has(child, rep_2) && !has(child, rep_1)) || (has(parent, rep_1) && !has(parent, rep_2));
    result.frame = read_placement(reader_, turned ? *second : *first);
    result.placement = read_placement(reader_, turned ? *first : *second);
  }

  const Reader& reader_;
  std::unordered_map<Index, Index> representation_of_;  // of a PRODUCT_DEFINITION
  std::unordered_map<Index, Index> definition_of_;      // and back
  std::unordered_map<Index, Index> relation_of_;        // of a NEXT_ASSEMBLY_USAGE_OCCURRENCE
  std::unordered_map<Index, Index> linked_;             // representations related without a transformation
};

// For each mapped item, the representation that lists it.
std::unordered_map<Index, Index> holders(const Reader& reader, const std::vector<Index>& mapped) {
  std::unordered_map<Index, Index> result;
  for (const auto k : mapped) result.emplace(k, no_instance);
  if (mapped.empty()) return result;
  for (Index k = 0; k < reader.file().instances().size(); ++k) {
    const auto& record = reader.file().instance(k);
    std::optional<bool> representation;  // looked at once per record: it may list any number of items
    for (auto value = record.first; value < record.last; ++value) {
      const auto target = reader.reference(value);
      const auto found = target ? result.find(*target) : result.end();
      // A representation, and not a style or a layer: (name, items, context).
      if (found == result.end() || found->second != no_instance) continue;
      if (!representation) {
        const auto own = reader.attributes(k, "REPRESENTATION", 0, 3);
        representation = own.size() >= 3 && reader.is_list(own[1]) && reader.reference(own[2]);
      }
      if (*representation) found->second = k;
    }
  }
  return result;
}

}  // namespace

std::optional<AxisPlacement> read_placement(const Reader& reader, std::uint32_t instance) {
  if (!reader.is(instance, "AXIS2_PLACEMENT_3D")) return std::nullopt;
  const auto record_is_complex = reader.file().instance(instance).complex;
  const auto location = record_is_complex ? attribute(reader, instance, "PLACEMENT", 0, 0)
                                          : attribute(reader, instance, "AXIS2_PLACEMENT_3D", 1, 0);
  const auto origin = location ? reader.point(*location) : Expected<Point>(input_error("no location"));
  if (!origin) return std::nullopt;
  AxisPlacement result{*origin};
  const std::size_t inherited = record_is_complex ? 0 : 2;
  if (const auto axis = attribute(reader, instance, "AXIS2_PLACEMENT_3D", inherited, 0)) {
    result.axis = reader.direction(*axis).value_or(result.axis);
  }
  // ISO 10303-42, first_proj_axis: the x axis, or the y axis where the first is along the axis itself.
  if (result.axis.tail<2>().norm() <= 1e-12 * result.axis.norm()) result.ref_direction = Point::UnitY();
  if (const auto x = attribute(reader, instance, "AXIS2_PLACEMENT_3D", inherited, 1)) {
    result.ref_direction = reader.direction(*x).value_or(result.ref_direction);
  }
  return result;
}

std::vector<Instance> read_instances(const Reader& reader) {
  const Assemblies assemblies(reader);
  std::vector<Instance> result;
  std::vector<Index> mapped;
  for (Index k = 0; k < reader.file().instances().size(); ++k) {
    if (reader.is(k, "NEXT_ASSEMBLY_USAGE_OCCURRENCE")) {
      if (auto usage = assemblies.usage(k)) result.push_back(*std::move(usage));
    } else if (reader.is(k, "MAPPED_ITEM")) {
      mapped.push_back(k);
    }
  }
  const auto holder = holders(reader, mapped);
  for (const auto k : mapped) {
    auto item = assemblies.mapped_item(k);
    if (!item) continue;
    const auto representation = holder.at(k);
    if (representation != no_instance) item->parent = assemblies.product_of_representation(representation);
    result.push_back(*std::move(item));
  }
  return result;
}

}  // namespace knead::step
