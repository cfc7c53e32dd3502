// What of the file stands around the surfaces, and what faces show of them.
#include <cmath>
#include <map>

#include "brep/tessellation/context_faces.hpp"
#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/source.hpp"
#include "query.hpp"
#include "session/document_regions.hpp"
#include "studio_context.hpp"

namespace knead::studio {
namespace {

struct GreyFace {
  std::string id, surface, form;
  int triangles = 0;
};

void describe(GreyFace& f, Fields& fields) {
  fields.name("grey face", "A face of the file that is no surface of the session.");
  fields.add("id", f.id);
  fields.add("surface", f.surface,
             {.help = "the entity on which it lies; empty where there is none"});
  fields.add("form", f.form,
             {.help = "PLANE and the like; TRIANGLES of faces that the file itself tessellates"});
  fields.add("triangles", f.triangles, {.help = "their number"});
}

struct NotDrawn {
  std::string id, reason;
};

void describe(NotDrawn& f, Fields& fields) {
  fields.name("not drawn", "A face that could not be triangulated, and why.");
  fields.add("id", f.id);
  fields.add("reason", f.reason);
}

struct Context {
  std::vector<float> positions, normals;
  std::vector<std::uint32_t> indices;
  std::vector<GreyFace> faces;
  std::vector<NotDrawn> skipped;
  std::vector<std::string> left_out;
};

void describe(Context& c, Fields& fields) {
  fields.name("context",
              "The surroundings of the surfaces: triangles of the other faces of the file.");
  fields.add("positions", c.positions, {.help = "relative to the session's origin"});
  fields.add("normals", c.normals);
  fields.add("indices", c.indices, {.help = "3 per triangle, face after face"});
  fields.add("faces", c.faces, {.help = "in the order of the triangles"});
  fields.add("skipped", c.skipped);
  fields.add("left_out", c.left_out,
             {.help = "what of the file is not drawn, one line for each kind and reason; skipped "
                      "faces are among it"});
}

void add(Context& context, const FaceMesh& mesh, const Point& origin) {
  const auto first = static_cast<std::uint32_t>(context.positions.size() / 3);
  for (std::size_t k = 0; k < mesh.points.size(); ++k) {
    for (int d = 0; d < 3; ++d) {
      context.positions.push_back(static_cast<float>(mesh.points[k][d] - origin[d]));
      context.normals.push_back(static_cast<float>(mesh.normals[k][d]));
    }
  }
  for (const auto& triangle : mesh.triangles) {
    for (const auto k : triangle) context.indices.push_back(first + k);
  }
}

Expected<std::optional<Context>> context(Studio& studio) {
  if (!studio.session || studio.session->document().model() == nullptr) return std::nullopt;
  const Document& document = studio.session->document();
  Context answer;
  FaceMeshes meshes;
  if (auto faces = context_faces(*document.model(), drawn_chord)) meshes = *std::move(faces);
  std::map<std::string, const brep::OtherSurface*> below;  // of every face
  const auto others = brep::other_surfaces(*document.model());
  for (const brep::OtherSurface& s : others) {
    for (const std::string& face : s.faces) below[face] = &s;
  }
  for (const FaceMesh& mesh : meshes.faces) {
    const auto on = below.find(mesh.id);
    const brep::OtherSurface none, &surface = on == below.end() ? none : *on->second;
    answer.faces.push_back({mesh.id, surface.id, mesh.tessellated ? "TRIANGLES" : surface.form,
                            static_cast<int>(mesh.triangles.size())});
    add(answer, mesh, studio.origin);
  }
  for (const SkippedFace& face : meshes.skipped)
    answer.skipped.push_back({face.id, face.reason.what});
  for (const LeftOut& left : left_out_of_picture(*document.source(), meshes.skipped)) {
    answer.left_out.push_back(sentence(left));
  }
  return answer;
}

/// A billionth of the domain is less than a pixel of a picture from a hundred thousand times as
/// near as all of it.
void add_fractions(std::vector<double>& numbers, double s, double t) {
  numbers.push_back(std::round(s * 1e9) / 1e9);
  numbers.push_back(std::round(t * 1e9) / 1e9);
}

struct Trims {
  std::vector<std::vector<std::vector<double>>> faces;
};

void describe(Trims& t, Fields& fields) {
  fields.name("trims",
              "The loops of each face on a surface: the parts enclosed by an odd number of them "
              "are visible.");
  fields.add("faces", t.faces, {.help = "fractions s and t of the domain in turn"});
}

Expected<std::optional<Trims>> trims(Studio& studio, int number) {
  if (!studio.session || studio.session->document().model() == nullptr) return std::nullopt;
  const auto& all = studio.shown.trims(studio.session->document());
  const std::size_t k = place_in_file(*studio.session, number);
  if (k >= all.size() || all[k].whole) return std::nullopt;
  Trims answer;
  for (const TrimFace& face : all[k].faces) {
    auto& loops = answer.faces.emplace_back();
    for (const TrimLoop& loop : face) {
      auto& numbers = loops.emplace_back();
      for (const auto& p : loop) add_fractions(numbers, p.x(), p.y());
    }
  }
  return answer;
}

struct Neighbour {
  std::string face, surface, form;
};

void describe(Neighbour& n, Fields& fields) {
  fields.name("neighbour", "A face at an edge.");
  fields.add("face", n.face);
  fields.add("surface", n.surface, {.help = "the entity on which it lies"});
  fields.add("form", n.form, {.help = "PLANE and the like"});
}

struct FaceEdge {
  std::string id;
  std::vector<double> course;
  std::vector<Neighbour> meets;
  bool seam = false;
};

void describe(FaceEdge& e, Fields& fields) {
  fields.name("face edge", "An edge of a face.");
  fields.add("id", e.id);
  fields.add(
      "course", e.course,
      {.help =
           "places along it, s and t in turn; on closed surfaces they may lie outside of 0 … 1"});
  fields.add("meets", e.meets);
  fields.add("seam", e.seam, {.help = "the same face is on both of its sides"});
}

Expected<std::vector<FaceEdge>> face_edges(Session& session, int number) {
  std::vector<FaceEdge> answer;
  if (!has_surface(session, number)) return answer;
  const SceneSurface& s = session.state().surfaces[static_cast<std::size_t>(number)];
  std::shared_ptr<const VisibleRegion> region = s.visible;
  if (!region) {
    auto found = DocumentRegions(session.document()).of(s.id);
    if (!found) return answer;
    region = std::make_shared<const VisibleRegion>(*std::move(found));
  }
  for (const TrimEdge& edge : region->edges) {
    FaceEdge& to =
        answer.emplace_back(FaceEdge{.id = edge.id, .course = {}, .meets = {}, .seam = edge.seam});
    for (const Eigen::Vector2d& p : edge.course) add_fractions(to.course, p.x(), p.y());
    for (std::size_t k = 0; k < edge.neighbours.size(); ++k) {
      const std::string& on = edge.supports[k];  // "#30 PLANE"
      const auto space = on.find(' ');
      to.meets.push_back({edge.neighbours[k], on.substr(0, space),
                          space == std::string::npos ? "" : on.substr(space + 1)});
    }
  }
  return answer;
}

}  // namespace

std::vector<Query> context_queries() {
  return {
      query<std::optional<Context>, context>("context",
                                             "The faces of the file that are no surfaces of the "
                                             "session; null without a file of faces."),
      query<std::optional<Trims>, trims>(
          "trims", "What the faces of the file show of a surface; null where that is all."),
      query<std::vector<FaceEdge>, face_edges>(
          "face_edges",
          "The edges of the faces of the file on a surface; none where they cannot be followed.")};
}

}  // namespace knead::studio
