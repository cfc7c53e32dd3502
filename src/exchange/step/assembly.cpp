#include "assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>

#include "brep/part_graph.hpp"
#include "faces.hpp"
#include "instances.hpp"
#include "knead/base/printable.hpp"

namespace knead::step {
namespace {

using Index = std::uint32_t;
constexpr std::size_t visits_per_record = 64;  // by parts that share records

/// Representations that are the same part, by relationships without a transformation.
/// A SHAPE_REPRESENTATION_RELATIONSHIP without a transformation says that two representations are
/// one shape (ISO 10303-41), and may chain any number of them: union–find with path halving.
class Classes {
 public:
  Index add(Index representation) {
    const auto [at, added] = at_.try_emplace(representation, static_cast<Index>(parent_.size()));
    if (added) {
      parent_.push_back(at->second);
      representations_.push_back(representation);
    }
    return at->second;
  }
  void join(Index a, Index b) {
    const Index first = find(add(a)), second = find(add(b));
    parent_[std::max(first, second)] = std::min(first, second);
  }
  [[nodiscard]] Index find(Index k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  [[nodiscard]] Index of(Index representation) { return find(at_.at(representation)); }
  [[nodiscard]] const std::vector<Index>& representations() const { return representations_; }
  [[nodiscard]] std::size_t size() const { return parent_.size(); }

 private:
  std::unordered_map<Index, Index> at_;
  std::vector<Index> parent_, representations_;
};

/// The records that a part holds.
struct Content {
  std::vector<Index> surfaces, faces, curves;
};

class Builder {
 public:
  Builder(const Reader& reader, const brep::Model& model, const ModelRecords& records)
      : reader_(reader), model_(model), records_(records) {}

