// Files and what is kept of sessions.
#include "knead/brep/face_conversion.hpp"
#include "knead/exchange/format.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/session/session_info.hpp"
#include "query.hpp"
#include "session/info_values.hpp"
#include "studio_context.hpp"

namespace knead::studio {
namespace {

std::string start(Studio& studio, Document document) {
  studio.origin = middle_of(document);
  studio.file_surfaces = document.surfaces().size();
  studio.shown.forget();
  studio.session.emplace(std::move(document));
  return session_json(*studio.session);
}

struct OpenQuery {
  using Answer = SessionInfo;
  Bytes file;
  std::string name;
};

void describe(OpenQuery& q, Fields& fields) {
  fields.name("open", "Begins a session on a file.");
  fields.add("file", q.file, {.help = "its bytes", .presence = Presence::required});
  fields.add("name", q.name, {.help = "of the file", .presence = Presence::required});
}

Expected<std::string> ask(Studio& studio, OpenQuery q) {
  auto source = open_source(std::move(q.file.data), std::move(q.name));
  if (!source) return std::unexpected(source.error());
  const auto model = (*source)->model();
  const bool nothing = (*source)->surfaces().empty() && (*source)->curves().empty();
  if (nothing && (model == nullptr || brep::other_surfaces(*model).empty())) {
    const auto& unreadable = (*source)->unreadable();
    if (!unreadable.empty()) return std::unexpected(unreadable.front().reason);
    return input_error("the file holds no surface", {},
                       "open a file with faces on surfaces: meshes cannot be sculpted");
  }
  return start(studio, Document::from(*std::move(source)));
}

struct FreshQuery {
  using Answer = SessionInfo;
  std::string name, unit = "mm";
};

void describe(FreshQuery& q, Fields& fields) {
  fields.name("fresh", "Begins a session without a file.");
  fields.add("name", q.name, {.help = "of the document", .presence = Presence::required});
  fields.add("unit", q.unit, {.help = "of lengths"});
}

Expected<std::string> ask(Studio& studio, const FreshQuery& q) {
  if (is_length_unit(q.unit)) return start(studio, Document::fresh(q.name, q.unit));
  return usage_error("\"" + q.unit + "\" is no unit of length", "unit",
                     "use one of " + list_of_length_units());
}

struct RestoreQuery {
  using Answer = Nothing;
  Bytes source, snapshot;
  std::string name, unit = "mm";
};

void describe(RestoreQuery& q, Fields& fields) {
  fields.name("restore",
              "Goes on with the session of a snapshot, with undo and redo; nothing is computed.");
  fields.add("source", q.source, {.help = "the file that it began with; of no bytes: without one"});
  fields.add("snapshot", q.snapshot,
             {.help = "of the query of that name", .presence = Presence::required});
  fields.add("name", q.name, {.help = "of the document", .presence = Presence::required});
  fields.add("unit", q.unit, {.help = "of one without a file"});
}

Expected<Nothing> ask(Studio& studio, RestoreQuery q) {
  Document document = Document::fresh(q.name, q.unit);
  if (!q.source.data.empty()) {
    auto source = open_source(std::move(q.source.data), q.name);
    if (!source) return std::unexpected(source.error());
    document = Document::from(*std::move(source));
  }
  const Point origin = middle_of(document);
  const std::size_t surfaces = document.surfaces().size();
  auto session = Session::restore(std::move(document), q.snapshot.data);
  if (!session) return std::unexpected(session.error());
  studio.origin = origin;
  studio.file_surfaces = surfaces;
  studio.shown.forget();
  studio.session = std::move(*session);
  return {};
}

struct SnapshotQuery {
  using Answer = Bytes;
  double history_bytes = 0;
};

void describe(SnapshotQuery& q, Fields& fields) {
  fields.name("snapshot", "All of the session as bytes.");
  fields.add("history_bytes", q.history_bytes,
             {.help = "of memory that states take, as far as which the history goes back",
              .range = between(0, 1e9),
              .presence = Presence::required});
}

Expected<std::string> ask(Session& session, const SnapshotQuery& q) {
  return session.snapshot(static_cast<std::size_t>(q.history_bytes));
}

/// The file, and how it leaves the edges of its faces; one answer, so that both are of the same
/// moment.
struct SavedFile {
  Bytes file;
  std::vector<EdgesInfo> edges;
};

void describe(SavedFile& saved, Fields& fields) {
  fields.name("saved file", "The document as a file.");
  fields.add("file", saved.file);
  fields.add("edges", saved.edges, {.help = "of the faces on every surface that has moved"});
}

Expected<SavedFile> save(Session& session) {
  auto file = session.save();
  if (!file) return std::unexpected(std::move(file.error()));
  return SavedFile{{*std::move(file)}, edges_info(session)};
}

}  // namespace

std::vector<Query> document_queries() {
  return {query<OpenQuery>(), query<FreshQuery>(), query<RestoreQuery>(), query<SnapshotQuery>(),
          query<SavedFile, save>("save", "The file as it is now.")};
}

}  // namespace knead::studio
