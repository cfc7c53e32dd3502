#include "conversion.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "exchange/faces/prepared_model.hpp"
#include "knead/brep/face_conversion.hpp"
#include "parts.hpp"
#include "writer.hpp"

namespace knead::iges {
namespace {

/// The parameters of one entity, as pointers and counts.
class PointerValues {
 public:
  explicit PointerValues(std::vector<std::string> values) : values_(std::move(values)) {}

  [[nodiscard]] int at(std::size_t k) const {
    return k < values_.size() ? integer(values_[k]).value_or(0) : 0;
  }
  [[nodiscard]] std::size_t count_at(std::size_t k) const {
    return static_cast<std::size_t>(std::max(at(k), 0));
  }
  void put(std::size_t k, int value) {
    if (at(k) == value) return;
    values_.resize(std::max(values_.size(), k + 1));
    values_[k] = std::to_string(value);
  }
  /// Leaves out so many from here on.
  void drop(std::size_t first, std::size_t count) {
    const auto begin = std::min(first, values_.size()),
               end = std::min(first + count, values_.size());
    values_.erase(values_.begin() + static_cast<std::ptrdiff_t>(begin),
                  values_.begin() + static_cast<std::ptrdiff_t>(end));
  }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] std::vector<std::string> take() && { return std::move(values_); }

 private:
  std::vector<std::string> values_;
};

/// What becomes of the boundaries on converted surfaces.
class Boundaries {
 public:
  Boundaries(const File& file, const std::set<int>& converted)
      : file_(file), converted_(converted) {}

  /// Errors (input): an entity cannot do without the parameters of a surface.
  Expected<std::vector<OtherParameters>> rewritten() {
    for (std::size_t k = 0; k < file_.entities().size(); ++k) {
      const int number = File::number(k);
      Expected<void> done;
      switch (file_.entities()[k].type) {
        case 140:
          done = refuse_offset(number);
          break;
        case 141:
          done = boundary(number);
          break;
        case 142:
          done = curve_on_surface(number);
          break;
        case 143:
          done = bounded_surface(number);
          break;
        case 144:
          done = trimmed_surface(number);
          break;
        case 510:
          done = face(number);
          break;
        default:
          break;
      }
      if (!done) return std::unexpected(std::move(done.error()));
    }
    std::vector<OtherParameters> result;
    for (auto& [number, values] : rewritten_) result.push_back({number, std::move(values)});
    return result;
  }

 private:
  /// Empty if the entity has none, or they do not point to a converted surface.
  std::optional<PointerValues> pointing(int number, std::size_t surface_at) const {
    auto parameters = file_.parameters(number);
    if (!parameters) return std::nullopt;
    PointerValues values(std::move(parameters->values));
    return converted_.contains(values.at(surface_at)) ? std::optional(std::move(values))
                                                      : std::nullopt;
  }

  void keep(int number, PointerValues values) {
    rewritten_.emplace(number, std::move(values).take());
  }

  Expected<void> refuse_offset(int number) const {
    if (!pointing(number, 5)) return {};
    return file_.error(number, "it is made of a surface that would get other parameters",
                       "convert it in the program that wrote the file");
  }

  /// How it was made, surface, curve in parameters, curve in space, which is preferred (2: that in
  /// space).
  Expected<void> curve_on_surface(int number) {
    auto values = pointing(number, 2);
    if (!values) return {};
    if (values->at(4) == 0)
      return file_.error(number, "it is given in the parameters of its surface alone",
                         "write the file again with its curves in space");
    values->put(3, 0);
    values->put(5, 2);
    keep(number, *std::move(values));
    return {};
  }

  /// Kind (0: curves in space alone), preference (1: these), surface, number of curves; of each the
  /// curve, its sense, and its curves in parameters.
  Expected<void> boundary(int number) {
    auto values = pointing(number, 3);
    if (!values) return {};
    values->put(1, 0);
    values->put(2, 1);
    std::size_t at = 5;
    for (std::size_t n = values->count_at(4); n > 0 && at + 2 < values->size(); --n, at += 3) {
      if (values->at(at) == 0)
        return file_.error(number, "it is given in the parameters of its surface alone",
                           "write the file again with its curves in space");
      values->drop(at + 3, values->count_at(at + 2));
      values->put(at + 2, 0);
    }
    keep(number, *std::move(values));
    return {};
  }

  /// Kind, as that of its boundaries, and surface.
  Expected<void> bounded_surface(int number) {
    auto values = pointing(number, 2);
    if (!values) return {};
    values->put(1, 0);
    keep(number, *std::move(values));
    return {};
  }

  /// Surface, whether it has an outer boundary of its own (0: it is that of the surface).
  Expected<void> trimmed_surface(int number) const {
    const auto values = pointing(number, 1);
    if (!values || values->at(2) != 0) return {};
    return file_.error(number, "it ends where its surface does, which would get other ends",
                       "write the file again with an outer boundary");
  }

