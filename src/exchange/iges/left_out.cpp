#include "left_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <initializer_list>
#include <limits>

#include "exchange/left_out_list.hpp"

namespace knead::iges {
namespace {

using detail::LeftOutKind;

namespace kinds {
constexpr LeftOutKind
    points = {"point", "points", "a point has no surface"},
    curves = {"curve that bounds no face", "curves that bound no face",
              "curves of an IGES file are not read by themselves",
              "write them as B-spline curves of a STEP file"},
    surfaces = {"surface without a face", "surfaces without faces",
                "of surfaces that are no B-splines only what faces cover is shown"},
    faces = {"face that cannot be read", "faces that cannot be read",
             "its bounds or its surface are missing", "check that the file is complete"},
    whole = {"face without bounds", "faces without bounds",
             "only B-spline surfaces are shown whole",
             "trim it in the program that wrote the file"},
    solids = {"solid without faces", "solids without faces", "its faces are not in the file",
              "write a boundary representation in the program that made the file"},
    instances = {"subfigure instance", "subfigure instances",
                 "its definition or its place cannot be read, or it is sheared"},
    definitions = {"subfigure definition", "subfigure definitions", "no instance uses it"},
    annotations = {"annotation", "annotations", "dimensions and notes are not shown"},
    elements = {"record of finite elements", "records of finite elements",
                "meshes of an analysis are not read"},
    groups = {"group", "groups", "groups are not shown"},
    views = {"drawing or view", "drawings and views", "drawings are not shown"},
    colours = {"colour", "colours", "colours of an IGES file are not read"},
    outside = {"external reference", "external references", "other files are not opened",
               "open them by themselves"};
}  // namespace kinds

/// Parts of others, and what says nothing of a shape: nulls, directions, matrices, boundaries,
/// lists of shells.
bool only_helps(int type) {
  constexpr int helpers[] = {0, 114, 118, 123, 124, 128, 140, 141, 186, 502, 504, 508, 514};
  return std::ranges::find(helpers, type) != std::end(helpers);
}

class Unread {
 public:
  Unread(const File& file, const brep::Model& model, const std::set<int>& unplaced)
      : file_(file), model_(model), unplaced_(unplaced) {
    for (const brep::Face& face : model.faces) shown_.insert(face.id);
  }

  std::vector<LeftOut> list() {
    for (std::size_t k = 0; k < file_.entities().size(); ++k) note_parts(File::number(k));
    for (std::size_t k = 0; k < file_.entities().size(); ++k)
      add(File::number(k), file_.entities()[k]);
    return list_.take();
  }

 private:
  using Values = std::vector<std::string>;
  static int pointer(const Values& values, std::size_t k) {
    const int value = k < values.size() ? integer(values[k]).value_or(0) : 0;
    return std::abs(std::max(value, -std::numeric_limits<int>::max()));
  }

  /// What an entity is made of.
  void note_parts(int number) {
    const int type = file_.find(number)->type;
    const auto parameters = file_.parameters(number);
    if (!parameters) return;
    const Values& values = parameters->values;
    const auto use = [&](std::initializer_list<std::size_t> places) {
      for (const std::size_t k : places) parts_.insert(pointer(values, k));
    };
    const auto use_list = [&](std::size_t count_at, std::size_t first, std::size_t step) {
      for (int n = pointer(values, count_at); n > 0 && first < values.size(); --n, first += step)
        parts_.insert(pointer(values, first));
    };
    switch (type) {
      case 102:
      case 180:
      case 184:
        return use_list(1, 2, 1);
      case 118:
      case 120:
      case 190:
      case 192:
      case 194:
      case 196:
      case 198:
        use({1, 2});
        return use(type == 190                  ? std::initializer_list<std::size_t>{3}
                   : type == 192                ? std::initializer_list<std::size_t>{4}
                   : type == 196                ? std::initializer_list<std::size_t>{3, 4}
                   : type == 194 || type == 198 ? std::initializer_list<std::size_t>{5}
                                                : std::initializer_list<std::size_t>{});
      case 108:
        return use({5});
      case 122:
      case 162:
      case 164:
      case 430:
        return use({1});
      case 130:
        return use({1, 3});
      case 140:
        return use({5});
      case 141:
        return note_boundary(values);
      case 142:
        return use({2, 3, 4});
      case 143:
        use({2});
        return use_list(3, 4, 1);
      case 144:
        use({1, 4});
        return use_list(3, 5, 1);
      case 504:
        return use_list(1, 2, 5);
      case 508:
        return note_loop(values);
      case 510:
        use({1});
        return use_list(2, 4, 1);
      case 408:
        placed_.insert(pointer(values, 1));
        return;
      default:
        return;
    }
  }

