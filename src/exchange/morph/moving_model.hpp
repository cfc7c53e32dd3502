#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "knead/exchange/morph.hpp"
#include "morph/surface_fit.hpp"

namespace knead::detail {

/// Where a surface stands in the model.
struct SurfacePlace {
  Eigen::Affine3d to_model = Eigen::Affine3d::Identity();
  std::string part = {};                 ///< its name
  std::vector<std::string> others = {};  ///< all places of it, if it is not said which is meant
};

/// A file whose faces are to move, as `fit_surfaces` takes it.
struct MovingModel {
  std::shared_ptr<const Source> source;   ///< with all surfaces as B-splines that can be
  std::shared_ptr<const Source> written;  ///< with those that move alone
  std::shared_ptr<const brep::Model> model;
  std::vector<morph::FitSurface> surfaces;      ///< one for each of the source
  std::vector<bool> shown;                      ///< of each: faces show some of it
  std::vector<std::vector<std::string>> faces;  ///< on each
  std::vector<SurfacePlace> places;             ///< of each
  std::vector<morph::FitSurface> placed;        ///< `surfaces` in the coordinates of the model
  std::vector<morph::FitEdge> edges;
  std::vector<std::string> converted;  ///< those of `written`
  std::vector<MorphException> fixed, unknown_edges;
  /// Of lengths of the model.
  [[nodiscard]] std::string unit() const;
};

/// The surface moved by an affine map. Errors: coordinates that are not finite then.
[[nodiscard]] Expected<Surface> image_of(const Surface& surface, const Eigen::Affine3d& map);

/// Puts surfaces, their edges and what they keep where their parts stand. Errors (input): a place
/// at which no part stands.
[[nodiscard]] Expected<void> add_places(const MorphSettings& settings, MovingModel& model);

/// What surfaces keep exactly, by their ids.
using MorphHolds = std::map<std::string, std::shared_ptr<const morph::SurfaceHolds>>;

/// `morph_file` with what surfaces keep beside `MorphSettings::keep`.
[[nodiscard]] Expected<MorphedFile> morph_file(const std::shared_ptr<const Source>& source,
                                               const MorphData& data, const MorphSettings& settings,
                                               const MorphHolds& holds, const MorphTold& told);

/// Converts what is to move, follows the visible parts of all surfaces and all edges, by threads.
/// Errors: those of `morph_file`.
[[nodiscard]] Expected<MovingModel> moving_model(const std::shared_ptr<const Source>& source,
                                                 const MorphSettings& settings,
                                                 const MorphHolds& holds = {});

}  // namespace knead::detail
