#include "knead/image/snake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <optional>

#include "snake_net.hpp"

namespace knead {
namespace {

constexpr int history = 10;  // earlier places that the motion is compared with
constexpr int highest_level = 40, patience = 20;
constexpr double most_uneven = 2;

Expected<void> check_settings(const SnakeSettings& s) {
  const struct {
    const char* name;
    double value, least, most;
  } numbers[] = {{"degree", double(s.degree), 2, 7},
                 {"control_points", double(s.control_points), double(s.degree + 1), 100000},
                 {"units", s.units, 0, 1e9},
                 {"alpha", s.alpha, 0, 1e12},
                 {"beta", s.beta, 0, 1e12},
                 {"gamma", s.gamma, 1e-12, 1e12},
                 {"band", s.band, 0, 1e6},
                 {"redistribute", double(s.redistribute), 0, 1e7},
                 {"balloon", s.balloon, -1e12, 1e12},
                 {"max_move", s.max_move, 1e-6, 1e6},
                 {"max_iterations", double(s.max_iterations), 1, 1e7},
                 {"motion", s.motion, 0, 1e6},
                 {"refine", s.refine, 0, 1e6},
                 {"max_control_points", double(s.max_control_points), 1, 100000}};
  for (const auto& [name, value, least, most] : numbers) {
    if (value >= least && value <= most) continue;
    return input_error(fmt::format("{} is out of range", value), name, fmt::format("use {} to {}", least, most));
  }
  for (const SnakeSpring& spring : s.springs) {
    if (!(spring.at >= 0 && spring.at <= 1)) return input_error("it is beyond the snake", "springs", "use at 0 to 1");
    if (!(spring.strength >= 0)) return input_error("the strength is negative", "springs", "use 0 or more");
  }
  for (const SnakeVolcano& volcano : s.volcanoes) {
    if (!(volcano.radius > 0)) return input_error("the radius is not positive", "volcanoes", "use more than 0");
  }
  return {};
}

/// Σ over the area inside by Green's theorem.
struct Inside {
  double area = 0, intensity = 0;  ///< signed: positive where the normal (y', −x') points outwards
};

/// Grey values on both sides.
struct Means {
  double inside = 0, outside = 0;
};

/// One snake on its way.
struct Running {
  SnakeSettings settings;
  SnakeNet net;
  Points c;  ///< its unknowns
  std::deque<Points> before = {};
  int iterations = 0;
  bool resting = false;
  double motion = 0;
  int level = 0;  ///< the viscosity is γ 2^level
  int steadily = 0;
  Points last = {};  ///< the last move

  [[nodiscard]] Inside inside(const ImagePotential& image) const {
    Inside sum;
    if (!settings.closed) return sum;
    const Points v = net.at_gauss(c, 0), t = net.at_gauss(c, 1);
    for (Eigen::Index q = 0; q < v.rows(); ++q) {
      const double w = net.quadrature().weights[static_cast<std::size_t>(q)];
      sum.area += w * (v(q, 0) * t(q, 1) - v(q, 1) * t(q, 0)) / 2;
      if (image.settings().region != 0) sum.intensity += w * t(q, 1) * image.intensity_to_the_left(v(q, 0), v(q, 1));
    }
    return sum;
  }

  /// The same of the band around it: of the polygon of points that far outside, less its own.
  [[nodiscard]] Inside around(const ImagePotential& image, const Inside& own) const {
    const Points v = net.at_gauss(c, 0), t = net.at_gauss(c, 1);
    const double side = std::copysign(settings.band, own.area);
    const auto place = [&](Eigen::Index q) {
      const Eigen::Vector2d along = t.row(q).head<2>().normalized();
      return Eigen::Vector2d(v(q, 0) + side * along[1], v(q, 1) - side * along[0]);
    };
    Inside sum{-own.area, -own.intensity};
    Eigen::Vector2d a = place(v.rows() - 1);
    double left = image.intensity_to_the_left(a[0], a[1]);
    for (Eigen::Index q = 0; q < v.rows(); ++q) {
      const Eigen::Vector2d b = place(q);
      const double there = image.intensity_to_the_left(b[0], b[1]);
      sum.area += (a[0] * b[1] - a[1] * b[0]) / 2;
      sum.intensity += (left + there) / 2 * (b[1] - a[1]);
      a = b;
      left = there;
    }
    return sum;
  }

