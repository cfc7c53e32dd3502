#include "outputs.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

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

/// A directory that goes when it is left, with what is in it.
struct Passing {
  fs::path path;
  Passing(const Passing&) = delete;
  Passing& operator=(const Passing&) = delete;
  explicit Passing(fs::path made) : path(std::move(made)) {}
  ~Passing() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

/// The directories of `path` that are missing, outermost first.
std::vector<fs::path> missing(const fs::path& path) {
  std::vector<fs::path> result;
  std::error_code ignored;
  for (fs::path at = path; !at.empty() && !fs::exists(at, ignored); at = at.parent_path()) {
    result.insert(result.begin(), at);
  }
  return result;
}

Expected<void> write_into(const fs::path& directory, const std::string& option,
                          const std::vector<std::pair<std::string, std::string>>& files) {
  std::string name = (directory / ".knead-set-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    return input_error(
        "nothing can be written into the directory: " + std::generic_category().message(errno),
        option, "name another one");
  }
  const Passing beside(name);
  for (const auto& [file, bytes] : files) {
    if (auto possible = check_writable(directory / file); !possible) return possible;
    auto status = write_file_atomically(beside.path / file, bytes);
    if (!status) {
      status.error().file = (directory / file).string();
      return status;
    }
  }
  std::error_code problem;
  for (const auto& [file, bytes] : files) {
    fs::rename(beside.path / file, directory / file, problem);
    if (problem)
      return input_error("it cannot be replaced: " + problem.message(),
                         (directory / file).string());
  }
  return {};
}

}  // namespace

Expected<void> check_directory(const NamedFile& directory) {
  const fs::path path(directory.path);
  std::error_code ignored;
  if (fs::exists(path, ignored) && !fs::is_directory(path, ignored))
    return input_error("it is no directory", directory.option, "name another one");
  const std::vector<fs::path> to_make = missing(path);
  auto possible = check_writable(to_make.empty() ? path / ".knead-set" : to_make.front());
  if (possible) return possible;
  return input_error(
      fmt::format("nothing can be written into {}: {}", directory.path, possible.error().message()),
      directory.option, "name another directory");
}

Expected<void> write_together(const NamedFile& directory,
                              const std::vector<std::pair<std::string, std::string>>& files) {
  const fs::path path(directory.path);
  const std::vector<fs::path> made = missing(path);
  std::error_code problem;
  fs::create_directories(path, problem);
  if (problem)
    return input_error("the directory cannot be made: " + problem.message(), directory.option,
                       "name another one");
  auto status = write_into(path, directory.option, files);
  if (status) {
    files_written += (files_written.empty() ? "" : ", ") + directory.path;
    return status;
  }
  for (auto at = made.rbegin(); at != made.rend(); ++at)
    fs::remove(*at, problem);  // if they are empty
  return status;
}

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
