#include "surface_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "base/counts.hpp"
#include "base/read_double.hpp"
#include "knead/base/printable.hpp"

namespace knead::detail {
namespace {

bool separates(char c) { return c == ' ' || ('\t' <= c && c <= '\r') || c == ','; }

class TextSource final : public Source {
 public:
  explicit TextSource(SurfaceText text) : text_(std::move(text)) {}

  const std::string& name() const override { return text_.name; }
  std::string_view format() const override { return text_.format; }
  std::vector<std::string> remarks() const override { return text_.remarks; }
  const std::vector<SourceSurface>& surfaces() const override { return text_.surfaces; }
  const std::vector<brep::UnreadableSurface>& unreadable() const override {
    return text_.unreadable;
  }

  Expected<std::string> save(
      std::span<const std::shared_ptr<const Surface>> surfaces,
      std::span<const std::string> followed,
      std::span<const std::shared_ptr<const Curve>> /*curves*/) const override {
    if (!followed.empty())
      return input_error("this file has no edges that could follow", followed.front());
    TextChanges changes;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      if (surfaces[k] == text_.surfaces[k].surface) continue;
      auto status = add_changes(text_.listed[k], *text_.surfaces[k].surface, *surfaces[k],
                                text_.print, changes);
      if (!status) return std::unexpected(std::move(status.error()));
    }
    return with_changes(text_.bytes, std::move(changes));
  }

 private:
  SurfaceText text_;
};

}  // namespace

void WordReader::skip() {
  while (at_ < end_) {
    if (comment_ != '\0' && text_[at_] == comment_) {
      while (at_ < end_ && text_[at_] != '\n') ++at_;
    } else if (separates(text_[at_])) {
      ++at_;
    } else {
      return;
    }
  }
}

bool is_tiny(std::string_view number) {
  return std::abs(std::strtod(std::string(number).c_str(), nullptr)) < 1;
}

bool WordReader::at_end() {
  skip();
  return at_ >= end_;
}

TextRange WordReader::next() {
  skip();
  const std::size_t begin = at_;
  while (at_ < end_ && !separates(text_[at_])) ++at_;
  return {begin, at_};
}

std::size_t WordReader::begin() {
  skip();
  return at_;
}

std::string_view WordReader::peek() {
  skip();
  const std::size_t begin = at_;
  const TextRange word = next();
  at_ = begin;
  return words(word);
}

Error WordReader::error(std::size_t place, std::string what, std::string remedy) const {
  const auto head = text_.substr(0, std::min(place, text_.size()));
  const auto line = static_cast<int>(std::ranges::count(head, '\n')) + 1;
  return {ErrorKind::input, std::move(what), {}, std::move(remedy), std::string(file_), line};
}

Expected<double> WordReader::number() {
  const TextRange range = next();
  std::string_view word = words(range);
  if (word.empty())
    return std::unexpected(
        error(range.begin, "the file ends where a number should be", "get all of it"));
  const std::string_view digits =
      word.starts_with('+') && !word.starts_with("+-") ? word.substr(1) : word;
  double value = 0;
  const auto [end, problem] = read_double(digits.data(), digits.data() + digits.size(), value);
  const bool tiny = problem == std::errc::result_out_of_range && is_tiny(digits);
  if ((problem != std::errc() && !tiny) || end != digits.data() + digits.size() ||
      !std::isfinite(value)) {
    return std::unexpected(
        error(range.begin, fmt::format("\"{}\" is not a number", printable(word)), "correct it"));
  }
  return value;
}

Expected<int> WordReader::integer(int least, int most, std::string_view what) {
  const TextRange range = next();
  const std::string_view word = words(range);
  int value = 0;
  const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (problem != std::errc() || end != word.data() + word.size() || value < least || value > most) {
    return std::unexpected(error(range.begin, fmt::format("\"{}\" is no {}", printable(word), what),
                                 fmt::format("{} to {} are possible", least, most)));
  }
  return value;
}

Expected<std::vector<double>> WordReader::numbers(std::size_t count) {
  std::vector<double> result;
  result.reserve(std::min(count, rest() / 2 + 1));
  for (std::size_t k = 0; k < count; ++k) {
    const auto value = number();
    if (!value) return std::unexpected(value.error());
    result.push_back(*value);
  }
  return result;
}

std::size_t ListedSurface::listed(std::size_t k) const {
  if (!u_fast) return k;
  const auto rows = static_cast<std::size_t>(count[0]),
             columns = static_cast<std::size_t>(count[1]);
  return k / columns + rows * (k % columns);
}

Expected<void> read_sizes(WordReader& words, ListedSurface& surface, int direction,
                          bool count_first, bool order) {
  const auto d = static_cast<std::size_t>(direction);
  for (int k = 0; k < 2; ++k) {
    if ((k == 0) == count_first) {
      const auto count =
          words.integer(2, static_cast<int>(max_spline_size), "number of control points");
      if (!count) return std::unexpected(count.error());
      surface.count[d] = *count;
    } else {
      const auto degree = words.integer(1 + order, max_degree + order, order ? "order" : "degree");
      if (!degree) return std::unexpected(degree.error());
      surface.degree[d] = *degree - order;
    }
  }
  return {};
}

Expected<void> check_size(WordReader& words, const ListedSurface& surface) {
  const auto size = product_of(surface.count);
  if (size && 2 * static_cast<std::size_t>(*size) <= words.rest()) return {};
  return std::unexpected(
      words.error(words.place(), "the file ends before its last control point", "get all of it"));
}

Expected<void> read_knots(WordReader& words, ListedSurface& surface, int direction) {
  const auto d = static_cast<std::size_t>(direction);
  auto knots = words.numbers(static_cast<std::size_t>(surface.count[d] + surface.degree[d] + 1));
  if (!knots) return std::unexpected(knots.error());
  surface.knots[d] = *std::move(knots);
  return {};
}

