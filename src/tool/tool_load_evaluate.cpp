#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <span>

#include "base/interruption.hpp"
#include "tool_load_sums.hpp"
#include "tool_load_sweep.hpp"

namespace knead {

namespace detail {

/// Where a tool is known not to act: around a place that it was asked about. Points of rational
/// splines are not leapt over, and where friction acts none are.
/// A signed distance cannot change faster than by one per length (it is 1-Lipschitz): a tool that
/// is `clear` away from a point does not act within that ball around it. Most points of a sweep are
/// told so without asking the tool.
struct ClearBall {
  Point centre = Point::Zero();
  double radius = -1;

  /// The action of the tool at x, which is not asked within the ball.
  [[nodiscard]] ToolAction action(const ModelTool& tool, const Point& x) {
    constexpr double safe = 1 - 1e-6;
    if (radius > 0) {
      const double left = safe * radius - (x - centre).norm();
      if (left > 0) {
        ToolAction none;
        none.clear = left;
        return none;
      }
    }
    ToolAction action = tool.action(x);
    centre = x;
    radius = action.active ? -1 : action.clear;
    return action;
  }
};

}  // namespace detail

namespace {

/// Potential, slope / displacement and curvature of friction that grips with force `grip` after
/// `slip`: quadratic up to `slip`, linear beyond.
struct Grip {
  double potential, slope, curvature;
};

// Coulomb's law, whose kink at 0 is replaced by the parabola with the same slope at `slip`.
Grip grip_at(double displacement, double grip, double slip) {
  if (displacement < slip)
    return {0.5 * grip / slip * displacement * displacement, grip / slip, grip / slip};
  return {grip * (displacement - 0.5 * slip), grip / displacement, 0};
}

/// A little more than where the tool acts, so that rounding leaves out nothing.
detail::ToolReach reach_of(const ModelTool& tool) {
  constexpr double slack = 1e-9;
  const double radius = tool.radius() + slack * (tool.radius() + tool.centre().norm());
  detail::ToolReach reach{{}, {}, {}, radius * radius};
  for (Eigen::Index c = 0; c < 3; ++c) {
    reach.lower[c] = tool.lower()[c];
    reach.upper[c] = tool.upper()[c];
    reach.centre[c] = tool.centre()[c];
  }
  return reach;
}

}  // namespace

/// One evaluation of the potential on a patch: which elements an actor may reach, and its effect at
/// their points.
template <int D>
class ToolLoad<D>::Evaluation {
 public:
  Evaluation(const ToolLoad& load, const Points& x, int first, int patch, const Actors& actors,
             PotentialState& state)
      : load_(load),
        x_(x),
        first_(first),
        patch_(patch),
        actors_(actors),
        state_(state),
        sweep_(load, x, first),
        forces_(load, first, state.force),
        clear_(actors.tools.size()) {
    for (std::size_t t = 0; t < actors.tools.size(); ++t) {
      if (load.takes_in_pass(actors.tools[t], actors.pass)) taken_.push_back(t);
    }
    find_sides();
    for (const ModelTool& tool : actors.tools) reaches_.push_back(reach_of(tool));
    if (actors.limit == nullptr) return;
    original_.emplace(load, actors.limit->original, 0);
    displacements_.resize(static_cast<Eigen::Index>(count_));
    for_each_used([&](std::size_t k) {
      const auto i = static_cast<Eigen::Index>(k);
      displacements_[i] = (x.row(first + i) - actors.limit->original.row(i)).norm();
    });
  }

  void run() {
    if (actors_.beyond != nullptr)
      return run_but(actors_.beyond->elements[static_cast<std::size_t>(patch_)]);
    if (actors_.watched == nullptr) return run_but({});
    const std::vector<int>& watched = actors_.watched->elements[static_cast<std::size_t>(patch_)];
    state_.contacts.reserve(state_.contacts.size() + 8 * watched.size());
    for (const int number : watched) visit(load_.element(number));
  }

