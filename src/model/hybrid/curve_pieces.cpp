// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/curve_pieces.hpp"

#include <algorithm>

namespace bbsim::model {

CurvePieces::CurvePieces(SwitchedModel& model) : model_(model) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (linkage(i).table) pieces_[i] = command_pieces_[i] = linkage(i).piece_at(0, 0, 1);
  }
}

void CurvePieces::put() {
  auto& loop = std::get<CoupledLoop<SignalPair, Linkages>>(model_.get().system).loop;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!linkage(i).table) continue;
    LinkCurve& curve = loop.link.of[i];
    curve.piece = linkage(i).table->view().pieces[pieces_[i]];
    curve.command_piece = linkage(i).table->view().pieces[command_pieces_[i]];
  }
}

void CurvePieces::choose(double t, const double* z) {
  const Demands demands = model_.demands(t, z);
  for (std::size_t i = 0; i < 2; ++i) {
    const Linkage& of = linkage(i);
    if (!of.table) continue;
    const AxisMode& axis = model_.mode().axis[i];
    const double horn = axis.ratio * z[SwitchedModel::angle + i] + axis.offset;
    pieces_[i] = of.piece_at(pieces_[i], horn, axis.ratio * z[model_.rate() + i]);
    if (converts_commands(of)) {
      command_pieces_[i] = of.command_piece_at(command_pieces_[i], demands.command[i]);
    }
  }
  put();
}

void CurvePieces::evaluate(const GuardContext& now, double* values) const {
  std::fill(values, values + guards(), unlimited);
  for (std::size_t i = 0; i < 2; ++i, values += Guard::count) {
    const Linkage& of = linkage(i);
    if (!of.table) continue;
    const AxisMode& axis = model_.mode().axis[i];
    const double horn = axis.ratio * now.z[SwitchedModel::angle + i] + axis.offset;
    const std::size_t last = of.table->knots().size() - 2;
    const CommandRange holds = of.piece_range(pieces_[i]);
    // The dead_point monitor handles the ends of the whole curve.
    if (pieces_[i] < last) values[Guard::high] = holds.high - horn;
    if (pieces_[i] > 0) values[Guard::low] = horn - holds.low;
    if (!converts_commands(of)) continue;
    const CommandRange command = of.command_piece_range(command_pieces_[i]);
    const bool rises = of.curve.slope > 0;
    const bool at_first = command_pieces_[i] == 0, at_last = command_pieces_[i] == last;
    const double wants = now.demands().command[i] + of.curve.shift;
    if (!(rises ? at_last : at_first)) values[Guard::command_high] = command.high - wants;
    if (!(rises ? at_first : at_last)) values[Guard::command_low] = wants - command.low;
  }
}

}  // namespace bbsim::model
