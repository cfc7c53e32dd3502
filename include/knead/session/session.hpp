#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/exchange/save_model.hpp"
#include "knead/session/command.hpp"
#include "knead/session/document.hpp"
#include "knead/tool/tool.hpp"

namespace knead {

/// What a command did besides what it was asked for: a text for people, and what a program reads of
/// it, null if nothing but the text is known. Notes with the same text are the same; snapshots keep
/// both.
struct Note : std::string {
  std::shared_ptr<const Diagnostic> diagnostic;

  Note() = default;
  Note(std::string text) : std::string(std::move(text)) {}  // NOLINT: a text is a note
  Note(std::string text, Diagnostic read) : std::string(std::move(text)) {
    if (read.code != ErrorCode{}) diagnostic = std::make_shared<const Diagnostic>(std::move(read));
  }
};

/// The record of one step.
struct StepRecord {
  int surface = 0;    ///< index into the state's surfaces: the first one selected; −1: of a body
  double time = 0;    ///< seconds
  double energy = 0;  ///< Σ Xᵀ K X after the step, normalised units: stretch + bend
  double stretch = 0, bend = 0, kinetic = 0, contact = 0;  ///< by term, see ActiveStep
  double residual = 0;              ///< relative imbalance of forces, see ActiveStep
  double largest_displacement = 0;  ///< from the surface as opened, file units
  double gap = 0;        ///< deepest penetration of a collision tool, in sizes of that tool
  std::string gap_tool;  ///< its name; empty without a penetration
  double violation = 0;  ///< of the constraints, file units
  int iterations = 0;
  bool converged = true;
  bool limited = false;                    ///< the limit restrains some point
  std::string note;                        ///< what went wrong, and what would help
  std::optional<double> load_factor = {};  ///< of a shell: the share of the load that is balanced
  std::vector<int> increments = {};  ///< of a shell: Newton iterations of each part of the load
  std::optional<double> energy_error = {};  ///< of rational shapes, see ActiveStep

  friend bool operator==(const StepRecord&, const StepRecord&) = default;
};

/// A mode that `modes` or `buckling` found: of the selected surfaces, their control points stacked.
struct ModeRecord {
  double value = 0;     ///< a frequency, or a factor of the load
  double residual = 0;  ///< relative, see solve/eigenmodes.hpp
  Points shape = {};    ///< displacements of the control points, of largest length 1
};

/// A surface of a session: what the file or a command calls it, and its shapes.
struct SessionSurface {
  std::string id, name, unit;
  std::shared_ptr<const Surface> opened;   ///< by the document, or as it was made
  std::shared_ptr<const Surface> rest;     ///< where its energy is measured from
  std::shared_ptr<const Surface> current;  ///< as it is now
};

struct PartedEdge;
struct SessionState;

/// How an act enters the history.
struct ActOptions {
  bool join = false;  ///< it belongs to the entry before it, and is undone with that
  bool keep = false;  ///< it is an entry even if it changes nothing
};

/// A document and its history of commands: the model and controller of every user interface.
///
/// Every command either takes full effect or returns an `Error` and changes nothing. Undo and redo
/// restore states bit for bit. Not thread-safe.
class Session {
 public:
  explicit Session(Document document);
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

  /// Called after each step of a stepping command with the numbers of steps done and requested;
  /// returns whether to go on. A `step` command that is stopped keeps the steps it has made, and
  /// its entry counts only those. Others that are stopped are errors (input), and change nothing.
  using Progress = std::function<bool(int, int)>;
  /// Asked within steps whether to go on (see `Interruption`): after a no the present step is given
  /// up, and the command ends as if it had been stopped after the step before; where there is none
  /// it is an error (input), and changes nothing.
  using GoOn = std::function<bool()>;

  /// Errors: of kind input where the command asks for what cannot be, numerical where it cannot be
  /// computed.
  [[nodiscard]] Expected<void> execute(const Command& command, const Progress& progress = {},
                                       const GoOn& go_on = {});

  /// Whether commands that do not say otherwise (`allow`) stop where a surface comes to another
  /// face of its model, instead of noting it; those that have stopped say so in the journal.
  void stop_at_faces(bool stops) { stops_at_faces_ = stops; }

