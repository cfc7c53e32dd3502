// Free curves of opened files: selected, sculpted and written back where they stand.
#include <gtest/gtest.h>

#include <filesystem>

#include "knead/exchange/format.hpp"
#include "knead/session/session_info.hpp"
#include "knead/spline/evaluate.hpp"
#include "session/fixes.hpp"
#include "support.hpp"
#include "support/error_codes.hpp"

namespace knead {
namespace {

using testing::fresh;
using testing::refusal;
using testing::run;
using testing::same_bits;
using testing::same_state;

Document document_of(const std::string& bytes, const std::string& name = "curves.step") {
  auto source = open_source(bytes, name);
  if (!source) ADD_FAILURE() << source.error().message();
  return Document::from(*std::move(source));
}

const SceneCurve& shapes(const Session& session, std::size_t k) {
  return std::get<SceneCurve>(session.state().bodies[k]);
}

/// A file of a sheet, a rational circle and a cubic called "rail".
std::string three_of_them() {
  Session session = fresh();
  run(session,
      {R"({"do":"new","size":[4,4]})", R"({"do":"new","shape":"curve","form":"circle","radius":3})",
       R"({"do":"new","shape":"curve","size":5,"net":8,"name":"rail"})"});
  return *session.save();
}

/// The lines of `after` that are not in `before`.
std::vector<std::string> new_lines(const std::string& before, const std::string& after) {
  std::vector<std::string> result;
  for (std::size_t at = 0; at < after.size();) {
    const std::size_t end = std::min(after.find('\n', at), after.size() - 1);
    const std::string line = after.substr(at, end + 1 - at);
    if (before.find(line) == std::string::npos) result.push_back(line);
    at = end + 1;
  }
  return result;
}

TEST(CurveFile, HasItsCurvesAsBodiesAndUntouchedItsBytes) {
  const std::string bytes = three_of_them();
  Session session(document_of(bytes));
  ASSERT_EQ(session.state().bodies.size(), 2U);
  EXPECT_EQ(session.state().selected, 0);
  EXPECT_FALSE(session.state().body);
  EXPECT_EQ(common_of(session.state().bodies[1]).name, "rail");
  EXPECT_EQ(common_of(session.state().bodies[1]).unit, "mm");
  EXPECT_TRUE(shapes(session, 0).current->rational());
  EXPECT_EQ(shapes(session, 1).current->size(), 8);
  EXPECT_EQ(session.save(), bytes);
  // Steps that move nothing write nothing.
  run(session, {R"({"do":"select","body":")" + common_of(session.state().bodies[1]).id + R"("})",
                R"({"do":"step","count":2})"});
  EXPECT_EQ(session.save(), bytes);
}

TEST(CurveFile, AMovedCurveChangesItsOwnPointsAlone) {
  const std::string bytes = three_of_them();
  for (const std::size_t k : {0U, 1U}) {
    SCOPED_TRACE(k);
    Session session(document_of(bytes));
    const std::string id = common_of(session.state().bodies[k]).id;
    run(session,
        {R"({"do":"select","body":")" + id + R"("})",
         R"({"do":"edge","which":"u0","hold":"position"})",
         R"({"do":"force","at":[0.5],"to":[1,2,6],"strength":50})", R"({"do":"step","count":4})"});
    const Curve& moved = *shapes(session, k).current;
    EXPECT_GT((moved.control_points() - shapes(session, k).opened->control_points())
                  .cwiseAbs()
                  .maxCoeff(),
              0.1);
    const auto saved = session.save();
    ASSERT_TRUE(saved) << saved.error().message();
    for (const std::string& line : new_lines(bytes, *saved)) {
      EXPECT_NE(line.find("CARTESIAN_POINT"), std::string::npos) << line;
    }
    const Session again(document_of(*saved));
    EXPECT_TRUE(same_bits(shapes(again, k).current->control_points(), moved.control_points()));
    EXPECT_TRUE(std::ranges::equal(shapes(again, k).current->weights(), moved.weights()));
    EXPECT_TRUE(same_bits(shapes(again, 1 - k).current->control_points(),
                          shapes(session, 1 - k).opened->control_points()));
    EXPECT_EQ(common_of(again.state().bodies[k]).id, id);
  }
}

TEST(CurveFile, ARefinedCurveIsWrittenAnewUnderItsNameAndLabel) {
  const std::string bytes = three_of_them();
  for (const std::size_t k : {0U, 1U}) {
    SCOPED_TRACE(k);
    Session session(document_of(bytes));
    run(session, {R"({"do":"select","body":")" + common_of(session.state().bodies[k]).id + R"("})",
                  R"({"do":"refine"})"});
    const auto saved = session.save();
    ASSERT_TRUE(saved) << saved.error().message();
    const Session again(document_of(*saved));
    ASSERT_EQ(again.state().bodies.size(), 2U);
    const Curve &written = *shapes(again, k).current, &ours = *shapes(session, k).current;
    EXPECT_EQ(written.knots(), ours.knots());
    EXPECT_TRUE(same_bits(written.control_points(), ours.control_points()));
    EXPECT_TRUE(std::ranges::equal(written.weights(), ours.weights()));
    EXPECT_EQ(common_of(again.state().bodies[k]).name, common_of(session.state().bodies[k]).name);
    EXPECT_EQ(common_of(again.state().bodies[k]).id, common_of(session.state().bodies[k]).id);
    // The sheet and the other curve keep their records.
    for (const std::string& line : new_lines(bytes, *saved))
      EXPECT_EQ(line.find("B_SPLINE_SURFACE"), std::string::npos);
  }
}

TEST(CurveFile, SurfacesAndCurvesAreSavedTogetherAndUndone) {
  const std::string bytes = three_of_them();
  Session session(document_of(bytes));
  run(session, {R"({"do":"points","rows_u":[2],"by":[0,0,1]})",
                R"({"do":"select","body":")" + common_of(session.state().bodies[1]).id + R"("})",
                R"({"do":"points","which":[3],"by":[0,0,2]})"});
  const Session again(document_of(*session.save()));
  EXPECT_TRUE(same_bits(shapes(again, 1).current->control_points(),
                        shapes(session, 1).current->control_points()));
  EXPECT_TRUE(same_bits(*again.state().surfaces[0].current, *session.state().surfaces[0].current));
  const auto restored = Session::restore(session.document(), session.snapshot());
  ASSERT_TRUE(restored) << restored.error().message();
  EXPECT_TRUE(same_state(restored->state(), session.state()));
  EXPECT_EQ(*restored->save(), *session.save());
  run(session, {R"({"do":"undo"})", R"({"do":"undo"})", R"({"do":"undo"})"});
  EXPECT_EQ(*session.save(), bytes);
}

TEST(CurveFile, OfOneCurveAloneHasItSelected) {
  Session made = fresh();
  run(made, {R"({"do":"new","shape":"curve","form":"circle","radius":3})"});
  Session session(document_of(*made.save()));
  EXPECT_EQ(session.state().body, 0);
  // As scripts begin: the edges of all faces are held, of which there are none.
  run(session, {R"({"do":"hold","mode":"position","all":true})",
                R"({"do":"tool","radius":1,"position":[2.6,0,0]})", R"({"do":"step","count":4})"});
  EXPECT_GT(largest_displacement(session.state().bodies[0]), 0.1);
  EXPECT_NE(*session.save(), *made.save());
}

TEST(CurveFile, WithoutASurfaceOffersOneOfItsCurves) {
  Session made = fresh();
  run(made, {R"({"do":"new","shape":"curve","size":5,"net":8})",
             R"({"do":"new","shape":"curve","size":5,"net":8})"});
  Session session(document_of(*made.save()));
  const Error error = refusal(session, R"({"do":"limit","distance":1,"relative":true})");
  EXPECT_EQ(testing::code_of(error), ErrorCode::no_spline_surface) << error.message();
  for (const Fix& fix : fixes_for(*error.diagnostic)) EXPECT_TRUE(session.act(fix.commands));
  EXPECT_TRUE(session.state().body);
}

TEST(CurveFile, CurvesOfEdgesAreNotFree) {
  const auto document = Document::open(KNEAD_SOURCE_DIR "/samples/bonnet.step");
  ASSERT_TRUE(document) << document.error().message();
  Session session(*document);
  const std::string bytes = testing::bytes_of(session.document());
  const std::size_t at = bytes.find("B_SPLINE_CURVE_WITH_KNOTS");
  ASSERT_NE(at, std::string::npos);
  const std::size_t begin = bytes.rfind('#', at);
  const std::string id =
      bytes.substr(begin, bytes.find_first_not_of("0123456789", begin + 1) - begin);
  EXPECT_TRUE(session.state().bodies.empty());
  const Error refused = refusal(session, R"({"do":"select","body":")" + id + R"("})");
  EXPECT_NE(refused.what.find("made of the curve " + id), std::string::npos) << refused.message();
  const Error nothing = refusal(session, R"({"do":"select","body":"#1"})");
  EXPECT_NE(nothing.remedy.find("no B-spline curves that stand for themselves"), std::string::npos)
      << nothing.message();
}

TEST(CurveFile, OfRealWorkComesBackWithOneCurveChanged) {
  const std::filesystem::path path = testing::foreign_cad("IEA_15MW_CFD.stp");
  KNEAD_NEEDS(path);
  const auto document = Document::open(path);
  ASSERT_TRUE(document);
  Session session(*document);
  const std::string bytes = testing::bytes_of(session.document());
  ASSERT_EQ(session.state().bodies.size(), 24U);
  EXPECT_EQ(*session.save(), bytes);
  const std::string id = common_of(session.state().bodies[7]).id;
  run(session, {R"({"do":"select","body":")" + id + R"("})",
                R"({"do":"edge","which":"u0","hold":"position"})",
                R"({"do":"edge","which":"u1","hold":"position"})",
                R"({"do":"points","which":[9],"by":[0.25,0,0]})", R"({"do":"step","count":2})"});
  const auto saved = session.save();
  ASSERT_TRUE(saved) << saved.error().message();
  const Session again(document_of(*saved, "blade.stp"));
  for (std::size_t k = 0; k < 24; ++k) {
    EXPECT_TRUE(same_bits(shapes(again, k).current->control_points(),
                          shapes(session, k).current->control_points()))
        << k;
  }
  for (const std::string& line : new_lines(bytes, *saved)) {
    EXPECT_NE(line.find("CARTESIAN_POINT"), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace knead
