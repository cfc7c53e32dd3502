#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <numeric>
#include <unordered_map>

#include "knead/base/printable.hpp"
#include "knead/exchange/assembly.hpp"
#include "step_data.hpp"
#include "step_faces.hpp"
#include "step_instances.hpp"

namespace knead::step {
namespace {

using Index = std::uint32_t;
constexpr std::size_t longest_path = 1000;     // characters; deeper ones keep their end
constexpr std::size_t visits_per_record = 64;  // by parts that share records

/// Representations that are the same part, by relationships without a transformation.
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

struct Use {
  Index parent = 0, child = 0;  // classes
  Eigen::Affine3d move = Eigen::Affine3d::Identity();
};

struct PartClass {
  std::string name;
  LengthUnit unit;
  bool product = false;     // it, or what it is used in, belongs to the structure of products
  std::vector<Index> down;  // uses of which it is the parent
  std::size_t open = 0;     // uses of which it is the child, not yet followed
  std::vector<PartPlace> places;
  std::vector<Index> surfaces, faces, curves;  // records
};

double ratio(const LengthUnit& child, const LengthUnit& parent) {
  return child.metres > 0 && parent.metres > 0 ? child.metres / parent.metres : 1.0;
}

std::string below(const std::string& path, const std::string& name) {
  std::string result = path.empty() ? name : path + "/" + name;
  if (result.size() > longest_path) result = "…/" + name.substr(0, longest_path);
  return result;
}

class Builder {
 public:
  explicit Builder(const File& file) : file_(file), reader_(file.data().records) {}

  Expected<Assembly> build() {
    const Structure structure = read_structure(reader_);
    join(structure);
    connect(structure);
    if (auto done = place(); !done) return std::unexpected(done.error());
    if (auto done = fill(); !done) return std::unexpected(done.error());
    for (const Index k : in_order_) {
      PartClass& c = classes_[k];
      if (c.surfaces.empty() && c.faces.empty() && c.curves.empty()) continue;
      const std::string unit = c.unit.name.empty() ? "unknown" : c.unit.name;
      result_.parts.push_back({c.name, unit, names(c.surfaces), names(c.faces), names(c.curves), std::move(c.places)});
    }
    add_rest();
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
    for (const auto& [representation, name] : structure.product_of) products_.emplace(representation, name);
    for (const auto& [representation, name] : products_) groups_.add(representation);
    for (const Component& c : structure.components) {
      if (c.parent != no_instance) groups_.add(c.parent);
      if (c.child != no_instance) groups_.add(c.child);
    }
    for (const auto& [a, b] : structure.linked) groups_.join(a, b);
    classes_.resize(groups_.size());
    std::unordered_map<std::string, const LengthUnit*> units;
    for (const LengthUnit& unit : file_.length_units()) units.emplace(unit.context, &unit);
    for (std::size_t k = 0; k < groups_.size(); ++k) {
      PartClass& c = classes_[groups_.find(static_cast<Index>(k))];
      const Index representation = groups_.representations()[k];
      if (const auto product = products_.find(representation); product != products_.end()) {
        if (!c.product) c.name = product->second;
        c.product = true;
      }
      const auto own = reader_.attributes(representation, "REPRESENTATION", 0, 3);
      const auto context = own.empty() ? std::nullopt : reader_.reference(own[2]);
      const auto unit = context ? units.find(name_of(reader_, *context)) : units.end();
      if (c.unit.name.empty() && unit != units.end()) c.unit = *unit->second;
    }
  }

  void connect(const Structure& structure) {
    for (const Component& c : structure.components) {
      const Instance& i = c.instance;
      if (c.child == no_instance || c.parent == no_instance) continue;  // a product without a shape
      Use use{groups_.of(c.parent), groups_.of(c.child)};
      if (use.parent == use.child) {
        warn(i, "is placed within itself; that is left out");
        continue;
      }
      if (c.place && c.frame) {
        const double scale = ratio(classes_[use.child].unit, classes_[use.parent].unit);
        use.move = *c.place * Eigen::Scaling(scale) * c.frame->inverse();
      }
      if (!c.place || !c.frame || !use.move.matrix().allFinite()) {
        use.move = Eigen::Affine3d::Identity();
        warn(i, "has no placement that can be read; it stands at the origin");
      }
      classes_[use.parent].down.push_back(static_cast<Index>(uses_.size()));
      uses_.push_back(use);
    }
  }

  void warn(const Instance& i, const char* what) {
    result_.warnings.push_back(fmt::format("{}: \"{}\" {}", i.id, printable(i.child.empty() ? i.name : i.child), what));
  }

  /// Marks what hangs together with products; other representations, such as those of styles and views, place nothing.
  void mark() {
    std::deque<Index> ready;
    for (Index k = 0; k < classes_.size(); ++k) {
      if (classes_[k].product) ready.push_back(k);
    }
    if (ready.empty()) {
      for (const Use& use : uses_) {
        if (!std::exchange(classes_[use.parent].product, true)) ready.push_back(use.parent);
      }
    }
    while (!ready.empty()) {
      const Index k = ready.front();
      ready.pop_front();
      for (const Index u : classes_[k].down) {
        ++classes_[uses_[u].child].open;
        if (!std::exchange(classes_[uses_[u].child].product, true)) ready.push_back(uses_[u].child);
      }
    }
  }