  /// Carries out commands without undo and redo, each after the one before, and leaves the session
  /// as it is, with what can be redone: only the models that they made and factored are kept, so
  /// that the same commands take less time later, with the same bits. Errors: that of the first
  /// command that fails.
  [[nodiscard]] Expected<void> rehearse(std::span<const Command> commands, const GoOn& go_on = {});

  /// Carries out commands as one act: one entry of the history, wherever they come from. If one
  /// fails, the session is what it was before the first, with what can be redone. Settings and
  /// steps that leave the scene bit for bit as it was (`step`, `evolve`, `load`, `hold`, `select`,
  /// `limit`, `seams`, `material` without a region) are no entry either, unless they are joined or
  /// kept. `undo` and `redo` among the commands end the entry.
  ///
  /// Returns whether there is something new. Errors: that of the first command that fails.
  [[nodiscard]] Expected<bool> act(std::span<const Command> commands,
                                   const ActOptions& options = {}, const Progress& progress = {},
                                   const GoOn& go_on = {});

  /// What becomes of the error of a command; its number counts from 0.
  using ErrorAt = std::function<Error(Error, std::size_t)>;
  /// Carries out commands as a script does: each is an entry of the history. If one fails, the
  /// session is what it was before the first, with what can be redone; if one is stopped, what it
  /// and those before it have done stands. Errors: what `at` makes of that of the first command
  /// that fails.
  [[nodiscard]] Expected<void> run(std::span<const Command> commands, const ErrorAt& at,
                                   const Progress& progress = {}, const GoOn& go_on = {});

  /// Takes the last entry of the history away where it is such settings and steps, and has changed
  /// nothing.
  void drop_unchanged();

  /// From now on undo goes no further back than here, the floor, and nothing is redone: the
  /// document is opened.
  void begin_history();
  /// The same in a restored session: the floor is after the first `commands` of the journal, or
  /// after the oldest state that is left; what can be redone stays.
  void begin_history_after(std::size_t commands);
  /// How many commands of the journal are below the floor.
  [[nodiscard]] std::size_t opening_commands() const;

  /// Merges the last entry of the history with the one before it: undo then reverts both at once,
  /// and the state between them is dropped. Nothing is merged with what is below the floor. For
  /// many commands that are one action, such as a stroke that follows the pointer. Equal `step`
  /// commands that become adjacent are merged into one with the sum of their counts, which is
  /// equivalent, and so is a stroke with the one it continues. Does nothing if there are fewer than
  /// two entries, or if something can be redone.
  void join();

  /// With the surfaces that are converted in the present state.
  [[nodiscard]] const Document& document() const;
  /// All surfaces: those of the document in its order, then those that commands have converted or
  /// made.
  [[nodiscard]] std::vector<SessionSurface> surfaces() const;
  /// The selected ones, as indices into `surfaces`, the first one first; none where a curve or a
  /// volume is selected.
  [[nodiscard]] std::vector<int> selection() const;
  /// Lengths in file units.
  [[nodiscard]] const std::vector<Tool>& tools() const;
  [[nodiscard]] std::vector<StepRecord> steps() const;
  /// What the last commands `modes` and `buckling` found, lowest first.
  [[nodiscard]] const std::vector<ModeRecord>& modes() const;
  [[nodiscard]] const std::vector<ModeRecord>& buckling() const;
  /// All that commands have made, a value that is the library's own
  /// (src/session/session_state.hpp).
  [[nodiscard]] const SessionState& state() const { return *states_[position_]; }
  /// The commands in effect, in order: together with the document, the whole session.
  [[nodiscard]] std::vector<Command> journal() const;
  [[nodiscard]] bool can_undo() const { return position_ > floor_; }
  [[nodiscard]] bool can_redo() const { return position_ + 1 < states_.size(); }

