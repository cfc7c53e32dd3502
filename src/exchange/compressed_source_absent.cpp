// A build without zlib.
#include "compressed_source.hpp"
#include "foreign_format.hpp"

namespace knead::detail {

Expected<std::shared_ptr<const Source>> open_compressed(std::string bytes, std::string name,
                                                        const OpenOptions& /*options*/) {
  Error error = foreign_format(bytes).value_or(
      Error{ErrorKind::input, "the file is compressed", {}, "unpack it"});
  error.file = std::move(name);
  return std::unexpected(std::move(error));
}

}  // namespace knead::detail
