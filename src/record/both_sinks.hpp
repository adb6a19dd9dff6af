// One run for two who look at it.
#pragma once

#include "solve/outcome.hpp"
#include "solve/piece.hpp"

namespace bbsim::record {

// Passes pieces on to two sinks, of which either may be null.
class BothPieces : public solve::PieceSink {
 public:
  BothPieces(solve::PieceSink* one, solve::PieceSink* other) : one_(one), other_(other) {}
  void begin_run() override {
    if (one_ != nullptr) one_->begin_run();
    if (other_ != nullptr) other_->begin_run();
  }
  void accept(const solve::Piece& piece) override {
    if (one_ != nullptr) one_->accept(piece);
    if (other_ != nullptr) other_->accept(piece);
  }
  // Who is to be told: null if nobody asks.
  [[nodiscard]] solve::PieceSink* sink() {
    if (one_ == nullptr || other_ == nullptr) return one_ == nullptr ? other_ : one_;
    return this;
  }

 private:
  solve::PieceSink* one_;
  solve::PieceSink* other_;
};

// Passes rows, and the motion between, on to two sinks.
class BothSinks : public solve::StateSink {
 public:
  BothSinks(solve::StateSink& one, solve::StateSink& other)
      : BothSinks(one, other, other.pieces()) {}
  // `others_pieces`: who is told of the motion for the other one, null for nobody.
  BothSinks(solve::StateSink& one, solve::StateSink& other, solve::PieceSink* others_pieces)
      : one_(one), other_(other), pieces_(one.pieces(), others_pieces) {}
  void accept(std::size_t first, std::size_t count, const double* values) override {
    one_.accept(first, count, values);
    other_.accept(first, count, values);
  }
  [[nodiscard]] solve::PieceSink* pieces() override { return pieces_.sink(); }

 private:
  solve::StateSink& one_;
  solve::StateSink& other_;
  BothPieces pieces_;
};

}  // namespace bbsim::record
