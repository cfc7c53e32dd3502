#include <gtest/gtest.h>

#include "sheet.hpp"

namespace knead {
namespace {

using testing::at;
using testing::fresh;
using testing::new_sheet;
using testing::refusal;
using testing::run;

TEST(Command, SeamsKeepPatchesTogetherOrLetThemTear) {
  // Two sheets on the same place: all four edges of one lie on those of the other.
  const auto apart = [](const std::vector<std::string>& more) {
    Session session = fresh();
    run(session, {new_sheet, new_sheet, R"({"do":"select","surface":"#1","connected":true})"});
    EXPECT_EQ(session.state().selection(), (std::vector<int>{0, 1}));
    run(session, {R"({"do":"force","at":[0,0.5],"to":[0,5,3],"strength":50})"});
    run(session, more);
    run(session, {R"({"do":"step","count":3})"});
    double gap = 0;
    for (double t : {0.1, 0.5, 0.8}) {
      gap = std::max(gap, (at(*session.state().surfaces[0].current, 0, t) -
                           at(*session.state().surfaces[1].current, 0, t))
                              .norm());
    }
    EXPECT_GT(session.largest_displacement(0), 0.1);
    return gap;
  };
  EXPECT_LT(apart({}), 1e-12 * 14);
  EXPECT_GT(apart({R"({"do":"seams","couple":false})"}), 0.01);
  Session session = fresh();
  EXPECT_EQ(refusal(session, R"({"do":"seams","tolerance":0})").where, "tolerance");
}

TEST(Command, SeamReportsNameSurfacesWhateverIsSelectedLater) {
  Session session = fresh();
  run(session, {R"({"do":"new","size":[5,5]})", new_sheet, new_sheet,
                R"({"do":"select","surfaces":["#2","#3"]})", R"({"do":"step"})",
                R"({"do":"select","surface":"#1"})"});
  ASSERT_FALSE(session.state().seam_reports.empty());
  for (const SeamReport& report : session.state().seam_reports) {
    EXPECT_EQ(report.seam.a.patch, 1);
    EXPECT_EQ(report.seam.b.patch, 2);
  }
}

}  // namespace
}  // namespace knead
