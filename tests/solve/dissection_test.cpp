#include "solve/dissection.hpp"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <numeric>
#include <random>

#include "knead/energy/stiffness.hpp"
#include "knead/solve/sparse_cholesky.hpp"
#include "solve/panels.hpp"
#include "support/surfaces.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

using testing::random_points;
using testing::with_threads;

/// K and mass of one or more patches, which depend on each other at some control points.
struct PatchSystem {
  std::vector<Surface> patches;
  SparseMatrix a;
  GridPlaces places;

  PatchSystem(int degree, std::vector<std::array<int, 2>> spans) {
    std::vector<Eigen::Triplet<double>> entries;
    int first = 0;
    for (const auto& [m, n] : spans) {
      patches.push_back(testing::relief(testing::uniform_clamped(degree, m),
                                        testing::uniform_clamped(degree, n), 1));
      const SparseMatrix k = Stiffness<2>::create(patches.back(), stretch_and_bend({}))->assemble(),
                         mass = Stiffness<2>::create(patches.back(), mass_energy<2>())->assemble();
      const SparseMatrix sum = k + mass;
      for (int j = 0; j < sum.outerSize(); ++j) {
        for (SparseMatrix::InnerIterator it(sum, j); it; ++it) {
          entries.emplace_back(first + it.row(), first + j, it.value());
        }
      }
      if (first > 0) {
        for (const auto& [i, j] : {std::pair{first - 1, first}, std::pair{first - 3, first + 2}}) {
          for (const auto& [p, q] : {std::pair{i, i}, std::pair{j, j}})
            entries.emplace_back(p, q, 0.5);
          for (const auto& [p, q] : {std::pair{i, j}, std::pair{j, i}})
            entries.emplace_back(p, q, -0.5);
        }
      }
      first += static_cast<int>(sum.rows());
    }
    a.resize(first, first);
    a.setFromTriplets(entries.begin(), entries.end());
    places = grid_places<2>(patches);
  }

  [[nodiscard]] SparseMatrix in_order(const Dissection& d) const {
    SparseMatrix lower(a.rows(), a.cols());
    lower.selfadjointView<Eigen::Lower>() = a.selfadjointView<Eigen::Lower>().twistedBy(
        Eigen::PermutationMatrix<Eigen::Dynamic>(d.order));
    return lower;
  }
};

/// What `Dissection` promises.
void expect_right(const SparseMatrix& a, const Dissection& d) {
  std::vector<int> places(d.order.begin(), d.order.end());
  std::ranges::sort(places);
  for (int k = 0; k < a.cols(); ++k) ASSERT_EQ(places[static_cast<std::size_t>(k)], k);
  std::vector<int> node_of(places.size(), -1);
  int next = 0;
  for (std::size_t k = 0; k < d.nodes.size(); ++k) {
    const Dissection::Node& node = d.nodes[k];
    ASSERT_EQ(node.begin, next);
    next = node.end;
    for (int i = node.begin; i < node.end; ++i)
      node_of[static_cast<std::size_t>(i)] = static_cast<int>(k);
    ASSERT_TRUE(node.parent < 0 || node.parent > static_cast<int>(k));
  }
  ASSERT_EQ(next, a.cols());
  const auto node = [&](int unknown) {
    return node_of[static_cast<std::size_t>(d.order[unknown])];
  };
  for (int j = 0; j < a.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator it(a, j); it; ++it) {
      const int first = std::min(node(j), node(static_cast<int>(it.row()))),
                last = std::max(node(j), node(static_cast<int>(it.row())));
      int behind = first;
      while (behind >= 0 && behind < last)
        behind = d.nodes[static_cast<std::size_t>(behind)].parent;
      ASSERT_EQ(behind, last) << j << " " << it.row();
    }
  }
}

