#include <algorithm>
#include <array>

#include "faces.hpp"
#include "geometry.hpp"
#include "instances.hpp"
#include "item_kinds.hpp"
#include "tessellated.hpp"

namespace knead::step {
namespace {

using Index = std::uint32_t;
constexpr int most_set_nesting = 50;               // of sets
constexpr std::size_t set_visits_per_record = 16;  // of items that sets share
constexpr std::size_t free_visits = 10'000;

constexpr std::array<std::string_view, 4> item_kinds = {
    "TRIANGULATED_FACE", "COMPLEX_TRIANGULATED_FACE", "TRIANGULATED_SURFACE_SET",
    "COMPLEX_TRIANGULATED_SURFACE_SET"};
constexpr std::array<std::string_view, 3> set_kinds = {"TESSELLATED_SOLID", "TESSELLATED_SHELL",
                                                       "TESSELLATED_GEOMETRIC_SET"};

class Sets {
 public:
  explicit Sets(const Reader& reader) : reader_(reader) {}

  TessellatedRecords read() {
    items_ = reader_.file().named(item_kinds);
    for (const Index k : items_) item_places_.emplace(k, Item());
    for (const std::string_view kind : set_kinds) {
      for (const Index k : reader_.file().named({kind})) {
        const auto attributes = reader_.attributes(k, kind, 1, 1);
        sets_.emplace(
            k, attributes.empty() ? std::vector<Index>() : reader_.references(attributes[0]));
      }
    }
    note_annotations();
    if (items_.empty()) return std::move(result_);
    for (const FaceRecord& face : read_faces(reader_)) faces_.insert(face.instance);
    most_ = free_visits + set_visits_per_record * reader_.file().instances().size();
    std::unordered_set<Index> held;
    for (const auto& [set, members] : sets_) held.insert(members.begin(), members.end());
    for (const Index k : roots(held)) {
      if (!result_.annotations.contains(k))
        visit(k, Eigen::Affine3d::Identity(), no_instance, false, 0);
    }
    for (const Index k : items_) {
      Item& item = item_places_[k];
      if (item.picture && item.places.empty()) result_.pictures.push_back(k);
      if (!item.places.empty()) result_.shown.push_back({k, item.named, std::move(item.places)});
    }
    return std::move(result_);
  }

 private:
  struct Item {
    Index named = no_instance;
    bool picture = false;
    std::vector<Eigen::Affine3d> places;
  };

  /// Sets and items that nothing holds, in the order of the file.
  [[nodiscard]] std::vector<Index> roots(const std::unordered_set<Index>& held) const {
    std::vector<Index> result;
    for (const auto& [set, members] : sets_) {
      if (!held.contains(set)) result.push_back(set);
    }
    for (const Index k : items_) {
      if (!held.contains(k)) result.push_back(k);
    }
    std::ranges::sort(result);
    return result;
  }

  /// What annotations hold, sets within sets included.
  void note_annotations() {
    std::vector<Index> stack;
    for (const std::string_view kind : reader_.file().keywords()) {
      if (!is_annotation(kind)) continue;
      for (const Index k : reader_.file().named({kind})) {
        const auto& record = reader_.file().instance(k);
        for (auto value = record.first; value < record.last; ++value) {
          if (const auto target = reader_.reference(value)) stack.push_back(*target);
        }
      }
    }
    while (!stack.empty()) {
      const Index k = stack.back();
      stack.pop_back();
      if (!result_.annotations.insert(k).second) continue;
      if (const auto set = sets_.find(k); set != sets_.end())
        stack.insert(stack.end(), set->second.begin(), set->second.end());
    }
  }

  void visit(Index k, const Eigen::Affine3d& outer, Index named, bool picture, int depth) {
    if (depth > most_set_nesting || ++visits_ > most_) {
      result_.too_many = true;
      return;
    }
    if (!reader_.item_name(k).empty()) named = k;
    const bool linked = picture || is_linked(k);
    if (const auto item = item_places_.find(k); item != item_places_.end()) {
      item->second.named = named;
      if (linked)
        item->second.picture = true;
      else
        item->second.places.push_back(outer);
      return;
    }
    const auto set = sets_.find(k);
    if (set == sets_.end()) return;
    const Eigen::Affine3d place = outer * place_of(k);
    for (const Index member : set->second) visit(member, place, named, linked, depth + 1);
  }

  /// Where a REPOSITIONED_TESSELLATED_ITEM puts its content.
  [[nodiscard]] Eigen::Affine3d place_of(Index k) const {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (!reader_.is(k, "REPOSITIONED_TESSELLATED_ITEM")) return result;
    const auto attributes = reader_.attributes(k, "REPOSITIONED_TESSELLATED_ITEM", 1, 1);
    const auto target = attributes.empty() ? std::nullopt : reader_.reference(attributes[0]);
    const auto placement = target ? read_placement(reader_, *target) : std::nullopt;
    const auto frame = placement ? frame_of(*placement) : std::nullopt;
    if (!frame) return result;
    result.linear() << frame->x, frame->y, frame->z;
    result.translation() = frame->origin;
    return result;
  }

  /// Whether an item or set has a link to exact geometry that the file has faces of.
  [[nodiscard]] bool is_linked(Index k) const {
    std::vector<Index> links;
    std::size_t at = 1;
    if (reader_.is(k, "TESSELLATED_SOLID"))
      links = reader_.attributes(k, "TESSELLATED_SOLID", 1, 2);
    if (reader_.is(k, "TESSELLATED_SHELL"))
      links = reader_.attributes(k, "TESSELLATED_SHELL", 1, 2);
    if (reader_.is(k, "TRIANGULATED_FACE") || reader_.is(k, "COMPLEX_TRIANGULATED_FACE")) {
      links = reader_.attributes(k, "TESSELLATED_FACE", 1, 4);
      at = 3;
    }
    const auto target = links.empty() ? std::nullopt : reader_.reference(links[at]);
    return target && has_faces(*target);
  }

  [[nodiscard]] bool has_faces(Index target) const {
    if (faces_.contains(target)) return true;
    const auto solid = reader_.attributes(target, "MANIFOLD_SOLID_BREP", 1, 1);
    const bool is_solid =
        reader_.is(target, "MANIFOLD_SOLID_BREP") || reader_.is(target, "BREP_WITH_VOIDS");
    const auto shell =
        is_solid && !solid.empty() ? reader_.reference(solid[0]) : std::optional(target);
    if (!shell || !is_shell(*shell)) return false;
    const auto members = reader_.attributes(*shell, "CONNECTED_FACE_SET", 1, 1);
    if (members.empty()) return false;
    return std::ranges::any_of(reader_.references(members[0]),
                               [&](Index face) { return faces_.contains(face); });
  }

  [[nodiscard]] bool is_shell(Index k) const {
    return reader_.is(k, "CLOSED_SHELL") || reader_.is(k, "OPEN_SHELL") ||
           reader_.is(k, "CONNECTED_FACE_SET");
  }

  const Reader& reader_;
  std::vector<Index> items_;
  std::unordered_map<Index, Item> item_places_;
  std::unordered_map<Index, std::vector<Index>> sets_;
  std::unordered_set<Index> faces_;
  std::size_t visits_ = 0, most_ = 0;
  TessellatedRecords result_;
};

}  // namespace

TessellatedRecords tessellated_records(const Reader& reader) { return Sets(reader).read(); }

}  // namespace knead::step
