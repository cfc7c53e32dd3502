// Snakes in an image as WebAssembly exports them: the studio's panel of images. The caller writes
// bytes to `snake_input(count)`, calls, and reads JSON from `snake_text()` and arrays from
// `snake_buffer(which)`; every call may grow the memory, so views of it must be renewed. Functions
// that can fail return 0 on failure; the text is then
// {"error": …}, and the previous state stays.
#include <nlohmann/json.hpp>

#include "answers.hpp"
#include "knead/image/snake_script.hpp"
#include "snake_page.hpp"

#define KNEAD_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace knead::snakes {
namespace {

using Json = nlohmann::json;

struct Held {
  std::vector<std::uint8_t> input;
  std::string text;
  SnakePage page;
  Lines lines;
  std::vector<std::uint8_t> pixels;
};

Held& held() {
  static Held value;
  return value;
}

std::string_view input_text() {
  return {reinterpret_cast<const char*>(held().input.data()), held().input.size()};
}

int answer(const Json& json) { return answer_in(held().text, json); }
int fail(const Error& error) { return fail_in(held().text, error); }

/// How the snakes are, and where in the buffers.
int state() {
  held().lines = held().page.lines();
  Json all = Json::array();
  for (const SnakeResult& s : held().page.results()) {
    all.push_back({{"closed", s.closed}, {"iterations", s.iterations}, {"resting", s.converged}});
  }
  return answer({{"snakes", std::move(all)}, {"ended", held().page.ended()}});
}

int state_after(const Expected<void>& status) { return status ? state() : fail(status.error()); }

}  // namespace
}  // namespace knead::snakes

using namespace knead;
using namespace knead::snakes;

KNEAD_EXPORT(snake_input) std::uint8_t* snake_input(std::size_t count) {
  held().input.resize(count);
  return held().input.data();
}

KNEAD_EXPORT(snake_text) const char* snake_text() { return held().text.data(); }
KNEAD_EXPORT(snake_text_size) std::size_t snake_text_size() { return held().text.size(); }

/// The image from the input, four bytes a pixel.
KNEAD_EXPORT(snake_image) int snake_image(int width, int height) {
  return state_after(held().page.set_image(grey_of(held().input, width, height)));
}

/// The mask that `distance` counts from, likewise; 0 × 0: none.
KNEAD_EXPORT(snake_mask) int snake_mask(int width, int height) {
  held().page.set_mask(width > 0 ? std::optional(grey_of(held().input, width, height))
                                 : std::nullopt);
  return state();
}

/// The script in the input: settings, and snakes, of which those that are there go on unless
/// `again` is 1.
KNEAD_EXPORT(snake_script) int snake_script(int again) {
  return state_after(held().page.set_script(input_text(), again != 0));
}

KNEAD_EXPORT(snake_advance) int snake_advance(int iterations) {
  return state_after(held().page.advance(iterations));
}

/// No snakes; the image and the mask stay.
KNEAD_EXPORT(snake_clear) int snake_clear() {
  held().page.remove_snakes();
  return state();
}

/// Keeps snakes, script and mask as they are; the text is {"kept": number}.
KNEAD_EXPORT(snake_keep) int snake_keep() { return answer({{"kept", held().page.keep()}}); }

/// All is as it was when it was kept.
KNEAD_EXPORT(snake_restore) int snake_restore(int kept) {
  return state_after(held().page.restore(kept));
}

KNEAD_EXPORT(snake_forget) void snake_forget(int kept) { held().page.forget(kept); }

/// Snakes that have ended may go on.
KNEAD_EXPORT(snake_wake) int snake_wake() { return state_after(held().page.wake()); }

/// The user's hand draws the point at the fraction `at` of a snake; snake −1: it lets go.
KNEAD_EXPORT(snake_pull) int snake_pull(int snake, double at, double x, double y, double strength) {
  if (snake < 0) return state_after(held().page.pull({}));
  return state_after(
      held().page.pull(Hand{static_cast<std::size_t>(snake), {at, {x, y}, strength}}));
}

KNEAD_EXPORT(snake_move) int snake_move(int snake, int point, double x, double y) {
  return state_after(held().page.move_point(static_cast<std::size_t>(snake), point, x, y));
}

/// The text becomes the contours: 0 JSON (the image's name is in the input), 1 CSV, 2 SVG.
KNEAD_EXPORT(snake_save) int snake_save(int kind) {
  const auto& image = held().page.image();
  if (!image) return fail({ErrorKind::usage, "there is no image", {}, "open one first"});
  const auto snakes = held().page.results();
  held().text = kind == 0   ? snakes_json(snakes, input_text(), image->width, image->height)
                : kind == 1 ? snakes_csv(snakes)
                            : snakes_svg(snakes, image->width, image->height);
  return 1;
}

/// Buffer 4 becomes pixels, a byte each: 0 white inside of the contours, 1 the energy that attracts
/// them.
KNEAD_EXPORT(snake_picture) int snake_picture(int kind) {
  const auto& image = held().page.image();
  if (!image) return fail({ErrorKind::usage, "there is no image", {}, "open one first"});
  if (kind == 1) {
    held().pixels = held().page.energy();
  } else {
    held().pixels.clear();
    for (const double x : snakes_mask(held().page.results(), image->width, image->height).values) {
      held().pixels.push_back(x > 0.5 ? 255 : 0);
    }
  }
  return answer({{"width", image->width}, {"height", image->height}});
}

namespace {
struct Bytes {
  const void* data = nullptr;
  std::size_t size = 0;
};

template <class T>
Bytes bytes_of(const std::vector<T>& v) {
  return {v.data(), v.size() * sizeof(T)};
}

Bytes buffer(int which) {
  const Held& h = held();
  switch (which) {
    case 0:
      return bytes_of(h.lines.points);
    case 1:
      return bytes_of(h.lines.offsets);
    case 2:
      return bytes_of(h.lines.net);
    case 3:
      return bytes_of(h.lines.net_from);
    case 4:
      return bytes_of(h.pixels);
    default:
      return {};
  }
}
}  // namespace

/// 0 to 3: `Lines` in the order of its fields; 4: `snake_picture`.
KNEAD_EXPORT(snake_buffer) const void* snake_buffer(int which) { return buffer(which).data; }
KNEAD_EXPORT(snake_buffer_size) std::size_t snake_buffer_size(int which) {
  return buffer(which).size;
}
