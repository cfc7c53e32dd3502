// What is stopped within a step, and lists of surfaces that states share.

#include "base/interruption.hpp"

#include <gtest/gtest.h>

#include "knead/solve/sparse_cholesky.hpp"
#include "sheet.hpp"

namespace knead::testing {
namespace {

/// Executes a command that is stopped when it asks for the n-th time whether to go on; returns how
/// often it asked.
struct Asked {
  long long count = 0;
  Expected<void> status;
};
Asked stopped_at(Session& session, const std::string& text, long long n) {
  Asked asked;
  const auto command = parse_command(text);
  EXPECT_TRUE(command) << text;
  asked.status = session.execute(*command, {}, [&] { return ++asked.count < n; });
  return asked;
}

constexpr long long never = 1LL << 60;

void expect_same_shape(const Session& a, const Session& b) {
  EXPECT_EQ(first(a).current->control_points(), first(b).current->control_points());
  EXPECT_EQ(first(a).rest->control_points(), first(b).rest->control_points());
  EXPECT_EQ(a.state().steps.size(), b.state().steps.size());
}

TEST(Interruption, WithinAStepKeepsTheStepsBefore) {
  const std::string steps = R"({"do":"step","count":4})";
  Session whole = on_sheet({ball});
  const Asked all = stopped_at(whole, steps, never);
  ASSERT_TRUE(all.status);
  EXPECT_GT(all.count, 100);
  std::size_t last = 4;
  for (const double share : {0.95, 0.85, 0.7}) {
    Session session = on_sheet({ball});
    const auto at = static_cast<long long>(share * static_cast<double>(all.count));
    const Asked asked = stopped_at(session, steps, at);
    EXPECT_EQ(asked.count, at) << "nobody asks again";
    if (!asked.status) continue;  // the first step
    const std::size_t made = session.state().steps.size();
    ASSERT_GE(made, 1U);
    ASSERT_LE(made, last);
    last = made;
    Session same = on_sheet({ball, R"({"do":"step","count":)" + std::to_string(made) + "}"});
    expect_same_shape(session, same);
    // It goes on as if nothing had happened.
    run(session, {R"({"do":"step"})"});
    run(same, {R"({"do":"step"})"});
    expect_same_shape(session, same);
  }
  EXPECT_LT(last, 4U);
}

TEST(Interruption, OfTheFirstStepAndOfOtherCommandsChangesNothing) {
  const std::vector<std::string> commands = {
      R"({"do":"step","count":3})", R"({"do":"drag","at":[0.5,0.5],"by":[0,0,1],"steps":3})",
      R"({"do":"lattice","steps":2})",
      R"({"do":"stroke","tool":"ball","path":[[4,4,-1.5],[6,6,-1.5]]})"};
  for (const std::string& text : commands) {
    Session whole = on_sheet({ball});
    const Asked all = stopped_at(whole, text, never);
    ASSERT_TRUE(all.status) << text << all.status.error().message();
    ASSERT_GT(all.count, 10) << text;
    for (const long long at : {1LL, 2LL, all.count / 5}) {
      Session session = on_sheet({ball});
      const auto before = session.journal().size();
      const auto shape = first(session).current;
      const Asked asked = stopped_at(session, text, at);
      if (at > 2 && asked.status) continue;  // a later step
      ASSERT_FALSE(asked.status) << text;
      EXPECT_NE(asked.status.error().what.find("stopped"), std::string::npos)
          << asked.status.error().message();
      EXPECT_EQ(session.journal().size(), before);
      EXPECT_EQ(first(session).current, shape);
      EXPECT_TRUE(session.state().steps.empty());
      ASSERT_TRUE(stopped_at(session, text, never).status);
      expect_same_shape(session, whole);
    }
  }
}

TEST(Interruption, IsAskedForThroughoutAFactorisation) {
  constexpr int size = 400;
  SparseMatrix a(size, size);
  for (int k = 0; k < size; ++k) {
    a.insert(k, k) = 4;
    for (const int other : {k + 1, k + 20}) {
      if (other < size) a.insert(other, k) = -1;
    }
  }
  long long asked = 0;
  {
    const Interruption counts([&] { return ++asked > 0; });
    EXPECT_TRUE(SparseCholesky::factor(a));
    EXPECT_FALSE(counts.happened());
  }
  EXPECT_GT(asked, size / 4);
  const Interruption stops([&] { return --asked > 20; });
  EXPECT_FALSE(SparseCholesky::factor(a));
  EXPECT_TRUE(stops.happened());
  EXPECT_EQ(asked, 20);
}

TEST(Interruption, IsTheInnermostOne) {
  EXPECT_FALSE(Interruption::asked_for());
  const Interruption outer([] { return false; });
  {
    const Interruption inner({});
    EXPECT_FALSE(Interruption::asked_for());
  }
  EXPECT_TRUE(Interruption::asked_for());
  Interruption::settle();
  EXPECT_FALSE(Interruption::asked_for());
}

TEST(SharedItems, AreSharedByStatesUntilTheyChange) {
  Session session = fresh();
  for (int k = 0; k < 20; ++k) run(session, {new_sheet});
  ASSERT_EQ(session.state().surfaces.size(), 20U);
  const SharedItems<SceneSurface> before = session.state().surfaces;
  run(session, {R"({"do":"select","surface":")" + before[7].id + R"("})", ball, R"({"do":"step"})",
                R"({"do":"tool","name":"other","radius":1,"position":[1,1,3]})"});
  const SharedItems<SceneSurface>& after = session.state().surfaces;
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(&before[k] == &after[k], k != 7) << k;
  SharedItems<int> list, copy;
  for (int k = 0; k < 3; ++k) list.push_back(k);
  copy = list;
  EXPECT_EQ(&std::as_const(list)[1], &std::as_const(copy)[1]);
  copy[1] = 5;
  EXPECT_EQ(std::vector<int>(list.begin(), list.end()), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(std::vector<int>(copy.begin(), copy.end()), (std::vector<int>{0, 5, 2}));
  EXPECT_FALSE(list == copy);
  copy[1] = 1;
  EXPECT_TRUE(list == copy);
}

}  // namespace
}  // namespace knead::testing
