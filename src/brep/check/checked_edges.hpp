#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bare_faces.hpp"
#include "edge_meetings.hpp"
#include "edge_walk.hpp"
#include "knead/brep/edge_measures.hpp"

namespace knead::brep {

/// One time that a bound runs along an edge.
struct FaceUse {
  Index face = none;
  bool forward = true;  ///< the face is to the left of the edge, as it runs from start to end
};

/// An edge, or a part of one and what it meets there.
struct CheckedEdge {
  std::string id;  ///< "#12", "#12+#15", "#12+#15/2"
  Index edge = none, other = none;
  std::optional<EdgeMeeting> part = {};  ///< none: all of it
};

/// The edges of a model that faces use, the faces around them, and where edges of one face each
/// meet. Surfaces without faces lie under faces that cover them (`with_bare_faces`).
class CheckedEdges {
 public:
  /// \param model outlives this
  CheckedEdges(const Model& model, const EdgeTolerances& tolerances);
  CheckedEdges(const CheckedEdges&) = delete;
  CheckedEdges& operator=(const CheckedEdges&) = delete;
  ~CheckedEdges() = default;

  /// In the order of the file, each part of two that meet once.
  [[nodiscard]] std::vector<CheckedEdge> all() const;
  /// Makes the faces of these ready for feet.
  void prepare(std::span<const CheckedEdge> edges);

  [[nodiscard]] const Model& model() const { return faced_ ? faced_->model : given_; }
  [[nodiscard]] const EdgeScale& scale() const { return scale_; }
  [[nodiscard]] double gap() const { return gap_; }  ///< tolerance of gaps
  [[nodiscard]] const std::vector<FaceUse>& uses(Index edge) const { return uses_[edge]; }
  /// Of an edge that is used.
  [[nodiscard]] const Expected<EdgePiece>& piece(Index edge) const { return *pieces_[edge]; }
  [[nodiscard]] EdgePiece piece(const CheckedEdge& edge) const;
  /// Of a prepared edge.
  [[nodiscard]] const Expected<CheckedFace>& face(Index face) const { return *faces_[face]; }
  /// The B-spline surface under a face; none: another one.
  [[nodiscard]] Index spline_under(Index face) const;
  /// The side of a surface without faces that an edge is; none: it is one of the file.
  [[nodiscard]] std::optional<CheckedFace::Side> side(Index edge) const;

 private:
  [[nodiscard]] Expected<EdgePiece> piece_of(Index edge) const;
  void find_scale(const EdgeTolerances& tolerances);

  const Model& given_;
  std::optional<FacedModel> faced_;
  std::vector<std::vector<FaceUse>> uses_;  // of every edge
  std::vector<Index> used_;
  std::vector<std::optional<Expected<EdgePiece>>> pieces_;
  std::vector<std::optional<Expected<std::shared_ptr<const CheckedSpline>>>> splines_;
  std::vector<std::optional<Expected<CheckedFace>>> faces_;
  EdgeScale scale_;
  double gap_ = 0;
};

}  // namespace knead::brep
