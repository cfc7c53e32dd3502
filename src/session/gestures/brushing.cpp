#include "brushing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "brush_path.hpp"
#include "knead/base/error_code.hpp"
#include "knead/spline/evaluate.hpp"
#include "knead/spline/extremum.hpp"
#include "scene/places.hpp"
#include "session/acts/following.hpp"
#include "session/acts/notes.hpp"
#include "session/acts/selection.hpp"
#include "session/acts/stepping.hpp"
#include "session/acts/trimming.hpp"
#include "stroke_model.hpp"

namespace knead {
namespace {

// A brush along a path, in four parts. Each place adds to a history at Chebyshev abscissae what the
// brush asks for there (`BrushHistory`); the history is interpolated by a spline on the present net
// (`local_coefficients`); masks and the reach lessen it; and it is projected onto what constraints
// allow (`brushed`). Histories depend on the path and not on the number of its places, and one that
// is led on needs its new places only.
constexpr double places_per_radius = 16;
// Of the largest displacement: what misses the constraints by less is allowed.
constexpr double feasible_share = 1e-9;
// Corrections outside of the brush that are less are left out.
constexpr double dropped_share = 1e-3;
// By conditions: of what is left out, so much of a correction undoes that.
constexpr double amplified = 100;
// Of its way that a point goes by itself if it is to be brought to the goal.
constexpr double least_share = 0.5;
constexpr double limit_share = 1e-6;  // by which a limit may be exceeded, as for steps

BrushPath path_of(const OpenBrush& open, const Scene& scene) {
  return {scene.selection(), open.before, open.brush.radius / places_per_radius, open.rope};
}

/// The brush without what a hand changes as it goes.
Brush without_hand(Brush brush) {
  brush.by = Point::Zero();
  brush.angle = 0;
  brush.factor = 1;
  return brush;
}

/// Whether what was remembered for one stroke serves another, which went on with it.
bool goes_on(const OpenBrush& from, const OpenBrush& to) {
  const auto same = [](const OpenStroke::Before& a, const OpenStroke::Before& b) {
    return a.rest == b.rest && a.current == b.current;
  };
  return without_hand(from.brush) == without_hand(to.brush) && from.images == to.images &&
         from.rope == to.rope && from.path.size() <= to.path.size() &&
         std::equal(from.path.begin(), from.path.end(), to.path.begin()) &&
         std::ranges::equal(from.before, to.before, same);
}

/// Coefficients of what is zero at an abscissa are zero: what lies outside of a brush keeps its
/// bits. Of high degree that is so only of small ones.
/// Interpolation at n abscissae is global: coefficients away from the brush decay but do not
/// vanish, and would change control points everywhere by rounding or little more. Those at whose
/// abscissa nothing is asked are set to zero if they are less than a thousandth of the largest
/// displacement.
Points local_coefficients(const StrokeModel& model, const Points& values) {
  Points result = model.control_points(values);
  const auto untouched = [&](Eigen::Index i) { return (values.row(i).array() == 0).all(); };
  const double largest = std::sqrt(values.rowwise().squaredNorm().maxCoeff());
  double dropped = 0;
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    if (untouched(i)) dropped = std::max(dropped, result.row(i).norm());
  }
  // Control points of high degree alternate by far more than what they show, and not only where a
  // site is reached.
  const double most = dropped > largest ? dropped_share * largest : dropped;
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    if (untouched(i) && result.row(i).norm() <= most) result.row(i).setZero();
  }
  return result;
}

/// Whether the first place has its image so far away that the brush does not overlap with it.
bool stands_alone(const BrushPlace& place, const OpenBrush& open) {
  return std::ranges::all_of(open.images, [&](const BrushImage& image) {
    return (image.of(place).at - place.at).norm() >= 2 * open.brush.radius;
  });
}

}  // namespace

bool BrushRun::reaches() const { return std::ranges::any_of(histories, &BrushHistory::reaches); }

Expected<void> BrushStroke::begin(const Begin& begin) {
  OpenBrush open{begin.brush, begin.images, begin.rope, {}, {}, {}};
  for (const SceneSurface& s : selected_surfaces(act_.state)) {
    open.before.push_back({s.rest, s.current});
    open.masks.push_back(s.mask);
  }
  act_.state.brush = std::move(open);
  return {};
}

