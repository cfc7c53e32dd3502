#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "knead/scene/model.hpp"
#include "knead/scene/trims.hpp"
#include "knead/session/document_regions.hpp"
#include "knead/session/session.hpp"
#include "knead/spline/site_values.hpp"
#include "motion_law.hpp"
#include "scene/model/met_conditions.hpp"
#include "scene/reshape.hpp"
#include "sculpt/travelled.hpp"

namespace knead {

/// A model that strokes press, and the abscissae at which they are remembered.
struct StrokeModel {
  SceneModel scene;
  std::vector<SiteValues<2>> values;  // per selected surface
  Points places;                      // at the abscissae of all of them, of the shapes from before the stroke

  /// Values at the abscissae of stacked control points, and back.
  [[nodiscard]] Points at_abscissae(const Points& x) const;
  [[nodiscard]] Points control_points(const Points& values) const;
  /// A displacement of control points that the model's constraints allow, for one that they may not.
  [[nodiscard]] Points allowed(const Points& x) const;
};

/// What an open brush has asked for so far: it follows from the scene.
struct BrushRun {
  ModelInput input;           ///< for which it was made
  OpenBrush open;             ///< the path is as far as it was led
  BrushPoint at = {};         ///< where the brush is, which may trail behind the end of the path
  std::vector<double> sides;  ///< of the selected surfaces: `seam_sides` from the one where the path begins
  BrushSamples samples;
  Points fair;                          ///< displacement to the fair shape, at the samples
  std::vector<BrushHistory> histories;  ///< of the stroke and its images
  bool stuck = false;                   ///< all that it asks for is held
  std::string shape = {};               ///< of which the pattern of a stamp was made; empty: of none

  /// Whether any control point is within the radius of the path.
  [[nodiscard]] bool reaches() const;
};

class ModelWalls;
struct WallMotion;

/// What happens where a surface comes to another face of its model: it is noted, allowed, or as far as it goes.
enum class Through { note, allow, stop };

/// What is known of faces beyond the states: undone, rehearsed or not.
struct KnownFaces {
  std::shared_ptr<const Document> document = {};                             ///< as in `SessionState`
  std::map<std::string, std::shared_ptr<const VisibleRegion>> visible = {};  ///< by surface
  std::shared_ptr<ModelWalls> walls = {};                                    ///< null until a surface has moved
};

struct Session::ModelCache {
  Models models;
  std::optional<StrokeModel> stroke;
  std::optional<BrushRun> brush;
  MetConditions conditions;
  KnownFaces faces;
};

/// Applies one command to a copy of the state, and has what commands share. Each command's file defines `execute` for
/// its fields.
struct SurfacePlace;

struct Executor {
  const Document& document;
  Models& models;  ///< of steps
  std::optional<StrokeModel>& stroke_cache;
  std::optional<BrushRun>& brush_cache;
  MetConditions& conditions;  ///< those there are, as of the last check
  KnownFaces& faces;          ///< of `document`
  SessionState& state;
  const Session::Progress& progress;
  bool allow_held = false;             ///< a tool may touch what is held alone
  std::optional<int> increments = {};  ///< of the load of a shell
  bool may_stop = false;               ///< the command may end after any of its steps
  std::optional<int> stopped = {};     ///< after so many steps
  DocumentRegions regions = DocumentRegions(document);
  std::optional<MotionLaw> law = {};  ///< what the command has asked for so far
  bool unruled = false;               ///< what acts has another law
  bool at_fold = false;               ///< the last step was made smaller, as more would fold a face: none follows
  Through through = Through::note;    ///< what the command may do at other faces
  bool stopped_at_face = false;       ///< it was made smaller there
  bool met_at_each_step = false;      ///< nothing of it is left to be compared with them

  template <class C>
  Expected<void> execute(const C& command);

  /// The one door of all that moves surfaces: what has moved further than it was asked to, by more than
  /// `law_tolerance`, is made smaller, and noted; a lever only where it moved further than the static solution of what
  /// acts on it, and how far is noted. Forgets what was asked.
  Expected<void> keep_law();

  /// Compares what moved from the surfaces of `before`, of an open stroke or brush from those before it, with the other
  /// faces of the model (`ModelWalls::first_contact`). What comes within the larger of the uncertainty of the file and
  /// 1e-6 of the size of the model is noted, with the place and how far it had come there, or made smaller alike, so
  /// that twice that distance is left.
  Expected<void> meet_faces(const Scene& before);

