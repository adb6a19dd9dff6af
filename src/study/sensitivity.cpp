// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/sensitivity.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "base/quoted.hpp"
#include "model/systems/any_jacobian.hpp"
#include "record/recorder.hpp"
#include "record/rows.hpp"
#include "study/event_sensitivity.hpp"
#include "study/radau_rule.hpp"
#include "study/rig_sensitivity.hpp"
#include "study/stage_equations.hpp"

namespace bbsim::study {
namespace {

// Tolerance for the polynomial of S, relative to S. At the end of an arc, S is far more accurate:
// Radau IIA has order 2s - 1 there.
constexpr double precision = 1e-11;
// A piece is halved up to this many times.
constexpr int deepest = 6;
// Effects below this share of the key's largest one may be rounding.
constexpr double least_share = 1e-5;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

// The rule's tables in double.
struct Tables {
  int stages;
  Eigen::VectorXd nodes{stages + 1};        // 0, c_1, ..., c_s = 1
  Eigen::VectorXd barycentric{stages + 1};  // weights of interpolation at them
  Eigen::MatrixXd matrix;
  Eigen::VectorXd last{stages}, previous{stages};  // give Legendre coefficients

  explicit Tables(int s) : stages(s) {
    const RadauRule rule(stages);
    matrix = rule.matrix_in_double;
    nodes[0] = 0;
    for (int i = 0; i < stages; ++i) {
      const auto at = static_cast<std::size_t>(i);
      nodes[i + 1] = plain(rule.nodes[at]);
      last[i] = plain(rule.last_coefficient[at]);
      previous[i] = plain(rule.previous_coefficient[at]);
    }
    for (int i = 0; i <= stages; ++i) {
      barycentric[i] = plain(rule.barycentric[static_cast<std::size_t>(i)]);
    }
  }

  // Interpolation weights of the values at the nodes, at a fraction of the step.
  [[nodiscard]] Eigen::VectorXd shares(double fraction) const {
    Eigen::VectorXd shares(stages + 1);
    for (int i = 0; i <= stages; ++i) {
      const double distance = fraction - nodes[i];
      if (distance == 0) return Eigen::VectorXd::Unit(stages + 1, i);
      shares[i] = barycentric[i] / distance;
    }
    return shares / shares.sum();
  }
};

const Tables& tables(std::size_t choice) {
  static const std::vector<Tables> made(StageChoice::counts.begin(), StageChoice::counts.end());
  return made[choice];
}
// Tables for an arc with one column per node.
const Tables& tables_of(const Eigen::MatrixXd& values) {
  const auto at = std::ranges::find(StageChoice::counts, values.cols() - 1);
  return tables(static_cast<std::size_t>(at - StageChoice::counts.begin()));
}

Eigen::VectorXd rates(const model::Model& model, double t, const double* z) {
  return rates_of(model.system, model.size(), t, z);
}

double power_of_two_below(double value) {
  return std::exp2(std::floor(std::log2(value)));
}

// Whether the model switches by its state, or at the stops of an input next to servos or forces.
// Events alone only observe the motion, or end it.
bool switches_without_samples(const model::Model& model) {
  return model.extras() > 0 && !(model.rig && model.rig->sampled);
}

// The polynomial of an arc that starts at `start`, as a piece whose ends may differ from the arc's.
class ArcPiece : public solve::Piece {
 public:
  ArcPiece(double start, double length, double from, double to, Eigen::MatrixXd values)
      : Piece(from, to, static_cast<int>(values.cols()) - 1),
        start_(start),
        length_(length),
        values_(std::move(values)) {}

  void evaluate(const double* times, std::size_t count, double* rows) const override {
    for (std::size_t i = 0; i < count; ++i) {
      const double fraction = (times[i] - start_) / length_;
      Eigen::Map<Eigen::VectorXd>(rows + i * static_cast<std::size_t>(values_.rows()),
                                  values_.rows()) = values_ * tables_of(values_).shares(fraction);
    }
  }

