#include "environment.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "knead/base/instruction_set.hpp"
#include "knead/base/printable.hpp"
#include "knead/base/threads.hpp"

namespace knead::cli {
namespace {

Expected<void> check_instruction_set() {
  const char* const variable = std::getenv("KNEAD_INSTRUCTION_SET");
  if (variable == nullptr) return {};
  std::string names;
  for (const InstructionSet set : available_instruction_sets()) {
    if (name(set) == variable) return {};
    names += (names.empty() ? "" : ", ") + std::string(name(set));
  }
  return usage_error(
      fmt::format("\"{}\" is no instruction set of this machine", printable(variable, 40)),
      "KNEAD_INSTRUCTION_SET", "use one of " + names + ", or leave it out");
}

Expected<void> check_threads() {
  const char* const variable = std::getenv("KNEAD_THREADS");
  if (variable == nullptr) return {};
  const std::string_view text = variable;
  int count = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (failed == std::errc() && end == text.data() + text.size() && count > 0 &&
      count <= max_thread_count)
    return {};
  return usage_error(fmt::format("\"{}\" is no number of threads", printable(variable, 40)),
                     "KNEAD_THREADS",
                     fmt::format("use 1 to {}, or leave it out", max_thread_count));
}

}  // namespace

Expected<void> check_environment() {
  if (auto known = check_instruction_set(); !known) return known;
  return check_threads();
}

Error out_of_memory(const std::string& place) {
  rlimit allowed{RLIM_INFINITY, RLIM_INFINITY};
  getrlimit(RLIMIT_AS, &allowed);
  const auto machine = static_cast<std::uint64_t>(std::max(0L, sysconf(_SC_PHYS_PAGES))) *
                       static_cast<std::uint64_t>(std::max(0L, sysconf(_SC_PAGESIZE)));
  const bool limited =
      allowed.rlim_cur != RLIM_INFINITY && (machine == 0 || allowed.rlim_cur < machine);
  const std::string enough =
      limited       ? fmt::format("more than the {} MiB that it may use", allowed.rlim_cur >> 20U)
      : machine > 0 ? fmt::format("more than the {} MiB of this machine", machine >> 20U)
                    : "more than there is";
  return {ErrorKind::numerical, "the memory is not enough: " + enough + " would be", place,
          "use a smaller net, model or count"};
}

}  // namespace knead::cli