  /// The selected curve or volume; null if none is.
  SceneBody* body();
  /// An error, as of `selected`, where nothing is selected.
  Expected<void> some_selected();
  /// Calls f with each selected shape, the first one first, until it returns an error.
  template <class F>
  Expected<void> each_selected(const F& f) {
    if (state.body) return std::visit(f, *body());
    for (const int k : state.selection()) {
      if (auto done = f(state.surfaces[static_cast<std::size_t>(k)]); !done) return done;
    }
    return {};
  }
  /// The error (input) of a field that the selected curve or volume does not have.
  std::unexpected<Error> of_surfaces(std::string_view field, const char* remedy = "leave it out");

  /// The first selected surface, or an error that says how to select one.
  Expected<SceneSurface*> selected();
  /// The only selected surface. Error: there are several.
  Expected<SceneSurface*> selected_alone();
  Expected<int> find_surface(const std::string& id) const;
  /// The selected surface of this id; without one the first selected. Errors (input), named `field`: it is not
  /// selected.
  Expected<int> selected_surface(const std::optional<std::string>& id, const char* field = "surface");
  Expected<Tool*> find_tool(const std::optional<std::string>& name);
  /// Diagonal of the bounding box of the first selected surface's reference: the unit of `relative`.
  Expected<double> diagonal();

  /// Tells how many steps are done. Whether to go on; if not, `stopped` where a command may end early, else an error.
  Expected<bool> carries_on(int done, int total);
  /// Whether the command may end with so many steps done, after the next one was interrupted.
  bool keeps_steps(int done);

  /// Keeps a constraint on the selected surfaces, after trying that it can be made.
  Expected<void> keep(const Constraint& constraint);
  /// Whether the constraints there are can be made, and met together: what cannot is refused now, not at the next step.
  /// No matrix is factored.
  Expected<void> check_constraints();
  /// Whether the constraints can be made on some selected surfaces, of which those alone changed that ask for no motion
  /// (edges that are held where they are, freed or followed); of all surfaces, where some constraint does. Whether the
  /// model can be factored is found out by the next step. \param changed ascending numbers in the selection
  Expected<void> check_constraints_on(std::span<const int> changed);

  /// `count` steps with the forces of the scene and these.
  Expected<void> run(int count, const EvolutionPolicy& evolution, const std::vector<PointForce>& more = {},
                     int done = 0, int total = 0);
  /// Whether a selected surface is a shell.
  [[nodiscard]] bool shells() const;
  /// Share `plasticity` of the displacement becomes rest shape.
  Expected<void> yield(double plasticity);

  /// Puts a tool down to leave `share` of what the material lets stay, all along the way.
  Expected<void> begin_stroke(const std::string& tool, double share);
  /// Leads the tool of the open stroke on, and shows the shapes under it.
  Expected<void> stroke_to(const std::vector<Point>& points);
  /// Ends the open stroke, where there is one: the tool goes home, and what stays is the shape and the rest shape.
  Expected<void> lift();

  /// Opens a stroke of a brush with the selected surfaces as they are; its path is empty.
  void begin_brush(const Brush& brush, std::vector<BrushImage> images, double rope);
  /// Leads the open brush on, and makes what it asks for the shapes and rest shapes.
  Expected<void> brush_to(const std::vector<BrushPoint>& path);

  /// The same control points on other knots or with other weights. Errors: a limit is set (input), and those of
  /// `change`.
  Expected<void> change_basis(SceneSurface& surface, const SurfaceChange& change);
  /// The same shapes on another net, which is noted.
  Expected<void> change_net(SceneSurface& surface, const SurfaceChange& change);
  /// Refines what seams between selected surfaces need; with `followed` only those between faces at edges that follow.
  Expected<void> refine_seams(bool followed = false);
  /// Unites the knots of coupled edges within reach of a place that have too little in common to bend there
  /// (`SeamReport::restricted`), unless refining is not permitted. `reports` are those of the selected surfaces.
  Expected<void> unite_restricted(std::span<const SeamReport> reports, const Point& place, double reach);
  /// Halves the spans of the selected surfaces that a tool reaches. Returns whether there were any. Errors (numerical):
  /// `limited`, where nobody asked for it, and a net would get more than 40 000 control points, and four times those
  /// that it has in the file.
  Expected<bool> refine_under(const Tool& tool, bool limited = false);