 private:
  /// All elements but some, which are given in ascending order.
  void run_but(std::span<const int> left_out) {
    int number = 0;
    std::array<std::size_t, D> span;
    const auto direction = [&](auto self, std::size_t d, std::size_t row) -> void {
      const std::vector<int>& starts = load_.starts_[d];
      for (span[d] = 0; span[d] < starts.size(); ++span[d]) {
        const std::size_t first = row * static_cast<std::size_t>(load_.net_[d]) +
                                  static_cast<std::size_t>(starts[span[d]]);
        if (d + 1 < D) {
          self(self, d + 1, first);
          continue;
        }
        const int here = number++;
        if (!left_out.empty() && left_out.front() == here) {
          left_out = left_out.subspan(1);
        } else if (actors_.limit != nullptr || any_near(first)) {
          visit(load_.element(span));
        }
      }
    };
    direction(direction, 0, 0);
  }

  void visit(const Element& element) {
    if (Interruption::asked_for()) return;
    const int visible =
        actors_.pass == ToolPass::all ? VisibleMask::full : load_.visibility(element);
    if (visible == VisibleMask::hidden) return;
    find_near(element);
    const bool limited = actors_.limit != nullptr && may_exceed(element);
    if (near_.empty() && !limited) return;
    Point lower, upper;
    sweep_.enter(element, lower, upper);
    if (load_.in_hull_)
      std::erase_if(near_,
                    [&](std::size_t t) { return !actors_.tools[t].may_reach(lower, upper); });
    if (near_.empty() && !limited) return;
    double longest = 0;
    for (std::size_t d = 0; d < D; ++d)
      longest = std::max(longest, load_.lengths_[d][static_cast<std::size_t>(element.span[d])]);
    const std::ptrdiff_t gripped = anchors_of(element);
    Visitor visitor{*this, element, longest, gripped, limited, visible != VisibleMask::full};
    sweep_.run(visitor);
  }

  /// What happens at the points of one element.
  struct Visitor {
    Evaluation& here;
    const Element& element;
    double longest;          // of its spans
    std::ptrdiff_t gripped;  // where its points' anchors of friction begin; −1: none
    bool limited;            // a point may be further away than the limit allows
    bool cut;                // by the edges of the visible part
    bool everywhere = limited || gripped >= 0;  // friction and the limit act away from tools

    [[nodiscard]] bool skip(const Point& lower, const Point& upper) const {
      // What is seen of a cell may lie beside the row of its Gauss point.
      return !everywhere && !cut && here.beyond_all(lower, upper);
    }
    [[nodiscard]] unsigned reached(const double* places, std::ptrdiff_t count) const {
      return everywhere || cut ? ~0U : here.reached(places, count);
    }
    [[nodiscard]] double act(const Sample& whole) const {
      if (!cut) return at(whole);
      here.load_.for_what_is_seen(whole, here.x_, here.first_, [&](const Sample& s) { at(s); });
      return 0;  // the next point may stand elsewhere than its Gauss point
    }
    [[nodiscard]] double clear(const Sample& s) const {
      ++here.state_.visited;
      double clear = std::numeric_limits<double>::infinity();
      for (const std::size_t t : here.near_) {
        clear = std::min(clear, here.clear_[t].action(here.actors_.tools[t], s.place).clear);
      }
      return clear;
    }

   private:
    double at(const Sample& s) const {
      ++here.state_.visited;
      const double clear = here.press(s, longest);
      if (gripped >= 0) here.rub(s, gripped + index(element, s.at));
      if (limited) here.hold_back(s);
      return everywhere ? 0 : clear;
    }
  };

  /// Where the anchors of friction at an element's points begin; −1: it has none.
  [[nodiscard]] std::ptrdiff_t anchors_of(const Element& element) const {
    return actors_.friction == nullptr
               ? -1
               : actors_.friction->elements[static_cast<std::size_t>(load_.number(element))];
  }

  /// f(i) for every control point of the patch that is used.
  template <class F>
  void for_each_used(const F& f) const {
    if (actors_.watched == nullptr) {
      for (std::size_t i = 0; i < count_; ++i) f(i);
      return;
    }
    for (const int row : actors_.watched->rows) {
      if (row >= first_ && row < first_ + static_cast<int>(count_))
        f(static_cast<std::size_t>(row - first_));
    }
  }