 private:
  double start_, length_;
  Eigen::MatrixXd values_;
};

}  // namespace

model::Form form_for(const Scenario& scenario, const std::vector<VariedKey>& keys) {
  const auto kind = [](const Scenario& scene, model::Form form) {
    return model::assemble(scene, false, form).system.index();
  };
  const auto suits = [&](model::Form form) {
    const std::size_t own = kind(scenario, form);
    return std::ranges::all_of(keys, [&](const VariedKey& key) {
      return kind(key.scenario(key.value + key.step), form) == own;
    });
  };
  if (keys.empty() || suits(model::Form::reduced)) return model::Form::reduced;
  return suits(model::Form::full) ? model::Form::full : model::Form::general;
}

Sensitivity::Sensitivity(const model::Model& model, model::Form form, const solve::OutputGrid& grid,
                         std::vector<VariedKey> keys)
    : model_(model),
      form_(form),
      grid_(grid),
      size_(static_cast<Eigen::Index>(model.size() + (model.gamma ? 1 : 0))),
      row_(static_cast<Eigen::Index>(model.row_size())),
      spin_(model.spin_state()) {
  const bool sampled = model.rig && model.rig->sampled;
  if (sampled) RigSensitivity::require_smooth_parts(model);
  initial_ = Eigen::MatrixXd::Zero(size_, static_cast<Eigen::Index>(keys.size()));
  for (VariedKey& key : keys) {
    Neighbors& neighbors = keys_.emplace_back(Neighbors{std::move(key), {}});
    if (switches_without_samples(model)) neighbors.key.step *= EventSensitivity::step_share;
    choose_step(neighbors);
    // Other keys may matter in another mode. The neighbors of a scene that switches are close.
    neighbors.pairs = switches_without_samples(model) ? 2 : least_pairs(neighbors);
    initial_.col(static_cast<Eigen::Index>(keys_.size()) - 1).head(size_ - (model.gamma ? 1 : 0)) =
        neighbors.slope([&](std::size_t i) -> Eigen::VectorXd {
          const std::vector<double>& initial = neighbors.models[i].initial;
          return Eigen::Map<const Eigen::VectorXd>(initial.data(),
                                                   static_cast<Eigen::Index>(initial.size()));
        });
  }
  if (sampled) switches_ = std::make_unique<RigSensitivity>(model, keys_);
  if (switches_without_samples(model)) switches_ = std::make_unique<EventSensitivity>(model, keys_);
}

// The widest smooth step has the least rounding. A wave's phase changes more and more with its
// frequency as time passes. If a narrower step is no smoother, only rounding is left.
void Sensitivity::choose_step(Neighbors& neighbors) const {
  constexpr int most_halvings = 20;
  fill(neighbors);
  double rough = roughness(neighbors);
  for (int i = 0; i < most_halvings && rough > 1; ++i) {
    Neighbors narrower{neighbors.key, {}};
    narrower.key.step /= 2;
    fill(narrower);
    const double its = roughness(narrower);
    if (its >= rough) return;
    rough = its;
    neighbors = std::move(narrower);
  }
}

void Sensitivity::fill(Neighbors& neighbors) const {
  neighbors.models.clear();
  const VariedKey& key = neighbors.key;
  for (const int offset : Neighbors::offsets) {
    neighbors.models.push_back(
        model::assemble(key.scenario(key.value + offset * key.step), model_.gamma, form_));
    require_alike(neighbors.models.back(), key.name);
  }
}

void Sensitivity::require_alike(const model::Model& other, const std::string& key) const {
  const std::string name = shown(key);
  if (other.system.index() != model_.system.index() || other.size() != model_.size() ||
      other.hybrid() != model_.hybrid()) {
    no_sensitivity(name +
                   ": the scene has other equations at nearby values; allowed: a key whose values "
                   "all give the same equations");
  }
  const bool same_stops = std::ranges::equal(other.stops, model_.stops, [&](double a, double b) {
    return std::abs(a - b) <= 1e-12 * grid_.end();
  });
  if (!same_stops) {
    no_sensitivity(
        name +
        ": it moves times at which the input jumps; allowed: keys that do not move these times");
  }
}

// The error of differences of order 6 over the allowed one, at instants throughout the run. If it
// is at most 1, differences of order 8 are far better than needed.
double Sensitivity::roughness(const Neighbors& neighbors) const {
  constexpr int instants = 32;
  constexpr double good = 1e-10;
  const auto states = static_cast<Eigen::Index>(model_.size());
  const Eigen::Index references = RigSensitivity::reference(model_, 0).size();
  Eigen::ArrayXd apart = Eigen::ArrayXd::Zero(states + references);
  Eigen::ArrayXd most = apart, size = apart;
  for (int k = 0; k <= instants; ++k) {
    const double t = grid_.end() * k / instants;
    std::vector<Eigen::VectorXd> at;
    for (const model::Model& model : neighbors.models) {
      Eigen::VectorXd& all = at.emplace_back(states + references);
      all << rates(model, t, model_.initial.data()), RigSensitivity::reference(model, t);
      size = size.max(at.back().array().abs());
    }
    const auto value = [&](std::size_t i) -> const Eigen::VectorXd& { return at[i]; };
    const double step = neighbors.key.step;
    const Eigen::VectorXd good_one = difference(eighth_order, 4, step, value);
    apart = apart.max((good_one - difference(sixth_order, 4, step, value)).array().abs());
    most = most.max(good_one.array().abs());
  }
  const Eigen::ArrayXd allowed = good * most + 8 * epsilon / neighbors.key.step * size;
  return (apart > 0).select(apart / allowed, 0).maxCoeff();
}

// The least number of pairs of neighbors whose difference of f is as good as that of order 8, at
// various states; 0 if f does not depend on the key.
std::size_t Sensitivity::least_pairs(const Neighbors& neighbors) const {
  constexpr std::size_t most = Neighbors::offsets.size() / 2;
  constexpr int states = 8;
  constexpr double good = 1e-13, golden = 0.6180339887498949, size_of_states = 0.3;
  const auto n = static_cast<Eigen::Index>(model_.size());
  std::size_t pairs = 0;
  for (int k = 0; k < states; ++k) {
    const double t = grid_.end() * k / states;
    // Evenly spread, with no two numbers alike.
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double turns = golden * static_cast<double>(k * n + i + 1);
      z[i] = model_.initial[static_cast<std::size_t>(i)] +
             size_of_states * (turns - std::floor(turns) - 0.5);
    }
    std::vector<Eigen::VectorXd> at;
    double size = 0;
    for (const model::Model& model : neighbors.models) {
      size = std::max(size, at.emplace_back(rates(model, t, z.data())).cwiseAbs().maxCoeff());
    }
    const auto order = [&](std::size_t of) {
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(n);
      for (std::size_t i = 0; i < of; ++i) {
        sum += central_weights(of)[i] * (at[most + i] - at[most - 1 - i]);
      }
      return sum;
    };
    const Eigen::VectorXd best = order(most);
    const double allowed = good * best.cwiseAbs().maxCoeff() + epsilon * size;
    while (pairs < most && !((order(pairs) - best).cwiseAbs().maxCoeff() <= allowed)) ++pairs;
  }
  // f is linear in the command. If the command moves with the key, f has one degree more.
  return (model_.rig && model_.rig->sampled) ? std::min(pairs + 1, most) : pairs;
}

