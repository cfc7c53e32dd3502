#include "buffers.hpp"

#include <nlohmann/json.hpp>

namespace knead::studio {

std::string buffers_json(std::initializer_list<Buffer> buffers) {
  auto json = nlohmann::json::object();
  for (const Buffer& b : buffers) {
    json[std::string(b.name)] = {
        {"type", b.type}, {"at", reinterpret_cast<std::uintptr_t>(b.data)}, {"count", b.count}};
  }
  return json.dump();
}

}  // namespace knead::studio
