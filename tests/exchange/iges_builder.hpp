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

  /// Returns its directory number. `parameters` without the type; `count`: as the directory states
  /// it.
  int add(int type, const std::string& parameters, int transform = 0, int form = 0, int count = 0,
          const std::string& comment = "") {
    std::string text = std::to_string(type) + separator + parameters + terminator + comment;
    const int number = 2 * static_cast<int>(entities_.size()) + 1;
    Entity entity{type, transform, form, static_cast<int>(lines_.size()) + 1, count, {}};
    while (!text.empty()) {
      std::size_t take = std::min<std::size_t>(text.size(), 64);
      if (take < text.size()) take = text.rfind(separator, take - 1) + 1;
      if (take == 0) take = 64;
      lines_.push_back(
          fmt::format("{:<64}{:>8}P{:>7}", text.substr(0, take), number, lines_.size() + 1));
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
      result += fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}D{:>7}{}", e.type,
                            e.first, 0, 0, 0, 0, e.transform, 0, "00000000", ++records, eol);
      result += fmt::format("{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}{:>8}D{:>7}{}", e.type, 0, 0,
                            e.count, e.form, "", "", "PLATE", 0, ++records, eol);
    }
    for (const std::string& line : lines_) result += line + eol;
    return result + fmt::format("S{:>7}G{:>7}D{:>7}P{:>7}{:<40}T{:>7}{}", 1, globals, records,
                                lines_.size(), "", 1, eol);
  }

 private:
  struct Entity {
    int type, transform, form, first, count;
    std::string label;
  };
  std::vector<Entity> entities_;
  std::vector<std::string> lines_;
};

/// The parameters of a bilinear plate [0, 4] × [0, 2], three control points in u and two in v;
/// heights may be written as they like.
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
  for (int k = 0; k < 4; ++k)
    sides.push_back(b.add(110, fmt::format("{},{}", corners[k], corners[(k + 1) % 4])));
  for (int k = 0; k < 4; ++k) {
    edges += fmt::format(",{},{},{},{},{}", sides[static_cast<std::size_t>(k)], vertices, k + 1,
                         vertices, (k + 1) % 4 + 1);
  }
  const int list = b.add(504, edges, 0, 1);
  for (int k = 0; k < 4; ++k) loop += fmt::format(",0,{},{},1,0", list, k + 1);
  const int bound = b.add(508, loop, 0, 1);
  b.add(510, fmt::format("{},1,1,{}", surface, bound), 0, 1);
  return b.text();
}

/// Two plates side by side, the second over x from 4 to 8: as a B-rep whose faces share an edge
/// (504), or as trimmed surfaces (144) each of which has a curve of its own there, the second one
/// turned. The second half is moved back by `apart`.
struct TwoPlates {
  std::string text;
  std::string left, right;  ///< surfaces
  std::string edge;         ///< in the view
  int curves = 0;           ///< along it
};
inline TwoPlates two_plates(bool shared, double apart = 0) {
  IgesBuilder b;
  const int left = b.add(128, plate());
  const int matrix = b.add(124, fmt::format("1.,0.,0.,{:.17g},0.,1.,0.,0.,0.,0.,1.,0.", 4 + apart));
  const int right = b.add(128, plate(), matrix);
  const auto corner = [&](int k, bool second) {
    return fmt::format("{:.17g},{}.,0.", (k == 1 || k == 2 ? 4 : 0) + (second ? 4 + apart : 0),
                       k > 1 ? 2 : 0);
  };
  TwoPlates result{{}, fmt::format("#{}", left), fmt::format("#{}", right), {}, shared ? 1 : 2};
  if (shared) {
    const int vertices =
        b.add(502, "6,0.,0.,0.,4.,0.,0.,4.,2.,0.,0.,2.,0.,8.,0.,0.,8.,2.,0.", 0, 1);
    constexpr int ends[7][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {1, 4}, {4, 5}, {5, 2}};
    const char* places[] = {"0.,0.,0.", "4.,0.,0.", "4.,2.,0.", "0.,2.,0.", "8.,0.,0.", "8.,2.,0."};
    std::string edges = "7";
    for (const auto& [from, to] : ends) {
      const int curve = b.add(110, fmt::format("{},{}", places[from], places[to]));
      if (from == 1 && to == 2) result.edge = fmt::format("#{}", curve);
      edges += fmt::format(",{},{},{},{},{}", curve, vertices, from + 1, vertices, to + 1);
    }
    const int list = b.add(504, edges, 0, 1);
    const int first =
        b.add(508, fmt::format("4,0,{0},1,1,0,0,{0},2,1,0,0,{0},3,1,0,0,{0},4,1,0", list), 0, 1);
    const int second =
        b.add(508, fmt::format("4,0,{0},5,1,0,0,{0},6,1,0,0,{0},7,1,0,0,{0},2,0,0", list), 0, 1);
    b.add(510, fmt::format("{},1,1,{}", left, first), 0, 1);
    b.add(510, fmt::format("{},1,1,{}", right, second), 0, 1);
  } else {
    for (const bool second : {false, true}) {
      std::string parts = "4";
      for (int k = 0; k < 4; ++k) {
        const int curve = b.add(110, corner(k, second) + "," + corner((k + 1) % 4, second));
        if (!second && k == 1) result.edge = fmt::format("#{}", curve);
        parts += fmt::format(",{}", curve);
      }
      const int loop = b.add(102, parts);
      const int surface = second ? right : left;
      b.add(144, fmt::format("{},1,0,{}", surface,
                             b.add(142, fmt::format("1,{},0,{},2", surface, loop))));
    }
  }
  result.text = b.text();
  return result;
}

}  // namespace knead::testing