void Sensitivity::begin(solve::StateSink& next, bool with_measures) {
  next_ = &next;
  keeps_arcs_ = with_measures;
  fan_.clear();
  fan_.add(*this);
  if (solve::PieceSink* const pieces = next.pieces()) fan_.add(*pieces);
}

void Sensitivity::accept(std::size_t first, std::size_t count, const double* values) {
  const double* const end = values + count * static_cast<std::size_t>(row_);
  states_.insert(states_.end(), values, end);
  // No piece follows the last row, which already includes all switches at its time.
  if (switches_ && run_ != nullptr && first + count == grid_.size()) {
    pass(grid_.end(), Eigen::Map<const Eigen::VectorXd>(end - row_, row_));
  }
  next_->accept(first, count, values);
}

void Sensitivity::begin_run() {
  slopes_ = initial_;
  largest_ = slopes_.cwiseAbs();
  states_.clear();
  arcs_.clear();
  Eigen::MatrixXd first = Eigen::MatrixXd::Zero(row_, slopes_.cols());
  first.topRows(size_) = slopes_;
  gradients_.assign(first.data(), first.data() + first.size());
  next_row_ = 1;
  if (!switches_) return;
  switches_->begin_run();
  run_ = nullptr;
  reached_ = Eigen::VectorXd::Zero(size_);
  std::ranges::copy(model_.initial, reached_.begin());
  rates_ = Eigen::VectorXd::Zero(size_);  // nothing moves before the start
}

