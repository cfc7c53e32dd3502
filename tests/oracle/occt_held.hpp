#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace knead::oracle {

/// All faces of a STEP, IGES or .brep file with their edges, as Open CASCADE reads them; lengths in
/// mm.
class OcctHeld {
 public:
  /// None where it cannot be read.
  [[nodiscard]] static std::optional<OcctHeld> read(const std::filesystem::path& path);

  /// Of every edge of every face, in order: how far 21 points of its curve are from the surface of
  /// the face.
  [[nodiscard]] std::vector<double> gaps() const;
  [[nodiscard]] int bad_shapes() const;  ///< faces and edges that BRepCheck finds fault with

  struct Data;

 private:
  explicit OcctHeld(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Data> data_;
};

}  // namespace knead::oracle