TEST(Dissection, SeparatesWhatDoesNotDependOnEachOther) {
  for (const int degree : {1, 3, 5}) {
    const PatchSystem one(degree, {{30, 41}}),
        several(degree, {{12, 9}, {3, 20}, {15, 15}, {1, 1}});
    for (const PatchSystem* p : {&one, &several}) {
      for (const int size : {64, 100, 500}) {
        const Dissection d = dissect(p->a, p->places, size);
        expect_right(p->a, d);
        if (p->a.cols() > 3 * size) {
          EXPECT_GT(d.nodes.size(), 2U) << degree << " " << size;
        }
        for (const Dissection::Node& node : d.nodes)
          EXPECT_LE(node.end - node.begin, std::max(size, 250));
      }
    }
  }
}

TEST(Dissection, IsRightWhateverThePlaces) {
  const PatchSystem p(3, {{20, 17}});
  GridPlaces same{1, std::vector<int>(static_cast<std::size_t>(p.a.cols()), 4)}, wild{2, {}};
  std::mt19937 random(1);
  for (int i = 0; i < 2 * p.a.cols(); ++i) wild.indices.push_back(static_cast<int>(random() % 7));
  for (const GridPlaces* places : {&same, &wild}) expect_right(p.a, dissect(p.a, *places, 64));
  // Nothing depends on anything, and what is not there at all.
  SparseMatrix apart(300, 300);
  apart.setIdentity();
  GridPlaces line{1, std::vector<int>(300)};
  std::iota(line.indices.begin(), line.indices.end(), 0);
  expect_right(apart, dissect(apart, line, 64));
  expect_right(SparseMatrix(0, 0), dissect(SparseMatrix(0, 0), GridPlaces{1, {}}, 64));
}

TEST(Dissection, FillsLargeGridsLessThanMinimumDegree) {
  const PatchSystem p(3, {{97, 97}});
  const auto stored = [&](const Dissection& d) {
    return static_cast<double>(Panels::factor(p.in_order(d), best_instruction_set(), &d)->stored());
  };
  EXPECT_LT(stored(dissect(p.a, p.places)), stored(minimum_degree(p.a)));
}

TEST(Dissection, OfVolumesSeparatesToo) {
  const auto knots = testing::uniform_clamped(2, 7);
  const int n = knots.count();
  const Volume box = *Volume::create({knots, knots, knots}, random_points(n * n * n, 1));
  const SparseMatrix a = Stiffness<3>::create(box, mass_energy<3>())->assemble();
  const Dissection d = dissect(a, grid_places<3>(std::span(&box, 1)), 100);
  expect_right(a, d);
  EXPECT_GT(d.nodes.size(), 2U);
}

using FourColumns = Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>;

TEST(DissectedPanels, SolveAndGiveTheSameBitsByThreadsAndInstructionSets) {
  const PatchSystem p(3, {{30, 27}, {11, 12}});
  const Dissection d = dissect(p.a, p.places, 100);
  ASSERT_GT(d.nodes.size(), 8U);
  const SparseMatrix lower = p.in_order(d), whole = lower.selfadjointView<Eigen::Lower>();
  const Eigen::Index n = lower.rows();
  FourColumns b(n, 4);
  b << random_points(n, 2), random_points(n, 3).col(0);
  const auto solved = [&](InstructionSet set) {
    const auto panels = Panels::factor(lower, set, &d);
    EXPECT_TRUE(panels);
    FourColumns x = FourColumns::Constant(panels->work_rows(), 4,
                                          1e300);  // rows beyond those of the matrix mean nothing
    x.topRows(n) = b;
    panels->forward<4>(x.data(), panels->all());
    const FourColumns half = x.topRows(n);
    panels->backward<4>(x.data(), panels->all());
    Eigen::VectorXd one = Eigen::VectorXd::Constant(panels->work_rows(), -1e300);
    one.head(n) = b.col(1);
    panels->forward<1>(one.data(), panels->all());
    EXPECT_EQ(one.head(n), half.col(1));
    panels->backward<1>(one.data(), panels->all());
    EXPECT_EQ(one.head(n), x.topRows(n).col(1));
    return FourColumns(x.topRows(n));
  };
  const FourColumns expected = with_threads(1, [&] { return solved(InstructionSet::vector128); });
  EXPECT_LE((whole * expected - b).norm(), 1e-12 * b.norm());
  for (const int threads : testing::thread_counts) {
    for (const InstructionSet set : available_instruction_sets()) {
      EXPECT_EQ(with_threads(threads, [&] { return solved(set); }), expected)
          << threads << " " << name(set);
    }
  }
}

