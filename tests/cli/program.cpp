#include "program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

extern char** environ;

namespace knead::testing {

namespace fs = std::filesystem;

Workshop::Workshop() {
  std::string name = (fs::temp_directory_path() / "knead_cli_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) ADD_FAILURE() << "no temporary directory";
  directory_ = name;
}

Workshop::~Workshop() {
  std::error_code ignored;
  fs::remove_all(directory_, ignored);
}

std::string Workshop::file(const std::string& name, const std::string& content) const {
  std::ofstream(directory_ / name, std::ios::binary) << content;
  return *this / name;
}

std::string Workshop::script(const Json& commands, const std::string& name) const {
  return file(name, Json{{"knead", 2}, {"commands", commands}}.dump());
}

std::string Workshop::script_of_all(const Json& commands, const std::string& name) const {
  Json all = {command("hold", {{"rows", 0}, {"all", true}})};
  for (Json each : commands) {
    if (each.at("do") == "tool" && !each.contains("touches")) each["touches"] = "all";
    all.push_back(std::move(each));
  }
  return script(all, name);
}

std::vector<std::string> Workshop::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory_))
    names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

std::string program() {
  const char* const other = std::getenv("KNEAD_PROGRAM");
  return other != nullptr ? other : KNEAD_PROGRAM;
}

Outcome knead(const std::vector<std::string>& arguments, const std::string& output) {
  const Workshop workshop;
  const std::string out = output.empty() ? workshop / "out" : output, err = workshop / "err";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);
  std::vector<std::string> all{program()};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& argument : all) argv.push_back(argument.data());
  argv.push_back(nullptr);
  Outcome run;
  pid_t child = 0;
  const bool started =
      posix_spawn(&child, all.front().c_str(), &actions, nullptr, argv.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (!started || waitpid(child, &status, 0) != child) {
    ADD_FAILURE() << "cannot run " << all.front();
    return run;
  }
  if (WIFEXITED(status)) run.code = WEXITSTATUS(status);
  if (output.empty()) run.out = content_of(out);
  run.err = content_of(err);
  return run;
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) ADD_FAILURE() << "cannot read " << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string bonnet() { return (fs::path(KNEAD_SOURCE_DIR) / "samples/bonnet.step").string(); }

Surface surface_of(const std::string& path, const std::string& id) {
  const auto file = step::File::read(path);
  if (!file) throw std::runtime_error(file.error().message());
  const brep::SplineSurface* found = file->model().find_surface(id);
  if (found == nullptr) throw std::runtime_error(path + " has no surface " + id);
  return found->surface;
}

::testing::AssertionResult identical(const std::string& a, const std::string& b) {
  if (a == b) return ::testing::AssertionSuccess() << "both have the same " << a.size() << " bytes";
  const auto [at, ignored] = std::ranges::mismatch(a, b);
  return ::testing::AssertionFailure()
         << "byte " << at - a.begin() << " of " << a.size() << " and " << b.size();
}

::testing::AssertionResult fails_with(const Outcome& run, int code,
                                      const std::vector<std::string>& named) {
  if (run.code != code)
    return ::testing::AssertionFailure() << "exit code " << run.code << ", " << run.err;
  if (!run.err.starts_with("knead: ") || run.err.find('\n') != run.err.size() - 1) {
    return ::testing::AssertionFailure() << "not one line: " << run.err;
  }
  for (const std::string& name : named) {
    if (run.err.find(name) == std::string::npos) {
      return ::testing::AssertionFailure() << "does not name \"" << name << "\": " << run.err;
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace knead::testing
