// Writes what the fuzz targets begin with: one folder of small files for each target.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "exchange/brep_square.hpp"
#include "exchange/face_builder.hpp"
#include "exchange/iges_builder.hpp"
#include "exchange/support.hpp"
#include "knead/exchange/file_io.hpp"
#include "knead/session/command_json.hpp"
#include "session/session_state.hpp"
#include "support/made_iges_solids.hpp"

namespace knead {
namespace {

namespace fs = std::filesystem;

class Corpus {
 public:
  explicit Corpus(fs::path folder) : folder_(std::move(folder)) {}

  void add(const std::string& target, const std::string& bytes) {
    fs::create_directories(folder_ / target);
    std::ofstream(folder_ / target / ("seed" + std::to_string(++count_)), std::ios::binary)
        << bytes;
  }

 private:
  fs::path folder_;
  int count_ = 0;
};

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Session after(const std::vector<std::string>& commands) {
  Session session(Document::fresh("sheet"));
  for (const std::string& json : commands) {
    const auto command = parse_command(json);
    const auto status = command ? session.execute(*command) : std::unexpected(command.error());
    if (!status) std::cerr << "seeds: " << json << ": " << status.error().message() << "\n";
  }
  return session;
}

std::string script(const std::vector<std::string>& commands) {
  std::string text = "{\"knead\": 2, \"commands\": [";
  for (const std::string& c : commands) text += (text.back() == '[' ? "\n  " : ",\n  ") + c;
  return text + "\n]}\n";
}

/// Surfaces of every form that scripts make.
const std::vector<std::vector<std::string>> sheets = {
    {R"({"do": "new", "net": [4, 4]})", R"({"do": "points", "rows_u": [2], "by": [0, 0, 0.2]})"},
    {R"({"do": "new", "shape": "cylinder", "net": [7, 4]})"},
    {R"({"do": "new", "shape": "torus", "radius": 2})"},
    {R"({"do": "new", "degree": [1, 2], "net": [2, 3]})",
     R"({"do": "new", "net": [4, 4], "position": [2, 0, 0]})"}};

/// Commands on whatever is selected.
const std::vector<std::vector<std::string>> edits = {
    {R"({"do": "tool", "name": "ball", "shape": "sphere", "radius": 0.2, "at": [0.5, 0.5], )"
     R"("mode": "collision"})",
     R"({"do": "move", "tool": "ball", "by": [0, 0, 0.1]})",
     R"({"do": "step", "count": 2, "lambda": 20})", R"({"do": "release"})"},
    {R"({"do": "edge", "which": "u0", "hold": "open"})",
     R"({"do": "force", "at": [0.5, 0.5], "to": [0, 0, 1]})", R"({"do": "step"})",
     R"({"do": "undo"})", R"({"do": "redo"})"},
    {R"({"do": "refine", "region": [[0, 0.5], [0, 1]]})", R"({"do": "elevate", "by": [1, 0]})",
     R"({"do": "coarsen", "tolerance": 1e-9})",
     R"({"do": "drag", "at": [0.5, 0.5], "by": [0, 0, 0.1]})"},
    {R"({"do": "material", "alpha": [1, 0, 1]})", R"({"do": "load", "pressure": 0.1})",
     R"({"do": "evolve", "mode": "dynamic"})", R"({"do": "step"})"},
    {R"({"do": "lattice", "net": [3, 3, 3], "degree": [2, 2, 2], "steps": 1})"},
    {R"({"do": "morph", "space": "0; 0; 0.1 * x * y"})"}};

void readers(Corpus& corpus) {
  using namespace testing;
  char kind = 0;
  for (const auto& commands : sheets) {
    const Session session = after(commands);
    for (const Format& format : formats()) {
      if (format.save == nullptr) continue;
      const auto bytes = session.save_as(format);
      if (bytes && (format.id == "step" || format.id == "iges"))
        corpus.add(std::string(format.id), *bytes);
    }
  }
  corpus.add("step", content_of(fs::path(KNEAD_SOURCE_DIR) / "examples/figures/patches.step"));
  FaceBuilder square_face;
  corpus.add("step", step_text(square + square_face.text()));
  corpus.add("iges", shell());
  IgesBuilder builder;
  builder.add(128, plate());
  corpus.add("iges", builder.text());
  corpus.add("brep", brep_square);
  corpus.add("brep", brep_square + "0\n");
  corpus.add("iges", iges_box_of_turned_faces());
  corpus.add("iges", iges_ring_in_mm());
  for (const Compression packing : {Compression::none, Compression::gzip, Compression::zip}) {
    corpus.add("packed", *compress(step_text(square + square_face.text()), packing, "a.stp"));
  }
  const fs::path texts = fs::path(KNEAD_SOURCE_DIR) / "tests/fuzz/corpus/text";
  for (const char* ending :
       {".g2", ".xml", ".dat", ".csv", ".json"}) {  // in the order of fuzz_text.cpp
    for (const auto& file : fs::directory_iterator(texts)) {
      if (file.path().extension() == ending)
        corpus.add("text", std::string(1, kind) + content_of(file.path()));
    }
    ++kind;
  }
}

void sessions(Corpus& corpus) {
  for (const auto& commands : sheets) {
    for (const auto& more : edits) {
      std::vector<std::string> all = commands;
      all.insert(all.end(), more.begin(), more.end());
      corpus.add("script", script(all));
    }
    const std::string snapshot = after(commands).snapshot();
    corpus.add("snapshot",
               snapshot.substr(snapshot.find('\n') + 9));  // without its name and checksum
    if (const auto saved = after(commands).save()) {
      for (const auto& more : edits) corpus.add("document", *saved + "\n%%\n" + script(more));
    }
  }
}

}  // namespace
}  // namespace knead

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: knead_fuzz_seeds FOLDER\n";
    return 2;
  }
  knead::Corpus corpus(argv[1]);
  knead::readers(corpus);
  knead::sessions(corpus);
  return 0;
}