void Sensitivity::accept(const solve::Piece& piece) {
  if (switches_) {
    run_ = piece.run();
    Eigen::VectorXd start(row_);
    const double from = piece.from();
    piece.evaluate(&from, 1, start.data());
    pass(from, start);
  }
  cross(piece, piece.from(), piece.to(), 0);
  if (switches_) rates_ = state_rates(piece.to(), reached_);
}

// The system in the mode of the present piece.
const model::System& Sensitivity::system() const {
  return switches_ ? run_->model().system : model_.system;
}

// The rates of a row's states, and of r gamma.
Eigen::VectorXd Sensitivity::state_rates(double t, const Eigen::VectorXd& row) const {
  Eigen::VectorXd all(size_);
  all.head(static_cast<Eigen::Index>(model_.size())) =
      rates_of(system(), model_.size(), t, row.data());
  if (model_.gamma) all[size_ - 1] = row[spin_];
  return all;
}

// Takes S across an instant at which the scene may switch; `after` is the row after it. Rows at the
// instant get the derivatives after it, just as they have the commands after it.
void Sensitivity::pass(double t, const Eigen::VectorXd& after) {
  const Eigen::VectorXd rates_after = state_rates(t, after);
  const Eigen::VectorXd moves =
      switches_->pass({*run_, t, reached_, rates_, after, rates_after}, slopes_);
  if (!arcs_.empty()) arcs_.back().to_moves = moves;
  largest_ = largest_.cwiseMax(slopes_.cwiseAbs());
  const double rounding = run_->rounding(t);
  while (next_row_ > 0 && grid_[next_row_ - 1] >= t - rounding) --next_row_;
  gradients_.resize(next_row_ * static_cast<std::size_t>(row_ * slopes_.cols()));
  for (; next_row_ < grid_.size() && grid_[next_row_] <= t + rounding; ++next_row_) {
    for (std::size_t k = 0; k < keys_.size(); ++k) {
      const Eigen::VectorXd slope = slopes_.col(static_cast<Eigen::Index>(k));
      const Eigen::VectorXd extras = switches_->extras(k, t, after.head(size_), slope);
      gradients_.insert(gradients_.end(), slope.begin(), slope.end());
      gradients_.insert(gradients_.end(), extras.begin(), extras.end());
    }
  }
}

// Adds df/dp, which is 0 for the integral of u.
void Sensitivity::add_forcing(const Neighbors& neighbors, double t, const double* z,
                              double* into) const {
  if (neighbors.pairs == 0) return;
  const std::span<const double> weights = central_weights(neighbors.pairs);
  constexpr std::size_t middle = Neighbors::offsets.size() / 2;
  const std::size_t n = model_.size();
  std::vector<double> above(n), below(n);
  for (std::size_t i = 0; i < neighbors.pairs; ++i) {
    const auto find = [&](const model::Model& model, std::vector<double>& rates) {
      std::visit([&](const auto& system) { system.derivative(t, z, rates.data()); }, model.system);
    };
    find(neighbors.models[middle + i], above);
    find(neighbors.models[middle - 1 - i], below);
    const double weight = weights[i] / neighbors.key.step;
    for (std::size_t j = 0; j < n; ++j) into[j] += weight * (above[j] - below[j]);
  }
}

void Sensitivity::cross(const solve::Piece& piece, double from, double to, int depth) {
  if (!(to > from)) return;
  const double h = to - from;
  for (std::size_t choice = stages_.of(h);; ++choice) {
    const bool is_last = choice == StageChoice::last;
    if (step(piece, from, to, choice, is_last && depth == deepest)) return stages_.pass(choice);
    if (is_last) break;
    stages_.fail(choice, h);
  }
  const double middle = from + h / 2;
  cross(piece, from, middle, depth + 1);
  cross(piece, middle, to, depth + 1);
}

