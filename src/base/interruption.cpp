#include "interruption.hpp"

#include <utility>

namespace knead {
namespace {

thread_local Interruption* innermost = nullptr;

}  // namespace

Interruption::Interruption(std::function<bool()> go_on)
    : go_on_(std::move(go_on)), outer_(innermost) {
  innermost = this;
}

Interruption::~Interruption() { innermost = outer_; }

bool Interruption::asked_for() {
  Interruption* const here = innermost;
  if (here == nullptr || !here->go_on_) return false;
  if (!here->happened_) here->happened_ = !here->go_on_();
  return here->happened_;
}

void Interruption::settle() {
  if (innermost == nullptr) return;
  innermost->go_on_ = nullptr;
  innermost->happened_ = false;
}

std::unexpected<Error> interrupted_error() { return input_error("it was stopped before its end"); }

}  // namespace knead
