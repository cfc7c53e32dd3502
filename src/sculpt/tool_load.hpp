#pragma once

#include <optional>
#include <span>
#include <vector>

#include "knead/sculpt/domain_scaling.hpp"
#include "knead/sculpt/tool.hpp"
#include "knead/spline/basis.hpp"
#include "potential.hpp"

namespace knead {

/// Dry friction, lagged: the normal forces and positions of all points in contact at the start of a step.
struct FrictionAnchors {
  struct Anchor {
    double grip = 0;  ///< Coulomb's coefficient times the normal force per parameter measure
    Point normal = Point::Zero(), place = Point::Zero();
  };
  std::vector<int> index;  ///< per Gauss point: an anchor, or −1
  std::vector<Anchor> anchors;
  double slip = 0;  ///< movement at which friction is fully developed
};

/// A bound on the displacement of every material point from an original shape: penalty stiffness·(|D| − distance)²/2
/// beyond it.
struct DisplacementLimit {
  double distance = 0, stiffness = 0;
  Points original;  ///< control points, in the units of the load
};

/// The forces of shaped tools on a spline, integrated over it: F_i = ∫ R_i f(S) dû (thesis Eqs. 4.23, 4.25), by Gauss
/// points in the parameter domain, R_i the (rational) basis. Everything is in the units of a `DomainScaling`.
///
/// The Gauss grid depends on the knots and weights and on the size of the tools, and is kept from step to step: at
/// least p + 1 points per span, and enough that they lie closer than a sixth of the smallest tool. Only spans whose
/// control points come near a tool are evaluated (the shape lies in their convex hull; with a weight that is not
/// positive it may not, and all are), so the cost depends on the contact, not the grid.
template <int D>
class ToolLoad {
 public:
  /// \param spline the rest shape, in file units; its spans are measured to choose the number of points.
  /// \param detail the length to resolve, in file units (smallest size or range of the tools); infinite: p + 1 points
  ///               per span.
  /// Error (input): the tool is so small that a direction would need more than 100,000 points.
  [[nodiscard]] static Expected<ToolLoad> create(const Spline<D>& spline, const DomainScaling<D>& scaling,
                                                 double detail);

  /// Everything that acts on the shape, in normalised units.
  struct Actors {
    std::span<const ModelTool> tools;
    const FrictionAnchors* friction = nullptr;
    const DisplacementLimit* limit = nullptr;
  };

  /// Adds potential, force and contacts at control points x (rows `first` … of all points) to `state`.
  void evaluate(const Points& x, int first, int patch, const Actors& actors, PotentialState& state) const;

  /// Adds the Hessian at one contact point of this patch, applied to v, to `out`.
  void apply_hessian(const ContactPoint& contact, int first, const Points& v, Points& out) const;

  /// Sets the marks of the control points that a contact point of this patch depends on.
  void mark(const ContactPoint& contact, int first, std::vector<char>& marks) const;

  /// The anchors of friction where the tools are touched at x.
  [[nodiscard]] FrictionAnchors anchors(const Points& x, int first, std::span<const ModelTool> tools,
                                        double slip) const;

  /// How deep the shape with control points x penetrates a tool, anywhere, not only at Gauss points: sampled three
  /// times as densely, with the deepest samples refined by a compass search to 1e-6 of the sample distance.
  [[nodiscard]] double deepest_entry(const Points& x, int first, const ModelTool& tool) const;

  [[nodiscard]] long long points() const;

 private:
  struct Element;  // one span per direction
  struct Sample;   // one Gauss point
  class Evaluation;
  class EntrySearch;
  using Homogeneous = std::array<double, 4>;
  using Workspace = std::array<std::vector<Homogeneous>, D + 1>;

  ToolLoad() = default;

  template <class F>
  void for_each_element(const F& f) const;
  template <class F>
  void for_each_control_point(const Element& element, const F& f) const;
  template <class F>
  void for_each_point(const Element& element, const Points& x, int first, Workspace& workspace, const F& f) const;
  [[nodiscard]] long long index(const std::array<int, 3>& at) const;
  template <class F>
  void for_each_function(const std::array<int, 3>& at, const F& f) const;
  void box_of(const Element& element, const Points& x, int first, Point& lower, Point& upper) const;

  std::array<int, D> net_{};
  std::array<BasisQuadrature, D> quadrature_;
  std::vector<KnotVector> knots_;
  std::array<std::vector<int>, D> spans_;       // first Gauss point of every span, and the end
  std::array<std::vector<double>, D> lengths_;  // of every span, normalised
  std::vector<double> weights_;                 // of the control points; empty for a polynomial spline
  bool in_hull_ = true;                         // all weights are positive
};

}  // namespace knead
