// How far what is no press may move a surface: the laws that docs/active-model.md, docs/brushes.md
// and docs/scripts.md state of attraction, forces, loads, the rest mode `none`, brushes and control
// points that are placed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "knead/energy/domain_scaling.hpp"
#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::first;
using testing::fresh;
using testing::run;

const char* const square = R"({"do":"new","size":[10,10],"net":[14,14]})";
const char* const held = R"({"do":"hold","rows":1})";

Point way(const Session& session, double s, double t) {
  return at(*first(session).current, s, t) - at(*first(session).opened, s, t);
}

/// √(mean of |u|²) over the parameters, of samples in the middle of cells, in lengths of the model.
double mean_displacement(const Session& session) {
  constexpr int cells = 60;
  double sum = 0;
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j)
      sum += way(session, (i + 0.5) / cells, (j + 0.5) / cells).squaredNorm();
  }
  return std::sqrt(sum) / cells / normalised_scaling<2>(*first(session).reference)->length;
}

/// The area of the domain as the model scales it.
double model_area(const Session& session) {
  const Surface& s = *first(session).reference;
  const auto scaling = normalised_scaling<2>(s);
  return scaling->factors[0] * s.knots(0).domain().length() * scaling->factors[1] *
         s.knots(1).domain().length();
}

TEST(OwnLaws, AttractionMovesByNoMoreThanTheRangeTimesARootInTheMean) {
  for (const auto& [stiffness, lambda] : {std::pair{1., 20.}, {100., 20.}, {100., 1.}}) {
    Session session = fresh();
    run(session,
        {square, held,
         fmt::format(
             R"({{"do":"tool","name":"b","mode":"proximity","radius":2,"range":1.5,"stiffness":{},)"
             R"("position":[5,5,3]}})",
             stiffness),
         fmt::format(R"({{"do":"step","lambda":{}}})", lambda)});
    const double range = 1.5 / normalised_scaling<2>(*first(session).reference)->length;
    EXPECT_GT(session.largest_displacement(0), 0);
    EXPECT_LE(mean_displacement(session), range * std::sqrt(stiffness / (3 * lambda)));
  }
}

TEST(OwnLaws, AStepOfAShapeWithoutRestMovesByWhatItsEnergyLoses) {
  for (const double lambda : {0.5, 5., 50.}) {
    Session session = fresh();
    run(session, {square, held, R"({"do":"points","which":[90,91,105],"by":[0,0,2]})",
                  R"({"do":"rest","mode":"none"})"});
    const Surface before = *first(session).current;
    run(session, {fmt::format(R"({{"do":"step","lambda":{}}})", lambda)});
    double sum = 0;
    constexpr int cells = 60;
    for (int i = 0; i < cells; ++i) {
      for (int j = 0; j < cells; ++j) {
        const double s = (i + 0.5) / cells, t = (j + 0.5) / cells;
        sum += (at(*first(session).current, s, t) - at(before, s, t)).squaredNorm();
      }
    }
    const double length = normalised_scaling<2>(*first(session).reference)->length;
    const double lost = *session.state().energy_before - session.state().steps.back().energy;
    EXPECT_GT(lost, 0);
    EXPECT_LE(lambda * model_area(session) * sum / (cells * cells * length * length), 1.01 * lost)
        << lambda;
  }
}

TEST(OwnLaws, ASpringDrawsItsPointTowardsItsTargetAndNotBeyond) {
  for (const double strength : {1., 100., 1e6}) {
    Session session = fresh();
    run(session,
        {square, held,
         fmt::format(R"({{"do":"force","at":[0.4,0.5],"to":[4.5,5.5,2],"strength":{}}})", strength),
         R"({"do":"step","count":8})"});
    const Point asked = Point(4.5, 5.5, 2) - at(*first(session).opened, 0.4, 0.5),
                gone = way(session, 0.4, 0.5);
    EXPECT_GT(gone.dot(asked), 0);
    EXPECT_LE(gone.norm(), asked.norm() * (1 + 1e-9)) << strength;
    EXPECT_LT(gone.cross(asked).norm(), 1e-6 * asked.squaredNorm());
  }
}

TEST(OwnLaws, DeadForcesAndLoadsMoveInProportion) {
  const auto moved = [](const std::string& what) {
    Session session = fresh();
    run(session, {square, held, what, R"({"do":"step","count":3})"});
    return Points(first(session).current->control_points() -
                  first(session).opened->control_points());
  };
  for (const char* const what :
       {R"({{"do":"force","kind":"dead","at":[0.4,0.5],"vector":[0,{},{}]}})",
        R"({{"do":"load","vector":[0,{},{}]}})"}) {
    const Points once = moved(fmt::format(fmt::runtime(what), 0.1, 0.3));
    const Points thrice = moved(fmt::format(fmt::runtime(what), 0.3, 0.9));
    EXPECT_GT(once.norm(), 0);
    EXPECT_LT((thrice - 3 * once).norm(), 1e-9 * thrice.norm()) << what;
  }
}

