#include "base/shared_list.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace knead {
namespace {

SharedList<std::string> numbers(std::size_t count) {
  SharedList<std::string> list;
  for (std::size_t k = 0; k < count; ++k) list.push_back(std::to_string(k));
  return list;
}

TEST(SharedList, IsTheListOfWhatWasAppended) {
  for (const std::size_t n : {0U, 1U, 127U, 128U, 129U, 1000U}) {
    const SharedList<std::string> list = numbers(n);
    ASSERT_EQ(list.size(), n);
    EXPECT_EQ(list.empty(), n == 0);
    std::size_t k = 0;
    for (const std::string& item : list) EXPECT_EQ(item, std::to_string(k++));
    EXPECT_EQ(k, n);
    if (n > 0) {
      EXPECT_EQ(list.back(), std::to_string(n - 1));
    }
  }
}

TEST(SharedList, CopiesDoNotSeeEachOthersChanges) {
  for (const std::size_t n : {1U, 127U, 128U, 200U}) {
    SharedList<std::string> one = numbers(n), two = one, three = one;
    one.push_back("one");
    two.push_back("two");
    three.own(n - 1) = "changed";
    EXPECT_EQ(one[n], "one");
    EXPECT_EQ(two[n], "two");
    EXPECT_EQ(one[n - 1], std::to_string(n - 1));
    EXPECT_EQ(three.back(), "changed");
    EXPECT_EQ(three.size(), n);
  }
}

TEST(SharedList, CopiesHaveTheSameItems) {
  const SharedList<std::string> list = numbers(1000);
  SharedList<std::string> copy = list;
  copy.push_back("more");
  EXPECT_EQ(&list[0], &copy[0]);
  EXPECT_EQ(&list[800], &copy[800]);
}

TEST(SharedList, IsCutWhereItIsAskedTo) {
  for (const std::size_t n : {0U, 1U, 127U, 128U, 129U, 300U}) {
    const SharedList<std::string> list = numbers(300);
    SharedList<std::string> cut = list;
    cut.truncate(n);
    EXPECT_EQ(cut, numbers(n));
    cut.push_back("next");
    EXPECT_EQ(cut.back(), "next");
    EXPECT_EQ(list, numbers(300));
  }
}

TEST(SharedList, ListsAreEqualIfTheirItemsAre) {
  EXPECT_EQ(numbers(130), numbers(130));
  EXPECT_NE(numbers(130), numbers(129));
  SharedList<std::string> other = numbers(130);
  other.own(3) = "x";
  EXPECT_NE(numbers(130), other);
}

}  // namespace
}  // namespace knead