namespace {

/// What the brush has asked for along the path, as far as it is not known.
Expected<void> start_brush_run(Act& act) {
  const OpenBrush& open = *act.state.brush;
  const ModelInput& input = act.cache.stroke->scene.input;
  if (act.cache.brush && act.cache.brush->input == input && goes_on(act.cache.brush->open, open))
    return {};
  BrushRun run{input, open, {}, {}, {}, {}, {}, false};
  run.open.path = {};
  std::vector<Seam> seams;
  for (const SeamReport& report : act.cache.stroke->scene.seams) seams.push_back(report.seam);
  const std::vector<int> selection = act.state.selection();
  const auto begin = std::ranges::find(selection, open.path.front().surface) - selection.begin();
  run.sides = seam_sides(seams, static_cast<int>(selection.size()), static_cast<int>(begin));
  Eigen::Index rows = 0;
  for (std::size_t k = 0; k < open.before.size(); ++k) {
    const Surface& shape = *open.before[k].current;
    if (auto status = run.samples.append(shape, act.cache.stroke->values[k], run.sides[k]); !status)
      return status;
    rows += shape.size();
  }
  if (open.brush.kind == BrushKind::smooth) {
    Points shape(rows, 3);
    rows = 0;
    for (const OpenStroke::Before& b : open.before) {
      shape.middleRows(rows, b.current->size()) = b.current->control_points();
      rows += b.current->size();
    }
    run.fair = act.cache.stroke->at_abscissae(act.cache.stroke->scene.model.fairing(shape));
    // Along the surface nothing would change but its parameters.
    const Points& n = run.samples.normals;
    for (Eigen::Index g = 0; g < rows; ++g)
      run.fair.row(g) = run.fair.row(g).dot(n.row(g)) * n.row(g);
  }
  run.histories.assign(open.images.size() + 1, BrushHistory(rows));
  act.cache.brush = std::move(run);
  return {};
}

/// Leads the brush to the end of its path, from where it is known.
Expected<void> lead_brush(Act& act) {
  const OpenBrush& open = *act.state.brush;
  BrushRun& run = *act.cache.brush;
  const BrushPath way = path_of(open, act.state);
  const std::vector<int> selection = act.state.selection();
  for (std::size_t k = run.open.path.size(); k < open.path.size(); ++k) {
    if (k == 0) run.at = open.path[0];
    auto next = k == 0 ? std::vector<BrushPoint>{run.at}
                       : way.places(open.path[k - 1], open.path[k], run.at);
    if (!next) return std::unexpected(next.error());
    for (const BrushPoint& at : *next) {
      auto place = way.place(at);
      if (!place) return std::unexpected(place.error());
      place->normal *= run.sides[static_cast<std::size_t>(std::ranges::find(selection, at.surface) -
                                                          selection.begin())];
      place->across = place->normal.cross(place->along);
      run.histories[0].go_to(open.brush, run.samples, *place, run.fair);
      for (std::size_t i = 0; i < open.images.size(); ++i) {
        run.histories[i + 1].go_to(open.images[i].of(open.brush), run.samples,
                                   open.images[i].of(*place), run.fair);
      }
      run.at = at;
    }
    run.open.path.push_back(open.path[k]);
  }
  if (run.reaches()) return {};
  return input_error(
      "the brush reaches no control point: the spans of the net are longer than its radius",
      "radius",
      R"(use a larger one, or let the net be refined: {"do":"refine","permission":"auto"})",
      {ErrorCode::brush_too_small});
}

/// How far the point that is grabbed would go with this displacement of the control points, of the
/// way that it should. 0 where it has an image that the brush overlaps with.
Expected<double> share_of_grab(const Act& act, const Points& displacement) {
  const OpenBrush& open = *act.state.brush;
  const auto place = path_of(open, act.state).place(open.path.front());
  if (!place) return std::unexpected(place.error());
  if (!stands_alone(*place, open)) return 0;
  const std::vector<int> selection = act.state.selection();
  const BrushPoint& at = open.path.front();
  const auto k =
      static_cast<std::size_t>(std::ranges::find(selection, at.surface) - selection.begin());
  const Surface& shape = *open.before[k].current;
  const Eigen::Index first = act.cache.stroke->scene.model.rows()[k];
  const auto field = shape.with_control_points(displacement.middleRows(first, shape.size()));
  if (!field) return std::unexpected(field.error());
  const auto u = parameters_at(*field, at.at, "path");
  if (!u) return std::unexpected(u.error());
  const auto moved = evaluate_point<2>(*field, *u);
  if (!moved) return std::unexpected(moved.error());
  return moved->dot(open.brush.by) / open.brush.by.squaredNorm();
}

/// The displacement of the control points that the open brush asks for and the constraints allow.
Expected<Points> brushed(Act& act) {
  const OpenBrush& open = *act.state.brush;
  BrushRun& run = *act.cache.brush;
  std::vector<Points> copies;
  for (std::size_t i = 0; i < run.histories.size(); ++i) {
    const Brush brush = i == 0 ? open.brush : open.images[i - 1].of(open.brush);
    copies.push_back(run.histories[i].displacement(brush, run.samples));
  }
  Points asked = blended(copies);
  const bool grabs = open.brush.kind == BrushKind::grab;
  const double most = std::max(std::sqrt(asked.rowwise().squaredNorm().maxCoeff()),
                               grabs ? open.brush.by.norm() : 0);
  act.law.ask_of_brush(open, most);
  const ActiveSurface& model = act.cache.stroke->scene.model;
  Points c = local_coefficients(*act.cache.stroke, asked);
  if (grabs && open.brush.by.squaredNorm() > 0) {
    // The point that is grabbed goes where it was asked to, whatever interpolation makes of the
    // falloff
    const auto share = share_of_grab(act, c);
    if (!share) return std::unexpected(share.error());
    // The interpolant of a steep falloff passes below its peak; asking for more makes the grabbed
    // point arrive. Below one half the net is too coarse for the brush, and scaling would blow up
    // what is beside.
    if (*share > least_share) asked /= *share;
  }
  const bool some = (asked.array() != 0).any();
  asked = unmasked(act.state, std::move(asked));
  c = local_coefficients(*act.cache.stroke, asked);
  // Between the sites the spline goes further where what is asked has steep sides
  const double reach = (1 + 0.5 * law_tolerance) * most;
  for (Eigen::Index first = 0; const OpenStroke::Before& before : open.before) {
    const Eigen::Index n = before.current->size();
    c.middleRows(first, n) = within_reach(*before.current, c.middleRows(first, n), reach);
    first += n;
  }
  const double largest = c.rowwise().norm().maxCoeff();
  run.stuck = some && largest == 0;
  Points allowed = model.allowed(c);
  if ((allowed - c).cwiseAbs().maxCoeff() <= feasible_share * largest) return allowed;
  // Corrections far from the brush that are small are dropped, and the rest is checked against the
  // conditions again; if dropping them would cost more than `amplified` times their size, all are
  // kept.
  Points nearest = model.nearest_allowed(c), whole = nearest;
  for (Eigen::Index i = 0; i < nearest.rows(); ++i) {
    if ((c.row(i).array() == 0).all() && nearest.row(i).norm() < dropped_share * largest)
      nearest.row(i).setZero();
  }
  allowed = model.allowed(nearest);
  if (!((allowed - nearest).cwiseAbs().maxCoeff() <= amplified * dropped_share * largest)) {
    allowed = std::move(
        whole);  // dependent control points follow from what was left out with large coefficients
  }
  run.stuck = (allowed.array() == 0).all();
  return allowed;
}

/// The masks from before the stroke with what was painted.
Expected<void> show_mask(Act& act) {
  const OpenBrush& open = *act.state.brush;
  Eigen::VectorXd weight = act.cache.brush->histories.front().weights(open.brush);
  for (const BrushHistory& image : act.cache.brush->histories)
    weight = weight.cwiseMax(image.weights(open.brush));
  const std::vector<int> selection = act.state.selection();
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    if (s.mask.empty()) s.mask.assign(static_cast<std::size_t>(s.current->size()), 0);
    for (double& m : s.mask) {
      const double w = weight[first++];
      m = open.brush.kind == BrushKind::mask ? std::max(m, w) : std::min(m, 1 - w);
    }
    if (std::ranges::all_of(s.mask, [](double m) { return m == 0; })) s.mask.clear();
  }
  return {};
}

