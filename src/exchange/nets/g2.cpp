#include <fmt/format.h>

#include <map>

#include "exchange/format_list.hpp"
#include "surface_text.hpp"

namespace knead::detail {
namespace {

// https://github.com/SINTEF-Geometry/GoTools/wiki/GoTools-g2-file-format
constexpr int spline_curve = 100, spline_surface = 200, spline_volume = 700;
constexpr int most_coordinates = 3;

/// The body of a surface: dimension, whether rational; of each direction the number of control
/// points, the order and the knots; control points, multiplied by their weights where there are
/// any, u fast.
Expected<ListedSurface> read_g2_surface(WordReader& words) {
  ListedSurface surface;
  surface.block.begin = words.begin();
  surface.homogeneous = true;
  const auto dimension = words.integer(1, most_coordinates, "number of coordinates");
  if (!dimension) return std::unexpected(dimension.error());
  const auto rational = words.integer(0, 1, "mark of a rational surface");
  if (!rational) return std::unexpected(rational.error());
  for (int d = 0; d < 2; ++d) {
    if (auto read = read_sizes(words, surface, d, true, true); !read)
      return std::unexpected(read.error());
    if (auto read = read_knots(words, surface, d); !read) return std::unexpected(read.error());
  }
  const auto at = words.place();
  if (*dimension != 3) {  // read, to find what follows
    const auto skipped =
        words.numbers(surface.points() * static_cast<std::size_t>(*dimension + *rational));
    if (!skipped) return std::unexpected(skipped.error());
    return std::unexpected(
        words.error(at, fmt::format("its points have {} coordinates, not 3", *dimension)));
  }
  if (auto read = read_points(words, surface, 3 + *rational); !read)
    return std::unexpected(read.error());
  surface.block.end = words.place();
  return surface;
}

/// Moves beyond the body of a spline curve or volume.
Expected<void> skip_spline(WordReader& words, int directions) {
  const auto dimension = words.integer(1, 16, "number of coordinates");
  if (!dimension) return std::unexpected(dimension.error());
  const auto rational = words.integer(0, 1, "mark of a rational spline");
  if (!rational) return std::unexpected(rational.error());
  std::size_t points = 1;
  for (int d = 0; d < directions; ++d) {
    ListedSurface sizes;
    if (auto read = read_sizes(words, sizes, 0, true, true); !read) return read;
    if (auto read = read_knots(words, sizes, 0); !read) return read;
    points *= static_cast<std::size_t>(sizes.count[0]);
    if (points > words.rest())
      return std::unexpected(words.error(words.place(), "the file ends too early"));
  }
  const auto skipped = words.numbers(points * static_cast<std::size_t>(*dimension + *rational));
  if (!skipped) return std::unexpected(skipped.error());
  return {};
}

Expected<std::string> print_g2(const Surface& surface) {
  std::string text = fmt::format("3 {}\n", surface.rational() ? 1 : 0);
  for (int d = 0; d < 2; ++d) {
    const KnotVector& knots = surface.knots(d);
    text += fmt::format("{} {}\n{}\n", knots.count(), knots.degree() + 1, list_knots(knots));
  }
  each_u_fast(surface, [&](int k) {
    const double weight = surface.rational() ? surface.weights()[static_cast<std::size_t>(k)] : 1;
    for (Eigen::Index c = 0; c < 3; ++c) {
      text += (c == 0 ? "" : " ") + digits_17(surface.control_points()(k, c) * weight);
    }
    text += surface.rational() ? " " + shortest(weight) + "\n" : "\n";
  });
  text.pop_back();
  return text;
}

/// Class, major version 1, minor version 0, and how many numbers of a colour follow.
Expected<int> read_header(WordReader& words) {
  const auto type = words.integer(1, 999, "class of an object");
  if (!type) return type;
  if (auto major = words.integer(0, 99, "version"); !major) return major;
  if (auto minor = words.integer(0, 99, "version"); !minor) return minor;
  const auto extra = words.integer(0, 64, "number of additional numbers");
  if (!extra) return extra;
  for (int k = 0; k < *extra; ++k) words.next();
  return type;
}

bool is_g2(std::string_view bytes) {
  WordReader words(bytes.substr(0, 200), {}, {0, std::min<std::size_t>(bytes.size(), 200)});
  const auto type = words.integer(100, 799, "class");
  return type && *type % 10 < 5 && words.integer(1, 1, "version") &&
         words.integer(0, 0, "version") && words.integer(0, 4, "number");
}

Expected<std::shared_ptr<const Source>> open_g2(std::string bytes, std::string name) {
  SurfaceText text;
  text.bytes = std::move(bytes);
  text.name = std::move(name);
  text.format = "GoTools";
  text.print = print_g2;
  WordReader words(text.bytes, text.name, {0, text.bytes.size()});
  std::map<int, int> others;
  for (int object = 1; !words.at_end(); ++object) {
    const std::size_t begin = words.place();
    const auto type = read_header(words);
    if (!type) return std::unexpected(type.error().within(fmt::format("object {}", object)));
    if (*type == spline_surface) {
      const std::size_t before = words.place();
      auto surface = read_g2_surface(words);
      const bool follows = surface || words.place() > before;
      text.add(fmt::format("#{}", object), {}, std::move(surface));
      if (follows) continue;
    }
    ++others[*type];
    if (*type == spline_curve || *type == spline_volume) {
      if (skip_spline(words, *type == spline_curve ? 1 : 3)) continue;
    }
    text.remarks.push_back(
        words
            .error(begin, fmt::format("an object of class {} is not known; all from there on is "
                                      "kept as it is",
                                      *type))
            .message());
    break;
  }
  for (const auto& [type, count] : others)
    text.remarks.push_back(fmt::format("{} x class {}", count, type));
  if (text.surfaces.empty() && text.unreadable.empty()) {
    return std::unexpected(Error{ErrorKind::input,
                                 "this GoTools file has no spline surface (class 200)",
                                 {},
                                 "save the surfaces as splines",
                                 text.name});
  }
  return source_of(std::move(text));
}

constexpr std::string_view g2_endings[] = {".g2"};

}  // namespace

Format g2_format() {
  return {.id = "g2",
          .name = "GoTools",
          .endings = g2_endings,
          .media_type = "model/x-gotools",
          .content = FormatContent::surfaces,
          .holds = "spline surfaces, and everything else of an opened file byte for byte",
          .recognises = is_g2,
          .open = open_g2};
}

}  // namespace knead::detail
