#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "exchange/format_list.hpp"
#include "knead/base/printable.hpp"
#include "surface_text.hpp"

namespace knead::detail {
namespace {

/// A tag of XML: "<name key="value">", "</name>" or "<name/>".
/// No library for XML is used: a saved file keeps every byte but the numbers of what changed, so
/// that their places in the text are needed, which parsers of documents do not keep. Only tags are
/// recognised; entities do not occur in numbers.
struct XmlTag {
  std::string_view name, attributes;
  bool opens = true, closes = false;
  TextRange range;
};

/// The next tag from `at` on, behind comments, declarations and CDATA; none at the end.
std::optional<XmlTag> next_tag(std::string_view text, std::size_t at) {
  const auto behind = [&](std::size_t from, std::string_view mark) {
    const std::size_t end = text.find(mark, from);
    return end == text.npos ? text.size() : end + mark.size();
  };
  while ((at = text.find('<', at)) != text.npos) {
    const std::string_view rest = text.substr(at);
    if (rest.starts_with("<!--")) {
      at = behind(at, "-->");
    } else if (rest.starts_with("<![CDATA[")) {
      at = behind(at, "]]>");
    } else if (rest.starts_with("<?") || rest.starts_with("<!")) {
      at = behind(at, ">");
    } else {
      break;
    }
  }
  if (at >= text.size()) return std::nullopt;
  // A ">" in quotes ends no tag.
  std::size_t end = at + 1;
  for (char quote = '\0'; end < text.size() && (quote != '\0' || text[end] != '>'); ++end) {
    const char c = text[end];
    if (quote != '\0' ? c == quote : c == '"' || c == '\'') quote = quote != '\0' ? '\0' : c;
  }
  if (end == text.size()) return std::nullopt;
  XmlTag tag;
  tag.range = {at, end + 1};
  std::string_view inside = text.substr(at + 1, end - at - 1);
  if (inside.starts_with('/')) {
    tag.opens = false;
    tag.closes = true;
    inside.remove_prefix(1);
  } else if (inside.ends_with('/')) {
    tag.closes = true;
    inside.remove_suffix(1);
  }
  tag.name = inside.substr(0, inside.find_first_of(" \t\r\n"));
  tag.attributes = inside.substr(tag.name.size());
  return tag;
}

/// The value of an attribute; empty if it has none.
std::string_view attribute(const XmlTag& tag, std::string_view key) {
  std::string_view rest = tag.attributes;
  while (true) {
    const std::size_t begin = rest.find_first_not_of(" \t\r\n");
    const std::size_t equals = rest.find('=');
    if (begin == rest.npos || equals == rest.npos || equals < begin) return {};
    const std::string_view name =
        rest.substr(begin, rest.find_last_not_of(" \t\r\n", equals - 1) + 1 - begin);
    const std::size_t open = rest.find_first_of("\"'", equals);
    const std::size_t close = open == rest.npos ? open : rest.find(rest[open], open + 1);
    if (close == rest.npos) return {};
    if (name == key) return rest.substr(open + 1, close - open - 1);
    rest.remove_prefix(close + 1);
  }
}

int whole(std::string_view text) {
  int value = -1;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc() && end == text.data() + text.size() ? value : -1;
}

/// The text of an element: from its tag to the next one.
TextRange content_of(std::string_view text, const XmlTag& tag) {
  const auto next = next_tag(text, tag.range.end);
  return {tag.range.end, next ? next->range.begin : text.size()};
}

std::size_t count_words(WordReader words) {
  std::size_t count = 0;
  for (; !words.at_end(); ++count) words.next();
  return count;
}

/// A TensorBSpline2 or TensorNurbs2: knots of both directions, weights, and control points, which
/// are not multiplied by them; the first direction is fast.
/// Knots are listed in full, each as often as its multiplicity. The order of elements is not relied
/// on except that knots precede the points, whose number they give.
Expected<ListedSurface> read_geometry(std::string_view text, std::string_view file,
                                      TextRange inside) {
  ListedSurface surface;
  surface.block = inside;
  const auto reader = [&](TextRange range) { return WordReader(text, file, range); };
  const auto fail = [&](std::size_t place, std::string what, std::string remedy = {}) {
    return std::unexpected(reader(inside).error(place, std::move(what), std::move(remedy)));
  };
  int directions = 0;
  bool points = false;
  for (auto tag = next_tag(text, inside.begin); tag && tag->range.begin < inside.end;
       tag = next_tag(text, tag->range.end)) {
    if (!tag->opens) continue;
    const TextRange content = content_of(text, *tag);
    if ((tag->name == "KnotVector" || tag->name == "coefs" || tag->name == "weights") &&
        !attribute(*tag, "format").empty() && attribute(*tag, "format") != "ASCII") {
      return fail(tag->range.begin, "its numbers are not written as text", "write them as ASCII");
    }
    if (tag->name == "KnotVector") {
      if (directions == 2) return fail(tag->range.begin, "it has more than two knot vectors");
      const auto d = static_cast<std::size_t>(directions++);
      surface.degree[d] = whole(attribute(*tag, "degree"));
      auto knots = reader(content).numbers(count_words(reader(content)));
      if (!knots) return std::unexpected(knots.error());
      surface.count[d] = static_cast<int>(knots->size()) - surface.degree[d] - 1;
      if (surface.degree[d] < 1 || surface.count[d] < 2) {
        return fail(tag->range.begin, "its knots do not fit its degree",
                    "give at least 2 (degree + 1) knots");
      }
      surface.knots[d] = *std::move(knots);
    } else if (tag->name == "weights") {
      auto weights = reader(content).numbers(count_words(reader(content)));
      if (!weights) return std::unexpected(weights.error());
      surface.weights = *std::move(weights);
    } else if (tag->name == "coefs") {
      if (const int dimension = whole(attribute(*tag, "geoDim")); dimension != 3) {
        return fail(tag->range.begin, "its points do not have 3 coordinates");
      }
      auto words = reader(content);
      auto kept = std::move(surface.weights);
      if (auto read = read_points(words, surface, 3); !read) return std::unexpected(read.error());
      surface.weights = std::move(kept);
      if (!words.at_end())
        return fail(words.place(), "it has more control points than its knots stand for");
      points = true;
    }
  }
  if (directions != 2 || !points)
    return fail(inside.begin, "it has no two knot vectors followed by control points");
  return surface;
}

Expected<std::string> print_gismo(const Surface& surface) {
  std::string bases;
  for (int d = 0; d < 2; ++d) {
    bases += fmt::format(
        "<Basis type=\"BSplineBasis\" index=\"{}\"><KnotVector "
        "degree=\"{}\">{}</KnotVector></Basis>\n",
        d, surface.knots(d).degree(), list_knots(surface.knots(d)));
  }
  bases = "<Basis type=\"TensorBSplineBasis2\">\n" + bases + "</Basis>\n";
  std::string weights, points;
  each_u_fast(surface, [&](int k) {
    if (surface.rational())
      weights += shortest(surface.weights()[static_cast<std::size_t>(k)]) + "\n";
    const auto p = surface.control_points().row(k);
    points += digits_17(p[0]) + " " + digits_17(p[1]) + " " + digits_17(p[2]) + "\n";
  });
  if (surface.rational()) {
    bases = "<Basis type=\"TensorNurbsBasis2\">\n" + bases + "<weights>" + weights +
            "</weights>\n</Basis>\n";
  }
  return "\n" + bases + "<coefs geoDim=\"3\">\n" + points + "</coefs>\n";
}

bool is_gismo(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, 4096);
  const auto root = next_tag(head, 0);
  return head.find_first_not_of(" \t\r\n") == head.find('<') && root && root->name == "xml";
}

Expected<std::shared_ptr<const Source>> open_gismo(std::string bytes, std::string name) {
  SurfaceText file;
  file.bytes = std::move(bytes);
  file.name = std::move(name);
  file.format = "G+Smo";
  file.print = print_gismo;
  const std::string_view text = file.bytes;
  std::map<std::string, int> others;
  for (auto tag = next_tag(text, 0); tag; tag = next_tag(text, tag->range.end)) {
    if (tag->name != "Geometry" || !tag->opens || tag->closes) continue;
    const std::size_t end = std::min(text.find("</Geometry", tag->range.end), text.size());
    const std::string_view type = attribute(*tag, "type"), id = attribute(*tag, "id");
    if (type == "TensorBSpline2" || type == "TensorNurbs2") {
      const std::size_t number = file.surfaces.size() + file.unreadable.size();
      file.add(id.empty() ? fmt::format("#s{}", number) : fmt::format("#{}", printable(id, 40)),
               printable(attribute(*tag, "label")),
               read_geometry(text, file.name, {tag->range.end, end}));
    } else {
      ++others[printable(type, 40)];
    }
    tag->range.end = end;
  }
  for (const auto& [type, count] : others)
    file.remarks.push_back(fmt::format("{} x {}", count, type));
  if (file.surfaces.empty() && file.unreadable.empty()) {
    return std::unexpected(Error{ErrorKind::input,
                                 "this G+Smo file has no TensorBSpline2 and no TensorNurbs2",
                                 {},
                                 "open one that holds a surface",
                                 file.name});
  }
  return source_of(std::move(file));
}

constexpr std::string_view gismo_endings[] = {".xml"};

}  // namespace

Format gismo_format() {
  return {.id = "gismo",
          .name = "G+Smo",
          .endings = gismo_endings,
          .media_type = "application/xml",
          .content = FormatContent::surfaces,
          .holds = "tensor-product surfaces, and everything else of an opened file byte for byte",
          .recognises = is_gismo,
          .open = open_gismo};
}

}  // namespace knead::detail
