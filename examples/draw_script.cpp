// Runs scripts as `knead sculpt --new` does and draws what they leave:
//   example_draw_script SCRIPT.json OUT.svg [FILE.step]
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "draw.hpp"
#include "knead/exchange/file_io.hpp"
#include "run_script.hpp"

namespace {

using namespace knead;

Expected<void> run(const std::string& script, const std::string& out, const std::string& file) {
  const auto session = examples::run_script(script, file);
  if (!session) return std::unexpected(session.error());
  std::vector<Surface> surfaces;
  for (const SessionSurface& s : session->surfaces()) surfaces.push_back(*s.current);
  const auto svg = examples::draw(surfaces, session->tools());
  if (!svg) return std::unexpected(svg.error());
  return write_file_atomically(out, *svg);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3 && argc != 4) {
    std::fputs("usage: example_draw_script SCRIPT.json OUT.svg [FILE.step]\n", stderr);
    return 2;
  }
  const auto status = run(argv[1], argv[2], argc == 4 ? argv[3] : "");
  if (!status) {
    fmt::print(stderr, "example_draw_script: {}\n", status.error().message());
    return 1;
  }
  return 0;
} catch (const std::exception& e) {
  std::fputs(e.what(), stderr);
  return 1;
}
