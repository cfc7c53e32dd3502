// Directions of Newton's iteration in contact, and how many substitutions steps under stiff tools
// take.
#include "contact/contact_directions.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "active.hpp"
#include "sculpt/travelled.hpp"
#include "support/surfaces.hpp"

namespace knead {
namespace {

/// Stiff springs between a plane and some control points, each with a normal of its own.
class Springs final : public Potential {
 public:
  Springs(std::vector<int> points, double stiffness, unsigned seed)
      : points_(std::move(points)),
        stiffness_(stiffness),
        normals_(testing::random_points(64, seed)) {}

  [[nodiscard]] PotentialState evaluate(const Points&, const WatchedElements*) const override {
    return {};
  }
  [[nodiscard]] bool acts_beyond(const WatchedElements&, const Points&) const override {
    return false;
  }
  void apply_hessian(const PotentialState&, const Points& v, Points& out) const override {
    for (std::size_t k = 0; k < points_.size(); ++k)
      out.row(points_[k]) += v.row(points_[k]) * hessian(k);
  }
  void each_hessian_block(const PotentialState&, const AddBlock& add) const override {
    for (std::size_t k = 0; k < points_.size(); ++k) add({&points_[k], 1}, hessian(k));
  }
  void mark(const PotentialState&, std::vector<char>& marks) const override {
    for (const int i : points_) marks[static_cast<std::size_t>(i)] = 1;
  }
  void widen(std::vector<char>&) const override {}
  [[nodiscard]] WatchedElements watch(const std::vector<char>&) const override { return {}; }
  void soften(double cap) override { stiffness_ = std::min(stiffness_, cap); }
  [[nodiscard]] double stiffest() const override { return stiffness_; }
  [[nodiscard]] bool limits() const override { return false; }

  [[nodiscard]] Eigen::Matrix3d hessian(std::size_t k) const {
    const Point n = normals_.row(static_cast<Eigen::Index>(k)).normalized();
    return stiffness_ * (1 + static_cast<double>(k)) * n * n.transpose();
  }

 private:
  std::vector<int> points_;
  double stiffness_;
  Points normals_;
};

struct Contact {
  Surface surface =
      testing::relief(testing::uniform_clamped(3, 9), testing::uniform_clamped(2, 8), 1);
  SparseMatrix a = Stiffness<2>::create(surface, stretch_and_bend({}))->assemble() +
                   Stiffness<2>::create(surface, mass_energy<2>())->assemble();
  ConstrainedCholesky inverse = *ConstrainedCholesky::factor(
      a, *ConstraintSpace::create(surface.size(), {}, std::vector<bool>()));
  Springs springs{{20, 21, 22, 30, 31, 40, 44, 52}, 1e3, 5};
  ContactNeighbourhood near{inverse, springs};
  Points r = testing::random_points(surface.size(), 6);
  Anchor anchor{{}, {}, 0, 0, 0, {}, {}, {}};

  Contact() {
    near.extend({});
    anchor.z = inverse.forward(r);
    anchor.rs = anchor.z.squared_norm;
    anchor.s_here = inverse.backward_within(near.subset(), anchor.z);
  }

  [[nodiscard]] Combination start() const { return {1, Points::Zero(near.size(), 3)}; }

