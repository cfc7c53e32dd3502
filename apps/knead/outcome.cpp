#include "outcome.hpp"

namespace knead::cli {
namespace {

bool is_negative = false;

}  // namespace

void set_negative_outcome(bool negative) { is_negative = negative; }
bool negative_outcome() { return is_negative; }

}  // namespace knead::cli