TEST(DissectedPanels, OfLargePanelsGiveTheSameBitsByAnyNumberOfThreads) {
  // Large enough that threads share the rows of panels.
  const PatchSystem p(5, {{110, 110}});
  Dissection d = dissect(p.a, p.places);
  ASSERT_GT(d.nodes.size(), 8U);
  const SparseMatrix lower = p.in_order(d);
  const Points b = random_points(lower.rows(), 2);
  const auto solved = [&] { return SparseCholesky::factor_in_order(lower, d)->solve(b); };
  const Points expected = with_threads(1, solved);
  const Points reordered = d.order.asPermutation() * b;
  const SparseMatrix whole = lower.selfadjointView<Eigen::Lower>();
  EXPECT_LE((whole * (d.order.asPermutation() * expected).eval() - reordered).norm(),
            1e-11 * b.norm());
  for (const int threads : {2, 3}) EXPECT_EQ(with_threads(threads, solved), expected) << threads;
}

TEST(DissectedPanels, SolveWithinAPartByTheBitsOfTheWhole) {
  const PatchSystem p(3, {{30, 27}, {11, 12}});
  const SparseMatrix copy = p.a;
  const auto dissected = SparseCholesky::factor_in_order(p.in_order(dissect(p.a, p.places, 80)),
                                                         dissect(p.a, p.places, 80));
  ASSERT_TRUE(dissected);
  for (const std::vector<int>& unknowns : {std::vector<int>{400, 401, 402, 433, 434},
                                           std::vector<int>{0}, std::vector<int>{990, 2, 500}}) {
    Points b = Points::Zero(p.a.rows(), 3);
    const Points here = random_points(static_cast<Eigen::Index>(unknowns.size()), 5);
    for (std::size_t k = 0; k < unknowns.size(); ++k)
      b.row(unknowns[k]) = here.row(static_cast<Eigen::Index>(k));
    const auto subset = dissected->subset(unknowns);
    const Points whole = dissected->solve(b);
    for (const int threads : testing::thread_counts) {
      const Points within =
          with_threads(threads, [&] { return dissected->solve_within(subset, here); });
      for (std::size_t k = 0; k < unknowns.size(); ++k) {
        EXPECT_EQ(within.row(static_cast<Eigen::Index>(k)), whole.row(unknowns[k])) << threads;
      }
    }
    const auto half = dissected->forward(b);
    Points back;
    dissected->backward_within(subset, half, back);
    for (std::size_t k = 0; k < unknowns.size(); ++k) {
      EXPECT_EQ(back.row(static_cast<Eigen::Index>(k)), whole.row(unknowns[k]));
    }
    Points all;
    dissected->backward(half, 0.25, subset, here, all);
    EXPECT_LE((p.a * all - 1.25 * b).norm(), 1e-11 * b.norm());
  }
}

TEST(DissectedPanels, AreRefusedForPlacesOfOtherUnknowns) {
  const PatchSystem p(3, {{9, 8}});
  GridPlaces fewer = p.places;
  fewer.indices.pop_back();
  for (const GridPlaces& places : {fewer, GridPlaces{}}) {
    const auto factor = SparseCholesky::factor(SparseMatrix(p.a), places);
    ASSERT_FALSE(factor);
    EXPECT_EQ(factor.error().kind, ErrorKind::usage);
  }
  EXPECT_TRUE(SparseCholesky::factor(SparseMatrix(p.a), p.places));
}

TEST(DissectedPanels, AreRefusedWhereAnyPivotIsNotPositive) {
  PatchSystem p(3, {{30, 27}});
  const Dissection d = dissect(p.a, p.places, 100);
  for (const int k : {3, 450, static_cast<int>(p.a.rows()) - 1}) {
    SparseMatrix a = p.in_order(d);
    a.coeffRef(k, k) = -1;
    for (const int threads : {1, 2}) {
      EXPECT_FALSE(with_threads(threads, [&] {
        return SparseCholesky::factor_in_order(a, d).has_value();
      })) << k;
    }
  }
}

}  // namespace
}  // namespace knead
