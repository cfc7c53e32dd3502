#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/display_range.hpp"
#include "scene/held_points.hpp"
#include "spline/grid_lines.hpp"

namespace knead::studio {

/// What is looked at from nearby: a part of the domain, in fractions of it, and how far chords may
/// be from the surface there, file units.
struct PictureWindow {
  std::array<double, 2> lower = {0, 0}, upper = {1, 1};
  double tolerance = 0;
};

/// A surface as a grid of points to draw, as fine as its curvature needs; every knot line is a line
/// of the grid. Grid point (k, l) is row k · counts[1] + l. Positions are relative to the requested
/// origin, so that single precision suffices.
struct Picture {
  int surface = 0;
  std::optional<PictureWindow> window = {};
  std::array<int, 2> counts = {0, 0};
  std::vector<float> positions, normals;  ///< 3 per grid point; normals of length 1
  std::vector<float>
      values;  ///< of the display, one per grid point, `no_value` for none; empty without one
  std::vector<float> s, t;  ///< fractions of the domain, per grid line
  std::vector<std::uint32_t> lines_u,
      lines_v;  ///< grid lines that are knot lines, ends of the domain included
  std::vector<std::uint32_t> coarse_u,
      coarse_v;                    ///< those that are there without a window; empty: all
  std::vector<float> net;          ///< control points, 3 each
  std::vector<std::uint8_t> held;  ///< per control point: 0, 1 or 2 as in `held_points`
};

/// Stands for a value that is not a number, in a form that shaders can tell apart and interpolate.
inline constexpr float no_value = -1e30F;

/// A display and its settings as requested by the page.
struct AskedDisplay {
  const Display* display = nullptr;  ///< null: none
  std::vector<std::vector<double>> settings;
};

/// By its name; "none" means none. Errors (usage): no such display or setting (`display_settings`).
[[nodiscard]] Expected<AskedDisplay> asked_display(
    std::string_view name, std::span<const std::pair<std::string, std::vector<double>>> settings);

/// How a surface is drawn.
struct PictureOptions {
  Point origin = Point::Zero();  ///< positions are relative to it
  int detail = 96;               ///< desired grid lines per direction
  AskedDisplay display = {};
  bool opened = false;                                ///< the shape as opened, not the present one
  std::shared_ptr<const VisibleRegion> visible = {};  ///< what faces show of it; null: all
  std::optional<PictureWindow> window = {};
  /// For displays that see them; null: nothing is.
  std::shared_ptr<const Surroundings> around = {};
};

/// Makes pictures of one surface after the other; tables and memory are kept while the knots stay
/// the same.
class PictureMaker {
 public:
  /// Errors (numerical): a rational denominator that is not positive.
  Expected<void> make(const Scene& scene, int index, const PictureOptions& options);
  [[nodiscard]] const Picture& picture() const { return picture_; }
  /// Of the display that the last picture shows, over all pictures from that of the first surface
  /// on; none without one.
  [[nodiscard]] std::optional<DisplayRange> range() const {
    return display_ ? range_.range(*display_) : std::nullopt;
  }

 private:
  /// Of the surface as opened, so that the grid stays while it is sculpted.
  struct KeptLines {
    std::shared_ptr<const Surface> of;
    int detail = 0;
    std::optional<GridWindow> window;
    std::array<GridLines, 2> lines;
  };
  Expected<std::array<GridLines, 2>> lines(const Scene& scene, int index, const Surface& drawn,
                                           int detail, const std::optional<GridWindow>& window);
  Expected<void> tabulate(const Scene& scene, int index, const Surface& surface,
                          const PictureOptions& options);
  void find_normals();
  Expected<void> find_held(const SceneSurface& surface);
  Expected<void> find_values(const Scene& scene, int index, const PictureOptions& options);

  std::optional<std::array<KnotVector, 2>> knots_;
  int detail_ = 0;
  std::optional<GridWindow> window_;
  std::shared_ptr<const Surface> of_;  // the surface as opened
  std::vector<KeptLines> lines_;
  std::array<std::vector<double>, 2> parameters_;
  std::array<BasisTable, 2> tables_;
  Evaluation<2> evaluation_;
  Points normals_;
  Picture picture_;
  std::vector<std::pair<HeldInput, std::vector<std::uint8_t>>> held_;
  DisplayMemory memory_;
  const Display* display_ = nullptr;
  DisplayRangeFinder range_;
};

}  // namespace knead::studio
