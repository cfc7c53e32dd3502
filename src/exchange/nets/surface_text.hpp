#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/exchange/source.hpp"

namespace knead::detail {

/// Bytes of a text.
struct TextRange {
  std::size_t begin = 0, end = 0;
};

/// Whether a number that no double can hold is too small for one, and so 0, not too large.
[[nodiscard]] bool is_tiny(std::string_view number);

/// Words of a text, separated by white space and commas, with their places.
class WordReader {
 public:
  /// \param comment begins a comment that lasts to the end of its line; '\0': there are none
  WordReader(std::string_view text, std::string_view file, TextRange range, char comment = '\0')
      : text_(text), file_(file), at_(range.begin), end_(range.end), comment_(comment) {}

  [[nodiscard]] bool at_end();
  [[nodiscard]] std::size_t place() const { return at_; }
  void go_to(std::size_t place) { at_ = place; }
  /// The next word; empty at the end.
  TextRange next();
  [[nodiscard]] std::string_view words(TextRange range) const {
    return text_.substr(range.begin, range.end - range.begin);
  }
  /// Where the next word begins.
  [[nodiscard]] std::size_t begin();
  /// The next word, which stays the next one.
  [[nodiscard]] std::string_view peek();
  /// Errors (input): no such number; the place is a line of the file.
  [[nodiscard]] Expected<double> number();
  [[nodiscard]] Expected<int> integer(int least, int most, std::string_view what);
  [[nodiscard]] Expected<std::vector<double>> numbers(std::size_t count);
  /// Bytes from here to the end.
  [[nodiscard]] std::size_t rest() const { return end_ - at_; }
  [[nodiscard]] Error error(std::size_t place, std::string what, std::string remedy = {}) const;

 private:
  void skip();

  std::string_view text_, file_;
  std::size_t at_, end_;
  char comment_;
};

/// A surface as a text of numbers lists it.
struct ListedSurface {
  std::array<int, 2> degree = {}, count = {};
  std::array<std::vector<double>, 2> knots;
  bool u_fast = true;               ///< neighbours along u are neighbours in the list
  bool homogeneous = false;         ///< coordinates are multiplied by the weight
  std::vector<double> coordinates;  ///< 3 per control point
  std::vector<TextRange> places;    ///< of them
  std::vector<double> weights;      ///< one per control point, or none
  TextRange block;  ///< all that describes degrees, knots, weights and control points

  [[nodiscard]] std::size_t points() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]);
  }
  /// Where control point k of a `Surface` stands in the list.
  [[nodiscard]] std::size_t listed(std::size_t k) const;
};

/// Reads degree + 1 (`order`) or the degree, and the number of control points. Errors (input): out
/// of range, or more control points than the rest of the text can hold.
[[nodiscard]] Expected<void> read_sizes(WordReader& words, ListedSurface& surface, int direction,
                                        bool count_first, bool order);
[[nodiscard]] Expected<void> check_size(WordReader& words, const ListedSurface& surface);
/// The knots of a direction: count + degree + 1.
[[nodiscard]] Expected<void> read_knots(WordReader& words, ListedSurface& surface, int direction);
/// The control points with `width` numbers each: x, y, z and, if there are four, the weight.
[[nodiscard]] Expected<void> read_points(WordReader& words, ListedSurface& surface, int width);

/// Errors (input): what `KnotVector` and `Surface` refuse; a weight of zero where coordinates are
/// homogeneous.
[[nodiscard]] Expected<Surface> surface_of(const ListedSurface& listed);

/// A number with the fewest digits that restore its bits; 17 significant digits for those of
/// control points.
[[nodiscard]] std::string shortest(double value);
[[nodiscard]] std::string digits_17(double value);
/// "0 0 1 1".
[[nodiscard]] std::string list_knots(const KnotVector& knots);
/// Calls f(k) for the control points of a net, u fast.
template <class F>
void each_u_fast(const Surface& surface, const F& f) {
  const auto [rows, columns] = surface.net();
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) f(i * columns + j);
  }
}

/// A file whose surfaces are lists of numbers in a text. A surface whose degrees, knots and weights
/// stay keeps its text but for the coordinates that change, which get 17 digits; another one is
/// written anew by `print`.
struct SurfaceText {
  std::string bytes, name;
  std::string_view format;
  std::vector<SourceSurface> surfaces;
  std::vector<ListedSurface> listed;  ///< of each
  std::vector<brep::UnreadableSurface> unreadable;
  std::vector<std::string> remarks;
  Expected<std::string> (*print)(const Surface& surface) = nullptr;  ///< the text of a block

  /// Makes it one of the surfaces, or of those that cannot be read.
  void add(std::string id, std::string label, Expected<ListedSurface> surface);
};

[[nodiscard]] std::shared_ptr<const Source> source_of(SurfaceText text);

/// What replaces bytes.
using TextChanges = std::vector<std::pair<TextRange, std::string>>;

/// The changes that make a listed surface another one: of single coordinates, with 17 digits, where
/// degrees, knots and weights stay; else the block, by `print`. `back`: from the coordinates of the
/// surfaces to those of the file.
[[nodiscard]] Expected<void> add_changes(const ListedSurface& listed, const Surface& before,
                                         const Surface& now,
                                         Expected<std::string> (*print)(const Surface& surface),
                                         TextChanges& changes,
                                         const Eigen::Affine3d& back = Eigen::Affine3d::Identity());
[[nodiscard]] std::string with_changes(std::string_view bytes, TextChanges changes);

}  // namespace knead::detail
