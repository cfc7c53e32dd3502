#pragma once

#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "brep/visible_mask.hpp"
#include "knead/energy/domain_scaling.hpp"
#include "knead/gramian/band_matrix.hpp"
#include "knead/spline/basis.hpp"
#include "knead/tool/tool.hpp"
#include "potential.hpp"

namespace knead {

/// The tools of one evaluation of a `ToolLoad`.
enum class ToolPass {
  all,      ///< those that touch all of the patch
  visible,  ///< those that touch its visible part only
};

/// The deepest penetration of a tool, 0 if there is none, and the number of samples among which it
/// was sought.
struct Penetration {
  double depth = 0;
  long long visited = 0;
};

/// Into how many pieces of `per_piece` Gauss points a span is cut so that these lie closer than a
/// sixth of the detail.
[[nodiscard]] double pieces_of_span(double length, int per_piece, double detail);

/// How far along a row of control points the parameters of a table are, Σ r N_r(u) with r counted
/// within a span: between two parameters of one span the shape moves by no more than the difference
/// times the longest step from control point to control point of the row, since the sums N_r + … +
/// N_p grow with u.
[[nodiscard]] std::vector<double> progress_along(const BasisTable& basis);

/// Dry friction, lagged: the normal forces and positions of all points in contact at the start of a
/// step. What it keeps per Gauss point it keeps for elements in contact only.
struct FrictionAnchors {
  struct Anchor {
    double grip = 0;  ///< Coulomb's coefficient times the normal force per parameter measure
    Point normal = Point::Zero(), place = Point::Zero();
  };
  std::vector<std::ptrdiff_t>
      elements;  ///< by number: where its points begin in `index`, or −1: none is in contact
  std::vector<int> index;  ///< per Gauss point of these elements: an anchor, or −1
  std::vector<Anchor> anchors;
  double slip = 0;  ///< movement at which friction is fully developed
};

/// A bound on the displacement of every material point from an original shape: penalty
/// stiffness·(|D| − distance)²/2 beyond it.
struct DisplacementLimit {
  double distance = 0, stiffness = 0;
  Points original;  ///< control points, in the units of the load
};

/// The forces of shaped tools on a spline, integrated over it: F_i = ∫ R_i f(S) dû (thesis
/// Eqs. 4.23, 4.25), by Gauss points in the parameter domain, R_i the (rational) basis. Everything
/// is in the units of a `DomainScaling`.
///
/// The Gauss grid depends on the knots and weights and on the size of the tools, and is kept from
/// step to step: at least p + 1 points per span, and enough that they lie closer than a sixth of
/// the smallest tool that is integrated on it (see `ToolGrids`). Only spans whose control points
/// come near a tool are evaluated (the shape lies in their convex hull; with a weight that is not
/// positive it may not, and all are), so the cost depends on the contact, not the grid.
///
/// Tools that are `ToolTouch::visible` act on the visible part V of a surface, F_i = ∫_V R_i f(S)
/// dû. Every Gauss point has a cell of the grid, as long in each direction as its weight, which
/// contains it (Chebyshev, Markov, Stieltjes: Szegő, Orthogonal Polynomials, § 3.41). In cells that
/// are visible it stays; where an edge cuts the cell, the centroid of the visible part takes its
/// place and the area of that part its weight (see `VisibleMask`): exact where R_i f is linear in
/// the cell.
template <int D>
class ToolLoad {
 public:
  /// \param spline the rest shape, in file units; its spans are measured to choose the number of
  /// points. \param detail the length to resolve, in file units (the least `Tool::detail`);
  /// infinite: p + 1 points per span. Error (input): the tool is so small that a direction would
  /// need more than 100,000 points.
  [[nodiscard]] static Expected<ToolLoad> create(const Spline<D>& spline,
                                                 const DomainScaling<D>& scaling, double detail);
  /// The same on a grid that resolves twice the length, for tools of that detail and more; this one
  /// is left with those of less. None where this one has p + 1 points on every span.
  [[nodiscard]] std::optional<ToolLoad> split();

