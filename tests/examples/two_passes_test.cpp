#include "two_passes.hpp"

#include <gtest/gtest.h>

#include "knead/solve/sparse_cholesky.hpp"

namespace knead::examples {
namespace {

std::array<KnotVector, 2> some_knots(int degree) {
  std::vector<double> u(static_cast<std::size_t>(degree) + 1, 0.0),
      v(static_cast<std::size_t>(degree) + 1, -1.0);
  for (const double knot : {0.1, 0.25, 0.25, 0.6, 0.61, 0.9}) u.push_back(knot);
  for (const double knot : {-0.5, 0.0, 1.5, 2.0, 2.5, 2.75}) v.push_back(knot);
  u.insert(u.end(), static_cast<std::size_t>(degree) + 1, 1.0);
  v.insert(v.end(), static_cast<std::size_t>(degree) + 1, 3.0);
  return {*KnotVector::create(degree, u), *KnotVector::create(degree, v)};
}

Energy<2> with_mass(Energy<2> energy, double mass) {
  for (const EnergyTerm<2>& term : mass_energy<2>(mass)) energy.push_back(term);
  return energy;
}

/// λ (G00 + a G11) ⊗ (G00 + b G11).
Energy<2> product(double lambda, double a, double b) {
  return with_mass(stretch_and_bend({{lambda * a, 0, lambda * b}, {0, lambda * a * b / 2, 0}}),
                   lambda);
}

/// λ (G00 + a G22) ⊗ G00: a cloth of stiff threads.
Energy<2> bent_one_way(double lambda, double a) {
  return with_mass(stretch_and_bend({{0, 0, 0}, {lambda * a, 0, 0}}), lambda);
}

template <class Solver>
void expect_the_vectorised_solution(const Energy<2>& energy, int degree, int held,
                                    const char* what) {
  const auto knots = some_knots(degree);
  const auto matrix = vectorised(knots, energy, held);
  const auto solver = Solver::create(knots, energy, held);
  ASSERT_TRUE(solver) << what << ": " << solver.error().message();
  const Points d = Points::Random(matrix.rows(), 3);
  const Points found = solver->solve(d), other = SparseCholesky::factor(matrix)->solve(d);
  // The vectorised system holds to rounding, as it does for its own solution; errors grow with its
  // condition.
  const double rows = (matrix.cwiseAbs() * Eigen::VectorXd::Ones(matrix.cols())).maxCoeff();
  const auto residual = [&](const Points& x) {
    return (matrix * x - d).cwiseAbs().maxCoeff() /
           (rows * x.cwiseAbs().maxCoeff() + d.cwiseAbs().maxCoeff());
  };
  EXPECT_LE(residual(found), 1e-14) << what << degree << held;
  EXPECT_LE(residual(other), 1e-14) << what << degree << held;
}

TEST(TwoPasses, SolveASingleProductAsTheVectorisedSystemDoes) {
  for (const int degree : {2, 3, 5}) {
    for (const int held : {0, 1}) {
      expect_the_vectorised_solution<TwoPasses>(product(20, 0.3, 0.05), degree, held, "stretch ");
      expect_the_vectorised_solution<TwoPasses>(bent_one_way(3, 1e-3), degree, held, "bent ");
    }
  }
}

TEST(TwoPasses, SayWhereTheyDoNotApply) {
  const auto knots = some_knots(3);
  const Material usual;  // the default, which bends
  EXPECT_NE(TwoPasses::create(knots, with_mass(stretch_and_bend(usual), 20))
                .error()
                .what.find("no single product"),
            std::string::npos);
  EXPECT_FALSE(TwoPasses::create(knots, with_mass(stretch_and_bend({{1, 0, 1}, {0, 0, 0}}), 20)))
      << "two products";
  EXPECT_NE(TwoPasses::create(knots, with_mass(stretch_and_bend({{1, 0.5, 1}, {0, 0, 0}}), 20))
                .error()
                .remedy.find("alpha12"),
            std::string::npos);
  EXPECT_FALSE(TwoPasses::create(knots, mass_energy<2>(1), 5)) << "everything is held";
}

TEST(FastDiagonalisation, SolvesSumsThatOnePairOfGramiansPerDirectionDiagonalises) {
  for (const int degree : {2, 3, 5}) {
    for (const int held : {0, 1}) {
      expect_the_vectorised_solution<FastDiagonalisation>(product(20, 0.3, 0.05), degree, held,
                                                          "product ");
      expect_the_vectorised_solution<FastDiagonalisation>(
          with_mass(stretch_and_bend({{1, 0, 3}, {0, 0.2, 0}}), 20), degree, held,
          "stretch and twist ");
      expect_the_vectorised_solution<FastDiagonalisation>(
          with_mass(stretch_and_bend({{0, 0, 0}, {0.01, 0, 0.02}}), 20), degree, held,
          "bending alone ");
    }
  }
}

TEST(FastDiagonalisation, DoesNotSolveTheDefaultMaterial) {
  const auto refused =
      FastDiagonalisation::create(some_knots(3), with_mass(stretch_and_bend(Material()), 20));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("stretch and bending"), std::string::npos);
}

}  // namespace
}  // namespace knead::examples
