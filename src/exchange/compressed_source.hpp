#pragma once

#include <memory>
#include <string>

#include "knead/exchange/format.hpp"

namespace knead::detail {

/// Opens a compressed file by what it holds; what is saved is compressed likewise. Errors (input):
/// those of `uncompress`, and of the format in it; a build without zlib, such as the studio's
/// module, whose page unpacks by the browser's own means, refuses.
[[nodiscard]] Expected<std::shared_ptr<const Source>> open_compressed(std::string bytes,
                                                                      std::string name,
                                                                      const OpenOptions& options);

}  // namespace knead::detail
