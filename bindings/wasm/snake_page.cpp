#include "snake_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace knead::snakes {
namespace {

constexpr int drawn_per_span = 8;

/// Whether they begin in the same place; springs may differ.
bool same_place(const SnakeStart& a, const SnakeStart& b) {
  return a.shape == b.shape && a.centre == b.centre && a.radii == b.radii && a.angle == b.angle &&
         a.points == b.points && a.closed == b.closed;
}

/// Control points that differ: a closed snake repeats the first p.
int unknowns(const SnakeResult& s) {
  return static_cast<int>(s.curve.size()) - (s.closed ? s.curve.knots()[0].degree() : 0);
}

std::vector<double> breaks(const KnotVector& knots) {
  const auto [lower, upper] = knots.domain();
  std::vector<double> all;
  for (const double x : knots.knots()) {
    if (x >= lower && x <= upper && (all.empty() || x > all.back())) all.push_back(x);
  }
  return all;
}

}  // namespace

Image grey_of(std::span<const std::uint8_t> rgba, int width, int height) {
  Image image{width, height, {}};
  image.values.reserve(rgba.size() / 4);
  const auto [red, green, blue] = shares_of(ImageChannel::grey);
  for (std::size_t k = 0; k + 3 < rgba.size(); k += 4) {
    const double r = rgba[k] / 255.0, g = rgba[k + 1] / 255.0, b = rgba[k + 2] / 255.0;
    image.values.push_back(r == g && g == b ? r : red * r + green * g + blue * b);
  }
  return image;
}

Expected<void> SnakePage::set_image(Image image) {
  if (auto checked = check_image(image); !checked) return checked;
  *this = {};
  image_ = std::move(image);
  return {};
}

void SnakePage::set_mask(std::optional<Image> mask) {
  now_.mask = mask ? std::make_shared<const Image>(std::move(*mask)) : nullptr;
  now_.potential.reset();
}

void SnakePage::remove_snakes() {
  now_ = State{now_.mask};
  hand_.reset();
}

int SnakePage::keep() {
  kept_.emplace(next_, now_);
  return next_++;
}

Expected<void> SnakePage::restore(int kept) {
  const auto found = kept_.find(kept);
  if (found == kept_.end()) return usage_error(fmt::format("nothing was kept under {}", kept));
  now_ = found->second;
  hand_.reset();
  return {};
}

Expected<SnakePage::Moved> SnakePage::begun(const SnakeScript& script,
                                            const SnakeStart& start) const {
  const One one{start, settings_of(script, start)};
  auto curve = curve_of(start, one.settings);
  if (!curve) return std::unexpected(curve.error());
  return Moved{one, std::move(*curve)};
}

Expected<SnakePage::Moved> SnakePage::goes_on(const One& before, SnakeResult now,
                                              const SnakeScript& script,
                                              const SnakeStart& start) const {
  const One one{start, settings_of(script, start), now.iterations};
  const SnakeSettings &is = one.settings, &was = before.settings;
  if (is.degree == was.degree && is.control_points == was.control_points && is.units == was.units) {
    return Moved{one, std::move(now.curve)};
  }
  // Another net: through the contour as it is, with the same length of the parameter unless that is
  // given.
  SnakeSettings settings = is;
  const auto [lower, upper] = now.curve.knots()[0].domain();
  if (settings.units == 0) settings.units = upper - lower;
  auto curve = curve_through(polyline(now), settings);
  if (!curve) return std::unexpected(curve.error());
  return Moved{one, std::move(*curve)};
}

Expected<void> SnakePage::set_script(std::string_view json, bool again) {
  if (!image_) return usage_error("there is no image", "image", "open one first");
  const auto script = parse_snake_script(json);
  if (!script) return std::unexpected(script.error());
  std::optional<ImagePotential> potential = now_.potential;
  if (!potential || now_.energy != script->image) {
    auto made = ImagePotential::create(*image_, script->image,
                                       now_.mask ? std::optional(*now_.mask) : std::nullopt);
    if (!made) return std::unexpected(made.error());
    potential = std::move(*made);
  }
  const std::vector<SnakeResult> now = results();
  std::vector<bool> taken(now_.snakes.size(), again);
  std::vector<One> snakes;
  std::vector<Curve> curves;
  std::vector<SnakeSettings> settings;
  for (std::size_t k = 0; k < script->snakes.size(); ++k) {
    const SnakeStart& start = script->snakes[k];
    std::size_t known = 0;
    while (known < now_.snakes.size() &&
           (taken[known] || !same_place(now_.snakes[known].start, start)))
      ++known;
    const bool there = known < now_.snakes.size();
    auto moved =
        there ? goes_on(now_.snakes[known], now[known], *script, start) : begun(*script, start);
    if (!moved) return std::unexpected(moved.error().within(fmt::format("snakes[{}]", k)));
    if (there) taken[known] = true;
    settings.push_back(moved->one.settings);
    curves.push_back(std::move(moved->curve));
    snakes.push_back(std::move(moved->one));
  }
  auto run = Snakes::create(*potential, curves, settings);
  if (!run) return std::unexpected(run.error());
  now_.snakes = std::move(snakes);
  now_.run = std::move(*run);
  now_.potential = std::move(potential);
  now_.energy = script->image;
  hand_.reset();
  return {};
}