  /// Whether it is stretched more than twice as much in some places as in others.
  [[nodiscard]] bool uneven() const {
    const Eigen::VectorXd speed = net.at_gauss(c, 1).rowwise().norm();
    return speed.maxCoeff() > most_uneven * speed.minCoeff();
  }

  /// Spreads it evenly along itself.
  Expected<void> spread() {
    const auto curve = net.curve(c);
    if (!curve) return std::unexpected(curve.error());
    auto even = fitted(polyline({*curve, true}, 8), net.breaks(), settings);
    if (!even) return std::unexpected(even.error());
    c = std::move(*even);
    return {};
  }

  /// γ v and the forces of the image, of pressure and of volcanoes at the Gauss points.
  [[nodiscard]] Points forces(const ImagePotential& image, double side, const std::optional<Means>& means) const {
    const Points v = net.at_gauss(c, 0), t = net.at_gauss(c, 1);
    Points f = viscosity() * v;
    for (Eigen::Index q = 0; q < v.rows(); ++q) {
      const double x = v(q, 0), y = v(q, 1);
      const auto external = image.force(x, y);
      Eigen::Vector2d force(external[0], external[1]);
      double pressure = settings.balloon;
      if (means) {
        const double grey = image.intensity(x, y), in = grey - means->inside, out = grey - means->outside;
        pressure += image.settings().region * (out * out - in * in);
      }
      if (settings.closed) force += side * pressure * Eigen::Vector2d(t(q, 1), -t(q, 0));
      for (const SnakeVolcano& volcano : settings.volcanoes) {
        const Eigen::Vector2d away(x - volcano.at[0], y - volcano.at[1]);
        const double distance = away.norm(), share = volcano.radius / std::max(distance, volcano.radius);
        if (distance > 0) force += volcano.strength * share * share * away / distance;
      }
      f.row(q).head<2>() += force.transpose();
    }
    return f;
  }

  Expected<void> step(const ImagePotential& image, double side, const std::optional<Means>& means) {
    const Points next = net.solve(forces(image, side, means), c);
    Points move = next - c;
    for (Eigen::Index k = 0; k < move.rows(); ++k) {
      const double length = move.row(k).norm();
      if (length > 0) move.row(k) *= settings.max_move * std::tanh(length / settings.max_move) / length;
    }
    c += move;
    ++iterations;
    if (static_cast<int>(before.size()) == history) {
      motion = std::numeric_limits<double>::infinity();
      for (const Points& earlier : before)
        motion = std::min(motion, (c - earlier).cwiseAbs().rowwise().sum().maxCoeff());
      motion *= std::ldexp(1, level);
      resting = motion < settings.motion;
      before.clear();
    } else {
      before.push_back(c);
    }
    if (auto done = steady(move); !done) return done;
    const bool normal = image.settings().region != 0 || settings.balloon != 0;
    const bool may = normal && settings.closed && settings.springs.empty() && settings.redistribute > 0;
    const bool spreads = may && !resting && iterations % settings.redistribute == 0 && uneven();
    return spreads ? spread() : Expected<void>{};
  }

  /// Doubles the viscosity when the snake turns back, and halves it again, down to what is asked, while it goes on.
  Expected<void> steady(const Points& move) {
    double onwards = 0, all = 0;  // how much of the motion goes on as before
    if (last.rows() == move.rows()) {
      const Eigen::VectorXd along = move.cwiseProduct(last).rowwise().sum();
      onwards = along.sum();
      all = along.cwiseAbs().sum();
    }
    const bool turned = onwards<0.5 * all, straight = onwards> 0.9 * all;
    last = move;
    steadily = straight ? steadily + 1 : 0;
    int next = level;
    if (turned && level < highest_level) ++next;
    if (steadily >= patience && level > 0) --next, steadily = 0;
    if (next == level) return {};
    level = next;
    SnakeSettings slower = settings;
    slower.gamma = viscosity();
    auto made = SnakeNet::create(net.breaks(), slower);
    if (!made) return std::unexpected(made.error());
    net = std::move(*made);
    return {};
  }