  /// On which sides of every tool's box each control point lies; then, for the first control point
  /// of every element, on which sides all of the element's do.
  /// A byte per control point and tool has a bit for each side of the tool's box beyond which it
  /// lies. The conjunction over the (p + 1)^D control points of an element is not 0 exactly if all
  /// are beyond one common side: then, by the convex hull, nothing of the element is in the box.
  /// Conjunctions over windows of p + 1 are made by doubling, one direction after the other: log2(p
  /// + 1) passes over the net, which compilers make vectors of, instead of (p + 1)^D tests for each
  /// element.
  void find_sides() {
    count_ = static_cast<std::size_t>(load_.control_points());
    sides_.resize(count_ * actors_.tools.size());
    for (const std::size_t t : taken_) {
      const double* points = x_.data() + 3 * static_cast<std::ptrdiff_t>(first_);
      unsigned char* sides = sides_.data() + t * count_;
      for_each_used([&](std::size_t i) { sides[i] = actors_.tools[t].sides(points + 3 * i); });
      std::size_t stride = 1;
      for (std::size_t d = D; d-- > 0;) {
        const auto all = static_cast<std::size_t>(load_.quadrature_[d].basis.degree + 1);
        for (std::size_t finished = 1, more; finished < all; finished += more) {
          more = std::min(finished, all - finished);
          const unsigned char* further = sides + more * stride;
          for (std::size_t i = 0; i + more * stride < count_; ++i) sides[i] &= further[i];
        }
        stride *= static_cast<std::size_t>(load_.net_[d]);
      }
    }
  }

  /// Whether a tool may reach the element with this first control point, by the sides of all its
  /// control points.
  [[nodiscard]] bool is_near(std::size_t tool, std::size_t first) const {
    return !load_.in_hull_ || sides_[tool * count_ + first] == 0;
  }
  [[nodiscard]] bool any_near(std::size_t first) const {
    return std::ranges::any_of(taken_, [&](std::size_t t) { return is_near(t, first); });
  }
  void find_near(const Element& element) {
    near_.clear();
    std::size_t first = 0;
    for (std::size_t d = 0; d < D; ++d) {
      first = first * static_cast<std::size_t>(load_.net_[d]) +
              static_cast<std::size_t>(element.first[d]);
    }
    std::ranges::copy_if(taken_, std::back_inserter(near_),
                         [&](std::size_t t) { return is_near(t, first); });
  }

  /// Whether every tool that is near acts on nothing in a box.
  [[nodiscard]] bool beyond_all(const Point& lower, const Point& upper) const {
    return std::ranges::none_of(near_, [&](std::size_t t) {
      const ModelTool& tool = actors_.tools[t];
      return tool.jumps() ? tool.overlaps(lower, upper) : tool.may_reach(lower, upper);
    });
  }

  /// The places that a tool may act on.
  [[nodiscard]] unsigned reached(const double* places, std::ptrdiff_t count) const {
    unsigned result = 0;
    for (const std::size_t t : near_) result |= kernels_.reached(places, count, reaches_[t]);
    return result;
  }

  /// Whether a point of the element may be further away than the limit allows.
  [[nodiscard]] bool may_exceed(const Element& element) const {
    if (!load_.in_hull_) return true;
    bool result = false;
    load_.for_each_control_point(element, [&](int row) {
      result = result || displacements_[row] > actors_.limit->distance;
    });
    return result;
  }

  void push(const Sample& s, double potential, const Point& force, const Eigen::Matrix3d& hessian) {
    state_.potential += s.weight * potential;
    if (s.part < 0) {
      forces_.add(s.at, s.weight * s.inverse, force);
    } else {
      load_.for_each_function(s.at, s.part, [&](int row, double n) {
        double* to = state_.force.data() + 3 * static_cast<std::ptrdiff_t>(first_ + row);
        for (int c = 0; c < 3; ++c) to[c] += s.weight * s.inverse * n * force[c];
      });
    }
    state_.contacts.push_back(
        {patch_, s.at, s.weight * s.inverse * s.inverse, hessian, s.part, load_.grid_});
  }

