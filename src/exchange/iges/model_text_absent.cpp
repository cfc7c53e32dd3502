#include "model_text.hpp"

namespace knead::iges {

Expected<std::string> model_text(const detail::FacePlan& /*plan*/, const SaveOptions& /*options*/) {
  return input_error("new IGES files of faces are not written here", {}, "use `knead export`");
}

}  // namespace knead::iges
