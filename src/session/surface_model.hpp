#pragma once

#include <span>
#include "knead/sculpt/constraints.hpp"

#include "knead/session/session.hpp"

namespace knead {

/// Everything that a model of the selected surfaces is made from, to tell whether the last one still serves.
struct ModelInput {
  std::vector<std::shared_ptr<const Surface>> references;
  std::vector<std::shared_ptr<const Surface>> rests;  // where constraints speak of places; else empty
  std::vector<RestMode> modes;
  std::vector<MaterialFieldOf<2>> materials;
  std::vector<int> hold_rows;
  std::vector<std::set<std::array<int, 2>>> pins;
  std::vector<std::vector<KeptConstraint>> constraints;
  std::vector<std::array<bool, 2>> smooth;
  SeamsCommand seams;
  ScalingMode scaling = ScalingMode::normalised;
  EvolveCommand evolve;
  double detail = 0;

  friend bool operator==(const ModelInput&, const ModelInput&) = default;
};

[[nodiscard]] ModelInput model_input(const SessionState& state, const EvolveCommand& evolve);

/// A model of the selected surfaces, coupled and constrained as asked.
struct SurfaceModel {
  ModelInput input;
  ActiveSurface model;
  std::vector<SeamReport> seams;
  std::vector<std::string> notes;
};

[[nodiscard]] Expected<SurfaceModel> make_model(const SessionState& state, ModelInput input);

/// Seams between these patches (and of each with itself) to the tolerance that was asked for, or the suggested one.
[[nodiscard]] Expected<FoundSeams> seams_between(const SessionState& state, std::span<const Surface* const> patches);

/// The selected surfaces' control points, one below the other.
[[nodiscard]] ActiveState active_state(const SessionState& state);

/// Loads, forces and the limit of the scene. Errors: a force on a point that there is not.
/// `model` is that of the selected surfaces.
[[nodiscard]] Expected<ActiveLoads> active_loads(const SessionState& state, const ActiveSurface& model);

/// The sampled part of a load, over the domain of a surface.
[[nodiscard]] Expected<Surface> load_field(const LoadCommand& load, const Surface& surface);

/// The plane of a mirror symmetry: as given, or the best one.
[[nodiscard]] Expected<MirrorPlane> plane_of(const SymmetryCommand& c, const Surface& surface);

/// Appends what keeps a symmetry of a surface.
[[nodiscard]] Expected<void> symmetry_constraints(const SurfaceState& surface, const SymmetryCommand& c,
                                                  ConstraintList& list);

/// The edges that a choice stands for.
[[nodiscard]] std::vector<SurfaceEdge> edges_of(EdgeChoice which);

/// (u, v) at fractions of the domain. Error (input): a number that is not from 0 to 1, named `where`.
[[nodiscard]] Expected<std::array<double, 2>> parameters_at(const Surface& surface, const Fractions& at,
                                                            const char* where = "at");
[[nodiscard]] Expected<std::array<Interval, 2>> region_at(const Surface& surface,
                                                          const std::array<Fractions, 2>& region);

/// R_ij(u, v) of all control points that act on a point, rows counted from `first`.
[[nodiscard]] std::vector<std::pair<int, double>> basis_terms(const Surface& surface, const std::array<double, 2>& u,
                                                              int first);

}  // namespace knead