  /// Energy of the selected surfaces, or of the selected body, as they stand, normalised units; 0
  /// without a selection.
  [[nodiscard]] Expected<double> energy();
  /// max |S − S_opened| of one surface, file units; accuracy as `largest_distance`
  /// (spline/extremum.hpp).
  [[nodiscard]] double largest_displacement(int surface) const;
  /// Number of control points of one surface whose position or weight differs from the opened one,
  /// bit for bit; all of them if its knots differ.
  [[nodiscard]] int moved_control_points(int surface) const;
  /// The edges of faces on surfaces that moved which do not meet their faces any more, as `save`
  /// would write them. Cost: linear in the edges of the surfaces that have moved, each sampled
  /// (src/brep/edge_contacts.hpp).
  [[nodiscard]] Expected<std::vector<PartedEdge>> parted_edges() const;
  /// The document's file with the present surfaces. Errors (numerical): one of `parted_edges` that
  /// was not freed.
  [[nodiscard]] Expected<std::string> save() const;
  /// A new file of this format with the present surfaces, whole, as `Document::save_as`; lengths of
  /// a file without a unit count as millimetres where the format must have one.
  [[nodiscard]] Expected<std::string> save_as(const Format& format,
                                              const SaveOptions& how = {}) const;

  /// The whole session except the document's file, as bytes: every state of the history with every
  /// number as it is, and the commands. Data shared by states is written once. If the history needs
  /// more than `history_bytes`, the oldest states are omitted: their commands stay in the journal
  /// but cannot be undone.
  [[nodiscard]] std::string snapshot(std::size_t history_bytes = std::size_t{64} << 20U) const;
  /// The session of which `snapshot` was taken, bit for bit, with undo and redo; nothing is
  /// recomputed. Errors (input): bytes that are damaged, of another version, or of a document with
  /// other surfaces.
  [[nodiscard]] static Expected<Session> restore(Document document, std::string_view snapshot);

 private:
  struct ModelCache;

  Expected<void> carry_out(const Command& command, const Progress& progress);

  // A part of the history to go back to: what commands that are carried out one by one reach, with
  // what can be redone.
  struct Before {
    std::size_t first = 0, position = 0;  // its first state, and the present one
    std::vector<std::shared_ptr<const SessionState>> states;
    std::vector<std::vector<Command>> entries;
  };
  // `joined`: the first of the commands is joined with the entry before it. Cost: a pointer per
  // state.
  [[nodiscard]] Before before(std::span<const Command> commands, bool joined = false) const;
  // Nothing but these commands has been carried out since.
  void go_back(Before before);

  [[nodiscard]] const Document& document_of(const SessionState& state) const;
  /// Restores the visible regions of surfaces whose edges are held, which a snapshot leaves to the
  /// document.
  void know_faces();

  Document document_;             // as opened
  std::vector<Command> earlier_;  // of a partly restored history: in effect, and cannot be undone
  std::vector<std::shared_ptr<const SessionState>> states_;  // one more than entries_
  std::vector<std::vector<Command>> entries_;                // what undo reverts at once
  std::size_t position_ = 0;
  std::size_t floor_ = 0;  // undo ends here
  bool stops_at_faces_ = false;
  std::unique_ptr<ModelCache>
      cache_;  // the last model: its factorisation is reused until a setting changes
};

/// The faces of a session's document as they are now, as a new file of another format: what
/// `Session::save` writes, with the edges that follow where they have moved, read again. Lengths of
/// a file without a unit are those of `options`. Errors: those of `Session::save` and of
/// `save_faces` of that file.
[[nodiscard]] Expected<FacesFile> save_faces(const Session& session, const Format& format,
                                             const SaveOptions& options = {}, bool convert = false);

/// A file of a session's document.
struct WrittenFile {
  std::string bytes;
  std::vector<std::string> left_out;  ///< what of the document it does not hold, a sentence each
};

/// How `file_of` writes.
struct FileOptions {
  std::string_view schema = "ap214";  ///< of STEP: "ap214" or "ap242"
  /// Of triangles from faces, file units; 0: a two-thousandth of the model's diagonal.
  double tolerance = 0;
  int detail = 96;  ///< of triangles without faces: lines per direction of each surface
};

/// The document as a file of the format that the ending of a name says: its own, as
/// `Session::save`; a new file of surfaces or of faces; or triangles, of the faces as they would be
/// saved, or else of all surfaces, whole. Errors: those of what is called; an ending of no format
/// (input).
[[nodiscard]] Expected<WrittenFile> file_of(const Session& session, const std::string& name,
                                            const FileOptions& options = {});

}  // namespace knead
