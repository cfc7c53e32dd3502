#include "knead/session/session.hpp"

namespace knead {

Expected<FacesFile> save_faces(const Session& session, const Format& format,
                               const SaveOptions& options, bool convert) {
  auto saved = session.save();
  if (!saved) return std::unexpected(std::move(saved.error()));
  const auto source = open_source(*std::move(saved), session.document().name());
  if (!source) return std::unexpected(source.error());
  return save_faces(**source, format, options, convert);
}

}  // namespace knead
