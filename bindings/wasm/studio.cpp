// The session as WebAssembly exports it: a C interface of numbers and bytes. The caller writes bytes to
// `knead_input(size)`, calls, and reads what came out from `knead_text()`; every call may grow the memory, so that
// views of it must be taken anew. Functions that can fail return 0 then, and the text is {"error": …}.
#include <algorithm>
#include <optional>
#include <string>

#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/format.hpp"
#include "knead/session/command_json.hpp"
#include "knead/session/document_regions.hpp"
#include "studio_assembly.hpp"
#include "studio_bodies.hpp"
#include "studio_combs.hpp"
#include "studio_context.hpp"
#include "studio_material.hpp"
#include "studio_mesh.hpp"
#include "studio_picture.hpp"
#include "studio_state.hpp"
#include "studio_surface.hpp"
#include "studio_trims.hpp"
#include "tool_picture.hpp"

/// Of the host: how many steps of the command under way are done, of how many.
extern "C" __attribute__((import_module("studio"), import_name("progress"))) void knead_progress(int done, int total);

#define KNEAD_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace knead::studio {
namespace {

struct Studio {
  std::string input, text;
  std::optional<Session> session;
  Point origin = Point::Zero();
  PictureMaker pictures;
  CombPicture combs;
  BodyPicture body;
  ContextPicture context;
  ToolPicture tool;
  MaterialSamples material;
  ShownParts shown;
};

Studio& held() {
  static Studio value;
  return value;
}

int fail(const Error& error) {
  held().text = error_json(error);
  return 0;
}

int answer(std::string text) {
  held().text = std::move(text);
  return 1;
}

/// What the faces of the open file show of a surface, once its trims have been asked for.
std::shared_ptr<const VisibleRegion> visible_part(int surface) {
  return held().shown.visible(held().session->document(), place_in_file(*held().session, surface));
}

int start(Document document) {
  held().origin = middle_of(document);
  held().shown.forget();
  held().session.emplace(std::move(document));
  return answer(state_json(*held().session));
}

int show_body(Expected<BodyPicture> picture) {
  if (!picture) return fail(picture.error());
  held().body = *std::move(picture);
  return answer(body_json(held().body));
}

}  // namespace
}  // namespace knead::studio

using namespace knead;
using namespace knead::studio;

KNEAD_EXPORT(knead_input) char* knead_input(std::size_t size) {
  held().input.resize(size);
  return held().input.data();
}

KNEAD_EXPORT(knead_text) const char* knead_text() { return held().text.data(); }
KNEAD_EXPORT(knead_text_size) std::size_t knead_text_size() { return held().text.size(); }

/// Input: the bytes of a file, then its name (the last `name_size` bytes).
KNEAD_EXPORT(knead_open) int knead_open(std::size_t name_size) {
  std::string bytes = std::move(held().input);
  held().input.clear();
  if (name_size > bytes.size()) return fail({ErrorKind::usage, "the name is longer than the input"});
  std::string name = bytes.substr(bytes.size() - name_size);
  bytes.resize(bytes.size() - name_size);
  auto source = open_source(std::move(bytes), std::move(name));
  if (!source) return fail(source.error());
  const auto model = (*source)->model();
  const bool nothing = (*source)->surfaces().empty() && (*source)->curves().empty();
  if (nothing && (model == nullptr || brep::other_surfaces(*model).empty())) {
    const auto& unreadable = (*source)->unreadable();
    if (!unreadable.empty()) return fail(unreadable.front().reason);
    return fail({ErrorKind::input,
                 "the file holds no surface",
                 {},
                 "open a file with faces on surfaces: meshes cannot be sculpted"});
  }
  return start(Document::from(*std::move(source)));
}

/// A session that `knead_snapshot` has kept. Input: the bytes of its file (none: a document without one), its
/// name, the snapshot.
KNEAD_EXPORT(knead_restore) int knead_restore(std::size_t source_size, std::size_t name_size) {
  std::string bytes = std::move(held().input);
  held().input.clear();
  if (source_size + name_size > bytes.size()) return fail({ErrorKind::usage, "the input is too short"});
  std::string name = bytes.substr(source_size, name_size), snapshot = bytes.substr(source_size + name_size);
  bytes.resize(source_size);
  Document document = Document::fresh(name);
  if (source_size > 0) {
    auto source = open_source(std::move(bytes), std::move(name));
    if (!source) return fail(source.error());
    document = Document::from(*std::move(source));
  }
  const Point origin = middle_of(document);
  auto session = Session::restore(std::move(document), snapshot);
  if (!session) return fail(session.error());
  held().origin = origin;
  held().shown.forget();
  held().session = std::move(*session);
  return answer("{}");
}