/// Rows of zero keep their bits.
Expected<void> displace_from_brush(Act& act, const Points& displacement) {
  const std::vector<int> selection = act.state.selection();
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < selection.size(); ++k) {
    SceneSurface& s = act.state.surfaces[static_cast<std::size_t>(selection[k])];
    const OpenStroke::Before& before = act.state.brush->before[k];
    const Points d = displacement.middleRows(first, before.current->size());
    first += d.rows();
    if ((d.array() == 0).all()) continue;
    const auto with = [&d](const Surface& shape) -> Expected<std::shared_ptr<const Surface>> {
      Points points = shape.control_points();
      for (Eigen::Index i = 0; i < d.rows(); ++i) {
        if ((d.row(i).array() != 0).any()) points.row(i) += d.row(i);
      }
      auto made = shape.with_control_points(std::move(points));
      if (!made) return std::unexpected(made.error().within("brush"));
      return std::make_shared<const Surface>(std::move(*made));
    };
    auto current = with(*before.current);
    if (!current) return std::unexpected(current.error());
    auto rest = before.rest == before.current ? current : with(*before.rest);
    if (!rest) return std::unexpected(rest.error());
    s.current = std::move(*current);
    s.rest = std::move(*rest);
    s.velocity.resize(0, 3);
    if (!act.state.limit) continue;
    const double was = largest_distance(*before.current, *s.opened),
                 is = largest_distance(*s.current, *s.opened);
    if (is > *act.state.limit * (1 + limit_share) && is > was) {
      return input_error(
          fmt::format(
              "the surface would be {:.6g} from where it was opened, and {:.6g} is the limit", is,
              *act.state.limit),
          "brush", R"(move it less, or end the limit: {"do":"limit"})",
          {ErrorCode::beyond_limit, {{"distance", is}, {"limit", *act.state.limit}}});
    }
  }
  return {};
}