Expected<void> read_points(WordReader& words, ListedSurface& surface, int width) {
  if (auto fits = check_size(words, surface); !fits) return fits;
  for (std::size_t k = 0; k < surface.points(); ++k) {
    for (int c = 0; c < width; ++c) {
      const std::size_t begin = words.begin();
      const auto value = words.number();
      if (!value) return std::unexpected(value.error());
      if (c < 3) {
        surface.coordinates.push_back(*value);
        surface.places.push_back({begin, words.place()});
      } else {
        surface.weights.push_back(*value);
      }
    }
  }
  return {};
}

Expected<Surface> surface_of(const ListedSurface& listed) {
  auto u = KnotVector::create(listed.degree[0], listed.knots[0]);
  if (!u) return std::unexpected(u.error().within("u"));
  auto v = KnotVector::create(listed.degree[1], listed.knots[1]);
  if (!v) return std::unexpected(v.error().within("v"));
  if (u->count() != listed.count[0] || v->count() != listed.count[1] ||
      listed.coordinates.size() != 3 * listed.points() ||
      (!listed.weights.empty() && listed.weights.size() != listed.points())) {
    return input_error(fmt::format("its knots stand for {} x {} control points, and {} are listed",
                                   u->count(), v->count(), listed.coordinates.size() / 3));
  }
  Points points(static_cast<Eigen::Index>(listed.points()), 3);
  std::vector<double> weights(listed.weights.size());
  for (std::size_t k = 0; k < listed.points(); ++k) {
    const std::size_t at = listed.listed(k);
    if (!weights.empty()) weights[k] = listed.weights[at];
    const double divisor = listed.homogeneous && !weights.empty() ? weights[k] : 1;
    if (divisor == 0)
      return input_error("a weight is zero", fmt::format("control point {}", at + 1));
    for (std::size_t c = 0; c < 3; ++c) {
      points(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) =
          listed.coordinates[3 * at + c] / divisor;
    }
  }
  return Surface::create({*std::move(u), *std::move(v)}, std::move(points), std::move(weights));
}

std::string shortest(double value) { return fmt::format("{}", value); }
std::string digits_17(double value) { return fmt::format("{:.17g}", value); }

std::string list_knots(const KnotVector& knots) {
  std::string text;
  for (const double knot : knots.knots()) text += (text.empty() ? "" : " ") + shortest(knot);
  return text;
}

void SurfaceText::add(std::string id, std::string label, Expected<ListedSurface> surface) {
  auto made = surface ? surface_of(*surface) : Expected<Surface>(std::unexpected(surface.error()));
  if (!made) {
    unreadable.push_back({std::move(id), std::move(made.error())});
    return;
  }
  surfaces.push_back({std::move(id), std::move(label), "unknown",
                      std::make_shared<const Surface>(*std::move(made))});
  listed.push_back(*std::move(surface));
  // The surface has them; saving needs only their places.
  listed.back().coordinates = {};
  listed.back().weights = {};
  for (auto& knots : listed.back().knots) knots = {};
}

std::shared_ptr<const Source> source_of(SurfaceText text) {
  return std::make_shared<const TextSource>(std::move(text));
}

// Where knots, degrees and weights are those of the file, only the coordinates that differ are
// replaced, with 17 digits, and every other byte stays; a surface that was refined is written anew
// in place of its block. Formats with homogeneous points list w P.
Expected<void> add_changes(const ListedSurface& listed, const Surface& before, const Surface& now,
                           Expected<std::string> (*print)(const Surface& surface),
                           TextChanges& changes, const Eigen::Affine3d& back) {
  const bool moved = !back.matrix().isIdentity(0);
  bool same = std::ranges::equal(now.weights(), before.weights());
  for (int d = 0; d < 2; ++d) {
    same = same && now.knots(d).degree() == before.knots(d).degree() &&
           std::ranges::equal(now.knots(d).knots(), before.knots(d).knots());
  }
  const auto stored = [&](Eigen::Index p) {
    const Point point = now.control_points().row(p).transpose();
    return moved ? Point(back * point) : point;
  };
  if (!same) {
    Points points = now.control_points();
    for (Eigen::Index p = 0; p < points.rows(); ++p) points.row(p) = stored(p).transpose();
    const auto surface = now.with_control_points(std::move(points));
    auto block =
        surface ? print(*surface) : Expected<std::string>(std::unexpected(surface.error()));
    if (!block) return std::unexpected(std::move(block.error()));
    changes.emplace_back(listed.block, *std::move(block));
    return {};
  }
  for (Eigen::Index p = 0; p < now.size(); ++p) {
    if (now.control_points().row(p) == before.control_points().row(p)) continue;
    const auto place = static_cast<std::size_t>(p);
    const double weight = listed.homogeneous && now.rational() ? now.weights()[place] : 1;
    const Point point = stored(p);
    for (Eigen::Index c = 0; c < 3; ++c) {
      if (!moved && now.control_points()(p, c) == before.control_points()(p, c)) continue;
      const TextRange range = listed.places[3 * listed.listed(place) + static_cast<std::size_t>(c)];
      changes.emplace_back(range, digits_17(point[c] * weight));
    }
  }
  return {};
}

// In the order of the text, so that it is copied once; ranges do not overlap.
std::string with_changes(std::string_view bytes, TextChanges changes) {
  std::ranges::sort(changes, {}, [](const auto& change) { return change.first.begin; });
  std::string result;
  std::size_t at = 0;
  for (const auto& [range, replacement] : changes) {
    result.append(bytes.substr(at, range.begin - at)).append(replacement);
    at = range.end;
  }
  return result.append(bytes.substr(at));
}

}  // namespace knead::detail