/// A document without a file; the input is its name.
KNEAD_EXPORT(knead_fresh) int knead_fresh() { return start(Document::fresh(held().input)); }

namespace {

int without_session() {
  return fail({ErrorKind::usage, "nothing is open", {}, "open a file or start a fresh document"});
}

int reply(Expected<std::string> text) { return text ? answer(*std::move(text)) : fail(text.error()); }

/// What `act` answers for a surface of the session, by its number.
template <class Act>
int with_surface(int surface, const Act& act) {
  if (!held().session) return without_session();
  const auto& surfaces = held().session->state().surfaces;
  if (surface < 0 || surface >= static_cast<int>(surfaces.size())) {
    return fail({ErrorKind::usage, "there is no such surface"});
  }
  return act(surfaces[static_cast<std::size_t>(surface)]);
}

int show_combs(Expected<CombPicture> combs) {
  if (!combs) return fail(combs.error());
  held().combs = *std::move(combs);
  return answer(comb_json(held().combs));
}

}  // namespace

/// The input is commands, one per line (`carry_out`).
KNEAD_EXPORT(knead_act) int knead_act(int join, int keep) {
  auto& session = held().session;
  if (!session) return without_session();
  const bool first =
      session->document().is_fresh() && session->state().surfaces.empty() && session->state().bodies.empty();
  const auto told = [](int done, int total) {
    knead_progress(done, total);
    return true;  // the page stops what takes long by ending its worker
  };
  session->stop_at_faces(true);
  const auto done = carry_out(*session, held().input, {.join = join != 0, .keep = keep != 0}, told);
  if (!done) return fail(done.error());
  if (first) held().origin = origin_near(session->state(), held().origin);
  return answer("{}");
}

/// The text is what `begin_history` answers.
KNEAD_EXPORT(knead_begin_history) int knead_begin_history(int commands) {
  return held().session ? answer(std::to_string(begin_history(*held().session, commands))) : without_session();
}

/// The input is a list of commands, which is rehearsed (`Session::rehearse`).
KNEAD_EXPORT(knead_rehearse) int knead_rehearse() {
  if (!held().session) return without_session();
  const auto commands = parse_commands(held().input);
  if (!commands) return fail(commands.error());
  if (auto done = held().session->rehearse(*commands); !done) return fail(done.error());
  return answer("{}");
}

KNEAD_EXPORT(knead_state) int knead_state() {
  return held().session ? answer(state_json(*held().session)) : without_session();
}

KNEAD_EXPORT(knead_steps) int knead_steps(std::size_t first) {
  return held().session ? answer(steps_json(held().session->state(), first)) : without_session();
}

/// The text is the session as bytes; the history goes back as far as `history_bytes` allow.
KNEAD_EXPORT(knead_snapshot) int knead_snapshot(std::size_t history_bytes) {
  return held().session ? answer(held().session->snapshot(history_bytes)) : without_session();
}

KNEAD_EXPORT(knead_journal) int knead_journal() {
  return held().session ? answer(journal_json(*held().session)) : without_session();
}

/// The text is `edges_json`.
KNEAD_EXPORT(knead_edges) int knead_edges() {
  return held().session ? answer(edges_json(*held().session)) : without_session();
}

/// The text is `room_json`.
KNEAD_EXPORT(knead_room) int knead_room(int surface) {
  auto& session = held().session;
  if (!session) return without_session();
  if (surface < 0 || surface >= static_cast<int>(session->state().surfaces.size())) return answer("null");
  return answer(room_json(*session, static_cast<std::size_t>(surface)));
}

