// What switches where friction is dry, contacts slide and motors have limits: which mode a coupled
// scene is in, and when it leaves it (docs/model.md, section 10).
//
// A dry force keeps something at rest as long as less than its limit is needed for that, and
// opposes its motion otherwise. Motion along a line is one of two signs, so that only its start and
// its end switch. In the plane it has any direction, and none at rest: so near rest that neither a
// position nor a velocity can tell within the tolerance, a direction is held instead.
#pragma once

#include <cstddef>
#include <vector>

#include "model/model.hpp"

namespace bbsim::model {

class DrySwitches {
 public:
  // `resolution` (m/s): velocities below it are taken to be near rest.
  DrySwitches(const DryParts& parts, double resolution) : parts_(parts), slow_(resolution) {}

  static constexpr std::size_t guards = 15;
  void append_scales(std::vector<double>& scales) const;

  // Chooses the mode that the model goes on in from here. What has come to rest is put to rest:
  // changes z.
  void settle(Model& model, double t, double* z) const;

  // Positive as long as nothing switches; `guards` numbers.
  void evaluate(const Model& model, double t, const double* z, double* values) const;

  // What somebody may want to be told of.
  struct State {
    bool slides = false, rests = false;
    bool sticks[2] = {false, false};
    friend bool operator==(const State&, const State&) = default;
  };
  [[nodiscard]] State state(const Model& model) const;

 private:
  template <class Contact, class Motor>
  struct BasicScene;
  using Scene = BasicScene<ContactMode, MotorMode>;
  using SeenScene = BasicScene<const ContactMode, const MotorMode>;
  struct AtZero;
  void settle_limits(Scene& scene, double t, const double* z) const;
  void settle_direction(DryDirection& of, const double (&v)[2], bool was_still) const;
  [[nodiscard]] int faults(Scene& scene, double t, const double* z, const AtZero& zero, bool slide,
                           bool rest) const;

  DryParts parts_;
  double slow_;
};

}  // namespace bbsim::model