  /// (A + H)⁻¹ of forces, by a dense factor, in the neighbourhood.
  [[nodiscard]] Points exact(const Points& forces) const {
    const Eigen::Index n = 3 * a.rows();
    Eigen::MatrixXd both = Eigen::MatrixXd::Zero(n, n);
    for (int k = 0; k < a.outerSize(); ++k) {
      for (SparseMatrix::InnerIterator it(a, k); it; ++it) {
        for (int c = 0; c < 3; ++c) both(3 * it.row() + c, 3 * it.col() + c) = it.value();
      }
    }
    springs.each_hessian_block({}, [&](std::span<const int> points, const Eigen::MatrixXd& block) {
      both.block(3 * points[0], 3 * points[0], 3, 3) += block;
    });
    const Eigen::VectorXd d = both.llt().solve(Eigen::Map<const Eigen::VectorXd>(forces.data(), n));
    return near.gather(Eigen::Map<const Points>(d.data(), a.rows(), 3));
  }
};

TEST(ContactDirections, SolveWithTheHessianOfContacts) {
  Contact c;
  const Points expected = c.exact(c.r);
  ContactDirections directions(true);
  int first = 0, again = 0, forgotten = 0;
  const ContactDirection d =
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-12, true}, first);
  EXPECT_LE((d.d - expected).norm(), 1e-10 * expected.norm());
  EXPECT_LE((d.ad.image(c.anchor, c.near) - d.d).norm(), 1e-11 * d.d.norm()) << "A d is of d";
  EXPECT_GT(first, 8) << "as many as there are springs: nothing is known of them at first";
  // The same system once more is known, and where it is forgotten it is found as at first.
  const ContactDirection e =
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-9, true}, again);
  EXPECT_LE((e.d - expected).norm(), 1e-7 * expected.norm());
  EXPECT_LE(again, 3);
  directions.forget();
  const ContactDirection f =
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-12, true}, forgotten);
  EXPECT_EQ(f.d, d.d);
  EXPECT_EQ(forgotten, first);
}

TEST(ContactDirections, CorrectByWhatWasShownOfAnotherSystem) {
  Contact c;
  ContactDirections directions(true);
  int first = 0, alone = 0, after = 0;
  static_cast<void>(
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-12, true}, first));
  c.springs = Springs({20, 21, 22, 30, 31, 40, 44, 53}, 1.1e3,
                      5);  // one lets go, one touches; all a little stiffer
  c.near.extend({});
  c.anchor.s_here = c.inverse.backward_within(c.near.subset(), c.anchor.z);
  directions.forget();
  static_cast<void>(
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-8, true}, alone));
  c.springs = Springs({20, 21, 22, 30, 31, 40, 52, 53}, 1e3, 5);
  const Points expected = c.exact(c.r);
  const ContactDirection d =
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-8, true}, after);
  EXPECT_LE((d.d - expected).norm(), 1e-6 * expected.norm());
  EXPECT_LT(after, alone);
}

// A residual that will be small enough, as those before tell, is not measured.
TEST(ContactDirections, MeasureNoResidualThatIsCertain) {
  Contact c;
  const Points expected = c.exact(c.r);
  ContactDirections directions(true);
  int first = 0, again = 0;
  static_cast<void>(
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-12, true}, first));
  const ContactDirection d =
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {0.2, true}, again);
  int measured = 0;
  static_cast<void>(
      directions.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {0.2, false}, measured));
  EXPECT_EQ(again, 0);
  EXPECT_EQ(measured, 1);
  EXPECT_LE((d.d - expected).norm(), 0.2 * expected.norm());
  ContactDirections exact(false);
  first = again = 0;
  static_cast<void>(
      exact.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-8, true}, first));
  static_cast<void>(
      exact.find({}, c.anchor, c.near, c.start(), c.anchor.s_here, {1e-8, true}, again));
  EXPECT_EQ(first, again)
      << "without corrections every residual is measured, and nothing remembered";
}

// A step of Newton's iteration is a pair as well: r before it is what (A + H) makes of the way to
// the minimum.
TEST(ContactDirections, LearnFromAStepOfNewtonsIteration) {
  Contact c;
  ContactDirections all(true), taught(true);
  int solves = 0, after = 0;
  const Combination r = c.start();
  const ContactDirection d =
      all.find({}, c.anchor, c.near, r, c.anchor.s_here, {1e-13, true}, solves);
  const Combination none{0, Points::Zero(c.near.size(), 3)};
  const Residual before{r, c.anchor.s_here}, balanced{none, none.e};
  taught.take(1, d, c.anchor, before, balanced);
  const ContactDirection e =
      taught.find({}, c.anchor, c.near, r, c.anchor.s_here, {1e-8, true}, after);
  EXPECT_LE(after, 1);
  EXPECT_LE((e.d - d.d).norm(), 1e-8 * d.d.norm());
  // A step along which nothing stiffens tells nothing, and one of another neighbourhood is none.
  ContactDirections untaught(true);
  untaught.take(1, d, c.anchor, before, before);
  untaught.take(1, d, c.anchor, {r, Points::Zero(1, 3)}, balanced);
  after = 0;
  static_cast<void>(untaught.find({}, c.anchor, c.near, r, c.anchor.s_here, {1e-13, true}, after));
  EXPECT_EQ(after, solves);
}