// Integrates S over an arc. Changes nothing and returns false if imprecise, unless `last_try`.
bool Sensitivity::step(const solve::Piece& piece, double from, double to, std::size_t choice,
                       bool last_try) {
  const Tables& rule = tables(choice);
  const int stages = rule.stages;
  const auto n = static_cast<Eigen::Index>(model_.size());
  const auto keys = static_cast<Eigen::Index>(keys_.size());
  const double h = to - from;
  std::vector<double> times;
  for (int i = 0; i <= stages; ++i) times.push_back(from + rule.nodes[i] * h);
  times.back() = to;
  Eigen::MatrixXd z(row_, stages + 1);
  piece.evaluate(times.data(), times.size(), z.data());

  std::vector<Eigen::MatrixXd> jacobians(static_cast<std::size_t>(stages),
                                         Eigen::MatrixXd::Zero(size_, size_));
  Eigen::MatrixXd part(n, n);
  Eigen::MatrixXd solved = Eigen::MatrixXd::Zero(size_ * stages, keys);  // df/dp, then S
  for (Eigen::Index j = 0; j < stages; ++j) {
    const double t = times[static_cast<std::size_t>(j) + 1];
    model::jacobian(system(), t, z.col(j + 1).data(), part.data());
    Eigen::MatrixXd& jacobian = jacobians[static_cast<std::size_t>(j)];
    jacobian.topLeftCorner(n, n) = part;
    if (model_.gamma) jacobian(n, spin_) = 1;
    for (Eigen::Index k = 0; k < keys; ++k) {
      add_forcing(keys_[static_cast<std::size_t>(k)], t, z.col(j + 1).data(),
                  solved.col(k).data() + j * size_);
    }
  }
  Eigen::VectorXd noise(keys);  // rounding of df/dp
  const double size =
      rates_of(system(), model_.size(), to, z.col(stages).data()).cwiseAbs().maxCoeff();
  for (Eigen::Index k = 0; k < keys; ++k) {
    noise[k] = epsilon * h * size / keys_[static_cast<std::size_t>(k)].key.step;
  }
  solve_stages(jacobians, rule.matrix, h, slopes_, solved);

  // The last Legendre coefficients bound the error of the polynomial. If symmetry makes the last
  // one vanish, a tenth of the one before replaces it.
  Eigen::MatrixXd largest = largest_;
  for (Eigen::Index j = 0; j < stages; ++j) {
    largest = largest.cwiseMax(solved.middleRows(j * size_, size_).cwiseAbs());
  }
  bool fine = true;
  for (Eigen::Index k = 0; k < keys && fine; ++k) {
    const Eigen::Map<const Eigen::MatrixXd> stage(solved.col(k).data(), size_, stages);
    const Eigen::MatrixXd grown = stage.colwise() - slopes_.col(k);
    const Eigen::ArrayXd tail =
        (grown * rule.last).array().abs().max(0.1 * (grown * rule.previous).array().abs());
    const Eigen::ArrayXd scale =
        largest.col(k).array().max(least_share * largest.col(k).maxCoeff());
    fine = (tail <= precision * scale + noise[k]).all();
  }
  if (!fine && !last_try) return false;

  // Between rows, only measures need the extras' derivatives.
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(row_ * (1 + keys), stages + 1);
  values.topRows(row_) = z;
  for (Eigen::Index k = 0; k < keys; ++k) {
    auto of_key = values.middleRows((1 + k) * row_, size_);
    of_key.col(0) = slopes_.col(k);
    of_key.rightCols(stages) =
        Eigen::Map<const Eigen::MatrixXd>(solved.col(k).data(), size_, stages);
    for (Eigen::Index j = 0; switches_ && keeps_arcs_ && j <= stages; ++j) {
      values.col(j).segment((1 + k) * row_ + size_, row_ - size_) =
          switches_->extras(static_cast<std::size_t>(k), times[static_cast<std::size_t>(j)],
                            z.col(j).head(size_), of_key.col(j));
    }
  }
  slopes_ = solved.bottomRows(size_);
  largest_ = largest;
  if (switches_) reached_ = z.col(stages).head(size_);
  take_rows(from, to, values);
  if (keeps_arcs_) arcs_.push_back({from, to, std::move(values)});
  return true;
}

