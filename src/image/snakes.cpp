#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "knead/image/snake.hpp"
#include "moving_snake.hpp"
#include "region_term.hpp"

namespace knead {
namespace {

bool all_ended(const std::vector<MovingSnake>& snakes) {
  return std::ranges::all_of(snakes, &MovingSnake::ended);
}

/// An iteration of those that have not ended.
///
/// Sums inside and grey values outside of all snakes are taken before any of them moves, so that
/// results do not depend on their order.
Expected<void> step_all(const ImagePotential& image, std::vector<MovingSnake>& snakes) {
  std::vector<Inside> insides;
  for (const MovingSnake& s : snakes) insides.push_back(s.inside(image));
  const auto sides = sides_of(image, snakes, insides);
  for (std::size_t k = 0; k < snakes.size(); ++k) {
    if (snakes[k].ended()) continue;
    if (auto status = snakes[k].step(image, std::copysign(1, insides[k].area), sides[k]); !status)
      return status;
  }
  return {};
}

bool may_refine(const MovingSnake& s) {
  return s.settings.refine > 0 && s.iterations < s.settings.max_iterations &&
         s.net.unknowns() <= s.settings.max_control_points;
}

}  // namespace

struct Snakes::State {
  ImagePotential image;
  std::vector<MovingSnake> snakes;
  /// While a finer net is tried: the same snakes, those that may be refined on half the spans.
  std::vector<MovingSnake> fine = {};

  [[nodiscard]] bool ended() const {
    return fine.empty() && all_ended(snakes) && std::ranges::none_of(snakes, may_refine);
  }

  /// Until an iteration is made or all is done.
  Expected<void> advance() {
    while (!ended()) {
      std::vector<MovingSnake>& moving = fine.empty() ? snakes : fine;
      if (!all_ended(moving)) return step_all(image, moving);
      if (auto status = fine.empty() ? try_finer() : adopt(); !status) return status;
    }
    return {};
  }

  Expected<void> try_finer() {
    for (const MovingSnake& s : snakes) {
      const auto& breaks = s.net.breaks();
      const bool may = may_refine(s);
      auto moved =
          moved_to(s, may ? halved(breaks, std::vector<bool>(breaks.size() - 1, true)) : breaks);
      if (!moved) return std::unexpected(moved.error());
      if (!may) moved->motion.stop();
      fine.push_back(std::move(*moved));
    }
    return {};
  }

  /// Halves those spans in which the finer net made a difference.
  ///
  /// Refinement by trial: how far a finer net would move the contour is measured on that net at
  /// rest, since no estimate from the image says where more control points help. Only the spans
  /// that differ are halved, from the coarse shape on; iterations of the trial count.
  Expected<void> adopt() {
    for (std::size_t k = 0; k < snakes.size(); ++k) {
      MovingSnake& s = snakes[k];
      if (fine[k].net.unknowns() == s.net.unknowns()) continue;
      const std::vector<bool> marked = spans_that_differ(s, fine[k]);
      const auto more = std::ranges::count(marked, true);
      const int spent = fine[k].iterations;
      if (more > 0 && s.net.unknowns() + more <= s.settings.max_control_points) {
        auto moved = moved_to(s, halved(s.net.breaks(), marked));
        if (!moved) return std::unexpected(moved.error());
        s = std::move(*moved);
      } else {
        s.settings.refine = 0;  // it follows the image
      }
      s.iterations = spent;
    }
    fine.clear();
    return {};
  }
};

Snakes::Snakes(std::unique_ptr<State> state) : state_(std::move(state)) {}
Snakes::Snakes(const Snakes& other) : state_(std::make_unique<State>(*other.state_)) {}
Snakes& Snakes::operator=(const Snakes& other) {
  if (this != &other) state_ = std::make_unique<State>(*other.state_);
  return *this;
}
Snakes::Snakes(Snakes&&) noexcept = default;
Snakes& Snakes::operator=(Snakes&&) noexcept = default;
Snakes::~Snakes() = default;

Expected<Snakes> Snakes::create(const ImagePotential& potential, const std::vector<Curve>& starts,
                                const std::vector<SnakeSettings>& settings) {
  if (starts.size() != settings.size())
    return input_error("every snake needs its settings", "snakes");
  std::vector<MovingSnake> snakes;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    auto snake = snake_on(starts[k], settings[k]);
    if (!snake) return std::unexpected(snake.error().within(fmt::format("snakes[{}]", k)));
    snakes.push_back(std::move(*snake));
  }
  return Snakes(std::make_unique<State>(potential, std::move(snakes)));
}

int Snakes::count() const { return static_cast<int>(std::ssize(state_->snakes)); }

bool Snakes::ended() const { return state_->ended(); }

Expected<int> Snakes::advance(int iterations) {
  int made = 0;
  for (; made < iterations && !state_->ended(); ++made) {
    if (auto status = state_->advance(); !status) return std::unexpected(status.error());
  }
  return made;
}

Expected<SnakeResult> Snakes::result(int snake) const {
  if (snake < 0 || snake >= count())
    return input_error(fmt::format("there is no snake {}", snake), "snakes");
  const MovingSnake& s = state_->snakes[static_cast<std::size_t>(snake)];
  auto curve = s.net.curve(s.c);
  if (!curve) return std::unexpected(curve.error());
  return SnakeResult{std::move(*curve), s.settings.closed, s.iterations, s.motion.resting(),
                     s.motion.last()};
}

const SnakeSettings& Snakes::settings(int snake) const {
  return state_->snakes[static_cast<std::size_t>(snake)].settings;
}

Expected<void> Snakes::change(int snake, const SnakeSettings& settings) {
  const auto now = result(snake);
  if (!now) return std::unexpected(now.error());
  const MovingSnake& before = state_->snakes[static_cast<std::size_t>(snake)];
  const double share = before.settings.end_tension * before.settings.alpha;
  auto pull = before.end_pull;  // of where it started, not of where it is
  for (double& p : pull) p *= share > 0 ? settings.end_tension * settings.alpha / share : 0;
  if (auto status = replace(snake, now->curve, settings); !status) return status;
  if (share > 0) state_->snakes[static_cast<std::size_t>(snake)].end_pull = pull;
  return {};
}

Expected<void> Snakes::replace(int snake, const Curve& curve, const SnakeSettings& settings) {
  if (snake < 0 || snake >= count())
    return input_error(fmt::format("there is no snake {}", snake), "snakes");
  auto anew = snake_on(curve, settings);
  if (!anew) return std::unexpected(anew.error().within(fmt::format("snakes[{}]", snake)));
  state_->snakes[static_cast<std::size_t>(snake)] = std::move(*anew);
  state_->fine.clear();  // what was tried was beside another
  return {};
}

Expected<std::vector<SnakeResult>> Snakes::results() const {
  std::vector<SnakeResult> all;
  for (int k = 0; k < count(); ++k) {
    auto one = result(k);
    if (!one) return std::unexpected(one.error());
    all.push_back(std::move(*one));
  }
  return all;
}

Expected<std::vector<SnakeResult>> run_snakes(const ImagePotential& potential,
                                              const std::vector<Curve>& starts,
                                              const std::vector<SnakeSettings>& settings) {
  auto snakes = Snakes::create(potential, starts, settings);
  if (!snakes) return std::unexpected(snakes.error());
  while (!snakes->ended()) {
    if (auto status = snakes->advance(100); !status) return std::unexpected(status.error());
  }
  return snakes->results();
}

}  // namespace knead
