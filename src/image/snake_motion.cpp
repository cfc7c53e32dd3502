#include "snake_motion.hpp"

#include <algorithm>
#include <limits>

namespace knead {
namespace {

constexpr int places_compared = 10, highest_level = 40, patience = 20;

}  // namespace

// Ten places are collected, then the eleventh is compared with all of them: a snake that circles
// through some of them rests as well. Moves shrink by 2^level as viscosity grows, and are counted
// as if it had not.
void SnakeMotion::went_to(const Points& c, double rest) {
  if (static_cast<int>(before_.size()) < places_compared) {
    before_.push_back(c);
    return;
  }
  last_ = std::numeric_limits<double>::infinity();
  for (const Points& earlier : before_)
    last_ = std::min(last_, (c - earlier).cwiseAbs().rowwise().sum().maxCoeff());
  last_ = std::ldexp(last_, level_);
  resting_ = last_ < rest;
  before_.clear();
}

// An explicit force with a stiffness above 2γ makes control points swing ever wider across an edge,
// each move against the last one. Where those that turn back outweigh a quarter of all, γ is
// doubled, which halves the step; after 20 moves that go on by nine tenths it is halved again.
bool SnakeMotion::steadied(const Points& move) {
  double onwards = 0, all = 0;  // how much of the motion goes on as before
  if (move_.rows() == move.rows()) {
    const Eigen::VectorXd along = move.cwiseProduct(move_).rowwise().sum();
    onwards = along.sum();
    all = along.cwiseAbs().sum();
  }
  const bool turned = onwards<0.5 * all, straight = onwards> 0.9 * all;
  move_ = move;
  steadily_ = straight ? steadily_ + 1 : 0;
  const int before = level_;
  if (turned && level_ < highest_level) ++level_;
  if (steadily_ >= patience && level_ > 0) --level_, steadily_ = 0;
  return level_ != before;
}

// |d| ↦ m tanh(|d|/m): the identity for small moves, without a kink where it begins to limit them.
Points limited(Points moves, double most) {
  for (Eigen::Index k = 0; k < moves.rows(); ++k) {
    const double length = moves.row(k).norm();
    if (length > 0) moves.row(k) *= most * std::tanh(length / most) / length;
  }
  return moves;
}

}  // namespace knead