void Sensitivity::take_rows(double from, double to, const Eigen::MatrixXd& values) {
  // A piece before a stop ends one rounding error early.
  const double until = to + 2 * epsilon * to;
  for (; next_row_ < grid_.size() && grid_[next_row_] <= until; ++next_row_) {
    const double fraction = std::min((grid_[next_row_] - from) / (to - from), 1.0);
    const Eigen::VectorXd shares = tables_of(values).shares(fraction);
    Eigen::VectorXd row = values.bottomRows(values.rows() - row_) * shares;
    if (switches_) {
      const Eigen::VectorXd z = values.topRows(size_) * shares;
      for (std::size_t k = 0; k < keys_.size(); ++k) {
        const Eigen::Index first = static_cast<Eigen::Index>(k) * row_;
        row.segment(first + size_, row_ - size_) =
            switches_->extras(k, grid_[next_row_], z, row.segment(first, size_));
      }
    }
    gradients_.insert(gradients_.end(), row.data(), row.data() + row.size());
  }
}

// Number of rows with derivatives; the run may have ended early.
std::size_t Sensitivity::rows() const {
  const auto size = static_cast<std::size_t>(row_);
  return std::min(states_.size() / size, gradients_.size() / (size * keys_.size()));
}

// Chooses a change of at most a thousandth of the key that moves no state by more than a thousandth
// of its range. Differences of order 4 are then accurate to rounding.
Sensitivity::Changed Sensitivity::changed(std::size_t key) const {
  constexpr double share = 1e-3, least_range = 1e-4;
  const VariedKey& varied = keys_[key].key;
  const auto count = static_cast<Eigen::Index>(rows());
  const Eigen::Map<const Eigen::MatrixXd> z(states_.data(), row_, count);
  const Eigen::VectorXd range = z.cwiseAbs().rowwise().maxCoeff();
  Eigen::VectorXd effect = Eigen::VectorXd::Zero(row_);
  for (Eigen::Index row = 0; row < count; ++row) {
    const Eigen::Map<const Eigen::MatrixXd> slopes(
        gradients_.data() + row * row_ * static_cast<Eigen::Index>(keys_.size()), row_,
        static_cast<Eigen::Index>(keys_.size()));
    effect = effect.cwiseMax(slopes.col(static_cast<Eigen::Index>(key)).cwiseAbs());
  }
  double most = varied.step;
  if (varied.value != 0) most = std::min(most, share * std::abs(varied.value));
  const double floor = least_range * range.maxCoeff();
  for (Eigen::Index i = 0; i < row_ && floor > 0; ++i) {
    if (effect[i] > 0) most = std::min(most, share * std::max(range[i], floor) / effect[i]);
  }
  // Do not move a switch by more than a thousandth of the shorter arc next to it.
  for (std::size_t i = 0; i < arcs_.size(); ++i) {
    const double moves = std::abs(switch_moves(i, key));
    if (moves > 0) most = std::min(most, share * room_at_end(i) / moves);
  }
  Changed changed{std::max(power_of_two_below(most), varied.step * 0x1p-20), {}, {}};
  for (const int offset : {-2, -1, 1, 2}) {
    const Scenario scenario = varied.scenario(varied.value + offset * changed.change);
    changed.models.push_back(model::assemble(scenario, model_.gamma, form_));
    changed.constants.push_back(model::constants_of(scenario));
  }
  return changed;
}

std::vector<double> Sensitivity::changed_rows(std::size_t key, double change) const {
  std::vector<double> moved = states_;
  const auto size = static_cast<std::size_t>(row_);
  for (std::size_t row = 0; row < rows(); ++row) {
    const double* const slopes = gradients_.data() + (row * keys_.size() + key) * size;
    for (std::size_t i = 0; i < size; ++i) moved[row * size + i] += change * slopes[i];
  }
  return moved;
}

