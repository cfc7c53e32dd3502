#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "knead/contact/active_spline.hpp"
#include "tool/tool_load.hpp"

namespace knead {

/// Tools, friction and limit on all patches of a model, in normalised units.
///
/// Ψ(x) = Σ over tools, friction, limit and point forces; sums over Gauss points come from the tool
/// grids of each patch (`ToolLoad`). A state lists the points in contact with their 3 × 3 Hessians;
/// H v, blocks of H and the control points concerned are made from that list, so that none of them
/// looks for contacts again.
template <int D>
class PatchPotential final : public Potential {
 public:
  PatchPotential(std::span<const ToolGrids<D>> loads, std::span<const int> rows,
                 std::vector<ModelTool> tools)
      : loads_(loads), rows_(rows), tools_(std::move(tools)) {
    for (const ModelTool& tool : tools_) given_.push_back(tool.stiffness());
  }

  /// Friction from the contacts at x; it is fully developed after moving by `slip`.
  void grip(const Points& x, double slip) {
    if (std::ranges::none_of(tools_, [](const ModelTool& t) {
          return t.tool().friction > 0 && t.tool().collides();
        }))
      return;
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      friction_.emplace_back();
      for (const ToolLoad<D>& grid : loads_[k]) {
        friction_[k].push_back({grid.anchors(x, rows_[k], tools_, slip),
                                grid.hides()
                                    ? grid.anchors(x, rows_[k], tools_, slip, ToolPass::visible)
                                    : FrictionAnchors{}});
      }
    }
  }
  /// No point may be further than `distance` from its position in `original`.
  void limit(const Points& original, double distance, double stiffness) {
    limits_.clear();
    limit_stiffness_ = stiffness;
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      limits_.push_back(
          {distance, stiffness, original.middleRows(rows_[k], rows_[k + 1] - rows_[k])});
    }
  }
  /// A force on one point.
  void add(PointForce force) { points_.push_back(std::move(force)); }
  void set_stiffness(std::size_t tool, double stiffness) {
    tools_[tool].set_stiffness(stiffness);
    given_[tool] = stiffness;
  }
  /// Collision with tool k starts this much further out.
  void set_offset(std::size_t k, double offset) { tools_[k].set_offset(offset); }
  [[nodiscard]] double offset(std::size_t k) const { return tools_[k].offset(); }
  /// The deepest penetration of tool k itself, also between Gauss points.
  [[nodiscard]] double deepest_entry(std::size_t k, const Points& x) const {
    double deepest = 0;
    for (std::size_t l = 0; l < loads_.size(); ++l) {
      const auto grid =
          std::ranges::find_if(loads_[l], [&](const auto& g) { return g.takes(tools_[k]); });
      deepest = std::max(deepest, grid->deepest_entry(x, rows_[l], tools_[k]).depth);
    }
    return deepest;
  }
  [[nodiscard]] std::size_t tool_count() const { return tools_.size(); }
  [[nodiscard]] double size(std::size_t k) const { return tools_[k].size(); }
  [[nodiscard]] const Tool& tool(std::size_t k) const { return tools_[k].tool(); }
  [[nodiscard]] double stiffness(std::size_t k) const { return given_[k]; }

  [[nodiscard]] PotentialState evaluate(const Points& x,
                                        const WatchedElements* watched = nullptr) const override {
    PotentialState state = on_elements(x, watched, nullptr);
    for (std::size_t k = 0; k < points_.size(); ++k) add_point(k, x, state);
    return state;
  }

  [[nodiscard]] bool acts_beyond(const WatchedElements& these, const Points& x) const override {
    return !on_elements(x, nullptr, &these).contacts.empty();
  }

  void apply_hessian(const PotentialState& state, const Points& v, Points& out) const override {
    for_each_grid(
        state,
        [&](const ToolLoad<D>& grid, int first, auto contacts) {
          grid.apply_hessian(contacts, first, v, out);
        },
        [&](const ContactPoint& c) {
          const PointForce& force = points_[static_cast<std::size_t>(c.at[0])];
          const Point h = c.hessian * combined(force, v);
          for (const auto& [row, r] : force.terms) out.row(row) += r * h.transpose();
        });
  }

  void each_hessian_block(const PotentialState& state, const AddBlock& add) const override {
    for_each_grid(
        state,
        [&](const ToolLoad<D>& grid, int first, auto contacts) {
          grid.each_hessian_block(contacts, first, add);
        },
        [&](const ContactPoint& c) { add_point_block(c, add); });
  }

  void mark(const PotentialState& state, std::vector<char>& marks) const override {
    for_each_grid(
        state,
        [&](const ToolLoad<D>& grid, int first, auto contacts) {
          grid.mark(contacts, first, marks);
        },
        [&](const ContactPoint& c) {
          for (const auto& [row, r] : points_[static_cast<std::size_t>(c.at[0])].terms)
            marks[static_cast<std::size_t>(row)] = 1;
        });
  }

  void widen(std::vector<char>& marks) const override {
    for (std::size_t k = 0; k < loads_.size(); ++k) loads_[k].coarsest().widen(rows_[k], marks);
  }

  [[nodiscard]] WatchedElements watch(const std::vector<char>& marks) const override {
    WatchedElements watched;
    for (std::size_t i = 0; i < marks.size(); ++i) {
      if (marks[i]) watched.rows.push_back(static_cast<int>(i));
    }
    for (std::size_t k = 0; k < loads_.size(); ++k)
      watched.elements.push_back(loads_[k].coarsest().elements_of(rows_[k], marks));
    return watched;
  }

  void soften(double cap) override {
    for (std::size_t t = 0; t < tools_.size(); ++t)
      tools_[t].set_stiffness(std::min(given_[t], cap));
    for (DisplacementLimit& limit : limits_) limit.stiffness = std::min(limit_stiffness_, cap);
  }

  [[nodiscard]] double stiffest() const override {
    double result = limits() ? limit_stiffness_ : 0;
    for (double stiffness : given_) result = std::max(result, stiffness);
    return result;
  }

  [[nodiscard]] bool limits() const override { return !limits_.empty(); }

 private:
  /// What acts on elements: on all, on those that are watched, or on all others.
  ///
  /// The limit is integrated on the coarsest grid of a patch only, which resolves the net; finer
  /// grids exist for small tools.
  [[nodiscard]] PotentialState on_elements(const Points& x, const WatchedElements* watched,
                                           const WatchedElements* beyond) const {
    PotentialState state;
    state.force = Points::Zero(x.rows(), 3);
    for (std::size_t k = 0; k < loads_.size(); ++k) {
      for (std::size_t g = 0; g < loads_[k].size(); ++g) {
        const ToolLoad<D>& grid = loads_[k][g];
        const auto pass = [&](ToolPass which, const DisplacementLimit* limit) {
          const FrictionAnchors* friction =
              friction_.empty() ? nullptr : &friction_[k][g][which == ToolPass::all ? 0U : 1U];
          if (friction && friction->anchors.empty()) friction = nullptr;
          grid.evaluate(x, rows_[k], static_cast<int>(k),
                        {tools_, friction, limit, which, watched, beyond}, state);
        };
        pass(ToolPass::all, limits() && &grid == &loads_[k].coarsest() ? &limits_[k] : nullptr);
        if (grid.hides()) pass(ToolPass::visible, nullptr);
      }
    }
    return state;
  }

  /// on_grid(grid, its patch's first row, contacts) for contacts of one grid that follow one
  /// another, on_point(contact) for each of a force on one point.
  template <class F, class G>
  void for_each_grid(const PotentialState& state, const F& on_grid, const G& on_point) const {
    const std::span<const ContactPoint> all(state.contacts);
    for (std::size_t k = 0; k < all.size();) {
      std::size_t end = k + 1;
      while (end < all.size() && all[end].patch == all[k].patch && all[end].grid == all[k].grid)
        ++end;
      if (all[k].patch >= 0) {
        const auto patch = static_cast<std::size_t>(all[k].patch);
        on_grid(loads_[patch][static_cast<std::size_t>(all[k].grid)], rows_[patch],
                all.subspan(k, end - k));
      } else {
        for (std::size_t i = k; i < end; ++i) on_point(all[i]);
      }
      k = end;
    }
  }

  [[nodiscard]] static Point combined(const PointForce& force, const Points& x) {
    Point sum = Point::Zero();
    for (const auto& [row, r] : force.terms) sum += r * x.row(row).transpose();
    return sum;
  }

  // The point is Σ r_i x_i, so that its Hessian h makes the blocks r_i r_j h between its control
  // points.
  void add_point_block(const ContactPoint& contact, const AddBlock& add) const {
    const auto& terms = points_[static_cast<std::size_t>(contact.at[0])].terms;
    std::vector<int> rows;
    Eigen::VectorXd shares(static_cast<Eigen::Index>(terms.size()));
    for (const auto& [row, r] : terms) {
      shares[static_cast<Eigen::Index>(rows.size())] = r;
      rows.push_back(row);
    }
    Eigen::MatrixXd block(3 * shares.size(), 3 * shares.size());
    for (Eigen::Index i = 0; i < shares.size(); ++i) {
      for (Eigen::Index j = 0; j < shares.size(); ++j) {
        block.block<3, 3>(3 * i, 3 * j) = shares[i] * shares[j] * contact.hessian;
      }
    }
    add(rows, block);
  }

  // Springs (thesis Eq. 4.24): ψ = k/2 |d|², d = Σ r x − to. Volcanoes: ψ = k/ρ, ρ² = |d|² + core²;
  // the force k d/ρ³ drives away, and the Hessian 3k d dᵀ/ρ⁵ − k/ρ³ I is indefinite: negative
  // across d.
  void add_point(std::size_t k, const Points& x, PotentialState& state) const {
    const PointForce& p = points_[k];
    const Point way = combined(p, x) - p.to;
    Point force;
    Eigen::Matrix3d hessian;
    if (p.kind == PointForce::Kind::spring) {
      state.potential += 0.5 * p.strength * way.squaredNorm();
      force = -p.strength * way;
      hessian = p.strength * Eigen::Matrix3d::Identity();
    } else {
      const double r2 = way.squaredNorm() + p.core * p.core, r = std::sqrt(r2),
                   k3 = p.strength / (r2 * r);
      state.potential += p.strength / r;
      force = k3 * way;
      hessian = 3 * k3 / r2 * way * way.transpose();
      hessian.diagonal().array() -= k3;
    }
    for (const auto& [row, r] : p.terms) state.force.row(row) += r * force.transpose();
    state.contacts.push_back({-1, {static_cast<int>(k), 0, 0}, 1, hessian});
  }

  std::vector<PointForce> points_;
  std::span<const ToolGrids<D>> loads_;  // of the patches
  std::span<const int> rows_;
  std::vector<ModelTool> tools_;
  std::vector<double> given_;  // their stiffness, not softened
  std::vector<std::vector<std::array<FrictionAnchors, 2>>>
      friction_;  // of either pass, by patch and grid
  std::vector<DisplacementLimit> limits_;
  double limit_stiffness_ = 0;  // not softened
};

}  // namespace knead
