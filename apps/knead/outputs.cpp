#include "outputs.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "knead/exchange/file_io.hpp"
#include "left_out_lines.hpp"

namespace knead::cli {
namespace {

namespace fs = std::filesystem;

bool is_special(const std::string& path) {
  std::error_code code;
  return fs::exists(path, code) && !fs::is_regular_file(path, code) &&
         !fs::is_directory(path, code);
}

bool same_file(const std::string& a, const std::string& b) {
  if (is_special(a)) return false;
  std::error_code code;
  return a == b || fs::equivalent(a, b, code) ||
         fs::weakly_canonical(a, code) == fs::weakly_canonical(b, code);
}

std::string files_written;

}  // namespace

Expected<void> check_name(const NamedFile& output, std::string_view ending,
                          std::string_view content) {
  std::string given = fs::path(output.path).extension().string();
  for (char& c : given) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (given.empty() || given == ending || is_special(output.path)) return {};
  return usage_error(fmt::format("\"{}\" is not the name of {}", output.path, content),
                     output.option, fmt::format("use a name that ends in {}", ending));
}

Expected<void> write_output(const std::string& path, std::string_view bytes) {
  auto status = write_file_atomically(path, bytes);
  if (status) files_written += (files_written.empty() ? "" : ", ") + path;
  return status;
}

const std::string& written_outputs() { return files_written; }

Expected<void> check_outputs(const std::vector<NamedFile>& outputs,
                             const std::vector<NamedFile>& inputs) {
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const auto& [option, path] = outputs[k];
    if (path.empty()) continue;
    const auto clash = [&](const NamedFile& other) -> Expected<void> {
      if (other.path.empty() || !same_file(path, other.path)) return {};
      return usage_error(fmt::format("{} is also the {}", path, other.option), option,
                         "name another file");
    };
    for (const NamedFile& input : inputs) {
      if (auto free = clash(input); !free) return free;
    }
    for (std::size_t j = 0; j < k; ++j) {
      if (auto free = clash(outputs[j]); !free) return free;
    }
    if (auto possible = check_writable(path); !possible) return possible;
  }
  return {};
}

Expected<std::string> bytes_of_faces(const Session& session, const Format& format,
                                     const SaveOptions& how) {
  auto made = save_faces(session, format, how);
  if (!made) return std::unexpected(std::move(made.error()));
  warn_left_out(made->left_out);
  return std::move(made->bytes);
}

}  // namespace knead::cli