  /// What faces show of a surface, by the document's file; all of a surface that is in no file. Errors: a face on it
  /// cannot be followed (input).
  Expected<const VisibleRegion*> visible(SceneSurface& surface);
  /// A surface as the document opened it, or as it was made.
  const Surface* document_surface(const SceneSurface& surface) const;
  /// Makes `visible` known of all selected surfaces of which edges of faces are held, or of which tools touch only what
  /// is visible; where that cannot be known, the latter is noted.
  Expected<void> know_trims();
  /// Unites the knots of faces at edges that follow, where refining is permitted.
  Expected<void> unite_followed();
  /// Makes an edge of faces one that may follow them. Errors (input): a face at it that cannot follow, or lies on a
  /// surface that is not selected, each named with what to do.
  Expected<void> follow_edge(const std::string& id);
  /// Makes the courses of edges known that follow selected surfaces. Errors: those of `follow_edge`.
  Expected<void> know_followed();
  /// Whether all edges that follow are still closed after surfaces changed from `before`. Errors (numerical): one is
  /// not, and by how much; a vertex of it moved that another edge holds.
  Expected<void> check_followed(const Scene& before);
  /// Holds the edges of faces on selected surfaces of which nothing is said as those of the first one that has its
  /// edges held; what cannot be followed is noted.
  void hold_likewise();
  /// Whether the edges of faces that are held stayed where they were as surfaces changed from `before`: for commands
  /// that place control points, as no model holds the edges there. Errors (numerical): an edge that moved, by how much,
  /// and how it may follow.
  Expected<void> check_held_edges(const Scene& before);
  /// The fractions of a place. Where edges of faces are held, a place that is not visible is an error which names the
  /// nearest one that is; elsewhere it is noted.
  Expected<Fractions> place_on(SceneSurface& surface, const SurfacePlace& place);
  /// Refines the selected surfaces of which edges of faces are held, so that something is free under each tool that
  /// touches them.
  Expected<void> refine_trims();
  /// The same at one place, for something of this size.
  Expected<void> refine_at_trims(SceneSurface& surface, const Fractions& at, double size);

