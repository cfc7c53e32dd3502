// Described values as bytes, and the same values again; bytes that are none.
#include "session/described_archive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "session/commands/force.hpp"
#include "session/described_state.hpp"

namespace knead {
namespace {

constexpr std::size_t memory = 1 << 20;

std::string written(const Type& type, const void* value, const void* other) {
  StateWriter a("");
  a.write(type, value, other);
  return a.out();
}
template <class T>
std::string written(const T& value, const T& other = T()) {
  return written(type_of<T>(), &value, &other);
}
/// Whether the bytes are a value.
template <class T>
bool reads(std::string_view bytes, T& value, std::size_t most = memory) {
  StateReader a(bytes, most);
  a.read(type_of<T>(), &value);
  return !a.bad() && a.rest().empty();
}

StepRecord step_of(double time, int iterations = 0) {
  StepRecord step;
  step.time = time;
  step.iterations = iterations;
  return step;
}

const Type& steps_of_a_state() { return *type_of<SessionState>().find("steps")->type; }

TEST(DescribedArchive, NumbersKeepTheirBits) {
  StepRecord step;
  step.energy = -0.0;
  step.residual = std::numeric_limits<double>::infinity();
  step.gap = std::bit_cast<double>(0x7ff8000000001234U);  // not a number, with a content
  step.violation = std::numeric_limits<double>::denorm_min();
  step.iterations = std::numeric_limits<int>::min();
  step.load_factor = -0.0;
  step.increments = {0, -1, 23, 24, 255, 256, 65536, std::numeric_limits<int>::max()};
  step.note = "“§”";
  StepRecord again;
  ASSERT_TRUE(reads(written(step), again));
  EXPECT_TRUE(same(type_of<StepRecord>(), &step, &again));
  EXPECT_TRUE(std::signbit(again.energy) && std::signbit(*again.load_factor));
  EXPECT_EQ(std::bit_cast<std::uint64_t>(again.gap), 0x7ff8000000001234U);
}

TEST(DescribedArchive, WhatIsNotWrittenIsAsItWas) {
  StepRecord before, after;
  before.time = after.time = 2;
  before.note = "slow";
  after.energy = 3;
  EXPECT_EQ(written(before, before), "\xa0");
  StepRecord read = before;
  ASSERT_TRUE(reads(written(after, before), read));
  EXPECT_EQ(read, after);
  StepRecord fresh;
  ASSERT_TRUE(reads("\xa0", fresh));
  EXPECT_EQ(fresh, StepRecord());
}

TEST(DescribedArchive, NamesAreWrittenOnceAndUnknownOnesRefused) {
  SharedList<StepRecord> steps;
  for (int k = 0; k < 3; ++k) steps.push_back(step_of(1, k + 1));
  SessionState state, again;
  state.steps = steps;
  const std::string bytes = written(state);
  EXPECT_EQ(bytes.find("iterations"), bytes.rfind("iterations"));
  ASSERT_TRUE(reads(bytes, again));
  EXPECT_EQ(again.steps, steps);
  std::string other = bytes;
  other[bytes.find("iterations")] = 'I';
  EXPECT_FALSE(reads(other, again));
}

TEST(DescribedArchive, ListsKeepWhatTheyHaveInCommon) {
  SessionState before, after;
  for (int k = 0; k < 300; ++k) before.steps.push_back(step_of(k + 0.5));
  after.steps = before.steps;
  after.steps.push_back(step_of(7));
  EXPECT_LT(written(after, before).size(), 40U);
  after.steps.own(5).time = -1;
  after.steps.truncate(200);
  SessionState read = before;
  ASSERT_TRUE(reads(written(after, before), read));
  EXPECT_EQ(read.steps, after.steps);
  EXPECT_EQ(before.steps[5].time, 5.5);
}

TEST(DescribedArchive, LengthsAreNotBelieved) {
  const std::string huge = "\xff\xff\xff\xff\xff\xff\xff\xff", many("\0\0\0\0\x7f\xff\xff\xff", 8);
  for (const std::string& size : {huge, many}) {
    for (const char kind : {'\x3b', '\x5b', '\x7b', '\x9b', '\xbb', '\xdb', '\xfb'}) {
      const std::string item = kind + size;
      std::vector<int> numbers;
      std::vector<double> doubles;
      std::string text;
      StepRecord step;
      int number = 0;
      EXPECT_FALSE(reads(item, numbers));
      EXPECT_FALSE(reads(item, doubles));
      EXPECT_FALSE(reads(item, text));
      EXPECT_FALSE(reads(item, step));
      EXPECT_EQ(reads(item, number), kind == '\x3b' && size == many);  // the least integer
      EXPECT_FALSE(
          reads("\x82" + (kind + size), numbers));  // as the number of those that are known
    }
  }
}

TEST(DescribedArchive, NestingIsThatOfTheDescription) {
  SessionState state;
  EXPECT_FALSE(reads(std::string(1 << 20, '\x81'), state));
  EXPECT_FALSE(reads(std::string(1 << 20, '\xa1'), state));
  std::vector<std::vector<int>> lists;
  EXPECT_FALSE(reads(std::string(1 << 20, '\x82'), lists));
}

TEST(DescribedArchive, MemoryIsLimited) {
  // 65536 empty records.
  std::string bytes = "\x9a" + std::string("\0\x01\0\x01", 4) + std::string(1, '\0');
  bytes += std::string(65536, '\xa0');
  std::vector<StepRecord> steps;
  EXPECT_TRUE(reads(bytes, steps, std::size_t{1} << 30U));
  EXPECT_EQ(steps.size(), 65536U);
  steps.clear();
  EXPECT_FALSE(reads(bytes, steps));
  EXPECT_LE(steps.size() * sizeof(StepRecord), memory);
  SharedList<StepRecord> shared;
  StateReader reader(bytes, memory);
  reader.read(steps_of_a_state(), &shared);
  EXPECT_TRUE(reader.bad());
  EXPECT_LE(shared.size() * sizeof(StepRecord), memory);
}

TEST(DescribedArchive, WhatCopiesShareWeighsOnceAndWhatTheyOwnEachTime) {
  const Type& type = steps_of_a_state();
  SharedList<StepRecord> steps;
  for (int k = 0; k < 300; ++k) steps.push_back(step_of(k));
  SharedList<StepRecord> copy = steps;
  Weight weight;
  EXPECT_GE(weight.of(type, &steps), 300 * sizeof(StepRecord));
  EXPECT_LE(weight.of(type, &copy), 64U);
  copy.own(5).time = -1;  // 128 of them are the copy's own now
  const std::size_t bytes = weight.of(type, &copy);
  EXPECT_GE(bytes, 128 * sizeof(StepRecord));
  EXPECT_LT(bytes, 256 * sizeof(StepRecord));
}

TEST(DescribedArchive, ForcesAreCheckedWhereverTheyComeFrom) {
  ForceCommand c{.kind = ForceKind::volcano, .at = std::vector{0.5, 0.5}, .to = {{0, 0, 1}}};
  EXPECT_TRUE(force_of(c));
  c.core = 0;
  EXPECT_EQ(force_of(c).error().where, "core");
  c.core = 1;
  c.strength = -1e300;
  EXPECT_EQ(force_of(c).error().where, "strength");
}

}  // namespace
}  // namespace knead
