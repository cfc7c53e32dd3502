#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "knead/session/command.hpp"
#include "knead/session/document.hpp"

namespace knead {

/// What one step did.
struct StepRecord {
  int surface = 0;                  ///< index into the document's surfaces
  double time = 0;                  ///< seconds
  double energy = 0;                ///< after the step, normalised units
  double residual = 0;              ///< relative imbalance of forces, see ActiveStep
  double largest_displacement = 0;  ///< from the surface as opened, file units
  int iterations = 0;
  bool converged = true;
};

/// What a session knows about one surface.
struct SurfaceState {
  std::shared_ptr<const Surface> current;
  std::shared_ptr<const Surface> rest;  ///< what displacements are measured from
  RestMode mode = RestMode::shape;
  Material material;
  int hold_rows = 0;
  std::set<std::array<int, 2>> pins;
};

/// The whole state at one moment. A value: undo puts an earlier one back, bit for bit.
struct SessionState {
  std::optional<int> selected;
  std::vector<SurfaceState> surfaces;
  std::vector<Tool> tools;  ///< lengths in file units
  std::vector<StepRecord> steps;
  std::optional<double> energy_before;  ///< energy before the first step
};

/// A document and its history of commands: the model and controller of every user interface.
///
/// Every command either takes effect whole or returns an `Error` and changes nothing. Undo and redo restore states bit
/// for bit. Not thread-safe.
class Session {
 public:
  explicit Session(Document document);

  /// Called after each step of a `StepCommand` with the number done and the number asked for.
  using Progress = std::function<void(int, int)>;

  [[nodiscard]] Expected<void> execute(const Command& command, const Progress& progress = {});

  [[nodiscard]] const Document& document() const { return document_; }
  [[nodiscard]] const SessionState& state() const { return *states_[position_]; }
  /// The commands whose effect stands, in order: with the document, all of the session.
  [[nodiscard]] std::vector<Command> journal() const;
  [[nodiscard]] bool can_undo() const { return position_ > 0; }
  [[nodiscard]] bool can_redo() const { return position_ + 1 < states_.size(); }

  /// Energy of the selected surface as it stands, normalised units; 0 without a selection.
  [[nodiscard]] Expected<double> energy();
  /// max |S − S_opened| of one surface, file units.
  [[nodiscard]] double largest_displacement(int surface) const;
  /// Control points of one surface that are no longer where they were opened, bit for bit.
  [[nodiscard]] int moved_control_points(int surface) const;
  /// The document's file with the present control points.
  [[nodiscard]] Expected<std::string> save() const;

 private:
  struct Executor;

  struct CachedModel {
    std::shared_ptr<const Surface> rest;
    ActiveSurface model;
  };

  [[nodiscard]] Expected<ActiveSurface> model_of(const SurfaceState& surface, const std::vector<Tool>& tools,
                                                 double lambda, StepWeight weight);
  [[nodiscard]] double displacement_of(int surface, const Surface& current) const;

  Document document_;
  std::vector<std::shared_ptr<const SessionState>> states_;  // one more than commands_
  std::vector<Command> commands_;
  std::size_t position_ = 0;
  std::optional<CachedModel> cache_;  // the last model: its factorisation serves until a setting changes
};

}  // namespace knead
