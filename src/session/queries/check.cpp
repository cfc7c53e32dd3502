#include "check.hpp"

#include "knead/exchange/format.hpp"
#include "session/session_state.hpp"

namespace knead {

static constexpr Choice grades[] = {{"a", "0.01 mm and 0.1 degrees"},
                                    {"b", "0.02 mm and 0.2 degrees"},
                                    {"c", "0.05 mm and 0.5 degrees"}};

void describe(CheckQuery& q, Fields& fields) {
  fields.name("check",
              "How the faces of the document meet at its edges, as it would be saved, and what of "
              "that exceeds a threshold (docs/check.md).");
  EdgeCheckRequest& check = q.check;
  fields.add("gap", check.gap, {.help = "largest gap, in the file's units", .range = at_least(0)});
  fields.add("angle", check.angle,
             {.help = "largest angle of edges that are meant to be smooth, degrees",
              .range = between(0, brep::meant_smooth)});
  fields.add("curvature", check.curvature,
             {.help = "largest relative difference in curvature there, percent",
              .range = between(0, 100)});
  fields.add("class", check.grade,
             {.help = "gap and angle of a class, where they are not given",
              .fallback = "none",
              .choices = grades});
  fields.add("edges", check.edges, {.help = "only these, by id"});
  fields.add("unit", check.unit,
             {.help = "of the coordinates, for a class, where the file does not say it",
              .omit_empty = true});
  fields.add("courses", check.courses, {.help = "with points along the edges, for drawing"});
  fields.add("against", q.against,
             {.help = "an earlier version of the file: only what is worse by more than the "
                      "thresholds counts"});
}

Expected<brep::EdgeCheckReport> ask(const Session& session, const CheckQuery& q) {
  const auto now = saved_source(session);
  if (!now) return std::unexpected(now.error());
  if (q.against.data.empty()) return check_edges(**now, q.check);
  const auto before = open_source(q.against.data, "against");
  if (!before) return std::unexpected(before.error());
  return check_edges(**now, q.check, before->get());
}

}  // namespace knead
