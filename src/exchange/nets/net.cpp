#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "exchange/format_list.hpp"
#include "surface_text.hpp"

namespace knead::detail {
namespace {

/// What stands for the knots that a plain net does not have.
/// Degree 3, or count − 1 where there are fewer than four points.
Expected<KnotVector> plain_knots(int count) {
  return KnotVector::clamped_uniform(std::min(3, count - 1), count);
}

/// A row of a net: its points, in a line apart or in one line with semicolons between them.
struct NetReader {
  std::string_view text, file;
  ListedSurface surface;
  std::optional<Error> undivided = {};  ///< points alone: nothing says how many make a row

  Expected<void> read() {
    std::vector<std::size_t> rows = {0};  // points of each
    bool in_lines = false;                // rows are lines with semicolons
    std::size_t next = 0;
    for (std::size_t begin = 0; begin < text.size(); begin = next) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      next = end + 1;
      const TextRange line = {begin, end};
      WordReader words(text, file, line, '#');
      if (words.at_end()) {
        if (rows.back() > 0) rows.push_back(0);
        continue;
      }
      in_lines = in_lines || text.substr(begin, end - begin).find(';') != text.npos;
      if (in_lines && rows.back() > 0) rows.push_back(0);
      const auto added = add_line(line);
      if (!added) return std::unexpected(added.error());
      rows.back() += *added;
    }
    if (rows.back() == 0) rows.pop_back();
    return shape(rows);
  }

 private:
  Expected<std::size_t> add_line(TextRange line) {
    std::size_t points = 0;
    for (std::size_t begin = line.begin; begin < line.end;) {
      const std::size_t end = std::min(text.find(';', begin), line.end);
      WordReader words(text, file, {begin, end}, '#');
      begin = end + 1;
      if (words.at_end()) continue;
      for (int c = 0; c < 3; ++c) {
        const std::size_t place = words.begin();
        const auto value = words.number();
        if (!value) return std::unexpected(value.error());
        surface.coordinates.push_back(*value);
        surface.places.push_back({place, words.place()});
      }
      if (!words.at_end()) {
        return std::unexpected(
            words.error(words.place(), "a point has more than three coordinates",
                        "a plain net has no weights; one point per line, or semicolons between"));
      }
      ++points;
    }
    return points;
  }

  Expected<void> shape(const std::vector<std::size_t>& rows) {
    const WordReader words(text, file, {0, text.size()});
    const std::size_t points = surface.coordinates.size() / 3;
    if (points == 0) return std::unexpected(words.error(0, "this file has no control points"));
    if (rows.size() < 2 || rows.front() < 2) {
      undivided = words.error(
          0, fmt::format("{} control points, but how many make a row is not said", points),
          "put an empty line after each row, or each row in one line with semicolons");
      return {};
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (rows[k] == rows.front()) continue;
      return std::unexpected(
          words.error(0,
                      fmt::format("row {} has {} control points, the first row has {}", k + 1,
                                  rows[k], rows.front()),
                      "give all rows the same number"));
    }
    surface.u_fast = false;
    surface.count = {static_cast<int>(rows.size()), static_cast<int>(rows.front())};
    for (std::size_t d = 0; d < 2; ++d) {
      const auto knots = plain_knots(surface.count[d]);
      if (!knots) return std::unexpected(knots.error());
      surface.degree[d] = knots->degree();
      surface.knots[d].assign(knots->knots().begin(), knots->knots().end());
    }
    surface.block = {0, text.size()};
    return {};
  }
};

Expected<std::string> print_net_rows(const Surface& surface) {
  const int columns = surface.net()[1];
  bool plain = !surface.rational();
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots(d);
    const auto uniform = plain_knots(knots.count());
    plain = plain && uniform && uniform->degree() == knots.degree() &&
            std::ranges::equal(uniform->knots(), knots.knots());
  }
  if (!plain) {
    return input_error("a plain net cannot say which knots a refined surface has", {},
                       "write STEP: a name that ends in .step");
  }
  std::string text;
  for (int k = 0; k < surface.size(); ++k) {
    const auto p = surface.control_points().row(k);
    if (k > 0 && k % columns == 0) text += '\n';
    text += digits_17(p[0]) + "," + digits_17(p[1]) + "," + digits_17(p[2]) + "\n";
  }
  return text;
}

Expected<std::shared_ptr<const Source>> open_net(std::string bytes, std::string name) {
  SurfaceText file;
  file.bytes = std::move(bytes);
  file.name = std::move(name);
  file.format = "plain net";
  file.print = print_net_rows;
  NetReader net{file.bytes, file.name, {}};
  if (auto read = net.read(); !read) return std::unexpected(read.error());
  if (net.undivided) {
    file.unreadable.push_back({"#1", *std::move(net.undivided)});
    return source_of(std::move(file));
  }
  file.remarks = {
      "it has points alone: degrees and knots are Knead's, clamped and uniform, cubic where there "
      "are enough"};
  file.add("#1", {}, std::move(net.surface));
  return source_of(std::move(file));
}

constexpr std::string_view net_endings[] = {".csv", ".ctrlpts"};

}  // namespace

Format net_format() {
  return {
      .id = "net",
      .name = "plain net",
      .endings = net_endings,
      .media_type = "text/csv",
      .content = FormatContent::surfaces,
      .holds = "the control points of one surface: a row of the net, an empty line, the next row",
      .recognises = [](std::string_view) { return false; },
      .open = open_net};
}

}  // namespace knead::detail
