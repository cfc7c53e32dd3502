#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/energy/shell_energy.hpp"
#include "knead/exchange/numerical_files.hpp"
#include "knead/session/session.hpp"

namespace knead {

// What the commands of a session have made of it, as values: the report and the analysis that
// programs write.

/// A changed surface whose part stands in several places of an assembly: the change shows in all of
/// them.
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

/// \param opened how many surfaces the file had: those that follow were converted, and are written
/// as B-splines Cost: an evaluation of the energy, and of every moved shape.
[[nodiscard]] Outcome outcome_of(Session& session, std::size_t opened);

/// The state of an edge of the faces on a surface.
struct EdgeReport {
  std::string id;
  std::string_view
      hold;  ///< "follow", or what of it is held: "open", "position", "tangent", "curvature"
  bool held = false;  ///< its place, at least
  bool along_lines =
      true;                ///< it runs along knot lines or ends of the domain only: no more is held
  int control_points = 0;  ///< that it was the first edge to hold
  double deviation = 0;    ///< max |S − S_opened| along it, file units
  std::vector<std::string> faces;  ///< on the other side
};

/// The edges of the faces on one surface: how they are held, how far the surface is from them.
struct EdgesReport {
  int surface = 0;  ///< an index into `Session::surfaces`
  std::vector<EdgeReport> edges;
  int free = 0,
      visible = 0;  ///< control points: those that may move, those that act on what is visible
  std::array<int, 2> net = {};  ///< control points by direction
  int samples = 0;              ///< points on all edges at which deviations were measured
  double largest_gap = 0;       ///< largest deviation of any edge that does not follow, file units
};

/// Of every surface with known edges that moved, or that holds them, in order. Surfaces whose edges
/// cannot be measured are left out. Cost: linear in the corners of the courses of all edges.
[[nodiscard]] std::vector<EdgesReport> report_edges(const Session& session);

/// An edge that follows its faces and was smooth as opened.
struct FollowedReport {
  std::string id;
  double angle = 0,
         angle_before = 0;  ///< the largest between its tangent planes, radians, now and as opened
};

/// Those whose angles can be measured, in the order in which they were let go. Cost: evaluates all
/// faces at the samples of each edge and at seven points in every span that it crosses.
[[nodiscard]] std::vector<FollowedReport> report_followed(const Session& session);

/// A seam of the last step, or why there is none.
struct SeamSummary {
  std::string a, b;        ///< "#12 u0": a side of a surface
  std::string continuity;  ///< "none", "C0", "G1", "periodic"
  double gap = 0;          ///< the largest distance of the two sides, file units
  std::string reason;      ///< why it is not smoother
};
[[nodiscard]] std::vector<SeamSummary> report_seams(const Session& session);

/// What a script has made, as `knead sculpt --report` writes it (docs/command-line.md): every
/// figure of every step, the outcome, edges, places, seams, notes, modes, and the readings of the
/// probes in the lists that they name. Errors: a probe outside of its domain (input), a rational
/// denominator that is not positive (numerical). Cost: one evaluation for each probe, and
/// `report_edges`.
[[nodiscard]] Expected<std::string> report_json(const Session& session, const Outcome& outcome);

/// The selected curve or volume.
struct BodyReport {
  std::string_view kind;  ///< "curve", "volume"
  std::string id, name, unit;
  std::vector<int> degrees, net;  ///< by direction; numbers of control points
};
[[nodiscard]] std::optional<BodyReport> report_body(const Session& session);

/// The material of a surface that is a shell. Requires: an index into `Session::surfaces`.
[[nodiscard]] std::optional<ShellMaterial> shell_of(const Session& session, int surface);

/// "box of sizes 10 x 20 x 5, rounding 2".
[[nodiscard]] std::string in_words(const Shape& shape);

/// The results of an analysis: each selected surface on `samples` × `samples` points, uniform in
/// its parameters, its present points with the fields `displacement` (from the rest shape), of
/// shells `membrane`, `moment`, `von_mises` (as in `ShellPointResults`) and `bending_strain`, and
/// the shapes `mode_1`, …, `buckling_1`, … of its modes and buckling modes. Errors, at the id of
/// the surface: fewer than 2 samples (input), those of `shell_results`.
[[nodiscard]] Expected<std::vector<FieldGrid>> result_grids(const Session& session, int samples);

/// The same as `knead analyse --results` writes them: with the modes, and of a shell the reactions
/// of all holds, which in equilibrium sum to zero with the loads. Errors: those of a static step of
/// a shell.
[[nodiscard]] Expected<std::string> analysis_json(const Session& session,
                                                  std::span<const FieldGrid> grids);

}  // namespace knead