  Expected<void> place() {
    mark();
    std::deque<Index> ready;
    const LengthUnit* model = nullptr;
    for (Index k = 0; k < classes_.size(); ++k) {
      PartClass& c = classes_[k];
      if (!c.product || groups_.find(k) != k) continue;
      in_order_.push_back(k);
      if (c.open > 0) continue;
      if (model == nullptr && !c.unit.name.empty()) model = &c.unit;
      PartPlace root{c.name};
      if (model != nullptr) root.to_model.scale(ratio(c.unit, *model));
      c.places.push_back(std::move(root));
      ready.push_back(k);
    }
    result_.unit = model != nullptr ? model->name : file_.length_unit();
    std::ranges::sort(in_order_, {}, [&](Index k) { return groups_.representations()[k]; });
    std::size_t count = ready.size(), followed = 0;
    const auto follow = [&](Index k) -> bool {
      ++followed;
      const std::vector<PartPlace> own = classes_[k].places;
      for (const Index u : classes_[k].down) {
        PartClass& child = classes_[uses_[u].child];
        count += own.size();
        if (count > max_places) return false;
        for (const PartPlace& p : own) {
          child.places.push_back({below(p.path, child.name), p.to_model * uses_[u].move});
        }
        if (--child.open == 0) ready.push_back(uses_[u].child);
      }
      return true;
    };
    while (!ready.empty()) {
      const Index k = ready.front();
      ready.pop_front();
      if (!follow(k)) {
        return input_error(fmt::format("the assembly has more than {} places of parts", max_places), {},
                           "open the files of its parts");
      }
    }
    if (followed < in_order_.size()) leave_circles();
    return {};
  }

  /// What is left hangs on an assembly within itself.
  void leave_circles() {
    result_.warnings.emplace_back("an assembly contains itself; its parts stand as far as they could be followed");
    for (const Index k : in_order_) {
      if (classes_[k].places.empty()) classes_[k].places.push_back({classes_[k].name});
    }
  }

  /// Gives every part what the items of its representations refer to.
  Expected<void> fill() {
    const std::size_t records = reader_.file().instances().size();
    // 1: a face, 2: a B-spline surface without faces (others are also referred to by the curves of their neighbours),
    // 3: a representation, 4: a curve that stands for itself
    std::vector<std::uint8_t> kind(records, 0);
    std::vector<bool> spline(records, false);
    std::unordered_map<Index, Index> below;  // the surface of each face
    for (const Index k : file_.data().surface_instances) spline[k] = true;
    for (const Face& face : read_faces(reader_)) {
      kind[face.instance] = 1;
      if (face.surface != no_instance && spline[face.surface]) below.emplace(face.instance, face.surface);
    }
    for (std::size_t k = 0; k < file_.surfaces().size(); ++k) {
      if (file_.surfaces()[k].faces == 0) kind[file_.data().surface_instances[k]] = 2;
    }
    for (const Index k : file_.data().curve_instances) kind[k] = 4;
    for (const Index k : groups_.representations()) kind[k] = 3;
    std::vector<Index> mark(records, no_instance), stack;
    held_.assign(records, false);
    given_.assign(records, false);
    std::size_t visits = 0;
    for (Index k = 0; k < groups_.size(); ++k) {
      const Index group = groups_.find(k);
      PartClass& c = classes_[group];
      const auto own = reader_.attributes(groups_.representations()[k], "REPRESENTATION", 0, 3);
      if (!c.product || own.empty()) continue;
      const auto visit = [&](Index target) {
        if (kind[target] == 3 || mark[target] == group) return;
        mark[target] = group;
        held_[target] = true;
        if (kind[target] == 1) {
          c.faces.push_back(target);
          if (const auto on = below.find(target); on != below.end()) c.surfaces.push_back(on->second);
        }
        if (kind[target] == 2) c.surfaces.push_back(target);
        if (kind[target] == 4) c.curves.push_back(target);
        stack.push_back(target);
        ++visits;
      };
      for (const Index item : reader_.references(own[1])) visit(item);
      while (!stack.empty() && visits <= visits_per_record * records) {
        const auto& record = reader_.file().instance(stack.back());
        stack.pop_back();
        for (auto value = record.first; value < record.last; ++value) {
          if (const auto target = reader_.reference(value)) visit(*target);
        }
      }
      for (const Index s : c.surfaces) given_[s] = true;
      if (!stack.empty())
        return input_error("too many parts share the same geometry", {}, "open the files of its parts");
    }
    return {};
  }

  /// What belongs to no product.
  void add_rest() {
    Part rest{{}, file_.length_unit(), {}, {}, {}, {PartPlace{}}};
    for (const Face& face : read_faces(reader_)) {
      if (!held_[face.instance]) rest.faces.push_back(name_of(reader_, face.instance));
    }
    for (const Index k : file_.data().surface_instances) {
      if (!given_[k]) rest.surfaces.push_back(name_of(reader_, k));
    }
    for (const Index k : file_.data().curve_instances) {
      if (!held_[k]) rest.curves.push_back(name_of(reader_, k));
    }
    if (!rest.faces.empty() || !rest.surfaces.empty() || !rest.curves.empty()) result_.parts.push_back(std::move(rest));
  }

  const File& file_;
  Reader reader_;
  Classes groups_;
  std::map<Index, std::string> products_;
  std::vector<PartClass> classes_;
  std::vector<Use> uses_;
  std::vector<Index> in_order_;
  std::vector<bool> held_, given_;  // reached; surfaces that a part has
  Assembly result_;
};

}  // namespace

bool Assembly::placed() const {
  return std::ranges::any_of(parts, [](const Part& part) {
    return part.places.size() != 1 || !part.places[0].to_model.matrix().isIdentity(0);
  });
}

const Part* Assembly::part_of(const std::string& surface) const {
  const auto found = std::ranges::find_if(
      parts, [&](const Part& part) { return std::ranges::find(part.surfaces, surface) != part.surfaces.end(); });
  return found == parts.end() ? nullptr : &*found;
}

Expected<Assembly> assembly_of(const File& file) {
  auto result = Builder(file).build();
  if (!result) result.error().file = file.name();
  return result;
}

}  // namespace knead::step
