#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/read_double.hpp"
#include "exchange/format_list.hpp"
#include "knead/base/printable.hpp"
#include "surface_text.hpp"

namespace knead::detail {
namespace {

constexpr std::string_view json_net_shape =
    R"(write [[[x, y, z], …], …], a row of the net after the other, or {"net": …, )"
    R"("degree": [p, q], "knots": [[…], […]], "weights": [[…], …]})";

/// The plain net of JSON: lists of rows of points, alone or in an object that also has degrees,
/// knots and weights.
struct JsonNetReader {
  std::string_view text, file;
  std::size_t at = 0;
  ListedSurface surface = {};
  bool has_degree = false;

  Expected<void> read() {
    skip();
    surface.u_fast = false;
    surface.block = {at, at};
    const auto status = peek() == '{' ? read_object() : read_net();
    if (!status) return status;
    surface.block.end = at;
    skip();
    if (at < text.size()) return wrong("something follows the net");
    return shape();
  }

 private:
  [[nodiscard]] std::unexpected<Error> wrong(std::string what) const {
    return std::unexpected(WordReader(text, file, {0, text.size()})
                               .error(at, std::move(what), std::string(json_net_shape)));
  }
  [[nodiscard]] char peek() const { return at < text.size() ? text[at] : '\0'; }
  void skip() {
    if (at == 0 && text.starts_with("\xEF\xBB\xBF")) at = 3;
    while (at < text.size() && std::string_view(" \t\r\n").find(text[at]) != std::string_view::npos)
      ++at;
  }
  /// Whether this character comes next; then it is behind us.
  bool take(char c) {
    skip();
    if (peek() != c) return false;
    ++at;
    return true;
  }

  /// Calls item() for each item of a list: no recursion but that of the callers, three lists deep.
  template <class F>
  Expected<std::size_t> list(std::string_view what, const F& item) {
    if (!take('[')) return wrong(fmt::format("{} should be a list here", what));
    std::size_t count = 0;
    if (take(']')) return count;
    do {
      if (auto status = item(); !status) return std::unexpected(status.error());
      ++count;
    } while (take(','));
    if (!take(']')) return wrong(fmt::format("{} goes on without a comma, or does not end", what));
    return count;
  }

  Expected<double> number(TextRange* place = nullptr) {
    skip();
    const std::size_t end = std::min(text.find_first_of(",]} \t\r\n", at), text.size());
    const std::string_view word = text.substr(at, end - at);
    double value = 0;
    const auto [stop, problem] = read_double(word.data(), word.data() + word.size(), value);
    const bool tiny = problem == std::errc::result_out_of_range && is_tiny(word);
    if ((problem != std::errc() && !tiny) || stop != word.data() + word.size() ||
        !std::isfinite(value)) {
      return wrong(fmt::format("\"{}\" is not a number", printable(word, 40)));
    }
    if (place != nullptr) *place = {at, end};
    at = end;
    return value;
  }

  Expected<void> numbers(std::string_view what, std::vector<double>& values) {
    const auto status = list(what, [&]() -> Expected<void> {
      const auto value = number();
      if (!value) return std::unexpected(value.error());
      values.push_back(*value);
      return {};
    });
    return status ? Expected<void>() : std::unexpected(status.error());
  }

  Expected<void> point() {
    const auto coordinates = list("a control point", [&]() -> Expected<void> {
      TextRange place;
      const auto value = number(&place);
      if (!value) return std::unexpected(value.error());
      surface.coordinates.push_back(*value);
      surface.places.push_back(place);
      return {};
    });
    if (!coordinates) return std::unexpected(coordinates.error());
    if (*coordinates != 3)
      return wrong(fmt::format("a control point has {} coordinates, not 3", *coordinates));
    return {};
  }

  /// Rows of equally many items. `sizes`: rows, items of each.
  template <class F>
  Expected<std::array<std::size_t, 2>> rows(std::string_view what, const F& item) {
    std::optional<std::size_t> width;
    std::size_t row = 0;
    const auto count = list(what, [&]() -> Expected<void> {
      const auto items = list("a row", item);
      if (!items) return std::unexpected(items.error());
      ++row;
      if (width && *items != *width) {
        return wrong(fmt::format("row {} of {} has {} items, the first row has {}", row, what,
                                 *items, *width));
      }
      width = *items;
      return {};
    });
    if (!count) return std::unexpected(count.error());
    return std::array{*count, width.value_or(0)};
  }

  Expected<void> read_net() {
    const auto sizes = rows("the net", [&] { return point(); });
    if (!sizes) return std::unexpected(sizes.error());
    constexpr std::size_t most = 1U << 30U;
    if ((*sizes)[0] > most || (*sizes)[1] > most) return wrong("the net is too large");
    surface.count = {static_cast<int>((*sizes)[0]), static_cast<int>((*sizes)[1])};
    return {};
  }

  Expected<void> read_degree() {
    std::vector<double> degrees;
    if (auto status = numbers("the degree", degrees); !status) return status;
    for (const double d : degrees) {
      if (d != std::floor(d) || d < 1 || d > 1000)
        return wrong("a degree is not a whole number from 1 on");
    }
    if (degrees.size() != 2) return wrong("there are not two degrees");
    surface.degree = {static_cast<int>(degrees[0]), static_cast<int>(degrees[1])};
    has_degree = true;
    return {};
  }

