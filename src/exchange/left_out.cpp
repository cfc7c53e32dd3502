#include "knead/exchange/source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

#include "brep/tessellation/face_tessellator.hpp"
#include "convertible.hpp"
#include "knead/base/printable.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/format.hpp"
#include "left_out_list.hpp"

namespace knead {
namespace {

using detail::LeftOutKind;
using detail::LeftOutList;

constexpr double rough = 0.1, fine = 1e-4;  // chords, as a share of their radii

void append(std::vector<LeftOut>& to, std::vector<LeftOut> more) {
  to.insert(to.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

void add_unreadable(const Source& source, LeftOutList& list) {
  for (const brep::UnreadableSurface& s : source.unreadable()) {
    list.add({"surface that cannot be sculpted", "surfaces that cannot be sculpted", s.reason.what,
              s.reason.remedy},
             s.id, 1, s.reason.line);
  }
}

Expected<void> draw(brep::FaceTessellator& tessellator, const brep::Face& face) {
  const auto on = tessellator.face_on_surface(face);
  const auto mesh = on ? tessellator.mesh(*on) : std::unexpected(on.error());
  return mesh ? Expected<void>() : std::unexpected(mesh.error());
}

std::vector<SkippedFace> illegible_faces(const brep::Model& model) {
  brep::FaceTessellator coarse(model, {rough});
  std::vector<SkippedFace> result = model.tessellated.skipped;
  for (const brep::Face& face : model.faces) {
    if (auto read = coarse.legible(face); !read)
      result.push_back({face.id, std::move(read.error())});
  }
  return result;
}

/// Narrow faces have edges that cross where chords are long: what fails is tried once more with
/// short ones.
std::vector<SkippedFace> failing_faces(const brep::Model& model) {
  brep::FaceTessellator coarse(model, {rough});
  std::vector<const brep::Face*> failed;
  for (const brep::Face& face : model.faces) {
    if (!draw(coarse, face)) failed.push_back(&face);
  }
  std::vector<SkippedFace> result = model.tessellated.skipped;
  if (failed.empty()) return result;
  brep::FaceTessellator close(model, {fine});
  for (const brep::Face* face : failed) {
    if (auto status = draw(close, *face); !status)
      result.push_back({face->id, std::move(status.error())});
  }
  return result;
}

/// Adds faces that fail; of those on a surface that cannot be read, that is the reason.
class FailedFaces {
 public:
  FailedFaces(const Source& source, const brep::Model& model, LeftOutList& list) : list_(list) {
    for (const brep::UnreadableSurface& s : source.unreadable()) unreadable_.insert(s.id);
    for (const brep::Face& face : model.faces) {
      if (face.support != brep::none && unreadable_.contains(model.supports[face.support].id))
        on_unreadable_.insert(face.id);
    }
  }

  void add(const std::string& id, const Error& reason) {
    constexpr std::string_view one = "face that cannot be drawn",
                               many = "faces that cannot be drawn";
    if (unreadable_.contains(id)) return;
    if (on_unreadable_.contains(id))
      list_.add({one, many, "its surface cannot be read"}, id);
    else
      list_.add({one, many, reason.what, reason.remedy}, id);
  }

 private:
  LeftOutList& list_;
  std::unordered_set<std::string> unreadable_, on_unreadable_;
};

void add_places(const brep::Model& model, LeftOutList& list) {
  if (model.instances.empty() || !model.assembly || !model.assembly->placed()) return;
  for (const brep::Part& part : model.assembly->parts) {
    if (part.surfaces.empty() && part.curves.empty()) continue;
    const bool moved = part.places.size() != 1 || !part.places[0].to_model.matrix().isIdentity(0);
    if (moved)
      list.add({"place of a part", "places of parts",
                "every part is written once, in its own coordinates"},
               {}, part.places.size());
  }
}

void add_curves(const Source& source, std::string_view reason, LeftOutList& list) {
  for (const SourceCurve& c : source.curves()) list.add({"curve", "curves", reason}, c.id);
}

}  // namespace

std::string sentence(const LeftOut& left) {
  std::string ids;
  for (const std::string& id : left.ids) ids += (ids.empty() ? "" : ", ") + id;
  if (!ids.empty() && left.count > left.ids.size()) ids += ", …";
  if (!ids.empty() && left.line > 0)
    ids += fmt::format("; {} {}", left.count == 1 ? "line" : "from line", left.line);
  std::string text = fmt::format("{} {}{}: {}", left.count, left.what(),
                                 ids.empty() ? "" : " (" + ids + ")", left.reason);
  if (!left.remedy.empty()) text += "; " + left.remedy;
  return printable(text, 2000);
}

std::vector<LeftOut> left_out_of_list(const Source& source) {
  const auto model = source.model();
  return left_out_of_picture(source, model ? illegible_faces(*model) : std::vector<SkippedFace>());
}

std::vector<LeftOut> left_out_of_faces(const Source& source) {
  const auto model = source.model();
  return left_out_of_picture(source, model ? failing_faces(*model) : std::vector<SkippedFace>());
}

std::vector<LeftOut> left_out_of_picture(const Source& source,
                                         std::span<const SkippedFace> skipped) {
  LeftOutList list;
  add_unreadable(source, list);
  if (const auto model = source.model()) {
    FailedFaces failed(source, *model, list);
    for (const SkippedFace& face : skipped) failed.add(face.id, face.reason);
  }
  std::vector<LeftOut> result = list.take();
  append(result, source.left_out());
  return result;
}

std::vector<LeftOut> left_out_of_mesh(const Source& source, std::span<const SkippedFace> skipped) {
  LeftOutList list;
  add_curves(source, "a mesh holds faces alone", list);
  std::vector<LeftOut> result = left_out_of_picture(source, skipped);
  append(result, list.take());
  return result;
}

std::vector<LeftOut> left_out_of_surfaces(const Source& source, const Format& format) {
  LeftOutList list;
  add_unreadable(source, list);
  if (const auto model = source.model()) {
    if (format.content == FormatContent::surfaces) {
      for (const brep::SplineSurface& s : model->surfaces) {
        if (s.trimmed)
          list.add({"surface's trims", "surfaces' trims", "surfaces are written whole"}, s.id);
      }
    }
    for (const brep::OtherSurface& s : brep::other_surfaces(*model)) {
      list.add({"surface of another form", "surfaces of other forms",
                "only B-spline surfaces are written",
                converts_surfaces(source) ? "make them B-splines with the command `convert`" : ""},
               s.id);
    }
    constexpr LeftOutKind tessellated = {"tessellated item", "tessellated items",
                                         "only B-spline surfaces are written"};
    for (const brep::TessellatedItem& item : model->tessellated.items)
      list.add(tessellated, item.mesh.id);
    for (const SkippedFace& item : model->tessellated.skipped) list.add(tessellated, item.id);
    add_places(*model, list);
  }
  if (!format.writes_curves) add_curves(source, "the format holds no curves", list);
  std::vector<LeftOut> result = list.take();
  append(result, source.left_out());
  return result;
}

}  // namespace knead
