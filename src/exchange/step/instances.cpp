#include "instances.hpp"

#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <unordered_set>

namespace knead::step {
namespace {

using Index = std::uint32_t;

// Attribute k of an entity as an instance of the file.
std::optional<Index> attribute(const Reader& reader, Index instance, std::string_view entity,
                               std::size_t inherited, std::size_t k) {
  if (!reader.is(instance, entity)) return std::nullopt;
  const auto attributes = reader.attributes(instance, entity, inherited, k + 1);
  return attributes.empty() ? std::nullopt : reader.reference(attributes[k]);
}

/// Orthonormal axes as columns, from directions that need not be (ISO 10303-42, base_axis);
/// right-handed unless `y` is given otherwise. Axes that vanish or coincide are replaced.
Eigen::Matrix3d axes(const Point& z_axis, const Point& x_axis,
                     const std::optional<Point>& y_axis = {}) {
  constexpr double parallel = 1e-9;
  Eigen::Matrix3d result;
  const Point z = z_axis.norm() > 0 ? Point(z_axis.normalized()) : Point::UnitZ();
  Point x = x_axis - x_axis.dot(z) * z;
  if (!(x.norm() > parallel * x_axis.norm())) x = z.unitOrthogonal();
  x.normalize();
  Point y = z.cross(x);
  if (y_axis && y_axis->dot(y) < 0) y = -y;
  result << x, y, z;
  return result;
}

/// CARTESIAN_TRANSFORMATION_OPERATOR_3D. Its own attributes are the last five; writers differ in
/// those before.
std::optional<Eigen::Affine3d> read_operator(const Reader& reader, Index instance) {
  if (!reader.is(instance, "CARTESIAN_TRANSFORMATION_OPERATOR_3D") ||
      reader.file().instance(instance).complex) {
    return std::nullopt;
  }
  const auto all = reader.parameters(instance, "CARTESIAN_TRANSFORMATION_OPERATOR_3D");
  if (all.size() < 6) return std::nullopt;
  const auto values = std::span(all).last(5);  // axis1, axis2, local_origin, scale, axis3
  const auto direction = [&](std::size_t k) {
    const auto target = reader.reference(values[k]);
    return target ? reader.direction(*target) : std::nullopt;
  };
  const auto location = reader.reference(values[2]);
  const auto origin =
      location ? reader.point(*location) : Expected<Point>(input_error("no location"));
  if (!origin) return std::nullopt;
  const double scale = reader.real(values[3]).value_or(1);
  if (!(scale > 0 && scale <= largest_number)) return std::nullopt;
  const Point z = direction(4).value_or(Point::UnitZ());
  const bool upright = z.tail<2>().norm() > 1e-12 * z.norm();
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() =
      scale *
      axes(z, direction(0).value_or(upright ? Point::UnitX() : Point::UnitY()), direction(1));
  result.translation() = *origin;
  return result;
}

/// Either kind of frame.
std::optional<Eigen::Affine3d> read_frame(const Reader& reader, Index instance) {
  const auto placement = read_placement(reader, instance);
  if (!placement) return read_operator(reader, instance);
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear() = axes(placement->axis, placement->ref_direction);
  result.translation() = placement->origin;
  return result;
}

class Assemblies {
 public:
  // Where a part stands is said by four records that lead to one another:
  //   NEXT_ASSEMBLY_USAGE_OCCURRENCE(…, relating, related)   this product within that one
  //   (10303-44) PRODUCT_DEFINITION_SHAPE(…, usage)
  //   CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(relation, shape)
  //   REPRESENTATION_RELATIONSHIP(…, rep_1, rep_2) + …_WITH_TRANSFORMATION(operator)  (10303-43)
  // with ITEM_DEFINED_TRANSFORMATION(…, item_1, item_2): the frame item_1 of the component goes to
  // the frame item_2 of the assembly. A SHAPE_DEFINITION_REPRESENTATION joins a product to its
  // representation. MAPPED_ITEM(mapping_source, mapping_target) does the same without products. All
  // tables are filled in one pass, since records may come in any order.
  explicit Assemblies(const Reader& reader) : reader_(reader) {
    for (const Index k : reader.file().named(
             {"SHAPE_DEFINITION_REPRESENTATION", "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION",
              "REPRESENTATION_RELATIONSHIP", "SHAPE_REPRESENTATION_RELATIONSHIP"})) {
      if (reader.is(k, "SHAPE_DEFINITION_REPRESENTATION")) {
        const auto shape = attribute(reader, k, "SHAPE_DEFINITION_REPRESENTATION", 0, 0);
        const auto representation = attribute(reader, k, "SHAPE_DEFINITION_REPRESENTATION", 0, 1);
        const auto definition =
            shape ? attribute(reader, *shape, "PRODUCT_DEFINITION_SHAPE", 0, 2) : std::nullopt;
        if (!definition || !representation) continue;
        const auto [first, added] = representation_of_.try_emplace(*definition, *representation);
        if (!added) links_.emplace_back(first->second, *representation);
        definition_of_.try_emplace(*representation, *definition);
      } else if (reader.is(k, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION")) {
        const auto relation = attribute(reader, k, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", 0, 0);
        const auto shape = attribute(reader, k, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", 0, 1);
        const auto usage =
            shape ? attribute(reader, *shape, "PRODUCT_DEFINITION_SHAPE", 0, 2) : std::nullopt;
        if (relation && usage) relation_of_.try_emplace(*usage, *relation);
      } else {
        link(k);
      }
    }
  }

  std::optional<Component> usage(Index k) const {
    // ASSEMBLY_COMPONENT_USAGE: id, name, description, relating and related PRODUCT_DEFINITION.
    const auto attributes = reader_.attributes(k, "PRODUCT_DEFINITION_RELATIONSHIP", 0, 5);
    if (attributes.empty()) return std::nullopt;
    Component result;
    brep::Instance& instance = result.instance;
    instance.id = "#" + std::to_string(reader_.file().instance(k).id);
    instance.name = reader_.string(attributes[1]);
    if (instance.name.empty()) instance.name = reader_.string(attributes[0]);
    const auto parent = reader_.reference(attributes[3]);
    const auto child = reader_.reference(attributes[4]);
    if (parent) instance.parent = product(*parent);
    if (child) instance.child = product(*child);
    const auto relation = relation_of_.find(k);
    if (relation != relation_of_.end()) transform(relation->second, parent, child, result);
    if (result.parent == no_instance && parent) result.parent = representation(*parent);
    if (result.child == no_instance && child) result.child = representation(*child);
    return result;
  }

  /// A relation with a transformation that no usage refers to: rep_1 within rep_2.
  std::optional<Component> relation(Index k) const {
    Component result;
    result.instance.id = "#" + std::to_string(reader_.file().instance(k).id);
    transform(k, std::nullopt, std::nullopt, result);
    if (result.parent == no_instance || result.child == no_instance) return std::nullopt;
    result.instance.parent = product_of_representation(result.parent);
    result.instance.child = product_of_representation(result.child);
    return result;
  }

  std::optional<Component> mapped_item(Index k) const {
    const auto source = attribute(reader_, k, "MAPPED_ITEM", 1, 0);
    const auto target = attribute(reader_, k, "MAPPED_ITEM", 1, 1);
    if (!source || !target) return std::nullopt;
    Component result;
    result.instance.id = "#" + std::to_string(reader_.file().instance(k).id);
    result.instance.name = reader_.item_name(k);
    result.instance.placement = read_placement(reader_, *target);
    result.place = read_frame(reader_, *target);
    if (const auto origin = attribute(reader_, *source, "REPRESENTATION_MAP", 0, 0)) {
      result.instance.frame = read_placement(reader_, *origin);
      result.frame = read_frame(reader_, *origin);
    }
    if (const auto mapped = attribute(reader_, *source, "REPRESENTATION_MAP", 0, 1)) {
      result.instance.child = product_of_representation(*mapped);
      result.child = *mapped;
    }
    return result;
  }

  /// Of each representation of a product: its name.
  std::unordered_map<Index, std::string> products() const {
    std::unordered_map<Index, std::string> result;
    for (const auto& [representation, definition] : definition_of_) {
      if (!reader_.is(definition, "NEXT_ASSEMBLY_USAGE_OCCURRENCE"))
        result.emplace(representation, product(definition));
    }
    return result;
  }

  /// Relations that usages refer to.
  std::unordered_set<Index> used_relations() const {
    std::unordered_set<Index> result;
    for (const auto& [usage, relation] : relation_of_) result.insert(relation);
    return result;
  }

  const std::vector<std::pair<Index, Index>>& links() const { return links_; }

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
    const auto attributes = reader_.attributes(k, "REPRESENTATION_RELATIONSHIP", 0, 4);
    if (attributes.empty()) return;
    const auto first = reader_.reference(attributes[2]);
    const auto second = reader_.reference(attributes[3]);
    if (!first || !second) return;
    linked_.try_emplace(*first, *second);
    linked_.try_emplace(*second, *first);
    links_.emplace_back(*first, *second);
  }

  Index representation(Index definition) const {
    const auto found = representation_of_.find(definition);
    return found == representation_of_.end() ? no_instance : found->second;
  }

  // PRODUCT_DEFINITION -> PRODUCT_DEFINITION_FORMATION -> PRODUCT, by position: each has subtypes
  // with other names.
  std::string product(Index definition) const {
    const auto step = [this](Index from, std::string_view entity,
                             std::size_t k) -> std::optional<Index> {
      const auto attributes = reader_.attributes(from, entity, 0, k + 1);
      return attributes.empty() ? std::nullopt : reader_.reference(attributes[k]);
    };
    const auto formation = step(definition, "PRODUCT_DEFINITION", 2);
    const auto made =
        formation ? step(*formation, "PRODUCT_DEFINITION_FORMATION", 2) : std::nullopt;
    if (!made || !reader_.is(*made, "PRODUCT")) return {};
    const auto attributes = reader_.attributes(*made, "PRODUCT", 0, 2);
    if (attributes.empty()) return {};
    const auto name = reader_.string(attributes[1]);
    return name.empty() ? reader_.string(attributes[0]) : name;
  }

  void transform(Index relation, std::optional<Index> parent, std::optional<Index> child,
                 Component& result) const {
    const auto transformation =
        attribute(reader_, relation, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION", 4, 0);
    const auto attributes = reader_.attributes(relation, "REPRESENTATION_RELATIONSHIP", 0, 4);
    if (!transformation || attributes.empty()) return;
    // rep_1 is the component by convention (CAx-IF recommended practice); some writers reverse it.
    const auto rep_1 = reader_.reference(attributes[2]);
    const auto rep_2 = reader_.reference(attributes[3]);
    const auto has = [this](std::optional<Index> definition, std::optional<Index> representation) {
      if (!definition || !representation) return false;
      const auto found = representation_of_.find(*definition);
      return found != representation_of_.end() && found->second == *representation;
    };
    const bool turned =
        (has(child, rep_2) && !has(child, rep_1)) || (has(parent, rep_1) && !has(parent, rep_2));
    result.child = (turned ? rep_2 : rep_1).value_or(no_instance);
    result.parent = (turned ? rep_1 : rep_2).value_or(no_instance);
    if (auto moved = read_operator(reader_, *transformation)) {
      result.place = turned ? moved->inverse() : *moved;
      result.frame = Eigen::Affine3d::Identity();
      return;
    }
    const auto first = attribute(reader_, *transformation, "ITEM_DEFINED_TRANSFORMATION", 0, 2);
    const auto second = attribute(reader_, *transformation, "ITEM_DEFINED_TRANSFORMATION", 0, 3);
    if (!first || !second) return;
    result.instance.frame = read_placement(reader_, turned ? *second : *first);
    result.instance.placement = read_placement(reader_, turned ? *first : *second);
    result.frame = read_frame(reader_, turned ? *second : *first);
    result.place = read_frame(reader_, turned ? *first : *second);
  }

  const Reader& reader_;
  std::unordered_map<Index, Index> representation_of_;  // of a PRODUCT_DEFINITION
  std::unordered_map<Index, Index> definition_of_;      // and back
  std::unordered_map<Index, Index> relation_of_;        // of a NEXT_ASSEMBLY_USAGE_OCCURRENCE
  std::unordered_map<Index, Index> linked_;     // representations related without a transformation
  std::vector<std::pair<Index, Index>> links_;  // all of these
};

/// One pass over all references of the file, in place of a search for each item.
/// For each mapped item, the representation that lists it.
std::unordered_map<Index, Index> holders(const Reader& reader, const std::vector<Index>& mapped) {
  std::unordered_map<Index, Index> result;
  for (const auto k : mapped) result.emplace(k, no_instance);
  if (mapped.empty()) return result;
  for (Index k = 0; k < reader.file().instances().size(); ++k) {
    const auto& record = reader.file().instance(k);
    std::optional<bool>
        representation;  // looked at once per record: it may list any number of items
    for (auto value = record.first; value < record.last; ++value) {
      const auto target = reader.reference(value);
      const auto found = target ? result.find(*target) : result.end();
      // A representation, and not a style, which has (name, styles, item), or a layer: (name,
      // items, context).
      if (found == result.end() || found->second != no_instance) continue;
      if (!representation) {
        const auto attributes = reader.attributes(k, "REPRESENTATION", 0, 3);
        const auto context = attributes.size() >= 3 && reader.is_list(attributes[1])
                                 ? reader.reference(attributes[2])
                                 : std::nullopt;
        representation = context && !result.contains(*context);
      }
      if (*representation) found->second = k;
    }
  }
  return result;
}

/// AXIS2_PLACEMENT_2D: an axis along z.
std::optional<brep::AxisPlacement> read_placement_in_parameters(const Reader& reader,
                                                                std::uint32_t instance) {
  const bool complex = reader.file().instance(instance).complex;
  const auto location = complex ? attribute(reader, instance, "PLACEMENT", 0, 0)
                                : attribute(reader, instance, "AXIS2_PLACEMENT_2D", 1, 0);
  const auto origin =
      location ? reader.point(*location) : Expected<Point>(input_error("no location"));
  if (!reader.is(instance, "AXIS2_PLACEMENT_2D") || !origin) return std::nullopt;
  brep::AxisPlacement result{*origin};
  const std::size_t inherited = complex ? 0 : 2;
  if (const auto x = attribute(reader, instance, "AXIS2_PLACEMENT_2D", inherited, 0)) {
    result.ref_direction = reader.direction(*x).value_or(result.ref_direction);
  }
  return result;
}

}  // namespace

std::optional<brep::AxisPlacement> read_placement(const Reader& reader, std::uint32_t instance) {
  if (reader.is_in_parameters()) return read_placement_in_parameters(reader, instance);
  if (!reader.is(instance, "AXIS2_PLACEMENT_3D")) return std::nullopt;
  const auto record_is_complex = reader.file().instance(instance).complex;
  const auto location = record_is_complex ? attribute(reader, instance, "PLACEMENT", 0, 0)
                                          : attribute(reader, instance, "AXIS2_PLACEMENT_3D", 1, 0);
  const auto origin =
      location ? reader.point(*location) : Expected<Point>(input_error("no location"));
  if (!origin) return std::nullopt;
  brep::AxisPlacement result{*origin};
  const std::size_t inherited = record_is_complex ? 0 : 2;
  if (const auto axis = attribute(reader, instance, "AXIS2_PLACEMENT_3D", inherited, 0)) {
    result.axis = reader.direction(*axis).value_or(result.axis);
  }
  // ISO 10303-42, first_proj_axis: the x axis, or the y axis where the first is along the axis
  // itself.
  if (result.axis.tail<2>().norm() <= 1e-12 * result.axis.norm())
    result.ref_direction = Point::UnitY();
  if (const auto x = attribute(reader, instance, "AXIS2_PLACEMENT_3D", inherited, 1)) {
    result.ref_direction = reader.direction(*x).value_or(result.ref_direction);
  }
  return result;
}

Structure read_structure(const Reader& reader) {
  const Assemblies assemblies(reader);
  const auto used = assemblies.used_relations();
  Structure result;
  std::vector<Index> mapped, relations;
  for (const Index k : reader.file().named({"NEXT_ASSEMBLY_USAGE_OCCURRENCE", "MAPPED_ITEM",
                                            "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION"})) {
    if (reader.is(k, "NEXT_ASSEMBLY_USAGE_OCCURRENCE")) {
      if (auto usage = assemblies.usage(k)) result.components.push_back(*std::move(usage));
    } else if (reader.is(k, "MAPPED_ITEM")) {
      mapped.push_back(k);
    } else if (!used.contains(k)) {
      relations.push_back(k);
    }
  }
  const auto holder = holders(reader, mapped);
  for (const auto k : mapped) {
    auto item = assemblies.mapped_item(k);
    if (!item) continue;
    item->parent = holder.at(k);
    if (item->parent != no_instance)
      item->instance.parent = assemblies.product_of_representation(item->parent);
    result.components.push_back(*std::move(item));
  }
  for (const auto k : relations) {
    if (auto component = assemblies.relation(k)) result.components.push_back(*std::move(component));
  }
  result.linked = assemblies.links();
  result.product_of = assemblies.products();
  return result;
}

}  // namespace knead::step