  Expected<void> read_field(std::string_view name) {
    if (name == "net") return read_net();
    if (name == "degree") return read_degree();
    if (name == "knots") {
      std::size_t d = 0;
      const auto lists = list("the knots", [&]() -> Expected<void> {
        if (d == 2) return wrong("there are more than two lists of knots");
        return numbers("the knots of a direction", surface.knots[d++]);
      });
      if (!lists) return std::unexpected(lists.error());
      return *lists == 2 ? Expected<void>() : wrong("there are not two lists of knots");
    }
    if (name == "weights") {
      const auto sizes = rows("the weights", [&]() -> Expected<void> {
        const auto value = number();
        if (!value) return std::unexpected(value.error());
        surface.weights.push_back(*value);
        return {};
      });
      return sizes ? Expected<void>() : std::unexpected(sizes.error());
    }
    if (name == "commands" || name == "knead") {
      Error error = wrong("it is a script of commands, not a net").error();
      error.remedy =
          "open a STEP file or another one with surfaces, and give the script by --script";
      return std::unexpected(std::move(error));
    }
    return wrong(fmt::format("a net has no field \"{}\"", printable(name, 40)));
  }

  Expected<void> read_object() {
    std::vector<std::string_view> seen;
    take('{');
    do {
      if (!take('"')) return wrong("a field should begin here, with its name in quotes");
      const std::size_t end = text.find('"', at);
      if (end == std::string_view::npos) return wrong("the name of a field does not end");
      const std::string_view name = text.substr(at, end - at);
      if (std::ranges::find(seen, name) != seen.end())
        return wrong(fmt::format("\"{}\" is there twice", printable(name, 40)));
      seen.push_back(name);
      at = end + 1;
      if (!take(':')) return wrong("a colon should follow the name of a field");
      if (auto status = read_field(name); !status) return status;
    } while (take(','));
    if (!take('}')) return wrong("the net goes on without a comma, or does not end");
    if (std::ranges::find(seen, "net") == seen.end()) return wrong("there is no field \"net\"");
    if (!has_degree && !surface.knots[0].empty())
      return wrong("there are knots, but no field \"degree\"");
    return {};
  }

  Expected<void> shape() {
    if (surface.count[0] < 2 || surface.count[1] < 2) {
      return wrong(fmt::format("a net of {} x {} control points is no surface", surface.count[0],
                               surface.count[1]));
    }
    for (std::size_t d = 0; d < 2; ++d) {
      if (!has_degree) surface.degree[d] = std::min(3, surface.count[d] - 1);
      if (!surface.knots[d].empty()) continue;
      const auto knots = KnotVector::clamped_uniform(surface.degree[d], surface.count[d]);
      if (!knots) return std::unexpected(knots.error());
      surface.knots[d].assign(knots->knots().begin(), knots->knots().end());
    }
    return {};
  }
};

/// The whole surface, as an object: every digit that its numbers need.
Expected<std::string> print_json_net(const Surface& surface) {
  const auto [rows, columns] = surface.net();
  std::string net, weights, knots;
  for (int i = 0; i < rows; ++i) {
    net += i == 0 ? "\n[" : ",\n[";
    weights += i == 0 ? "\n[" : ",\n[";
    for (int j = 0; j < columns; ++j) {
      const int k = i * columns + j;
      const auto p = surface.control_points().row(k);
      net += (j == 0 ? "[" : ",[") + digits_17(p[0]) + "," + digits_17(p[1]) + "," +
             digits_17(p[2]) + "]";
      if (surface.rational())
        weights += (j == 0 ? "" : ",") + shortest(surface.weights()[static_cast<std::size_t>(k)]);
    }
    net += "]";
    weights += "]";
  }
  for (int d = 0; d < 2; ++d) {
    std::string list;
    for (const double knot : surface.knots(d).knots())
      list += (list.empty() ? "" : ",") + shortest(knot);
    knots += (d == 0 ? "[" : ",\n[") + list + "]";
  }
  return fmt::format("{{\"degree\": [{}, {}],\n\"knots\": [{}],\n{}\"net\": [{}]}}",
                     surface.knots(0).degree(), surface.knots(1).degree(), knots,
                     surface.rational() ? "\"weights\": [" + weights + "],\n" : std::string(), net);
}

Expected<std::shared_ptr<const Source>> open_json_net(std::string bytes, std::string name) {
  SurfaceText file;
  file.bytes = std::move(bytes);
  file.name = std::move(name);
  file.format = "JSON net";
  file.print = print_json_net;
  JsonNetReader net{file.bytes, file.name};
  if (auto read = net.read(); !read) return std::unexpected(read.error());
  if (!net.has_degree) {
    file.remarks = {
        "it states no degrees: they are Knead's, cubic where there are enough points, on uniform "
        "knots"};
  }
  file.add("#1", {}, std::move(net.surface));
  return source_of(std::move(file));
}

constexpr std::string_view json_net_endings[] = {".json"};

}  // namespace

Format json_net_format() {
  return {.id = "json-net",
          .name = "JSON net",
          .endings = json_net_endings,
          .media_type = "application/json",
          .content = FormatContent::surfaces,
          .holds =
              "the control points of one surface as lists, with degrees, knots and weights if they "
              "are stated",
          .recognises = [](std::string_view) { return false; },
          .open = open_json_net};
}

}  // namespace knead::detail
