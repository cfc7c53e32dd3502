#include "met_conditions.hpp"

#include <algorithm>

#include "constraints.hpp"
#include "joined_shapes.hpp"
#include "knead/spline/extremum.hpp"
#include "solve/constraint_space.hpp"

namespace knead {
namespace {

/// Whether a surface has the conditions that it had, and perhaps further pins.
/// Whether conditions that were asked for can be met is known once they are eliminated: a row that
/// reduces to 0 = value ≠ 0 contradicts those before. A gesture that adds one pin after the other
/// would eliminate all of them each time, O(n) eliminations of n rows; instead the elimination is
/// kept, and the new rows alone are reduced against it.
bool only_pins_added(const SurfaceInput& was, const SurfaceInput& is) {
  const auto same = [](const SurfaceInput& a, const SurfaceInput& b) {
    return a.id == b.id && a.reference == b.reference && a.rest == b.rest && a.mode == b.mode &&
           a.hold_rows == b.hold_rows && a.pins == b.pins &&
           a.smooth_knot_lines == b.smooth_knot_lines && a.smooth_poles == b.smooth_poles &&
           a.visible == b.visible && a.masked == b.masked;
  };
  if (!same(was, is) || is.constraints.size() < was.constraints.size()) return false;
  const auto [end, added] = std::ranges::mismatch(was.constraints, is.constraints);
  return end == was.constraints.end() &&
         std::all_of(added, is.constraints.end(), [](const KeptConstraint& kept) {
           return std::holds_alternative<PointPin>(kept.constraint);
         });
}

double size_of(const ModelInput& input) {
  double size = 0;
  for (const SurfaceInput& s : input.shapes)
    size = std::max(size, bounding_box(*s.reference).diagonal());
  return size > 0 ? size : 1;
}

bool has_normal(const LinearConstraint& condition) { return condition.normal.has_value(); }

}  // namespace

Expected<void> MetConditions::check(const ModelInput& input) {
  if (met_ && meets_more(input)) return {};
  met_.reset();
  auto joined = join_shapes(input);
  if (!joined) return std::unexpected(joined.error());
  if (!asks_for_motion(input)) return {};
  std::vector<LinearConstraint>& conditions = joined->settings.constraints;
  const double size = size_of(input);
  // In units of the model's size: the elimination judges values by a fixed threshold.
  for (LinearConstraint& c : conditions) c.value /= size;
  eliminated_ += static_cast<long long>(conditions.size());
  auto elimination =
      ConstraintSpace::eliminated(joined->rows.back(), conditions, joined->settings.held);
  if (!elimination) return std::unexpected(elimination.error());
  // Conditions along edges are chosen from the whole set (a QR decomposition with pivoting), so
  // that further pins change which of them are taken: nothing can be added to those.
  if (joined->entwined) return {};
  met_.emplace(input, joined->rows, size, std::ranges::any_of(conditions, has_normal),
               std::move(*elimination));
  return {};
}

/// Whether an input adds pins to what was met, and these are met too: nothing that they contradict
/// is known then.
bool MetConditions::meets_more(const ModelInput& input) {
  ModelInput& met = met_->input;
  if (!input.followed.empty() || !(input.seams == met.seams) ||
      !std::ranges::equal(met.shapes, input.shapes, only_pins_added)) {
    return false;
  }
  for (std::size_t k = 0; k < input.shapes.size(); ++k) {
    std::vector<KeptConstraint>& known = met.shapes[k].constraints;
    const auto added = std::span(input.shapes[k].constraints).subspan(known.size());
    if (!meets(k, added)) return false;
    known.insert(known.end(), added.begin(), added.end());
  }
  return true;
}

bool MetConditions::meets(std::size_t surface, std::span<const KeptConstraint> pins) {
  if (pins.empty()) return true;
  const SurfaceInput& of = met_->input.shapes[surface];
  SurfaceInput alone;
  alone.id = of.id;
  alone.reference = of.reference;
  alone.rest = of.rest;
  alone.mode = of.mode;
  alone.smooth_knot_lines = alone.smooth_poles = false;
  alone.constraints.assign(pins.begin(), pins.end());
  std::vector<std::string> notes;
  auto list = constraints_of(alone, notes);
  // Of a point that is a control point, that is held: whatever was eliminated may contain it.
  if (!list || std::ranges::find(list->held, true) != list->held.end()) return false;
  for (LinearConstraint& c : list->constraints) {
    // Conditions on single coordinates treble the unknowns; an elimination made for whole points
    // has no room for them.
    if (c.normal && !met_->along_normals) return false;
    for (auto& term : c.terms) term.first += met_->rows[surface];
    c.value /= met_->size;
    ++eliminated_;
    if (!met_->elimination.add(c)) return false;
  }
  return true;
}

}  // namespace knead
