// What is measured of surfaces and their edges.
#include "knead/session/session_info.hpp"
#include "query.hpp"
#include "session/info_values.hpp"

namespace knead::studio {
namespace {

Expected<std::string> edge_distance(Session& session, int number) {
  if (!has_surface(session, number)) return "null";
  return edge_distance_json(session, static_cast<std::size_t>(number));
}

struct ReadingQuery {
  using Answer = ReadingInfo;
  int surface = 0;
  Fractions at = {0, 0};
};

void describe(ReadingQuery& q, Fields& fields) {
  fields.name("reading", "What is measured at a point of a surface.");
  fields.add("surface", q.surface, {.help = "its number", .presence = Presence::required});
  fields.add("at", q.at,
             {.help = "s and t", .unit = Unit::fraction, .presence = Presence::required});
}

Expected<std::string> ask(Session& session, const ReadingQuery& q) {
  if (const auto surface = surface_of(session, q.surface); !surface)
    return std::unexpected(surface.error());
  return reading_json(session, q.surface, q.at);
}

struct FaceReadingQuery {
  using Answer = ReadingInfo;
  std::string face;
  Vector3 near = {0, 0, 0};
};

void describe(FaceReadingQuery& q, Fields& fields) {
  fields.name("face_reading", "The same on a face that lies on no surface of the session.");
  fields.add("face", q.face, {.help = "its id", .presence = Presence::required});
  fields.add("near", q.near,
             {.help = "it is measured at the nearest point", .presence = Presence::required});
}

Expected<std::string> ask(Session& session, const FaceReadingQuery& q) {
  return face_reading_json(session, q.face, {q.near[0], q.near[1], q.near[2]});
}

}  // namespace

std::vector<Query> reading_queries() {
  return {query<std::optional<double>, edge_distance>(
              "edge_distance",
              "How far the visible middle of a surface is from the nearest edge of a face, in "
              "units of the file; null where no edges are known."),
          query<ReadingQuery>(), query<FaceReadingQuery>()};
}

}  // namespace knead::studio
