#include "rational_load.hpp"

#include <algorithm>
#include <cmath>

#include "gramian/rational_elements.hpp"
#include "gramian/rational_rule.hpp"
#include "gramian/unit_gauss.hpp"
#include "knead/spline/evaluate.hpp"

namespace knead::detail {
namespace {

constexpr double load_tolerance = 1e-10;

template <int D>
class RationalLoad {
 public:
  RationalLoad(const Spline<D>& shape, const Spline<D>& load)
      : shape_(shape), load_(load), elements_(knots_of(shape), shape.weights(), breaks_of(load)) {}

  Expected<Points> run() {
    if (auto status = sum_up(false); !status) return std::unexpected(status.error());
    // The sizes by few points may have been too large for the tolerance to be kept; those of this
    // pass are not.
    for (int pass = 0; pass < 4; ++pass) {
      size_ = measure_;
      if (auto status = sum_up(true); !status) return std::unexpected(status.error());
      if ((errors_.array() <= load_tolerance * measure_.array()).all()) break;
    }
    return forces_;
  }

 private:
  static std::array<const KnotVector*, D> knots_of(const Spline<D>& spline) {
    std::array<const KnotVector*, D> knots;
    for (std::size_t d = 0; d < D; ++d) knots[d] = &spline.knots()[d];
    return knots;
  }
  static std::array<std::vector<double>, D> breaks_of(const Spline<D>& load) {
    std::array<std::vector<double>, D> breaks;
    for (std::size_t d = 0; d < D; ++d) {
      const auto knots = load.knots()[d].knots();
      breaks[d].assign(knots.begin(), knots.end());
    }
    return breaks;
  }

  /// Forces, the integrals of R and bounds of their errors; by few points, for the integrals,
  /// unless `certified`.
  Expected<void> sum_up(bool certified) {
    forces_ = Points::Zero(shape_.size(), 3);
    measure_ = errors_ = Eigen::VectorXd::Zero(shape_.size());
    RationalRule<D> rule(
        1, {.most_points = D == 3 ? 16 : 24, .all_points = 1e4 * elements_.count() + 1e7});
    Expected<void> status;
    double error = 0;
    const auto size = [&](const double* bounds, std::size_t d, double rho) {
      return this->size(bounds, d, rho);
    };
    const auto visit = [&](const RationalPiece<D>& piece, const std::array<int, D>& points,
                           double piece_error) {
      error += piece_error;
      status = add(piece, points);
      return status.has_value();
    };
    elements_.for_each([&](const RationalPiece<D>& piece) {
      error = 0;
      std::array<int, D> few;
      for (std::size_t d = 0; d < D; ++d) few[d] = piece.axis(d).degree() + 2;
      const double allowed = load_tolerance / static_cast<double>(elements_.functions()) *
                             RationalElements<D>::share(piece);
      const bool kept =
          certified ? rule.integrate(piece, allowed, size, visit) : visit(piece, few, 0);
      if (!kept && status) {
        status = numerical_error(
            "the weights of one element differ so much that loads on it cannot be integrated",
            "load", "use weights that differ less");
      }
      for (std::size_t r = 0; r < elements_.functions() && certified; ++r) {
        errors_[elements_.rows()[r]] += error * size_[elements_.rows()[r]];
      }
      return status.has_value();
    });
    return status;
  }

  /// A bound of R f relative to ∫ R and max |f|: f is a polynomial, which grows by ρ per degree at
  /// most (Bernstein).
  [[nodiscard]] double size(const double* bounds, std::size_t direction, double rho) const {
    double largest = 0;
    for (std::size_t r = 0; r < elements_.functions(); ++r) {
      largest = std::max(largest, bounds[r] / size_[elements_.rows()[r]]);
    }
    return largest * std::pow(rho, load_.knots()[direction].degree());
  }

  Expected<void> add(const RationalPiece<D>& piece, const std::array<int, D>& points) {
    RationalLine<D> line{{}, {}};
    std::array<BasisTable, D> tables;
    std::array<const BasisTable*, D> pointers;
    for (std::size_t d = 0; d < D; ++d) {
      const RationalAxis& axis = piece.axis(d);
      points_[d].tabulate(axis, points[d], d + 1 == D);
      line.points[d] = &points_[d];
      std::vector<double> at;
      for (const double t : unit_gauss<double>(points[d]).t) {
        at.push_back(std::clamp(axis.lower + t * axis.length(), axis.lower,
                                std::nextafter(axis.upper, axis.lower)));
      }
      at.resize(points_[d].size(), at.back());
      auto made = tabulate_basis(load_.knots()[d], at, 0);
      if (!made) return std::unexpected(made.error());
      tables[d] = std::move(*made);
      pointers[d] = &tables[d];
    }
    const auto f = evaluate_grid<D>(load_, pointers, 0);
    if (!f) return std::unexpected(f.error());
    values_.resize(elements_.functions() * line.size());
    Eigen::Index first = 0;
    do {
      if (!piece.evaluate(line, 1, values_.data())) {
        return numerical_error("the rational denominator is not positive", "load",
                               "use positive weights");
      }
      add_line(line, f->points(), first);
      first += static_cast<Eigen::Index>(line.size());
    } while (line.next());
    return {};
  }

  void add_line(const RationalLine<D>& line, const Points& f, Eigen::Index first) {
    const std::size_t n = line.size();
    const double outer = line.outer_weight();
    for (std::size_t r = 0; r < elements_.functions(); ++r) {
      const int row = elements_.rows()[r];
      for (std::size_t g = 0; g < n; ++g) {
        const double factor = outer * line.points[D - 1]->weights[g] * values_[r * n + g];
        forces_.row(row) += factor * f.row(first + static_cast<Eigen::Index>(g));
        measure_[row] += factor;
      }
    }
  }

  const Spline<D>&shape_, &load_;
  RationalElements<D> elements_;
  std::array<RationalPoints, D> points_;
  std::vector<double> values_;
  Points forces_;
  Eigen::VectorXd size_, measure_, errors_;
};

}  // namespace

template <int D>
Expected<Points> rational_load(const Spline<D>& shape, const Spline<D>& load) {
  return RationalLoad<D>(shape, load).run();
}

template Expected<Points> rational_load<1>(const Spline<1>&, const Spline<1>&);
template Expected<Points> rational_load<2>(const Spline<2>&, const Spline<2>&);
template Expected<Points> rational_load<3>(const Spline<3>&, const Spline<3>&);

}  // namespace knead::detail