Expected<void> SnakePage::advance(int iterations) {
  if (!now_.run) return {};
  const auto made = now_.run->advance(iterations);
  return made ? Expected<void>{} : std::unexpected(made.error());
}

SnakeSettings SnakePage::settings_now(std::size_t snake) const {
  SnakeSettings settings = now_.snakes[snake].settings;
  if (!hand_ || hand_->snake != snake) return settings;
  settings.springs.push_back(hand_->spring);
  settings.refine = 0;
  settings.max_iterations = 10'000'000;  // as long as the hand pulls
  return settings;
}

Expected<void> SnakePage::change(std::size_t snake) {
  const auto now = now_.run->result(static_cast<int>(snake));
  if (!now) return std::unexpected(now.error());
  if (auto status = now_.run->change(static_cast<int>(snake), settings_now(snake)); !status)
    return status;
  now_.snakes[snake].earlier += now->iterations;
  return {};
}

Expected<void> SnakePage::wake() {
  for (std::size_t k = 0; k < now_.snakes.size(); ++k) {
    if (auto status = change(k); !status) return status;
  }
  return {};
}

Expected<void> SnakePage::pull(const std::optional<Hand>& hand) {
  if (hand && hand->snake >= now_.snakes.size())
    return usage_error(fmt::format("there is no snake {}", hand->snake));
  const std::optional<Hand> before = hand_;
  hand_ = hand;
  if (before && (!hand || hand->snake != before->snake)) {
    if (auto status = change(before->snake); !status) return status;
  }
  return hand ? change(hand->snake) : Expected<void>{};
}

Expected<void> SnakePage::move_point(std::size_t snake, int point, double x, double y) {
  if (snake >= now_.snakes.size()) return usage_error(fmt::format("there is no snake {}", snake));
  const auto now = now_.run->result(static_cast<int>(snake));
  if (!now) return std::unexpected(now.error());
  const int n = unknowns(*now);
  if (point < 0 || point >= n)
    return usage_error(fmt::format("there is no control point {}", point));
  if (!std::isfinite(x) || !std::isfinite(y)) return usage_error("the place is not finite");
  Points c = now->curve.control_points();
  for (Eigen::Index i = point; i < c.rows(); i += n) c.row(i).head<2>() << x, y;
  const auto curve = Curve::create({now->curve.knots()[0]}, std::move(c));
  if (!curve) return std::unexpected(curve.error());
  if (auto status = now_.run->replace(static_cast<int>(snake), *curve, settings_now(snake));
      !status)
    return status;
  now_.snakes[snake].earlier += now->iterations;
  return {};
}

std::vector<SnakeResult> SnakePage::results() const {
  std::vector<SnakeResult> all;
  for (std::size_t k = 0; k < now_.snakes.size(); ++k) {
    auto now = now_.run->result(static_cast<int>(k));
    if (!now) return all;
    now->iterations += now_.snakes[k].earlier;
    all.push_back(std::move(*now));
  }
  return all;
}

Lines SnakePage::lines() const {
  Lines lines;
  for (const SnakeResult& s : results()) {
    lines.offsets.push_back(static_cast<std::uint32_t>(lines.points.size() / 3));
    lines.net_from.push_back(static_cast<std::uint32_t>(lines.net.size() / 2));
    const auto places = polyline(s, drawn_per_span);
    const std::vector<double> at = breaks(s.curve.knots()[0]);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const std::size_t span = k / drawn_per_span;
      const double share = double(k % drawn_per_span) / drawn_per_span;
      const double u = span + 1 < at.size() ? std::lerp(at[span], at[span + 1], share) : at.back();
      for (const double x :
           {places[k][0], places[k][1], (u - at.front()) / (at.back() - at.front())}) {
        lines.points.push_back(static_cast<float>(x));
      }
    }
    for (int i = 0; i < unknowns(s); ++i) {
      for (const int d : {0, 1})
        lines.net.push_back(static_cast<float>(s.curve.control_points()(i, d)));
    }
  }
  lines.offsets.push_back(static_cast<std::uint32_t>(lines.points.size() / 3));
  lines.net_from.push_back(static_cast<std::uint32_t>(lines.net.size() / 2));
  return lines;
}

std::vector<std::uint8_t> SnakePage::energy() const {
  if (!now_.potential) return {};
  std::vector<double> values;
  for (int y = 0; y < now_.potential->height(); ++y) {
    for (int x = 0; x < now_.potential->width(); ++x) values.push_back(now_.potential->value(x, y));
  }
  const auto [least, most] = std::ranges::minmax(values);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size());
  for (const double v : values) {
    bytes.push_back(static_cast<std::uint8_t>(
        most > least ? std::lround(255 * (v - least) / (most - least)) : 0));
  }
  return bytes;
}

}  // namespace knead::snakes