  [[nodiscard]] double viscosity() const { return std::ldexp(settings.gamma, level); }

  [[nodiscard]] bool ended() const { return resting || iterations >= settings.max_iterations; }
};

/// All of them until the last one rests.
Expected<void> run_until_rest(const ImagePotential& image, std::vector<Running>& snakes) {
  const bool region = image.settings().region != 0;
  while (std::ranges::any_of(snakes, [](const Running& s) { return !s.ended(); })) {
    std::vector<Inside> insides;
    double area = 0, intensity = 0;
    for (const Running& s : snakes) {
      insides.push_back(s.inside(image));
      const double side = std::copysign(1, insides.back().area);
      area += std::abs(insides.back().area);
      intensity += side * insides.back().intensity;
    }
    const double left = double(image.width()) * double(image.height()) - area;
    const double outside = left >= 1 ? (image.total_intensity() - intensity) / left : 0;
    for (std::size_t k = 0; k < snakes.size(); ++k) {
      if (snakes[k].ended()) continue;
      std::optional<Means> means;
      if (region && std::abs(insides[k].area) >= 1) {
        means = Means{insides[k].intensity / insides[k].area, outside};
        if (snakes[k].settings.band > 0) {
          const Inside band = snakes[k].around(image, insides[k]);
          if (std::abs(band.area) >= 1) means->outside = band.intensity / band.area;
        }
      }
      if (auto done = snakes[k].step(image, std::copysign(1, insides[k].area), means); !done) return done;
    }
  }
  return {};
}

/// The same snake on the net of these spans, with its iterations.
Expected<Running> moved_to(const Running& snake, std::span<const double> breaks) {
  const auto curve = snake.net.curve(snake.c);
  if (!curve) return std::unexpected(curve.error());
  auto c = projected(*curve, breaks, snake.settings);
  if (!c) return std::unexpected(c.error());
  auto net = SnakeNet::create(breaks, snake.settings);
  if (!net) return std::unexpected(net.error());
  return Running{snake.settings, std::move(*net), std::move(*c), {}, snake.iterations};
}

std::vector<double> halved(const std::vector<double>& breaks, const std::vector<bool>& marked) {
  std::vector<double> result;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k) {
    result.push_back(breaks[k]);
    if (marked[k]) result.push_back(std::midpoint(breaks[k], breaks[k + 1]));
  }
  result.push_back(breaks.back());
  return result;
}

/// Spans in which the contour is elsewhere, across itself, on a net of half the spans.
std::vector<bool> spans_that_differ(const Running& coarse, const Running& fine) {
  const auto& at = coarse.net.quadrature().parameters;
  std::vector<bool> marked(coarse.net.breaks().size() - 1, false);
  const auto basis = tabulate_basis(fine.net.knots(), at, 0);
  if (!basis) return marked;
  const Points v = coarse.net.at_gauss(coarse.c, 0), t = coarse.net.at_gauss(coarse.c, 1);
  const auto per_span = static_cast<std::size_t>(coarse.net.points_per_span());
  for (std::size_t q = 0; q < at.size(); ++q) {
    Eigen::RowVector3d there = Eigen::RowVector3d::Zero();
    const int first = basis->first[q];
    for (int r = 0; r <= basis->degree; ++r) {
      there += basis->row(static_cast<int>(q), 0)[r] * fine.c.row((first + r) % fine.net.unknowns());
    }
    const auto row = static_cast<Eigen::Index>(q);
    const Eigen::RowVector2d d = (there - v.row(row)).head<2>(), along = t.row(row).head<2>();
    const double across = std::abs(d[0] * along[1] - d[1] * along[0]) / std::max(along.norm(), 1e-300);
    if (across > coarse.settings.refine) marked[q / per_span] = true;
  }
  return marked;
}

/// Halves spans of snakes that rest, where that changes them, until it does so nowhere.
Expected<void> refine_all(const ImagePotential& image, std::vector<Running>& snakes) {
  for (bool again = true; again;) {
    again = false;
    std::vector<Running> fine;
    for (const Running& s : snakes) {
      const auto& breaks = s.net.breaks();
      const bool may = s.settings.refine > 0 && s.iterations < s.settings.max_iterations &&
                       2 * s.net.unknowns() <= 2 * s.settings.max_control_points;
      auto moved = moved_to(s, may ? halved(breaks, std::vector<bool>(breaks.size() - 1, true)) : breaks);
      if (!moved) return std::unexpected(moved.error());
      moved->resting = !may;
      fine.push_back(std::move(*moved));
    }
    if (auto done = run_until_rest(image, fine); !done) return done;
    for (std::size_t k = 0; k < snakes.size(); ++k) {
      Running& s = snakes[k];
      if (fine[k].net.unknowns() == s.net.unknowns()) continue;
      const std::vector<bool> marked = spans_that_differ(s, fine[k]);
      const auto more = std::ranges::count(marked, true);
      const int spent = fine[k].iterations;
      if (more > 0 && s.net.unknowns() + more <= s.settings.max_control_points) {
        auto moved = moved_to(s, halved(s.net.breaks(), marked));
        if (!moved) return std::unexpected(moved.error());
        s = std::move(*moved);
        again = true;
      } else {
        s.settings.refine = 0;  // it follows the image
      }
      s.iterations = spent;
    }
    if (!again) continue;
    if (auto done = run_until_rest(image, snakes); !done) return done;
  }
  return {};
}

}  // namespace