  void note_boundary(const Values& values) {
    parts_.insert(pointer(values, 3));
    std::size_t at = 5;
    for (int n = pointer(values, 4); n > 0 && at + 2 < values.size(); --n) {
      const auto flat = static_cast<std::size_t>(pointer(values, at + 2));
      parts_.insert(pointer(values, at));
      for (std::size_t k = at + 3; k < at + 3 + flat && k < values.size(); ++k)
        parts_.insert(pointer(values, k));
      at += 3 + flat;
    }
  }

  void note_loop(const Values& values) {
    // Of each: kind, list, its entry, sense, number of curves in parameters, and these.
    std::size_t at = 2;
    for (int n = pointer(values, 1); n > 0 && at + 4 < values.size(); --n) {
      const auto flat = static_cast<std::size_t>(pointer(values, at + 4));
      for (std::size_t k = 0; k < flat && at + 6 + 2 * k < values.size(); ++k)
        parts_.insert(pointer(values, at + 6 + 2 * k));
      at += 5 + 2 * flat;
    }
  }

  void add(int number, const Entity& entity) {
    const int type = entity.type;
    if (only_helps(type)) return;
    const bool part = parts_.contains(number) || entity.parametric;
    const auto put = [&](const LeftOutKind& kind) { list_.add(kind, fmt::format("#{}", number)); };
    if (type == 143 || type == 144 || type == 510) return add_face(number, type);
    if (const LeftOutKind* kind = standing_kind(type, entity.form)) {
      if (!part) put(*kind);
      return;
    }
    if (const LeftOutKind* kind = kind_of(type)) return put(*kind);
    if (type == 408) {
      if (unplaced_.contains(number)) put(kinds::instances);
      return;
    }
    if (type == 308) {
      if (!placed_.contains(number)) put(kinds::definitions);
      return;
    }
    const std::string_view known = type_name(type);
    const std::string name =
        fmt::format("of type {}{}", type, known.empty() ? "" : fmt::format(" ({})", known));
    list_.add({"entity " + name, "entities " + name, "entities of this type are not read"},
              fmt::format("#{}", number));
  }

  /// Geometry that is left out where nothing else is made of it.
  static const LeftOutKind* standing_kind(int type, int form) {
    switch (type) {
      case 116:
      case 132:
        return &kinds::points;
      case 100:
      case 102:
      case 104:
      case 110:
      case 112:
      case 126:
      case 130:
      case 142:
        return &kinds::curves;
      case 106:
        return form <= 3                  ? &kinds::points
               : form <= 13 || form == 63 ? &kinds::curves
                                          : &kinds::annotations;
      case 108:
      case 120:
      case 122:
      case 190:
      case 192:
      case 194:
      case 196:
      case 198:
        return &kinds::surfaces;
      default:
        return nullptr;
    }
  }

  static const LeftOutKind* kind_of(int type) {
    if ((type >= 150 && type <= 168) || type == 180 || type == 182 || type == 184 || type == 430)
      return &kinds::solids;
    if ((type >= 202 && type <= 230)) return &kinds::annotations;
    switch (type) {
      case 134:
      case 136:
      case 138:
      case 146:
      case 148:
        return &kinds::elements;
      case 402:
        return &kinds::groups;
      case 404:
      case 410:
        return &kinds::views;
      case 314:
        return &kinds::colours;
      case 416:
        return &kinds::outside;
      default:
        return nullptr;
    }
  }

  void add_face(int number, int type) {
    if (shown_.contains(fmt::format("#{}", number))) return;
    const auto parameters = file_.parameters(number);
    const bool bare = type == 144 && parameters && pointer(parameters->values, 2) == 0 &&
                      pointer(parameters->values, 3) == 0;
    const int below = parameters ? pointer(parameters->values, type == 143 ? 2 : 1) : 0;
    // A whole B-spline surface stands for itself.
    if (bare && model_.find_surface(fmt::format("#{}", below)) != nullptr) return;
    list_.add(bare && file_.find(below) != nullptr ? kinds::whole : kinds::faces,
              fmt::format("#{}", number));
  }

  const File& file_;
  const brep::Model& model_;
  const std::set<int>& unplaced_;
  std::set<std::string> shown_;  // faces
  std::set<int> parts_, placed_;
  detail::LeftOutList list_;
};

}  // namespace

std::vector<LeftOut> left_out(const File& file, const brep::Model& model,
                              const std::set<int>& unplaced) {
  return Unread(file, model, unplaced).list();
}

}  // namespace knead::iges