  /// Surface, number of loops, whether the first is the outer one, loops (508): of these the number
  /// of edges, and of each its kind, list, place there, sense, and curves in parameters as pairs.
  Expected<void> face(int number) {
    const auto values = pointing(number, 1);
    if (!values) return {};
    for (std::size_t k = 4; k < 4 + values->count_at(2) && k < values->size(); ++k) {
      const int loop = values->at(k);
      auto parameters = file_.parameters(loop);
      if (!parameters || file_.find(loop)->type != 508) continue;
      PointerValues edges(std::move(parameters->values));
      std::size_t at = 2;
      for (std::size_t n = edges.count_at(1); n > 0 && at + 4 < edges.size(); --n, at += 5) {
        edges.drop(at + 5, 2 * edges.count_at(at + 4));
        edges.put(at + 4, 0);
      }
      keep(loop, std::move(edges));
    }
    return {};
  }

  const File& file_;
  const std::set<int>& converted_;
  std::map<int, std::vector<std::string>> rewritten_;
};

/// Curves, points and directions, of which surfaces and boundaries are made.
bool is_part(int type) {
  constexpr int parts[] = {100, 102, 104, 106, 110, 112, 116, 123, 126, 130};
  return std::ranges::find(parts, type) != std::end(parts);
}

/// Whether only its own parts are known of this type: lists of anything, as groups (402), may name
/// an entity anywhere.
bool may_name_any(int type) {
  constexpr int lists[] = {308, 402, 404, 406};
  return std::ranges::find(lists, type) != std::end(lists);
}

/// The parts that nothing needs any more: they depend on entities that no longer refer to them.
/// Every reader would take them for curves of their own.
class ReleasedParts {
 public:
  explicit ReleasedParts(const File& file) : file_(file), before_(file.entities().size()) {
    for (std::size_t k = 0; k < before_.size(); ++k) {
      const auto parameters = file.parameters(File::number(k));
      if (!parameters) continue;
      before_[k] = named(file.entities()[k].type, parameters->values);
      for (const int part : before_[k]) ++uses_[part];
    }
  }

  /// The entity has these parameters now; none: it is made of no others.
  void change(int number, const std::vector<std::string>& now = {}) {
    auto after = named(file_.find(number)->type, now);
    for (const int part : after) ++uses_[part];
    exchange(number, std::move(after));
    for (; followed_ < released_.size(); ++followed_) exchange(released_[followed_], {});
  }

  [[nodiscard]] const std::vector<int>& list() const { return released_; }

 private:
  static std::vector<int> named(int type, const std::vector<std::string>& values) {
    if (!may_name_any(type)) return parts_of(type, values);
    std::vector<int> result;
    for (const std::string& value : values) result.push_back(integer(value).value_or(0));
    return result;
  }

  void exchange(int number, std::vector<int> after) {
    for (const int part :
         std::exchange(before_[static_cast<std::size_t>(number) / 2], std::move(after)))
      drop(part);
  }

  void drop(int part) {
    const Entity* entity = file_.find(part);
    if (entity != nullptr && --uses_[part] == 0 && is_part(entity->type) && entity->dependent)
      released_.push_back(part);
  }

  const File& file_;
  std::vector<std::vector<int>> before_;  // what each entity names
  std::map<int, int> uses_;
  std::vector<int> released_;
  std::size_t followed_ = 0;  // so many of these have dropped their own parts
};

}  // namespace

Expected<std::string> with_splines(const File& file, const brep::Model& model,
                                   std::span<const std::string> surfaces) {
  std::vector<Replacement> made;
  std::set<int> converted;
  for (const std::string& id : surfaces) {
    const auto faces = brep::faces_on_other(model, id);
    if (!faces) return std::unexpected(faces.error());
    const std::string& name = model.supports[faces->front()->support].id;
    const int number = integer(std::string_view(name).substr(1)).value_or(0);
    if (!converted.insert(number).second) continue;
    if (detail::is_whole_sphere(model, name))
      return file.error(number, "readers of the format know whole spheres as such alone",
                        "keep it, or write STEP");
    auto surface = brep::exact_spline(model, name);
    if (!surface) return std::unexpected(std::move(surface.error()));
    made.push_back({number, *std::move(surface)});
  }
  auto others = Boundaries(file, converted).rewritten();
  if (!others) return std::unexpected(std::move(others.error()));
  ReleasedParts parts(file);
  for (const int number : converted) parts.change(number);
  for (const OtherParameters& other : *others) parts.change(other.number, other.values);
  for (const int number : parts.list()) others->push_back({number, {"0"}});
  return with_surfaces(file, made, {}, *others);
}

}  // namespace knead::iges