  /// Tools. `longest` is the element's longest span. Returns how far around no tool acts.
  double press(const Sample& s, double longest) {
    double clear = std::numeric_limits<double>::infinity();
    for (std::size_t t : near_) {
      const ModelTool& tool = actors_.tools[t];
      const ToolAction action = clear_[t].action(tool, s.place);
      clear = std::min(clear, action.clear);
      if (!action.active) continue;
      push(s, action.potential, action.force, action.hessian);
      const double size = tool.size();
      state_.coarseness = std::max(state_.coarseness, longest / size);
      if (action.entry > state_.entry * size) {
        state_.entry = action.entry / size;
        state_.entered = static_cast<int>(t);
      }
    }
    return clear;
  }

  /// Friction at a point whose anchor stands at `index`.
  void rub(const Sample& s, std::ptrdiff_t index) {
    const int anchor = actors_.friction->index[static_cast<std::size_t>(index)];
    if (anchor < 0) return;
    const auto& a = actors_.friction->anchors[static_cast<std::size_t>(anchor)];
    const Eigen::Matrix3d tangential =
        Eigen::Matrix3d::Identity() - a.normal * a.normal.transpose();
    const Point displacement = tangential * (s.place - a.place);
    const double length = displacement.norm();
    const Grip grip = grip_at(length, a.grip, actors_.friction->slip);
    Eigen::Matrix3d hessian = grip.slope * tangential;
    if (length > 0) {
      hessian += (grip.curvature - grip.slope) / (length * length) * displacement *
                 displacement.transpose();
    }
    push(s, grip.potential, -grip.slope * displacement, hessian);
  }

  /// The limit.
  /// Ψ = k (|D| − d)²/2 beyond d, the gradient along n = D/|D|, and the Hessian k (n nᵀ + (1 −
  /// d/|D|)(I − n nᵀ)).
  void hold_back(const Sample& s) {
    Point original = Point::Zero();
    if (s.part < 0) {
      original = s.inverse * original_->at(s.at);
    } else {
      load_.for_each_function(s.at, s.part, [&](int row, double n) {
        original += s.inverse * n * actors_.limit->original.row(row).transpose();
      });
    }
    const Point displacement = s.place - original;
    const double length = displacement.norm(), beyond = length - actors_.limit->distance,
                 k = actors_.limit->stiffness;
    if (!(beyond > 0)) return;
    state_.limited = true;
    const Point n = displacement / length;
    Eigen::Matrix3d hessian = k * (1 - beyond / length) * n * n.transpose();
    hessian.diagonal().array() += k * beyond / length;
    push(s, 0.5 * k * beyond * beyond, -k * beyond * n, hessian);
  }

  const ToolLoad& load_;
  const Points& x_;
  int first_, patch_;
  const Actors& actors_;
  PotentialState& state_;
  Sweep sweep_;
  ForcesOfPoints forces_;
  std::vector<detail::ClearBall> clear_;  // by tool
  const detail::ElementKernels& kernels_ = detail::element_kernels();
  std::optional<FieldAtPoints> original_;  // that the limit is measured from
  std::size_t count_ = 0;                  // of control points
  std::vector<unsigned char> sides_;       // by first control point of an element, tool after tool
  Eigen::VectorXd
      displacements_;  // of the control points: their hull bounds the displacement of every point
  std::vector<std::size_t> taken_,
      near_;  // the tools of this grid and pass, and those near an element
  std::vector<detail::ToolReach> reaches_;  // of the tools
};

template <int D>
void ToolLoad<D>::evaluate(const Points& x, int first, int patch, const Actors& actors,
                           PotentialState& state) const {
  const bool none = std::ranges::none_of(
      actors.tools, [&](const auto& t) { return takes_in_pass(t, actors.pass); });
  if (none && actors.friction == nullptr && actors.limit == nullptr) return;
  Evaluation(*this, x, first, patch, actors, state).run();
}

template void ToolLoad<1>::evaluate(const Points&, int, int, const Actors&, PotentialState&) const;
template void ToolLoad<2>::evaluate(const Points&, int, int, const Actors&, PotentialState&) const;
template void ToolLoad<3>::evaluate(const Points&, int, int, const Actors&, PotentialState&) const;

}  // namespace knead
