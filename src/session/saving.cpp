// The document of a session as files.
#include <algorithm>
#include <cmath>
#include <utility>

#include "knead/exchange/format.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/session/session.hpp"
#include "session_state.hpp"

namespace knead {
namespace {

/// Whether a surface is that of the file but for the rounding of knots that were inserted and
/// removed again: it stands as it was opened, on the knots of the file.
bool only_rounded(const SceneSurface& s, const Surface& file) {
  constexpr double roundings = 1e-13;  // of the largest coordinate
  const Surface &now = *s.current, &opened = *s.opened;
  const auto same = [](const Points& a, const Points& b) { return a.rows() == b.rows() && a == b; };
  for (int d = 0; d < 2; ++d) {
    if (!std::ranges::equal(now.knots(d).knots(), file.knots(d).knots())) return false;
  }
  if (!same(now.control_points(), opened.control_points()) ||
      !std::ranges::equal(now.weights(), opened.weights()) ||
      now.weights().size() != file.weights().size()) {
    return false;
  }
  for (std::size_t k = 0; k < now.weights().size(); ++k) {
    if (std::abs(now.weights()[k] - file.weights()[k]) > roundings * std::abs(file.weights()[k]))
      return false;
  }
  const double largest = file.control_points().cwiseAbs().maxCoeff();
  return (now.control_points() - file.control_points()).cwiseAbs().maxCoeff() <=
         roundings * largest;
}

std::vector<DocumentSurface> present_surfaces(const Document& document, const Scene& state) {
  std::vector<DocumentSurface> surfaces;
  const auto& scene = state.surfaces;
  const auto append = [&](const SceneSurface& s) {
    surfaces.push_back({s.id, s.name, s.unit, s.current});
  };
  if (document.is_fresh()) std::ranges::for_each(scene, append);
  for (const DocumentSurface& s : document.surfaces()) {  // converted ones come last in the scene
    append(*std::ranges::find(scene, s.id, &SceneSurface::id));
    if (surfaces.back().surface != s.surface &&
        only_rounded(*std::ranges::find(scene, s.id, &SceneSurface::id), *s.surface)) {
      surfaces.back().surface = s.surface;
    }
  }
  return surfaces;
}

/// The curves and volumes as they are now.
std::vector<DocumentBody> present_bodies(const Scene& scene) {
  std::vector<DocumentBody> bodies;
  for (const SceneBody& body : scene.bodies) {
    std::visit([&](const auto& b) { bodies.push_back({b.id, b.name, b.unit, b.current}); }, body);
  }
  return bodies;
}

}  // namespace

Expected<std::string> saved(const Document& document, const SessionState& state) {
  const auto parted = parted_edges(document, state);
  if (!parted) return std::unexpected(parted.error());
  if (auto none = check_parted(*parted); !none) return std::unexpected(none.error());
  std::vector<std::string> followed;
  for (const FollowedEdge& edge : state.followed) followed.push_back(edge.id);
  return document.save(present_surfaces(document, state), followed, present_bodies(state));
}

Expected<std::string> Session::save() const { return saved(document(), state()); }

Expected<std::string> Session::save_as(const Format& format, const SaveOptions& how) const {
  return document().save_as(format, present_surfaces(document(), state()), present_bodies(state()),
                            how);
}

Expected<std::shared_ptr<const Source>> saved_source(const Document& document,
                                                     const SessionState& state) {
  auto bytes = saved(document, state);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  return open_source(*std::move(bytes), document.name());
}

Expected<std::shared_ptr<const Source>> saved_source(const Session& session) {
  return saved_source(session.document(), session.state());
}

namespace {

Expected<WrittenFile> without_loss(Expected<std::string> bytes) {
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  return WrittenFile{*std::move(bytes), {}};
}

WrittenFile with_loss(std::string bytes, std::vector<std::string> sentences,
                      const std::vector<LeftOut>& left_out) {
  for (const LeftOut& left : left_out) sentences.push_back(sentence(left));
  return {std::move(bytes), std::move(sentences)};
}

Expected<WrittenFile> triangles_of(const Session& session, const Format& format,
                                   const FileOptions& how) {
  if (session.document().model() == nullptr) {
    std::vector<NamedSurface> surfaces;
    SaveOptions options;
    options.detail = how.detail;
    for (const SceneSurface& s : session.state().surfaces) {
      surfaces.push_back({s.name.empty() ? s.id : s.name, *s.current});
      options.unit = s.unit;
    }
    return without_loss(save_surfaces(surfaces, format, options));
  }
  const auto file = saved_source(session);
  if (!file) return std::unexpected(file.error());
  auto model = save_model(**file, format, how.tolerance);
  if (!model) return std::unexpected(std::move(model.error()));
  return with_loss(std::move(model->bytes), std::move(model->warnings),
                   left_out_of_mesh(**file, model->skipped));
}

}  // namespace

Expected<FacesFile> save_faces(const Session& session, const Format& format,
                               const SaveOptions& options, bool convert) {
  const auto source = saved_source(session);
  if (!source) return std::unexpected(source.error());
  return save_faces(**source, format, options, convert);
}

Expected<WrittenFile> file_of(const Session& session, const std::string& name,
                              const FileOptions& how) {
  if (const auto triangles = format_of_name(name, FormatContent::triangles))
    return triangles_of(session, **triangles, how);
  const auto format = format_of_name(name, FormatContent::surfaces);
  if (!format) {
    Error error = format.error();
    error.remedy += "; triangles: " + list_of_endings(FormatContent::triangles);
    return std::unexpected(std::move(error));
  }
  const Document& document = session.document();
  if (document.source() != nullptr && (*format)->name == document.source()->format())
    return without_loss(session.save());
  const SaveOptions options{.schema = how.schema};
  if (document.model() == nullptr || (*format)->save_faces == nullptr)
    return without_loss(session.save_as(**format, options));
  auto made = save_faces(session, **format, options);
  if (!made) return std::unexpected(std::move(made.error()));
  return with_loss(std::move(made->bytes), {}, made->left_out);
}

}  // namespace knead
