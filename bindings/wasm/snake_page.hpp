#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "knead/image/snake_script.hpp"

namespace knead::snakes {

/// What the user's hand draws at: a point of one of the snakes.
struct Hand {
  std::size_t snake = 0;
  SnakeSpring spring = {};
};

/// How snakes are drawn: points in single precision, in pixels.
struct Lines {
  std::vector<float> points;            ///< x, y, parameter (0 to 1) of places along all contours
  std::vector<std::uint32_t> offsets;   ///< where each begins among them, and their end
  std::vector<float> net;               ///< x, y of all control points that can be moved
  std::vector<std::uint32_t> net_from;  ///< likewise
};

/// An image and the snakes in it, each from where it starts to where it is.
class SnakePage {
 public:
  /// Forgets the snakes, the mask and what was kept.
  [[nodiscard]] Expected<void> set_image(Image image);
  /// The mask stays.
  void remove_snakes();
  void set_mask(std::optional<Image> mask);
  /// The snakes of a script whose starts stand in the one before go on from where they are, under
  /// the new settings; the others begin, as all do with `again`. On failure everything stays.
  [[nodiscard]] Expected<void> set_script(std::string_view json, bool again);
  /// Some iterations of all snakes that do not rest.
  [[nodiscard]] Expected<void> advance(int iterations);
  /// Those that rest, or have made all their iterations, may go on.
  [[nodiscard]] Expected<void> wake();
  /// The hand's spring, until it lets go.
  [[nodiscard]] Expected<void> pull(const std::optional<Hand>& hand);
  [[nodiscard]] Expected<void> move_point(std::size_t snake, int point, double x, double y);

  /// Keeps everything but the image as it is now, under a number.
  [[nodiscard]] int keep();
  /// Everything is as it was when it was kept, bit for bit, and goes on as it did then; the hand
  /// has let go. Errors: there is no such number (usage).
  [[nodiscard]] Expected<void> restore(int kept);
  void forget(int kept) { kept_.erase(kept); }

  [[nodiscard]] const std::optional<Image>& image() const { return image_; }
  /// Whether nothing is left to do: all rest or have made their iterations.
  [[nodiscard]] bool ended() const { return !now_.run || now_.run->ended(); }
  [[nodiscard]] std::vector<SnakeResult> results() const;
  [[nodiscard]] Lines lines() const;
  /// Q at the pixels, from black at its smallest to white at its largest.
  [[nodiscard]] std::vector<std::uint8_t> energy() const;

 private:
  struct One {
    SnakeStart start;
    SnakeSettings settings;
    int earlier = 0;  ///< iterations before it was changed last
  };
  /// Everything but the image.
  struct State {
    std::shared_ptr<const Image> mask = {};
    std::optional<ImagePotential> potential = {};
    ImagePotentialSettings energy = {};
    std::vector<One> snakes = {};
    std::optional<Snakes> run = {};
  };
  /// Where one is to go on.
  struct Moved {
    One one;
    Curve curve;
  };
  [[nodiscard]] Expected<Moved> begun(const SnakeScript& script, const SnakeStart& start) const;
  [[nodiscard]] Expected<Moved> goes_on(const One& before, SnakeResult now,
                                        const SnakeScript& script, const SnakeStart& start) const;
  /// Its settings with the hand's spring, if it is this one that is pulled.
  [[nodiscard]] SnakeSettings settings_now(std::size_t snake) const;
  [[nodiscard]] Expected<void> change(std::size_t snake);

  std::optional<Image> image_ = {};
  State now_ = {};
  std::optional<Hand> hand_ = {};
  std::map<int, State> kept_ = {};
  int next_ = 0;
};

/// A grey image of pixels with four bytes each, as the command line makes one; the fourth does not
/// count.
[[nodiscard]] Image grey_of(std::span<const std::uint8_t> rgba, int width, int height);

}  // namespace knead::snakes
