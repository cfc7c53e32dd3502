#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>

#include <sys/types.h>

#include "binding.hpp"

namespace knead::python {

/// What one thread at a time may use. The interpreter's lock is not held while another thread is
/// waited for.
class OneAtATime {
 public:
  /// Takes it for this thread, and gives the interpreter to others for as long as this lives.
  /// Raises `RuntimeError` where this thread has it already (a callback that calls the session
  /// which called it), and where another thread had it as the process forked. Ctrl+C ends the
  /// waiting.
  class Taken {
   public:
    explicit Taken(OneAtATime& of);
    Taken(const Taken&) = delete;
    Taken& operator=(const Taken&) = delete;
    ~Taken();

   private:
    OneAtATime& of_;
    std::optional<py::gil_scoped_release> others_;
  };

 private:
  std::timed_mutex mutex_;
  std::atomic<std::thread::id> owner_{};
  std::atomic<pid_t> process_ = 0;
};

/// Long work: it tells its progress and can be stopped, by Ctrl+C, by the callback, and by what
/// that raises. Used while the interpreter is others'.
class Work {
 public:
  /// \param progress called with the numbers of steps done and to do; false stops. None: nobody is
  /// told
  explicit Work(py::object progress);

  /// False: stop.
  bool tell(int count, int all);
  /// Asked often; looks for signals every 20 ms.
  bool go_on();
  /// Whether it was stopped.
  [[nodiscard]] bool stopped() const { return stopped_; }
  /// Raises what stopped it, unchanged. With the interpreter.
  void finish();

 private:
  bool look_for_signals();

  py::object progress_;
  std::optional<py::error_already_set> raised_;
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
  bool stopped_ = false;
};

}  // namespace knead::python