/// The text is `checked_edges_json`.
KNEAD_EXPORT(knead_checked_edges) int knead_checked_edges(int surface) {
  auto& session = held().session;
  if (!session) return without_session();
  if (surface < 0 || surface >= static_cast<int>(session->state().surfaces.size())) return answer("[]");
  return reply(checked_edges_json(*session, static_cast<std::size_t>(surface)));
}

/// The text is `reading_json`, at the fractions (s, t) of the domain.
KNEAD_EXPORT(knead_reading) int knead_reading(int surface, double s, double t) {
  return with_surface(surface, [&](const SceneSurface&) {
    return reply(reading_json(*held().session, surface, {s, t}));
  });
}

/// The input is the id of a face that is on no surface of the session; the text is `face_reading_json` near (x, y, z).
KNEAD_EXPORT(knead_face_reading) int knead_face_reading(double x, double y, double z) {
  if (!held().session) return without_session();
  return reply(face_reading_json(*held().session, held().input, {x, y, z}));
}

/// The text is the saved file.
KNEAD_EXPORT(knead_save) int knead_save() {
  if (!held().session) return without_session();
  return reply(held().session->save());
}

/// Coordinate `axis` of the origin of pictures, file units.
KNEAD_EXPORT(knead_origin) double knead_origin(int axis) { return held().origin[axis]; }

/// The text is the list of displays: `displays_json`.
KNEAD_EXPORT(knead_displays) int knead_displays() { return answer(displays_json()); }

/// A picture of a surface, or of the shape as it was opened: the text is `picture_json`, its buffers stay until the
/// next call. The input is what colours it (`read_display`). `detail`: grid lines wanted per direction. From (s0, t0)
/// to (s1, t1), fractions of its domain, chords are within `tolerance` where that is above 0.
KNEAD_EXPORT(knead_picture)
int knead_picture(int surface, int detail, int opened, double s0, double t0, double s1, double t1, double tolerance) {
  return with_surface(surface, [&](const SceneSurface&) {
    auto display = read_display(held().input);
    if (!display) return fail(display.error());
    const bool sees = display->display != nullptr && display->display->sees_model;
    const auto seen = sees ? held().shown.around(held().session->document()) : nullptr;
    const PictureOptions options{held().origin,
                                 detail,
                                 *std::move(display),
                                 opened != 0,
                                 visible_part(surface),
                                 PictureWindow{{s0, t0}, {s1, t1}, tolerance},
                                 seen};
    const auto done = held().pictures.make(held().session->state(), surface, options);
    return done ? answer(picture_json(held().pictures.picture())) : fail(done.error());
  });
}

/// Where the colours of the pictures end that were made since that of the first surface: the text is `range_json`.
KNEAD_EXPORT(knead_range) int knead_range() { return answer(range_json(held().pictures.range())); }

/// Curvature combs of a surface along `along_u` curves on which u runs and `along_v` on which v does, with `teeth`
/// pieces of every knot span: the text is `comb_json`, its buffers stay until the next call.
KNEAD_EXPORT(knead_combs) int knead_combs(int surface, int along_u, int along_v, int teeth) {
  return with_surface(surface, [&](const SceneSurface& s) {
    return show_combs(
        comb_picture(*s.current, {{along_u, along_v}, teeth}, held().origin, visible_part(surface).get()));
  });
}

/// The same of the curves in which the plane (x, y, z) · p = offset cuts it, in file units; (x, y, z) is of length 1.
KNEAD_EXPORT(knead_section_combs)
int knead_section_combs(int surface, double x, double y, double z, double offset) {
  return with_surface(surface, [&](const SceneSurface& s) {
    return show_combs(
        section_comb_picture(*s.current, {{x, y, z}, offset}, held().origin, visible_part(surface).get()));
  });
}

/// A curve or a volume: the text is `body_json`, its buffers stay until the next call.
KNEAD_EXPORT(knead_body_picture) int knead_body_picture(int body) {
  if (!held().session) return without_session();
  const auto& bodies = held().session->state().bodies;
  if (body < 0 || body >= static_cast<int>(bodies.size())) return fail({ErrorKind::usage, "there is no such body"});
  return show_body(body_picture(bodies[static_cast<std::size_t>(body)], held().origin));
}