TEST(ContactDirections, TakeFewSubstitutionsAFrame) {
  const Surface s = testing::box<2>(3, 40);
  const auto model = testing::active<2>(s, testing::sheet_settings(s, StepAccuracy::interactive));
  Tool ball = testing::ball_above_sheet(1e4);
  ActiveState from{s.control_points()};
  int iterations = 0, solves = 0;
  for (int k = 0; k < 20; ++k) {
    testing::move_to(ball, Point(0.5 + 0.005 * k, 0.5, 0.16 - 0.004 * k));
    const auto step = model.step(from, {&ball, 1});
    ASSERT_TRUE(step && step->converged) << k;
    from.control_points = step->control_points;
    iterations += step->iterations;
    solves += step->solves;
  }
  EXPECT_LE(iterations, 20 * 4.5);
  EXPECT_LE(solves, 20 * 12);
}

struct Following {
  int iterations = 0, solves = 0;  ///< most of any place but the first two
  int all_solves = 0;              ///< of all these places together
};

/// Presses a stiff ball into the same sheet at place after place, each time from `guess` of the
/// last two displacements and of the way from the place before, and compares with the same without
/// a guess.
template <class Guess>
Following follow(const Guess& guess) {
  const Surface s = testing::box<2>(3, 40);
  ActiveSettings<2> settings = testing::sheet_settings(s, StepAccuracy::interactive);
  settings.lambda = 1000;
  const auto quick = testing::active<2>(s, settings);
  settings.accuracy = StepAccuracy::exact;
  const auto exact = testing::active<2>(s, settings);
  Tool ball = testing::ball_above_sheet(5e5);
  ActiveState from{s.control_points()};
  from.balanced = true;
  Points last, older;
  Following result;
  Travel travel{Point::Zero(), Point::Zero()};
  for (int k = 0; k < 8; ++k) {
    travel = {travel.to, Point(0.35 + 0.03 * k, 0.45, 0.075)};
    testing::move_to(ball, travel.to);
    from.guess.resize(0, 3);
    const auto expected = exact.step(from, {&ball, 1});
    if (k > 0) from.guess = guess(s, quick, last, older, travel);
    const auto step = quick.step(from, {&ball, 1});
    EXPECT_TRUE(step && step->converged && expected && expected->converged) << k;
    if (!step || !expected) return result;
    older = std::exchange(last, Points(step->control_points - s.control_points()));
    const Points off = step->control_points - expected->control_points;
    EXPECT_LE(off.cwiseAbs().maxCoeff(), 2e-6 * last.cwiseAbs().maxCoeff()) << k;
    if (k < 2) continue;
    result.iterations = std::max(result.iterations, step->iterations);
    result.solves = std::max(result.solves, step->solves);
    result.all_solves += step->solves;
  }
  return result;
}

// What touches as the contact travels is reckoned with at once, and a direction is not found more
// closely than the contacts are known.
TEST(ContactDirections, FollowAStiffBallFromAPoorGuess) {
  const auto [iterations, solves, all] = follow(
      [](const Surface&, const ActiveSurface&, const Points& last, const Points& older,
         const Travel&) -> Points { return older.rows() > 0 ? Points(2 * last - older) : last; });
  EXPECT_LE(iterations, 8);
  EXPECT_LE(solves, 85);
  EXPECT_LE(all, 6 * 60);
}

TEST(ContactDirections, FollowAStiffBallFromWhereItHasTravelled) {
  const auto [iterations, solves, all] =
      follow([](const Surface& s, const ActiveSurface& model, const Points& last, const Points&,
                const Travel& travel) {
        return model.allowed(
            travelled(s, *SiteValues<2>::create(s, Sites::chebyshev), last, {&travel, 1}));
      });
  EXPECT_LE(iterations, 4);
  EXPECT_LE(solves, 36);
  EXPECT_LE(all, 6 * 33);
}

}  // namespace
}  // namespace knead
