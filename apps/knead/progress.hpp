#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace knead::cli {

/// A line on standard error that says how far the work has come, when that is a terminal and the
/// work has taken more than a second; removed at the end.
class ProgressLine {
 public:
  ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();

  /// "step 12 of 60"
  void show(const char* what, std::size_t count, std::size_t total);
  /// At once, before work that cannot tell: "reading wing.step, 105 MB".
  void announce(const std::string& what);

 private:
  void print(const std::string& text);

  bool terminal_;
  std::chrono::steady_clock::time_point start_, shown_;
};

/// Announces that a file is read, where that takes a while.
void announce_reading(ProgressLine& line, const std::string& name);

/// From its construction on, Ctrl+C asks to stop instead of ending the program; a second one ends
/// it at once.
class Interrupt {
 public:
  Interrupt();
  [[nodiscard]] static bool asked();
  /// Ends the program as Ctrl+C would have, if it was pressed, so that whoever started it knows.
  static void pass_on();
};

}  // namespace knead::cli
