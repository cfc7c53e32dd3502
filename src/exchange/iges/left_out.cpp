#include "left_out.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exchange/left_out_list.hpp"
#include "parts.hpp"

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
  /// What an entity is made of, and the definitions that instances place.
  void note_parts(int number) {
    const int type = file_.find(number)->type;
    const auto parameters = file_.parameters(number);
    if (!parameters) return;
    auto& to = type == 408 ? placed_ : parts_;
    for (const int part : parts_of(type, parameters->values)) to.insert(part);
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
    const bool bare = type == 144 && parameters && pointer_at(parameters->values, 2) == 0 &&
                      pointer_at(parameters->values, 3) == 0;
    const int below = parameters ? pointer_at(parameters->values, type == 143 ? 2 : 1) : 0;
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
