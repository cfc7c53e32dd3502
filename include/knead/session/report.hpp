#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/exchange/field_grid.hpp"
#include "knead/scene/followed.hpp"
#include "knead/scene/shell_fields.hpp"
#include "knead/scene/trims.hpp"
#include "knead/session/session.hpp"

namespace knead {

// What the commands of a session have made of it, as values: the report and the analysis that programs write.

/// A changed surface whose part stands in several places of an assembly: the change shows in all of them.
struct RepeatedSurface {
  std::string surface, part;
  int places = 0;
};

/// What a script has made of a session. Times in seconds, lengths in units of the file.
struct Outcome {
  double time = 0;                             ///< of all steps
  double energy_before = 0, energy_after = 0;  ///< NaN where there is none
  double residual = 0, gap = 0;                ///< of the last step; the gap in sizes of the tool
  double largest_displacement = 0;             ///< of any point, from the shape as opened
  int moved = 0;                               ///< control points
  int surfaces = 0, bodies = 0;                ///< that have changed; converted surfaces count too
  std::vector<RepeatedSurface> places;
  std::vector<Note> notes;         ///< of the session, and on edges that are open
  std::optional<Error> no_energy;  ///< why the energy cannot be computed
};

/// \param opened how many surfaces the file had: those that follow were converted, and are written as B-splines
/// Cost: an evaluation of the energy, and of every moved shape.
[[nodiscard]] Outcome outcome_of(Session& session, std::size_t opened);

/// The edges of the faces on one surface: how they are held, how far the surface is from them.
struct EdgesReport {
  int surface = 0;  ///< index
  TrimReport trims;
};

/// Of every surface with known edges that moved, or that holds them, in order. Surfaces whose edges cannot be measured
/// are left out. Cost: that of `trim_report`.
[[nodiscard]] std::vector<EdgesReport> report_edges(const SessionState& state);

/// "follow", or what of an edge is held: "free", "position", "clamped", "curvature".
[[nodiscard]] std::string_view hold_of(const TrimReport::Edge& edge);

/// The angles between the tangent planes at an edge that follows and was smooth as opened; none for other edges. Cost:
/// that of `parting`.
[[nodiscard]] std::optional<Parting> angles_at(const SessionState& state, const std::string& edge);

/// "none", "C0", "G1", "periodic".
[[nodiscard]] std::string_view name_of(SeamContinuity continuity);
/// "#12 u0": a side of a surface.
[[nodiscard]] std::string name_of(const SessionState& state, const PatchEdge& edge);

/// What a script has made, as `knead sculpt --report` writes it (docs/command-line.md): every figure of every step, the
/// outcome, edges, places, seams, notes, modes, and the readings of the scene's probes in the lists that they name.
/// Errors: those of `read_probe` and `read_shell`. Cost: one evaluation for each probe, and `report_edges`.
[[nodiscard]] Expected<std::string> report_json(const SessionState& state, const Outcome& outcome);

/// The results of an analysis: `result_grid` of each selected surface, with the shapes `mode_1`, …, `buckling_1`, … of
/// its modes and buckling modes. Errors: those of `result_grid`, at the id of the surface.
[[nodiscard]] Expected<std::vector<FieldGrid>> result_grids(const SessionState& state, int samples);

/// The same as `knead analyse --results` writes them: with the reactions of a shell and the modes. Errors: those of
/// `hold_reactions`.
[[nodiscard]] Expected<std::string> analysis_json(const SessionState& state, std::span<const FieldGrid> grids);

}  // namespace knead
