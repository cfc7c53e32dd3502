#include "base/parallel_for.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "knead/base/threads.hpp"
#include "support/sanitized.hpp"
#include "support/thread_counts.hpp"

namespace knead {
namespace {

using detail::block_size;
using detail::parallel_for;
using testing::with_threads;

/// How often each of `count` items is visited, in blocks of `size`.
std::vector<int> visits(std::ptrdiff_t count, std::ptrdiff_t size) {
  std::vector<int> visited(static_cast<std::size_t>(count), 0);
  parallel_for(count, size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t k = begin; k < end; ++k) ++visited[static_cast<std::size_t>(k)];
  });
  return visited;
}

TEST(ParallelFor, VisitsEveryItemOnce) {
  for (const int threads : {1, 2, 3, 7}) {
    for (const std::ptrdiff_t count : {0, 1, 5, 64, 1000}) {
      for (const std::ptrdiff_t size : {1, 3, 64, 2000}) {
        const auto visited = with_threads(threads, [&] { return visits(count, size); });
        EXPECT_EQ(visited, std::vector<int>(static_cast<std::size_t>(count), 1))
            << threads << " " << size;
      }
    }
  }
}

TEST(ParallelFor, BlocksBeginAtMultiplesOfTheirSize) {
  std::mutex mutex;
  std::set<std::pair<std::ptrdiff_t, std::ptrdiff_t>> blocks;
  with_threads(3, [&] {
    parallel_for(23, 5, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      const std::lock_guard lock(mutex);
      blocks.emplace(begin, end);
    });
    return 0;
  });
  EXPECT_EQ(blocks, (std::set<std::pair<std::ptrdiff_t, std::ptrdiff_t>>{
                        {0, 5}, {5, 10}, {10, 15}, {15, 20}, {20, 23}}));
}

TEST(ParallelFor, IsOneCallWithOneThreadOrOneBlock) {
  for (const auto& [threads, size] : {std::pair{1, 5}, {3, 100}}) {
    int calls = 0;
    with_threads(threads, [&] {
      parallel_for(100, size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        ++calls;
        EXPECT_EQ(begin, 0);
        EXPECT_EQ(end, 100);
      });
      return 0;
    });
    EXPECT_EQ(calls, 1);
  }
}

TEST(ParallelFor, SeveralThreadsTakePart) {
  // Every block waits until another thread has come.
  std::atomic<int> arrived = 0;
  std::set<std::thread::id> threads;
  std::mutex mutex;
  with_threads(2, [&] {
    parallel_for(2, 1, [&](std::ptrdiff_t, std::ptrdiff_t) {
      ++arrived;
      while (arrived < 2) std::this_thread::yield();
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
    });
    return 0;
  });
  EXPECT_EQ(threads.size(), 2u);
}

TEST(ParallelFor, RunsInOneThreadWithinABody) {
  std::atomic<int> calls = 0;
  with_threads(3, [&] {
    parallel_for(6, 1, [&](std::ptrdiff_t, std::ptrdiff_t) {
      const auto here = std::this_thread::get_id();
      parallel_for(50, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        ++calls;
        EXPECT_TRUE(begin == 0 && end == 50 && std::this_thread::get_id() == here);
      });
    });
    return 0;
  });
  EXPECT_EQ(calls, 6);
}

TEST(ParallelFor, CarriesWhatABodyThrowsToTheCaller) {
  for (const int threads : {1, 2, 3, 7}) {
    for (const std::ptrdiff_t at : {0, 17, 99}) {
      const auto run = [&] {
        parallel_for(100, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          if (begin <= at && at < end) throw std::runtime_error("item " + std::to_string(at));
        });
        return 0;
      };
      try {
        with_threads(threads, run);
        ADD_FAILURE() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_EQ(error.what(), "item " + std::to_string(at));
      }
      // And the threads serve the next call.
      EXPECT_EQ(with_threads(threads, [] { return visits(50, 1); }), std::vector<int>(50, 1));
    }
  }
}