std::vector<double> Sensitivity::column_gradient(const scenario::Column& column,
                                                 std::size_t key) const {
  const std::size_t count = rows();
  const auto size = static_cast<std::size_t>(row_);
  std::vector<double> gradient(states_.size() / size, nothing);
  if (count == 0) return gradient;
  const std::vector<std::string> names = model_.state_names();
  const auto state = std::ranges::find(names, column.name);
  // With offsets or backlash, the plane does not move as the servos do.
  const bool of_plane =
      model_.rig && (column.name.starts_with("phi") || column.name.starts_with("theta"));
  if (state != names.end() && !of_plane) {
    const auto at = static_cast<std::size_t>(state - names.begin());
    for (std::size_t row = 0; row < count; ++row) {
      gradient[row] = gradients_[(row * keys_.size() + key) * size + at];
    }
    return gradient;
  }
  // Otherwise the column is a function of the states and of the key.
  const Changed at = changed(key);
  std::vector<double> times;
  for (std::size_t row = 0; row < count; ++row) times.push_back(grid_[row]);
  std::vector<Eigen::VectorXd> values;
  for (std::size_t i = 0; i < 4; ++i) {
    constexpr std::array offsets = {-2, -1, 1, 2};
    record::Rows one({&column});
    one.begin(at.models[i], at.constants[i]);
    one.evaluate(times.data(), changed_rows(key, offsets[i] * at.change).data(), count);
    values.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(one[0], static_cast<Eigen::Index>(count)));
  }
  const Eigen::VectorXd found =
      difference(fourth_order, 2, at.change,
                 [&](std::size_t i) -> const Eigen::VectorXd& { return values[i]; });
  std::copy(found.begin(), found.end(), gradient.begin());
  return gradient;
}

// The length of the shorter arc next to the end of an arc, s; 0 for the last arc.
double Sensitivity::room_at_end(std::size_t arc) const {
  const auto length = [this](std::size_t i) { return arcs_[i].to - arcs_[i].from; };
  return arc + 1 < arcs_.size() ? std::min(length(arc), length(arc + 1)) : 0;
}

// Returns how far a key moves the switch at the end of an arc; measures need it only at jumps of
// rates. Returns 0 next to a very short arc (sticking): a move would carry the motion far past it.
double Sensitivity::switch_moves(std::size_t arc, std::size_t key) const {
  constexpr double least_room = 1e-6;  // share of the run
  const Eigen::VectorXd& moves = arcs_[arc].to_moves;
  if (moves.size() == 0 || room_at_end(arc) < least_room * grid_.end()) return 0;
  return moves[static_cast<Eigen::Index>(key)];
}

// The arc with the motion at a time, which may be slightly past its end, as in a moved motion.
const Sensitivity::Arc* Sensitivity::arc_at(double t) const {
  constexpr double past = 0.05;  // share of the arc's length
  const auto later = std::ranges::find_if(arcs_.rbegin(), arcs_.rend(),
                                          [&](const Arc& arc) { return arc.from < t; });
  const auto found = std::find_if(later, arcs_.rend(), [&](const Arc& arc) {
    return t - arc.to <= past * (arc.to - arc.from);
  });
  return found == arcs_.rend() ? nullptr : &*found;
}

