#include "brep/face_point.hpp"
#include "command_fields.hpp"
#include "info_values.hpp"
#include "knead/session/session_info.hpp"
#include "scene/places.hpp"
#include "scene/shell_fields.hpp"

namespace knead {

void describe_measures(ReadingInfo& r, Fields& fields) {
  fields.add("at", r.at, {.unit = Unit::fraction});
  fields.add("point", r.point, {.unit = Unit::length});
  fields.add("displacement", r.displacement,
             {.help = "from the surface as opened", .unit = Unit::length});
  fields.add("normal", r.normal, {.help = "of length 1; zero where there is none"});
  fields.add("curvature", r.curvature,
             {.help = "the principal ones, the larger first; null where there is no normal"});
  fields.add("von_mises", r.von_mises,
             {.help = "of shells: on the face that the normal leaves, and on the other",
              .omit_empty = true});
  fields.add(
      "membrane", r.membrane,
      {.help = "of shells: principal forces per length, the larger first", .omit_empty = true});
  fields.add("moment", r.moment,
             {.help = "of shells: principal bending moments per length", .omit_empty = true});
  fields.add("bending_strain", r.bending_strain,
             {.help = "of shells: the largest strain that bending adds", .omit_empty = true});
}

void describe(ReadingInfo& r, Fields& fields) {
  fields.name("reading info", "What is measured at a point of a surface.");
  fields.add("name", r.name);
  fields.add("surface", r.surface,
             {.help = "its number; -1 of a face on no surface of the session"});
  describe_measures(r, fields);
}

Expected<ReadingInfo> reading_of(const Scene& scene, const Probe& probe) {
  const auto reading = read_probe(scene, probe);
  if (!reading) return std::unexpected(reading.error());
  ReadingInfo info;
  info.name = probe.name;
  info.surface = probe.surface;
  info.at = probe.at;
  info.point = array_of(reading->point);
  info.displacement = array_of(reading->displacement);
  info.normal = array_of(reading->normal);
  info.curvature = reading->curvature;
  const auto shell = read_shell(scene, probe.surface, probe.at);
  if (!shell) return std::unexpected(shell.error());
  if (*shell) {
    info.von_mises = (*shell)->von_mises;
    info.membrane = (*shell)->membrane;
    info.moment = (*shell)->moment;
    info.bending_strain = (*shell)->bending_strain;
  }
  return info;
}

std::vector<ReadingInfo> readings_of(const Scene& scene) {
  std::vector<ReadingInfo> result;
  for (const Probe& probe : scene.probes) {
    if (probe.list != "measurements") continue;
    if (auto reading = reading_of(scene, probe)) result.push_back(*std::move(reading));
  }
  return result;
}

Expected<std::string> reading_json(const Session& session, int surface,
                                   const std::array<double, 2>& at) {
  const auto reading = reading_of(session.state(), Probe{"measurements", "", surface, at});
  if (!reading) return std::unexpected(reading.error());
  return json_of(*reading);
}

Expected<std::string> face_reading_json(const Session& session, const std::string& face,
                                        const Point& near) {
  const brep::Model* model = session.document().model();
  if (model == nullptr) return input_error("the document has no faces", face);
  const auto found = point_on_face(*model, face, near);
  if (!found) return std::unexpected(found.error());
  ReadingInfo info;
  info.surface = -1;
  info.point = array_of(found->point);
  info.normal = array_of(found->normal);
  info.curvature = found->curvature;
  return json_of(info);
}

}  // namespace knead