  /// The part of a surface that is visible, from now on. No effect if that is all of it. Surfaces
  /// only.
  void show(std::shared_ptr<const VisibleRegion> region);
  /// Whether tools that touch the visible part only need a pass of their own.
  [[nodiscard]] bool hides() const { return mask_ != nullptr; }

  /// Everything that acts on the shape, in normalised units.
  struct Actors {
    std::span<const ModelTool> tools;
    const FrictionAnchors* friction = nullptr;
    const DisplacementLimit* limit = nullptr;
    ToolPass pass = ToolPass::all;
    const WatchedElements* watched = nullptr;  ///< null: all elements
    /// Of all elements only those that are not among these.
    const WatchedElements* beyond = nullptr;
  };

  /// Adds potential, force and contacts at control points x (rows `first` … of all points) to
  /// `state`.
  void evaluate(const Points& x, int first, int patch, const Actors& actors,
                PotentialState& state) const;

  /// Adds the Hessian at contact points of this patch, applied to v, to `out`: fastest in the order
  /// of `evaluate`.
  void apply_hessian(std::span<const ContactPoint> contacts, int first, const Points& v,
                     Points& out) const;

  /// Calls `add` with blocks whose sum is that Hessian, for contact points of this patch: those of
  /// one element after another give one block.
  void each_hessian_block(std::span<const ContactPoint> contacts, int first,
                          const AddBlock& add) const;

  /// Sets the marks of the control points that contact points of this patch depend on.
  void mark(std::span<const ContactPoint> contacts, int first, std::vector<char>& marks) const;

  /// Marks the neighbours of this patch's marked control points, by one in every direction of the
  /// net.
  void widen(int first, std::vector<char>& marks) const;
  /// The numbers of the elements whose control points are all marked, ascending.
  [[nodiscard]] std::vector<int> elements_of(int first, const std::vector<char>& marks) const;

  /// The anchors of friction where the tools are touched at x.
  [[nodiscard]] FrictionAnchors anchors(const Points& x, int first,
                                        std::span<const ModelTool> tools, double slip,
                                        ToolPass pass = ToolPass::all) const;

  /// How deep the shape with control points x penetrates a tool, anywhere, not only at Gauss
  /// points: sampled three times as densely, with the deepest samples refined by a compass search
  /// to 1e-6 of the sample distance.
  [[nodiscard]] Penetration deepest_entry(const Points& x, int first, const ModelTool& tool) const;

  [[nodiscard]] long long points() const;
  /// Whether a tool is integrated on this grid.
  [[nodiscard]] bool takes(const ModelTool& tool) const {
    return tool.detail() >= least_ && (!most_ || tool.detail() < *most_);
  }

 private:
  struct Element;   // one span per direction
  struct Sample;    // one Gauss point
  class Sweep;      // over the Gauss points of an element
  struct Gripping;  // what friction does in one
  class Evaluation;
  class EntrySearch;
  class ElementLevels;
  class PointSums;  // over Gauss points, one direction at a time
  class FieldAtPoints;
  class ForcesOfPoints;

  /// The functions of the last direction on one span: function j at Gauss point k of it at [j
  /// stride + k], with zeros behind the last.
  struct TransposedBasis {
    std::ptrdiff_t stride = 0;
    std::vector<double> values;
  };

  ToolLoad() = default;

  [[nodiscard]] int control_points() const {
    return std::accumulate(net_.begin(), net_.end(), 1, std::multiplies{});
  }

