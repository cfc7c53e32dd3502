#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "knead/exchange/format.hpp"

namespace knead::cli {

/// The help text of FILE: the endings of CAD files.
[[nodiscard]] std::string cad_file_help();

/// The option `--max-unpacked`, in MiB.
struct UnpackOption {
  int mebibytes = static_cast<int>(max_file_size >> 20U);

  void add_to(CLI::App& command);
  [[nodiscard]] OpenOptions options() const;
};

/// Reads and opens a CAD file.
[[nodiscard]] Expected<std::shared_ptr<const Source>> open_cad_file(const std::string& file,
                                                                    const UnpackOption& most);

/// The bytes of a CAD file, compressed or not as the name that they get says: ".gz" and ".stpZ"
/// compress, other endings of CAD files do not. Where the name says nothing, or has the ending of
/// the input, they stay as they are, which is as the input is.
[[nodiscard]] Expected<std::string> compressed_by_name(std::string bytes, const std::string& output,
                                                       const std::string& input);

}  // namespace knead::cli
