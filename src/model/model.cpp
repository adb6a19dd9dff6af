#include "model/model.hpp"

#include <limits>

namespace bbsim::model {

std::size_t Model::extras() const {
  return rig && hybrid() ? std::size_t{RigExtras::size} : 0;
}

Sample Model::sample(double t, const double* row, Detail detail) const {
  Sample sample = std::visit(
      [&](const auto& any) {
        if constexpr (is_rig<std::decay_t<decltype(any)>>) {
          return extras() > 0
                     ? any.sample(t, row, RigExtras::unpack(row + size() + (gamma ? 1 : 0)), detail)
                     : any.sample(t, row, detail);
        } else {
          return any.sample(t, row, detail);
        }
      },
      system);
  sample.gamma = gamma ? row[size()] / radius : gamma_not_integrated();
  return sample;
}

double Model::gamma_not_integrated() const {
  const bool turns = std::visit(
      [](const auto& any) { return spin_index<std::decay_t<decltype(any)>> >= 0; }, system);
  return turns ? std::numeric_limits<double>::quiet_NaN() : 0;
}

std::vector<std::string> Model::state_names() const {
  return std::visit(
      [](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        std::vector<std::string> names(Any::Layout::names.begin(), Any::Layout::names.end());
        if constexpr (Any::size > Any::Layout::size) {
          for (const char* suffix : {"", "_rate"}) {
            if (phi_moves(Any::moves)) names.push_back(std::string("phi") + suffix);
            if (theta_moves(Any::moves)) names.push_back(std::string("theta") + suffix);
          }
        }
        if constexpr (Any::size == RigLoop<true>::size) {
          names.insert(names.end(), {"x_integral", "y_integral"});
        }
        return names;
      },
      system);
}

bool Model::closed_loop() const {
  return std::visit([](const auto& any) { return !std::decay_t<decltype(any)>::open_loop; },
                    system);
}

}  // namespace bbsim::model