TEST(OwnLaws, AVolcanoPushesNoHarderThanItsCoreAllows) {
  const auto moved = [](const std::string& what) {
    Session session = fresh();
    run(session, {square, held, what, R"({"do":"step"})"});
    return way(session, 0.4, 0.5).norm();
  };
  // in units of the model, those of a sheet of 10 × 10
  for (const double below : {0.05, 0.5, 1.}) {
    const double volcano = moved(fmt::format(
        R"({{"do":"force","kind":"volcano","at":[0.4,0.5],"to":[4,5,{}],"strength":0.1,)"
        R"("core":0.5}})",
        -below));
    Session session = fresh();
    run(session, {square});
    const double core = 0.5 / normalised_scaling<2>(*first(session).reference)->length;
    const double most = 0.1 * 2 / (3 * std::sqrt(3)) / (core * core);
    const double dead = moved(fmt::format(
        R"({{"do":"force","kind":"dead","at":[0.4,0.5],"vector":[0,0,{:.17g}]}})", most));
    EXPECT_GT(volcano, 0);
    EXPECT_LE(volcano, dead * (1 + 1e-6)) << below;
  }
}

TEST(OwnLaws, NoPointOfASurfaceGoesFurtherThanTheControlPointsThatArePlaced) {
  Session session = fresh();
  run(session, {R"({"do":"new","shape":"sphere"})",
                R"({"do":"points","which":[12,17],"by":[0.1,0.2,-0.2]})"});
  EXPECT_GT(session.largest_displacement(0), 0.01);
  EXPECT_LE(session.largest_displacement(0), 0.3 * (1 + 1e-12));
}

TEST(OwnLaws, ATwistGoesNoFurtherThanTheChordAtItsRim) {
  for (const double degrees : {20., 90., 170., 270.}) {
    Session session = testing::on_sheet();
    run(session,
        {fmt::format(R"({{"do":"brush","kind":"twist","radius":3,"angle":{},"path":[[0.5,0.5]]}})",
                     degrees)});
    const double half = 0.5 * std::min(degrees, 180.) * std::numbers::pi / 180;
    EXPECT_GT(session.largest_displacement(0), 0.05);
    EXPECT_LE(session.largest_displacement(0), 1.05 * 2 * 3 * std::sin(half)) << degrees;
  }
}

TEST(OwnLaws, ASmoothingBrushGoesNoFurtherThanTheBumpIsHighAndLowersIt) {
  const auto height = [](const Surface& s) { return s.control_points().col(2).maxCoeff(); };
  for (const double strength : {0.3, 1.}) {
    Session session = testing::on_sheet(
        {R"({"do":"points","which":[44,45,54,55],"by":[0,0,0.5]})", R"({"do":"rest"})"});
    const Surface before = *first(session).current;
    run(session,
        {fmt::format(
            R"({{"do":"brush","kind":"smooth","radius":4,"strength":{},"path":[[0.5,0.5]]}})",
            strength)});
    double most = 0;
    for (int k = 0; k <= 40; ++k) {
      for (int l = 0; l <= 40; ++l) {
        most = std::max(
            most,
            (at(*first(session).current, k / 40., l / 40.) - at(before, k / 40., l / 40.)).norm());
      }
    }
    EXPECT_GT(most, 0);
    EXPECT_LE(most, 1.05 * strength * 0.5);
    EXPECT_LT(height(*first(session).current), height(before));
  }
}

TEST(OwnLaws, RelaxingLowersABumpAndMovesNothingBeyondItsRadius) {
  Session session = testing::on_sheet({R"({"do":"refine","region":[[0,1],[0,1]]})",
                                       R"({"do":"points","rows_u":[8],"by":[0,0,0.5]})"});
  const Points before = first(session).current->control_points();
  run(session, {R"({"do":"relax","at":[0.5,0.5],"radius":3,"strength":0.7})"});
  const Points after = first(session).current->control_points();
  double most = 0;
  for (Eigen::Index i = 0; i < before.rows(); ++i) {
    const double moved = (after.row(i) - before.row(i)).norm();
    most = std::max(most, moved);
    if ((before.row(i).head<2>() - Eigen::RowVector2d(5, 5)).norm() > 4) {
      EXPECT_EQ(moved, 0) << i;
    }
  }
  EXPECT_GT(most, 0);
  EXPECT_LE(most, 0.5);
}

}  // namespace
}  // namespace knead