TEST(ParallelFor, CallsOfSeveralThreadsDoNotDisturbEachOther) {
  with_threads(3, [] {
    std::vector<std::vector<int>> visited(4);
    std::vector<std::thread> callers;
    for (auto& mine : visited) {
      callers.emplace_back([&mine] {
        for (int round = 0; round < 50; ++round) mine = visits(200, 7);
      });
    }
    for (std::thread& caller : callers) caller.join();
    for (const auto& mine : visited) EXPECT_EQ(mine, std::vector<int>(200, 1));
    return 0;
  });
}

TEST(ParallelFor, TheNumberMayChangeFromCallToCall) {
  for (int round = 0; round < 40; ++round) {
    EXPECT_EQ(with_threads(1 + round % 8, [] { return visits(100, 3); }), std::vector<int>(100, 1));
  }
}

/// The exit code of a child that runs `work`.
template <class Work>
int in_child(const Work& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ParallelFor, WorksInAProcessThatForked) {
  const std::vector<int> once(100, 1);
  const auto run = [&] { return visits(100, 1) == once ? 0 : 1; };
  with_threads(3, [&] {
    EXPECT_EQ(run(), 0);
    EXPECT_EQ(in_child([&] { return run() + run(); }), 0);
    EXPECT_EQ(in_child([&] { return in_child(run); }), 0);
    EXPECT_EQ(run(), 0);
    return 0;
  });
}

TEST(ParallelFor, ProcessMayEndWhileThreadsWait) {
  EXPECT_EXIT(
      {
        set_thread_count(3);
        std::exit(visits(100, 1) == std::vector<int>(100, 1) ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(ParallelFor, WhereNoThreadCanBeStartedFewerDoTheWork) {
  if (testing::sanitized()) GTEST_SKIP() << "a sanitizer needs more memory than this limit leaves";
  EXPECT_EQ(in_child([] {
              const rlimit nothing_more{1 << 20, 1 << 20};
              if (setrlimit(RLIMIT_AS, &nothing_more) != 0) return 2;
              set_thread_count(max_thread_count);
              int visited[1000] = {};
              parallel_for(1000, 1, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                for (std::ptrdiff_t k = begin; k < end; ++k) ++visited[k];
              });
              for (const int times : visited) {
                if (times != 1) return 1;
              }
              return 0;
            }),
            0);
}

TEST(BlockSize, DividesOnlyWhatIsWorthIt) {
  static_assert(block_size(100, 1) == 100);
  static_assert(block_size(0, 1) == 1);
  static_assert(block_size(1000, 1000.0) == 1000);
  static_assert(block_size(10000, 1000.0) == 262);
  static_assert(block_size(1000, 1e9) == 16);     // no more than 64 blocks
  static_assert(block_size(1000, 1e9, 6) == 18);  // of whole steps
  SUCCEED();
}

TEST(ThreadCount, IsWhatWasAskedForWithinItsLimits) {
  const int otherwise = thread_count();
  EXPECT_GE(otherwise, 1);
  for (const auto& [asked, given] :
       {std::pair{1, 1}, {7, 7}, {100000, max_thread_count}, {0, otherwise}, {-3, otherwise}}) {
    set_thread_count(asked);
    EXPECT_EQ(thread_count(), given);
  }
  set_thread_count(0);
}

/// Run by the next test in a process of its own, which has another environment.
TEST(ThreadCount, IsTheOneExpected) {
  const char* expected = std::getenv("KNEAD_TEST_EXPECTED_THREADS");
  if (expected == nullptr) GTEST_SKIP() << "run by another test";
  EXPECT_EQ(std::to_string(thread_count()), expected);
}

TEST(ThreadCount, DefaultIsThatOfTheEnvironment) {
  const std::string otherwise = std::to_string(std::max(1u, std::thread::hardware_concurrency()));
  for (const auto& [variable, expected] : {std::pair<const char*, std::string>{"3", "3"},
                                           {"1000", "256"},
                                           {"0", otherwise},
                                           {"three", otherwise}}) {
    SCOPED_TRACE(variable);
    EXPECT_EQ(in_child([&] {
                setenv("KNEAD_THREADS", variable, 1);
                setenv("KNEAD_TEST_EXPECTED_THREADS", expected.c_str(), 1);
                execl("/proc/self/exe", "base_test", "--gtest_filter=ThreadCount.IsTheOneExpected",
                      "--gtest_brief=1", nullptr);
                return 1;
              }),
              0);
  }
}

}  // namespace
}  // namespace knead