/// Makes the shapes and rest shapes those from before the stroke with this displacement, or with
/// what share of it folds no face. What is grabbed goes where it was asked to, or nowhere.
Expected<void> show_brush(Act& act, const Points& displacement) {
  if (auto shown = displace_from_brush(act, displacement); !shown) return shown;
  if (act.state.brush->brush.kind == BrushKind::grab) {
    if (auto sound = check_folds(act.state); !sound) return sound;
  } else {
    const auto smaller = keep_unfolded(act.state, "brush", 1, [&](double share) {
      return displace_from_brush(act, share * displacement);
    });
    if (!smaller) return std::unexpected(smaller.error());
    if (!smaller->empty()) note_once(act.state, *smaller);
  }
  note_model(act, act.cache.stroke->scene.seams, act.cache.stroke->scene.notes);
  return {};
}

}  // namespace

Expected<void> BrushStroke::lead(const std::vector<BrushPoint>& path) {
  OpenBrush& open = *act_.state.brush;
  const std::vector<int> selection = act_.state.selection();
  for (std::size_t k = 0; k < selection.size();
       ++k) {  // places and nets are those of the shapes from before
    SceneSurface& s = act_.state.surfaces[static_cast<std::size_t>(selection[k])];
    s.rest = open.before[k].rest;
    s.current = open.before[k].current;
    s.mask = open.masks[k];
  }
  const std::size_t known = open.path.size();
  for (const BrushPoint& at : path) open.path.push_back(at);
  std::vector<BrushPoint> places;
  const BrushPath way = path_of(open, act_.state);
  for (std::size_t k = known; k < open.path.size(); ++k) {
    const auto more = k == 0 ? std::vector<BrushPoint>{open.path[0]}
                             : way.places(open.path[k - 1], open.path[k], open.path[k - 1]);
    if (!more) return std::unexpected(more.error());
    places.insert(places.end(), more->begin(), more->end());
  }
  if (auto refined = refine_for_brush(act_, places); !refined) return refined;
  const bool paints = open.brush.kind == BrushKind::mask || open.brush.kind == BrushKind::unmask;
  Attempts tried(act_.state);
  while (true) {
    if (auto made = prepare_brush_model(act_); !made) return made;
    if (auto started = start_brush_run(act_); !started) return started;
    if (auto led = lead_brush(act_); !led) return led;
    if (paints) return show_mask(act_);
    const auto displacement = brushed(act_);
    if (!displacement) return std::unexpected(displacement.error());
    const Scene before = act_.state;
    if (auto shown = show_brush(act_, *displacement); !shown) return shown;
    const auto closed = tried.together(act_.state);
    if (!closed) return std::unexpected(closed.error());
    if (*closed) return {};
    act_.state.surfaces = before.surfaces;
  }
}

Expected<void> BrushStroke::lift() {
  act_.state.brush.reset();
  return {};
}

}  // namespace knead
