#include "cad_input.hpp"

#include <filesystem>
#include <limits>

#include "knead/exchange/file_io.hpp"

namespace knead::cli {

std::string cad_file_help() {
  return "CAD file: " + list_of_endings(FormatContent::surfaces, true) +
         "; compressed too (.stpZ, .step.gz)";
}

void UnpackOption::add_to(CLI::App& command) {
  // The reader of STEP counts bytes in 32 bits.
  constexpr int most = 4095;
  command.add_option("--max-unpacked", mebibytes, "MiB that a compressed FILE may hold")
      ->check(CLI::Range(1, most))
      ->capture_default_str();
}

OpenOptions UnpackOption::options() const {
  return {.max_unpacked = static_cast<std::size_t>(mebibytes) << 20U};
}

Expected<std::shared_ptr<const Source>> open_cad_file(const std::string& file,
                                                      const UnpackOption& most) {
  auto bytes = read_file(file);
  if (!bytes) return std::unexpected(std::move(bytes.error()));
  return open_source(*std::move(bytes), file, most.options());
}

Expected<std::string> compressed_by_name(std::string bytes, const std::string& output,
                                         const std::string& input) {
  namespace fs = std::filesystem;
  const Compression wanted = compression_of_name(output), present = compression_of(bytes);
  if (wanted == present) return bytes;
  if (wanted == Compression::none && (fs::path(output).extension() == fs::path(input).extension() ||
                                      !format_of_name(output, FormatContent::surfaces))) {
    return bytes;
  }
  return compress_by_name(std::move(bytes), output);
}

}  // namespace knead::cli