/// Likewise the block that the command `lattice` would pull, with so many control points along x, y, z; `anew` is 1 for
/// one round the selected surfaces as they are.
KNEAD_EXPORT(knead_lattice_picture) int knead_lattice_picture(int x, int y, int z, double margin, int anew) {
  if (!held().session) return without_session();
  return show_body(lattice_picture(held().session->state(), margin, {x, y, z}, anew != 0, held().origin));
}

/// The shape of a tool in its own frame: the text is `tool_picture_json`, its buffers stay until the next call.
KNEAD_EXPORT(knead_tool_picture) int knead_tool_picture(int tool) {
  auto& session = held().session;
  if (!session) return without_session();
  const auto& tools = session->state().tools;
  if (tool < 0 || tool >= static_cast<int>(tools.size())) return fail({ErrorKind::usage, "there is no such tool"});
  held().tool = tool_picture(tools[static_cast<std::size_t>(tool)].shape.shape());
  return answer(tool_picture_json(held().tool));
}

/// Control points of a surface in full precision: the text is raw doubles.
KNEAD_EXPORT(knead_control_points) int knead_control_points(int surface) {
  return with_surface(surface, [](const SceneSurface& s) {
    const Points& points = s.current->control_points();
    return answer(std::string(reinterpret_cast<const char*>(points.data()),
                              static_cast<std::size_t>(points.size()) * sizeof(double)));
  });
}

/// Degree, net, knots, weights and control points of a surface in full precision, as JSON.
KNEAD_EXPORT(knead_surface) int knead_surface(int surface) {
  return with_surface(surface, [](const SceneSurface& s) { return answer(surface_json(*s.current)); });
}

/// The material of a surface as it is now, by samples over its domain: the text is `material_json`, its buffers stay
/// until the next call.
KNEAD_EXPORT(knead_material) int knead_material(int surface, int rows, int columns) {
  return with_surface(surface, [&](const SceneSurface& s) {
    auto samples = material_samples(s.material, *s.reference, {rows, columns});
    if (!samples) return fail(samples.error());
    held().material = *std::move(samples);
    return answer(material_json(held().material));
  });
}

/// The text is the `mesh_file` of the format at this position in the list of formats.
KNEAD_EXPORT(knead_mesh) int knead_mesh(int format, int detail) {
  auto& session = held().session;
  if (!session) return without_session();
  if (format < 0 || format >= static_cast<int>(formats().size())) {
    return fail({ErrorKind::usage, "there is no such format"});
  }
  return reply(mesh_file(*session, formats()[static_cast<std::size_t>(format)], detail));
}

/// The faces of the open file that are no surfaces of the session: the text is `context_json`, its buffers stay until
/// the next call of this function. Without a file there are none, and the text is null.
KNEAD_EXPORT(knead_context) int knead_context() {
  auto& session = held().session;
  if (!session || !session->document().model()) return answer("null");
  held().context = context_picture(*session->document().model(), held().origin);
  return answer(context_json(held().context, *session->document().source()));
}

/// The parts of the open file and where they stand: `assembly_json`; null without a file.
KNEAD_EXPORT(knead_assembly) int knead_assembly() {
  const auto& session = held().session;
  const brep::Model* model = session ? session->document().model() : nullptr;
  return answer(model != nullptr ? assembly_json(*model) : "null");
}

/// What the faces of the open file show of a surface: `trim_json`.
KNEAD_EXPORT(knead_trims) int knead_trims(int surface) {
  auto& session = held().session;
  if (!session || !session->document().model()) return answer("null");
  const auto& all = held().shown.trims(session->document());
  const std::size_t k = place_in_file(*held().session, surface);
  return answer(k < all.size() ? trim_json(all[k]) : "null");
}

/// The edges of the faces of the open file on a surface: `face_edges_json`; none if they cannot be followed.
KNEAD_EXPORT(knead_face_edges) int knead_face_edges(int surface) {
  auto& session = held().session;
  if (!session) return answer("[]");
  const auto& surfaces = session->state().surfaces;
  if (surface < 0 || surface >= static_cast<int>(surfaces.size())) return answer("[]");
  const SceneSurface& s = surfaces[static_cast<std::size_t>(surface)];
  if (s.visible) return answer(face_edges_json(*s.visible));
  const auto region = DocumentRegions(session->document()).of(s.id);
  return answer(region ? face_edges_json(*region) : "[]");
}
