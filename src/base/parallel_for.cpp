#include "parallel_for.hpp"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <exception>
#include <mutex>
#include <vector>

#include "knead/base/threads.hpp"
#include "parallel_order.hpp"

namespace knead::detail {
namespace {

/// Whether this thread runs a body now.
thread_local bool inside = false;

/// One call of `run_blocks`.
///
/// Blocks are taken from an atomic counter, by whoever is free: loads of different size balance
/// themselves. Relaxed order suffices for it, since the mutex of the pool orders the beginning and
/// the end of a loop.
class Loop {
 public:
  Loop(std::ptrdiff_t count, std::ptrdiff_t size,
       void (*body)(const void*, std::ptrdiff_t, std::ptrdiff_t), const void* context, int threads)
      : count_(count),
        size_(size),
        body_(body),
        context_(context),
        thrown_(static_cast<std::size_t>(threads)) {}

  /// Does blocks until none is left. `thread` counts those that take part.
  void take_part(int thread) noexcept {
    inside = true;
#ifdef __cpp_exceptions
    try {
      do_blocks();
    } catch (...) {
      thrown_[static_cast<std::size_t>(thread)] = std::current_exception();
      next_.store(count_, std::memory_order_relaxed);
    }
#else
    static_cast<void>(thread);
    do_blocks();
#endif
    inside = false;
  }

  /// Throws what a body has thrown.
  void finish() const {
    for (const std::exception_ptr& thrown : thrown_) {
      if (thrown) std::rethrow_exception(thrown);
    }
  }

 private:
  void do_blocks() {
    for (;;) {
      const std::ptrdiff_t begin = next_.fetch_add(size_, std::memory_order_relaxed);
      if (begin >= count_) return;
      body_(context_, begin, std::min(begin + size_, count_));
    }
  }

  std::ptrdiff_t count_, size_;
  void (*body_)(const void*, std::ptrdiff_t, std::ptrdiff_t);
  const void* context_;
  std::atomic<std::ptrdiff_t> next_ = 0;
  std::vector<std::exception_ptr> thrown_;
};

/// Threads that wait for loops. It is never destroyed, and they are never joined: they wait when
/// the process ends.
///
/// One loop at a time: whoever finds the pool busy does its loop alone, without waiting, so that
/// threads of a program cannot block each other. Helpers that come after the last block find none
/// and leave.
class Pool {
 public:
  /// Runs the loop with up to that many helpers beside this thread; false, with nothing done, where
  /// another thread of the program does so at this time.
  bool run(Loop& loop, int helpers) {
    const std::unique_lock owner(owner_, std::try_to_lock);
    if (!owner) return false;
    while (size_ < helpers && start()) ++size_;
    helpers = std::min(helpers, size_);
    {
      const std::lock_guard lock(mutex_);
      loop_ = &loop;
      wanted_ = helpers;
      joined_ = 0;
    }
    for (int k = 0; k < helpers; ++k) wake_.notify_one();
    loop.take_part(0);
    std::unique_lock lock(mutex_);
    wanted_ = 0;  // who has not come by now need not come any more
    left_.wait(lock, [this] { return working_ == 0; });
    loop_ = nullptr;
    return true;
  }

  Pool* abandoned = nullptr;  ///< in the process that this one forked from

 private:
  /// By pthread_create, which returns its failure as a value also where there are no exceptions.
  bool start() {
    pthread_attr_t detached;
    if (pthread_attr_init(&detached) != 0) return false;
    pthread_attr_setdetachstate(&detached, PTHREAD_CREATE_DETACHED);
    // Signals are for the threads of the program.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    pthread_t thread;
    const auto help = [](void* pool) -> void* { static_cast<Pool*>(pool)->help(); };
    const bool started = pthread_create(&thread, &detached, help, this) == 0;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    pthread_attr_destroy(&detached);
    return started;
  }

  // Joined and left under the mutex: `run` returns only when nobody is inside, as the loop lives on
  // its stack.
  [[noreturn]] void help() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return wanted_ > 0; });
      --wanted_;
      ++working_;
      Loop& loop = *loop_;
      const int number = ++joined_;
      lock.unlock();
      loop.take_part(number);
      lock.lock();
      if (--working_ == 0) left_.notify_one();
    }
  }

  std::mutex owner_;  // who runs a loop
  int size_ = 0;      // its: threads that were started
  std::mutex mutex_;  // the rest
  std::condition_variable wake_, left_;
  Loop* loop_ = nullptr;
  int wanted_ = 0, joined_ = 0,
      working_ = 0;  // helpers that may still come, have come, and have not left
};

std::atomic<Pool*> current = nullptr;

/// A child has none of its parent's threads, and what they held stays held: it starts with a pool
/// of its own. The old one is kept in sight of those who look for leaks.
void abandon() {
  Pool* const old = current.load();
  if (old == nullptr) return;
  auto* const fresh = new Pool;
  fresh->abandoned = old;
  current.store(fresh);
}
[[maybe_unused]] const int registered = pthread_atfork(nullptr, nullptr, abandon);

// Made without a lock and without a static's guard: a fork in between would leave either locked in
// the child for ever. Of two threads that make one, one pool is deleted.
Pool& pool() {
  Pool* known = current.load(std::memory_order_acquire);
  if (known != nullptr) return *known;
  auto* const made = new Pool;
  if (current.compare_exchange_strong(known, made)) return *made;
  delete made;
  return *known;
}

}  // namespace

void give_way() { sched_yield(); }

void run_blocks(std::ptrdiff_t count, std::ptrdiff_t size,
                void (*body)(const void*, std::ptrdiff_t, std::ptrdiff_t), const void* context) {
  const int threads =
      static_cast<int>(std::min<std::ptrdiff_t>(thread_count(), (count + size - 1) / size));
  if (threads > 1 && !inside) {
    Loop loop(count, size, body, context, threads);
    if (pool().run(loop, threads - 1)) return loop.finish();
  }
  body(context, 0, count);
}

}  // namespace knead::detail