Expected<Curve> curve_through(std::span<const std::array<double, 2>> points, const SnakeSettings& settings) {
  if (auto checked = check_settings(settings); !checked) return std::unexpected(checked.error());
  if (points.size() < (settings.closed ? 3U : 2U)) {
    return input_error(fmt::format("{} points make no contour", points.size()), "points",
                       settings.closed ? "give 3 or more" : "give 2 or more");
  }
  const double length = chord_length(points, settings.closed), units = settings.units > 0 ? settings.units : length;
  const int spans = settings.closed ? settings.control_points : settings.control_points - settings.degree;
  std::vector<double> breaks;
  for (int k = 0; k <= spans; ++k) breaks.push_back((units > 0 && std::isfinite(units) ? units : 1) * k / spans);
  const auto c = fitted({points.begin(), points.end()}, breaks, settings);
  if (!c) return std::unexpected(c.error());
  const auto net = SnakeNet::create(breaks, settings, true);
  return net ? net->curve(*c) : std::unexpected(net.error());
}

Expected<std::vector<SnakeResult>> run_snakes(const ImagePotential& potential, std::vector<Curve> starts,
                                              const std::vector<SnakeSettings>& settings) {
  if (starts.size() != settings.size()) return input_error("every snake needs its settings", "snakes");
  std::vector<Running> snakes;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    if (auto checked = check_settings(settings[k]); !checked) {
      return std::unexpected(checked.error().within(fmt::format("snakes[{}]", k)));
    }
    auto net = SnakeNet::create(breaks_of(starts[k]), settings[k]);
    if (!net) return std::unexpected(net.error());
    if (!std::ranges::equal(net->knots().knots(), starts[k].knots()[0].knots())) {
      return input_error("its knots are not those of a snake", fmt::format("snakes[{}]", k), "use curve_through");
    }
    Points c = net->unknowns_of(starts[k]);
    snakes.push_back({settings[k], std::move(*net), std::move(c)});
  }
  if (auto done = run_until_rest(potential, snakes); !done) return std::unexpected(done.error());
  if (auto refined = refine_all(potential, snakes); !refined) return std::unexpected(refined.error());
  std::vector<SnakeResult> results;
  for (const Running& s : snakes) {
    auto curve = s.net.curve(s.c);
    if (!curve) return std::unexpected(curve.error());
    results.push_back({std::move(*curve), s.settings.closed, s.iterations, s.resting, s.motion});
  }
  return results;
}

}  // namespace knead
