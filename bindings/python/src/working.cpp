#include "working.hpp"

#include <unistd.h>

namespace knead::python {

OneAtATime::Taken::Taken(OneAtATime& of) : of_(of) {
  const std::thread::id owner = of_.owner_.load();
  if (owner != std::thread::id()) {
    const bool forked = of_.process_.load() != ::getpid();
    if (forked)
      throw std::runtime_error(
          "another thread was at work on this session when the process forked");
    if (owner == std::this_thread::get_id()) {
      throw std::runtime_error(
          "a callback must not use the session that calls it: do so after the call");
    }
  }
  others_.emplace();
  while (!of_.mutex_.try_lock_for(std::chrono::milliseconds(50))) {
    others_.reset();
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    others_.emplace();
  }
  of_.process_.store(::getpid());
  of_.owner_.store(std::this_thread::get_id());
}

OneAtATime::Taken::~Taken() {
  of_.owner_.store({});
  of_.mutex_.unlock();
}

Work::Work(py::object progress) : progress_(std::move(progress)) {}

bool Work::tell(int count, int all) {
  if (stopped_ || progress_.is_none()) return go_on();
  const py::gil_scoped_acquire interpreter;
  try {
    const py::object answer = progress_(count, all);
    stopped_ = answer.ptr() == Py_False;
  } catch (py::error_already_set& raised) {
    raised_.emplace(std::move(raised));
    stopped_ = true;
  }
  return !stopped_ && look_for_signals();
}

bool Work::go_on() {
  if (stopped_) return false;
  constexpr auto pause = std::chrono::milliseconds(20);
  const auto now = std::chrono::steady_clock::now();
  if (now < next_) return true;
  const py::gil_scoped_acquire interpreter;
  next_ = now + pause;
  return look_for_signals();
}

bool Work::look_for_signals() {
  if (PyErr_CheckSignals() == 0) return true;
  raised_.emplace();
  stopped_ = true;
  return false;
}

void Work::finish() {
  if (!raised_) return;
  raised_->restore();
  raised_.reset();
  throw py::error_already_set();
}

}  // namespace knead::python
