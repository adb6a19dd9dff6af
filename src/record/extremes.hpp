// The greatest values that numbers of a run take, over its continuous motion.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "base/chebyshev.hpp"
#include "base/greatest.hpp"
#include "model/model.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Looks at each piece of a run at as many points as the integrator's polynomial has detail there,
// both ends included, hence at both sides of every switch. Where a number may be greater between
// two points than it was anywhere before, it goes for that maximum on the polynomial.
class Extremes : public solve::PieceSink {
 public:
  // Writes all the numbers, of one instant. What is no number is passed over.
  using Look = std::function<void(const model::Sample& sample, double* numbers)>;

  struct Greatest {
    double value;
    double t;  // s
  };

  Extremes(std::size_t count, Look look);

  // Begins anew, with a model that outlives the run.
  void begin(const model::Model& model);
  // An instant that may be of no piece, such as the start of a run that ends there.
  void note(const model::Sample& sample);

  void begin_run() override;
  void accept(const solve::Piece& piece) override;

  [[nodiscard]] std::size_t size() const { return greatest_.size(); }
  // No number before there was one.
  [[nodiscard]] const Greatest& operator[](std::size_t i) const { return greatest_[i]; }

 private:
  void sample(const solve::Piece& piece, const ChebyshevPoints& points);
  [[nodiscard]] bool may_matter(std::size_t i, std::size_t count) const;
  [[nodiscard]] bool is_shown(std::size_t i, const ChebyshevPoints& points) const;
  void take(std::size_t i, double value, double t);
  void climb_within(std::size_t i, const solve::Piece& piece, const ChebyshevPoints& points);

  Look look_;
  const model::Model* model_ = nullptr;
  std::vector<Greatest> greatest_;
  ChebyshevTables tables_;
  std::vector<double> times_, rows_, one_;  // one_: the numbers of an instant
  std::vector<double> values_, finer_;      // of each number, its values at the points
  std::vector<std::size_t> matter_;         // those that may be greater in this piece than before
};

}  // namespace bbsim::record
