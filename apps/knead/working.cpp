#include "working.hpp"

#include <utility>

namespace knead::cli {
namespace {

std::string place_now;

}  // namespace

void work_on(std::string place) { place_now = std::move(place); }
const std::string& place_of_work() { return place_now; }

}  // namespace knead::cli
