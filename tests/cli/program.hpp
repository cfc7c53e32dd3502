#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "exchange/step/file.hpp"

namespace knead::testing {

using Json = nlohmann::json;

/// A directory of its own for one test, gone afterwards.
class Workshop {
 public:
  Workshop();
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  ~Workshop();

  [[nodiscard]] std::string operator/(const std::string& name) const {
    return (directory_ / name).string();
  }
  /// Writes a file and returns its path.
  [[nodiscard]] std::string file(const std::string& name, const std::string& content) const;
  [[nodiscard]] std::string script(const Json& commands,
                                   const std::string& name = "script.json") const;
  /// The commands as such a script where nothing is held at first, and tools touch all of a
  /// surface.
  [[nodiscard]] std::string script_of_all(const Json& commands,
                                          const std::string& name = "script.json") const;
  /// Names of all files, hidden ones too, sorted.
  [[nodiscard]] std::vector<std::string> files() const;

 private:
  std::filesystem::path directory_;
};

/// What a run of the program left behind.
struct Outcome {
  int code = -1;  ///< exit code; -1 where it did not end by itself
  std::string out, err;
  [[nodiscard]] Json json() const { return Json::parse(out); }
};

/// Runs the command line with these arguments.
/// The program that is tested: the environment's KNEAD_PROGRAM, or the one of this build.
[[nodiscard]] std::string program();
/// \param output where its standard output goes instead of `Outcome::out`, if not empty
[[nodiscard]] Outcome knead(const std::vector<std::string>& arguments,
                            const std::string& output = {});

[[nodiscard]] std::string content_of(const std::string& path);
[[nodiscard]] std::string bonnet();
/// Surface #id of a STEP file; fails the test where there is none.
[[nodiscard]] Surface surface_of(const std::string& path, const std::string& id);

/// The same bytes; says where they differ without printing them.
[[nodiscard]] ::testing::AssertionResult identical(const std::string& a, const std::string& b);

/// True where the run failed as the contract says: this code, nothing but one line on standard
/// error, and that names all of these.
[[nodiscard]] ::testing::AssertionResult fails_with(const Outcome& run, int code,
                                                    const std::vector<std::string>& named);

/// A script's command: command("step", {{"count", 3}}).
[[nodiscard]] inline Json command(const std::string& name, Json fields = Json::object()) {
  fields["do"] = name;
  return fields;
}

}  // namespace knead::testing
