#include "studio_mesh.hpp"

#include "knead/exchange/save_model.hpp"

namespace knead::studio {

Expected<std::string> mesh_file(const Session& session, const Format& format, int detail) {
  std::vector<NamedSurface> surfaces;
  SaveOptions options;
  options.detail = detail;
  for (const SceneSurface& s : session.state().surfaces) {
    surfaces.push_back({s.name.empty() ? s.id : s.name, *s.current});
    options.unit = s.unit;
  }
  if (session.document().model() == nullptr) return save_surfaces(surfaces, format, options);
  auto saved = session.save();
  if (!saved) return std::unexpected(saved.error());
  const auto file = open_source(*std::move(saved), session.document().name());
  if (!file) return std::unexpected(file.error());
  auto model = save_model(**file, format, 0, options);
  if (!model) return std::unexpected(model.error());
  return std::move(model->bytes);
}

}  // namespace knead::studio