  Expected<brep::Assembly> build(const Structure& structure) {
    join(structure);
    connect(structure);
    if (auto status = graph_->place(model_.length_unit(), result_); !status)
      return std::unexpected(status.error());
    if (auto status = fill(); !status) return std::unexpected(status.error());
    std::vector<Index> in_order;
    for (Index k = 0; k < graph_->size(); ++k) {
      if ((*graph_)[k].product) in_order.push_back(k);
    }
    std::ranges::sort(in_order, {}, [&](Index k) { return groups_.representations()[k]; });
    for (const Index k : in_order) {
      Content& c = contents_[k];
      if (c.surfaces.empty() && c.faces.empty() && c.curves.empty()) continue;
      brep::PartGraph::Node& node = (*graph_)[k];
      const std::string unit = node.unit.name.empty() ? "unknown" : node.unit.name;
      result_.parts.push_back({node.name, unit, names(c.surfaces), names(c.faces), names(c.curves),
                               std::move(node.places)});
    }
    brep::add_rest(model_, result_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::vector<std::string> names(std::vector<Index>& records) const {
    std::ranges::sort(records);
    records.erase(std::ranges::unique(records).begin(), records.end());
    std::vector<std::string> result;
    for (const Index k : records) result.push_back(name_of(reader_, k));
    return result;
  }

  void join(const Structure& structure) {
    for (const auto& [representation, name] : structure.product_of)
      products_.emplace(representation, name);
    for (const auto& [representation, name] : products_) groups_.add(representation);
    for (const Component& c : structure.components) {
      if (c.parent != no_instance) groups_.add(c.parent);
      if (c.child != no_instance) groups_.add(c.child);
    }
    for (const auto& [a, b] : structure.linked) groups_.join(a, b);
    graph_.emplace(groups_.size());
    contents_.resize(groups_.size());
    std::unordered_map<std::string, const brep::LengthUnit*> units;
    for (const brep::LengthUnit& unit : model_.units) units.emplace(unit.context, &unit);
    for (std::size_t k = 0; k < groups_.size(); ++k) {
      brep::PartGraph::Node& c = (*graph_)[groups_.find(static_cast<Index>(k))];
      const Index representation = groups_.representations()[k];
      if (const auto product = products_.find(representation); product != products_.end()) {
        if (!c.product) c.name = product->second;
        c.product = true;
      }
      const auto attributes = reader_.attributes(representation, "REPRESENTATION", 0, 3);
      const auto context = attributes.empty() ? std::nullopt : reader_.reference(attributes[2]);
      const auto unit = context ? units.find(name_of(reader_, *context)) : units.end();
      if (c.unit.name.empty() && unit != units.end()) c.unit = *unit->second;
    }
  }

  void connect(const Structure& structure) {
    for (const Component& c : structure.components) {
      const brep::Instance& i = c.instance;
      if (c.child == no_instance || c.parent == no_instance) continue;  // a product without a shape
      const Index parent = groups_.of(c.parent), child = groups_.of(c.child);
      if (parent == child) {
        warn(i, "is placed within itself; that is left out");
        continue;
      }
      // An ITEM_DEFINED_TRANSFORMATION (ISO 10303-43) takes one frame, given in the part, to
      // another one, the place in the assembly. Lengths of the part become those of the assembly in
      // between.
      Eigen::Affine3d move = Eigen::Affine3d::Identity();
      if (c.place && c.frame) {
        const double scale = brep::unit_ratio((*graph_)[child].unit, (*graph_)[parent].unit);
        move = *c.place * Eigen::Scaling(scale) * c.frame->inverse();
      }
      if (!c.place || !c.frame || !move.matrix().allFinite()) {
        move = Eigen::Affine3d::Identity();
        warn(i, "has no placement that can be read; it stands at the origin");
      }
      graph_->use(parent, child, move);
    }
  }

  void warn(const brep::Instance& i, const char* what) {
    result_.warnings.push_back(
        fmt::format("{}: \"{}\" {}", i.id, printable(i.child.empty() ? i.name : i.child), what));
  }

  /// Gives every part what the items of its representations refer to.
  /// What a part holds is all that the items of its representations lead to by references of any
  /// kind, up to other representations: the paths from a representation to its surfaces differ too
  /// much among schemas and writers to be listed. Cost: the records reached, once per part; parts
  /// that share records are bounded by `visits_per_record`.
  Expected<void> fill() {
    const std::size_t records = reader_.file().instances().size();
    // 1: a face or tessellated item, 2: a B-spline surface without faces (others are also referred
    // to by the curves of their neighbours), 3: a representation, 4: a curve that stands for itself
    std::vector<std::uint8_t> kind(records, 0);
    std::vector<bool> spline(records, false);
    std::unordered_map<Index, Index> below;  // the surface of each face
    for (const Index k : records_.surfaces) spline[k] = true;
    for (const FaceRecord& face : records_.faces) {
      kind[face.instance] = 1;
      if (face.surface != no_instance && spline[face.surface])
        below.emplace(face.instance, face.surface);
    }
    for (std::size_t k = 0; k < model_.surfaces.size(); ++k) {
      if (model_.surfaces[k].faces == 0) kind[records_.surfaces[k]] = 2;
    }
    for (const TessellatedRecord& item : records_.tessellated.shown) kind[item.instance] = 1;
    for (const Index k : records_.curves) kind[k] = 4;
    for (const Index k : groups_.representations()) kind[k] = 3;
    std::vector<Index> mark(records, no_instance), stack;
    std::size_t visits = 0;
    for (Index k = 0; k < groups_.size(); ++k) {
      const Index group = groups_.find(k);
      Content& c = contents_[group];
      const auto attributes =
          reader_.attributes(groups_.representations()[k], "REPRESENTATION", 0, 3);
      if (!(*graph_)[group].product || attributes.empty()) continue;
      const auto visit = [&](Index target) {
        if (kind[target] == 3 || mark[target] == group) return;
        mark[target] = group;
        if (kind[target] == 1) {
          c.faces.push_back(target);
          if (const auto on = below.find(target); on != below.end())
            c.surfaces.push_back(on->second);
        }
        if (kind[target] == 2) c.surfaces.push_back(target);
        if (kind[target] == 4) c.curves.push_back(target);
        stack.push_back(target);
        ++visits;
      };
      for (const Index item : reader_.references(attributes[1])) visit(item);
      while (!stack.empty() && visits <= visits_per_record * records) {
        const auto& record = reader_.file().instance(stack.back());
        stack.pop_back();
        for (auto value = record.first; value < record.last; ++value) {
          if (const auto target = reader_.reference(value)) visit(*target);
        }
      }
      if (!stack.empty())
        return input_error("too many parts share the same geometry", {},
                           "open the files of its parts");
    }
    return {};
  }

  const Reader& reader_;
  const brep::Model& model_;
  const ModelRecords& records_;
  Classes groups_;
  std::map<Index, std::string> products_;
  std::optional<brep::PartGraph> graph_;
  std::vector<Content> contents_;
  brep::Assembly result_;
};

}  // namespace

Expected<brep::Assembly> read_assembly(const Reader& reader, const Structure& structure,
                                       const brep::Model& model, const ModelRecords& records) {
  auto result = Builder(reader, model, records).build(structure);
  if (!result) result.error().file = model.name;
  return result;
}

}  // namespace knead::step
