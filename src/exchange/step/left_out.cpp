#include "left_out.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <unordered_set>

#include "data.hpp"
#include "exchange/left_out_list.hpp"
#include "faces.hpp"
#include "free_curves.hpp"
#include "item_kinds.hpp"
#include "knead/base/printable.hpp"

namespace knead::step {
namespace {

using Index = std::uint32_t;

class Unread {
 public:
  explicit Unread(const File& file)
      : model_(file.model()), records_(file.data().of), reader_(file.data().records) {
    for (const FaceRecord& face : records_.faces) faces_.insert(face.instance);
  }

  std::vector<LeftOut> list() {
    add_curves();
    add_faces();
    add_standing();
    add_edges();
    add_pictures();
    add_kinds();
    add_empty_parts();
    return list_.take();
  }

 private:
  [[nodiscard]] std::string name(Index instance) const { return name_of(reader_, instance); }

  /// B-spline curves that would be read if they could.
  void add_curves() {
    std::vector<UnreadableCurve> unreadable;
    static_cast<void>(free_curves(reader_, &unreadable));
    for (const auto& [instance, reason] : unreadable)
      list_.add(
          {"curve that cannot be read", "curves that cannot be read", reason.what, reason.remedy},
          name(instance));
  }

  /// Of which not even the record can be followed.
  void add_faces() {
    for (const Index k : reader_.file().named({"ADVANCED_FACE", "FACE_SURFACE", "FACE"})) {
      if (!faces_.contains(k))
        list_.add({"face that cannot be read", "faces that cannot be read",
                   "its record has no bounds or no surface", "check that the file is complete"},
                  name(k));
    }
  }

  /// What representations of shape and sets of geometry hold directly.
  void add_standing() {
    const Part21File& file = reader_.file();
    std::unordered_set<Index> elsewhere;  // representations of properties, sets of annotations
    for (const std::string_view kind : file.keywords()) {
      const bool annotation = is_annotation(kind);
      if (!annotation && !same_kind(kind, "PROPERTY_DEFINITION_REPRESENTATION")) continue;
      for (const Index k : file.named({kind}))
        each_reference(k, [&](Index target) { elsewhere.insert(target); });
    }
    std::set<Index> seen;
    for (const std::string_view kind : file.keywords()) {
      const bool set = same_kind(kind, "GEOMETRIC_SET") || same_kind(kind, "GEOMETRIC_CURVE_SET");
      if (!set && !holds_shape(kind)) continue;
      for (const Index k : file.named({kind})) {
        if (elsewhere.contains(k)) continue;
        const auto attributes = set ? reader_.attributes(k, "GEOMETRIC_SET", 1, 1)
                                    : reader_.attributes(k, "REPRESENTATION", 0, 2);
        if (attributes.empty()) continue;
        for (const Index item : reader_.references(attributes[set ? 0 : 1])) {
          if (seen.insert(item).second) add_item(item);
        }
      }
    }
  }

  void add_item(Index item) {
    const auto is_any = [&](std::span<const std::string_view> kinds) {
      return std::ranges::any_of(kinds,
                                 [&](std::string_view kind) { return reader_.is(item, kind); });
    };
    if (is_any(read_items) || is_b_spline_curve(reader_, item)) return;
    if (is_any(point_kinds))
      return list_.add({"point", "points", "a point has no surface"}, name(item));
    if (is_any(curve_kinds)) {
      return list_.add({"curve that is no B-spline", "curves that are no B-splines",
                        "only B-spline curves are read where they stand for themselves",
                        "convert them to B-spline curves in the program that wrote the file"},
                       name(item));
    }
    if (is_any(surface_kinds)) return add_surface(item);
    if (is_listed_kind(item)) return;
    const auto& record = reader_.file().instance(item);
    const std::string kind = printable(reader_.file().keyword(record.first), 80);
    list_.add({"item " + kind, "items " + kind, "items of this kind are not read"}, name(item));
  }

  void add_surface(Index item) {
    if (faces_.contains(item)) return;
    const auto below = untrimmed(reader_, item);
    const auto& splines = records_.surfaces;
    if (below && std::ranges::find(splines, *below) != splines.end()) return;
    // One that cannot be read has a reason of its own.
    if (below && std::ranges::find(model_.unreadable, name(*below), &brep::UnreadableSurface::id) !=
                     model_.unreadable.end())
      return;
    list_.add({"surface without a face", "surfaces without faces",
               "of surfaces that are no B-splines only what faces cover is shown"},
              name(item));
  }

  /// Wires.
  void add_edges() {
    const auto edges = reader_.file().named({"EDGE_CURVE"});
    if (edges.empty()) return;
    std::unordered_set<std::string> around;
    for (const brep::Face& face : model_.faces) {
      for (const brep::Index edge : brep::edges_around(face)) around.insert(model_.edges[edge].id);
    }
    for (const Index edge : edges) {
      if (!around.contains(name(edge)) && reader_.file().instance(edge).uses > 0)
        list_.add({"free edge", "free edges", "no face that is read is bounded by it"}, name(edge));
    }
  }

  void add_pictures() {
    for (const Index k : records_.tessellated.pictures)
      list_.add({"tessellated picture of a face", "tessellated pictures of faces",
                 "the exact face is shown"},
                name(k));
    if (records_.tessellated.too_many)
      list_.add({"use of a tessellated item", "uses of tessellated items",
                 "sets hold each other too often"});
  }

  /// The kinds that are never read, whatever refers to them. A record counts once.
  void add_kinds() {
    for (const KindGroup& group : kind_groups) {
      std::set<Index> found;
      for (const std::string_view kind : reader_.file().keywords()) {
        if (!group.has(kind)) continue;
        for (const Index k : reader_.file().named({kind})) found.insert(k);
      }
      for (const Index k : found) {
        if (group.has == is_annotation || !records_.tessellated.annotations.contains(k))
          list_.add(group.kind, name(k));
      }
    }
  }

  [[nodiscard]] bool is_listed_kind(Index item) const {
    const auto& record = reader_.file().instance(item);
    for (auto k = record.first; k < record.last; k = reader_.file().value(k).next) {
      const std::string kind = upper_case(reader_.file().keyword(k));
      if (std::ranges::any_of(kind_groups, [&](const KindGroup& group) { return group.has(kind); }))
        return true;
    }
    return false;
  }

  /// Components without a shape: neither they nor what they are made of have geometry.
  void add_empty_parts() {
    if (model_.instances.empty() || !model_.assembly) return;
    std::set<std::string> shown, empty;
    for (const brep::Part& part : model_.assembly->parts) shown.insert(part.name);
    for (const brep::Instance& i : model_.instances) shown.insert(i.parent);
    for (const brep::Instance& i : model_.instances) {
      if (i.child.empty() || shown.contains(i.child) || !empty.insert(i.child).second) continue;
      list_.add({"part without geometry", "parts without geometry",
                 "the file does not hold its shape", "open the part's own file"},
                i.id);
    }
  }

  template <class Act>
  void each_reference(Index instance, const Act& act) const {
    const auto& record = reader_.file().instance(instance);
    for (auto value = record.first; value < record.last; ++value) {
      if (const auto target = reader_.reference(value)) act(*target);
    }
  }

  const brep::Model& model_;
  const ModelRecords& records_;
  Reader reader_;
  std::unordered_set<Index> faces_;
  detail::LeftOutList list_;
};

}  // namespace

std::vector<LeftOut> left_out(const File& file) { return Unread(file).list(); }

}  // namespace knead::step
