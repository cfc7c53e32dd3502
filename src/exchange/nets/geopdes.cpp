#include <fmt/format.h>

#include <algorithm>

#include "exchange/format_list.hpp"
#include "surface_text.hpp"

namespace knead::detail {
namespace {

/// All weights 1 means that there are none: the format cannot leave them out.
void drop_unit_weights(ListedSurface& surface) {
  if (std::ranges::all_of(surface.weights, [](double w) { return w == 1; }))
    surface.weights.clear();
}

/// Both degrees, both numbers of control points, both knot vectors.
Expected<ListedSurface> read_spaces(WordReader& words) {
  ListedSurface surface;
  surface.block.begin = words.begin();
  surface.homogeneous = true;
  for (int& degree : surface.degree) {
    const auto read = words.integer(1, max_degree, "degree");
    if (!read) return std::unexpected(read.error());
    degree = *read;
  }
  for (int& count : surface.count) {
    const auto read = words.integer(2, 1 << 26, "number of control points");
    if (!read) return std::unexpected(read.error());
    count = *read;
  }
  for (int d = 0; d < 2; ++d) {
    if (auto read = read_knots(words, surface, d); !read) return std::unexpected(read.error());
  }
  return surface;
}

/// A patch of GeoPDEs, Bembel and the NURBS toolbox: degrees, numbers of control points, knots,
/// then x, y, z and the weight of all control points, coordinates multiplied by the weight, u fast.
/// https://github.com/rafavzqz/geopdes/blob/master/geopdes/doc/geo_specs_mp_v21.txt
Expected<ListedSurface> read_patch(WordReader& words, int coordinates) {
  auto read = read_spaces(words);
  if (!read) return read;
  ListedSurface surface = *std::move(read);
  if (auto fits = check_size(words, surface); !fits) return std::unexpected(fits.error());
  const std::size_t n = surface.points(), first = words.place();
  surface.coordinates.resize(3 * n);
  surface.places.resize(3 * n);
  for (std::size_t c = 0; c < static_cast<std::size_t>(coordinates); ++c) {
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t begin = words.begin();
      const auto value = words.number();
      if (!value) return std::unexpected(value.error());
      if (c > 2) continue;
      surface.coordinates[3 * k + c] = *value;
      surface.places[3 * k + c] = {begin, words.place()};
    }
  }
  auto weights = words.numbers(n);
  if (!weights) return std::unexpected(weights.error());
  surface.weights = *std::move(weights);
  surface.block.end = words.place();
  drop_unit_weights(surface);
  if (coordinates != 3) {
    return std::unexpected(
        words.error(first, fmt::format("its points have {} coordinates, not 3", coordinates)));
  }
  return surface;
}

/// What `read_spaces` reads.
std::string print_spaces(const Surface& surface) {
  const auto [rows, columns] = surface.net();
  return fmt::format("{} {}\n{} {}\n{}\n{}\n", surface.knots(0).degree(), surface.knots(1).degree(),
                     rows, columns, list_knots(surface.knots(0)), list_knots(surface.knots(1)));
}

Expected<std::string> print_patch(const Surface& surface) {
  std::string text = print_spaces(surface);
  const auto weight = [&](int k) {
    return surface.rational() ? surface.weights()[static_cast<std::size_t>(k)] : 1.0;
  };
  for (Eigen::Index c = 0; c < 3; ++c) {
    each_u_fast(surface, [&](int k) {
      text += digits_17(surface.control_points()(k, c) * weight(k)) + " ";
    });
    text.back() = '\n';
  }
  each_u_fast(surface, [&](int k) { text += shortest(weight(k)) + " "; });
  text.pop_back();
  return text;
}

bool is_word(std::string_view word) {
  return !word.empty() &&
         (('A' <= word[0] && word[0] <= 'Z') || ('a' <= word[0] && word[0] <= 'z'));
}

/// Leaves the reader at the next line whose first letter is one: the name of a patch or an
/// interface.
std::string name_line(WordReader& words, std::string_view text) {
  const std::size_t begin = words.begin();
  const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
  words.go_to(end);
  std::string name(text.substr(begin, end - begin));
  while (name.ends_with(' ')) name.pop_back();
  return name;
}

/// Dimensions of parameters and space (one number if they are the same), numbers of patches and
/// others.
Expected<std::vector<int>> read_header(WordReader& words, std::string_view text) {
  const std::size_t begin = words.begin();
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  std::vector<int> header;
  while (words.place() < end && header.size() < 8) {
    if (words.begin() >= end) break;
    const auto value = words.integer(0, 1 << 24, "number of patches");
    if (!value) return std::unexpected(value.error());
    header.push_back(*value);
  }
  words.go_to(end);
  return header;
}

Expected<std::shared_ptr<const Source>> open_patches(SurfaceText file) {
  file.print = print_patch;
  const std::string_view text = file.bytes;
  WordReader words(text, file.name, {0, text.size()}, '#');
  const std::size_t begin = words.place();
  const auto header = read_header(words, text);
  if (!header) return std::unexpected(header.error());
  // Version 2.1: parameters, space, patches, interfaces, subdomains; before: dimension, patches, ….
  const bool two = header->size() >= 5;
  const int parameters = header->empty() ? 0 : (*header)[0],
            space = two ? (*header)[1] : parameters;
  const int patches = two ? (*header)[2] : header->size() > 1 ? (*header)[1] : 1;
  if (parameters != 2) {
    return std::unexpected(words.error(
        begin, fmt::format("its patches have {} parameters: they are no surfaces", parameters),
        "open a file of surfaces"));
  }
  for (int k = 1; k <= patches && !words.at_end(); ++k) {
    std::string label = is_word(words.peek()) ? name_line(words, text) : std::string();
    auto patch = read_patch(words, space);
    // Nothing marks where a patch begins: behind a fault in numbers the next one cannot be found. A
    // patch in the plane is no fault, and was read to its end.
    const bool whole = patch.has_value() || space != 3;
    file.add(fmt::format("#{}", k), std::move(label), std::move(patch));
    if (!whole) break;
  }
  return source_of(std::move(file));
}

/// The list that IGA codes call smesh: dimension, degrees, numbers of control points, knots, and x,
/// y, z, weight of each control point, u fast; weights other than 1 are refused.
Expected<std::shared_ptr<const Source>> open_smesh(SurfaceText file) {
  file.print = [](const Surface& surface) -> Expected<std::string> {
    std::string text = print_spaces(surface);
    each_u_fast(surface, [&](int k) {
      for (Eigen::Index c = 0; c < 3; ++c) text += digits_17(surface.control_points()(k, c)) + " ";
      text += "1\n";
    });
    text.pop_back();
    return text;
  };
  WordReader words(file.bytes, file.name, {0, file.bytes.size()}, '#');
  const auto read = [&]() -> Expected<ListedSurface> {
    if (const auto three = words.integer(3, 3, "number of coordinates"); !three)
      return std::unexpected(three.error());
    auto surface = read_spaces(words);
    if (!surface) return surface;
    const std::size_t first = words.place();
    if (auto points = read_points(words, *surface, 4); !points)
      return std::unexpected(points.error());
    surface->block.end = words.place();
    drop_unit_weights(*surface);
    if (surface->weights.empty()) return surface;
    // Nothing says whether coordinates are multiplied by them.
    return std::unexpected(
        words.error(first, "it has weights, whose meaning in this format is not settled",
                    "write the surface as a patch of GeoPDEs"));
  };
  auto surface = read();
  if (!surface) return std::unexpected(surface.error());
  file.add("#1", {}, *std::move(surface));
  return source_of(std::move(file));
}

bool is_geopdes(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 1024);
  if (!head.starts_with('#')) return false;
  const std::size_t nurbs = head.find("nurbs");
  return nurbs != head.npos && head.find(" v.", nurbs) != head.npos;
}

Expected<std::shared_ptr<const Source>> open_geopdes(std::string bytes, std::string name) {
  SurfaceText file;
  file.bytes = std::move(bytes);
  file.name = std::move(name);
  file.format = "GeoPDEs and Bembel";
  const std::string_view text = file.bytes;
  // A line with a single 3 begins the other list; no header of a file of surfaces is one.
  const bool list = text.starts_with("3\n") || text.starts_with("3\r\n");
  auto source = list ? open_smesh(std::move(file)) : open_patches(std::move(file));
  if (source && (*source)->surfaces().empty() && (*source)->unreadable().empty()) {
    return std::unexpected(Error{ErrorKind::input,
                                 "this file has no patch",
                                 {},
                                 "open one that holds a surface",
                                 (*source)->name()});
  }
  return source;
}

constexpr std::string_view geopdes_endings[] = {".dat"};

}  // namespace

Format geopdes_format() {
  return {.id = "geopdes",
          .name = "GeoPDEs and Bembel",
          .endings = geopdes_endings,
          .media_type = "text/x-nurbs",
          .content = FormatContent::surfaces,
          .holds = "patches, and everything else of an opened file byte for byte",
          .recognises = is_geopdes,
          .open = open_geopdes};
}

}  // namespace knead::detail
