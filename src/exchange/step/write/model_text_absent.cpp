#include "model_text.hpp"

namespace knead::step {

Expected<std::string> model_text(const detail::FacePlan& /*plan*/, const TextOptions& /*options*/) {
  return input_error("new STEP files of faces are not written here", {}, "use `knead export`");
}

}  // namespace knead::step
