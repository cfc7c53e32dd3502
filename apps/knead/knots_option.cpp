#include "knots_option.hpp"

#include <fmt/format.h>

#include "knead/exchange/file_io.hpp"

namespace knead::cli {

void KnotsOption::add_to(CLI::App& command) {
  command.add_option("--degree", degree, fmt::format("degree of the basis, 1 to {}", max_degree))
      ->required();
  command.add_option("--knots", knots,
                     "all knots, separated by commas, each repeated to its multiplicity; may begin "
                     "with a minus sign");
  command.add_option("--knots-file", file,
                     "file with the knots, separated by commas or white space");
}

Expected<KnotVector> KnotsOption::read() const {
  if (knots.empty() == file.empty()) {
    return usage_error(knots.empty() ? "no knots are given" : "the knots are given twice",
                       "command line", "give either --knots or --knots-file");
  }
  if (degree < 1 || degree > max_degree) {
    return usage_error(fmt::format("degree {} is out of range", degree), "--degree",
                       fmt::format("use 1 to {}", max_degree));
  }
  if (file.empty()) {
    auto numbers = parse_numbers(knots, "--knots");
    if (!numbers) return std::unexpected(numbers.error());
    return of_option(KnotVector::create(degree, std::move(*numbers)), "--knots");
  }
  auto text = read_file(file);
  if (!text) return std::unexpected(text.error());
  auto numbers = parse_numbers(*text, "--knots-file");
  auto made = numbers ? KnotVector::create(degree, std::move(*numbers))
                      : Expected<KnotVector>(std::unexpected(numbers.error()));
  if (made) return made;
  Error error = made.error();
  error.kind = ErrorKind::input;  // the mistake is in a file, not in the call
  error.file = file;
  return std::unexpected(error);
}

}  // namespace knead::cli