 private:
  Expected<void> meet_faces(std::span<const std::shared_ptr<const Surface>> before);
  Expected<void> stop_at_face(std::span<const WallMotion> motions, double share);
  [[nodiscard]] std::vector<std::shared_ptr<const Surface>> shapes_before(const Scene& before) const;
  [[nodiscard]] std::shared_ptr<const Surface> rest_before(int surface) const;
  ModelWalls& known_walls();
  [[nodiscard]] std::string face_on(const std::string& surface);
  Expected<void> keep_law(MotionLaw& asked);
  Expected<void> ask_of_motion(const EvolutionPolicy& evolution, const std::vector<PointForce>& grips);
  void measure_from_rest();
  void note_loose();
  void keep_what_stroke_left();
  void ask_of_stroke(double moved, std::span<const Tool> tools);
  void ask_of_brush(double asked);
  [[nodiscard]] bool held_all_round(std::span<const SeamReport> reports) const;
  [[nodiscard]] bool goes_too_far(const ActiveStep& step, const ActiveLoads& loads, const Model& model);
  [[nodiscard]] Points points_of_law() const;
  [[nodiscard]] Expected<ActiveStep> within_depth(ActiveStep step, const ActiveState& from, std::span<const Tool> tools,
                                                  ActiveLoads loads) const;
  [[nodiscard]] double motion(double enough) const;
  [[nodiscard]] double static_motion() const;
  Expected<void> move_less(double share);
  void note_motion(std::string_view begins, const std::string& note, Diagnostic read = {});
  /// `count` steps of the selected curve or volume.
  Expected<void> run_body(int count, const EvolutionPolicy& evolution);
  [[nodiscard]] bool imprints(const ActiveStep& step) const;
  void note_all(std::span<const std::string> notes);
  Expected<void> know_what_holds();
  Expected<ActiveStep> next_step(const EvolutionPolicy& evolution, const std::vector<PointForce>& more,
                                 double& seconds);
  Expected<void> refine_as(const std::vector<SeamRefinement>& refinements);
  Expected<void> take(const ActiveStep& step);
  /// The same motion, made again and again with edges coupled more tightly.
  struct Attempts {
    struct Best {
      SharedItems<SceneSurface> surfaces;
      CouplingTolerance coupling;
      std::vector<Point> motion;  ///< of points of the edges, in the first one that could be accepted
    };
    std::vector<std::shared_ptr<const Surface>> before;  ///< of each surface of the scene
    std::optional<Best> best = {};                       ///< the tightest that could be accepted
  };
  [[nodiscard]] Attempts attempts() const;
  /// Whether the surfaces may stay as they are: edges that follow are closed, and as smooth as asked. If not, couples
  /// them more tightly and returns false: what moved the surfaces must be made again. Where that would keep the edges
  /// from moving, the tightest attempt that could be accepted is taken. What cannot be is left to `check_followed`.
  Expected<bool> together(Attempts& attempts);
  Expected<void> append_motion(const SharedEdge& edge, std::span<const std::shared_ptr<const Surface>> before,
                               std::vector<Point>& to) const;
  /// Takes a step unless `together` says that it must be made again; returns whether it was taken. Errors: those of
  /// `check_followed`.
  Expected<bool> take_together(const ActiveStep& step, Attempts& attempts);
  /// Refines a surface around a place that may lie this far from the nearest held edge.
  Expected<void> refine_round(SceneSurface& s, const TrimContact& contact, double size);
  /// Refines the faces at edges that follow: what is under a tool on one side, on the others too.
  Expected<void> refine_followed(const SceneSurface& touched, const TrimContact& contact, double size);
  void record(const ActiveStep& step, double seconds, std::string note);
  void note_model(std::span<const SeamReport> seams, std::span<const std::string> notes);
  void note_creases(std::span<const SeamReport> seams);
  /// Whether the surfaces of which edges of faces are held have not folded: their normals point to the same side as at
  /// rest, at four points per span. Error (numerical): where they do not.
  Expected<void> check_folds();
  /// Makes a motion smaller, everywhere alike, where it would fold a face: what is held is linear in displacements, and
  /// so holds for every share of them. \param shows shows this share of it; all of `whole` is shown. Returns the note
  /// on it, in which `what` names it; empty: nothing folds. Errors: as above, where not even a tenth of it would be
  /// left.
  Expected<std::string> keep_unfolded(std::string_view what, double whole,
                                      const std::function<Expected<void>(double)>& shows);
  /// The same of the open stroke, and of a step from these shapes, but not of an equilibrium. Of a step that is not the
  /// first, nothing may be left.
  Expected<std::string> keep_stroke_unfolded();
  Expected<std::string> keep_step_unfolded(std::span<const std::shared_ptr<const Surface>> from, bool first,
                                           const EvolutionPolicy& evolution);
  /// Error (numerical): a selected surface is further from the surface as opened than `limit` allows.
  [[nodiscard]] Expected<void> check_limit() const;
  /// The error of a step in which nothing is free to move under a tool.
  Error all_held(const std::string& tool) const;
  /// Some selected surface is held by the edges of its faces.
  bool holds_edges() const;
  Expected<void> prepare_stroke_model();
  /// Makes the model of this input, with the abscissae of the shapes from before the stroke, unless it is there.
  Expected<void> keep_stroke_model(ModelInput input, std::span<const OpenStroke::Before> before);
  Expected<void> put_tool(const Point& place);
  [[nodiscard]] Points stroke_guess(std::span<const Travel> travels) const;
  Expected<ActiveStep> press(std::vector<Tool> tools, std::span<const Travel> travels);
  [[nodiscard]] double depth_at_sites(std::span<const Tool> tools) const;
  Expected<ActiveStep> press_shell_on_bed(const std::vector<Tool>& tools, Points guess);
  Expected<void> unite_under_stroke();
  Expected<bool> refine_stroke(const ActiveStep* step);
  Expected<void> press_along(const std::vector<Point>& places);
  Expected<void> show_stroke(bool down);
  Expected<void> show_remembered(bool down);
  Expected<void> refine_for_brush(const std::vector<BrushPoint>& places);
  Expected<double> refine_under_brush(SceneSurface& surface, const Fractions& at, double pressure);
  [[nodiscard]] Expected<double> length_of_brush_model() const;
  Expected<void> prepare_brush_model();
  Expected<void> start_brush_run();
  Expected<void> lead_brush();
  Expected<Points> brushed();
  [[nodiscard]] Expected<double> share_of_grab(const Points& displacement) const;
  Expected<void> show_mask();
  /// The displacement of control points as the masks of the selected surfaces lessen it.
  [[nodiscard]] Points unmasked(Points displacement) const;
  Expected<void> show_brush(const Points& displacement);
  Expected<void> displace_from_brush(const Points& displacement);
};

inline constexpr double coarse = 0.5;      // spans longer than this share of a tool follow it less accurately
inline constexpr int max_refinements = 5;  // of the net under a tool at one place, if refining is permitted

/// The record of a step of what it says itself: neither the surface nor the displacement.
[[nodiscard]] StepRecord record_of(const ActiveStep& step, double seconds, std::string note);

/// A shape on the net of another one, whose degrees are these or more, as are its knots then.
[[nodiscard]] Expected<Surface> onto_net(Surface shape, const Surface& like);

/// The error of a step whose numbers are not finite.
[[nodiscard]] std::unexpected<Error> beyond_numbers();

/// The note on a step for the user: its own, or that the net is too coarse for a tool.
[[nodiscard]] std::string note_of(const ActiveStep& step);

/// "#12: the net is now …", for the notes.
[[nodiscard]] std::string net_note(const SceneSurface& surface);

}  // namespace knead
