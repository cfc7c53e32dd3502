// The studio's engine as WebAssembly exports it. The page writes a request and its bytes to
// `knead_input(size)`, calls, and reads the answer from `knead_text()`; every call may grow the
// memory, so that views of it must be taken anew.
#include <string>
#include <utility>

#include "queries.hpp"

#define KNEAD_IMPORT(name) __attribute__((import_module("studio"), import_name(#name)))

/// Of the host: how many steps of the command under way are done, of how many. Not 0: it stops, and
/// they stay.
extern "C" KNEAD_IMPORT(progress) int knead_progress(int steps, int total);
/// Asked within steps. Not 0: the command stops, and the present step is given up.
extern "C" KNEAD_IMPORT(stops) int knead_stops();

#define KNEAD_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace knead::studio {
namespace {

struct Held {
  std::string input, text;
  Answer answer;
  Studio studio;
  Held() {
    studio.progress = [](int steps, int total) { return knead_progress(steps, total) == 0; };
    studio.go_on = [] { return knead_stops() == 0; };
  }
};

Held& held() {
  static Held value;
  return value;
}

}  // namespace
}  // namespace knead::studio

using namespace knead::studio;

KNEAD_EXPORT(knead_input) char* knead_input(std::size_t size) {
  held().input.resize(size);
  return held().input.data();
}

/// `knead::studio::call` of the input.
KNEAD_EXPORT(knead_call) void knead_call(std::size_t json_size) {
  Held& h = held();
  h.text = call(h.studio, std::exchange(h.input, {}), json_size, h.answer);
}

KNEAD_EXPORT(knead_text) const char* knead_text() { return held().text.data(); }
KNEAD_EXPORT(knead_text_size) std::size_t knead_text_size() { return held().text.size(); }
