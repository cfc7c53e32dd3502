#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace knead::testing {

/// Writes IGES files entity by entity.
class IgesBuilder {
 public:
  std::string eol = "\n";
  std::string global =
      "1H,,1H;,5HPlate,9HPlate.igs,5HMaker,3H1.0,32,38,6,308,15,5HPlate,1.,2,2HMM,1,0.01,"
      "15H20240101.000000,1E-6,100.,,,11,0,15H20240101.000000;";
  char separator = ',', terminator = ';';

  /// Returns its directory number. `parameters` without the type; `count`: as the directory states it.
  int add(int type, const std::string& parameters, int transform = 0, int form = 0, int count = 0,
          const std::string& comment = "") {
    std::string text = std::to_string(type) + separator + parameters + terminator + comment;
    const int number = 2 * static_cast<int>(entities_.size()) + 1;
    Entity entity{type, transform, form, static_cast<int>(lines_.size()) + 1, count, {}};
    while (!text.empty()) {
      std::size_t take = std::min<std::size_t>(text.size(), 64);
      if (take < text.size()) take = text.rfind(separator, take - 1) + 1;
      if (take == 0) take = 64;
      lines_.push_back(fmt::format("{:<64}{:>8}P{:>7}", text.substr(0, take), number, lines_.size() + 1));
      text.erase(0, take);
      if (count == 0) ++entity.count;
    }
    entities_.push_back(entity);
    return number;
  }

  [[nodiscard]] std::string text() const {
    std::string result = fmt::format("{:<72}S{:>7}{}", "a plate", 1, eol);
    int globals = 0;
    for (std::size_t at = 0; at < global.size(); at += 72) {
      result += fmt::format("{:<72}G{:>7}{}", global.substr(at, 72), ++globals, eol);
    }
    int records = 0;
    for (const Entity& e : entities_) {
      result += fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}D{:>7}{}", e.type, e.first, 0, 0, 0, 0,
                            e.transform, 0, "00000000", ++records, eol);
      result += fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}D{:>7}{}", e.type, 0, 0, e.count, e.form, "",
                            "", "PLATE", 0, ++records, eol);
    }
    for (const std::string& line : lines_) result += line + eol;
    return result +
           fmt::format("S{:>7}G{:>7}D{:>7}P{:>7}{:<40}T{:>7}{}", 1, globals, records, lines_.size(), "", 1, eol);
  }

 private:
  struct Entity {
    int type, transform, form, first, count;
    std::string label;
  };
  std::vector<Entity> entities_;
  std::vector<std::string> lines_;
};

/// The parameters of a bilinear plate [0, 4] × [0, 2], three control points in u and two in v; heights may be written
/// as they like.
inline std::string plate(const std::string& height = "0.") {
  std::string text = "2,1,1,1,0,0,1,0,0,0.,0.,0.5,1.,1.,0.,0.,1.,1.,1.,1.,1.,1.,1.,1.";
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 3; ++i) text += fmt::format(",{}.,{}.,{}", 2 * i, 2 * j, height);
  }
  return text + ",0.,1.,0.,1.";
}

/// The plate as a B-rep: one face (510) with a loop of shared edges.
inline std::string shell() {
  IgesBuilder b;
  const int surface = b.add(128, plate());
  const int vertices = b.add(502, "4,0.,0.,0.,4.,0.,0.,4.,2.,0.,0.,2.,0.", 0, 1);
  const char* corners[] = {"0.,0.,0.", "4.,0.,0.", "4.,2.,0.", "0.,2.,0."};
  std::string edges = "4", loop = "4";
  std::vector<int> sides;
  for (int k = 0; k < 4; ++k) sides.push_back(b.add(110, fmt::format("{},{}", corners[k], corners[(k + 1) % 4])));
  for (int k = 0; k < 4; ++k) {
    edges +=
        fmt::format(",{},{},{},{},{}", sides[static_cast<std::size_t>(k)], vertices, k + 1, vertices, (k + 1) % 4 + 1);
  }
  const int list = b.add(504, edges, 0, 1);
  for (int k = 0; k < 4; ++k) loop += fmt::format(",0,{},{},1,0", list, k + 1);
  const int bound = b.add(508, loop, 0, 1);
  b.add(510, fmt::format("{},1,1,{}", surface, bound), 0, 1);
  return b.text();
}

}  // namespace knead::testing