// The outcome of the motion moved by a change of a key. It stops at its own zero of the event's
// margin, found by the secant method. Empty if there is no such zero nearby.
std::optional<solve::Outcome> Sensitivity::moved(const solve::Outcome& outcome, std::size_t key,
                                                 double change, const model::Model& changed) const {
  solve::Outcome moved = outcome;
  if (outcome.ending != solve::Ending::stopped) return moved;
  model::Occurrence& stop = moved.occurrences.back();
  const std::vector<model::Monitor>& monitors = changed.events->monitors;
  const auto monitor = std::ranges::find_if(
      monitors, [&](const model::Monitor& one) { return stop.name == one.name(); });
  if (monitor == monitors.end()) return {};
  std::vector<double> margins(monitors.size());
  Eigen::VectorXd row;
  const auto look = [&](double t) {
    const Arc* const arc = arc_at(t);
    if (arc == nullptr) return false;
    row = moved_values(*arc, key, change) *
          tables_of(arc->values).shares((t - arc->from) / (arc->to - arc->from));
    return true;
  };
  const auto margin = [&](double t) {
    if (!look(t)) return nothing;
    changed.events->margins(changed.sample(t, row.data(), model::Detail::motion), margins.data());
    return margins[static_cast<std::size_t>(monitor - monitors.begin())];
  };
  const Arc* const last = arc_at(stop.t);
  if (last == nullptr) return {};
  double before = stop.t - 1e-3 * (stop.t - last->from), t = stop.t;
  double margin_before = margin(before);
  constexpr int most = 50;
  for (int i = 0;; ++i) {
    const double now = margin(t);
    if (i == most || !std::isfinite(now)) return {};
    const double step = now == margin_before ? 0 : -now * (t - before) / (now - margin_before);
    before = std::exchange(t, t + step);
    margin_before = now;
    // The secant method converges with order 1.6.
    if (std::abs(step) <= 1e-10 * t) break;
  }
  if (!look(t)) return {};
  stop.t = t;
  stop.sample = changed.sample(t, row.data(), model::Detail::all);
  return moved;
}

// The row at each node of an arc, moved along S.
Eigen::MatrixXd Sensitivity::moved_values(const Arc& arc, std::size_t key, double change) const {
  return arc.values.topRows(row_) +
         change * arc.values.middleRows((1 + static_cast<Eigen::Index>(key)) * row_, row_);
}

std::vector<double> Sensitivity::measure_gradients(const std::vector<scenario::Measure>& measures,
                                                   std::size_t key,
                                                   const solve::Outcome& outcome) const {
  if (measures.empty() || rows() == 0) return std::vector<double>(measures.size(), nothing);
  constexpr std::array offsets = {-2, -1, 1, 2};
  const Changed at = changed(key);
  std::vector<Eigen::VectorXd> found;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const double change = offsets[i] * at.change;
    const auto its_outcome = moved(outcome, key, change, at.models[i]);
    if (!its_outcome) return std::vector<double>(measures.size(), nothing);
    const bool stops = outcome.ending == solve::Ending::stopped;
    const double end = stops ? its_outcome->occurrences.back().t : grid_.end();
    const Arc* const last = stops ? arc_at(end) : nullptr;
    record::Recorder recorder({{}, measures, false});
    recorder.begin(at.models[i], at.constants[i], grid_);
    if (solve::PieceSink* const pieces = recorder.pieces()) {
      pieces->begin_run();
      double moves = 0;  // shift of the arc's start
      for (std::size_t a = 0; a < arcs_.size(); ++a) {
        const Arc& arc = arcs_[a];
        const double from = arc.from + change * moves;
        moves = switch_moves(a, key);
        const double to = &arc == last ? end : arc.to + change * moves;
        if (to > from) {
          pieces->accept(
              ArcPiece(arc.from, arc.to - arc.from, from, to, moved_values(arc, key, change)));
        }
        if (&arc == last) break;
      }
    }
    recorder.accept(0, rows(), changed_rows(key, change).data());
    Eigen::VectorXd results(static_cast<Eigen::Index>(measures.size()));
    recorder.finish(*its_outcome, results.data());
    found.push_back(std::move(results));
  }
  const auto value = [&](std::size_t i) -> const Eigen::VectorXd& { return found[i]; };
  const Eigen::VectorXd gradient = difference(fourth_order, 2, at.change, value);
  const Eigen::VectorXd coarse = difference(second_order, 2, at.change, value);
  std::vector<double> gradients(measures.size());
  for (std::size_t m = 0; m < measures.size(); ++m) {
    const auto i = static_cast<Eigen::Index>(m);
    // At a kink, such as one maximum overtaking another, the differences disagree.
    const double allowed = 1e-2 * std::max(std::abs(gradient[i]), std::abs(coarse[i])) +
                           1e-10 * std::abs(found[1][i]) / at.change;
    gradients[m] = std::abs(gradient[i] - coarse[i]) <= allowed ? gradient[i] : nothing;
  }
  return gradients;
}

}  // namespace bbsim::study
