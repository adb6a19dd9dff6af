#include "model/spectrum.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "model/control/sampled_cycle.hpp"
#include "model/eigenvalues.hpp"
#include "model/systems/any_jacobian.hpp"

namespace bbsim::model {
namespace {

// With the plane level at home, whatever its offsets.
template <class Loop>
Loop level(Loop loop) {
  if constexpr (is_rig<Loop>) loop.mode = {};
  if constexpr (is_coupled_loop<Loop>) {
    loop.loop.mode = {};
    using Link = std::decay_t<decltype(loop.loop.link)>;
    if constexpr (std::is_same_v<Link, Linkages>) loop.loop.link = levelled(loop.loop.link);
    if constexpr (std::is_same_v<Link, ThreeServos>) {
      for (int i = 0; i < 2; ++i) {
        loop.loop.link.cos_offset[i] = 1;
        loop.loop.link.sin_offset[i] = 0;
      }
    }
    loop.parts.contact = {};
    for (MotorMode& motor : loop.motors) motor = {};
  }
  return loop;
}

}  // namespace

Eigenvalues sorted_eigenvalues(const Eigen::MatrixXd& matrix) {
  Eigenvalues values = eigenvalues_of(matrix);
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  return values;
}

Eigenvalues eigenvalues(const Model& model, double t, const double* z) {
  const auto n = static_cast<Eigen::Index>(model.size());
  Eigen::MatrixXd matrix(n, n);
  jacobian(model.system, t, z, matrix.data());
  return sorted_eigenvalues(matrix);
}

Eigenvalues closed_loop_poles(const Model& model) {
  return std::visit(
      [](const auto& loop) -> Eigenvalues {
        using Loop = std::decay_t<decltype(loop)>;
        if constexpr (Loop::open_loop || (is_coupled<Loop> && !is_coupled_loop<Loop>)) {
          return {};
        } else {
          // Where the reference is, is no matter of home.
          Eigen::MatrixXd full(Loop::size, Loop::size);
          jacobian_at_home(level(loop), full.data());
          constexpr int spin = spin_index<Loop>;
          if constexpr (is_coupled_loop<Loop>) {
            if (loop.law().kind == LawKind::held && loop.by != GimbalBy::given_torques) return {};
            using Layout = typename Loop::Layout;
            std::vector<int> rest{0, 1, 2, 3};
            for (int i = Layout::angle; i < Layout::integral; ++i) rest.push_back(i);
            for (int j = 0; j < 2; ++j) {
              if (loop.law().integrates(static_cast<std::size_t>(j))) {
                rest.push_back(Layout::integral + j);
              }
            }
            if (loop.motor.from_integral != 0) {
              rest.insert(rest.end(), {Layout::motor, Layout::motor + 1});
            }
            return sorted_eigenvalues(full(rest, rest));
          } else if constexpr (is_rig<Loop>) {
            if (loop.law().kind == LawKind::held) return {};
            // Without the spin, as below, and without an integral part that never changes.
            std::vector<int> rest{0, 1, 2, 3, 5, 6, 7, 8};
            for (int i = 9; i < Loop::size; ++i) {
              if (loop.law().integrates(static_cast<std::size_t>(i - 9))) rest.push_back(i);
            }
            return sorted_eigenvalues(full(rest, rest));
          } else if constexpr (spin < 0) {
            return sorted_eigenvalues(full);
          } else {
            // At home the spin neither feels the other states nor acts on them.
            std::vector<int> rest;
            for (int i = 0; i < Loop::size; ++i) {
              if (i != spin) rest.push_back(i);
            }
            return sorted_eigenvalues(full(rest, rest));
          }
        }
      },
      model.system);
}

bool stable(const Eigenvalues& poles) {
  double scale = 0;
  for (const auto& pole : poles) scale = std::max(scale, std::abs(pole));
  const double rounding = 100 * std::numeric_limits<double>::epsilon() * scale;
  return std::all_of(poles.begin(), poles.end(),
                     [rounding](const auto& pole) { return pole.real() < -rounding; });
}

}  // namespace bbsim::model