  void divide(const std::array<std::vector<int>, D>& counts);
  void transpose();
  [[nodiscard]] Element element(std::array<std::size_t, D> span) const;
  [[nodiscard]] Element element(int number) const;
  template <class F>
  void for_each_element(const F& f) const;
  template <class F>
  void for_each_element(const std::array<std::size_t, D>& begin,
                        const std::array<std::size_t, D>& end, const F& f) const;
  template <class F>
  void for_each_line(const std::array<int, D>& first, const F& f) const;
  template <class F>
  void for_each_control_point(const Element& element, const F& f) const;
  template <class F>
  void for_what_is_seen(const Sample& whole, const Points& x, int first, const F& f) const;
  [[nodiscard]] Sample visible_part(const Sample& whole, int part, const Points& x,
                                    int first) const;
  [[nodiscard]] ToolPass pass_of(const ModelTool& tool) const {
    return mask_ && tool.tool().touches == ToolTouch::visible ? ToolPass::visible : ToolPass::all;
  }
  [[nodiscard]] bool takes_in_pass(const ModelTool& tool, ToolPass pass) const {
    return takes(tool) && pass_of(tool) == pass;
  }
  [[nodiscard]] int visibility(const Element& element) const;
  [[nodiscard]] const double* values(const std::array<int, 3>& at, int part, std::size_t d) const;
  [[nodiscard]] int number(const Element& element) const;
  [[nodiscard]] static std::ptrdiff_t index(const Element& element, const std::array<int, 3>& at);
  [[nodiscard]] static std::ptrdiff_t points(const Element& element);
  template <class F>
  void for_each_function(const std::array<int, 3>& at, int part, const F& f) const;
  [[nodiscard]] double weight(std::ptrdiff_t row) const {
    return weights_.empty() ? 1 : weights_[static_cast<std::size_t>(row)];
  }

  double detail_ = 0;              // that it resolves, normalised
  double least_ = 0;               // detail of the tools that it takes
  std::optional<double> most_;     // likewise; none: all from there on
  int grid_ = 0;                   // of `ToolGrids`
  std::array<double, D> scale_{};  // of the domain, see `DomainScaling`
  std::array<int, D> net_{};
  std::array<BasisQuadrature, D> quadrature_;
  std::vector<KnotVector> knots_;
  std::array<std::vector<int>, D> spans_;       // first Gauss point of every span, and the end
  std::array<std::vector<int>, D> starts_;      // first function of every span
  std::array<std::vector<double>, D> lengths_;  // of every span, normalised
  std::vector<double> progress_;                // in the last direction, see `progress_along`
  std::vector<TransposedBasis> transposed_;     // of every span of the last direction
  std::vector<double> weights_;  // of the control points; empty for a polynomial spline
  bool in_hull_ = true;          // all weights are positive
  std::shared_ptr<const VisibleRegion> region_;  // null: everything is visible
  std::shared_ptr<const VisibleMask> mask_;      // of the Gauss points' cells; null likewise
  std::vector<double>
      part_values_;  // of the basis at the centroid of every part, one direction after the other
};

/// The forces of tools of all sizes on one patch, each tool on a grid of its own fineness: grid k
/// resolves 2^k times the smallest detail, and takes the tools of 2^k to 2^(k+1) times that; the
/// last one has p + 1 points per span, and takes all larger ones. A small tool does not refine the
/// grid of a large one: a tool is asked at no more than four times (in two directions) as many
/// points as if it were alone. The limit on displacements, which is a spline itself, acts on the
/// last grid.
template <int D>
class ToolGrids {
 public:
  /// As `ToolLoad::create`.
  [[nodiscard]] static Expected<ToolGrids> create(const Spline<D>& spline,
                                                  const DomainScaling<D>& scaling, double detail);
  /// As `ToolLoad::show`.
  void show(const std::shared_ptr<const VisibleRegion>& region);

  [[nodiscard]] std::size_t size() const { return grids_.size(); }
  [[nodiscard]] const ToolLoad<D>& operator[](std::size_t k) const { return grids_[k]; }
  [[nodiscard]] const ToolLoad<D>& coarsest() const { return grids_.back(); }
  [[nodiscard]] auto begin() const { return grids_.begin(); }
  [[nodiscard]] auto end() const { return grids_.end(); }

 private:
  std::vector<ToolLoad<D>> grids_;  // finest first
};

}  // namespace knead
