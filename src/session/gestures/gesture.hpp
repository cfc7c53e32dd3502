#pragma once

#include <concepts>
#include <span>
#include <utility>
#include <vector>

#include "knead/base/error.hpp"
#include "scene/scene.hpp"

namespace knead {

/// What a hand does over one command or several: it is begun with the shapes as they are, led on
/// along a path, and lifted. While it is open, the scene keeps what it was begun with and what it
/// has asked for, and the selected surfaces show what has come of that.
template <class G>
concept Gesture = requires(G gesture, const typename G::Begin& begin,
                           const std::vector<typename G::Place>& path) {
  { std::as_const(gesture).is_open() } -> std::same_as<bool>;
  { gesture.begin(begin) } -> std::same_as<Expected<void>>;
  { gesture.lead(path) } -> std::same_as<Expected<void>>;
  { gesture.lift() } -> std::same_as<Expected<void>>;  // nothing if it is not open
};

/// Begins a gesture unless it is open, leads it along a path, and lifts it unless it stays open.
template <Gesture G>
[[nodiscard]] Expected<void> make(G gesture, const typename G::Begin& begin,
                                  const std::vector<typename G::Place>& path, bool stays_open) {
  if (!gesture.is_open()) {
    if (auto begun = gesture.begin(begin); !begun) return begun;
  }
  if (auto led = gesture.lead(path); !led || stays_open) return led;
  return gesture.lift();
}

/// The shapes of the selected surfaces from before the open gesture; empty: none is open.
[[nodiscard]] inline std::span<const OpenStroke::Before> before_gesture(const Scene& scene) {
  if (scene.stroke) return scene.stroke->before;
  if (scene.brush) return scene.brush->before;
  return {};
}

}  // namespace knead
