#include "deviation.hpp"

#include <utility>

#include "session/session_state.hpp"

namespace knead {

void describe(DeviationQuery& q, Fields& fields) {
  fields.name("deviation",
              "How far data are from the faces of the document, as it would be saved: what `morph` "
              "with the same data would make it follow (docs/morph.md). Nothing moves.");
  describe_data(q.request.space, q.data, fields);
  describe_partners(q.request, fields);
}

Expected<DataDeviation> ask(const Session& session, const DeviationQuery& q) {
  const auto data = data_of(q.data, q.request.space);
  if (auto right = check_kinds(data); !right) return std::unexpected(std::move(right.error()));
  const auto source = saved_source(session);
  if (!source) return std::unexpected(source.error());
  MorphSettings settings = q.request.settings;
  settings.along_normal = q.request.along.has_value();
  return detail::data_deviation(*source, data, std::move(settings));
}

}  // namespace knead
