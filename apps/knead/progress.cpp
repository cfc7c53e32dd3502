#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "knead/base/printable.hpp"
#include "say.hpp"

namespace knead::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void remember_interrupt(int) {
  interrupted = 1;
  std::signal(SIGINT, SIG_DFL);
}

}  // namespace

ProgressLine::ProgressLine()
    : terminal_(isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()),
      shown_(start_) {}

ProgressLine::~ProgressLine() {
  if (shown_ > start_) say(stderr, "\r\x1b[K");
}

void ProgressLine::show(const char* what, std::size_t count, std::size_t total) {
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || now - start_ < std::chrono::seconds(1) ||
      now - shown_ < std::chrono::milliseconds(100))
    return;
  print(fmt::format("{} {} of {}", what, count, total));
}

void ProgressLine::announce(const std::string& what) {
  if (terminal_) print(what);
}

void ProgressLine::print(const std::string& text) {
  shown_ = std::chrono::steady_clock::now();
  say(stderr, "\r\x1b[K{} ", text);
  std::fflush(stderr);
}

void announce_reading(ProgressLine& line, const std::string& name) {
  constexpr std::uintmax_t large = 8U << 20U;
  std::error_code failed;
  const std::uintmax_t size = std::filesystem::file_size(name, failed);
  if (!failed && size >= large)
    line.announce(fmt::format("reading {}, {} MB", printable(name, 60), size >> 20U));
}

Interrupt::Interrupt() { std::signal(SIGINT, remember_interrupt); }

bool Interrupt::asked() { return interrupted != 0; }

void Interrupt::pass_on() {
  if (!asked()) return;
  std::signal(SIGINT, SIG_DFL);
  std::raise(SIGINT);
}

}  // namespace knead::cli
